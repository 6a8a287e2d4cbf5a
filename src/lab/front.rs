//! What panels, views and the headless runner see of a run, and how they change it.
//!
//! In: a scene, then [`Command`]s and ticks. Out: the newest state, the samples so far, what the run is doing. The run
//! itself is moved by a driver, inline or on a thread of its own; which one does not show in the trajectory.

use super::Half;
use super::driver::Driver;
use super::engine::{Beside, Engine, Order, PairChange, SaveOrder, SavedFile, Update};
use super::twin::Twin;
use crate::measure::{Avalanche, FlowHistory, Measure, Sample, Series, avalanches};
use crate::run::{
    BedStore, Changed, Command, History, Parameter, ParameterInfo, Past, Preparation, Provenance,
    Record, Run, ScriptedCommand, Session, Snapshot, StampedCommand, Timeline, check,
};
use crate::scene::Scene;
use crate::solver::{Fault, Profile, TimeStepAdvice, advise};
use crate::world::World;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
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
#[cfg_attr(feature = "headless", derive(bevy::ecs::resource::Resource))]
pub struct Simulation {
    id: u64,
    scene: Arc<Scene>,
    /// The scene as it was opened, before what acts from the next start on was changed.
    original: Arc<Scene>,
    advice: TimeStepAdvice,
    means: Means,
    driver: Option<Driver>,
    /// What the engine has told last, taken in or not.
    heard: Heard,
    /// News that are not taken in yet: those of a pair are when both halves are at the same step.
    pending: Option<Update>,
    /// The run beside this one, if there is one.
    twin: Option<Box<Twin>>,
    speed: f64,
    bed: Option<Arc<World>>,
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
    /// Commands sent so far, those of them that were taken up, and those that wait for the twin before they are sent.
    sent: u64,
    answered: u64,
    waiting: usize,
    status: Status,
    profile: Profile,
    rate: Rate,
    warnings: Vec<String>,
    generation: u64,
    saved: Saved,
}

/// What a run is computed with.
#[derive(Clone, Copy, Debug)]
struct Means {
    driver: DriverKind,
    threads: usize,
    memory: usize,
}

impl Means {
    fn of(options: &Options) -> Self {
        Self {
            driver: options.driver,
            threads: options.threads,
            memory: options.memory,
        }
    }

    /// What each of two runs gets of it.
    fn half(self) -> Self {
        Self {
            threads: (self.threads / 2).max(1),
            memory: self.memory / 2,
            ..self
        }
    }
}

