//! The program without a window: an app whose systems step a run, progress bars, what is printed.
//!
//! In: a [`grainfall::runner::Job`], a [`grainfall::sweep::Sweep`] or a [`grainfall::paper::PaperJob`]. Out: their files and a word on the terminal. The
//! run is moved by the same system as in the window, inline and as fast as the machine can; the
//! loop that moves it to its end, records it and stops it is the one of [`grainfall::runner`].

mod allowed;
pub mod command_line;
mod confirm;
mod export;
mod import;
mod interruption;
mod named_scene;
mod pack;
mod paper_task;
mod program;
mod progress;
mod report;
mod shell;
mod sweep_task;
pub mod terminal;
mod time_steps;

pub use allowed::Allowed;
pub use confirm::confirm;
pub use export::hand_over;
pub use import::ImportTask;
pub use interruption::{check_threads, heard, interruption};
pub use named_scene::{named_scene, short_name};
pub use pack::{write_bed, write_openings, write_packing};
pub use paper_task::PaperTask;
pub use program::{RunInApp, finish, run};
pub use progress::Progress;
pub use report::{Report, Said};
pub use shell::{misspelt_command, print_completions, write_manual};
pub use sweep_task::SweepTask;
pub use time_steps::list_time_steps;
