//! What was wrong with a scene, in words a person can act on.

use super::outline::{Outline, OutlineEntry, line_of, shorten};
use std::fmt;

/// Characters of a part of a message at most: whatever a file holds, its mistake is told in a few
/// lines.
const LONGEST: usize = 600;
/// Characters of what was expected at most: every key there is may be named.
const LONGEST_LIST: usize = 2000;

/// A scene that cannot be used: where, what was found, what was expected, what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct SceneError(Box<Mistake>);

/// What a [`SceneError`] tells.
#[derive(Clone, Debug, PartialEq)]
struct Mistake {
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
        &self.0.file
    }

    /// Line of the mistake, counted from 1.
    pub fn line(&self) -> Option<usize> {
        self.0.line.as_ref().map(|line| line.0)
    }

    /// The key that is wrong, with all that lead to it: `grains.species[0].radius`.
    pub fn key(&self) -> Option<&str> {
        self.0.key.as_deref()
    }

    /// The value that is wrong, as written.
    pub fn value(&self) -> Option<&str> {
        self.0.value.as_deref()
    }

    /// What was expected.
    pub fn expected(&self) -> &str {
        &self.0.expected
    }

    /// A file that cannot be read at all.
    pub(crate) fn unreadable(file: &str, fault: impl Into<String>, expected: &str) -> Self {
        Self(Box::new(Mistake {
            file: file.to_owned(),
            line: None,
            key: None,
            value: None,
            fault: fault.into(),
            expected: expected.to_owned(),
            advice: None,
        }))
    }

    pub(super) fn at_line(mut self, text: &str, at: usize) -> Self {
        let line = line_of(text, at);
        let written = text.lines().nth(line - 1).unwrap_or_default();
        self.0.line = Some((line, shorten(written, 100)));
        self
    }

    pub(crate) fn advise(mut self, advice: Option<String>) -> Self {
        self.0.advice = advice;
        self
    }

    /// `problem` with the place in `text` where it stands.
    pub(crate) fn from_problem(file: &str, text: &str, problem: Problem) -> Self {
        let outline = Outline::new(text);
        let entry = outline.find(&problem.path);
        let exact = entry.filter(|e| e.path.starts_with(&problem.path));
        let value = exact.map(|e| outline.value(e));
        let fault = match (problem.fault, &value, exact) {
            (KeyFault::Value(_), Some(written), Some(e)) if e.path == problem.path => {
                format!("is {written}")
            }
            (KeyFault::Value(si), Some(written), _) if si != *written => {
                format!("is {written}, in SI units {si}")
            }
            (fault, ..) => fault.to_string(),
        };
        let error = Self::unreadable(file, fault, &problem.expected).advise(problem.advice);
        match entry {
            Some(entry) if exact.is_some() => error.in_entry(&outline, entry),
            Some(holder) => error.about(problem.path).at_line(text, holder.start),
            None => error.about(problem.path),
        }
    }

    /// `problem` with a value that no file gave.
    pub(crate) fn outside_of_files(origin: &str, problem: Problem) -> Self {
        Self::unreadable(origin, problem.fault.to_string(), &problem.expected)
            .about(problem.path)
            .advise(problem.advice)
    }

    /// The mistake is in `entry`: its key, its value, its line.
    pub(super) fn in_entry(mut self, outline: &Outline, entry: &OutlineEntry) -> Self {
        self.0.key = Some(entry.path.clone());
        self.0.value = Some(outline.value(entry));
        self.at_line(outline.text(), entry.start)
    }

    /// The mistake concerns `key`, which has no value.
    pub(super) fn about(mut self, key: impl Into<String>) -> Self {
        self.0.key = Some(key.into());
        self.0.value = None;
        self
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some((line, _)) = &self.line {
            write!(f, ", line {line}")?;
        }
        f.write_str(": ")?;
        if let Some(key) = &self.key {
            write!(f, "`{}` ", shorten(key, LONGEST))?;
        }
        f.write_str(&shorten(&self.fault, LONGEST))?;
        if !self.expected.is_empty() {
            write!(f, "; expected {}", shorten(&self.expected, LONGEST_LIST))?;
        }
        if let Some(advice) = &self.advice {
            write!(f, ". {}", shorten(advice, LONGEST))?;
        }
        if let Some((line, written)) = &self.line {
            write!(f, "\n  {line} | {written}")?;
        }
        Ok(())
    }
}

/// A mistake in a value, before it is known where the value stands.
#[derive(Debug)]
pub(crate) struct Problem {
    /// Path of the key.
    pub path: String,
    /// What is wrong.
    pub fault: KeyFault,
    /// What was expected.
    pub expected: String,
    /// What to do where that is not obvious.
    pub advice: Option<String>,
}

/// What is wrong with a key.
#[derive(Debug)]
pub(crate) enum KeyFault {
    /// It has this value, here in SI units.
    Value(String),
    /// Something else, a phrase of which the key is the subject.
    Other(String),
}

impl fmt::Display for KeyFault {
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
            fault: KeyFault::Other(fault.into()),
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
            fault: KeyFault::Value(value.to_string()),
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
pub(crate) fn one_of(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [one, other] => format!("{one} or {other}"),
        many => format!("one of {}", many.join(", ")),
    }
}

/// `Did you mean …?` where one of the `known` names is near.
pub(crate) fn suggestion(name: &str, known: &[&str]) -> Option<String> {
    nearest(name, known).map(|nearest| format!("Did you mean `{nearest}`?"))
}

/// The one of the `known` names that `name` may be a slip of.
pub fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let longest = 1 + name.chars().count() / 3;
    let distances = known
        .iter()
        .map(|known| (edit_distance(name, known), *known));
    let near = distances.filter(|(distance, _)| *distance <= longest);
    near.min_by_key(|(distance, _)| *distance)
        .map(|(_, nearest)| nearest)
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
