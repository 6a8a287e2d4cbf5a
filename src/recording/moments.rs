//! `grains.pvd` and `contacts.pvd`: which file shows which instant.
//!
//! In: the lists. Out: times and names of files. Whether the files are there is seen when they are
//! read: ten thousand of them are opened at once.

use super::RecordingError;
use super::own_files::OwnFile;
use super::vtk_arrays::parse;
use std::str::from_utf8;

/// Largest list that is read [bytes]: one entry has ninety.
pub const LARGEST_LIST: u64 = 256 << 20;
/// Latest time of a state [s].
const LATEST: f64 = 2e6;

/// A file that shows one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedFile {
    /// The instant [s].
    pub time: f64,
    /// The file's name, relative to the folder.
    pub name: String,
}

/// The files that `list` names, in order of their times.
///
/// # Errors
/// When it is no such list, or its times do not follow each other.
pub fn listed_files(list: &OwnFile) -> Result<Vec<ListedFile>, RecordingError> {
    let refuse = |reason: String| RecordingError::of(&list.path, reason);
    let text = from_utf8(&list.bytes).map_err(|_| refuse("is no text".into()))?;
    // Each entry is an element and the end of its line.
    let document = parse(text, u32::MAX).map_err(refuse)?;
    let entries = document.descendants().filter(|n| n.has_tag_name("DataSet"));
    let mut files: Vec<ListedFile> = Vec::new();
    for (index, entry) in entries.enumerate() {
        let refuse = |what: &str| refuse(format!("entry {} {what}", index + 1));
        let time = entry.attribute("timestep").and_then(|t| t.parse().ok());
        let time = time.filter(|time| (0.0..=LATEST).contains(time));
        let time = time.ok_or_else(|| refuse("has no time"))?;
        if files.last().is_some_and(|last| last.time >= time) {
            return Err(refuse("is not later than the one before it"));
        }
        let name = entry.attribute("file");
        let name = name.ok_or_else(|| refuse("names no file"))?.to_owned();
        files.push(ListedFile { time, name });
    }
    Ok(files)
}
