//! Single values: numbers within their limits, vectors, names, how many of a kind.
//!
//! In: a value and the path of its key. Out: nothing, or a [`Problem`] with what was expected.

use crate::physics::limits::{self, Limits};
use crate::scene::error::Problem;
use glam::DVec3;

/// Nothing, or the first mistake.
pub(in crate::scene) type Checked = Result<(), Problem>;

/// Materials, species, planes or pairs a scene may have.
pub(super) const MOST_KINDS: usize = 200;

/// Refuses a `value` of the key at `path` that is not within `limits`.
pub(in crate::scene) fn within(
    limits: &Limits,
    value: f64,
    path: impl FnOnce() -> String,
) -> Checked {
    if limits.accept(value) {
        Ok(())
    } else {
        Err(Problem::value(
            path(),
            format!("{value:?}"),
            limits.expected,
        ))
    }
}

pub(in crate::scene) fn fraction(path: &str, value: f64) -> Checked {
    within(&limits::FRACTION, value, || path.to_owned())
}

/// A vector whose components are numbers no larger than `largest`.
pub(super) fn vector(v: DVec3, largest: f64, unit: &str, path: impl FnOnce() -> String) -> Checked {
    if v.to_array().iter().all(|x| x.abs() <= largest) {
        return Ok(());
    }
    Err(Problem::value(
        path(),
        shown(v),
        format!("three numbers between -{largest} and {largest} {unit}"),
    ))
}

pub(super) fn shown(v: DVec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

pub(super) fn check_number(path: &str, what: &str, number: usize) -> Checked {
    if (1..=MOST_KINDS).contains(&number) {
        return Ok(());
    }
    Err(Problem::new(
        path,
        format!("has {number} {what}"),
        format!("between 1 and {MOST_KINDS} {what}"),
    ))
}

/// Names become parts of keys such as `friction.glass.drum`.
pub(super) fn check_name(name: &str, path: impl FnOnce() -> String) -> Checked {
    let fits = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if (1..=40).contains(&name.chars().count()) && name.chars().all(fits) {
        return Ok(());
    }
    Err(Problem::new(
        path(),
        format!("is not a usable name: {name:?}"),
        "1 to 40 letters, digits, `-` or `_`",
    ))
}

pub(super) fn twice(path: String, what: &str, name: &str) -> Problem {
    Problem::new(
        path,
        format!("gives {what} called `{name}` a second time"),
        "each name once",
    )
}
