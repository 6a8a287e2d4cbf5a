//! Claims about scenes, worlds, solver, measures, runs and the headless runner. No window, no
//! driver needed.

#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may be computed with the platform's own functions"
)]

mod architecture;
#[cfg(feature = "headless")]
mod command_line;
mod comparison;
mod doors;
mod engines;
#[cfg(feature = "headless")]
mod headless;
mod measure;
#[cfg(all(feature = "headless", unix))]
mod outputs;
mod paper;
mod parameters;
mod recorder;
mod recording;
#[cfg(feature = "headless")]
mod reliability;
mod run;
mod same_bits;
mod scene;
mod session;
mod solver;
mod step;
mod sweep;
mod timeline;
mod vtk;
mod world;
