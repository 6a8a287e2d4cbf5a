//! Which step of a run was when, where its time step changed on the way.
//!
//! In: the first time step and the commands of the run. Out: the time of a step and the step at a
//! time. A world's clock knows its own present step alone; this knows the whole run.

use super::{Command, Parameter, StampedCommand};

/// The times of a run's steps.
#[derive(Clone, Debug, PartialEq)]
pub struct StepTimes {
    /// Parts of one time step each, in order, the first from step 0 on.
    parts: Vec<StepInterval>,
}

/// A time step and from when on it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StepInterval {
    step: u64,
    /// [s]
    time: f64,
    /// [s]
    time_step: f64,
}

impl StepTimes {
    /// Of a run that began with steps of `time_step` [s] and was changed by `commands`.
    pub fn new(time_step: f64, commands: &[StampedCommand]) -> Self {
        let first = StepInterval {
            step: 0,
            time: 0.0,
            time_step,
        };
        let later = commands.iter().filter_map(|stamped| match stamped.command {
            Command::Set {
                parameter: Parameter::TimeStep,
                value,
            } => Some(StepInterval {
                step: stamped.step,
                time: stamped.time,
                time_step: value.number(),
            }),
            _ => None,
        });
        Self {
            parts: [first].into_iter().chain(later).collect(),
        }
    }

    /// Simulated time at `step` [s].
    pub fn time_at(&self, step: u64) -> f64 {
        let part = self.last(|part| part.step <= step);
        part.time + (step - part.step) as f64 * part.time_step
    }

    /// The step nearest to `time` [s].
    pub fn step_at(&self, time: f64) -> u64 {
        let time = time.max(0.0);
        let part = self.last(|part| part.time <= time);
        let steps = ((time - part.time) / part.time_step).round() as u64;
        part.step.saturating_add(steps)
    }

    /// The last part that `began`; the first one always has.
    fn last(&self, began: impl Fn(&StepInterval) -> bool) -> StepInterval {
        let began = self.parts.partition_point(began);
        self.parts[began.max(1) - 1]
    }
}
