//! Commands that are carried out by themselves when their time comes: how a recorded run is played again.
//!
//! In: a list of (step or time, command). Out: each command once, before the first step at or after its own.

use super::{Command, StampedCommand};
use crate::world::Clock;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// A command and when it is due, as files hold it. Where both step and time are given, as in a recorded list, the step
/// decides.
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
    commands: VecDeque<(u64, Command)>,
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
            due.push((entry.due(index + 1, clock)?, entry.command.clone()));
        }
        due.sort_by_key(|(step, _)| *step);
        Ok(Self {
            commands: due.into(),
        })
    }

    /// The script of `commands` in order of their steps.
    pub(crate) fn in_order(commands: impl Iterator<Item = (u64, Command)>) -> Self {
        Self {
            commands: commands.collect(),
        }
    }

    /// What is due after `step`.
    pub(crate) fn after(&self, step: u64) -> impl Iterator<Item = (u64, Command)> {
        let later = move |entry: &&(u64, Command)| entry.0 > step;
        self.commands.iter().filter(later).cloned()
    }

    /// What is still to be carried out.
    pub fn commands(&self) -> impl Iterator<Item = &Command> {
        self.commands.iter().map(|(_, command)| command)
    }

    /// The step before which the next command is due.
    pub fn next_step(&self) -> Option<u64> {
        self.commands.front().map(|(step, _)| *step)
    }

    /// Takes the next command if it is due at `step`.
    pub fn take_due(&mut self, step: u64) -> Option<Command> {
        self.next_step().filter(|due| *due <= step)?;
        self.commands.pop_front().map(|(_, command)| command)
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
