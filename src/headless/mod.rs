//! The windowless runner: progress, output files, exit codes.
//!
//! In: a [`Job`]: a scene, where its files go, what to change. Out: the files (`series.csv`, `grains.pvd` with one `.vtp` or
//! `.vtu` per output time, `summary.json`) and an [`Ending`]. The run is moved by the same system as in the window, inline
//! and as fast as the machine can.

mod claim;
mod commands_file;
mod error;
mod folder;
mod grains_file;
mod pack;
mod polyhedra_file;
mod profile_files;
mod progress;
mod recorder;
mod report;
mod series_file;
mod setting;
mod summary_file;
mod velocity_file;

pub use claim::Verdict;
pub use commands_file::read_commands;
pub use error::HeadlessError;
pub(crate) use folder::SUMMARY;
pub use grains_file::write_grains;
pub use pack::pack;
pub(crate) use profile_files::{FLOW, PROFILE, write_flow, write_profile};
pub(crate) use progress::{Progress, spoken};
pub(crate) use series_file::{SERIES, write_series};
pub use setting::{apply_setting, compared_value};
pub(crate) use summary_file::SummaryFile;
pub(crate) use velocity_file::{VELOCITY, write_velocity};

use crate::scene::Scene;
use crate::simulation::{
    BedStore, DriverKind, Options, ScriptedCommand, Simulation, SimulationPlugin, Status,
};
use crate::solver::Fault;
use crate::world::World;
use bevy::MinimalPlugins;
use bevy::app::{App, PluginGroup, TaskPoolOptions, TaskPoolPlugin};
use bevy::time::TimeUpdateStrategy;
use recorder::Recorder;
use report::report;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// What to run and where its files go.
#[derive(Clone, Debug)]
pub struct Job {
    /// The scene.
    pub scene: Scene,
    /// What to call it in the summary.
    pub name: String,
    /// The output folder.
    pub out: PathBuf,
    /// Threads the solver works on.
    pub threads: usize,
    /// Commands carried out when their time comes.
    pub script: Vec<ScriptedCommand>,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// It reached its duration.
    Done,
    /// Somebody stopped it; its files are whole.
    Interrupted,
    /// The solver met an absurd state; the files hold all up to the last good one.
    Faulted(Fault),
}

impl Ending {
    /// What the process ends with: 0, 130 or 3.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Interrupted => 130,
            Self::Faulted(_) => 3,
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Interrupted => "interrupted",
            Self::Faulted(_) => "fault",
        }
    }

    fn fault(&self) -> Option<&Fault> {
        match self {
            Self::Faulted(fault) => Some(fault),
            Self::Done | Self::Interrupted => None,
        }
    }
}

/// Runs `job` until its duration is reached, a fault occurs or `interrupted` becomes true; prints progress to standard
/// error and a summary to standard output.
///
/// # Errors
/// A [`HeadlessError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run(job: &Job, interrupted: &AtomicBool) -> Result<Ending, HeadlessError> {
    let mut simulation = Simulation::open(job.scene.clone(), options(job));
    simulation.hold_at(Some(0));
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
    simulation.hold_at(Some(recorder.next_stop(&world.clock)));
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
