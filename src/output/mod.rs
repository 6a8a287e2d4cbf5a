//! The files that a run leaves behind.
//!
//! In: a [`RunSoFar`] of a run on its way. Out: a folder of files, each whole, in SI units. Not
//! here: when a run holds for its outputs and what is told meanwhile (see `runner`).
//!
//! Each row of the table uses only rows below it.
//!
//! | file | holds |
//! |---|---|
//! | `recorder` | which file is written when |
//! | `collection_file` | the list of the grains' files |
//! | `grains_file` | the grains at each output time, for `ParaView` |
//! | `polyhedra_file` | polyhedra as cells |
//! | `vtk` | VTK's XML files |
//! | `summary_file` | `summary.json`: what was run, how it ended, what came out |
//! | `series_file`, `profile_files`, `velocity_file` | tables: `series.csv`, `flow.csv` … |
//! | `folder` | where the files go; nobody else's are touched |
//! | `digest` | what tells a file from every other |
//! | `run_so_far`, `ending` | what is seen of a run; how it ended |
//! | `error` | why files cannot be written |

mod collection_file;
mod digest;
mod ending;
mod error;
mod folder;
mod grains_file;
mod polyhedra_file;
mod profile_files;
mod recorder;
mod run_so_far;
mod series_file;
mod summary_file;
mod velocity_file;
mod vtk;

pub use digest::digest_of_file;
pub use ending::Ending;
pub use error::OutputError;
pub use folder::{CHECKPOINT, OutputFolder, SAMPLES, SUMMARY, write_file};
pub use grains_file::write_grains;
pub use recorder::{Recorder, Subject, Written};
pub use run_so_far::RunSoFar;
