//! What either driver moves on: a preparation that becomes a run, and the player's state.
//!
//! In: [`Order`]s. Out: [`Update`]s. [`Engine::work`] does one short piece at a time, so that orders are answered quickly;
//! how the pieces fall does not show in the trajectory.

use super::preparation::{Preparation, Prepared};
use super::{Command, ParameterInfo, Run, Script, ScriptedCommand, StampedCommand, Status};
use crate::measure::{FlowHistory, Sample};
use crate::solver::{Fault, Profile};
use crate::world::World;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the front asks of the engine.
pub enum Order {
    /// Carry this out.
    Command(Command),
    /// A tick of this much wall-clock time has passed.
    Tick(Duration),
    /// Go no further than this step for now.
    Hold(Option<u64>),
}

/// News from the engine since the last update was taken.
#[derive(Default)]
pub struct Update {
    /// The state now, where it is another one.
    pub world: Option<Arc<World>>,
    /// The run's live parameters, once it stands at time zero.
    pub parameters: Option<Arc<[ParameterInfo]>>,
    /// Whether the run went back to time zero, so that samples and commands start afresh.
    pub restarted: bool,
    /// Samples taken.
    pub samples: Vec<Sample>,
    /// The flowing layer up to the last of them.
    pub flow: Option<Arc<FlowHistory>>,
    /// Commands carried out.
    pub commands: Vec<StampedCommand>,
    /// How many [`Order::Command`]s were answered since the engine was made.
    pub answered: u64,
    /// What the engine does.
    pub status: Option<Status>,
    /// The solver's profile of the last half second or so.
    pub profile: Option<Profile>,
    /// What people should know, in sentences.
    pub warnings: Vec<String>,
}

impl Update {
    /// Adds what came `later`.
    pub fn absorb(&mut self, later: Self) {
        if later.restarted {
            self.samples.clear();
            self.commands.clear();
            self.restarted = true;
        }
        self.world = later.world.or(self.world.take());
        self.parameters = later.parameters.or(self.parameters.take());
        self.samples.extend(later.samples);
        self.flow = later.flow.or(self.flow.take());
        self.commands.extend(later.commands);
        self.answered = later.answered;
        self.status = later.status.or(self.status.take());
        self.profile = later.profile.or(self.profile.take());
        self.warnings.extend(later.warnings);
    }
}

/// Wall-clock time over which a profile is gathered.
const PROFILE_TIME: Duration = Duration::from_millis(500);

/// Wall-clock time a piece of work should take: orders wait for it.
const PIECE_TIME: Duration = Duration::from_millis(10);
/// Steps that a piece has at least: taking a state in and giving it back costs as much as a dozen of them.
const LEAST_STEPS: u64 = 50;

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
    waiting: Vec<Command>,
    fault: Option<Fault>,
    news: Update,
    told: Told,
    profiled: Instant,
}

enum Stage {
    Preparing(Box<Preparation>),
    Ready(Box<Run>),
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
    /// An engine that makes a run of `preparation` and carries out `script` by itself.
    pub fn new(
        preparation: Preparation,
        script: Vec<ScriptedCommand>,
        autoplay: bool,
        speed: f64,
    ) -> Self {
        Self {
            stage: Stage::Preparing(Box::new(preparation)),
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
            script,
            waiting: Vec::new(),
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
            Order::Command(command) if matches!(self.stage, Stage::Preparing(_)) => {
                self.waiting.push(command);
            }
            Order::Command(command) => self.carry_out(command),
        }
    }

