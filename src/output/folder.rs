//! A run's output folder: one run's files, and one program at a time that writes them.
//!
//! In: a path. Out: a locked folder that holds one run's files and nothing of an earlier run's. A
//! folder that holds anything but an earlier run is left alone: see [`OutputError::ForeignFolder`].
//! Of what is in a run's folder, only files by the names that runs give are ever removed.

use super::OutputError;
use super::digest::Digested;
use crate::files::{
    FolderLock, GrowingFile, LOCK, LockError, check_target, is_temporary, make_folder, read_whole,
    remove_file, sync_file, sync_folder, write_whole, write_whole_unsynced,
};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};

/// The file that says a folder is a run's.
pub const SUMMARY: &str = "summary.json";
/// The file from which a run that was stopped goes on.
pub const CHECKPOINT: &str = "checkpoint.bin";
/// The samples that belong to [`CHECKPOINT`].
pub const SAMPLES: &str = "checkpoint-samples.bin";
/// The profiles of the flowing layer that belong to [`CHECKPOINT`].
pub const PROFILES: &str = "checkpoint-profiles.bin";
/// Times and digests of the frames that belong to [`CHECKPOINT`].
pub const FRAME_LOG: &str = "checkpoint-frames.bin";
/// Largest summary that is read [bytes].
const LARGEST: u64 = 256 << 20;
/// The kinds of frames, each with a folder of its own.
pub const FRAMES: [&str; 2] = ["grains", "contacts"];
/// What [`SUMMARY`] contains in a run's folder.
const MARK: &[u8] = b"\"program\": \"grainfall\"";

/// Where a run's files go.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    lock: FolderLock,
}

impl OutputFolder {
    /// Makes the folder where it is missing, and locks it. What is in it stays as it is.
    ///
    /// # Errors
    /// When it holds other files than a run's, another program writes to it, or it cannot be
    /// written.
    pub fn lock(path: &Path) -> Result<Self, OutputError> {
        let failed = |source| OutputError::write(path, source);
        if path.exists() && is_foreign(path).map_err(failed)? {
            return Err(OutputError::ForeignFolder(path.to_owned()));
        }
        make_folder(path).map_err(failed)?;
        let lock = FolderLock::of(path).map_err(|error| match error {
            LockError::Taken(holder) => OutputError::Taken {
                path: path.to_owned(),
                holder,
            },
            LockError::Unwritten(source) => OutputError::write(&path.join(LOCK), source),
        })?;
        Ok(Self {
            path: path.to_owned(),
            lock,
        })
    }

    /// What people should know of it, in sentences.
    pub fn warning(&self) -> Option<String> {
        (!self.lock.holds()).then(|| {
            format!(
                "the file system of {} has no locks: see to it that no other run writes there",
                self.path.display()
            )
        })
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the summary in it states; nothing where there is none.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn summary(&self) -> Result<Value, OutputError> {
        let path = self.path.join(SUMMARY);
        if !path.exists() {
            return Ok(Value::Null);
        }
        let bytes = read_whole(&path, LARGEST).map_err(|error| OutputError::write(&path, error))?;
        // The folder was found to be a run's by this file, so a part of it was written elsewhere.
        serde_json::from_slice(&bytes).map_err(|error| OutputError::OtherRun {
            path: self.path.clone(),
            reason: format!("its {SUMMARY} cannot be read: {error}"),
        })
    }

    /// Whether the run in it, if there is one, has come to nothing yet.
    ///
    /// # Errors
    /// When its summary cannot be read.
    pub fn is_begun_only(&self) -> Result<bool, OutputError> {
        let summary = self.summary()?;
        Ok(summary.is_null() || summary["state_hash"].is_null())
    }

    /// Name of the frame number `index` of this `kind`, relative to the folder.
    pub fn frame_name(kind: &str, index: usize) -> String {
        format!("{kind}/{kind}_{index:06}.vtp")
    }

    /// Writes the file called `name` with what `fill` writes, whole or not at all, and returns the
    /// digest of its bytes.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<String, OutputError> {
        let mut digest = String::new();
        let written = write_whole(&self.path.join(name), |file| {
            digest = digested(file, fill)?;
            Ok(())
        });
        self.named(name, written)?;
        Ok(digest)
    }

