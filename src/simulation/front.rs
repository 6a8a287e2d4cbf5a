//! What panels, views and the headless runner see of a run, and how they change it.
//!
//! In: a scene, then [`Command`]s and ticks. Out: the newest state, the samples so far, what the run is doing. The run
//! itself is moved by a driver, inline or on a thread of its own; which one does not show in the trajectory.

use super::bed::BedStore;
use super::driver::Driver;
use super::engine::{Engine, Order, SavedFile, Update};
use super::parameter::ParameterInfo;
use super::preparation::Preparation;
use super::session::Session;
use super::timeline::Past;
use super::{Command, Parameter, ScriptedCommand, StampedCommand};
use crate::measure::{Avalanche, FlowHistory, Measure, Sample, Series, avalanches};
use crate::scene::Scene;
use crate::solver::{Fault, Profile, TimeStepAdvice, advise};
use crate::world::World;
use bevy::ecs::resource::Resource;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Smallest drop of the surface that counts as an avalanche [rad], 1°.
pub const SMALLEST_DROP: f64 = std::f64::consts::PI / 180.0;

/// Wall-clock time over which the real-time factor is measured.
const RATE_TIME: Duration = Duration::from_millis(400);

/// Wall-clock time of running after which a run is worth keeping even if nothing was changed in it.
const LONG_RUN: Duration = Duration::from_mins(5);

/// How a simulation is opened.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Who moves the run.
    pub driver: DriverKind,
    /// Threads the solver works on.
    pub threads: usize,
    /// Whether the run starts by itself.
    pub autoplay: bool,
    /// Simulated seconds per wall-clock second to aim for; infinity for as fast as the machine can.
    pub speed: f64,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
    /// Commands carried out by themselves when their time comes.
    pub script: Vec<ScriptedCommand>,
    /// Memory for states to come back to [bytes]; without any, an earlier moment is computed from time zero.
    pub memory: usize,
}

/// Memory for states to come back to in a window [bytes].
const WINDOW_MEMORY: usize = 1 << 30;

/// Who moves a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriverKind {
    /// The caller of [`Simulation::tick`], within the call.
    Inline,
    /// A thread of its own; no call ever waits for it.
    Thread,
}

impl Options {
    /// For a window: a thread of its own that leaves one core to the picture, in real time.
    pub fn window() -> Self {
        Self {
            driver: DriverKind::Thread,
            threads: available_threads().saturating_sub(1).max(1),
            autoplay: true,
            speed: 1.0,
            beds: BedStore::user(),
            script: Vec::new(),
            memory: WINDOW_MEMORY,
        }
    }

    /// Without a window: inline, all cores, as fast as the machine can; nobody goes back.
    pub fn headless() -> Self {
        Self {
            driver: DriverKind::Inline,
            threads: available_threads(),
            speed: f64::INFINITY,
            memory: 0,
            ..Self::window()
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::window()
    }
}

fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// What a simulation does now.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// The run is not at time zero yet.
    Preparing {
        /// What is being done.
        stage: String,
        /// How far it has come, 0 … 1.
        progress: f32,
    },
    /// It is on the way to the moment that was asked for.
    Seeking {
        /// How much of the way is done, 0 … 1.
        progress: f32,
    },
    /// It holds.
    Paused,
    /// It goes on.
    Running,
    /// The solver met an absurd state; the last good one is shown, none where the bed was still settling.
    Faulted(Fault),
    /// There is no run, for the reason given.
    Failed(String),
}

/// A simulation as the outside sees it.
#[derive(Resource)]
pub struct Simulation {
    scene: Arc<Scene>,
    advice: TimeStepAdvice,
    driver: Option<Driver>,
    speed: f64,
    world: Option<Arc<World>>,
    parameters: Arc<[ParameterInfo]>,
    series: Series,
    flow: Arc<FlowHistory>,
    avalanches: Avalanches,
    commands: Vec<StampedCommand>,
    past: Past,
    /// How often [`Simulation::commands`] became another list.
    revision: u64,
    /// The step asked for and not yet reached.
    sought: Option<u64>,
    /// Values asked for and not yet carried out.
    asked: BTreeMap<Parameter, f64>,
    /// Commands sent so far, and those of them that were taken up.
    sent: u64,
    answered: u64,
    status: Status,
    profile: Profile,
    rate: Rate,
    warnings: Vec<String>,
    generation: u64,
    saved: Saved,
}

