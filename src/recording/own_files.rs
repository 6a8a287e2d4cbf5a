//! The files of a run's folder, each with the digest that its record states.
//!
//! In: names out of the folder's own lists. Out: their bytes, and whether they are as they were
//! written. A name leads to a regular file in the folder or in a folder of it, and nowhere else: no
//! list opens anything above, nor a link.

use super::RecordingError;
use crate::files::read_whole;
use crate::output::{digest_of, is_own_name};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct OwnFiles {
    folder: PathBuf,
    /// The digests that its record states, by name.
    digests: BTreeMap<String, String>,
}

/// A file that was read.
pub struct OwnFile {
    /// Where it is.
    pub path: PathBuf,
    /// All of it.
    pub bytes: Vec<u8>,
    /// Whether it is another than its record states; not, where that states nothing of it.
    pub is_altered: bool,
}

impl OwnFiles {
    /// Those of `folder`, of which a record states these `digests`.
    pub fn new(folder: PathBuf, digests: BTreeMap<String, String>) -> Self {
        Self { folder, digests }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Whether there is a file called `name`.
    pub fn has(&self, name: &str) -> bool {
        self.folder.join(name).is_file()
    }

    /// The file called `name`, `most` bytes of it at most.
    ///
    /// # Errors
    /// When that is no name of a file in the folder, or it cannot be read.
    pub fn read(&self, name: &str, most: u64) -> Result<OwnFile, RecordingError> {
        let path = self.folder.join(name);
        let refuse = |reason: String| RecordingError::of(&path, reason);
        if !is_own_name(name) {
            return Err(RecordingError::of(
                &self.folder,
                format!("{name:?} is no name of a run's file"),
            ));
        }
        let unread = |error| refuse(format!("cannot be read: {error}"));
        let found = fs::symlink_metadata(&path).map_err(unread)?;
        if found.is_symlink() {
            return Err(refuse(
                "is a link, and a run writes files: nothing elsewhere is read".into(),
            ));
        }
        let bytes = read_whole(&path, most).map_err(unread)?;
        let stated = self.digests.get(name);
        let is_altered = stated.is_some_and(|stated| *stated != digest_of(&bytes));
        Ok(OwnFile {
            path,
            bytes,
            is_altered,
        })
    }
}

impl OwnFile {
    /// What is to be said of it, if it was altered.
    pub fn note(&self) -> Option<String> {
        let path = self.path.display();
        (self.is_altered).then(|| format!("{path} is not as it was written"))
    }
}
