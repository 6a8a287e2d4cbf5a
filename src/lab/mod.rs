//! Labs: one run or two equal ones side by side, with one clock, changed by one enum of commands.
//!
//! In: a scene or a session, then commands and ticks of wall-clock time. Out: the newest state of each run, what was
//! changed and measured in it, what the lab does. How the work is cut into pieces, and on which thread it is done, does
//! not show in a trajectory.
//!
//! | file | holds |
//! |---|---|
//! | `lab`, `run_view` | what the outside sees: the lab, and each of its runs |
//! | `command`, `options`, `status`, `half` | what is asked of a lab, how it is opened, what it does, left and right |
//! | `driver` | who computes: the caller, or a thread |
//! | `engine`, `clock` | what the driver moves: commands are dispatched here; how far the runs may go |
//! | `runs` | the runs themselves, kept at the same step |
//! | `update` | what the engine tells the outside |

mod clock;
mod command;
mod driver;
mod engine;
mod half;
#[expect(
    clippy::module_inception,
    reason = "the lab is what this module is about"
)]
mod lab;
mod options;
mod run_view;
mod runs;
mod status;
mod update;

pub use command::LabCommand;
pub use half::Half;
pub use lab::{Comparison, Lab};
pub use options::{DriverKind, Options};
pub use run_view::{RunView, SMALLEST_DROP};
pub use status::Status;
pub use update::SavedFile;
