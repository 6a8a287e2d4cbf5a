//! Where the time goes.
//!
//! In: times of the stages of steps ([`super::step`]). Out: what each stage took, and per grain and
//! step.

use std::time::{Duration, Instant};

/// A stage of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Finding the pairs that are near each other.
    Neighbours,
    /// Contact laws, pair by pair.
    Contacts,
    /// Summing forces on each grain and moving it.
    Integration,
    /// Copying the state in and out of the world.
    Exchange,
}

/// Time spent since the profile was last taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    /// Steps taken.
    pub steps: u64,
    /// Neighbour lists built.
    pub rebuilds: u64,
    /// Lists of the features of two polyhedra made.
    pub relisted: u64,
    /// Wall time in all.
    pub total: Duration,
    /// Wall time of each stage.
    pub stages: [Duration; 4],
    /// Grains.
    pub grains: usize,
    /// Listed pairs.
    pub listed: usize,
}

impl Stage {
    /// Every stage in the order of a step.
    pub const ALL: [Self; 4] = [
        Self::Neighbours,
        Self::Contacts,
        Self::Integration,
        Self::Exchange,
    ];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Neighbours => "neighbours",
            Self::Contacts => "contacts",
            Self::Integration => "integration",
            Self::Exchange => "exchange",
        }
    }
}

impl Profile {
    /// Does `work` on the clock of `stage`.
    pub(super) fn time_stage<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let begin = Instant::now();
        let result = work();
        self.add(stage, begin.elapsed());
        result
    }

    /// Books `time` spent in `stage`.
    pub(super) fn add(&mut self, stage: Stage, time: Duration) {
        self.stages[stage as usize] += time;
    }

    /// Time spent in `stage`.
    pub fn time(&self, stage: Stage) -> Duration {
        self.stages[stage as usize]
    }

    /// Part of the time that `stage` took, 0 … 1. Some stages are timed in some steps only and that
    /// is scaled up: where a step takes no longer than to look at the clock, they come to more than
    /// the whole, and count as parts of their sum.
    pub fn share(&self, stage: Stage) -> f64 {
        let whole = self.total.max(self.stages.iter().sum());
        self.time(stage).as_secs_f64() / whole.as_secs_f64().max(f64::MIN_POSITIVE)
    }

    /// Wall time per grain and step [s].
    pub fn per_grain_step(&self) -> f64 {
        self.total.as_secs_f64() / (self.steps.max(1) * self.grains.max(1) as u64) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_parts_of_a_whole() {
        let of = |total| Profile {
            total: Duration::from_millis(total),
            stages: [10, 20, 30, 20].map(Duration::from_millis),
            ..Profile::default()
        };
        let sum = |profile: Profile| -> f64 {
            let shares = Stage::ALL.map(|stage| profile.share(stage));
            shares.iter().sum()
        };
        assert!((sum(of(160)) - 0.5).abs() < 1e-12);
        assert!((sum(of(40)) - 1.0).abs() < 1e-12, "measured too long");
        assert!(Profile::default().share(Stage::Contacts).abs() < 1e-12);
    }
}
