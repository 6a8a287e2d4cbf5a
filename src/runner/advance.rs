//! What a runner moves: a run that is prepared, then advanced, in short pieces.
//!
//! Two things are moved so: a [`DirectRun`], here, and a run within an app, whose systems step it
//! (see `headless`).

use crate::output::RunSoFar;
use crate::run::{
    BedStore, Checkpoint, Measured, Pieces, Preparation, Prepared, Run, Script, ScriptedCommand,
    Stored,
};
use crate::scene::Scene;
use crate::solver::{Fault, advise};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Wall-clock time that a piece takes: whoever stops a run waits for it.
const PIECE_TIME: Duration = Duration::from_millis(50);

/// Something that a runner moves to its end.
pub trait Advance {
    /// Where it is.
    fn at(&self) -> At<'_>;

    /// Does one short piece of work: prepares, or advances towards the step `goal` and no further.
    ///
    /// # Errors
    /// A [`Halt`] where it can go no further.
    fn advance(&mut self, goal: u64) -> Result<(), Halt>;

    /// What people should know, in sentences.
    fn warnings(&self) -> Vec<String>;

    /// May forget what is `stored` in files of what was measured; what forgets, remembers.
    fn forget(&mut self, _stored: Stored) {}

    /// Shows all that was `measured`, after some of it was forgotten.
    fn remember(&mut self, _measured: Measured) {}
}

/// Where a run is.
pub enum At<'a> {
    /// Before time zero.
    Preparing {
        /// What is being done.
        stage: &'a str,
        /// How far that has come, 0 … 1.
        share: f64,
    },
    /// At a state.
    State(RunSoFar<'a>),
}

impl<'a> At<'a> {
    /// The state, where there is one.
    pub fn state(self) -> Option<RunSoFar<'a>> {
        match self {
            Self::State(run) => Some(run),
            Self::Preparing { .. } => None,
        }
    }
}

/// Why a run can go no further.
#[derive(Clone, Debug, PartialEq)]
pub enum Halt {
    /// The solver met an absurd state.
    Fault(Fault),
    /// Its commands cannot be carried out, for the reason given.
    Refused(String),
}

/// A run that the caller moves by itself, without an app.
pub struct DirectRun {
    stage: RunStage,
    script: Vec<ScriptedCommand>,
    checkpoint: Option<Checkpoint>,
    /// Whether the script is all that was carried out in a recorded run.
    is_record: bool,
    pieces: Pieces,
    warnings: Vec<String>,
    /// Whether they tell of a time step that exceeds its limit.
    is_warned: bool,
}

enum RunStage {
    Preparing(Box<Preparation>),
    Standing(Box<Run>),
}

impl DirectRun {
    /// A run of `scene` on `threads` threads that carries out `script` by itself.
    pub fn new(
        scene: Arc<Scene>,
        script: Vec<ScriptedCommand>,
        threads: usize,
        beds: BedStore,
    ) -> Self {
        let advice = advise(&scene);
        let preparation = Preparation::new(scene, advice.time_step, threads, beds);
        Self {
            stage: RunStage::Preparing(Box::new(preparation)),
            script,
            checkpoint: None,
            is_record: false,
            pieces: Pieces::of(PIECE_TIME),
            is_warned: advice.warning.is_some(),
            warnings: advice.warning.into_iter().collect(),
        }
    }

    /// The same, its script being all that was carried out in a recorded run.
    #[must_use]
    pub fn of_record(self) -> Self {
        Self {
            is_record: true,
            ..self
        }
    }

    /// The same going on from a `checkpoint` of a run of the same scene and script.
    #[must_use]
    pub fn from_checkpoint(self, checkpoint: Option<Checkpoint>) -> Self {
        Self { checkpoint, ..self }
    }

    /// The run of `scene` as it stands at `checkpoint`, to be read: nothing is prepared, so its bed is
    /// that state and not the one it began with.
    pub fn standing_at(checkpoint: Checkpoint, scene: Arc<Scene>, threads: usize) -> Self {
        let mut run = Run::new(scene.clone(), checkpoint.world().clone(), threads);
        run.resume(checkpoint);
        Self {
            stage: RunStage::Standing(Box::new(run)),
            ..Self::new(scene, Vec::new(), threads, BedStore::none())
        }
    }

    /// The run, once it stands at a state.
    pub fn run(&self) -> Option<&Run> {
        match &self.stage {
            RunStage::Standing(run) => Some(run),
            RunStage::Preparing(_) => None,
        }
    }

    /// The run that stands at a state.
    ///
    /// # Errors
    /// Itself, where it is still being prepared.
    pub fn into_run(self) -> Result<Run, Box<Self>> {
        match self.stage {
            RunStage::Standing(run) => Ok(*run),
            RunStage::Preparing(_) => Err(Box::new(self)),
        }
    }

    /// Takes up the script, and goes to the checkpoint where there is one.
    fn begin(&mut self, mut run: Run) -> Result<(), String> {
        let script = Script::new(&self.script, &run.world().clock).map_err(|e| e.to_string())?;
        let scheduled = if self.is_record {
            run.replay(script)
        } else {
            run.schedule(script)
        };
        scheduled.map_err(|error| error.to_string())?;
        if let Some(checkpoint) = self.checkpoint.take() {
            run.resume(checkpoint);
        }
        self.stage = RunStage::Standing(Box::new(run));
        Ok(())
    }
}

impl Advance for DirectRun {
    fn at(&self) -> At<'_> {
        match &self.stage {
            RunStage::Preparing(preparation) => At::Preparing {
                stage: preparation.name(),
                share: preparation.progress().into(),
            },
            RunStage::Standing(run) => At::State(RunSoFar::of(run)),
        }
    }

    fn advance(&mut self, goal: u64) -> Result<(), Halt> {
        match &mut self.stage {
            RunStage::Standing(run) => {
                let from = run.world().clock.step;
                let to = goal.min(from.saturating_add(self.pieces.steps()));
                let started = Instant::now();
                run.advance_to(to).map_err(Halt::Fault)?;
                self.pieces.fit(to.saturating_sub(from), started.elapsed());
                Ok(())
            }
            RunStage::Preparing(preparation) => {
                let Prepared::Ready(run) = preparation.advance().map_err(Halt::Fault)? else {
                    return Ok(());
                };
                self.warnings.extend_from_slice(preparation.warnings());
                self.begin(*run).map_err(Halt::Refused)
            }
        }
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        let advice = self.run().map(Run::advice);
        let warning = advice.and_then(|advice| advice.warning);
        warnings.extend(warning.filter(|_| !self.is_warned));
        warnings
    }

    fn forget(&mut self, stored: Stored) {
        if let RunStage::Standing(run) = &mut self.stage {
            run.forget(stored);
        }
    }

    fn remember(&mut self, measured: Measured) {
        if let RunStage::Standing(run) = &mut self.stage {
            run.remember(measured);
        }
    }
}
