//! What either driver moves on: a preparation that becomes a run, and the player's state.
//!
//! In: [`Order`]s. Out: [`Update`]s. [`Engine::work`] does one short piece at a time, so that orders are answered quickly;
//! how the pieces fall does not show in the trajectory.

use super::{Half, Status};
use crate::measure::{FlowHistory, Sample};
use crate::run::{
    Command, CommandError, Parameter, ParameterInfo, Past, Preparation, Prepared, Record, Run,
    Script, ScriptedCommand, Session, Snapshot, StampedCommand, Timeline,
};
use crate::scene::Scene;
use crate::solver::{Fault, Profile};
use crate::world::World;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the front asks of the engine.
pub enum Order {
    /// Carry this out.
    Command(Command),
    /// Carry this change of a pair of runs out; answered as a command is.
    Change(PairChange),
    /// A tick of this much wall-clock time has passed.
    Tick(Duration),
    /// Go no further than this step for now.
    Hold(Option<u64>),
    /// Write the whole session to a file.
    Save(SaveOrder),
    /// Start afresh at time zero with these values; answered as a command is.
    Restart(Vec<(Parameter, f64)>),
    /// Keep this run beside the present one, or go on with it.
    Adopt(Box<Beside>, Half),
    /// Work on so many threads from now on.
    Threads(usize),
}

/// A session that is to be written.
pub struct SaveOrder {
    /// To this file.
    pub path: PathBuf,
    /// The scene as it was opened, before what acts from the next start on was changed.
    pub original: Arc<Scene>,
    /// A run that goes on beside this one, to be kept as one that was left.
    pub beside: Option<Box<Beside>>,
}

/// A change of two runs side by side, or of one of them.
#[derive(Clone)]
pub struct PairChange {
    /// The change.
    pub command: Command,
    /// Whether it is part of the change before it.
    pub joins: bool,
    /// Whether it changes this run; one of the other run alone is noted in this one, so that an undo is of both.
    pub is_here: bool,
}

/// A run of the same scene from the same bed that another engine computed.
pub struct Beside {
    /// What is known of it.
    pub record: Record,
    /// The state at its end, where that is at hand.
    pub end: Option<Snapshot>,
}

/// What became of a file that was to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedFile {
    /// The file.
    pub path: PathBuf,
    /// Why it could not be written, if it could not.
    pub outcome: Result<(), String>,
}

/// News from the engine since the last update was taken.
#[derive(Default)]
pub struct Update {
    /// The state now, where it is another one.
    pub world: Option<Arc<World>>,
    /// The run's live parameters, once it stands at time zero.
    pub parameters: Option<Arc<[ParameterInfo]>>,
    /// The state at time zero, before any command, once the run stands there.
    pub bed: Option<Arc<World>>,
    /// Whether another run is the present one, so that samples and commands start afresh.
    pub switched: bool,
    /// Samples taken.
    pub samples: Vec<Sample>,
    /// The flowing layer up to the last of them.
    pub flow: Option<Arc<FlowHistory>>,
    /// Commands carried out.
    pub commands: Vec<StampedCommand>,
    /// What lies behind and ahead of the state.
    pub past: Option<Past>,
    /// How many orders that are answered, as [`Order::Command`] is, were taken up since the engine was made.
    pub answered: u64,
    /// What the engine does.
    pub status: Option<Status>,
    /// The solver's profile of the last half second or so.
    pub profile: Option<Profile>,
    /// What people should know, in sentences.
    pub warnings: Vec<String>,
    /// Files that were to be written.
    pub saved: Vec<SavedFile>,
}

impl Update {
    /// Adds what came `later`.
    pub fn absorb(&mut self, later: Self) {
        if later.switched {
            self.samples.clear();
            self.commands.clear();
            self.switched = true;
        }
        self.world = later.world.or(self.world.take());
        self.parameters = later.parameters.or(self.parameters.take());
        self.bed = later.bed.or(self.bed.take());
        self.samples.extend(later.samples);
        self.flow = later.flow.or(self.flow.take());
        self.commands.extend(later.commands);
        self.past = later.past.or(self.past.take());
        self.answered = later.answered;
        self.status = later.status.or(self.status.take());
        self.profile = later.profile.or(self.profile.take());
        self.warnings.extend(later.warnings);
        self.saved.extend(later.saved);
    }
}

/// Wall-clock time over which a profile is gathered.
const PROFILE_TIME: Duration = Duration::from_millis(500);

/// Wall-clock time a piece of work should take: orders wait for it.
const PIECE_TIME: Duration = Duration::from_millis(10);
/// Steps that a piece has at least: taking a state in and giving it back costs as much as a dozen of them.
const LEAST_STEPS: u64 = 50;

/// Commands that come sooner after each other belong to one change: a drag, or a button that sets several parameters.
const ONE_CHANGE: Duration = Duration::from_millis(400);

