//! What the RON reader refuses, in words a person can act on.
//!
//! In: the reader's error and the text, and which kind of file it should be. Out: a [`SceneError`]
//! that names the key round the place and says what belongs there. Values that can be read but make
//! no sense are for the checks of that kind.

use super::error::{SceneError, one_of, suggestion};
use super::outline::{Outline, OutlineEntry, byte_at};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

const WHOLE_NUMBER: &str = "a whole number of at least 0";

/// A kind of file in RON, in words.
pub(crate) struct FileKind {
    /// What people call it: `scene`.
    pub noun: &'static str,
    /// How its text begins.
    pub begins: &'static str,
    /// What each key of it holds, for those who left it out or gave something else; empty where
    /// that needs no saying.
    pub meaning: fn(&str) -> &'static str,
}

/// What `text`, which errors call `file`, states as a file of this `kind`.
///
/// # Errors
/// When the text is no such file; what its values mean is not looked at.
pub(crate) fn read_ron<T: DeserializeOwned>(
    kind: &FileKind,
    file: &str,
    text: &str,
) -> Result<T, SceneError> {
    if text.trim().is_empty() {
        let expected = format!("a {} {}", kind.noun, kind.begins);
        return Err(SceneError::unreadable(file, "the file is empty", &expected));
    }
    let extensions = Extensions::IMPLICIT_SOME
        | Extensions::UNWRAP_NEWTYPES
        | Extensions::UNWRAP_VARIANT_NEWTYPES;
    let options = ron::Options::default().with_default_extension(extensions);
    (options.from_str(text)).map_err(|error| explain(kind, file, text, &error))
}

/// What the RON reader found wrong in `text`, in our words.
fn explain(
    kind: &FileKind,
    file: &str,
    text: &str,
    error: &ron::error::SpannedError,
) -> SceneError {
    let outline = Outline::new(text);
    let start = byte_at(text, error.span.start.line, error.span.start.col);
    let end = byte_at(text, error.span.end.line, error.span.end.col);
    // The reader stands before the white space that leads to the token it refuses.
    let blank = text[start..].len() - text[start..].trim_start().len();
    let finding = Finding {
        kind,
        file,
        outline: &outline,
        at: (start + blank).min(end.max(start)),
    };
    finding.explain(&error.code)
}

/// A mistake that the RON reader found at the byte `at`.
struct Finding<'a> {
    kind: &'a FileKind,
    file: &'a str,
    outline: &'a Outline<'a>,
    at: usize,
}

