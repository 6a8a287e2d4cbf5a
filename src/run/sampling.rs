//! When a run is measured: after the first step at or after each multiple of an interval.
//!
//! In: the index of a sample and a clock. Out: the step after which it is taken. Nothing is
//! measured here.

use crate::world::World;

/// Simulated time between two samples [s].
pub const SAMPLE_INTERVAL: f64 = 0.02;

/// The step after which the sample of this index is taken.
pub fn sample_step(world: &World, sample: u64) -> u64 {
    world.clock.step_at(sample as f64 * SAMPLE_INTERVAL)
}

/// The first index from `sample` on whose sample is still to be taken when the run stands at
/// `world`.
pub fn next_sample(world: &World, sample: u64) -> u64 {
    let mut next = sample;
    while sample_step(world, next) <= world.clock.step {
        next += 1;
    }
    next
}
