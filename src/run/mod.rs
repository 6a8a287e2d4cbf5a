//! A run: the trajectory of a scene, and all that is kept of it.
//!
//! In: a scene and commands. Out: states, samples, records that can be verified. [`Run`] knows
//! nothing of wall-clock time, frames or threads: the same scene, seed and commands give the same
//! bits.
//!
//! Each row of the table uses only rows below it; a test holds the files to that.
//!
//! | file | holds |
//! |---|---|
//! | `opening` | the moments at which scenes open in a window |
//! | `session` | all branches of a run in one file |
//! | `session_tail` | what later layouts of that file added |
//! | `timeline` | all branches of a run: seek, branch, undo |
//! | `soundness` | whether what a file kept of a run is what a run can be |
//! | `archive`, `keyframes` | a timeline as a file keeps it; states along all branches |
//! | `events` | what happened, and when: impacts, avalanches, changes … |
//! | `kept_memory` | what a run keeps in memory by design |
//! | `past`, `undo` | what is told of a timeline; what can be taken back |
//! | `estimate` | what a scene asks of a machine, before any work |
//! | `preparation`, `settling`, `bed` | from a scene to a settled bed at time zero; where beds are kept |
//! | `trajectory`, `check` | the run itself: world, solver, commands, samples; what it refuses |
//! | `branch`, `history` | what is known of a branch; its changes, and what tells it from others |
//! | `snapshot` | where a run stood, in memory or in a file |
//! | `orientations` | how far spheres have turned, for pictures |
//! | `method` | which solver and measures computed a run |
//! | `step_costs` | what shorter and longer steps changed in whole beds |
//! | `machine` | what a machine has left; work that gives way |
//! | `tables` | what the columns of tables hold, for programs that read them |
//! | `measured` | what was measured, and how much of it stands in files |
//! | `meetings` | which of few grains met and parted, and when |
//! | `pieces`, `sampling` | a long way cut into pieces; when samples are taken |
//! | `branch_names` | what people called branches |
//! | `provenance`, `record` | where a file came from; a state and what leads to it, as files state it |
//! | `script` | commands that are carried out by themselves: replay |
//! | `rescue` | what a window was about, for the case that it ends unasked |
//! | `steps` | which step was when, where the time step changed |
//! | `changes` | which parameters each change set |
//! | `command` | everything a person can ask for |
//! | `shared` | what is shared in memory, in a file |

mod archive;
mod bed;
mod branch;
mod branch_names;
mod changes;
mod check;
mod command;
mod estimate;
mod events;
mod history;
mod kept_memory;
mod keyframes;
mod machine;
mod measured;
mod meetings;
mod method;
mod opening;
mod orientations;
mod past;
mod pieces;
mod preparation;
mod provenance;
mod record;
mod rescue;
mod sampling;
mod script;
mod session;
mod session_tail;
mod settling;
mod shared;
mod snapshot;
mod soundness;
mod step_costs;
mod steps;
mod tables;
mod timeline;
mod trajectory;
mod undo;

pub use crate::parameters::{
    Parameter, ParameterInfo, Value, Values, live_parameters, start_parameters, time_step,
};
pub use crate::physics::DisplayUnit;
pub use crate::scene::SAMPLE_INTERVAL;
#[cfg(test)]
pub(crate) use bed::BedKey;
pub use bed::BedStore;
pub use branch::Branch;
pub use branch_names::BranchNames;
pub use changes::{Change, Setting, changes};
pub use check::CommandError;
pub(crate) use check::accept;
pub use command::{Command, StampedCommand};
pub use estimate::{BeyondMachine, Estimate};
pub use events::{Event, EventKind, Happening, Pair, events};
pub use history::{History, Moment};
pub use kept_memory::KeptMemory;
pub(crate) use machine::give_way;
pub use machine::{available_threads, resident_memory};
pub use measured::{Measured, Stored};
pub use meetings::{MOST_MEETINGS, Meeting, MeetingKind};
pub use method::method;
pub use opening::{Opening, OpeningError, opening, openings};
pub use orientations::Turned;
pub use past::Past;
pub use pieces::Pieces;
pub use preparation::{BedError, Preparation, Prepared, make_bed};
pub use provenance::{Provenance, printable};
pub use record::{RunRecord, VERSION, fingerprint};
pub use rescue::Rescue;
pub use sampling::Sampling;
pub use script::{Script, ScriptError, ScriptedCommand};
pub use session::{SESSION_EXTENSION, Session, SessionError};
pub use snapshot::{Checkpoint, CheckpointParts, Snapshot};
pub use step_costs::{MeasuredBed, MeasuredResult, MeasuredStep};
pub use steps::StepTimes;
pub use tables::{Cells, Column, TABLES_METADATA, Table, write_metadata};
pub use timeline::Timeline;
pub use trajectory::Run;
pub use undo::Changed;
