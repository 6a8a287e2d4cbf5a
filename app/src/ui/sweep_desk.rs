//! The parameter sweep of a window: it runs in the background, whatever scene is open meanwhile.
//!
//! In: a question. Out: how its sweep stands, and what its cases came to. Panels look at it;
//! starting and stopping it is `dispatch`'s business.

use grainfall::run::BedStore;
use grainfall::runner::spare_threads;
use grainfall::sweep::{BackgroundSweep, Question, Sweep, SweepStanding};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where sweeps go on a system that has no place for a user's data.
const NO_HOME: &str = "sweeps";

/// The sweep of a window, shared by those who look at it.
#[derive(Clone, Default)]
pub struct SweepDesk(Arc<Mutex<Held>>);

#[derive(Default)]
struct Held {
    run: Option<(Question, BackgroundSweep)>,
    /// The folder that a person chose for sweeps.
    home: Option<PathBuf>,
    /// Why the last one could not start.
    refusal: Option<String>,
}

/// A sweep as it stands.
pub struct SweepSeen {
    /// What was asked.
    pub question: Question,
    /// What is run.
    pub sweep: Arc<Sweep>,
    /// How far it has come.
    pub standing: SweepStanding,
    /// Whether it was told to stop.
    pub is_stopping: bool,
}

impl SweepSeen {
    /// Whether it goes on.
    pub fn is_running(&self) -> bool {
        self.standing.ending.is_none()
    }
}

impl SweepDesk {
    /// The folder in which each sweep has one of its own.
    pub fn home(&self) -> PathBuf {
        let chosen = self.held().home.clone();
        chosen
            .or_else(Question::home)
            .unwrap_or_else(|| NO_HOME.into())
    }

    /// Puts the sweeps that follow into this folder.
    pub fn settle_in(&self, home: PathBuf) {
        self.held().home = Some(home);
    }

    /// Starts the sweep that answers `question`, or goes on with it, on the cores that a window
    /// leaves; nothing where one is running.
    pub fn start(&self, question: Question, beds: BedStore) {
        let sweep = question.sweep(&self.home(), spare_threads(), beds);
        let mut held = self.held();
        if (held.run.as_ref()).is_some_and(|(_, run)| run.is_running()) {
            held.refusal = Some("A sweep is running: stop it first.".into());
            return;
        }
        match sweep {
            Ok(sweep) => {
                held.run = Some((question, BackgroundSweep::start(sweep)));
                held.refusal = None;
            }
            Err(error) => held.refusal = Some(error.to_string()),
        }
    }

    /// Stops it soon; what is done is kept, and the rest up to its checkpoints.
    pub fn stop(&self) {
        if let Some((_, run)) = &self.held().run {
            run.stop();
        }
    }

    /// Stops it, and waits until what it came to is on the disk.
    pub fn leave(&self) {
        if let Some((_, run)) = &mut self.held().run {
            run.stop();
            run.wait();
        }
    }

    /// The sweep as it stands, where there is one.
    pub fn seen(&self) -> Option<SweepSeen> {
        let held = self.held();
        let (question, run) = held.run.as_ref()?;
        Some(SweepSeen {
            question: question.clone(),
            sweep: run.sweep().clone(),
            standing: run.standing(),
            is_stopping: run.is_stopping(),
        })
    }

    /// How far the sweep that is running has come, in words; none where none is.
    pub fn progress(&self) -> Option<String> {
        let held = self.held();
        let (_, run) = held.run.as_ref()?;
        run.is_running().then(|| run.standing().progress)
    }

    /// Why the last one could not start.
    pub fn refusal(&self) -> Option<String> {
        self.held().refusal.clone()
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
