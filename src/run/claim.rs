//! What a file claims: that this scene with these commands comes to that state.
//!
//! In: a state and all that leads to it. Out: a [`Claim`], as files hold it. A fingerprint over all that makes the claim
//! tells a file that was edited or damaged since. `grainfall verify FILE` computes the state again.

use super::{Command, ScriptedCommand, StampedCommand};
use crate::files::write_whole;
use crate::scene::Scene;
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;

/// Version of the program, as files state it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A state and all that leads to it, as JSON files hold it; what else they hold is passed over.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Claim {
    /// Always `grainfall`.
    pub program: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// What the scene was called.
    pub name: String,
    /// The scene as it was run.
    pub scene: Scene,
    /// What was changed, in order; those after the state too.
    pub commands: Vec<ScriptedCommand>,
    /// Steps taken until the state.
    pub steps: u64,
    /// Simulated time of the state [s].
    pub time: f64,
    /// Hash of the state; none where the run had not begun.
    pub state_hash: Option<String>,
    /// Hash of scene, commands, steps and state.
    pub fingerprint: Option<String>,
}

/// Hash of all that a claim states. Commands count by step and content.
pub fn fingerprint<'a>(
    scene: &Scene,
    commands: impl Iterator<Item = (Option<u64>, &'a Command)>,
    steps: u64,
    state_hash: Option<&str>,
) -> String {
    let commands: Vec<_> = commands.collect();
    let all = postcard::to_stdvec(&(scene, commands, steps, state_hash)).unwrap_or_default();
    blake3::hash(&all).to_hex()[..32].to_owned()
}

impl Claim {
    /// That `scene`, called `name`, with `commands` comes to `world`.
    pub fn of(name: &str, scene: &Scene, commands: &[StampedCommand], world: &World) -> Self {
        let commands: Vec<ScriptedCommand> = commands.iter().map(Into::into).collect();
        let mut claim = Self {
            program: "grainfall".into(),
            version: VERSION.into(),
            name: name.into(),
            scene: scene.clone(),
            commands,
            steps: world.clock.step,
            time: world.time(),
            state_hash: Some(world.hash().to_string()),
            fingerprint: None,
        };
        claim.fingerprint = Some(claim.own_fingerprint());
        claim
    }

    /// Writes it to the JSON file at `path`, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        write_whole(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            file.write_all(b"\n")
        })
    }

    /// Whether it is as the program wrote it.
    pub fn is_genuine(&self) -> bool {
        self.fingerprint.as_deref() == Some(&self.own_fingerprint())
    }

    fn own_fingerprint(&self) -> String {
        let commands = self
            .commands
            .iter()
            .map(|entry| (entry.step, &entry.command));
        fingerprint(
            &self.scene,
            commands,
            self.steps,
            self.state_hash.as_deref(),
        )
    }
}
