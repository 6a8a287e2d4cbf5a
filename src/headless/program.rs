//! A run without a window, from its scene to its last file, moved on by the same system as in the window.

use super::progress::{Progress, spoken};
use super::recorder::Recorder;
use super::report::report;
use super::{Ending, HeadlessError, Job};
use crate::simulation::{DriverKind, LabCommand, Options, Simulation, SimulationPlugin, Status};
use crate::world::World;
use bevy::MinimalPlugins;
use bevy::app::{App, PluginGroup, TaskPoolOptions, TaskPoolPlugin};
use bevy::time::TimeUpdateStrategy;
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs `job` until its duration is reached, a fault occurs or `interrupted` becomes true; prints progress to standard
/// error and a summary to standard output.
///
/// # Errors
/// A [`HeadlessError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run(job: &Job, interrupted: &AtomicBool) -> Result<Ending, HeadlessError> {
    let mut simulation = Simulation::open(job.scene.clone(), options(job));
    simulation.send(LabCommand::Hold(Some(0)));
    let mut recorder = Recorder::open(job, &simulation)?;
    let mut app = app(simulation);
    let mut progress = Progress::new();
    let ending = loop {
        app.update();
        let mut simulation = app.world_mut().resource_mut::<Simulation>();
        if let Some(ending) = follow(&mut simulation, &mut recorder, &mut progress)? {
            break ending;
        }
        if interrupted.load(Ordering::Relaxed) {
            break Ending::Interrupted;
        }
    };
    progress.finish();
    let simulation = app.world().resource::<Simulation>();
    let results = recorder.finish(simulation, &ending)?;
    report(simulation, &recorder, &ending, &results);
    Ok(ending)
}

fn options(job: &Job) -> Options {
    Options {
        driver: DriverKind::Inline,
        threads: job.threads,
        autoplay: true,
        speed: f64::INFINITY,
        beds: job.beds.clone(),
        script: job.script.clone(),
        memory: 0,
    }
}

/// An app without a window in which each update is one tick.
fn app(simulation: Simulation) -> App {
    let mut app = App::new();
    let task_pool_options = TaskPoolOptions::with_num_threads(1);
    app.add_plugins((
        MinimalPlugins.set(TaskPoolPlugin { task_pool_options }),
        SimulationPlugin,
    ))
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
    .insert_resource(simulation);
    app
}

/// Records what is due and lets the run go on to its next stop; says how it ended, if it did.
fn follow(
    simulation: &mut Simulation,
    recorder: &mut Recorder,
    progress: &mut Progress,
) -> Result<Option<Ending>, HeadlessError> {
    match simulation.status() {
        Status::Preparing {
            stage,
            progress: share,
        } => {
            progress.tell(f64::from(*share), || stage.clone());
            return Ok(None);
        }
        Status::Failed(reason) => return Err(HeadlessError::Input(reason.clone())),
        Status::Faulted(fault) => return Ok(Some(Ending::Faulted(fault.clone()))),
        Status::Paused | Status::Running | Status::Seeking { .. } => {}
    }
    let Some(world) = simulation.world().cloned() else {
        return Ok(None);
    };
    tell(simulation, &world, progress, recorder.wall_time());
    if recorder.record(simulation, &world)? {
        return Ok(Some(Ending::Done));
    }
    simulation.send(LabCommand::Hold(Some(recorder.next_stop(&world.clock))));
    Ok(None)
}

fn tell(simulation: &Simulation, world: &World, progress: &mut Progress, wall_time: f64) {
    let (time, duration) = (world.time(), simulation.scene().duration);
    let left = wall_time * (duration - time) / time;
    progress.tell(time / duration, || {
        format!(
            "t = {time:.2} s of {duration} s, {:.2} × real time, {} left",
            simulation.real_time_factor(),
            spoken(left)
        )
    });
}
