//! The same bits on ARM: the golden runs of `tests/core`, and every operation of the lanes.

#![cfg(test)]

#[path = "../../core/solver/golden.rs"]
mod golden;
#[allow(dead_code, unused_imports, reason = "its tests are what is wanted")]
#[path = "../../../src/lanes/mod.rs"]
mod lanes;

use grainfall::scene::Scene;
use grainfall::solver::Solver;
use grainfall::world::{World, build};

#[test]
fn the_processor_has_lanes_of_its_own() {
    let all = lanes::Processor::all();
    println!("{}", lanes::Processor::detect());
    assert!(all.len() > 1, "{all:?}");
}
