//! The commands that play a step's experiment, and when its run has answered.
//!
//! In: a step, the parameters of the run and their present values; then what is seen of the run.
//! Out: commands; the measured value, or why there is none. Every experiment begins at time zero with
//! the scene's values and those of its step, so that it comes to the same for everybody.

use super::description::{LessonStep, Measurement, is_same_parameter};
use crate::measure::{Estimate, Series};
use crate::parameters::{Parameter, ParameterInfo, Value};
use crate::run::{Command, StampedCommand};

/// What a lesson sees of a run.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// Its samples.
    pub series: &'a Series,
    /// The commands in its branch.
    pub commands: &'a [StampedCommand],
    /// The number of that branch.
    pub branch: u32,
    /// Whether everything that was asked for has been carried out or refused.
    pub has_answered: bool,
}

/// An experiment that is played.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Experiment {
    /// The branch that was left for it.
    left: u32,
    /// Its own branch, once it has begun.
    own: Option<u32>,
    /// How much of it is over, 0 … 1.
    pub progress: f64,
}

/// What became of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Course {
    /// It goes on.
    On,
    /// It is over.
    Measured(Estimate),
    /// It cannot answer any more, for the reason given.
    Spoilt(&'static str),
}

impl Experiment {
    /// One that begins now; `branch` is what is shown.
    pub fn from(branch: u32) -> Self {
        Self {
            left: branch,
            own: None,
            progress: 0.0,
        }
    }

    /// What becomes of it as far as the run is `seen`.
    pub fn follow(&mut self, measurement: &Measurement, seen: &Seen) -> Course {
        if !seen.has_answered || (self.own.is_none() && seen.branch == self.left) {
            return Course::On;
        }
        if *self.own.get_or_insert(seen.branch) != seen.branch {
            return Course::Spoilt("Another run is shown now: play this one again.");
        }
        let end = measurement.span.end;
        let spoils = |own: &StampedCommand| {
            matches!(own.command, Command::Set { .. }) && own.step > 0 && own.time < end
        };
        if seen.commands.iter().any(spoils) {
            return Course::Spoilt("A value was changed while it was measured: play it again.");
        }
        let newest = seen.series.time().last().copied().unwrap_or(0.0);
        self.progress = (newest / end).clamp(0.0, 1.0);
        measurement
            .of(seen.series)
            .map_or(Course::On, Course::Measured)
    }
}

/// What plays `step` from time zero in a run with these `parameters`, of which `value` tells the
/// present value: all of them as the scene has them, but those that the step sets.
pub(super) fn commands_of(
    step: &LessonStep,
    parameters: &[ParameterInfo],
    value: impl Fn(&Parameter) -> Option<Value>,
) -> Vec<Command> {
    // It stands until everything is set: so no step is taken with a value of before.
    let mut commands = vec![Command::Pause, Command::Reset];
    for info in parameters {
        let own = step
            .set
            .iter()
            .find(|(own, _)| is_same_parameter(own, &info.parameter));
        let wanted = own.map_or(info.default, |(_, value)| *value);
        if value(&info.parameter) != Some(wanted) {
            commands.push(Command::Set {
                parameter: info.parameter.clone(),
                value: wanted,
            });
        }
    }
    commands.extend(step.speed.map(Command::Speed));
    commands.push(Command::Play);
    commands
}
