//! What was wrong with a scene, in words a person can act on.

use super::outline::{Entry, Outline, byte_at, line_of, shorten};
use std::fmt;

const WHOLE_NUMBER: &str = "a whole number of at least 0";
/// The characters of an index in a path.
const INDEX: [char; 12] = ['[', ']', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'];

/// A scene that cannot be used: where, what was found, what was expected, what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", self.describe())]
pub struct SceneError {
    /// The file, or whatever else gave the value.
    file: String,
    /// Line, counted from 1, and its text.
    line: Option<(usize, String)>,
    /// The key, with all that lead to it.
    key: Option<String>,
    /// The value as written.
    value: Option<String>,
    /// What is wrong, a phrase of which the key is the subject.
    fault: String,
    /// What was expected.
    expected: String,
    /// What to do where that is not obvious.
    advice: Option<String>,
}

impl SceneError {
    /// The file that is wrong.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Line of the mistake, counted from 1.
    pub fn line(&self) -> Option<usize> {
        self.line.as_ref().map(|line| line.0)
    }

    /// The key that is wrong, with all that lead to it: `grains.species[0].radius`.
    pub fn key(&self) -> Option<&str> {
        self.key.as_deref()
    }

    /// The value that is wrong, as written.
    pub fn value(&self) -> Option<&str> {
        self.value.as_deref()
    }

    /// What was expected.
    pub fn expected(&self) -> &str {
        &self.expected
    }

    /// A file that cannot be read at all.
    pub(super) fn unreadable(file: &str, fault: impl Into<String>, expected: &str) -> Self {
        Self {
            file: file.to_owned(),
            line: None,
            key: None,
            value: None,
            fault: fault.into(),
            expected: expected.to_owned(),
            advice: None,
        }
    }

    pub(super) fn at_line(mut self, text: &str, at: usize) -> Self {
        let line = line_of(text, at);
        let written = text.lines().nth(line - 1).unwrap_or_default();
        self.line = Some((line, shorten(written, 100)));
        self
    }

    pub(super) fn advise(mut self, advice: Option<String>) -> Self {
        self.advice = advice;
        self
    }

    /// `problem` with the place in `text` where it stands.
    pub(super) fn from_problem(file: &str, text: &str, problem: Problem) -> Self {
        let outline = Outline::new(text);
        let entry = outline.find(&problem.path);
        let exact = entry.filter(|e| e.path.starts_with(&problem.path));
        let value = exact.map(|e| outline.value(e));
        let fault = match (problem.fault, &value, exact) {
            (Fault::Value(_), Some(written), Some(e)) if e.path == problem.path => {
                format!("is {written}")
            }
            (Fault::Value(si), Some(written), _) if si != *written => {
                format!("is {written}, in SI units {si}")
            }
            (fault, ..) => fault.to_string(),
        };
        let error = Self {
            file: file.to_owned(),
            line: None,
            key: Some(exact.map_or(problem.path, |e| e.path.clone())),
            value,
            fault,
            expected: problem.expected,
            advice: problem.advice,
        };
        match entry {
            Some(entry) => error.at_line(text, entry.start),
            None => error,
        }
    }

    /// `problem` with a value that no file gave.
    pub(super) fn outside_of_files(origin: &str, problem: Problem) -> Self {
        let mut error = Self::unreadable(origin, problem.fault.to_string(), &problem.expected);
        error.key = Some(problem.path);
        error.advise(problem.advice)
    }

    /// What the RON reader found wrong, in our words.
    pub(super) fn from_ron(file: &str, text: &str, error: &ron::error::SpannedError) -> Self {
        let outline = Outline::new(text);
        let start = byte_at(text, error.span.start.line, error.span.start.col);
        let end = byte_at(text, error.span.end.line, error.span.end.col);
        // The reader stands before the white space that leads to the token it refuses.
        let blank = text[start..].len() - text[start..].trim_start().len();
        let at = (start + blank).min(end.max(start));
        let finding = Finding {
            file,
            text,
            outline: &outline,
            at,
        };
        finding.explain(&error.code)
    }

    fn describe(&self) -> String {
        let mut text = self.file.clone();
        if let Some((line, _)) = &self.line {
            text += &format!(", line {line}");
        }
        text += ": ";
        if let Some(key) = &self.key {
            text += &format!("`{key}` ");
        }
        text += &self.fault;
        if !self.expected.is_empty() {
            text += &format!("; expected {}", self.expected);
        }
        if let Some(advice) = &self.advice {
            text += &format!(". {advice}");
        }
        if let Some((line, written)) = &self.line {
            text += &format!("\n  {line} | {written}");
        }
        text
    }
}

/// A mistake in a value, before it is known where the value stands.
#[derive(Debug)]
pub(super) struct Problem {
    /// Path of the key.
    pub path: String,
    /// What is wrong.
    pub fault: Fault,
    /// What was expected.
    pub expected: String,
    /// What to do where that is not obvious.
    pub advice: Option<String>,
}

/// What is wrong with a key.
#[derive(Debug)]
pub(super) enum Fault {
    /// It has this value, here in SI units.
    Value(String),
    /// Something else, a phrase of which the key is the subject.
    Other(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(value) => write!(f, "is {value}"),
            Self::Other(phrase) => f.write_str(phrase),
        }
    }
}

