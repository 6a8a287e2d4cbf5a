//! Values of parameters: a number, a count or one of some named choices.
//!
//! In: numbers and words, from text, files or code. Out: a [`Value`] that says which of the three
//! it is. Whether a parameter takes such a value is [`super::Parameter::typed`]'s to say, and how
//! files hold it stands in `stored`.

use std::fmt;

/// A value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number in the parameter's SI unit.
    Number(f64),
    /// How many.
    Count(u64),
    /// One of the parameter's choices.
    Choice(&'static Choice),
}

/// One of the values between which a parameter lets choose.
#[derive(Debug, PartialEq)]
pub struct Choice {
    /// Its word in files and for `--set`.
    pub key: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// The number that stands for it in binary files, and in those written before it had a word.
    pub number: f64,
}

impl Value {
    /// It as a number: that of a choice is the one that stands for it in files.
    pub fn number(self) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Count(count) => count as f64,
            Self::Choice(choice) => choice.number,
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<u64> for Value {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<&'static Choice> for Value {
    fn from(choice: &'static Choice) -> Self {
        Self::Choice(choice)
    }
}

impl PartialEq<f64> for Value {
    fn eq(&self, number: &f64) -> bool {
        matches!(self, Self::Number(own) if own == number)
    }
}

impl fmt::Display for Value {
    /// As `--set` takes it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Count(count) => write!(f, "{count}"),
            Self::Choice(choice) => f.write_str(choice.key),
        }
    }
}
