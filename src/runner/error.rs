//! What can go wrong with a run beside the physics.

use super::exit;
use crate::output::OutputError;
use crate::scene::SceneError;

/// Why a run could not be done or its files not be written.
#[derive(Debug, thiserror::Error)]
pub enum RunnerError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The input asks for something that cannot be.
    #[error("{0}")]
    Input(String),
    /// The machine has not what it takes.
    #[error("{0}")]
    System(String),
    /// The files cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl RunnerError {
    /// The same, saying of bad input that it was met in the run called `name`.
    #[must_use]
    pub fn within(self, name: &str) -> Self {
        match self {
            Self::Input(reason) => Self::Input(format!("{name}: {reason}")),
            other => other,
        }
    }

    /// What the process ends with: 2 for bad input, 5 where another program writes to the output
    /// folder, 1 for the rest.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(_)
            | Self::Input(_)
            | Self::Output(OutputError::ForeignFolder(_) | OutputError::OtherRun { .. }) => {
                exit::BAD_INPUT
            }
            Self::Output(OutputError::Taken { .. }) => exit::IN_USE,
            Self::System(_)
            | Self::Output(OutputError::Write { .. } | OutputError::Read { .. }) => {
                exit::NOT_WRITTEN
            }
        }
    }
}