/// When a parameter was last set, to tell which commands belong to one change.
#[derive(Default)]
pub struct Drag(Option<Instant>);

impl Drag {
    /// Whether a command that sets a parameter now is part of the change before it.
    pub fn joins(&mut self) -> bool {
        let last = self.0.replace(Instant::now());
        last.is_some_and(|last| last.elapsed() < ONE_CHANGE)
    }
}

/// A preparation that becomes a run, and the player's state.
pub struct Engine {
    stage: Stage,
    mode: Mode,
    speed: f64,
    /// Simulated time granted by ticks and not yet spent on whole steps [s].
    owed: f64,
    target: u64,
    hold: u64,
    /// Steps of a piece.
    piece: u64,
    script: Vec<ScriptedCommand>,
    /// Memory for keyframes [bytes].
    memory: usize,
    /// Orders that come before the run stands, or while it is on the way to another moment.
    waiting: Vec<Order>,
    drag: Drag,
    fault: Option<Fault>,
    news: Update,
    told: Told,
    profiled: Instant,
}

enum Stage {
    Preparing(Box<Preparation>),
    Ready(Box<Timeline>),
    /// There is no run, as the status says.
    Failed(Status),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Paused,
    Running,
    Stepping { until: u64 },
}

/// What updates have told so far.
#[derive(Default)]
struct Told {
    step: Option<u64>,
    samples: usize,
    commands: usize,
}

impl Engine {
    /// An engine that makes a run of `preparation`, carries out `script` by itself and holds keyframes in `memory` bytes.
    pub fn new(
        preparation: Preparation,
        script: Vec<ScriptedCommand>,
        memory: usize,
        autoplay: bool,
        speed: f64,
    ) -> Self {
        let stage = Stage::Preparing(Box::new(preparation));
        Self {
            script,
            memory,
            ..Self::at(stage, autoplay, speed)
        }
    }

    /// An engine that goes on with `timeline`.
    pub fn resume(timeline: Timeline, autoplay: bool, speed: f64) -> Self {
        let (parameters, bed) = (
            timeline.run().parameters().clone(),
            timeline.run().bed().clone(),
        );
        let mut engine = Self::at(Stage::Ready(Box::new(timeline)), autoplay, speed);
        engine.news.parameters = Some(parameters);
        engine.news.bed = Some(bed);
        engine
    }

    fn at(stage: Stage, autoplay: bool, speed: f64) -> Self {
        Self {
            stage,
            mode: if autoplay {
                Mode::Running
            } else {
                Mode::Paused
            },
            speed,
            owed: 0.0,
            target: 0,
            hold: u64::MAX,
            piece: 8,
            script: Vec::new(),
            memory: 0,
            waiting: Vec::new(),
            drag: Drag::default(),
            fault: None,
            news: Update::default(),
            told: Told::default(),
            profiled: Instant::now(),
        }
    }

    /// Carries out `order`, or keeps it until the run stands.
    pub fn order(&mut self, order: Order) {
        match order {
            Order::Tick(passed) => self.grant(passed),
            Order::Hold(step) => self.hold = step.unwrap_or(u64::MAX),
            order if self.must_wait(&order) => self.waiting.push(order),
            Order::Command(command) => self.carry_out(command),
            Order::Change(change) => self.change_in_pair(change),
            Order::Save(order) => self.save(order),
            Order::Restart(values) => self.restart(&values),
            Order::Adopt(beside, shown) => self.adopt(*beside, shown),
            Order::Threads(threads) => {
                if let Stage::Ready(timeline) = &mut self.stage {
                    timeline.use_threads(threads);
                }
            }
        }
    }

    /// Whether there is work to do without another order.
    pub fn is_busy(&self) -> bool {
        match &self.stage {
            Stage::Preparing(_) => true,
            Stage::Ready(timeline) => timeline.run().world().clock.step < self.goal(timeline),
            Stage::Failed(_) => false,
        }
    }

    /// Does one short piece of work, if there is any.
    pub fn work(&mut self) {
        match &mut self.stage {
            Stage::Preparing(preparation) => match preparation.advance() {
                Ok(Prepared::NotYet) => {}
                Ok(Prepared::Ready(run)) => {
                    let warnings = preparation.warnings().to_vec();
                    self.begin(*run, warnings);
                }
                Err(fault) => self.stage = Stage::Failed(Status::Faulted(fault)),
            },
            Stage::Ready(_) => self.advance_run(),
            Stage::Failed(_) => {}
        }
    }

