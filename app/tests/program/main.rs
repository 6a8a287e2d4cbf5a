//! Claims about the program without a window: its command line, its files, its endings.

#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may be computed with the platform's own functions"
)]

mod command_line;
mod headless;
#[cfg(unix)]
mod outputs;
mod reliability;
#[allow(dead_code, reason = "tests of the library use more of it")]
#[path = "../../../tests/common/runs.rs"]
mod runs;
mod sweeps;
#[allow(dead_code, reason = "tests of the library use more of it")]
#[path = "../../../tests/common/vtk_file.rs"]
mod vtk_file;
