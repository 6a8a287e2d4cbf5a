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
//! | `frames` | what is written at each output time, and once at the first |
//! | `collection_file` | the lists of these files |
//! | `grains_file`, `contacts_file` | the grains and their contacts at an instant, for `ParaView` and OVITO |
//! | `shapes_file`, `container_file` | what polyhedra and the container look like |
//! | `vtk` | VTK's XML files |
//! | `base64` | bytes as text |
//! | `summary_file` | `summary.json`: what was run, how it ended, what came out |
//! | `series_file`, `profile_files`, `velocity_file`, `events_file` | tables: `series.csv`, `flow.csv` … |
//! | `folder` | where the files go; nobody else's are touched |
//! | `digest` | what tells a file from every other |
//! | `run_so_far`, `ending` | what is seen of a run; how it ended |
//! | `error` | why files cannot be written |

mod base64;
mod collection_file;
mod contacts_file;
mod container_file;
mod digest;
mod ending;
mod error;
mod events_file;
mod folder;
mod frames;
mod grains_file;
mod profile_files;
mod recorder;
mod run_so_far;
mod series_file;
mod shapes_file;
mod summary_file;
mod velocity_file;
mod vtk;

pub use contacts_file::write_contacts;
pub use container_file::write_container;
pub use digest::{digest_of, digest_of_file};
pub use ending::Ending;
pub use error::OutputError;
pub use events_file::{
    AVALANCHE_BEGINS, AVALANCHE_ENDS, BRIDGE_FORMS, BRIDGE_RUPTURES, CHANGE, EVENTS, FRONT_STOPS,
    IMPACT, PARTING, events_table,
};
pub use folder::{
    CHECKPOINT, FRAME_LOG, OutputFolder, PROFILES, SAMPLES, SUMMARY, is_name_below, is_own_name,
    write_file,
};
pub use frames::{Frame, LISTS};
pub use grains_file::write_grains;
pub use profile_files::{FLOW, flow_table};
pub use recorder::{IMPORTED, Recorder, Subject, Written, WrittenRest};
pub use run_so_far::RunSoFar;
pub use series_file::SERIES;
pub use shapes_file::{SHAPES, write_shapes};
