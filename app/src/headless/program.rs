//! A run without a window, moved on by the same system as in the window.

use super::Progress;
use super::report::Report;
use crate::simulation::{Simulation, SimulationPlugin};
use bevy::MinimalPlugins;
use bevy::app::{App, PluginGroup, TaskPoolOptions, TaskPoolPlugin};
use bevy::time::TimeUpdateStrategy;
use grainfall::lab::{DriverKind, LabCommand, Options, Status};
use grainfall::output::{Ending, OutputError, RunSoFar};
use grainfall::run::{Checkpoint, Measured, Run, Session, Stored, Timeline};
use grainfall::runner::{Advance, At, DirectRun, Halt, Job, Runner, RunnerError};
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs `job` until its duration is reached, a fault occurs or `interrupted` becomes true; prints
/// progress to standard error and a summary to standard output, but where the `report` is to be
/// another.
///
/// # Errors
/// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run(job: &Job, report: Report, interrupted: &AtomicBool) -> Result<Ending, RunnerError> {
    let mut runner = Runner::open(job)?;
    tell_standing(&runner, job, report);
    let checkpoint = runner.take_checkpoint();
    let mut run = RunInApp::of(small_app(), job, checkpoint);
    finish(runner, &mut run, job, report, interrupted)
}

/// Says where a run goes on that was stopped, or is done.
fn tell_standing(runner: &Runner, job: &Job, report: Report) {
    if let Some(time) = runner.goes_on_from() {
        report.note(&if runner.is_done() {
            format!(
                "this run is done already, and {} holds its results; --restart computes it anew",
                job.out.display()
            )
        } else {
            format!(
                "going on from t = {time:.6} s, where the run in {} was stopped",
                job.out.display()
            )
        });
    }
}

/// Moves `run` to the end that `job` asks for, as [`run`] does.
///
/// # Errors
/// As [`run`].
pub fn finish(
    runner: Runner,
    run: &mut dyn Advance,
    job: &Job,
    report: Report,
    interrupted: &AtomicBool,
) -> Result<Ending, RunnerError> {
    let mut progress = Progress::of(report);
    let stop = || interrupted.load(Ordering::Relaxed);
    let finished = runner.finish(run, &mut progress, &stop);
    progress.finish();
    if let Err(RunnerError::Output(OutputError::Write { .. })) = &finished {
        report.note(&format!(
            "what was computed is kept in {} up to its last output: make room there, and the same command goes on",
            job.out.display()
        ));
    }
    let finished = finished?;
    report.run(run.at().state(), &job.out, &finished)?;
    Ok(finished.ending)
}

/// Bevy's smallest app.
fn small_app() -> App {
    let mut app = App::new();
    let task_pool_options = TaskPoolOptions::with_num_threads(1);
    app.add_plugins((
        MinimalPlugins.set(TaskPoolPlugin { task_pool_options }),
        SimulationPlugin,
    ));
    app
}

/// A run within an app without a window, in which each update is one tick.
pub struct RunInApp {
    app: App,
    /// A run that goes on after a stop, until it stands where it stopped.
    resuming: Option<DirectRun>,
    name: String,
    options: Options,
    /// All that was measured, once the run is over.
    measured: Option<Measured>,
}

impl RunInApp {
    /// The run that `job` asks for in an `app` with the [`SimulationPlugin`]: from time zero, or
    /// going on from `checkpoint`.
    pub fn of(mut app: App, job: &Job, checkpoint: Option<Checkpoint>) -> Self {
        app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        let options = options(job);
        let resuming = checkpoint.map(|from| DirectRun::of(job).from_checkpoint(Some(from)));
        if resuming.is_none() {
            app.insert_resource(Simulation::open(job.scene.clone(), options.clone()));
        }
        Self {
            app,
            resuming,
            name: job.name.clone(),
            options,
            measured: None,
        }
    }

    /// Hands the run that stands where it stopped to the app.
    fn hand_over(&mut self, run: Run) {
        let session = Session::of(&self.name, &Timeline::new(run, 0));
        let simulation = Simulation::resume(session, self.options.clone());
        self.app.insert_resource(simulation);
    }

    /// The app that it runs in.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }

    fn simulation(&self) -> Option<&Simulation> {
        self.app.world().get_resource()
    }
}

fn options(job: &Job) -> Options {
    Options {
        driver: DriverKind::Inline,
        threads: job.threads,
        autoplay: true,
        speed: f64::INFINITY,
        beds: job.beds.clone(),
        shows_settling: false,
        script: job.script.clone(),
        memory: 0,
    }
}

impl Advance for RunInApp {
    fn at(&self) -> At<'_> {
        if let Some(resuming) = &self.resuming {
            return resuming.at();
        }
        let starting = At::Preparing {
            stage: "starting",
            share: 0.0,
        };
        let Some(simulation) = self.simulation() else {
            return starting;
        };
        match (simulation.status(), simulation.world()) {
            (Status::Preparing { stage, progress }, _) => At::Preparing {
                stage,
                share: f64::from(*progress),
            },
            (_, None) => starting,
            (_, Some(world)) => At::State(RunSoFar {
                world,
                series: (self.measured.as_ref()).map_or(simulation.series(), |all| &all.series),
                flow: (self.measured.as_ref()).map_or(simulation.flow(), |all| &all.flow),
                meetings: simulation.meetings(),
                commands: simulation.commands(),
                sampling: simulation.sampling(),
            }),
        }
    }

    fn advance(&mut self, goal: u64) -> Result<(), Halt> {
        if let Some(mut resuming) = self.resuming.take() {
            resuming.advance(goal)?;
            match resuming.into_run() {
                Ok(run) => self.hand_over(run),
                Err(resuming) => self.resuming = Some(*resuming),
            }
            return Ok(());
        }
        if let Some(mut simulation) = self.app.world_mut().get_resource_mut::<Simulation>() {
            simulation.send(LabCommand::Hold(Some(goal)));
        }
        self.app.update();
        match self.simulation().map(|simulation| simulation.status()) {
            Some(Status::Failed(reason)) => Err(Halt::Refused(reason.clone())),
            Some(Status::Faulted(fault)) => Err(Halt::Fault(fault.clone())),
            _ => Ok(()),
        }
    }

    fn warnings(&self) -> Vec<String> {
        let simulation = self.simulation();
        simulation.map_or_else(Vec::new, |simulation| simulation.warnings().to_vec())
    }

    fn forget(&mut self, stored: Stored) {
        if let Some(mut simulation) = self.app.world_mut().get_resource_mut::<Simulation>() {
            simulation.send(LabCommand::ForgetMeasured(stored));
        }
    }

    fn remember(&mut self, measured: Measured) {
        self.measured = Some(measured);
    }
}
