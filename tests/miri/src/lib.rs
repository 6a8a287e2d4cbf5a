//! Where the solver's `unsafe` stands, alone: the worker pool with its barrier, and the lanes.

#![allow(
    dead_code,
    unused_imports,
    reason = "each module is here for its unsafe parts alone"
)]

#[path = "../../../src/lanes/mod.rs"]
pub mod lanes;
pub mod solver;
