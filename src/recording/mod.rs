//! A run's folder, read back: what was computed can be looked at without computing it again.
//!
//! In: the folder of a run without a window or of an import, its `summary.json` or its
//! `grains.pvd`. Out: a [`Recording`]: the scene, the samples, the moments of which there are
//! states, and each of these states as a [`crate::world::World`] when it is asked for. Numbers have
//! the 32 bits of the files; what these do not hold (springs, the terms of forces) is NaN. Files
//! from elsewhere are bounded, checked and never trusted: see `SECURITY.md`.
//!
//! Each row of the table uses only rows below it.
//!
//! | file | holds |
//! |---|---|
//! | `follower` | a run under way: what it writes is taken up |
//! | `flow_survey` | the mean flow, measured on the states |
//! | `recorded_run` | what a folder holds, and its states one by one |
//! | `recorded_state` | a state out of the files of one instant |
//! | `course` | what was set when, and where the walls are by then |
//! | `stated` | what its record states of a run |
//! | `shapes` | what polyhedra look like |
//! | `tables` | the tables, each with what is to be said of it |
//! | `samples`, `flow_table`, `meetings_table` | `series.csv`, `flow.csv`, `events.csv` |
//! | `moments` | the list of the states' files |
//! | `vtk_arrays` | arrays out of VTK's XML files |
//! | `own_files` | files of the folder, each with its digest |
//! | `error` | why there is nothing to show |

mod course;
mod error;
mod flow_survey;
mod flow_table;
mod follower;
mod meetings_table;
mod moments;
mod own_files;
mod recorded_run;
mod recorded_state;
mod samples;
mod shapes;
mod stated;
mod tables;
mod vtk_arrays;

pub use error::RecordingError;
pub use flow_survey::FlowSurvey;
pub use follower::{Follower, RunNews};
pub use recorded_run::{RecordedState, Recording, RecordingFacts};
pub use stated::RunProgress;
