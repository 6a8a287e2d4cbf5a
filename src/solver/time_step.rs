//! How long a step may be, and why.

use crate::scene::Scene;

/// One limit on the time step.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Limit {
    /// What sets it: `Rayleigh wave`, `Hertz contact` …
    pub name: &'static str,
    /// The step must not exceed it [s].
    pub time_step: f64,
    /// How it was computed, in words and numbers.
    pub reason: String,
}

/// The step to take and the limits it was chosen from.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct TimeStepAdvice {
    /// The step taken [s].
    pub time_step: f64,
    /// Every limit considered, the binding one first.
    pub limits: Vec<Limit>,
    /// What to tell people when a given step exceeds a limit.
    pub warning: Option<String>,
}

/// The time step for `scene`: the one it gives, or the largest that every limit allows.
pub fn advise(_scene: &Scene) -> TimeStepAdvice {
    unimplemented!("time step advice")
}