    /// Whether there is work to do without another order.
    pub fn is_busy(&self) -> bool {
        match &self.stage {
            Stage::Preparing(_) => true,
            Stage::Ready(run) => run.world().clock.step < self.goal(),
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
                    self.begin(run, warnings);
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
        let Stage::Ready(run) = &mut self.stage else {
            return update;
        };
        let (series, commands) = (run.series(), run.commands());
        update.samples = (self.told.samples..series.len())
            .filter_map(|index| series.get(index))
            .collect();
        update.flow = (!update.samples.is_empty()).then(|| run.flow().clone());
        update.commands = commands[self.told.commands..].to_vec();
        let step = run.world().clock.step;
        if update.restarted || self.told.step != Some(step) || !update.commands.is_empty() {
            update.world = Some(Arc::new(run.world().clone()));
        }
        self.told = Told {
            step: Some(step),
            samples: series.len(),
            commands: commands.len(),
        };
        if self.profiled.elapsed() > PROFILE_TIME {
            self.profiled = Instant::now();
            update.profile = Some(run.take_profile()).filter(|profile| profile.steps > 0);
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
            (Stage::Ready(_), Some(fault)) => Status::Faulted(fault.clone()),
            (Stage::Ready(_), None) if self.mode == Mode::Paused => Status::Paused,
            (Stage::Ready(_), None) => Status::Running,
        }
    }

    /// The step to reach before the next order.
    fn goal(&self) -> u64 {
        let goal = match self.mode {
            Mode::Paused => 0,
            Mode::Running => self.target,
            Mode::Stepping { until } => until,
        };
        goal.min(self.hold)
    }

    /// Lets the run go on by what `passed` wall-clock time is worth.
    fn grant(&mut self, passed: Duration) {
        let (Stage::Ready(run), Mode::Running) = (&self.stage, self.mode) else {
            return;
        };
        let clock = &run.world().clock;
        if self.speed.is_infinite() {
            self.target = u64::MAX;
            return;
        }
        self.owed += self.speed * passed.as_secs_f64();
        let steps = (self.owed / clock.time_step).floor();
        self.owed -= steps * clock.time_step;
        self.target = clock.step + steps as u64;
    }

    fn begin(&mut self, mut run: Box<Run>, warnings: Vec<String>) {
        self.news.warnings.extend(warnings);
        let script = std::mem::take(&mut self.script);
        let scheduled = Script::new(&script, &run.world().clock)
            .map_err(|error| error.to_string())
            .and_then(|script| run.schedule(script).map_err(|error| error.to_string()));
        if let Err(reason) = scheduled {
            self.stage = Stage::Failed(Status::Failed(reason));
            return;
        }
        self.news.parameters = Some(run.parameters().clone());
        self.stage = Stage::Ready(run);
        for command in std::mem::take(&mut self.waiting) {
            self.carry_out(command);
        }
    }

    fn carry_out(&mut self, command: Command) {
        self.news.answered += 1;
        let Stage::Ready(run) = &mut self.stage else {
            return;
        };
        if let Err(refusal) = run.apply(command.clone()) {
            self.news.warnings.push(refusal.to_string());
            return;
        }
        let step = run.world().clock.step;
        match command {
            Command::Play => self.play(Mode::Running, step),
            Command::Pause => self.play(Mode::Paused, step),
            Command::Step(steps) => {
                let until = step.saturating_add(steps);
                self.play(Mode::Stepping { until }, step);
            }
            Command::Speed(speed) => {
                self.speed = speed;
                self.play(self.mode, step);
            }
            Command::Reset => {
                self.told = Told::default();
                self.news.restarted = true;
                let mode = match self.mode {
                    Mode::Running if self.fault.is_none() => Mode::Running,
                    _ => Mode::Paused,
                };
                self.play(mode, step);
            }
            Command::Set { .. } => {}
        }
    }

    /// Goes on in `mode` from `step`, forgetting what earlier ticks granted and what went wrong.
    fn play(&mut self, mode: Mode, step: u64) {
        self.mode = mode;
        self.target = step;
        self.owed = 0.0;
        self.fault = None;
    }

    fn advance_run(&mut self) {
        let goal = self.goal();
        let Stage::Ready(run) = &mut self.stage else {
            return;
        };
        let from = run.world().clock.step;
        let to = goal.min(from.saturating_add(self.piece));
        let started = Instant::now();
        let outcome = run.advance_to(to);
        self.adapt(to.saturating_sub(from), started.elapsed());
        if let Err(fault) = outcome {
            self.mode = Mode::Paused;
            self.fault = Some(fault);
        } else if matches!(self.mode, Mode::Stepping { until } if until <= to) {
            self.mode = Mode::Paused;
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
