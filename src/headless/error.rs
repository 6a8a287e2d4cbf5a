//! What can go wrong with a headless run beside the physics.

use crate::scene::SceneError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a headless run could not be done or its files not be written.
#[derive(Debug, thiserror::Error)]
pub enum HeadlessError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The input asks for something that cannot be.
    #[error("{0}")]
    Input(String),
    /// The output folder holds somebody else's files.
    #[error(
        "the output folder {} holds files that are not a run's: choose another with --out, or empty it", .0.display()
    )]
    ForeignFolder(PathBuf),
    /// A file or folder could not be written.
    #[error("cannot write {}", .path.display())]
    Write {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl HeadlessError {
    /// That `path` could not be written because of `source`.
    pub(super) fn write(path: &Path, source: io::Error) -> Self {
        Self::Write {
            path: path.to_owned(),
            source,
        }
    }

    /// What the process ends with: 2 for bad input, 1 for the rest.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(_) | Self::Input(_) | Self::ForeignFolder(_) => 2,
            Self::Write { .. } => 1,
        }
    }
}
