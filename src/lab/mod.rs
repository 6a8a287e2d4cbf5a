//! Labs: one run or two equal ones side by side, with one clock, changed by one enum of commands.
//!
//! In: a scene or a session, then commands and ticks of wall-clock time. Out: the newest state of
//! each run, what was changed and measured in it, what the lab does. How the work is cut into
//! pieces, and on which thread it is done, does not show in a trajectory.
//!
//! Each row of the table uses only rows below it; a test holds the files to that.
//!
//! | file | holds |
//! |---|---|
//! | `kept` | a session or a recording, told from a scene |
//! | `lab` | what the outside sees and sends commands to |
//! | `driver` | who computes: the caller, or a thread |
//! | `engine` | what the driver moves: commands are dispatched here |
//! | `runs`, `run_view` | the runs, kept at the same step; what the outside sees of each |
//! | `playback` | a recording in the place of runs |
//! | `lab_command`, `update` | what is asked of a lab; what the engine tells the outside |
//! | `clock`, `options` | how far the runs may go; how a lab is opened |
//! | `status`, `half` | what a lab does; left and right |

mod clock;
mod driver;
mod engine;
mod half;
mod kept;
#[expect(
    clippy::module_inception,
    reason = "the lab is what this module is about"
)]
mod lab;
mod lab_command;
mod options;
mod playback;
mod run_view;
mod runs;
mod status;
mod update;

pub use half::Half;
pub use kept::Kept;
pub use lab::{Comparison, Lab};
pub use lab_command::LabCommand;
pub use options::{DriverKind, Options};
pub use run_view::{RunView, SMALLEST_DROP};
pub use status::Status;
pub use update::{RecordedFlow, SavedFile};
