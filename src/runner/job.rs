//! What to run and where its files go.

use super::RunnerError;
use crate::parameters::live_parameters;
use crate::run::{BedStore, Script, ScriptedCommand, accept, available_threads};
use crate::scene::{Scene, SceneGrains};
use crate::solver::advise;
use crate::world::{SpeciesId, build, build_packed};
use glam::DVec3;
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
    /// Whether checkpoints are kept in the folder, so that the same job goes on after a stop. Where
    /// they are not, an earlier run in the folder is replaced.
    pub checkpoints: bool,
    /// Whether a run in the folder is replaced instead of gone on with.
    pub restart: bool,
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
            restart: false,
        }
    }

    /// Refuses a job whose commands cannot be carried out in its scene.
    ///
    /// # Errors
    /// What was asked for that cannot be, and what can.
    pub fn check(&self) -> Result<(), RunnerError> {
        if self.script.is_empty() {
            return Ok(());
        }
        check_script(&self.scene, &self.script).map_err(RunnerError::Input)
    }
}

/// Refuses a script that cannot be carried out in `scene`. Cells are not cut for that: what can be
/// changed about them does not depend on their shapes.
fn check_script(scene: &Scene, script: &[ScriptedCommand]) -> Result<(), String> {
    let time_step = advise(scene).time_step;
    let world = match scene.grains {
        SceneGrains::Voronoi(_) => {
            let mut world = build_packed(scene, time_step, Vec::new());
            // Shares are of grains, so it takes one.
            world
                .grains
                .push_sphere(DVec3::ZERO, 1.0, 1.0, SpeciesId(0));
            world
        }
        SceneGrains::Fill { .. } | SceneGrains::List(_) => build(scene, time_step),
    };
    let script = Script::new(script, &world.clock).map_err(|error| error.to_string())?;
    let parameters = live_parameters(scene, &world);
    let accepted = script.accepted(|command| accept(&parameters, &world, command));
    accepted.map(drop).map_err(|error| error.to_string())
}

/// Threads that the machine has beside the one that draws a window, one at least.
pub fn spare_threads() -> usize {
    available_threads().saturating_sub(1).max(1)
}
