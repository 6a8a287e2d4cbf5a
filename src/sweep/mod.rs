//! Variations of a scene, run side by side, and their results set beside each other.
//!
//! In: a scene and what to vary about it. Out: a folder with one folder per case (`summary.json`,
//! `series.csv`, and `flow.csv` and `velocity.csv` or a column's `profile.csv`), a table of all
//! results (`table.csv`, `table.md`) and plots with the paper's laws drawn in. Each case takes one
//! core. Where the seed is varied, cases that differ in nothing else are one experiment, repeated:
//! `ensembles.csv` and `ensembles.md` hold means over the seeds with their standard errors, and so
//! do the plots. A sweep of what a paper varies ends with `statements.md`: the paper's statements,
//! each with the verdict that follows by rule. A sweep that was stopped goes on when it is called
//! again: finished cases are kept, others go on from their checkpoints. Several sweeps may work in
//! one folder at the same time: each case is run by one of them, and each waits for all cases
//! before it writes the tables. A batch system runs the cases one by one ([`run_case`]) and sets
//! what they came to beside each other in the end ([`merge`]).

mod background;
mod case;
pub mod chart;
mod column_laws;
mod column_plots;
mod columns;
mod curve;
mod drum_plots;
mod drums;
mod ensemble;
mod ensemble_table;
mod folder;
mod gather;
mod kasper_parts;
mod kasper_statements;
mod legend;
mod man_loose_statements;
mod man_statements;
mod plan;
mod plot_files;
mod question;
mod results_csv;
mod results_table;
mod stated;
mod statements;
mod statements_file;
mod values;
mod variation;
mod varied;
mod velocity_plot;

pub use background::{BackgroundSweep, SweepStanding};
pub use case::CaseResult;
pub(crate) use case::job;
pub(crate) use columns::{Column, ColumnMeasure, Columns, rounded};
pub use curve::{curve, figures, numbers, varied_number};
pub(crate) use drums::{Drum, Drums, MeasuredBy};
pub(crate) use ensemble::{Ensemble, ensembles};
pub use folder::SWEEP;
pub(crate) use folder::SweepFolder;
pub(crate) use gather::{Kept, gather};
pub(crate) use kasper_statements::drum_statements;
pub(crate) use man_statements::column_statements;
pub use plan::cases;
pub use plan::{Case, Sweep, count};
pub(crate) use plot_files::lacking;
pub use question::Question;
pub(crate) use results_table::TableColumn;
pub use stated::StatedSweep;
pub(crate) use statements::{Statement, table as statements_table};
pub use values::ValueRange;
pub(crate) use variation::READING;
pub use variation::Variation;

use crate::output::{Ending, OutputError};
use crate::runner::{RunnerError, Watch, exit, spoken};
use case::CaseProgress;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

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
    /// That of a sweep of so many `cases` of which these `outcomes` are there.
    fn of(outcomes: &[CaseResult], cases: usize) -> Self {
        let interrupted = (outcomes.iter()).any(|outcome| outcome.ending == Ending::Interrupted);
        let faults = (outcomes.iter()).filter(|outcome| outcome.ending.fault().is_some());
        match faults.count() {
            _ if interrupted || outcomes.len() < cases => Self::Interrupted,
            0 => Self::Done,
            faults => Self::Faulted(faults),
        }
    }

    /// What the process ends with: 0, 3 or 130.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Done => exit::DONE,
            Self::Faulted(_) => exit::FAULT,
            Self::Interrupted => exit::INTERRUPTED,
        }
    }
}

/// Keeps what a case came to, elsewhere than in its folder.
type Keep<'a> = dyn Fn(&CaseResult) -> Result<(), RunnerError> + Sync + 'a;

/// Time between two looks at how far the cases have come.
const LOOK_TIME: Duration = Duration::from_millis(100);

/// How a sweep ended, with its table.
#[derive(Clone, Debug)]
pub struct Swept {
    /// How it ended.
    pub ending: SweepEnding,
    /// Its results side by side, in Markdown.
    pub table: String,
    /// The cases that are not among them, each with how it stands.
    pub missing: Vec<String>,
    /// The cases that met a fault, each with what it was.
    pub faults: Vec<String>,
}

impl Swept {
    fn of(sweep: &Sweep, outcomes: &[CaseResult], cases: usize, missing: Vec<String>) -> Self {
        let fault = |outcome: &CaseResult| {
            let fault = outcome.ending.fault()?;
            Some(format!("{}: {fault}", outcome.case.name))
        };
        Self {
            ending: SweepEnding::of(outcomes, cases),
            table: table(sweep, outcomes),
            missing,
            faults: outcomes.iter().filter_map(fault).collect(),
        }
    }
}

/// Runs `sweep` until every case is done or `interrupted` becomes true; `watch` hears how far it
/// has come.
///
/// # Errors
/// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run(
    sweep: &Sweep,
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
) -> Result<Swept, RunnerError> {
    run_seen(sweep, interrupted, watch, &|_| ())
}

