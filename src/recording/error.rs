//! Why a folder or a state in it cannot be shown.

use std::path::{Path, PathBuf};

/// Why a folder or a state in it cannot be shown: which file, and what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", .path.display())]
pub struct RecordingError {
    path: PathBuf,
    reason: String,
}

impl RecordingError {
    /// That the file at `path` is wrong in this way, a phrase behind its name.
    pub fn of(path: &Path, reason: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }
}