/// What is known of the files a session was written to.
#[derive(Default)]
struct Saved {
    /// News of files, not yet taken.
    files: Vec<SavedFile>,
    /// Commands sent before each file that is still to be written.
    pending: Vec<u64>,
    /// The revision that the last file holds, or that the simulation was opened with.
    revision: u64,
    /// Wall-clock time of running since then.
    worked: Duration,
}

impl Simulation {
    /// Opens `scene`. On a thread this returns at once and the run is prepared there; inline it is prepared by ticks.
    pub fn open(scene: Scene, options: Options) -> Self {
        let scene = Arc::new(scene);
        let advice = advise(&scene);
        let speed = options.speed;
        let driver = drive(scene.clone(), advice.time_step, options);
        Self::with(scene, advice, speed, driver)
    }

    /// Opens `session` at the moment that was shown. What `options` say of beds and scripts means nothing for it.
    pub fn resume(session: Session, options: Options) -> Self {
        let scene = Arc::new(session.claim().scene.clone());
        let speed = options.speed;
        let make = move || {
            let timeline = session.into_timeline(options.threads, options.memory);
            Engine::resume(timeline, options.autoplay, speed)
        };
        let driver = driven(options.driver, make);
        let advice = advise(&scene);
        Self::with(scene, advice, speed, driver)
    }

    fn with(
        scene: Arc<Scene>,
        advice: TimeStepAdvice,
        speed: f64,
        driver: std::io::Result<Driver>,
    ) -> Self {
        let mut simulation = Self {
            scene,
            speed,
            world: None,
            parameters: Arc::new([]),
            series: Series::default(),
            flow: Arc::default(),
            avalanches: Avalanches::default(),
            commands: Vec::new(),
            past: Past::default(),
            revision: 0,
            sought: None,
            asked: BTreeMap::new(),
            sent: 0,
            answered: 0,
            status: Status::Preparing {
                stage: "starting".into(),
                progress: 0.0,
            },
            profile: Profile::default(),
            rate: Rate::default(),
            warnings: advice.warning.iter().cloned().collect(),
            advice,
            generation: 0,
            saved: Saved::default(),
            driver: None,
        };
        match driver {
            Ok(driver) => simulation.driver = Some(driver),
            Err(error) => {
                simulation.status =
                    Status::Failed(format!("the system gives the solver no thread: {error}"));
            }
        }
        simulation
    }

    /// What was asked for.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The newest state; none while the run is prepared.
    pub fn world(&self) -> Option<&Arc<World>> {
        self.world.as_ref()
    }

    /// Changes whenever [`Simulation::world`] is another state.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The samples of the present run so far, one every [`super::SAMPLE_INTERVAL`]; those after the state shown too.
    pub fn series(&self) -> &Series {
        &self.series
    }

    /// The last sample at or before the state shown.
    pub fn sample(&self) -> Option<Sample> {
        let step = self.world.as_ref()?.clock.step;
        let steps = self.series.steps();
        let samples = steps.partition_point(|&sampled| sampled <= step);
        self.series.get(samples.checked_sub(1)?)
    }

    /// What lies behind and ahead of the state shown.
    pub fn past(&self) -> &Past {
        &self.past
    }

    /// The step that is shown, or the one that was asked for and is still on its way.
    pub fn step(&self) -> u64 {
        let shown = || self.world.as_ref().map_or(0, |world| world.clock.step);
        self.sought.unwrap_or_else(shown)
    }

