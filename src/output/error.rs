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
    /// The output folder holds another run, which would be lost.
    #[error(
        "the output folder {} holds another run: {reason}. Choose another folder with --out, or add \
         --restart to replace what it holds", .path.display()
    )]
    OtherRun {
        /// Which folder.
        path: PathBuf,
        /// What is different about it.
        reason: String,
    },
    /// Another program writes to the output folder.
    #[error(
        "the output folder {} is in use by {holder}: wait for it, stop it, or choose another folder \
         with --out", .path.display()
    )]
    Taken {
        /// Which folder.
        path: PathBuf,
        /// Who writes to it.
        holder: String,
    },
    /// A file or folder could not be written.
    #[error("cannot write {}", .path.display())]
    Write {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// What was written to a file cannot be read back.
    #[error("cannot read {}", .path.display())]
    Read {
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
