//! The same bits on ARM: the golden runs, and every operation of the lanes.

#![cfg(test)]

#[path = "../../golden/main.rs"]
mod golden;
#[allow(dead_code, unused_imports, reason = "its tests are what is wanted")]
#[path = "../../../src/lanes/mod.rs"]
mod lanes;

#[test]
fn the_processor_has_lanes_of_its_own() {
    let all = lanes::Processor::all();
    println!("{}", lanes::Processor::detect());
    assert!(all.len() > 1, "{all:?}");
}
