//! `grainfall verify FILE`: computes again what a file states.
//!
//! In: a run's `summary.json`, or a session or a list of changes that was saved in the window. Out:
//! whether the state is the same to the bit.

use super::drive::{End, drive};
use super::{DirectRun, RunnerError, Watch, exit};
use crate::files::read_whole;
use crate::output::Ending;
use crate::run::{BedStore, RunRecord, Session, VERSION};
use crate::scene::within_folders;
use crate::solver::Fault;
use crate::world::StateHash;
use std::path::Path;
use std::sync::Arc;

/// Largest record that is read [bytes]: one of a scene with as many listed grains as a file holds.
const LARGEST_FILE: u64 = 256 << 20;

/// What became of computing a stated state again.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The state is the same to the bit.
    Same,
    /// The run came to a state with this hash.
    Other(StateHash),
    /// The run met a fault on the way.
    Faulted(Fault),
    /// Somebody stopped it.
    Interrupted,
}

impl Verdict {
    /// What the process ends with: 0, 4, 3 or 130.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Same => exit::DONE,
            Self::Other(_) => exit::OTHER_STATE,
            Self::Faulted(_) => exit::FAULT,
            Self::Interrupted => exit::INTERRUPTED,
        }
    }
}

impl RunRecord {
    /// The record in the file at `path`: a session or JSON.
    ///
    /// # Errors
    /// When the file cannot be read, holds no record, or was edited since it was written.
    pub fn read(path: &Path) -> Result<Self, RunnerError> {
        if Session::is_at(path) {
            let session = Session::read(path).map_err(|e| RunnerError::Input(e.to_string()))?;
            return Ok(session.into_record());
        }
        let name = path.display();
        let refuse = |reason: String| {
            RunnerError::Input(format!(
                "{name}: {reason}; expected a run's summary.json, or a session or a list of changes saved in the window"
            ))
        };
        let bytes = read_whole(path, LARGEST_FILE)
            .map_err(|error| refuse(format!("cannot be read: {error}")))?;
        // A packing lies where the program is called, as when the record was made, or beside it.
        let folders = [Path::new("."), path.parent().unwrap_or(Path::new("."))];
        let record: Self = within_folders(&folders, || serde_json::from_slice(&bytes))
            .map_err(|error| refuse(error.to_string()))?;
        if record.program != "grainfall" || record.state_hash.is_none() {
            return Err(refuse("states no state to come to".into()));
        }
        if !record.is_genuine() {
            return Err(refuse(format!(
                "its fingerprint does not fit: the file was edited or damaged, or written by another version than \
                 {VERSION} (it says {})",
                record.version
            )));
        }
        record.check().map_err(refuse)?;
        Ok(record)
    }

    /// Computes the state again on `threads` threads, from time zero, until `stop` says so; `watch`
    /// hears how far it has come.
    ///
    /// # Errors
    /// When the scene or the commands cannot be run.
    pub fn verify(
        &self,
        threads: usize,
        beds: BedStore,
        watch: &mut dyn Watch,
        stop: &dyn Fn() -> bool,
    ) -> Result<Verdict, RunnerError> {
        let scene = Arc::new(self.scene.clone());
        let mut run = DirectRun::new(scene, self.commands.clone(), threads, beds).of_record();
        let end = End::Step(self.steps, self.time);
        let ending = drive(&mut run, end, None, watch, stop);
        let ending = ending.map_err(|error| error.within(&self.name))?;
        let hash = run.run().map(|run| run.world().hash());
        Ok(match (ending, hash) {
            (Ending::Faulted(fault), _) => Verdict::Faulted(fault),
            (Ending::Interrupted, _) | (_, None) => Verdict::Interrupted,
            (Ending::Done, Some(hash)) if self.state_hash == Some(hash.to_string()) => {
                Verdict::Same
            }
            (Ending::Done, Some(hash)) => Verdict::Other(hash),
        })
    }
}
