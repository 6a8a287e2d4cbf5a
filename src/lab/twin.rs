//! A second run of the same scene beside the first: from the same start, differing in one parameter, in step with it.
//!
//! In: what is asked of the pair. Out: the same asked of each run at the same step. Both are sent to a common step and
//! hold there; only when both have come is what they have become taken in, so that the two states shown are always of the
//! same step. What changes a run is asked for there too, so that the same change has the same step in both: the two keep
//! differing in the one parameter alone, and each goes the way, to the bit, that it would go by itself. A change of that
//! parameter in one of them is noted in the other, so that both can take back the same changes: undo and redo lead both
//! to the same moment, and so does a branch.
//!
//! A run that stopped short of the common step, because it met a fault or was stopped on the way to a moment, holds; the
//! other goes back to it. Taking up a kept run belongs to one run and waits until the twin is ended.

use super::engine::{Beside, Drag, Order, PairChange};
use super::{Simulation, Status};
use crate::run::{Command, Parameter};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Wall-clock time that both work until they meet again, at least and at most: two frames where these take long, so that
/// little of it is spent waiting for the next one.
const SLICE: [Duration; 2] = [Duration::from_millis(60), Duration::from_millis(500)];
/// Steps until the first meeting.
const FIRST_SLICE: u64 = 50;
/// Why some commands are refused.
const OF_ONE_RUN: &str = "A kept run would take the place of one of the two: end the twin first.";

/// One of two runs side by side, and of their pictures.
#[cfg_attr(feature = "headless", derive(bevy::ecs::component::Component))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Half {
    /// The first run; all of the picture where there is one run only.
    #[default]
    Left,
    /// The twin.
    Right,
}

impl Half {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Its place among both.
    pub fn index(self) -> usize {
        self as usize
    }

    /// What people call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// A run beside another, in step with it.
pub struct Twin {
    run: Simulation,
    parameter: Parameter,
    mode: Mode,
    /// The step that both were sent to.
    target: u64,
    /// The step they must not pass for now.
    hold: Option<u64>,
    /// Simulated time granted and not yet spent [s].
    owed: f64,
    waiting: VecDeque<Asked>,
    drag: Drag,
    slice: Slice,
}

/// What the pair does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Paused,
    Running,
    Stepping { until: u64 },
}

/// What waits for both runs to be at the same step.
enum Asked {
    /// Of both runs, or of the pair.
    Both(Command),
    /// Of both runs or of one of them, as part of the change before it or not.
    Change {
        command: Command,
        joins: bool,
        of: Option<Half>,
    },
    Save(PathBuf),
}

/// How far both go until they meet again.
struct Slice {
    steps: u64,
    /// Where and when the present one was begun.
    begun: Option<(u64, Instant)>,
    /// When the last tick was, and how long frames take.
    ticked: Option<Instant>,
    frame: Duration,
}

impl Slice {
    /// Takes note of a tick: some come at once, then none until the next frame.
    fn tick(&mut self) {
        let now = Instant::now();
        let apart = self.ticked.map_or(Duration::ZERO, |last| now - last);
        self.ticked = Some(now);
        self.frame = apart.max(self.frame.mul_f64(0.95));
    }

    /// Fits it to [`SLICE`], now that both have come to `step`.
    fn end(&mut self, step: u64) {
        if let Some((from, since)) = self.begun.take() {
            let steps = step.saturating_sub(from);
            let wanted = (2 * self.frame).clamp(SLICE[0], SLICE[1]);
            let fitting =
                steps as f64 * wanted.as_secs_f64() / since.elapsed().as_secs_f64().max(1e-9);
            // A short one, because no more was granted, says little of long ones.
            let most = 4 * steps.max(self.steps);
            self.steps = (fitting as u64).clamp(1, most.max(FIRST_SLICE));
        }
    }
}

impl Twin {
    /// A twin of a run that starts afresh at time zero: `run`, which starts there too and differs in `parameter`. Both go
    /// on from there at once where the first one did.
    pub(super) fn new(run: Simulation, parameter: Parameter, goes_on: bool) -> Self {
        Self {
            run,
            parameter,
            mode: if goes_on { Mode::Running } else { Mode::Paused },
            target: 0,
            hold: None,
            owed: 0.0,
            waiting: VecDeque::new(),
            drag: Drag::default(),
            slice: Slice {
                steps: FIRST_SLICE,
                begun: None,
                ticked: None,
                frame: Duration::ZERO,
            },
        }
    }

    /// The run; it has a state once it is in step with the first.
    pub fn run(&self) -> &Simulation {
        &self.run
    }

    /// What the two runs differ in.
    pub fn parameter(&self) -> &Parameter {
        &self.parameter
    }

    /// Whether the pair is to go on.
    pub(super) fn goes_on(&self) -> bool {
        self.mode != Mode::Paused
    }

