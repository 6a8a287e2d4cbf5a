//! How files hold values of parameters.
//!
//! In: a value. Out: its form in a file, and the value from it. In text files a number is a number
//! and a choice its word. In binary ones, and where hashes are made, each is one `f64`, as it was
//! before choices had words: what was hashed then still has the same hash.

use super::parameter::entries;
use super::value::{Choice, Value};
use serde::de::Visitor;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            _ if !serializer.is_human_readable() => serializer.serialize_f64(self.number()),
            Self::Number(number) => serializer.serialize_f64(*number),
            Self::Count(count) => serializer.serialize_u64(*count),
            Self::Choice(choice) => serializer.serialize_str(choice.key),
        }
    }
}

impl<'de> Deserialize<'de> for Value {
    /// A choice comes out of a binary file as its number, and as a choice of the first parameter
    /// that has its word out of a text: [`super::Parameter::typed`] makes of both what is meant.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(NumberOrWord)
        } else {
            f64::deserialize(deserializer).map(Self::Number)
        }
    }
}

struct NumberOrWord;

impl Visitor<'_> for NumberOrWord {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or the word of a choice")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
        Ok(Value::Number(number))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
        Ok(Value::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
        Ok(Value::Number(number as f64))
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Value, E> {
        let choice = choices().find(|choice| choice.key == word);
        choice.map(Value::Choice).ok_or_else(|| {
            let known: Vec<&str> = choices().map(|choice| choice.key).collect();
            E::custom(format!(
                "`{word}` is no value; expected a number, or a word of {}",
                known.join(", ")
            ))
        })
    }
}

/// Every choice of every parameter.
fn choices() -> impl Iterator<Item = &'static Choice> {
    let kinds = entries().iter().map(|entry| &entry.row.kind);
    kinds.flat_map(super::parameter_row::Kind::choices)
}
