//! A sweep on threads of its own, while others look at how far it has come.
//!
//! In: a sweep. Out: its progress and what its cases came to, as they are done; in the end how it
//! ended. Looking never waits for the work.

use super::case::CaseResult;
use super::plan::Sweep;
use super::{SweepEnding, Swept, run_seen};
use crate::run::give_way;
use crate::runner::{Part, Watch};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// How a sweep in the background stands.
#[derive(Clone, Debug, Default)]
pub struct SweepStanding {
    /// How much of all is done, 0 … 1.
    pub share: f64,
    /// How far it has come, in words: `3 of 8 cases done, 2 min 5 s left`.
    pub progress: String,
    /// How each case stands, in their order; none before the first look.
    pub parts: Vec<Part>,
    /// What the cases that are done came to, in the order in which they were: their results alone.
    pub outcomes: Arc<Vec<CaseResult>>,
    /// How it ended, or why it could not be run; none while it goes on.
    pub ending: Option<Result<SweepEnding, String>>,
    /// The cases that met a fault, each with what it was.
    pub faults: Vec<String>,
}

/// A sweep that runs in the background.
pub struct BackgroundSweep {
    sweep: Arc<Sweep>,
    stop: Arc<AtomicBool>,
    standing: Arc<Mutex<SweepStanding>>,
    worker: Option<JoinHandle<()>>,
}

impl BackgroundSweep {
    /// Starts `sweep`, or goes on with it where its folder holds part of it.
    pub fn start(sweep: Sweep) -> Self {
        let sweep = Arc::new(sweep);
        let stop = Arc::new(AtomicBool::new(false));
        let standing = Arc::new(Mutex::new(SweepStanding::default()));
        let shared = (sweep.clone(), stop.clone(), standing.clone());
        let work = move || {
            // Somebody looks at something else meanwhile.
            give_way();
            let (sweep, stop, standing) = shared;
            run(&sweep, &stop, &standing);
        };
        let begun = std::thread::Builder::new().name("sweep".into()).spawn(work);
        if let Err(error) = &begun {
            let reason = format!("the system gives no thread to run it on: {error}");
            locked(&standing).ending = Some(Err(reason));
        }
        Self {
            sweep,
            stop,
            standing,
            worker: begun.ok(),
        }
    }

    /// What is run.
    pub fn sweep(&self) -> &Arc<Sweep> {
        &self.sweep
    }

    /// How it stands now.
    pub fn standing(&self) -> SweepStanding {
        locked(&self.standing).clone()
    }

    /// Whether it goes on.
    pub fn is_running(&self) -> bool {
        locked(&self.standing).ending.is_none()
    }

    /// Stops it soon: what is done is kept, and the rest up to its checkpoints.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was told to stop.
    pub fn is_stopping(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Waits until it has ended.
    pub fn wait(&mut self) {
        if let Some(worker) = self.worker.take() {
            // What went wrong there stands in the standing.
            drop(worker.join());
        }
    }
}

/// It is stopped, and what it came to is on the disk.
impl Drop for BackgroundSweep {
    fn drop(&mut self) {
        self.stop();
        self.wait();
    }
}

fn locked(standing: &Mutex<SweepStanding>) -> MutexGuard<'_, SweepStanding> {
    standing.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes what it hears into a standing.
struct Listener<'a>(&'a Mutex<SweepStanding>);

impl Watch for Listener<'_> {
    fn preparing(&mut self, _share: f64, _stage: &str) {}

    fn running(&mut self, share: f64, what: &dyn Fn() -> String) {
        let mut standing = locked(self.0);
        (standing.share, standing.progress) = (share, what());
    }

    fn parts(&mut self, parts: &[Part]) {
        locked(self.0).parts = parts.to_vec();
    }
}

/// Has its sweep end with a reason where the work on it panics.
struct Ended<'a>(&'a Mutex<SweepStanding>);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        let mut standing = locked(self.0);
        if standing.ending.is_none() {
            let reason = "it ended unexpectedly; what was done is kept".to_owned();
            standing.ending = Some(Err(reason));
        }
    }
}

fn run(sweep: &Sweep, stop: &AtomicBool, standing: &Mutex<SweepStanding>) {
    let ended = Ended(standing);
    let see = |outcome: &CaseResult| {
        let results = outcome.without_course();
        Arc::make_mut(&mut locked(standing).outcomes).push(results);
    };
    let swept = run_seen(sweep, stop, &mut Listener(standing), &see);
    let mut told = locked(standing);
    match swept {
        Ok(Swept { ending, faults, .. }) => {
            if ending != SweepEnding::Interrupted {
                told.share = 1.0;
                told.parts.fill(Part::Over);
            }
            (told.ending, told.faults) = (Some(Ok(ending)), faults);
        }
        Err(error) => told.ending = Some(Err(error.to_string())),
    }
    drop(told);
    drop(ended);
}
