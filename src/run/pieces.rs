//! A long way cut into pieces that each take about the same wall-clock time.
//!
//! In: a goal and how to go there. Out: pieces, between which orders are heard, progress is told
//! and checkpoints are kept. How a way is cut does not show in a trajectory.

use std::time::Duration;

/// Steps that a piece has at least, as long as they take no longer than [`LONGEST`]: taking a state
/// in and giving it back costs as much as a dozen.
const LEAST_STEPS: u64 = 50;
/// Most wall-clock time that a piece takes where more than one step does not fit into it: whoever
/// stops a run is answered within a second.
const LONGEST: Duration = Duration::from_millis(500);
/// Steps of the first piece, before it is known how long one takes.
const FIRST_STEPS: u64 = 8;

/// How many steps the next piece has.
#[derive(Clone, Copy, Debug)]
pub struct Pieces {
    time: Duration,
    steps: u64,
}

impl Pieces {
    /// Pieces that take about `time` of wall-clock time each.
    pub fn of(time: Duration) -> Self {
        Self {
            time,
            steps: FIRST_STEPS,
        }
    }

    /// Steps that the next piece has at most.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Fits the next piece's steps to the time wanted, seeing that `steps` took `time`.
    pub fn fit(&mut self, steps: u64, time: Duration) {
        if steps == 0 {
            return;
        }
        let rate = steps as f64 / time.as_secs_f64().max(1e-9);
        let fitting = |time: Duration| (rate * time.as_secs_f64()) as u64;
        let most = 4 * self.steps.max(steps);
        let least = LEAST_STEPS.min(fitting(LONGEST)).max(1);
        self.steps = fitting(self.time).min(most).max(least);
    }
}
