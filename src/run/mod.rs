//! A run: the trajectory of a scene, and all that is kept of it.
//!
//! In: a scene and commands. Out: states, samples, records that can be verified. [`Run`] knows nothing of wall-clock time,
//! frames or threads: the same scene, seed and commands give the same bits.
//!
//! | file | holds |
//! |---|---|
//! | `command` | everything a person can ask for |
//! | `parameter`, `relabel` | the numbers that can change while a run goes on, and how they change a world |
//! | `start` | the numbers that act from the next start on |
//! | `steps` | which step was when, where the time step changed |
//! | `script` | commands that are carried out by themselves: replay |
//! | `trajectory` | the run itself: world, solver, samples, snapshots |
//! | `pieces` | a long way cut into pieces of about the same wall-clock time |
//! | `timeline` | all branches of a run: seek, branch, undo |
//! | `branch`, `history`, `undo`, `keyframes` | what is known of a branch, what tells branches apart, what can be taken back, states along them |
//! | `preparation`, `settling`, `bed` | from a scene to a settled bed at time zero, and where beds are kept |
//! | `session`, `archive`, `shared` | all of that in one file |
//! | `claim`, `provenance` | a state and what leads to it, as files state it; in a few words, for exported files |

mod archive;
mod bed;
mod branch;
mod claim;
mod command;
mod history;
mod keyframes;
mod parameter;
mod pieces;
mod preparation;
mod provenance;
mod relabel;
mod script;
mod session;
mod settling;
mod shared;
mod start;
mod steps;
mod timeline;
mod trajectory;
mod undo;

pub use bed::BedStore;
pub use branch::Branch;
pub use claim::{Claim, VERSION, fingerprint};
pub use command::{Command, Parameter, StampedCommand};
pub use history::{History, Moment};
pub(crate) use parameter::time_step;
pub use parameter::{DisplayUnit, ParameterInfo};
pub use pieces::Pieces;
pub use preparation::{BedError, Preparation, Prepared, make_bed};
pub use provenance::{Provenance, TABLES_METADATA};
pub use script::{Script, ScriptError, ScriptedCommand};
pub use session::{SESSION_EXTENSION, Session, SessionError};
pub use start::{StartInfo, StartParameter, start_parameters};
pub use steps::StepTimes;
pub use timeline::{Past, Timeline};
pub(crate) use trajectory::check;
pub use trajectory::{Checkpoint, CommandError, Run, SAMPLE_INTERVAL, Snapshot};
pub use undo::Changed;
