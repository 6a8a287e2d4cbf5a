//! Everything that can be asked of a lab, as one enum.
//!
//! In: what a person, a script or the window asks for. Out: a [`LabCommand`] for
//! [`super::Lab::send`], which is the only way to change a lab. What each command does is decided
//! by the engine, not here.

use super::Half;
use crate::run::{Command, Parameter, Stored, Value};
use std::path::PathBuf;

/// Everything that can be asked of a lab.
#[derive(Clone, Debug, PartialEq)]
pub enum LabCommand {
    /// Carry this out in every run, at the same step. A value of the parameter that a comparison is
    /// about concerns the left run alone, and so does the list of branches.
    All(Command),
    /// Give a parameter a value in one of the runs; the other notes it, so that an undo is of both.
    SetIn {
        /// In which one.
        half: Half,
        /// Which parameter.
        parameter: Parameter,
        /// Its new value.
        value: Value,
    },
    /// What is set from here on is one change: of one drag, or of one button that sets several
    /// parameters.
    OpenChange,
    /// What is set from here on is another change.
    CloseChange,
    /// Start two runs side by side at time zero, with the present values of all parameters but one.
    Compare {
        /// What the two differ in: it keeps its present value in the left run.
        parameter: Parameter,
        /// Its value in the right run.
        value: Value,
    },
    /// Go on with one of the two runs and keep the other as a branch of it.
    EndComparison {
        /// The run to go on with.
        keep: Half,
    },
    /// Call a branch by a name; an empty one takes its name away.
    NameBranch {
        /// In which run's list it is.
        half: Half,
        /// Its number.
        number: u32,
        /// Its name.
        name: String,
    },
    /// Write the session to a file: every run with its branches.
    Save {
        /// The file.
        path: PathBuf,
        /// How the window looks, in its own words.
        look: String,
    },
    /// Write the session to a file for the case that the program ends unasked
    /// ([`crate::run::Rescue`]): it does not count as saved.
    Rescue {
        /// The file.
        path: PathBuf,
        /// How the window looks, in its own words.
        look: String,
    },
    /// Go no further than this step for now, or as far as the clock allows.
    Hold(Option<u64>),
    /// Forget so much of what was measured: it stands in files, and nobody goes back.
    ForgetMeasured(Stored),
    /// Measure the mean flow of the recording that is played, on its states.
    MeasureFlow,
    /// Work on so many threads in all.
    Threads(usize),
}

impl From<Command> for LabCommand {
    fn from(command: Command) -> Self {
        Self::All(command)
    }
}
