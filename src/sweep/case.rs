//! One case: run, checkpointed, written.

use super::checkpoint::{self, CaseKey};
use super::{Case, Sweep};
use crate::files::write_whole;
use crate::headless::{
    FLOW, HeadlessError, PROFILE, SERIES, SUMMARY, SummaryFile, VELOCITY, write_flow,
    write_profile, write_series, write_velocity,
};
use crate::measure::{
    Deposit, FlowProfile, Measure, ResultKey, RunQuantity, Series, Summary, VelocityMap, results,
};
use crate::simulation::{Preparation, Provenance, Run, SMALLEST_DROP, Script, TABLES_METADATA};
use crate::solver::Fault;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Wall-clock time between two checkpoints.
const CHECKPOINT_TIME: Duration = Duration::from_secs(20);
/// Grains times steps between two looks at the clock: some seconds of the slowest grains.
const SLICE: u64 = 1_000_000;
/// Share of a run, from its start, that results leave out: the paper averages over the last 30 of 50 s.
const LEFT_OUT: f64 = 0.4;

/// How far a case has come, for others to see.
#[derive(Default)]
pub struct Share(AtomicU64);

impl Share {
    /// 0 … 1.
    pub fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    fn set(&self, share: f64) {
        self.0.store(share.to_bits(), Ordering::Relaxed);
    }
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaseEnding {
    /// It reached its duration.
    Done,
    /// It was stopped and left a checkpoint.
    Interrupted,
    /// The solver met an absurd state.
    Faulted,
}

/// What became of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Which one.
    pub case: Case,
    /// How it ended.
    pub ending: CaseEnding,
    /// Its results.
    pub results: Summary,
    /// Its samples.
    pub series: Series,
    /// Its flowing layer.
    pub flow: FlowProfile,
    /// Its fastest moment.
    pub fastest: Option<VelocityMap>,
    /// Hash of its last state.
    pub hash: String,
}

impl Outcome {
    /// Whether a column collapsed.
    pub fn is_column(&self) -> bool {
        self.results.entry(RunQuantity::AspectRatio).is_some()
    }

    /// The result `key` as a number in the SI unit.
    pub fn result(&self, key: impl Into<ResultKey>) -> Option<f64> {
        self.results.value(key)
    }
}