    /// What is new since this was last called.
    pub fn take_update(&mut self) -> Update {
        let mut update = std::mem::take(&mut self.news);
        self.news.answered = update.answered;
        update.status = Some(self.status());
        let Stage::Ready(timeline) = &mut self.stage else {
            return update;
        };
        let news = timeline.take_news();
        if news.switched {
            update.switched = true;
            self.told = Told::default();
        }
        let record = timeline.record();
        let (series, commands) = (&record.series, record.history.commands());
        update.samples = (self.told.samples..series.len())
            .filter_map(|index| series.get(index))
            .collect();
        let flowed = news.arrived || !update.samples.is_empty();
        update.flow = flowed.then(|| record.flow.clone());
        update.commands = commands[self.told.commands..].to_vec();
        let world = timeline.run().world();
        let step = world.clock.step;
        let moved = self.told.step != Some(step) || !update.commands.is_empty();
        let on_the_way = timeline.destination().is_some();
        if news.switched || news.arrived || (moved && !on_the_way) {
            update.world = Some(Arc::new(world.clone()));
            self.told.step = Some(step);
        }
        self.told.samples = series.len();
        self.told.commands = commands.len();
        update.past = Some(timeline.past());
        if self.profiled.elapsed() > PROFILE_TIME {
            self.profiled = Instant::now();
            update.profile = Some(timeline.take_profile()).filter(|profile| profile.steps > 0);
        }
        update
    }

    fn status(&self) -> Status {
        match (&self.stage, &self.fault) {
            (Stage::Failed(status), _) => status.clone(),
            (Stage::Preparing(preparation), _) => Status::Preparing {
                stage: preparation.name().into(),
                progress: preparation.progress(),
            },
            (Stage::Ready(timeline), _) if timeline.destination().is_some() => Status::Seeking {
                progress: timeline.progress(),
            },
            (Stage::Ready(_), Some(fault)) => Status::Faulted(fault.clone()),
            (Stage::Ready(_), None) if self.mode == Mode::Paused => Status::Paused,
            (Stage::Ready(_), None) => Status::Running,
        }
    }

    /// The step to reach before the next order.
    fn goal(&self, timeline: &Timeline) -> u64 {
        let goal = match (timeline.destination(), self.mode) {
            (Some(destination), _) => destination,
            (None, Mode::Paused) => 0,
            (None, Mode::Running) => self.target,
            (None, Mode::Stepping { until }) => until,
        };
        goal.min(self.hold)
    }

    /// Whether `order` has no meaning before the run stands where it was asked to go.
    fn must_wait(&self, order: &Order) -> bool {
        match &self.stage {
            Stage::Preparing(_) => true,
            Stage::Ready(timeline) => {
                let acts_on_the_moment = matches!(
                    order,
                    Order::Save(..)
                        | Order::Change(_)
                        | Order::Command(Command::Play | Command::Step(_) | Command::Set { .. })
                );
                timeline.destination().is_some() && acts_on_the_moment
            }
            Stage::Failed(_) => false,
        }
    }

    /// Lets the run go on by what `passed` wall-clock time is worth.
    fn grant(&mut self, passed: Duration) {
        let (Stage::Ready(timeline), Mode::Running) = (&mut self.stage, self.mode) else {
            return;
        };
        let clock = timeline.run().world().clock;
        if self.speed.is_infinite() {
            self.target = u64::MAX;
            return;
        }
        self.owed += self.speed * passed.as_secs_f64();
        let steps = (self.owed / clock.time_step).floor();
        self.owed -= steps * clock.time_step;
        self.target = clock.step + steps as u64;
        if timeline.destination().is_none() {
            timeline.skip_towards(self.target);
        }
    }

    fn begin(&mut self, run: Run, warnings: Vec<String>) {
        self.news.warnings.extend(warnings);
        let script = std::mem::take(&mut self.script);
        let clock = run.world().clock;
        self.news.parameters = Some(run.parameters().clone());
        self.news.bed = Some(run.bed().clone());
        let mut timeline = Timeline::new(run, self.memory);
        let scheduled = Script::new(&script, &clock)
            .map_err(|error| error.to_string())
            .and_then(|script| timeline.schedule(script).map_err(|error| error.to_string()));
        if let Err(reason) = scheduled {
            self.stage = Stage::Failed(Status::Failed(reason));
            return;
        }
        self.stage = Stage::Ready(Box::new(timeline));
        self.carry_out_waiting();
    }

    /// Carries out what waited, as far as it need not wait on.
    fn carry_out_waiting(&mut self) {
        for order in std::mem::take(&mut self.waiting) {
            self.order(order);
        }
    }

    /// Writes the whole session, on the way from one piece of work to the next.
    fn save(&mut self, order: SaveOrder) {
        let SaveOrder {
            path,
            original,
            beside,
        } = order;
        let outcome = match &mut self.stage {
            Stage::Ready(timeline) => {
                let beside = beside.map(|beside| timeline.adopt(beside.record, beside.end));
                let title = &timeline.run().scene().title;
                let session = Session::of(title, timeline).of_original(&original);
                if beside.is_some() {
                    timeline.forget(timeline.kept().len() - 1);
                }
                session.write(&path).map_err(|error| error.to_string())
            }
            Stage::Preparing(_) | Stage::Failed(_) => Err("there is no run".into()),
        };
        self.news.saved.push(SavedFile { path, outcome });
    }

