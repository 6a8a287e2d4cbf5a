//! The one clock of a lab: how far its runs may go, whether there is one of them or there are two.
//!
//! In: ticks of wall-clock time, the speed asked for, play, pause, steps, a hold. Out: the step
//! that the runs should come to before the next command. It steps nothing itself and knows nothing
//! of states; a way to an earlier or later moment is the run's own, and the clock only lets it
//! pass.

use crate::world;
use std::time::Duration;

/// What the runs are to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// Hold.
    Paused,
    /// Go on at the speed asked for.
    Running,
    /// Go on to this step and hold there.
    Stepping {
        /// The step.
        until: u64,
    },
}

/// How far the runs of a lab may go.
#[derive(Clone, Debug)]
pub struct LabClock {
    mode: Mode,
    /// Simulated seconds per wall-clock second.
    speed: f64,
    /// Simulated time granted by ticks and not yet spent on whole steps [s].
    accumulator: f64,
    /// The step that ticks have granted.
    target: u64,
    /// The step that must not be passed for now.
    hold: u64,
}

impl LabClock {
    /// A clock that runs or holds, at `speed` simulated seconds per wall-clock second.
    pub fn new(runs: bool, speed: f64) -> Self {
        let mode = if runs { Mode::Running } else { Mode::Paused };
        Self {
            mode,
            speed,
            accumulator: 0.0,
            target: 0,
            hold: u64::MAX,
        }
    }

    /// What the runs are to do.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Goes on in `mode` from here; what earlier ticks granted is forgotten.
    pub fn set_mode(&mut self, mode: Mode) {
        self.mode = mode;
        self.target = 0;
        self.accumulator = 0.0;
    }

    /// Goes on at `speed` from here; what earlier ticks granted is forgotten.
    pub fn set_speed(&mut self, speed: f64) {
        self.speed = speed;
        self.set_mode(self.mode);
    }

    /// Lets the runs go no further than `step`, or as far as they may.
    pub fn hold_at(&mut self, step: Option<u64>) {
        self.hold = step.unwrap_or(u64::MAX);
    }

    /// Grants what `passed` wall-clock time is worth to runs that stand at `now`.
    pub fn tick(&mut self, passed: Duration, now: world::Clock) {
        if self.mode != Mode::Running {
            return;
        }
        if self.speed.is_infinite() {
            self.target = u64::MAX;
            return;
        }
        self.accumulator += self.speed * passed.as_secs_f64();
        let steps = (self.accumulator / now.time_step).floor();
        self.accumulator -= steps * now.time_step;
        self.target = now.step + steps as u64;
    }

    /// The step to show at a finite speed, if the runs go on: what is recorded already may be
    /// skipped up to there.
    pub fn due(&self) -> Option<u64> {
        (self.mode == Mode::Running && self.speed.is_finite()).then_some(self.target)
    }

    /// The step to come to before the next command, for a run on the way to `destination` or on no
    /// such way.
    pub fn goal(&self, destination: Option<u64>) -> u64 {
        let goal = match (destination, self.mode) {
            (Some(destination), _) => destination,
            (None, Mode::Paused) => 0,
            (None, Mode::Running) => self.target,
            (None, Mode::Stepping { until }) => until,
        };
        goal.min(self.hold)
    }

    /// Notes that all runs have come to `step`: single steps end there.
    pub fn reach(&mut self, step: u64) {
        if matches!(self.mode, Mode::Stepping { until } if until <= step) {
            self.mode = Mode::Paused;
        }
    }

    /// Holds where the runs stand, because of a fault.
    pub fn stop(&mut self) {
        self.mode = Mode::Paused;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(step: u64) -> world::Clock {
        let mut now = world::Clock::new(0.5);
        now.step = step;
        now
    }

    #[test]
    fn parts_of_a_step_are_saved_up_and_none_is_lost() {
        let mut clock = LabClock::new(true, 0.5);
        clock.tick(Duration::from_millis(1500), at(7));
        assert_eq!(clock.goal(None), 8, "0.75 s are one step");
        clock.tick(Duration::from_millis(1500), at(8));
        assert_eq!(clock.goal(None), 10, "0.25 s and 0.75 s are two");
    }

    #[test]
    fn no_goal_lies_beyond_the_hold() {
        let mut clock = LabClock::new(true, f64::INFINITY);
        clock.tick(Duration::ZERO, at(0));
        assert_eq!(clock.goal(None), u64::MAX);
        clock.hold_at(Some(5));
        assert_eq!((clock.goal(None), clock.goal(Some(9))), (5, 5));
        clock.set_mode(Mode::Stepping { until: 4 });
        assert_eq!(clock.goal(None), 4);
        clock.reach(4);
        assert_eq!((clock.mode(), clock.goal(None)), (Mode::Paused, 0));
    }
}
