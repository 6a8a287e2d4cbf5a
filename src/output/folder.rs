//! A run's output folder: files that appear whole or not at all.
//!
//! In: a path. Out: a folder that holds one run's files and nothing of an earlier run's. A folder
//! that holds anything but an earlier run is left alone: see [`OutputError::ForeignFolder`].

use super::OutputError;
use crate::files::write_whole;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The file that says a folder is a run's.
pub const SUMMARY: &str = "summary.json";
/// The file from which a run that was stopped goes on.
pub const CHECKPOINT: &str = "checkpoint.bin";
/// The folder of the grains' files.
const GRAINS: &str = "grains";
/// What [`SUMMARY`] contains in a run's folder.
const MARK: &[u8] = b"\"program\": \"grainfall\"";

/// Where a run's files go.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// Makes the folder, or clears it of an earlier run's grains but for the files named in `kept`.
    ///
    /// # Errors
    /// When it holds other files than a run's, or cannot be written.
    pub fn open(path: &Path, kept: &[&str]) -> Result<Self, OutputError> {
        let failed = |source| OutputError::write(path, source);
        let folder = Self {
            path: path.to_owned(),
        };
        fs::create_dir_all(path).map_err(failed)?;
        if folder.is_foreign().map_err(failed)? {
            return Err(OutputError::ForeignFolder(path.to_owned()));
        }
        folder.clear(kept).map_err(failed)?;
        Ok(folder)
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Name of the grains' file number `index` with this extension, relative to the folder.
    pub fn grains_name(index: usize, extension: &str) -> String {
        format!("{GRAINS}/grains_{index:06}.{extension}")
    }

    /// Writes the file called `name` with what `fill` writes, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        write_file(&self.path.join(name), fill)
    }

    /// Removes the file called `name`, if there is one.
    ///
    /// # Errors
    /// When it cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), OutputError> {
        let path = self.path.join(name);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(OutputError::write(&path, error))
            }
            _ => Ok(()),
        }
    }

    /// Whether it holds files and no summary of a run.
    fn is_foreign(&self) -> io::Result<bool> {
        let summary = self.path.join(SUMMARY);
        if summary.is_file() && contains(&fs::read(summary)?, MARK) {
            return Ok(false);
        }
        for entry in fs::read_dir(&self.path)? {
            let name = entry?.file_name();
            if name != GRAINS && name != CHECKPOINT {
                return Ok(true);
            }
        }
        let grains = self.path.join(GRAINS);
        Ok(grains.is_dir() && fs::read_dir(grains)?.next().is_some())
    }

    fn clear(&self, kept: &[&str]) -> io::Result<()> {
        let grains = self.path.join(GRAINS);
        if !grains.is_dir() {
            return Ok(());
        }
        for entry in fs::read_dir(grains)? {
            let entry = entry?;
            let name = entry.file_name();
            let own = name.to_str().is_some_and(|name| {
                is_grains_file(name) && !kept.contains(&format!("{GRAINS}/{name}").as_str())
            });
            if own {
                fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }
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

fn is_grains_file(name: &str) -> bool {
    let extension = Path::new(name).extension();
    name.starts_with("grains_") && extension.is_some_and(|e| e == "vtp" || e == "vtu")
}

fn contains(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}