impl Finding<'_> {
    fn explain(&self, code: &ron::Error) -> SceneError {
        use ron::Error as E;
        match code {
            E::NoSuchStructField {
                expected, found, ..
            } => self.unknown_key(found, expected),
            E::MissingStructField { field, .. } => self.missing_key(field),
            E::DuplicateStructField { .. } => {
                self.wrong("is given twice".to_owned(), "each key once")
            }
            E::NoSuchEnumVariant {
                expected, found, ..
            } => self
                .wrong(format!("is `{found}`"), &one_of(expected))
                .advise(suggestion(found, expected)),
            E::ExpectedFloat => self.wrong_type("a number"),
            E::ExpectedInteger
            | E::IntegerOutOfBounds
            | E::InvalidIntegerDigit { .. }
            | E::UnderscoreAtBeginning => self.wrong_type(WHOLE_NUMBER),
            E::ExpectedComma if self.within_number() => self.wrong_number(),
            E::ExpectedIdentifier if self.at_value() => self.wrong_type("a name"),
            E::ExpectedString => self.wrong_type("text in double quotes"),
            E::ExpectedArray => self.wrong_type("a list `[…]`"),
            E::ExpectedMap => self.wrong_type("a map `{\"name\": (…), …}`"),
            E::ExpectedStructLike | E::ExpectedNamedStructLike(_) => {
                self.wrong_type("`(` and what belongs inside")
            }
            E::SuggestRawIdentifier(found) => self.wrong_type_of(found, "a name"),
            E::ExpectedDifferentLength { .. } => self.wrong_length("too few elements", code),
            E::ExpectedStructLikeEnd => self.wrong_length("too many elements", code),
            other => self.syntax(other),
        }
    }

    fn unknown_key(&self, found: &str, expected: &[&str]) -> SceneError {
        let entry = self.outline.around(self.at);
        let holder = entry.and_then(|e| e.path.rsplit_once('.')).map(|p| p.0);
        let fault = match holder {
            Some(holder) => format!("is not a key of `{holder}`"),
            None => format!("is not a key of a {}", self.kind.noun),
        };
        let key = entry.map_or(found, |e| &e.path);
        self.error(entry, fault, one_of(expected))
            .about(key)
            .advise(suggestion(found, expected))
    }

    fn missing_key(&self, field: &str) -> SceneError {
        if let Some(holder) = self.outline.holding(self.at) {
            let fault = format!("has no `{field}`");
            return self.error(Some(holder), fault, (self.kind.meaning)(field).to_owned());
        }
        let fault = format!("is missing from the {}", self.kind.noun);
        self.error(None, fault, (self.kind.meaning)(field).to_owned())
            .about(field)
    }

    fn wrong_type(&self, expected: &str) -> SceneError {
        let found = self.outline.around(self.at).map(|e| self.outline.value(e));
        self.wrong_type_of(found.as_deref().unwrap_or_default(), expected)
    }

    fn wrong_type_of(&self, found: &str, expected: &str) -> SceneError {
        let Some(entry) = self.outline.around(self.at) else {
            let fault = format!("the text does not begin as a {}", self.kind.noun);
            return self.error(None, fault, self.kind.begins.to_owned());
        };
        let expected = match (self.kind.meaning)(last_key(&entry.path)) {
            "" => expected.to_owned(),
            meaning => format!("{expected}: {meaning}"),
        };
        self.error(Some(entry), format!("is {found}"), expected)
    }

    /// A tuple ends too early or too late.
    fn wrong_length(&self, fault: &str, code: &ron::Error) -> SceneError {
        let element = self.outline.holding(self.at);
        let Some(entry) = element.and_then(|e| self.outline.find(without_index(&e.path))) else {
            return self.syntax(code);
        };
        let expected = (self.kind.meaning)(last_key(&entry.path)).to_owned();
        self.error(Some(entry), format!("has {fault}"), expected)
    }

    fn wrong(&self, fault: String, expected: &str) -> SceneError {
        let entry = self.outline.around(self.at);
        self.error(entry, fault, expected.to_owned())
    }

    /// A number that the reader took for a whole one, until it met more.
    fn wrong_number(&self) -> SceneError {
        let entry = self.outline.around(self.at);
        if entry.is_some_and(|e| self.outline.value(e).parse::<f64>().is_ok()) {
            self.wrong_type(WHOLE_NUMBER)
        } else {
            self.wrong_type("a number alone")
        }
    }

    /// Whether the reader stands in a single word that begins with a digit.
    fn within_number(&self) -> bool {
        self.outline.around(self.at).is_some_and(|entry| {
            let value = self.outline.value(entry);
            value.starts_with(|c: char| c.is_ascii_digit()) && !value.contains(' ')
        })
    }

    /// Whether the reader stands where a value begins.
    fn at_value(&self) -> bool {
        let entry = self.outline.around(self.at);
        entry.is_some_and(|e| e.value.start == self.at && e.start < self.at)
    }

    fn syntax(&self, code: &ron::Error) -> SceneError {
        let entry = self.outline.around(self.at);
        let near = match entry {
            Some(entry) => format!(" (in `{}`)", entry.path),
            None => String::new(),
        };
        let what = code.to_string();
        SceneError::unreadable(
            self.file,
            format!("this is not RON{near}: {}", lower_first(&what)),
            "",
        )
        .advise(self.syntax_advice(code))
        .at_line(self.outline.text(), self.at)
    }

    fn syntax_advice(&self, code: &ron::Error) -> Option<String> {
        use ron::Error as E;
        let advice = match code {
            E::Eof => "The text ends too early: is a closing bracket or quote missing?",
            E::ExpectedComma => {
                "Is a comma or a closing quote missing before this, or is there a bracket too many?"
            }
            E::TrailingCharacters => {
                let noun = self.kind.noun;
                return Some(format!("Nothing may follow the {noun}'s closing bracket"));
            }
            E::ExpectedMapColon => "A key and its value are parted by a colon",
            E::ExpectedIdentifier => "Keys are plain words; only names stand in quotes",
            _ => return None,
        };
        Some(advice.to_owned())
    }

    fn error(&self, entry: Option<&OutlineEntry>, fault: String, expected: String) -> SceneError {
        let error = SceneError::unreadable(self.file, fault, &expected);
        match entry {
            Some(entry) => error.in_entry(self.outline, entry),
            None => error.at_line(self.outline.text(), self.at),
        }
    }
}

/// The path of the list that holds the element at `path`; a path that is no element's stays.
fn without_index(path: &str) -> &str {
    let list = path.strip_suffix(']').and_then(|p| p.rsplit_once('['));
    list.map_or(path, |(list, _)| list)
}

/// The last name of a path without the unit in it.
fn last_key(path: &str) -> &str {
    let path = without_index(path);
    let key = path.rsplit_once('.').map_or(path, |(_, key)| key);
    ["_mm", "_rpm", "_deg", "_mpas", "_ml"]
        .iter()
        .fold(key, |key, unit| key.strip_suffix(unit).unwrap_or(key))
}

fn lower_first(text: &str) -> String {
    let mut characters = text.chars();
    characters
        .next()
        .map(|first| first.to_lowercase().chain(characters).collect())
        .unwrap_or_default()
}