/// Does the same; each case that is done is shown to `see` when it is.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_seen(
    sweep: &Sweep,
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
    see: &(dyn Fn(&CaseResult) + Sync),
) -> Result<Swept, RunnerError> {
    let cases = plan::cases(sweep)?;
    case::check_method(sweep, &cases)?;
    let folder = SweepFolder::open(sweep, &cases)?;
    // The costliest first, so that no core idles at the end.
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by(|&a, &b| cases[b].cost().total_cmp(&cases[a].cost()));
    let keep = |outcome: &CaseResult| {
        see(outcome);
        Ok(())
    };
    let outcomes = run_cases(sweep, &cases, order, interrupted, watch, &keep)?;
    let files = set_beside(sweep, &outcomes)?;
    folder.close(sweep, &outcomes, files)?;
    Ok(Swept::of(sweep, &outcomes, cases.len(), Vec::new()))
}

/// Runs these `cases` of `sweep` one after the other, as they stand, and sets nothing beside each
/// other; each that is done is handed to `keep`.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_in_order(
    sweep: &Sweep,
    cases: &[Case],
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
    keep: &Keep,
) -> Result<SweepEnding, RunnerError> {
    case::check_method(sweep, cases)?;
    SweepFolder::open(sweep, cases)?;
    let order = (0..cases.len()).collect();
    let outcomes = run_cases(sweep, cases, order, interrupted, watch, keep)?;
    Ok(SweepEnding::of(&outcomes, cases.len()))
}

/// Runs case number `number` of `sweep`, from 1 on, and no other, until it is done or `interrupted`
/// becomes true; returns its name and how it ended. Nothing is set beside it: [`merge`] does that.
///
/// # Errors
/// A [`RunnerError`] when there is no such case, the input asks for something that cannot be,
/// another program runs the case, or a file cannot be written.
pub fn run_case(
    sweep: &Sweep,
    number: usize,
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
) -> Result<(String, Ending), RunnerError> {
    let cases = plan::cases(sweep)?;
    let own = number.checked_sub(1).and_then(|index| cases.get(index));
    let case = own.ok_or_else(|| {
        RunnerError::Input(format!(
            "--case {number}: expected one of 1 to {}",
            cases.len()
        ))
    })?;
    case::check_method(sweep, std::slice::from_ref(case))?;
    SweepFolder::open(sweep, std::slice::from_ref(case))?;
    let stop = || interrupted.load(Ordering::Relaxed);
    let outcome = case::run(sweep, case, 1, watch, &stop)?;
    let ending = outcome.map_or(Ending::Interrupted, |outcome| outcome.ending);
    Ok((case.name.clone(), ending))
}

/// Sets what the cases of `sweep` came to beside each other, and computes nothing: cases that are
/// not done are named.
///
/// # Errors
/// A [`RunnerError`] when nobody began the sweep, its cases have other values, or a file cannot be
/// read or written.
pub fn merge(sweep: &Sweep) -> Result<Swept, RunnerError> {
    let cases = plan::cases(sweep)?;
    if !SweepFolder::exists(sweep)? {
        return Err(RunnerError::Input(format!(
            "{} holds no sweep: run its cases first, or say where it is with --out",
            sweep.out.display()
        )));
    }
    let folder = SweepFolder::open(sweep, &cases)?;
    let (outcomes, missing) = gather(sweep, &cases, &[])?;
    let files = set_beside(sweep, &outcomes)?;
    folder.close(sweep, &outcomes, files)?;
    Ok(Swept::of(sweep, &outcomes, cases.len(), missing))
}

/// Writes tables and plots of these `outcomes`; returns the files' names.
pub(crate) fn set_beside(
    sweep: &Sweep,
    outcomes: &[CaseResult],
) -> Result<Vec<String>, RunnerError> {
    let sound = sound(outcomes);
    let ensembles = ensembles(sweep, &sound);
    let means = means(&ensembles);
    let mut files = results_csv::write_csv(sweep, outcomes, means)?;
    files.push(results_table::write_markdown(sweep, outcomes)?);
    if !means.is_empty() {
        files.push(ensemble_table::write_markdown(sweep, means)?);
    }
    files.extend(statements_file::write_statements(sweep, &ensembles)?);
    let plots = plot_files::plots(sweep, outcomes).chain(curve::curves(sweep, &sound));
    files.extend(plot_files::write_plots(sweep, plots)?);
    files.extend(velocity_plot::write_velocity_plots(sweep, outcomes)?);
    Ok(files)
}

/// The table that people read: means over the seeds where there are several, else the cases.
fn table(sweep: &Sweep, outcomes: &[CaseResult]) -> String {
    let sound = sound(outcomes);
    let ensembles = ensembles(sweep, &sound);
    match means(&ensembles) {
        [] => results_table::markdown(sweep, outcomes),
        means => ensemble_table::markdown(sweep, means),
    }
}

fn sound(outcomes: &[CaseResult]) -> Vec<CaseResult> {
    let sound = outcomes.iter().filter(|own| own.is_sound());
    sound.cloned().collect()
}