    /// Lets both go no further than `step` for now.
    pub(super) fn hold_at(&mut self, step: Option<u64>) {
        self.hold = step;
    }

    /// The run as one to keep beside the first.
    pub(super) fn beside(&self) -> Beside {
        self.run.as_beside()
    }

    /// Ends it: what the first run must not pass, and what it was still to do.
    pub(super) fn end(self) -> (Option<u64>, impl Iterator<Item = Command>) {
        let waiting = self.waiting.into_iter().filter_map(|asked| match asked {
            Asked::Both(command) => Some(command),
            Asked::Change { command, of, .. } => (of != Some(Half::Right)).then_some(command),
            Asked::Save(_) => None,
        });
        (self.hold, waiting)
    }

    /// Asks for `command` of both runs, or of the `first` alone where it is about what they differ in.
    pub(super) fn send(&mut self, first: &mut Simulation, command: Command) {
        match command {
            Command::Return(_) => first.warn(OF_ONE_RUN),
            Command::Speed(_) => self.owed = 0.0,
            Command::Forget(_) => first.ask(command),
            Command::Seek(_) | Command::Pause if self.can_turn(first) => {
                // Both are on the way to one moment, and nothing is to be done there: they may as well go to another.
                self.ask_both(first, &command);
            }
            Command::Set {
                ref parameter,
                value,
            } => {
                let of = (*parameter == self.parameter).then_some(Half::Left);
                if of.is_none() {
                    self.run.expect(parameter, value);
                }
                self.change(first, command, of);
            }
            Command::Seek(_) => {
                let is_seek = |asked: &mut Asked| matches!(asked, Asked::Both(Command::Seek(_)));
                self.waiting.pop_back_if(is_seek);
                self.wait(first, Asked::Both(command));
            }
            command => self.wait(first, Asked::Both(command)),
        }
    }

    /// Gives what the two runs differ in another `value` in this one.
    pub(super) fn set(&mut self, first: &mut Simulation, value: f64) {
        let parameter = self.parameter.clone();
        self.run.expect(&parameter, value);
        let command = Command::Set { parameter, value };
        self.change(first, command, Some(Half::Right));
    }

    /// Lets the session be written to `path` when both are at the same step.
    pub(super) fn save(&mut self, first: &mut Simulation, path: PathBuf) {
        self.wait(first, Asked::Save(path));
    }

    /// Lets both go on by `passed` wall-clock time; what the pair does now.
    pub(super) fn tick(&mut self, first: &mut Simulation, passed: Duration) -> Status {
        self.slice.tick();
        first.gather(passed);
        self.run.gather(passed);
        self.grant(first.speed(), passed);
        if self.have_come(first) {
            self.meet(first);
        }
        self.status(first)
    }

    /// Asks for a change of both runs, or of one of them.
    fn change(&mut self, first: &mut Simulation, command: Command, of: Option<Half>) {
        let joins = self.drag.joins();
        self.wait(first, Asked::Change { command, joins, of });
    }

    fn wait(&mut self, first: &mut Simulation, asked: Asked) {
        if !matches!(asked, Asked::Change { .. }) {
            self.drag = Drag::default();
        }
        self.waiting.push_back(asked);
        self.tell_waiting(first);
    }

    /// Lets both runs know how much is still to be asked of them.
    fn tell_waiting(&mut self, first: &mut Simulation) {
        for run in [first, &mut self.run] {
            run.let_wait(self.waiting.len());
        }
    }

    fn ask_both(&mut self, first: &mut Simulation, command: &Command) {
        for run in [first, &mut self.run] {
            run.ask(command.clone());
        }
    }

    /// Whether a run is on the way to a moment, and nothing waits for it to come there.
    fn can_turn(&self, first: &Simulation) -> bool {
        let travels = |run: &Simulation| matches!(run.heard().status, Status::Seeking { .. });
        self.waiting.is_empty() && (travels(first) || travels(&self.run))
    }

    fn grant(&mut self, speed: f64, passed: Duration) {
        if self.mode == Mode::Running {
            let most = speed * SLICE[1].as_secs_f64();
            self.owed = (self.owed + speed * passed.as_secs_f64()).min(most);
        } else {
            self.owed = 0.0;
        }
    }

    /// Whether neither run will move before it is asked to.
    fn have_come(&self, first: &Simulation) -> bool {
        let has_come = |run: &Simulation| {
            let heard = run.heard();
            let rests = match heard.status {
                Status::Paused | Status::Faulted(_) | Status::Failed(_) => true,
                Status::Running => heard.step.is_some_and(|step| step >= self.target),
                Status::Seeking { .. } | Status::Preparing { .. } => false,
            };
            rests && run.has_heard_all()
        };
        has_come(first) && has_come(&self.run)
    }