/// Runs `case`, from its checkpoint where there is one, until it is done or `stop` says so; a finished one is only read.
/// None where it was stopped while its bed was settling.
///
/// # Errors
/// When the input asks for something that cannot be, or a file cannot be written.
pub fn run(
    sweep: &Sweep,
    case: &Case,
    share: &Share,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Outcome>, HeadlessError> {
    let folder = sweep.out.join(&case.name);
    let key = CaseKey::of(case);
    let Some(mut run) = prepared(sweep, case, stop)? else {
        return Ok(None);
    };
    share.set(0.0);
    if let Some(checkpoint) = checkpoint::read(&folder, &key) {
        run.resume(checkpoint);
    }
    let started = Instant::now();
    let (ending, fault) = advance(&mut run, case, &folder, &key, share, stop)?;
    let outcome = outcome(case, &run, ending);
    checkpoint::write_checkpoint(&folder, &key, &run.checkpoint())?;
    write_files(
        case,
        &folder,
        &run,
        &outcome,
        fault.as_ref(),
        started.elapsed(),
    )?;
    if ending != CaseEnding::Interrupted {
        share.set(1.0);
    }
    Ok(Some(outcome))
}

/// The run of `case` at time zero; none where it was stopped before.
fn prepared(
    sweep: &Sweep,
    case: &Case,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Run>, HeadlessError> {
    let name = &case.name;
    let scene = Arc::new(case.scene.clone());
    let mut preparation = Preparation::new(scene, case.time_step, 1, sweep.beds.clone());
    let refuse = |reason: String| HeadlessError::Input(format!("{name}: {reason}"));
    let settled = preparation.go_through(stop);
    let settled = settled.map_err(|fault| refuse(format!("the bed cannot settle: {fault}")))?;
    let Some(mut run) = settled else {
        return Ok(None);
    };
    let script =
        Script::new(&case.script, &run.world().clock).map_err(|e| refuse(e.to_string()))?;
    run.schedule(script).map_err(|e| refuse(e.to_string()))?;
    Ok(Some(run))
}

fn advance(
    run: &mut Run,
    case: &Case,
    folder: &Path,
    key: &CaseKey,
    share: &Share,
    stop: &dyn Fn() -> bool,
) -> Result<(CaseEnding, Option<Fault>), HeadlessError> {
    let duration = case.scene.duration;
    let mut kept = Instant::now();
    loop {
        let clock = run.world().clock;
        let end = clock.step_at(duration);
        share.set((clock.time() / duration).min(0.999_999));
        if clock.step >= end {
            return Ok((CaseEnding::Done, None));
        }
        if stop() {
            return Ok((CaseEnding::Interrupted, None));
        }
        let slice = (SLICE / run.world().grains.len().max(1) as u64).max(1);
        if let Err(fault) = run.advance_to(end.min(clock.step + slice)) {
            return Ok((CaseEnding::Faulted, Some(fault)));
        }
        if kept.elapsed() > CHECKPOINT_TIME {
            checkpoint::write_checkpoint(folder, key, &run.checkpoint())?;
            kept = Instant::now();
        }
    }
}

fn outcome(case: &Case, run: &Run, ending: CaseEnding) -> Outcome {
    let from = LEFT_OUT * run.world().time();
    let results = results(run.series(), run.world(), from, SMALLEST_DROP);
    Outcome {
        case: case.clone(),
        ending,
        results,
        series: run.series().clone(),
        flow: run.flow().since(from),
        fastest: run.flow().fastest_since(from).cloned(),
        hash: run.world().hash().to_string(),
    }
}

fn write_files(
    case: &Case,
    folder: &Path,
    run: &Run,
    outcome: &Outcome,
    fault: Option<&Fault>,
    wall_time: Duration,
) -> Result<(), HeadlessError> {
    let world = run.world();
    let advice = run.advice();
    let summary = SummaryFile {
        program: "grainfall",
        version: env!("CARGO_PKG_VERSION"),
        status: match outcome.ending {
            CaseEnding::Done => "done",
            CaseEnding::Interrupted => "interrupted",
            CaseEnding::Faulted => "fault",
        },
        fault,
        name: &case.name,
        seed: case.scene.seed,
        scene: &case.scene,
        commands: run.commands(),
        time_step: &advice,
        steps: world.clock.step,
        time: world.time(),
        grains: world.grains.len(),
        state_hash: Some(outcome.hash.clone()),
        results: Some(&outcome.results),
        wall_time: wall_time.as_secs_f64(),
        threads: 1,
        warnings: &[],
    };
    write(&folder.join(SUMMARY), |file| summary.write(file))?;
    write(&folder.join(SERIES), |file| {
        write_series(run.series(), &Measure::of(world), file)
    })?;
    let mut tables = vec![SERIES];
    if let Some(deposit) = Deposit::of(world) {
        tables.push(PROFILE);
        write(&folder.join(PROFILE), |file| {
            write_profile(&deposit.height_profile(), file)
        })?;
    } else {
        tables.push(FLOW);
        write(&folder.join(FLOW), |file| write_flow(&outcome.flow, file))?;
    }
    if let Some(map) = &outcome.fastest {
        tables.push(VELOCITY);
        write(&folder.join(VELOCITY), |file| write_velocity(map, file))?;
    }
    let from = Provenance::of(&case.scene, world);
    write(&folder.join(TABLES_METADATA), |file| {
        from.write_tables(&tables, file)
    })
}

/// Writes a file of a sweep, whole or not at all.
pub(super) fn write(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), HeadlessError> {
    write_whole(path, fill).map_err(|source| HeadlessError::Write {
        path: path.to_owned(),
        source,
    })
}
