//! What the RON reader refuses, in words a person can act on.
//!
//! In: the reader's error and the text. Out: a [`SceneError`] that names the key round the place
//! and says what belongs there. Values that can be read but make no sense are for [`super::check`].

use super::error::{SceneError, one_of, suggestion};
use super::outline::{Outline, OutlineEntry, byte_at};
use crate::physics::ContactLaw;

const WHOLE_NUMBER: &str = "a whole number of at least 0";

/// What the RON reader found wrong in `text`, in our words.
pub(super) fn explain(file: &str, text: &str, error: &ron::error::SpannedError) -> SceneError {
    let outline = Outline::new(text);
    let start = byte_at(text, error.span.start.line, error.span.start.col);
    let end = byte_at(text, error.span.end.line, error.span.end.col);
    // The reader stands before the white space that leads to the token it refuses.
    let blank = text[start..].len() - text[start..].trim_start().len();
    let finding = Finding {
        file,
        outline: &outline,
        at: (start + blank).min(end.max(start)),
    };
    finding.explain(&error.code)
}

/// A mistake that the RON reader found at the byte `at`.
struct Finding<'a> {
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
            None => "is not a key of a scene".to_owned(),
        };
        let key = entry.map_or(found, |e| &e.path);
        self.error(entry, fault, one_of(expected))
            .about(key)
            .advise(suggestion(found, expected))
    }

    fn missing_key(&self, field: &str) -> SceneError {
        if let Some(holder) = self.outline.holding(self.at) {
            let fault = format!("has no `{field}`");
            return self.error(Some(holder), fault, meaning(field).to_owned());
        }
        let fault = "is missing from the scene".to_owned();
        self.error(None, fault, meaning(field).to_owned())
            .about(field)
    }

    fn wrong_type(&self, expected: &str) -> SceneError {
        let found = self.outline.around(self.at).map(|e| self.outline.value(e));
        self.wrong_type_of(found.as_deref().unwrap_or_default(), expected)
    }

    fn wrong_type_of(&self, found: &str, expected: &str) -> SceneError {
        let Some(entry) = self.outline.around(self.at) else {
            let fault = "the text does not begin as a scene".to_owned();
            return self.error(None, fault, "`(title: …, …)`".to_owned());
        };
        let expected = match meaning(last_key(&entry.path)) {
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
        let expected = meaning(last_key(&entry.path)).to_owned();
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
        .advise(syntax_advice(code).map(str::to_owned))
        .at_line(self.outline.text(), self.at)
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

fn syntax_advice(code: &ron::Error) -> Option<&'static str> {
    use ron::Error as E;
    match code {
        E::Eof => Some("The text ends too early: is a closing bracket or quote missing?"),
        E::ExpectedComma => Some(
            "Is a comma or a closing quote missing before this, or is there a bracket too many?",
        ),
        E::TrailingCharacters => Some("Nothing may follow the scene's closing bracket"),
        E::ExpectedMapColon => Some("A key and its value are parted by a colon"),
        E::ExpectedIdentifier => {
            Some("Keys are plain words; only names of materials stand in quotes")
        }
        _ => None,
    }
}

/// What a key holds, for those who left it out or gave something else.
fn meaning(key: &str) -> &'static str {
    match key {
        "title" => "one line that names the scene",
        "materials" => "the materials by name: `{\"glass\": (density: 2500), …}`",
        "container" => "`Drum(…)`, `Box(…)`, `Column(…)`, `Planes([…])` or `Nothing`",
        "grains" => "`Fill(…)`, `Voronoi(…)` or `List([…])`",
        "species" => "the kinds of grain, `[(radius: 0.003, material: \"glass\")]`",
        "material" => "the name of one of the scene's materials",
        "radius" => "a length in m, or in mm as `radius_mm`",
        "height" => "a length in m, or in mm as `height_mm`",
        "cell" | "rounding" => "a length in m, or in mm under a key that ends in `_mm`",
        "shape" => {
            "`Box(size: …)`, `Tetrahedron(edge: …)`, `Prism(…)`, `Hull(points: […])` or `Sphere`"
        }
        "orientation" => "`Turned(axis: …, angle_deg: …)`, `Quaternion(…)` or `Upright`",
        "tube" => "`(speed: …)` in m/s",
        "width" => "a length in m, or in mm as `width_mm`",
        "speed" => "rad/s, or turns per minute as `speed_rpm`",
        "position" | "point" | "min" | "max" => "a point `(x, y, z)` in m",
        "velocity" => "`(x, y, z)` in m/s",
        "spin" => "`(x, y, z)` in rad/s",
        "gravity" => "`(x, y, z)` in m/s²",
        "normal" => "the direction `(x, y, z)` towards the grains",
        "between" => "two materials, `(\"glass\", \"drum\")`",
        "normal_stiffness" | "tangential_stiffness" => "a spring's stiffness in N/m",
        "law" => ContactLaw::FORMS,
        "integrator" => "`Explicit` or `Imex`",
        "time_step" => "`Automatic`, `Following` or `Given(…)` with a time in s",
        "duration" | "output_interval" | "sample_interval" => "a time in s",
        _ => "",
    }
}
