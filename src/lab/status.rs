//! What a lab does now, as one value for buttons and status lines.

use crate::solver::Fault;

/// What a lab does now.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// There is no state at time zero yet.
    Preparing {
        /// What is being done.
        stage: String,
        /// How far it has come, 0 … 1.
        progress: f32,
    },
    /// It is computing the way to the step that was asked for.
    Seeking {
        /// How much of the way is done, 0 … 1.
        progress: f32,
    },
    /// It holds.
    Paused,
    /// It goes on.
    Running,
    /// The solver met an absurd state; the last good one is shown, none where the bed was still
    /// settling.
    Faulted(Fault),
    /// There is no run, for the reason given.
    Failed(String),
}

impl Status {
    /// What is said before anything is heard of the engine.
    pub(super) fn starting() -> Self {
        Self::Preparing {
            stage: "starting".into(),
            progress: 0.0,
        }
    }
}
