//! The papers' claims on whole runs. They take minutes each, so that they run only when asked for:
//! `cargo test --release --test papers -- --ignored --nocapture`.

mod kasper2021;
mod man2023;

use grainfall::measure::Summary;

/// The result `name`, printed too.
#[track_caller]
fn value(summary: &Summary, name: &str) -> f64 {
    let value = summary.value(name).unwrap_or(f64::NAN);
    println!("{name}: {value:.4e}");
    value
}