/// What an engine has told last.
pub(super) struct Heard {
    /// What it does.
    pub status: Status,
    /// The step of its newest state.
    pub step: Option<u64>,
    /// Commands that it took up.
    pub answered: u64,
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
        let (speed, means) = (options.speed, Means::of(&options));
        let driver = drive(scene.clone(), advice.time_step, options);
        Self::with(scene, advice, speed, means, driver)
    }

    /// Opens `session` at the moment that was shown. What `options` say of beds and scripts means nothing for it.
    pub fn resume(session: Session, options: Options) -> Self {
        let scene = Arc::new(session.claim().scene.clone());
        let original = session.original().clone();
        let (speed, means) = (options.speed, Means::of(&options));
        let make = move || {
            let timeline = session.into_timeline(options.threads, options.memory);
            Engine::resume(timeline, options.autoplay, speed)
        };
        let driver = driven(options.driver, make);
        let advice = advise(&scene);
        Self::with(scene, advice, speed, means, driver).made_of(original.into())
    }

    fn with(
        scene: Arc<Scene>,
        advice: TimeStepAdvice,
        speed: f64,
        means: Means,
        driver: std::io::Result<Driver>,
    ) -> Self {
        let status = Status::Preparing {
            stage: "starting".into(),
            progress: 0.0,
        };
        let mut simulation = Self {
            id: next_number(),
            original: scene.clone(),
            scene,
            speed,
            means,
            heard: Heard {
                status: status.clone(),
                step: None,
                answered: 0,
            },
            pending: None,
            twin: None,
            bed: None,
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
            waiting: 0,
            status,
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
                simulation.fail(format!("the system gives the solver no thread: {error}"));
            }
        }
        simulation
    }

    /// What was asked for.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene as it was opened: another than [`Simulation::scene`] where what acts from the next start on was changed.
    pub fn original(&self) -> &Arc<Scene> {
        &self.original
    }

    /// The same, of a scene that was made of the `original`.
    #[must_use]
    pub fn made_of(self, original: Arc<Scene>) -> Self {
        Self { original, ..self }
    }

    /// The newest state; none while the run is prepared.
    pub fn world(&self) -> Option<&Arc<World>> {
        self.world.as_ref()
    }

    /// What tells it from every other simulation.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// Where what is shown comes from; nothing before there is a state.
    pub fn provenance(&self) -> Option<Provenance> {
        let provenance = Provenance::of(&self.scene, self.world()?);
        let beside = self.twin().and_then(|twin| {
            let (key, run) = (twin.parameter(), twin.run());
            Some((format!("{key} = {:?}", run.value(key)), run.world()?))
        });
        Some(match beside {
            None => provenance,
            Some((change, world)) => provenance.beside(change, world),
        })
    }

    /// Changes whenever [`Simulation::world`] is another state, and is that of no other simulation.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The samples of the present run so far, one every [`crate::run::SAMPLE_INTERVAL`]; those after the state shown too.
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

    /// What an undo would take back, and a redo bring back; of two runs side by side, what was changed since they began.
    pub fn turns(&self) -> [Option<&Changed>; 2] {
        let past = self.half(Half::Right).past();
        [past.undo.as_ref(), past.redo.as_ref()]
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

    /// Asks for `command`; it is carried out before the next slice of steps, stamped and kept. With a twin it is carried
    /// out in both runs at the same step, unless it is about what they differ in: that concerns this run alone.
    pub fn send(&mut self, command: Command) {
        match &command {
            Command::Set { parameter, value } => self.expect(parameter, *value),
            Command::Speed(speed) => self.speed = *speed,
            Command::Seek(step) => self.sought = Some(*step),
            _ => {}
        }
        match self.twin.take() {
            Some(mut twin) => {
                twin.send(self, command);
                self.twin = Some(twin);
            }
            None => self.ask(command),
        }
    }

    /// Shows `value` as that of `parameter` until what was asked for is carried out.
    pub(super) fn expect(&mut self, parameter: &Parameter, value: f64) {
        self.asked.insert(parameter.clone(), value);
    }

    /// Asks this run's own engine for `command`.
    pub(super) fn ask(&mut self, command: Command) {
        self.sent += 1;
        self.order(Order::Command(command));
    }

    /// Asks this run's own engine for a `change` of a pair.
    pub(super) fn ask_change(&mut self, change: PairChange) {
        self.sent += 1;
        self.order(Order::Change(change));
    }

    /// Writes the whole session to `path`, off this thread where there is another; what becomes of it is told by
    /// [`Simulation::take_saved`]. A twin is in it as a run that was kept.
    pub fn save(&mut self, path: PathBuf) {
        match self.twin.take() {
            Some(mut twin) => {
                twin.save(self, path);
                self.twin = Some(twin);
            }
            None => self.write(path, None),
        }
    }

    /// Lets the engine write the session to `path`, with the run `beside` it.
    pub(super) fn write(&mut self, path: PathBuf, beside: Option<Box<Beside>>) {
        self.saved.pending.push(self.sent);
        self.order(Order::Save(SaveOrder {
            path,
            original: self.original.clone(),
            beside,
        }));
    }

    /// Begins a twin: both runs start afresh at time zero, with the present values of all parameters but `parameter`,
    /// which has its present value in this one and `value` in the other.
    ///
    /// # Errors
    /// Why there can be none now, in a sentence.
    pub fn start_twin(&mut self, parameter: &Parameter, value: f64) -> Result<(), String> {
        if self.twin.is_some() {
            return Err("There is a twin already: end it first".into());
        }
        let (Some(bed), true) = (self.bed.clone(), self.can_start_twin()) else {
            return Err("Two runs start side by side only while the run stands or goes on".into());
        };
        let command = Command::Set {
            parameter: parameter.clone(),
            value,
        };
        check(&self.parameters, &bed, &command).map_err(|refusal| refusal.to_string())?;
        let parameters = self.parameters.iter().map(|info| &info.parameter);
        let values: Vec<_> = parameters
            .map(|parameter| (parameter.clone(), self.value(parameter)))
            .collect();
        let mut run = self.sibling(bed)?;
        let own = |(of, present): &(Parameter, f64)| {
            (of.clone(), if of == parameter { value } else { *present })
        };
        run.restart(values.iter().map(own).collect());
        let goes_on = self.status == Status::Running;
        self.order(Order::Threads(self.means.half().threads));
        // The pair keeps the time: each half goes as fast as it can to the step that both are sent to.
        self.order(Order::Hold(Some(0)));
        self.ask(Command::Speed(f64::INFINITY));
        self.restart(values);
        self.sought = None;
        self.twin = Some(Box::new(Twin::new(run, parameter.clone(), goes_on)));
        Ok(())
    }

    /// Whether the run is one that a twin can be begun of.
    pub fn can_start_twin(&self) -> bool {
        self.twin.is_none() && matches!(self.status, Status::Running | Status::Paused)
    }

    /// Ends the twin: goes on with one of the two runs, and keeps the other beside it.
    pub fn end_twin(&mut self, go_on_with: Half) {
        let Some(twin) = self.twin.take() else {
            return;
        };
        self.order(Order::Adopt(Box::new(twin.beside()), go_on_with));
        self.order(Order::Threads(self.means.threads));
        self.ask(Command::Speed(self.speed));
        let is_held = self.heard.status == Status::Running;
        if twin.goes_on() {
            self.ask(Command::Play);
        } else if is_held && go_on_with == Half::Left {
            self.ask(Command::Pause);
        }
        let (hold, waiting) = twin.end();
        self.waiting = 0;
        self.order(Order::Hold(hold));
        for command in waiting {
            self.ask(command);
        }
    }

    /// The twin, while there is one.
    pub fn twin(&self) -> Option<&Twin> {
        self.twin.as_deref()
    }

    /// Gives the parameter that the two runs differ in another value in the twin; nothing without one.
    pub fn set_twin(&mut self, value: f64) {
        if let Some(mut twin) = self.twin.take() {
            twin.set(self, value);
            self.twin = Some(twin);
        }
    }

    /// One of the two runs; this one without a twin.
    pub fn half(&self, half: Half) -> &Self {
        match (half, &self.twin) {
            (Half::Right, Some(twin)) => twin.run(),
            _ => self,
        }
    }

    /// Another run of the same scene from `bed`, at time zero, held there.
    fn sibling(&self, bed: Arc<World>) -> Result<Self, String> {
        let (scene, means) = (self.scene.clone(), self.means.half());
        let make = {
            let scene = scene.clone();
            move || {
                let run = Run::new(scene, bed, means.threads);
                Engine::resume(Timeline::new(run, means.memory), false, f64::INFINITY)
            }
        };
        let driver = driven(means.driver, make);
        let mut run = Self::with(scene, self.advice.clone(), f64::INFINITY, means, driver);
        run.order(Order::Hold(Some(0)));
        match &run.status {
            Status::Failed(reason) => Err(reason.clone()),
            _ => Ok(run),
        }
    }

    /// Starts afresh at time zero with `values`.
    fn restart(&mut self, values: Vec<(Parameter, f64)>) {
        self.sent += 1;
        self.order(Order::Restart(values));
    }

    /// This run as one to keep beside another.
    pub(super) fn as_beside(&self) -> Beside {
        let mut history = History::default();
        for (index, command) in self.commands.iter().enumerate() {
            let joins = self.past.changes.binary_search(&index).is_err();
            history.push(command.clone(), joins);
        }
        let record = Record {
            history,
            series: self.series.clone(),
            flow: self.flow.clone(),
            end: self.past.end,
            ..Record::default()
        };
        let (commands, samples) = (self.commands.len(), self.series.len());
        let end = self.world.as_ref().filter(|_| !self.looks_back());
        Beside {
            end: end.map(|world| Snapshot::of_end(world, commands, samples, self.flow.clone())),
            record,
        }
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
        self.answered == self.sent && self.waiting == 0
    }

    /// Notes how many commands wait for the twin.
    pub(super) fn let_wait(&mut self, commands: usize) {
        self.waiting = commands;
    }

    /// Lets the run go no further than `step` for now, or as far as it will.
    pub fn hold_at(&mut self, step: Option<u64>) {
        match &mut self.twin {
            Some(twin) => twin.hold_at(step),
            None => self.order(Order::Hold(step)),
        }
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
        if let Some(mut twin) = self.twin.take() {
            self.status = twin.tick(self, passed);
            self.twin = Some(twin);
        } else {
            self.gather(passed);
            self.take_in();
        }
        if self.status == Status::Running {
            self.saved.worked += passed;
        }
    }

    /// Lets the engine go on by `passed` wall-clock time and hears what is new.
    pub(super) fn gather(&mut self, passed: Duration) {
        let Some(driver) = &mut self.driver else {
            return;
        };
        let update = driver.tick(passed);
        if update.is_none() && driver.has_died() {
            self.driver = None;
            self.fail("the solver's thread ended; this is a mistake in Grainfall".into());
        }
        let Some(update) = update else {
            return;
        };
        let heard = &mut self.heard;
        heard.status = update.status.clone().unwrap_or(heard.status.clone());
        let step = update.world.as_ref().map(|world| world.clock.step);
        heard.step = step.or(heard.step);
        heard.answered = update.answered;
        match &mut self.pending {
            Some(earlier) => earlier.absorb(update),
            None => self.pending = Some(update),
        }
    }

    /// Takes in what was heard.
    pub(super) fn take_in(&mut self) {
        if let Some(update) = self.pending.take() {
            self.take(update);
        }
    }

    /// What the engine has told last.
    pub(super) fn heard(&self) -> &Heard {
        &self.heard
    }

    /// Whether the engine has taken up all that was sent to it.
    pub(super) fn has_heard_all(&self) -> bool {
        self.heard.answered == self.sent
    }

    /// Adds a warning.
    pub(super) fn warn(&mut self, text: &str) {
        self.warnings.push(text.into());
    }

    fn fail(&mut self, reason: String) {
        self.status = Status::Failed(reason);
        self.heard.status = self.status.clone();
    }

    pub(super) fn order(&mut self, order: Order) {
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
        self.bed = update.bed.or(self.bed.take());
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
            self.generation = next_number();
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

/// A number that nobody else has, never zero.
fn next_number() -> u64 {
    static NUMBERS: AtomicU64 = AtomicU64::new(1);
    NUMBERS.fetch_add(1, Ordering::Relaxed)
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