    /// Changes whenever [`Simulation::commands`] is another list.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether the state shown is not the newest of the present run.
    pub fn looks_back(&self) -> bool {
        self.step() < self.past.end.step
    }

    /// The flowing layer so far.
    pub fn flow(&self) -> &FlowHistory {
        &self.flow
    }

    /// The avalanches so far, of [`SMALLEST_DROP`] at least.
    pub fn avalanches(&self) -> &[Avalanche] {
        &self.avalanches.list
    }

    /// What it does now.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The parameters that can change while it goes on; none while the run is prepared.
    pub fn parameters(&self) -> &[ParameterInfo] {
        &self.parameters
    }

    /// Present value of `parameter` in SI units, or the value asked for where that is still to be carried out; NaN where
    /// the scene has no such parameter.
    pub fn value(&self, parameter: &Parameter) -> f64 {
        let asked = self.asked.get(parameter).copied();
        let present = || parameter.read(self.world.as_ref()?);
        asked.or_else(present).unwrap_or(f64::NAN)
    }

    /// Asks for `command`; it is carried out before the next slice of steps, stamped and kept.
    pub fn send(&mut self, command: Command) {
        match &command {
            Command::Set { parameter, value } => {
                self.asked.insert(parameter.clone(), *value);
            }
            Command::Speed(speed) => self.speed = *speed,
            Command::Seek(step) => self.sought = Some(*step),
            _ => {}
        }
        self.sent += 1;
        self.order(Order::Command(command));
    }

    /// Writes the whole session to `path`, off this thread where there is another; what becomes of it is told by
    /// [`Simulation::take_saved`].
    pub fn save(&mut self, path: PathBuf) {
        self.saved.pending.push(self.sent);
        self.order(Order::Save(path));
    }

    /// What became of files since this was last called.
    pub fn take_saved(&mut self) -> Vec<SavedFile> {
        std::mem::take(&mut self.saved.files)
    }

    /// Whether a file is still to be written.
    pub fn is_saving(&self) -> bool {
        !self.saved.pending.is_empty()
    }

    /// Whether there is something that no file holds and that would be missed: changes, runs that were kept, or minutes of
    /// computing.
    pub fn is_unsaved(&self) -> bool {
        let past = &self.past;
        let changed = past.undo.is_some() || past.redo.is_some() || !past.kept.is_empty();
        (changed && self.revision != self.saved.revision) || self.saved.worked > LONG_RUN
    }

    /// Whether every command that was sent has been taken up.
    pub fn has_answered(&self) -> bool {
        self.answered == self.sent
    }

    /// Lets the run go no further than `step` for now, or as far as it will.
    pub fn hold_at(&mut self, step: Option<u64>) {
        self.order(Order::Hold(step));
    }

    /// The commands carried out in the present run since time zero; those after the state shown too.
    pub fn commands(&self) -> &[StampedCommand] {
        &self.commands
    }

    /// Simulated seconds per wall-clock second that were asked for.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Simulated seconds per wall-clock second lately; zero while it holds.
    pub fn real_time_factor(&self) -> f64 {
        match self.status {
            Status::Running => self.rate.value,
            _ => 0.0,
        }
    }

    /// Where the solver's time went lately.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The time step and its reasons.
    pub fn advice(&self) -> &TimeStepAdvice {
        &self.advice
    }

    /// What people should know, in sentences: refused commands, a bed that could not be kept …
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Lets `passed` wall-clock time pass: hands the next slice of steps over and takes in what is new.
    pub fn tick(&mut self, passed: Duration) {
        let Some(driver) = &mut self.driver else {
            return;
        };
        let update = driver.tick(passed);
        if update.is_none() && driver.has_died() {
            self.driver = None;
            self.status =
                Status::Failed("the solver's thread ended; this is a mistake in Grainfall".into());
        }
        if let Some(update) = update {
            self.take(update);
        }
        if self.status == Status::Running {
            self.saved.worked += passed;
        }
    }

    fn order(&mut self, order: Order) {
        if let Some(driver) = &mut self.driver {
            driver.order(order);
        }
    }