    /// The same, durable only when [`OutputFolder::sync`] was called with its name.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_unsynced(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<String, OutputError> {
        let mut digest = String::new();
        let written = write_whole_unsynced(&self.path.join(name), |file| {
            digest = digested(file, fill)?;
            Ok(())
        });
        self.named(name, written)?;
        Ok(digest)
    }

    /// Makes the files called `names` durable.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&self, names: &[String]) -> Result<(), OutputError> {
        let mut folders = BTreeSet::new();
        for name in names {
            let path = self.path.join(name);
            self.named(name, sync_file(&path))?;
            folders.extend(path.parent().map(Path::to_owned));
        }
        for folder in folders {
            sync_folder(&folder).map_err(|source| OutputError::write(&folder, source))?;
        }
        Ok(())
    }

    /// Begins the growing file called `name` with `head` and `tail`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn begin(
        &self,
        name: &str,
        head: &[u8],
        tail: &'static [u8],
    ) -> Result<GrowingFile, OutputError> {
        let path = self.path.join(name);
        GrowingFile::begin(&path, head, tail).map_err(|source| OutputError::write(&path, source))
    }

    /// Tells `outcome` of a call about the file called `name` with its path.
    ///
    /// # Errors
    /// That of the outcome.
    pub fn named<T>(&self, name: &str, outcome: io::Result<T>) -> Result<T, OutputError> {
        outcome.map_err(|source| OutputError::write(&self.path.join(name), source))
    }

    /// Whether files called `names` can be written.
    ///
    /// # Errors
    /// When one of them is there and is no regular file.
    pub fn check(&self, names: &[&str]) -> Result<(), OutputError> {
        let mut names = names.iter();
        names.try_for_each(|name| self.named(name, check_target(&self.path.join(name))))
    }

    /// Removes the file called `name`, if there is one.
    ///
    /// # Errors
    /// When it cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), OutputError> {
        self.named(name, remove_file(&self.path.join(name)))
    }

    /// Removes the files called `names`, the frames, and what was not whole when a program stopped
    /// here, but for what is `kept`.
    ///
    /// # Errors
    /// When one of them cannot be removed.
    pub fn clear(&self, names: &[&str], kept: &[&str]) -> Result<(), OutputError> {
        for name in names.iter().filter(|name| !kept.contains(name)) {
            self.remove(name)?;
        }
        let left = self.leftovers(kept);
        for path in left.map_err(|source| OutputError::write(&self.path, source))? {
            remove_file(&path).map_err(|source| OutputError::write(&path, source))?;
        }
        Ok(())
    }

    /// Frames that are not `kept`, and files that were never whole.
    fn leftovers(&self, kept: &[&str]) -> io::Result<Vec<PathBuf>> {
        let mut left = Vec::new();
        for kind in [""].into_iter().chain(FRAMES) {
            let folder = self.path.join(kind);
            if !folder.is_dir() {
                continue;
            }
            for entry in fs::read_dir(folder)? {
                let entry = entry?;
                let name = entry.file_name().to_string_lossy().into_owned();
                let is_own =
                    is_frame(kind, &name) && !kept.contains(&format!("{kind}/{name}").as_str());
                if (is_own || is_temporary(&name)) && entry.file_type()?.is_file() {
                    left.push(entry.path());
                }
            }
        }
        Ok(left)
    }
}

/// Writes to `file` what `fill` writes, and returns its digest.
fn digested(
    file: &mut dyn Write,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<String> {
    let mut file = Digested::new(file);
    fill(&mut file)?;
    Ok(file.digest())
}

/// Whether the folder at `path` holds files and no summary of a run. Another program may begin its
/// run there meanwhile, with the summary before all else: so that is looked for last.
fn is_foreign(path: &Path) -> io::Result<bool> {
    Ok(holds_other_files(path)? && !holds_summary(path)?)
}

/// Whether anything is in the folder at `path` beside the lock and what a run keeps for itself.
fn holds_other_files(path: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(path)? {
        let name = entry?.file_name();
        let own = [CHECKPOINT, SAMPLES, PROFILES, FRAME_LOG, LOCK]
            .into_iter()
            .chain(FRAMES);
        if !own.into_iter().any(|own| name == *own) && !name.to_str().is_some_and(is_temporary) {
            return Ok(true);
        }
    }
    for kind in FRAMES.map(|kind| path.join(kind)) {
        if kind.is_dir() && fs::read_dir(kind)?.next().is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether the folder at `path` holds the summary of a run.
fn holds_summary(path: &Path) -> io::Result<bool> {
    let summary = path.join(SUMMARY);
    Ok(summary.is_file() && contains(&read_whole(&summary, LARGEST)?, MARK))
}

/// Writes the file at `path` with what `fill` writes, whole or not at all.
///
/// # Errors
/// When it cannot be written.
pub fn write_file(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    write_whole(path, fill).map_err(|source| OutputError::write(path, source))
}

/// Whether `name` is that of a file in a folder or in a folder of it, and of nothing above.
pub fn is_own_name(name: &str) -> bool {
    is_name_below(name, 2)
}

/// Whether `name` is that of something below a folder, at most so `deep`, and of nothing above.
pub fn is_name_below(name: &str, deep: usize) -> bool {
    let path = Path::new(name);
    let mut parts = path.components();
    parts.all(|part| matches!(part, Component::Normal(_)))
        && (1..=deep).contains(&path.components().count())
}

/// Whether frames of this `kind` have such a `name`; earlier programs wrote polyhedra as `.vtu`.
fn is_frame(kind: &str, name: &str) -> bool {
    let extension = Path::new(name).extension();
    let number = name
        .strip_prefix(kind)
        .and_then(|rest| rest.strip_prefix('_'));
    FRAMES.contains(&kind)
        && number.is_some()
        && extension.is_some_and(|e| e == "vtp" || e == "vtu")
}

fn contains(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folder_in_which_a_run_begins_this_moment_is_never_foreign() {
        let place = tempfile::tempdir().unwrap();
        for number in 0..200 {
            let folder = place.path().join(number.to_string());
            let summary = folder.join(SUMMARY);
            fs::create_dir(&folder).unwrap();
            std::thread::scope(|scope| {
                scope.spawn(|| write_whole_unsynced(&summary, |file| file.write_all(MARK)));
                while !summary.exists() {
                    assert!(!is_foreign(&folder).unwrap());
                }
            });
            assert!(!is_foreign(&folder).unwrap());
        }
    }

    #[test]
    fn folder_with_files_and_no_summary_is_foreign() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(LOCK), "").unwrap();
        assert!(!is_foreign(folder.path()).unwrap());
        fs::write(folder.path().join("thesis.tex"), "").unwrap();
        assert!(is_foreign(folder.path()).unwrap());
        fs::write(folder.path().join(SUMMARY), "{}").unwrap();
        assert!(is_foreign(folder.path()).unwrap(), "nobody's summary");
        fs::write(folder.path().join(SUMMARY), MARK).unwrap();
        assert!(!is_foreign(folder.path()).unwrap());
    }
}
