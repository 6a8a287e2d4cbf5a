//! What the engine tells the outside: news in an [`Update`], each replaced or continued by the
//! next.
//!
//! In: nothing. Out: plain values that travel between threads. States, samples and commands are
//! shared, not copied.

use super::Status;
use crate::measure::{MeanFlow, Sample};
use crate::recording::RecordingFacts;
use crate::run::{Branch, KeptMemory, Parameter, ParameterInfo, Past, Sampling, Turned};
use crate::solver::{Fault, Profile};
use crate::world::World;
use std::path::PathBuf;
use std::sync::Arc;

/// News from the engine since the last update was taken.
#[derive(Default)]
pub struct Update {
    /// The runs, where there are any and all are at the same step.
    pub runs: Option<RunsNews>,
    /// What is known of the recording that is played, where that has changed.
    pub recording: Option<RecordingFacts>,
    /// How many commands were dispatched since the engine was made. None while two runs are on the
    /// way to a common step: what they become by then is told together.
    pub answered: Option<u64>,
    /// What the lab does.
    pub status: Option<Status>,
    /// The bed on its way to rest, without its contacts, as of lately.
    pub settling: Option<Arc<World>>,
    /// What people should know, in sentences.
    pub warnings: Vec<String>,
    /// Files that were to be written.
    pub saved: Vec<SavedFile>,
}

/// All runs of a lab, shown at the same step.
pub struct RunsNews {
    /// What the two differ in, where there are two.
    pub comparison: Option<Parameter>,
    /// The left run, then the right one.
    pub runs: Vec<RunNews>,
}

/// A run as it is shown.
#[derive(Clone)]
pub struct RunNews {
    /// The state.
    pub world: Arc<World>,
    /// The step that was come to: that of the state, or a later one where only some states of a
    /// run are known.
    pub reached: u64,
    /// The state it began with: of a recording, the first that can be read.
    pub start: Arc<World>,
    /// How far each of its spheres has turned since time zero; none of polyhedra.
    pub turned: Option<Turned>,
    /// The parameters that can change while it goes on.
    pub parameters: Arc<[ParameterInfo]>,
    /// What was changed and measured, up to its end or to a little before it.
    pub branch: Arc<Branch>,
    /// The newest sample, which the branch shared here may not have yet.
    pub latest: Option<Sample>,
    /// Which samples were taken until the state, and what the next one depends on.
    pub sampling: Sampling,
    /// What lies behind and ahead of the state.
    pub past: Past,
    /// What the run keeps in memory by design, as of the last second.
    pub memory: KeptMemory,
    /// What stopped it, if something did.
    pub fault: Option<Fault>,
    /// The mean flow of a recording, where its run wrote one or it was asked for.
    pub flow: Option<RecordedFlow>,
    /// The solver's profile of the last half second or so.
    pub profile: Profile,
}

/// The mean flow of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedFlow {
    /// It.
    pub mean: Arc<MeanFlow>,
    /// States that were read for it; none where the run wrote it itself.
    pub read: Option<usize>,
}

/// What became of a file that was to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedFile {
    /// The file.
    pub path: PathBuf,
    /// Why it could not be written, if it could not.
    pub outcome: Result<(), String>,
}

impl Update {
    /// Adds what came `later`.
    pub fn absorb(&mut self, later: Self) {
        self.runs = later.runs.or(self.runs.take());
        self.recording = later.recording.or(self.recording.take());
        self.answered = later.answered.or(self.answered);
        self.status = later.status.or(self.status.take());
        self.settling = later.settling.or(self.settling.take());
        self.warnings.extend(later.warnings);
        self.saved.extend(later.saved);
    }
}