impl Problem {
    pub fn new(
        path: impl Into<String>,
        fault: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            path: path.into(),
            fault: Fault::Other(fault.into()),
            expected: expected.into(),
            advice: None,
        }
    }

    /// The value of `path` is not what was expected.
    pub fn value(
        path: impl Into<String>,
        value: impl fmt::Display,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            fault: Fault::Value(value.to_string()),
            ..Self::new(path, "", expected)
        }
    }

    pub fn advise(mut self, advice: impl Into<String>) -> Self {
        self.advice = Some(advice.into());
        self
    }

    /// The `name` at `path` is none of the `known` ones.
    pub fn unknown_name<'a>(
        path: impl Into<String>,
        what: &str,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        let mut problem = Self::new(
            path,
            format!("names {what} `{}`, which does not exist", shorten(name, 40)),
            one_of(&known),
        );
        problem.advice = suggestion(name, &known);
        problem
    }
}

/// `a`, `a or b`, `one of a, b, c`, each in code quotes.
pub(super) fn one_of(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [one, other] => format!("{one} or {other}"),
        many => format!("one of {}", many.join(", ")),
    }
}

/// `Did you mean …?` where one of the `known` names is near.
pub(super) fn suggestion(name: &str, known: &[&str]) -> Option<String> {
    let longest = 1 + name.chars().count() / 3;
    known
        .iter()
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= longest)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| format!("Did you mean `{candidate}`?"))
}

/// Characters to insert, drop or replace to turn `a` into `b`, whatever their case (Levenshtein).
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.to_lowercase().chars().take(100).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

/// A mistake that the RON reader found at the byte `at`.
struct Finding<'a> {
    file: &'a str,
    text: &'a str,
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
            E::ExpectedDifferentLength { .. } => self.wrong_length("too few elements"),
            E::ExpectedStructLikeEnd => self.wrong_length("too many elements"),
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
        let mut error = self.error(entry, fault, one_of(expected));
        error.value = None;
        error.key.get_or_insert_with(|| found.to_owned());
        error.advise(suggestion(found, expected))
    }

    fn missing_key(&self, field: &str) -> SceneError {
        if let Some(holder) = self.outline.holding(self.at) {
            let fault = format!("has no `{field}`");
            return self.error(Some(holder), fault, meaning(field).to_owned());
        }
        let fault = "is missing from the scene".to_owned();
        let mut error = self.error(None, fault, meaning(field).to_owned());
        error.key = Some(field.to_owned());
        error
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
    fn wrong_length(&self, fault: &str) -> SceneError {
        let element = self.outline.holding(self.at);
        let entry = element.and_then(|e| self.outline.find(e.path.trim_end_matches(INDEX)));
        let expected = entry.map_or("", |e| meaning(last_key(&e.path)));
        self.error(entry, format!("has {fault}"), expected.to_owned())
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
        .at_line(self.text, self.at)
    }

    fn error(&self, entry: Option<&Entry>, fault: String, expected: String) -> SceneError {
        let mut error = SceneError::unreadable(self.file, fault, &expected);
        error.value = entry.map(|e| self.outline.value(e));
        error.key = entry.map(|e| e.path.clone());
        error.at_line(self.text, entry.map_or(self.at, |e| e.start))
    }
}

/// The last name of a path without the unit in it.
fn last_key(path: &str) -> &str {
    let key = path.trim_end_matches(INDEX).rsplit('.').next();
    let key = key.unwrap_or_default();
    key.trim_end_matches("_mm").trim_end_matches("_rpm")
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
        "container" => "`Drum(…)`, `Box(…)`, `Planes([…])` or `Nothing`",
        "grains" => "`Fill(…)` or `List([…])`",
        "species" => "the kinds of grain, `[(radius: 0.003, material: \"glass\")]`",
        "material" => "the name of one of the scene's materials",
        "radius" => "a length in m, or in mm as `radius_mm`",
        "width" => "a length in m, or in mm as `width_mm`",
        "speed" => "rad/s, or turns per minute as `speed_rpm`",
        "position" | "point" | "min" | "max" => "a point `(x, y, z)` in m",
        "velocity" => "`(x, y, z)` in m/s",
        "spin" => "`(x, y, z)` in rad/s",
        "gravity" => "`(x, y, z)` in m/s²",
        "normal" => "the direction `(x, y, z)` towards the grains",
        "between" => "two materials, `(\"glass\", \"drum\")`",
        "normal_stiffness" | "tangential_stiffness" => "a spring's stiffness in N/m",
        "law" => "`HertzMindlin` or `Hooke(…)`",
        "time_step" => "`Automatic` or `Given(…)` with a time in s",
        "duration" | "output_interval" => "a time in s",
        _ => "",
    }
}
