//! The tables of a run's folder, each with what is to be said of it.
//!
//! In: the folder's files. Out: samples, mean flow, contacts and bridges. None of them is needed to
//! show states: where one cannot be read, a note says so.

use super::RecordingError;
use super::flow_table::{LARGEST_FLOW, mean_flow};
use super::meetings_table::{LARGEST_EVENTS, meetings};
use super::own_files::OwnFiles;
use super::samples::{LARGEST_TABLE, samples};
use crate::measure::{MeanFlow, Series};
use crate::output::{EVENTS, FLOW, SERIES};
use crate::run::{Meeting, StepTimes};
use crate::world::World;

/// The tables of a folder.
pub struct Tables<'a> {
    /// Its files.
    pub files: &'a OwnFiles,
    /// Whether the run has come to its end, at which it writes all but the samples: what is there
    /// before is of an earlier one.
    pub is_over: bool,
}

impl Tables<'_> {
    /// The samples, and what is to be said of their file, in sentences.
    ///
    /// # Errors
    /// When there are none.
    pub fn samples(&self) -> Result<(Series, Vec<String>), RecordingError> {
        let mut file = self.files.read(SERIES, LARGEST_TABLE)?;
        if !self.is_over {
            // The last row may be half written.
            let whole = file.bytes.iter().rposition(|byte| *byte == b'\n');
            file.bytes.truncate(whole.map_or(0, |last| last + 1));
        }
        let (series, fault) = samples(&file)?;
        Ok((series, file.note().into_iter().chain(fault).collect()))
    }

    /// The mean flow, if there is one; what is to be said of it goes to `notes`.
    pub fn flow(&self, notes: &mut Vec<String>) -> Option<MeanFlow> {
        if !self.is_over || !self.files.has(FLOW) {
            return None;
        }
        let read = self.files.read(FLOW, LARGEST_FLOW);
        match read.and_then(|file| Ok((file.note(), mean_flow(&file)?))) {
            Ok((note, flow)) => {
                notes.extend(note);
                Some(flow)
            }
            Err(error) => {
                notes.push(format!("There is no mean flow: {error}"));
                None
            }
        }
    }

    /// The contacts and bridges between grains and walls of `world` that began and ended, at these
    /// `steps`; what is to be said of their file goes to `notes`. Where nothing happened there is no
    /// file.
    pub fn meetings(
        &self,
        world: &World,
        steps: &StepTimes,
        notes: &mut Vec<String>,
    ) -> Vec<Meeting> {
        if !self.is_over || !self.files.has(EVENTS) {
            return Vec::new();
        }
        let read = self.files.read(EVENTS, LARGEST_EVENTS);
        match read.and_then(|file| Ok((file.note(), meetings(&file, world, steps)?))) {
            Ok((note, (meetings, fault))) => {
                notes.extend(note.into_iter().chain(fault));
                meetings
            }
            Err(error) => {
                notes.push(format!("There are no impacts: {error}"));
                Vec::new()
            }
        }
    }
}
