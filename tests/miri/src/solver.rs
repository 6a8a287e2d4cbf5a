//! The worker pool.

#[path = "../../../src/solver/barrier.rs"]
pub mod barrier;
#[path = "../../../src/solver/ranges.rs"]
pub mod ranges;
#[path = "../../../src/solver/workers.rs"]
pub mod workers;
