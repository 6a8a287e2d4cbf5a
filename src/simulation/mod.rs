//! A run and the Bevy plugin that steps it.
//!
//! [`Run`] is the trajectory: a scene, its world, the solver, the commands carried out and the samples taken. It knows
//! nothing of wall-clock time, frames or threads: the same scene, seed and commands give the same bits. [`Simulation`] is
//! what panels and views see of it; a driver moves the run on, inline or on its own thread.
//!
//! | file | holds |
//! |---|---|
//! | `command` | everything a person can ask for |
//! | `parameter`, `relabel` | the numbers that can change while a run goes on, and how they change a world |
//! | `start` | the numbers that act from the next start on |
//! | `script` | commands that are carried out by themselves: replay |
//! | `run` | the trajectory, samples, snapshots |
//! | `timeline` | runs as something to hold: seek, branch, undo |
//! | `history`, `keyframes` | what tells runs apart and what is known of them; states to come back to |
//! | `preparation`, `settling`, `bed` | from a scene to a settled bed at time zero, and where beds are kept |
//! | `session`, `archive`, `shared` | all of that in one file |
//! | `claim`, `provenance` | a state and what leads to it, as files state it; in a few words, for exported files |
//! | `engine`, `driver` | who moves a run on, in short pieces, inline or on a thread |
//! | `twin` | a second run beside the first, in step with it |
//! | `front`, `plugin` | what the outside sees, and the Bevy system that ticks it |

mod archive;
mod bed;
mod claim;
mod command;
mod driver;
mod engine;
mod front;
mod history;
mod keyframes;
mod parameter;
mod plugin;
mod preparation;
mod provenance;
mod relabel;
mod run;
mod script;
mod session;
mod settling;
mod shared;
mod start;
mod timeline;
mod twin;

pub use bed::BedStore;
pub use claim::{Claim, VERSION, fingerprint};
pub use command::{Command, Parameter, StampedCommand};
pub use engine::SavedFile;
pub use front::{DriverKind, Options, SMALLEST_DROP, Simulation, Status};
pub use history::{History, Moment, Record};
pub use parameter::{DisplayUnit, ParameterInfo};
pub use plugin::{SimulationPlugin, SimulationSystems, advance_simulation};
pub use preparation::{Preparation, Prepared, make_bed};
pub use provenance::{Provenance, TABLES_METADATA};
pub use run::{Checkpoint, CommandError, Run, SAMPLE_INTERVAL, Snapshot};
pub use script::{Script, ScriptError, ScriptedCommand};
pub use session::{SESSION_EXTENSION, Session, SessionError};
pub use start::{StartInfo, StartParameter, start_parameters};
pub use timeline::{Changed, Past, Timeline};
pub use twin::{Half, Twin};

use run::check;