/// The ensembles where one of them has several seeds; else none.
fn means<'a, 'b>(ensembles: &'a [Ensemble<'b>]) -> &'a [Ensemble<'b>] {
    let has_seeds = ensembles.iter().any(|ensemble| ensemble.members.len() > 1);
    if has_seeds { ensembles } else { &[] }
}

/// How many of so many `cases` run at the same time, and on how many threads each, where `jobs` may:
/// fewer cases than that share them.
fn shared_out(jobs: usize, cases: usize) -> (usize, usize) {
    let at_once = jobs.clamp(1, cases.max(1));
    (at_once, (jobs / at_once).max(1))
}

/// Runs the cases in this `order`, each that is done handed to `keep`; returns what became of them
/// in their own.
fn run_cases(
    sweep: &Sweep,
    cases: &[Case],
    order: Vec<usize>,
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
    keep: &Keep,
) -> Result<Vec<CaseResult>, RunnerError> {
    let shares: Vec<CaseProgress> = cases.iter().map(|_| CaseProgress::default()).collect();
    let (at_once, threads) = shared_out(sweep.jobs, order.len());
    let waiting = Mutex::new(VecDeque::from(order));
    let next = || {
        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.pop_front()
    };
    let failed = AtomicBool::new(false);
    let stop = || interrupted.load(Ordering::Relaxed) || failed.load(Ordering::Relaxed);
    let results = Mutex::new(Vec::new());
    let follower = std::thread::current();
    std::thread::scope(|scope| {
        for _ in 0..at_once {
            scope.spawn(|| {
                while let Some(index) = next().filter(|_| !stop()) {
                    let mut share = &shares[index];
                    let result = case::run(sweep, &cases[index], threads, &mut share, &stop);
                    let result = result.and_then(|outcome| kept(outcome, keep));
                    if let Err(RunnerError::Output(OutputError::Taken { .. })) = result {
                        // Another sweep is at it: its outcome is read when that is done.
                        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
                        waiting.push_back(index);
                        drop(waiting);
                        std::thread::sleep(LOOK_TIME);
                        continue;
                    }
                    if let Ok(Some(outcome)) = &result
                        && outcome.ending != Ending::Interrupted
                    {
                        share.set(1.0);
                    }
                    failed.fetch_or(result.is_err(), Ordering::Relaxed);
                    let mut results = results.lock().unwrap_or_else(PoisonError::into_inner);
                    results.push((index, result));
                    follower.unpark();
                }
            });
        }
        let done = || results.lock().map_or(0, |results| results.len());
        follow(cases, &shares, watch, &|| done() < cases.len() && !stop());
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(index, _)| *index);
    let results = results.into_iter();
    results
        .filter_map(|(_, result)| result.transpose())
        .collect()
}

/// The `outcome` of a case, handed to `keep` where it is done.
fn kept(outcome: Option<CaseResult>, keep: &Keep) -> Result<Option<CaseResult>, RunnerError> {
    let done = outcome.as_ref().filter(|own| own.ending == Ending::Done);
    done.map_or(Ok(()), keep)?;
    Ok(outcome)
}

/// Tells how far the whole has come while it is `working`.
fn follow(
    cases: &[Case],
    shares: &[CaseProgress],
    watch: &mut dyn Watch,
    working: &dyn Fn() -> bool,
) {
    let all: f64 = cases.iter().map(Case::cost).sum();
    let started = Instant::now();
    let sum = |part: fn(&CaseProgress) -> f64| -> f64 {
        let parts = cases.iter().zip(shares).map(|(c, s)| c.cost() * part(s));
        parts.sum::<f64>() / all
    };
    while working() {
        // Until a case is over, or for so long.
        std::thread::park_timeout(LOOK_TIME);
        let share = sum(CaseProgress::get);
        let elapsed = started.elapsed().as_secs_f64();
        let left = elapsed * (1.0 - share) / sum(CaseProgress::since_first);
        let finished = shares.iter().filter(|share| share.get() >= 1.0).count();
        let preparing = shares.iter().filter(|share| share.is_preparing()).count();
        watch.parts(&shares.iter().map(CaseProgress::part).collect::<Vec<_>>());
        watch.running(share, &|| {
            let beds = match preparing {
                0 => String::new(),
                count => format!("{count} settling, "),
            };
            format!(
                "{finished} of {} cases done, {beds}{} left",
                cases.len(),
                spoken(left)
            )
        });
    }
}

#[cfg(test)]
mod tests {
    use super::shared_out;

    #[test]
    fn fewer_cases_than_jobs_share_them() {
        for (jobs, cases, expected) in [
            (2, 1, (1, 2)),
            (2, 2, (2, 1)),
            (2, 9, (2, 1)),
            (16, 3, (3, 5)),
            (4, 0, (1, 4)),
            (0, 3, (1, 1)),
        ] {
            assert_eq!(
                shared_out(jobs, cases),
                expected,
                "{jobs} jobs, {cases} cases"
            );
        }
    }
}