    /// Takes in what both have become, and sends them on; the one that is ahead goes back first.
    fn meet(&mut self, first: &mut Simulation) {
        let (Some(left), Some(right)) = (first.heard().step, self.run.heard().step) else {
            return;
        };
        if left != right {
            let ahead = if left > right { first } else { &mut self.run };
            ahead.ask(Command::Seek(left.min(right)));
            ahead.order(Order::Hold(None));
            self.mode = Mode::Paused;
            return;
        }
        for run in [&mut *first, &mut self.run] {
            run.take_in();
        }
        self.slice.end(left);
        let has_stopped =
            |run: &Simulation| matches!(run.heard().status, Status::Faulted(_) | Status::Failed(_));
        if self.mode == (Mode::Stepping { until: left })
            || has_stopped(first)
            || has_stopped(&self.run)
        {
            self.mode = Mode::Paused;
        }
        self.answer(first, left);
        self.tell_waiting(first);
        if self.have_come(first) {
            self.go_on(first, left);
        }
    }

    /// Asks for what waited, now that both are at `step`.
    fn answer(&mut self, first: &mut Simulation, step: u64) {
        // Whether the last change asked for, or the last one there was, lies at the end of both runs.
        let mut at_end = !first.looks_back() && !self.run.looks_back();
        while let Some(asked) = self.waiting.pop_front() {
            match asked {
                Asked::Both(Command::Play) => self.mode = Mode::Running,
                Asked::Both(Command::Pause) => self.mode = Mode::Paused,
                Asked::Both(Command::Step(steps)) => {
                    let until = step.saturating_add(steps);
                    self.mode = Mode::Stepping { until };
                    return;
                }
                Asked::Both(command @ (Command::Seek(_) | Command::Undo | Command::Redo)) => {
                    self.mode = Mode::Paused;
                    if self.can(&command) {
                        self.ask_both(first, &command);
                        self.order_both(first, || Order::Hold(None));
                        return;
                    }
                }
                Asked::Both(command @ Command::Reset) => {
                    self.target = 0;
                    self.order_both(first, || Order::Hold(Some(0)));
                    self.ask_both(first, &command);
                    return;
                }
                Asked::Both(command) => self.ask_both(first, &command),
                Asked::Change { command, joins, of } => {
                    let joins = joins && at_end;
                    at_end = true;
                    for (half, run) in Half::ALL.into_iter().zip([&mut *first, &mut self.run]) {
                        let is_here = of.is_none_or(|of| of == half);
                        run.ask_change(PairChange {
                            command: command.clone(),
                            joins,
                            is_here,
                        });
                    }
                }
                Asked::Save(path) => first.write(path, Some(Box::new(self.beside()))),
            }
        }
    }

    /// Whether both can go where `command` leads: what was changed before the pair began is the first one's alone.
    fn can(&self, command: &Command) -> bool {
        let past = self.run.past();
        match command {
            Command::Undo => past.undo.is_some(),
            Command::Redo => past.redo.is_some(),
            _ => true,
        }
    }

    fn order_both(&mut self, first: &mut Simulation, order: impl Fn() -> Order) {
        for run in [first, &mut self.run] {
            run.order(order());
        }
    }

    /// Sends both from `step` as far as was granted, and no further than they come in a slice.
    fn go_on(&mut self, first: &mut Simulation, step: u64) {
        let Some(time_step) = first.world().map(|world| world.clock.time_step) else {
            return;
        };
        let granted = match self.mode {
            Mode::Paused => return,
            Mode::Stepping { until } => until - step,
            Mode::Running => (self.owed / time_step) as u64,
        };
        let allowed = self.hold.map_or(u64::MAX, |hold| hold.saturating_sub(step));
        let steps = granted.min(self.slice.steps).min(allowed);
        if steps == 0 {
            return;
        }
        self.owed -= steps as f64 * time_step;
        self.target = step + steps;
        self.slice.begun = Some((step, Instant::now()));
        for run in [first, &mut self.run] {
            run.order(Order::Hold(Some(self.target)));
            if run.heard().status != Status::Running {
                run.ask(Command::Play);
            }
        }
    }

    fn status(&self, first: &Simulation) -> Status {
        let both = [&first.heard().status, &self.run.heard().status];
        let stopped = |status: &&&Status| matches!(status, Status::Faulted(_) | Status::Failed(_));
        if let Some(stopped) = both.iter().find(stopped) {
            return (*stopped).clone();
        }
        let ways = both.iter().filter_map(|status| match status {
            Status::Seeking { progress } => Some(*progress),
            _ => None,
        });
        match ways.reduce(f32::min) {
            Some(progress) => Status::Seeking { progress },
            None if self.mode == Mode::Paused => Status::Paused,
            None => Status::Running,
        }
    }
}