    fn take(&mut self, update: Update) {
        if update.switched {
            self.series.truncate(0);
            self.flow = Arc::default();
            self.commands.clear();
            self.avalanches = Avalanches::default();
        }
        if update.switched || !update.commands.is_empty() {
            self.revision += 1;
        }
        for sample in update.samples {
            self.series.push(sample);
        }
        self.flow = update.flow.unwrap_or(self.flow.clone());
        self.commands.extend(update.commands);
        self.past = update.past.unwrap_or(std::mem::take(&mut self.past));
        self.warnings.extend(update.warnings);
        self.answered = update.answered;
        if self.has_answered() {
            self.asked.clear();
        }
        self.status = update.status.unwrap_or(self.status.clone());
        if self.has_answered() && !matches!(self.status, Status::Seeking { .. }) {
            self.sought = None;
        }
        if let Some(parameters) = update.parameters {
            self.parameters = parameters;
            self.saved.revision = self.revision;
        }
        self.take_files(update.saved);
        self.profile = update.profile.unwrap_or(std::mem::take(&mut self.profile));
        if self.status != Status::Running {
            self.rate.since = None;
        }
        if let Some(world) = update.world {
            self.rate.follow(world.time());
            self.world = Some(world);
            self.generation += 1;
        }
        self.avalanches.follow(&self.series);
    }

    fn take_files(&mut self, files: Vec<SavedFile>) {
        let pending = std::mem::take(&mut self.saved.pending);
        let (answered, waiting) = pending.split_at(files.len().min(pending.len()));
        self.saved.pending = waiting.to_vec();
        for (file, &sent) in files.into_iter().zip(answered) {
            // Commands that followed before the news came may be in this revision and not in the file.
            if file.outcome.is_ok() && sent == self.answered {
                self.saved.revision = self.revision;
                self.saved.worked = Duration::ZERO;
            }
            self.saved.files.push(file);
        }
    }
}

/// The driver that `options` ask for, with an engine for `scene`.
fn drive(scene: Arc<Scene>, time_step: f64, options: Options) -> std::io::Result<Driver> {
    let kind = options.driver;
    let make = move || {
        let preparation = Preparation::new(scene, time_step, options.threads, options.beds);
        Engine::new(
            preparation,
            options.script,
            options.memory,
            options.autoplay,
            options.speed,
        )
    };
    driven(kind, make)
}

/// The driver of this `kind` with the engine that `make` makes.
fn driven(
    kind: DriverKind,
    make: impl FnOnce() -> Engine + Send + 'static,
) -> std::io::Result<Driver> {
    match kind {
        DriverKind::Inline => Ok(Driver::inline(make())),
        DriverKind::Thread => Driver::thread(make),
    }
}

/// The avalanches of a growing series.
#[derive(Default)]
struct Avalanches {
    list: Vec<Avalanche>,
    samples: usize,
    due: Option<Instant>,
}

impl Avalanches {
    /// Looks through `series` again where it has grown, spending a twentieth of the time at most.
    fn follow(&mut self, series: &Series) {
        let started = Instant::now();
        if series.len() == self.samples || self.due.is_some_and(|due| due > started) {
            return;
        }
        self.list = avalanches(
            series.time(),
            series.column(Measure::SurfaceAngle),
            SMALLEST_DROP,
        );
        self.samples = series.len();
        self.due = Some(started + 20 * started.elapsed());
    }
}

/// Simulated time per wall-clock time, measured over [`RATE_TIME`].
#[derive(Default)]
struct Rate {
    value: f64,
    since: Option<(Instant, f64)>,
}

impl Rate {
    fn follow(&mut self, time: f64) {
        let (since, from) = *self.since.get_or_insert((Instant::now(), time));
        let passed = since.elapsed();
        if time < from {
            self.since = None;
        } else if passed >= RATE_TIME {
            self.value = (time - from) / passed.as_secs_f64();
            self.since = Some((Instant::now(), time));
        }
    }
}
