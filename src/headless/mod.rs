//! The windowless runner: progress, output files, exit codes.
//!
//! In: a [`Job`]: a scene, where its files go, what to change. Out: the files (`series.csv`, `grains.pvd` with one `.vtp` or
//! `.vtu` per output time, `summary.json`) and an [`Ending`]. The run is moved by the same system as in the window, inline
//! and as fast as the machine can.

mod claim;
mod commands_file;
mod error;
mod folder;
mod grains_file;
mod pack;
mod polyhedra_file;
mod profile_files;
#[cfg(feature = "headless")]
mod program;
mod progress;
#[cfg(feature = "headless")]
mod recorder;
#[cfg(feature = "headless")]
mod report;
mod series_file;
mod setting;
mod summary_file;
mod velocity_file;

pub use claim::Verdict;
pub use commands_file::read_commands;
pub use error::HeadlessError;
pub(crate) use folder::SUMMARY;
pub use grains_file::write_grains;
pub use pack::pack;
pub(crate) use profile_files::{FLOW, PROFILE, write_flow, write_profile};
#[cfg(feature = "headless")]
pub use program::run;
pub(crate) use progress::{Progress, spoken};
pub(crate) use series_file::{SERIES, write_series};
pub use setting::{apply_setting, compared_value};
pub(crate) use summary_file::SummaryFile;
pub(crate) use velocity_file::{VELOCITY, write_velocity};

use crate::run::{BedStore, ScriptedCommand};
use crate::scene::Scene;
use crate::solver::Fault;
use std::path::PathBuf;

/// What to run and where its files go.
#[derive(Clone, Debug)]
pub struct Job {
    /// The scene.
    pub scene: Scene,
    /// What to call it in the summary.
    pub name: String,
    /// The output folder.
    pub out: PathBuf,
    /// Threads the solver works on.
    pub threads: usize,
    /// Commands carried out when their time comes.
    pub script: Vec<ScriptedCommand>,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// It reached its duration.
    Done,
    /// Somebody stopped it; its files are whole.
    Interrupted,
    /// The solver met an absurd state; the files hold all up to the last good one.
    Faulted(Fault),
}

impl Ending {
    /// What the process ends with: 0, 130 or 3.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Interrupted => 130,
            Self::Faulted(_) => 3,
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Interrupted => "interrupted",
            Self::Faulted(_) => "fault",
        }
    }

    fn fault(&self) -> Option<&Fault> {
        match self {
            Self::Faulted(fault) => Some(fault),
            Self::Done | Self::Interrupted => None,
        }
    }
}
