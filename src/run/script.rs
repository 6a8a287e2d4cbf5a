//! Commands that are carried out by themselves when their time comes: how a recorded run is played
//! again.
//!
//! In: a list of commands, each with a step or a time. Out: each command once, before the first
//! step at or after its own. Nothing is carried out here: the run takes what is due.

use super::{Command, StampedCommand};
use crate::world::Clock;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// A command and when it is due, as files hold it. Where both step and time are given, as in a
/// recorded list, the step decides.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ScriptedCommand {
    /// Due before this step.
    #[serde(default)]
    pub step: Option<u64>,
    /// Due before the first step at or after this simulated time [s].
    #[serde(default)]
    pub time: Option<f64>,
    /// What to do.
    pub command: Command,
}

/// Commands in the order in which they are due.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Script {
    commands: VecDeque<Due>,
}

/// A command and the step before which it is due.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Due {
    step: u64,
    command: Command,
    /// The simulated time that it was given for [s], where it was not for a step: it keeps that
    /// when the time step changes. A file keeps the step alone.
    #[serde(skip)]
    time: Option<f64>,
}

/// Why a list of commands cannot be played.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScriptError {
    /// An entry does not say when.
    #[error("command {0} has neither `step` nor `time`; give one of them")]
    NoTime(usize),
    /// An entry's time is no time.
    #[error("command {0}: `time` is {1}; expected a number of seconds from 0 on")]
    BadTime(usize, f64),
    /// An entry moves along the run instead of changing it.
    #[error(
        "command {0} is {1}, which a list cannot hold: it holds what was changed between time zero and the end"
    )]
    NoChange(usize, &'static str),
}

impl Script {
    /// The script that `commands`, in any order, make for a run whose time goes as `clock` says.
    ///
    /// # Errors
    /// A [`ScriptError`] that names the first bad entry, counted from 1.
    pub fn new(commands: &[ScriptedCommand], clock: &Clock) -> Result<Self, ScriptError> {
        let mut due = Vec::with_capacity(commands.len());
        for (index, entry) in commands.iter().enumerate() {
            if let Some(name) = entry.command.moving() {
                return Err(ScriptError::NoChange(index + 1, name));
            }
            due.push(Due {
                step: entry.due(index + 1, clock)?,
                command: entry.command.clone(),
                time: entry.time.filter(|_| entry.step.is_none()),
            });
        }
        due.sort_by_key(|due| due.step);
        Ok(Self {
            commands: due.into(),
        })
    }

    /// The commands that were `carried_out`, in order, and then what of `plan` is due after `step`.
    pub(crate) fn again(carried_out: &[StampedCommand], plan: &Self, step: u64) -> Self {
        let again = carried_out.iter().map(|stamped| Due {
            step: stamped.step,
            command: stamped.command.clone(),
            time: None,
        });
        let later = plan.commands.iter().filter(|due| due.step > step);
        Self {
            commands: again.chain(later.cloned()).collect(),
        }
    }

    /// Fits the steps of what is due later than now at given times to a `clock` whose time step may
    /// have changed.
    pub(crate) fn keep_times(&mut self, clock: &Clock) {
        let later = self.commands.iter_mut().filter(|due| due.step > clock.step);
        for due in later {
            due.step = due.time.map_or(due.step, |time| clock.step_at(time));
        }
        self.commands.make_contiguous().sort_by_key(|due| due.step);
    }

    /// Forgets what a run that stands at `clock` has carried out.
    pub(crate) fn forget_past(&mut self, clock: &Clock) {
        for due in &mut self.commands {
            due.step = due.time.map_or(due.step, |time| clock.step_at(time));
        }
        self.commands.retain(|due| due.step > clock.step);
        self.commands.make_contiguous().sort_by_key(|due| due.step);
    }

    /// It with each command as `accept` has it.
    ///
    /// # Errors
    /// The first refusal.
    pub(crate) fn accepted<E>(
        mut self,
        accept: impl Fn(&Command) -> Result<Command, E>,
    ) -> Result<Self, E> {
        for due in &mut self.commands {
            due.command = accept(&due.command)?;
        }
        Ok(self)
    }

    /// The step before which the next command is due.
    pub fn next_step(&self) -> Option<u64> {
        self.commands.front().map(|due| due.step)
    }

    /// Takes the next command if it is due at `step`.
    pub fn take_due(&mut self, step: u64) -> Option<Command> {
        self.next_step().filter(|due| *due <= step)?;
        self.commands.pop_front().map(|due| due.command)
    }
}

impl ScriptedCommand {
    fn due(&self, number: usize, clock: &Clock) -> Result<u64, ScriptError> {
        match (self.step, self.time) {
            (Some(step), _) => Ok(step),
            (None, Some(time)) if time.is_finite() && time >= 0.0 => Ok(clock.step_at(time)),
            (None, Some(time)) => Err(ScriptError::BadTime(number, time)),
            (None, None) => Err(ScriptError::NoTime(number)),
        }
    }
}

impl From<&StampedCommand> for ScriptedCommand {
    fn from(stamped: &StampedCommand) -> Self {
        Self {
            step: Some(stamped.step),
            time: Some(stamped.time),
            command: stamped.command.clone(),
        }
    }
}
