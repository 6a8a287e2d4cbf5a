//! The program without a window: an app whose systems step a run, progress bars, what is printed.
//!
//! In: a [`crate::runner::Job`] or a [`Sweep`]. Out: their files and a word on the terminal. The
//! run is moved by the same system as in the window, inline and as fast as the machine can; the
//! loop that moves it to its end, records it and stops it is the one of [`crate::runner`].

mod confirm;
mod interruption;
mod pack;
mod program;
mod progress;
mod report;
pub mod terminal;

pub use confirm::confirm;
pub use interruption::{check_threads, interruption};
pub use pack::pack;
pub use program::run;
pub use progress::Progress;
pub use report::{Report, Said};

use crate::runner::RunnerError;
use crate::sweep::{self, Sweep, SweepEnding};
use std::sync::atomic::AtomicBool;

/// Runs `sweep` until every case is done or `interrupted` becomes true; prints progress to standard
/// error and the table to standard output, but where the `report` is to be another.
///
/// # Errors
/// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run_sweep(
    sweep: &Sweep,
    report: Report,
    interrupted: &AtomicBool,
) -> Result<SweepEnding, RunnerError> {
    let mut progress = Progress::of(report);
    let swept = sweep::run(sweep, interrupted, &mut progress);
    progress.finish();
    let swept = swept?;
    report.sweep(sweep, &swept)?;
    Ok(swept.ending)
}
