//! The papers' claims on whole runs. They take minutes each, so that they run only when asked for:
//! `cargo test --release --test papers -- --ignored --nocapture`.

mod kasper2021;
mod man2023;

use grainfall::measure::{ResultKey, Summary};

/// The result `key`, printed too.
#[track_caller]
fn value(summary: &Summary, key: impl Into<ResultKey>) -> f64 {
    let key = key.into();
    let value = summary.value(key).unwrap_or(f64::NAN);
    println!("{}: {value:.4e}", key.name());
    value
}
