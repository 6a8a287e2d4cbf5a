//! Why a run's files cannot be written.

use std::io;
use std::path::{Path, PathBuf};

/// Why a run's files cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The output folder holds somebody else's files.
    #[error(
        "the output folder {} holds files that are not a run's: choose another with --out, or empty \
         it", .0.display()
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

impl OutputError {
    /// That `path` could not be written because of `source`.
    pub fn write(path: &Path, source: io::Error) -> Self {
        Self::Write {
            path: path.to_owned(),
            source,
        }
    }
}
