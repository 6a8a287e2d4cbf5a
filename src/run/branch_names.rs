//! Names that people gave to branches.
//!
//! In: the number of a branch and a text. Out: the name, by that number. Branches that nobody named
//! are called by what differs in them, which is told by whoever shows them.

use super::provenance::is_unprintable;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Most branches that have one.
const MOST: usize = 1000;

/// The names of branches by their numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<(u32, String)>", into = "Vec<(u32, String)>")]
pub struct BranchNames(BTreeMap<u32, String>);

impl From<Vec<(u32, String)>> for BranchNames {
    /// Names as a file may have them.
    fn from(list: Vec<(u32, String)>) -> Self {
        let mut names = Self::default();
        for (number, name) in list {
            names.give(number, &name);
        }
        names
    }
}

impl From<BranchNames> for Vec<(u32, String)> {
    fn from(names: BranchNames) -> Self {
        names.0.into_iter().collect()
    }
}

impl BranchNames {
    /// Longest name, in characters.
    pub const LONGEST: usize = 60;

    /// The name of the branch of this `number`, where it has one.
    pub fn of(&self, number: u32) -> Option<&str> {
        self.0.get(&number).map(String::as_str)
    }

    /// Calls the branch of this `number` by `name`: one line, [`BranchNames::LONGEST`] characters of
    /// it, none that cannot be printed or that turns the direction of other text; an empty one, or
    /// one of which nothing is seen, takes its name away.
    pub fn give(&mut self, number: u32, name: &str) {
        let is_between = |letter: char| letter.is_whitespace() || is_unprintable(letter);
        let words: Vec<&str> = name
            .split(is_between)
            .filter(|word| !word.is_empty())
            .collect();
        let name: String = words.join(" ").chars().take(Self::LONGEST).collect();
        if name.chars().all(is_invisible) {
            self.0.remove(&number);
        } else if self.0.len() < MOST || self.0.contains_key(&number) {
            self.0.insert(number, name);
        }
    }
}

/// Spaces of no width and marks that only other letters show. They stand in emoji and in several
/// scripts, so they are kept beside other letters.
fn is_invisible(letter: char) -> bool {
    letter == ' '
        || matches!(letter, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2060}'..='\u{2064}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_hides_or_turns_what_stands_beside_it() {
        let mut names = BranchNames::default();
        let given = [
            (
                "\u{202e}steep\u{2066} one\u{1b}[31m",
                Some("steep one [31m"),
            ),
            ("\u{200b}\u{feff} \u{200f}", None),
            (
                "\u{1f468}\u{200d}\u{1f52c} שלום",
                Some("\u{1f468}\u{200d}\u{1f52c} שלום"),
            ),
            ("two\u{2028}lines", Some("two lines")),
        ];
        for (name, expected) in given {
            names.give(1, name);
            assert_eq!(names.of(1), expected, "{name:?}");
        }
    }

    #[test]
    fn names_are_one_line_and_come_back_from_a_file() {
        let mut names = BranchNames::default();
        names.give(2, "  the steep\none\u{7} ");
        names.give(3, &"x".repeat(500));
        names.give(4, "gone");
        names.give(4, " \t");
        assert_eq!(names.of(2), Some("the steep one"));
        assert_eq!(names.of(3).map(str::len), Some(BranchNames::LONGEST));
        assert_eq!((names.of(4), names.of(1)), (None, None));
        let bytes = postcard::to_stdvec(&names).unwrap();
        assert_eq!(postcard::from_bytes::<BranchNames>(&bytes).unwrap(), names);
        let many: Vec<(u32, String)> = (0..5000).map(|k| (k, "name".to_owned())).collect();
        assert_eq!(BranchNames::from(many).0.len(), MOST);
    }
}
