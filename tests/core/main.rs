//! Claims about scenes, worlds, solver, measures, runs and the headless runner. No window, no driver needed.

mod architecture;
#[cfg(feature = "headless")]
mod headless;
mod measure;
mod run;
mod scene;
mod session;
mod solver;
mod step;
mod sweep;
mod timeline;
mod twin;
mod vtk;
mod world;
