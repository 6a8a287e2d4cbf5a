//! One case of a sweep: run, and what came out.

use super::{Case, Sweep};
use crate::files::read_whole;
use crate::measure::{Estimate, ResultKey, RunQuantity, Series, Summary, VelocityMap};
use crate::output::{Ending, OutputError, RunSoFar, SUMMARY};
use crate::run::method;
use crate::runner::{self, Advance, Job, Part, RunnerError, Watch};
use serde_json::Value;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Largest summary that is read [bytes].
const LARGEST: u64 = 256 << 20;

/// How far a case has come, for others to see.
#[derive(Default)]
pub struct CaseProgress {
    share: AtomicU64,
    first_share: OnceLock<f64>,
    is_preparing: AtomicBool,
}

impl CaseProgress {
    /// 0 … 1, and 1 only of a case that is over.
    pub fn get(&self) -> f64 {
        f64::from_bits(self.share.load(Ordering::Relaxed))
    }

    /// How much of it has been done since it was first heard of: not what an earlier call had done.
    pub fn since_first(&self) -> f64 {
        let share = self.get();
        share - self.first_share.get().unwrap_or(&share)
    }

    /// Whether its bed is being settled now, or its grains are being cut.
    pub fn is_preparing(&self) -> bool {
        self.is_preparing.load(Ordering::Relaxed)
    }

    /// How it stands.
    pub fn part(&self) -> Part {
        match self.get() {
            share if share >= 1.0 => Part::Over,
            _ if self.is_preparing() => Part::Preparing,
            share if share > 0.0 => Part::Running(share),
            _ => Part::Waiting,
        }
    }

    /// Says that it has come so far.
    pub fn set(&self, share: f64) {
        self.is_preparing.store(false, Ordering::Relaxed);
        self.first_share.get_or_init(|| share);
        self.share.store(share.to_bits(), Ordering::Relaxed);
    }
}

impl Watch for &CaseProgress {
    fn preparing(&mut self, _share: f64, _stage: &str) {
        self.is_preparing.store(true, Ordering::Relaxed);
    }

    fn running(&mut self, share: f64, _what: &dyn Fn() -> String) {
        self.set(share.min(0.999_999));
    }
}

/// What became of a case.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// Which one.
    pub case: Case,
    /// How it ended.
    pub ending: Ending,
    /// Its results.
    pub results: Summary,
    /// Its samples; none of a case whose results alone are kept.
    pub series: Series,
    /// Its flowing layer: velocity along the surface [m/s] over the depth below it [m].
    pub flow: Vec<(f64, Estimate)>,
    /// Its fastest moment.
    pub fastest: Option<VelocityMap>,
    /// Hash of its last state.
    pub hash: String,
    /// By which solver and measures it was computed ([`method`]); none where its folder does not
    /// say.
    pub method: Option<String>,
}

impl CaseResult {
    /// Whether a column collapsed.
    pub fn is_column(&self) -> bool {
        self.results.entry(RunQuantity::AspectRatio).is_some()
    }

    /// The result `key` as a number in the SI unit.
    pub fn result(&self, key: impl Into<ResultKey>) -> Option<f64> {
        self.results.value(key)
    }

    /// Whether it shows a result: what a case came to before it met a fault is none, nor is where
    /// one stood that was stopped before it began.
    pub fn is_sound(&self) -> bool {
        self.ending.fault().is_none() && self.results.to > 0.0
    }

    /// The same without its samples and what is taken of them: its results alone.
    #[must_use]
    pub fn without_course(&self) -> Self {
        Self {
            series: Series::default(),
            flow: Vec::new(),
            fastest: None,
            case: self.case.clone(),
            ending: self.ending.clone(),
            results: self.results.clone(),
            hash: self.hash.clone(),
            method: self.method.clone(),
        }
    }

    /// Whether it was computed by this build's method.
    pub fn is_of_this_method(&self) -> bool {
        self.method.as_deref() == Some(method(&self.case.scene))
    }

    /// Whether its samples are there, and with them its flowing layer and its fastest moment.
    pub fn has_course(&self) -> bool {
        !self.series.is_empty()
    }

