//! What follows the states in a session's file: what later layouts of it added, one behind the other.
//!
//! In: an archive and how the window looks. Out: a [`Tail`], and from it the same. A file of an
//! earlier layout ends earlier: what it lacks is empty.

use super::archive::Archive;
use super::branch_names::BranchNames;
use super::meetings::Meeting;
use super::sampling::Sampling;
use glam::Quat;
use serde::{Deserialize, Serialize};

/// Raised whenever what follows the second line of a session's file is laid out otherwise.
pub const LAYOUT: &str = "7";
/// The layout that ends where the names begin; it is read, too.
const WITHOUT_NAMES: &str = "6";
/// The layout that ends where the meetings begin; it is read, too.
const WITHOUT_MEETINGS: &str = "5";
/// The layout that ends where the orientations begin; it is read, too.
const WITHOUT_ORIENTATIONS: &str = "4";
/// The layout that ends where the tail begins; it is read, too.
pub const WITHOUT_TAIL: &str = "3";
/// All that are read.
const LAYOUTS: [&str; 5] = [
    LAYOUT,
    WITHOUT_NAMES,
    WITHOUT_MEETINGS,
    WITHOUT_ORIENTATIONS,
    WITHOUT_TAIL,
];

/// What follows the states, in this order.
#[derive(Default, Serialize, Deserialize)]
pub struct Tail {
    /// How samples are taken from each state of the archive on.
    samplings: Vec<Sampling>,
    /// How the window looked, in its own words.
    look: String,
    /// How far spheres have turned in each state.
    orientations: Vec<Vec<Quat>>,
    /// Who of few grains met in each branch.
    meetings: Vec<Vec<Meeting>>,
    /// What people called branches.
    names: BranchNames,
}

/// Whether files of this `layout` are read.
pub fn is_known(layout: &str) -> bool {
    LAYOUTS.contains(&layout)
}

impl Tail {
    /// What the `archive` does not say by itself, and the `look` of the window.
    pub fn of(archive: &Archive, look: &str) -> Self {
        Self {
            samplings: archive.samplings().collect(),
            look: look.to_owned(),
            orientations: archive.orientations().collect(),
            meetings: archive.meetings().map(<[Meeting]>::to_vec).collect(),
            names: archive.names.clone(),
        }
    }

    /// That in the `bytes` at the end of a file of this `layout`.
    ///
    /// # Errors
    /// When they are something else.
    pub fn read(bytes: &[u8], layout: &str) -> postcard::Result<Self> {
        match layout {
            WITHOUT_TAIL => Ok(Self::default()),
            WITHOUT_ORIENTATIONS => {
                let (samplings, look) = postcard::from_bytes(bytes)?;
                Ok(Self {
                    samplings,
                    look,
                    ..Self::default()
                })
            }
            WITHOUT_MEETINGS => {
                let (samplings, look, orientations) = postcard::from_bytes(bytes)?;
                Ok(Self {
                    samplings,
                    look,
                    orientations,
                    ..Self::default()
                })
            }
            WITHOUT_NAMES => {
                let (samplings, look, orientations, meetings) = postcard::from_bytes(bytes)?;
                Ok(Self {
                    samplings,
                    look,
                    orientations,
                    meetings,
                    ..Self::default()
                })
            }
            _ => postcard::from_bytes(bytes),
        }
    }

    /// Gives the `archive` what it did not say by itself; returns the look of the window.
    pub fn complete(self, archive: &mut Archive) -> String {
        archive.set_samplings(&self.samplings);
        archive.set_orientations(self.orientations);
        archive.set_meetings(self.meetings);
        archive.names = self.names;
        self.look
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_earlier_layout_lacks_is_empty() {
        let mut names = BranchNames::default();
        names.give(1, "the steep one");
        let tail = Tail {
            samplings: vec![Sampling::on_grid(3)],
            look: "a look".into(),
            orientations: vec![vec![Quat::IDENTITY]],
            meetings: vec![Vec::new(), Vec::new()],
            names,
        };
        let bytes = postcard::to_stdvec(&tail).unwrap();
        let end = bytes.len();
        let end_of_meetings = end - postcard::to_stdvec(&tail.names).unwrap().len();
        let meetings = postcard::to_stdvec(&tail.meetings).unwrap().len();
        let orientations = postcard::to_stdvec(&tail.orientations).unwrap().len();
        let without_meetings = end_of_meetings - meetings;
        let without_orientations = without_meetings - orientations;
        let steep = Some("the steep one");
        let ends = [
            (LAYOUT, end, (1, "a look", 1, 2, steep)),
            (WITHOUT_NAMES, end_of_meetings, (1, "a look", 1, 2, None)),
            (
                WITHOUT_MEETINGS,
                without_meetings,
                (1, "a look", 1, 0, None),
            ),
            (
                WITHOUT_ORIENTATIONS,
                without_orientations,
                (1, "a look", 0, 0, None),
            ),
            (WITHOUT_TAIL, 0, (0, "", 0, 0, None)),
        ];
        for (layout, end, expected) in ends {
            let read = Tail::read(&bytes[..end], layout).unwrap();
            let found = (
                read.samplings.len(),
                read.look.as_str(),
                read.orientations.len(),
                read.meetings.len(),
                read.names.of(1),
            );
            assert_eq!(found, expected, "{layout}");
        }
        assert!(Tail::read(&bytes[..end - 1], LAYOUT).is_err());
        assert!(is_known(LAYOUT) && !is_known("2"));
    }
}
