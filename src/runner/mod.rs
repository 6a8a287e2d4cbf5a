//! A scene run to its end: the one loop that prepares, advances, records, keeps checkpoints and
//! stops when it is told to.
//!
//! In: a [`Job`], or a file that states a state to come to. Out: the files of an output folder and
//! a [`Finished`], or a [`Verdict`]. Runs without a window, cases of a sweep and `grainfall verify`
//! all go through here. Not here: printing, and the app whose systems step a run (see `headless`).
//!
//! Each row of the table uses only rows below it.
//!
//! | file | holds |
//! |---|---|
//! | `verify` | computing again what a file states |
//! | `drive` | the loop, and how a run ended |
//! | `checkpoint` | going on after a stop |
//! | `rest` | ending when a column is at rest |
//! | `log` | what was measured, in files that grow |
//! | `advance` | what the loop moves: a run in short pieces |
//! | `job` | what to run and where its files go |
//! | `setting`, `commands_file` | `--set`, `--commands`: what is changed about a run |
//! | `error` | what can go wrong |
//! | `exit` | what the process ends with |
//! | `watch` | hearing how far a run has come |

mod advance;
mod checkpoint;
mod commands_file;
mod drive;
mod error;
pub mod exit;
mod job;
mod log;
mod rest;
mod setting;
mod verify;
mod watch;

pub use advance::{Advance, At, DirectRun, Halt};
pub use commands_file::read_commands;
pub use drive::{Finished, Runner, Standing, look, run, standing};
pub use error::RunnerError;
pub use job::{Job, spare_threads};
pub use setting::{apply_settings, compared_value, live_command};
pub use verify::{Verdict, VouchedFiles, check_digests};
pub use watch::{Part, Watch, spoken};

#[cfg(test)]
mod faults;
#[cfg(test)]
mod forgetting;
