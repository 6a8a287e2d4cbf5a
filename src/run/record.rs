//! The record of a run, as files hold it: that this scene with these commands comes to that state.
//!
//! In: a state and all that leads to it. Out: a [`RunRecord`], as JSON files hold it. Its
//! fingerprint shows whether the file was edited or damaged since. Nothing is computed again here:
//! `grainfall verify FILE` does that.

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
pub struct RunRecord {
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

/// Hash of all that a record states; none where that cannot be written as bytes. Commands count by
/// step and content.
pub fn fingerprint<'a>(
    scene: &Scene,
    commands: impl Iterator<Item = (Option<u64>, &'a Command)>,
    steps: u64,
    state_hash: Option<&str>,
) -> Option<String> {
    let commands: Vec<_> = commands.collect();
    // What a fingerprint is missing of is told where it is written to a file.
    let all = postcard::to_stdvec(&(scene, commands, steps, state_hash)).ok()?;
    Some(blake3::hash(&all).to_hex()[..32].to_owned())
}

impl RunRecord {
    /// That `scene`, called `name`, with `commands` comes to `world`.
    pub fn of(name: &str, scene: &Scene, commands: &[StampedCommand], world: &World) -> Self {
        let commands: Vec<ScriptedCommand> = commands.iter().map(Into::into).collect();
        let mut record = Self {
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
        record.fingerprint = record.own_fingerprint();
        record
    }

    /// Writes it to the JSON file at `path`, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written, or has no fingerprint.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.check_fingerprint()?;
        write_whole(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            file.write_all(b"\n")
        })
    }

    /// Refuses to be written without a fingerprint.
    pub(super) fn check_fingerprint(&self) -> io::Result<()> {
        let reason =
            "the scene and its changes cannot be written as bytes, so they have no fingerprint";
        let missing = || io::Error::other(reason);
        self.fingerprint.as_ref().map(drop).ok_or_else(missing)
    }

    /// It with the fingerprint of what it states.
    #[must_use]
    pub fn sealed(mut self) -> Self {
        self.fingerprint = self.own_fingerprint();
        self
    }

    /// Whether it is as the program wrote it.
    pub fn is_genuine(&self) -> bool {
        self.fingerprint.is_some() && self.fingerprint == self.own_fingerprint()
    }

    fn own_fingerprint(&self) -> Option<String> {
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