    fn restart(&mut self, values: &[(Parameter, f64)]) {
        self.news.answered += 1;
        if let Stage::Ready(timeline) = &mut self.stage {
            timeline.restart(values);
            self.play(self.mode);
        }
    }

    /// Keeps the run `beside`; goes on with it where the right one is to be `shown`.
    fn adopt(&mut self, beside: Beside, shown: Half) {
        if let Stage::Ready(timeline) = &mut self.stage {
            timeline.adopt(beside.record, beside.end);
            let newest = timeline.kept().len() - 1;
            if shown == Half::Right {
                self.travel(|timeline| timeline.take_up(newest));
            }
        }
    }

    fn carry_out(&mut self, command: Command) {
        self.news.answered += 1;
        let Stage::Ready(timeline) = &mut self.stage else {
            return;
        };
        match command {
            Command::Play => self.play(Mode::Running),
            Command::Pause => {
                timeline.stop();
                self.carry_out_waiting();
                self.play(Mode::Paused);
            }
            Command::Step(steps) => {
                let until = timeline.run().world().clock.step.saturating_add(steps);
                self.play(Mode::Stepping { until });
            }
            Command::Speed(speed) => {
                self.speed = speed;
                self.play(self.mode);
            }
            Command::Reset => {
                timeline.reset();
                let mode = match self.mode {
                    Mode::Running if self.fault.is_none() => Mode::Running,
                    _ => Mode::Paused,
                };
                self.play(mode);
            }
            Command::Set { .. } => {
                let refused = timeline.change(command, self.drag.joins()).err();
                self.tell(refused);
            }
            Command::Seek(step) => self.travel(|timeline| timeline.seek(step)),
            Command::Undo => self.travel(Timeline::undo),
            Command::Redo => self.travel(Timeline::redo),
            Command::Return(index) => self.travel(|timeline| timeline.take_up(index)),
            Command::Forget(index) => timeline.forget(index),
        }
    }

    fn change_in_pair(&mut self, change: PairChange) {
        self.news.answered += 1;
        if let Stage::Ready(timeline) = &mut self.stage {
            if change.is_here {
                let refused = timeline.change(change.command, change.joins).err();
                self.tell(refused);
            } else {
                // What is refused here is refused there too, and told by that run.
                let _ = timeline.note_beside(&change.command, change.joins);
            }
        }
    }

    /// Says why a command was refused.
    fn tell(&mut self, refused: Option<CommandError>) {
        let refusal = refused.map(|refusal| refusal.to_string());
        self.news.warnings.extend(refusal);
    }

    /// Sets out for another moment and holds there.
    fn travel(&mut self, set_out: impl FnOnce(&mut Timeline)) {
        if let Stage::Ready(timeline) = &mut self.stage {
            set_out(timeline);
        }
        self.drag = Drag::default();
        self.play(Mode::Paused);
    }

    /// Goes on in `mode` from here, forgetting what earlier ticks granted and what went wrong.
    fn play(&mut self, mode: Mode) {
        self.mode = mode;
        self.target = 0;
        self.owed = 0.0;
        self.fault = None;
    }

    fn advance_run(&mut self) {
        let Stage::Ready(timeline) = &self.stage else {
            return;
        };
        let goal = self.goal(timeline);
        let Stage::Ready(timeline) = &mut self.stage else {
            return;
        };
        let from = timeline.run().world().clock.step;
        let to = goal.min(from.saturating_add(self.piece));
        let travelled = timeline.destination().is_some();
        let started = Instant::now();
        let outcome = timeline.advance_to(to);
        let arrived = travelled && timeline.destination().is_none();
        self.adapt(to.saturating_sub(from), started.elapsed());
        if let Err(fault) = outcome {
            self.mode = Mode::Paused;
            self.fault = Some(fault);
        } else if matches!(self.mode, Mode::Stepping { until } if until <= to) {
            self.mode = Mode::Paused;
        }
        if arrived {
            self.carry_out_waiting();
        }
    }

    /// Fits the next piece's steps to [`PIECE_TIME`], seeing that `steps` took `time`.
    fn adapt(&mut self, steps: u64, time: Duration) {
        if steps == 0 {
            return;
        }
        let fitting = steps as f64 * PIECE_TIME.as_secs_f64() / time.as_secs_f64().max(1e-9);
        let most = 4 * self.piece.max(steps);
        self.piece = (fitting as u64).min(most).max(LEAST_STEPS);
    }
}
