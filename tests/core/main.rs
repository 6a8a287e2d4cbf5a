//! Claims about scenes, worlds, solver, measures and runs. No window, no driver needed.

#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may be computed with the platform's own functions"
)]

mod architecture;
mod comparison;
mod doors;
mod engines;
mod events;
#[path = "../common/hash_table.rs"]
mod hash_table;
mod kept_results;
mod lesson;
mod measure;
#[path = "../common/meshes.rs"]
mod meshes;
mod opening;
mod packages;
mod paper;
mod parameters;
mod recorder;
mod recording;
mod rest;
mod run;
#[path = "../common/runs.rs"]
mod runs;
mod same_bits;
mod scene;
mod session;
#[path = "../common/small_export.rs"]
mod small_export;
mod solver;
mod step;
mod sweep;
mod timeline;
mod vtk;
#[path = "../common/vtk_file.rs"]
mod vtk_file;
mod world;
