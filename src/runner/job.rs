//! What to run and where its files go.

use crate::run::{BedStore, ScriptedCommand};
use crate::scene::Scene;
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
    /// Whether the grains are written at each output time.
    pub grains: bool,
    /// Whether checkpoints are kept in the folder, so that the same job goes on after a stop.
    pub checkpoints: bool,
}

impl Job {
    /// A run of `scene`, called `name`, with its files in the folder `out`, on all cores: the
    /// grains at each output time, no commands, no checkpoints, the user's beds.
    pub fn new(name: impl Into<String>, scene: Scene, out: impl Into<PathBuf>) -> Self {
        Self {
            scene,
            name: name.into(),
            out: out.into(),
            threads: available_threads(),
            script: Vec::new(),
            beds: BedStore::user(),
            grains: true,
            checkpoints: false,
        }
    }
}

/// Threads that the machine has.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
