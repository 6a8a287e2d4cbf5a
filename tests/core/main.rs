//! Claims about scenes, worlds, solver, measures, runs and the headless runner. No window, no driver needed.

mod architecture;
mod comparison;
#[cfg(feature = "headless")]
mod headless;
mod measure;
mod parameters;
mod run;
mod scene;
mod session;
mod solver;
mod step;
mod sweep;
mod timeline;
mod vtk;
mod world;
