//! Variations of a scene, run side by side, and their results set beside each other.
//!
//! In: a scene and what to vary about it. Out: a folder with one folder per case (`summary.json`, `series.csv`, and `flow.csv`
//! and `velocity.csv` or a column's `profile.csv`), a table of all results (`table.csv`, `table.md`) and plots with the paper's
//! laws drawn in. Each case takes one core. A sweep that was stopped goes on when it is called again: finished cases are kept,
//! others go on from their checkpoints.

mod case;
pub(crate) mod chart;
mod checkpoint;
mod column_plots;
mod drum_plots;
mod plan;
mod plot_files;
mod results_table;
mod velocity_plot;

pub use plan::{Case, Variation};

use crate::headless::{HeadlessError, Progress, spoken};
use crate::scene::Scene;
use crate::simulation::BedStore;
use case::{CaseEnding, Outcome, Share};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// What to run.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What the scene was called.
    pub name: String,
    /// The scene that is varied.
    pub scene: Scene,
    /// What is changed in every case, as `--set` has it.
    pub settings: Vec<String>,
    /// What is varied.
    pub variations: Vec<Variation>,
    /// The output folder.
    pub out: PathBuf,
    /// Cases that run at the same time.
    pub jobs: usize,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
}

/// How a sweep ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepEnding {
    /// Every case is done.
    Done,
    /// Every case that could be run is done; this many met a fault.
    Faulted(usize),
    /// Somebody stopped it; it goes on when it is called again.
    Interrupted,
}

impl SweepEnding {
    /// What the process ends with: 0, 3 or 130.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Faulted(_) => 3,
            Self::Interrupted => 130,
        }
    }
}

/// Time between two looks at how far the cases have come.
const LOOK_TIME: Duration = Duration::from_millis(100);

/// Runs `sweep` until every case is done or `interrupted` becomes true; prints progress to standard error and the table to
/// standard output.
///
/// # Errors
/// A [`HeadlessError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run(sweep: &Sweep, interrupted: &AtomicBool) -> Result<SweepEnding, HeadlessError> {
    let cases = plan::cases(sweep)?;
    let shares: Vec<Share> = cases.iter().map(|_| Share::default()).collect();
    let outcomes = carry_out(sweep, &cases, &shares, interrupted)?;
    results_table::write_tables(sweep, &outcomes)?;
    plot_files::write_plots(sweep, &outcomes)?;
    velocity_plot::write_velocity_plots(sweep, &outcomes)?;
    print!("{}", results_table::markdown(sweep, &outcomes));
    let faults = count(&outcomes, CaseEnding::Faulted);
    let stopped = outcomes.len() < cases.len() || count(&outcomes, CaseEnding::Interrupted) > 0;
    println!("results in {}", sweep.out.display());
    Ok(match faults {
        _ if stopped => SweepEnding::Interrupted,
        0 => SweepEnding::Done,
        faults => SweepEnding::Faulted(faults),
    })
}

fn count(outcomes: &[Outcome], ending: CaseEnding) -> usize {
    outcomes.iter().filter(|o| o.ending == ending).count()
}

/// Runs the cases, the costliest first so that no core idles at the end; returns what became of them in their own order.
fn carry_out(
    sweep: &Sweep,
    cases: &[Case],
    shares: &[Share],
    interrupted: &AtomicBool,
) -> Result<Vec<Outcome>, HeadlessError> {
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by(|&a, &b| cases[b].cost().total_cmp(&cases[a].cost()));
    let next = AtomicUsize::new(0);
    let failed = AtomicBool::new(false);
    let results = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..sweep.jobs.clamp(1, cases.len().max(1)) {
            scope.spawn(|| {
                while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let stop =
                        || interrupted.load(Ordering::Relaxed) || failed.load(Ordering::Relaxed);
                    if stop() {
                        break;
                    }
                    let result = case::run(sweep, &cases[index], &shares[index], &stop);
                    failed.fetch_or(result.is_err(), Ordering::Relaxed);
                    if let Ok(mut results) = results.lock() {
                        results.push((index, result));
                    }
                }
            });
        }
        let working = || {
            let done = results.lock().map_or(0, |results| results.len());
            done < cases.len()
                && !interrupted.load(Ordering::Relaxed)
                && !failed.load(Ordering::Relaxed)
        };
        follow(cases, shares, &working);
    });
    let mut results = results.into_inner().unwrap_or_default();
    results.sort_by_key(|(index, _)| *index);
    results
        .into_iter()
        .filter_map(|(_, result)| result.transpose())
        .collect()
}

/// Tells how far the whole has come while it is `working`.
fn follow(cases: &[Case], shares: &[Share], working: &dyn Fn() -> bool) {
    let mut progress = Progress::new();
    let all: f64 = cases.iter().map(Case::cost).sum();
    let started = Instant::now();
    let done = || -> f64 {
        let parts = cases.iter().zip(shares).map(|(c, s)| c.cost() * s.get());
        parts.sum::<f64>() / all
    };
    let mut before = None;
    while working() {
        std::thread::sleep(LOOK_TIME);
        let share = done();
        // What earlier calls had done took no time in this one.
        let before = *before.get_or_insert(share);
        let elapsed = started.elapsed().as_secs_f64();
        let left = elapsed * (1.0 - share) / (share - before);
        let finished = shares.iter().filter(|share| share.get() >= 1.0).count();
        progress.tell(share, || {
            format!(
                "{finished} of {} cases done, {} left",
                cases.len(),
                spoken(left)
            )
        });
    }
    progress.finish();
}
