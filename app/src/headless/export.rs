//! `grainfall export SCENE`: a scene handed to an engine that runs under MPI.

use super::terminal::say;
use super::{Progress, Report};
use grainfall::engines::{Export, ExportError, MpiEngine, export};
use grainfall::run::{Run, Script};
use grainfall::runner::{Advance, At, DirectRun, Halt, Job, RunnerError};
use grainfall::solver::advise;
use grainfall::world::build;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Writes what `engine` takes to run `job` to its folder, its bed settled or as the filling is
/// placed; progress goes to standard error, what is different in the engine is said. Returns
/// whether it came to that before `interrupted` became true.
///
/// # Errors
/// When the engine does not have what the job asks for, or the folder cannot be written.
pub fn hand_over(
    job: &Job,
    engine: MpiEngine,
    settles: bool,
    report: Report,
    interrupted: &AtomicBool,
) -> Result<bool, RunnerError> {
    job.check()?;
    let is_at_start = |step: Option<u64>, time: Option<f64>| step == Some(0) || time == Some(0.0);
    if (job.script.iter()).any(|command| !is_at_start(command.step, command.time)) {
        return Err(RunnerError::Input(format!(
            "commands after time zero are not handed to {engine}: it runs the scene as it begins"
        )));
    }
    let run = if settles {
        settled(job, report, interrupted)?
    } else {
        Some(placed(job)?)
    };
    let Some(run) = run else {
        return Ok(false);
    };
    let world = run.world();
    let handed = Export {
        name: &job.name,
        scene: &job.scene,
        commands: &job.script,
        world,
        is_settled: settles,
    };
    let exported = export(handed, engine, &job.out).map_err(|error| match error {
        ExportError::Unwritten(error) => error.into(),
        refused => RunnerError::Input(refused.to_string()),
    })?;
    if report == Report::Text {
        say(&format!(
            "{} grains for {engine}: {} steps of {:e} s, a dump every {}",
            world.grains.len(),
            exported.steps.run,
            exported.time_step,
            exported.steps.output
        ));
        say(&format!("what {engine} does otherwise:"));
        for deviation in &exported.deviations {
            say(&format!("  - {deviation}"));
        }
        let folder = job.out.display();
        say(&format!(
            "files in {folder}: run them with `sh {folder}/run.sh 4`"
        ));
    }
    Ok(true)
}

/// The run of `job` at time zero, its bed settled; none where it was stopped before.
fn settled(
    job: &Job,
    report: Report,
    interrupted: &AtomicBool,
) -> Result<Option<Run>, RunnerError> {
    let mut run = DirectRun::of(job);
    let mut progress = Progress::of(report);
    while let At::Preparing { stage, share } = run.at() {
        if interrupted.load(Ordering::Relaxed) {
            progress.finish();
            return Ok(None);
        }
        progress.tell(share, || stage.to_owned());
        run.advance(0).map_err(|halt| match halt {
            Halt::Fault(fault) => RunnerError::Input(format!("the bed cannot settle: {fault}")),
            Halt::Refused(reason) => RunnerError::Input(reason),
        })?;
    }
    progress.finish();
    for warning in run.warnings() {
        report.note(&warning);
    }
    Ok(run.into_run().ok())
}

/// The run of `job` at time zero, its grains where the filling places them.
fn placed(job: &Job) -> Result<Run, RunnerError> {
    let input = |reason: String| RunnerError::Input(reason);
    let scene = Arc::new(job.scene.clone());
    let world = build(&scene, advise(&scene).time_step);
    let script = Script::new(&job.script, &world.clock);
    let script = script.map_err(|error| input(error.to_string()))?;
    let mut run = Run::new(scene, world, job.threads);
    run.schedule(script)
        .map_err(|error| input(error.to_string()))?;
    Ok(run)
}
