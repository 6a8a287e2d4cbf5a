//! `grains.pvd` and `contacts.pvd`: lists of files that programs open as a series in time.
//!
//! In: each file with its time. Out: a list that is whole after each of them.

use super::{OutputError, OutputFolder};
use crate::files::GrowingFile;
use crate::run::Provenance;
use serde::{Deserialize, Serialize};

const HEAD: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
                    byte_order=\"LittleEndian\">\n  <Collection>\n";
const TAIL: &str = "  </Collection>\n</VTKFile>\n";

/// A file that shows one instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CollectedFile {
    /// Simulated time of the state in it [s].
    pub time: f64,
    /// Its name, relative to the folder.
    pub name: String,
    /// The digest of its bytes.
    pub digest: String,
}

impl CollectedFile {
    fn entry(&self) -> String {
        let Self { time, name, .. } = self;
        format!("    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>\n")
    }
}

/// The list while a run goes on.
pub struct CollectionFile {
    name: &'static str,
    file: GrowingFile,
}

impl CollectionFile {
    /// Writes the list called `name` of these `frames`, all `from` one run.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn begin(
        folder: &OutputFolder,
        name: &'static str,
        frames: impl Iterator<Item = CollectedFile>,
        from: &Provenance,
    ) -> Result<Self, OutputError> {
        let head = from.in_xml(&opening(frames));
        let file = folder.begin(name, head.as_bytes(), TAIL.as_bytes())?;
        Ok(Self { name, file })
    }

    /// Adds `frame`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn add(&mut self, folder: &OutputFolder, frame: &CollectedFile) -> Result<(), OutputError> {
        let added = self.file.add(frame.entry().as_bytes());
        folder.named(self.name, added)
    }

    /// Makes it durable.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&self, folder: &OutputFolder) -> Result<(), OutputError> {
        folder.named(self.name, self.file.sync())
    }
}

/// Writes the list called `name` of all `frames` of a run, `from` its last state, and returns its
/// digest.
///
/// # Errors
/// When it cannot be written.
pub fn write_collection(
    folder: &OutputFolder,
    name: &str,
    frames: impl Iterator<Item = CollectedFile>,
    from: &Provenance,
) -> Result<String, OutputError> {
    let text = from.in_xml(&(opening(frames) + TAIL));
    folder.write(name, |file| file.write_all(text.as_bytes()))
}

/// All but the end of the list of `frames`.
fn opening(frames: impl Iterator<Item = CollectedFile>) -> String {
    let entries: String = frames.map(|frame| frame.entry()).collect();
    format!("{HEAD}{entries}")
}
