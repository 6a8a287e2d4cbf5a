//! `grainfall verify FILE`: computes again what a file claims.
//!
//! In: a run's `summary.json`, or a session or a list of changes that was saved in the window. Out: whether the state is
//! the same to the bit.

use super::{HeadlessError, Progress};
use crate::simulation::{BedStore, Claim, Preparation, Run, Script, Session, VERSION};
use crate::solver::{Fault, advise};
use crate::world::StateHash;
use std::fs;
use std::path::Path;

/// Simulated time between two looks at whether to stop [s].
const SLICE: f64 = 0.01;

/// What became of a claim.
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
            Self::Same => 0,
            Self::Other(_) => 4,
            Self::Faulted(_) => 3,
            Self::Interrupted => 130,
        }
    }
}

impl Claim {
    /// The claim of the file at `path`: a session or JSON.
    ///
    /// # Errors
    /// When the file cannot be read, makes no claim, or was edited since it was written.
    pub fn read(path: &Path) -> Result<Self, HeadlessError> {
        if Session::is_at(path) {
            let session = Session::read(path).map_err(|e| HeadlessError::Input(e.to_string()))?;
            return Ok(session.into_claim());
        }
        let name = path.display();
        let refuse = |reason: String| {
            HeadlessError::Input(format!(
                "{name}: {reason}; expected a run's summary.json, or a session or a list of changes saved in the window"
            ))
        };
        let text =
            fs::read_to_string(path).map_err(|error| refuse(format!("cannot be read: {error}")))?;
        let claim: Self = serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
        if claim.program != "grainfall" || claim.state_hash.is_none() {
            return Err(refuse("states no state to come to".into()));
        }
        if !claim.is_genuine() {
            return Err(refuse(format!(
                "its fingerprint does not fit: the file was edited or damaged, or written by another version than \
                 {VERSION} (it says {})",
                claim.version
            )));
        }
        Ok(claim)
    }

    /// Computes the state again on `threads` threads, from time zero, until `stop` says so.
    ///
    /// # Errors
    /// When the scene or the commands cannot be run.
    pub fn verify(
        &self,
        threads: usize,
        beds: BedStore,
        stop: &dyn Fn() -> bool,
    ) -> Result<Verdict, HeadlessError> {
        let refuse = |reason: String| HeadlessError::Input(format!("{}: {reason}", self.name));
        let time_step = advise(&self.scene).time_step;
        let scene = std::sync::Arc::new(self.scene.clone());
        let mut progress = Progress::new();
        let mut preparation = Preparation::new(scene, time_step, threads, beds);
        let mut run = match preparation.go_through(stop) {
            Ok(Some(run)) => run,
            Ok(None) => return Ok(Verdict::Interrupted),
            Err(fault) => return Ok(Verdict::Faulted(fault)),
        };
        let script =
            Script::new(&self.commands, &run.world().clock).map_err(|e| refuse(e.to_string()))?;
        run.replay(script).map_err(|e| refuse(e.to_string()))?;
        let reached = self.advance(&mut run, &mut progress, stop);
        progress.finish();
        let hash = run.world().hash();
        Ok(match reached {
            Err(fault) => Verdict::Faulted(fault),
            Ok(false) => Verdict::Interrupted,
            Ok(true) if self.state_hash == Some(hash.to_string()) => Verdict::Same,
            Ok(true) => Verdict::Other(hash),
        })
    }

    /// Advances `run` to the claim's step; says whether it came there.
    fn advance(
        &self,
        run: &mut Run,
        progress: &mut Progress,
        stop: &dyn Fn() -> bool,
    ) -> Result<bool, Fault> {
        let slice = (SLICE / run.world().clock.time_step).ceil() as u64;
        while run.world().clock.step < self.steps {
            if stop() {
                return Ok(false);
            }
            let step = run.world().clock.step;
            run.advance_to(self.steps.min(step + slice))?;
            let share = step as f64 / self.steps as f64;
            progress.tell(share, || {
                format!("t = {:.2} s of {:.2} s", run.world().time(), self.time)
            });
        }
        Ok(true)
    }
}