    /// That `case` is done with these results, of which nothing else is kept.
    pub fn kept(case: &Case, results: Summary, hash: String, method: String) -> Self {
        Self {
            case: case.clone(),
            ending: Ending::Done,
            results,
            series: Series::default(),
            flow: Vec::new(),
            fastest: None,
            hash,
            method: Some(method),
        }
    }

    fn of(
        case: &Case,
        ending: Ending,
        results: Summary,
        run: RunSoFar,
        method: Option<String>,
    ) -> Self {
        let from = run.results_from();
        Self {
            case: case.clone(),
            ending,
            results,
            series: run.series.clone(),
            flow: (run.flow.since(from).depth.into_iter())
                .zip(run.flow.velocity_since(from))
                .collect(),
            fastest: run.flow.fastest_since(from).cloned(),
            hash: run.world.hash().to_string(),
            method,
        }
    }
}

/// What running `case` on one thread takes.
pub fn job(sweep: &Sweep, case: &Case) -> Job {
    Job {
        threads: 1,
        script: case.script.clone(),
        beds: sweep.beds.clone(),
        grains: false,
        checkpoints: true,
        restart: sweep.restart,
        ..Job::new(&case.name, case.scene.clone(), sweep.out.join(&case.name))
    }
}

/// Refuses cases that were computed by another solver or other measures: set beside those of this
/// build, nobody could say what a difference is of.
///
/// # Errors
/// With the first of them, and what to do.
pub fn check_method(sweep: &Sweep, cases: &[Case]) -> Result<(), RunnerError> {
    if sweep.restart {
        return Ok(());
    }
    for case in cases {
        let stated = stated_method(&sweep.out.join(&case.name))?;
        let own = method(&case.scene);
        if let Some(other) = stated.filter(|stated| stated != own) {
            return Err(RunnerError::Input(format!(
                "{}: it was computed by method {other}, and this build of Grainfall computes by {own}: \
                 --restart computes it anew, another --out leaves it as it is",
                case.name
            )));
        }
    }
    Ok(())
}

/// The method that the summary in `folder` states, if there is one.
fn stated_method(folder: &Path) -> Result<Option<String>, RunnerError> {
    let path = folder.join(SUMMARY);
    let bytes = match read_whole(&path, LARGEST) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(OutputError::write(&path, error).into()),
    };
    // What is no JSON is told of when the case is gone on with.
    let summary: Value = serde_json::from_slice(&bytes).unwrap_or_default();
    Ok(summary["method"].as_str().map(str::to_owned))
}

/// Runs `case` on so many `threads`, from its checkpoint where there is one, until it is done or
/// `stop` says so; a finished one is only read. None where it was stopped while its bed was
/// settling.
///
/// # Errors
/// When the input asks for something that cannot be, or a file cannot be written.
pub fn run(
    sweep: &Sweep,
    case: &Case,
    threads: usize,
    watch: &mut dyn Watch,
    stop: &dyn Fn() -> bool,
) -> Result<Option<CaseResult>, RunnerError> {
    let job = Job {
        threads,
        ..job(sweep, case)
    };
    let finished = runner::run(&job, watch, stop);
    let (finished, run) = finished.map_err(|error| error.within(&case.name))?;
    let (ending, results) = (finished.ending, finished.results);
    let Some(view) = run.at().state() else {
        return match ending {
            Ending::Faulted(fault) => Err(RunnerError::Input(format!(
                "{}: the bed cannot settle: {fault}",
                case.name
            ))),
            Ending::Done | Ending::Interrupted => Ok(None),
        };
    };
    let method = stated_method(&job.out)?;
    Ok(Some(CaseResult::of(case, ending, results, view, method)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_earlier_call_had_done_is_not_done_in_this_one() {
        let mut half = &CaseProgress::default();
        assert_eq!(half.since_first(), 0.0);
        half.running(0.5, &String::new);
        half.running(0.75, &String::new);
        assert_eq!((half.get(), half.since_first()), (0.75, 0.25));
        let done = CaseProgress::default();
        done.set(1.0);
        assert_eq!((done.get(), done.since_first()), (1.0, 0.0));
    }
}
