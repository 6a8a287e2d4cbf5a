//! The output folder: files that appear whole or not at all.
//!
//! In: a path. Out: a folder that holds this run's files and nothing of an earlier run's. A folder that holds anything but
//! an earlier run is left alone: see [`HeadlessError::ForeignFolder`].

use super::HeadlessError;
use crate::files::write_whole;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The file that says a folder is a run's.
pub const SUMMARY: &str = "summary.json";
/// The folder of the grains' files.
const GRAINS: &str = "grains";
/// What [`SUMMARY`] contains in a run's folder.
const MARK: &str = "\"program\": \"grainfall\"";

/// Where a run's files go.
pub struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// Makes the folder, or clears it of an earlier run's files.
    ///
    /// # Errors
    /// When it holds other files than a run's, or cannot be written.
    pub fn open(path: &Path) -> Result<Self, HeadlessError> {
        let failed = |source| HeadlessError::write(path, source);
        let folder = Self {
            path: path.to_owned(),
        };
        fs::create_dir_all(path.join(GRAINS)).map_err(failed)?;
        if folder.is_foreign().map_err(failed)? {
            // Only an empty folder goes: this one, if it was made just now.
            let _ = fs::remove_dir(path.join(GRAINS));
            return Err(HeadlessError::ForeignFolder(path.to_owned()));
        }
        folder.clear().map_err(failed)?;
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
    ) -> Result<(), HeadlessError> {
        let path = self.path.join(name);
        write_whole(&path, fill).map_err(|source| HeadlessError::write(&path, source))
    }

    fn is_foreign(&self) -> io::Result<bool> {
        let summary = fs::read_to_string(self.path.join(SUMMARY)).unwrap_or_default();
        if summary.contains(MARK) {
            return Ok(false);
        }
        let mut entries = fs::read_dir(&self.path)?.chain(fs::read_dir(self.path.join(GRAINS))?);
        Ok(entries.any(|entry| entry.is_ok_and(|entry| entry.file_name() != GRAINS)))
    }

    fn clear(&self) -> io::Result<()> {
        for entry in fs::read_dir(self.path.join(GRAINS))? {
            let entry = entry?;
            let name = entry.file_name();
            let own = name.to_str().is_some_and(|name| {
                name.starts_with("grains_")
                    && Path::new(name)
                        .extension()
                        .is_some_and(|e| e == "vtp" || e == "vtu")
            });
            if own {
                fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }
}
