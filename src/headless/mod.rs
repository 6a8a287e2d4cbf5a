//! The program without a window: an app whose systems step a run, progress bars, what is printed.
//!
//! In: a [`crate::runner::Job`] or a [`Sweep`]. Out: their files and a word on the terminal. The
//! run is moved by the same system as in the window, inline and as fast as the machine can; the
//! loop that moves it to its end, records it and stops it is the one of [`crate::runner`].

mod pack;
mod program;
mod progress;
mod report;

pub use pack::pack;
pub use program::run;
pub use progress::Progress;

use crate::runner::RunnerError;
use crate::sweep::{self, Sweep, SweepEnding};
use std::sync::atomic::AtomicBool;

/// Runs `sweep` until every case is done or `interrupted` becomes true; prints progress to standard
/// error and the table to standard output.
///
/// # Errors
/// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run_sweep(sweep: &Sweep, interrupted: &AtomicBool) -> Result<SweepEnding, RunnerError> {
    let mut progress = Progress::on_stderr();
    let swept = sweep::run(sweep, interrupted, &mut progress);
    progress.finish();
    let swept = swept?;
    print!("{}", swept.table);
    println!("results in {}", sweep.out.display());
    Ok(swept.ending)
}
