//! The record of a run, as files hold it: that this scene with these commands comes to that state.
//!
//! In: a state and all that leads to it. Out: a [`RunRecord`], as JSON files hold it. Its
//! fingerprint, over all that the file states, shows whether it was edited or damaged since.
//! Nothing is computed again here: `grainfall verify FILE` does that.

use super::{ScriptedCommand, StampedCommand};
use crate::files::write_whole;
use crate::scene::Scene;
use crate::world::World;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// Version of the program, as files state it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The name under which a file states its own fingerprint.
const FINGERPRINT: &str = "fingerprint";

/// A state and all that leads to it, as JSON files hold it; what else they hold is passed over.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RunRecord {
    /// Always `grainfall`.
    pub program: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// What the scene was called.
    pub name: String,
    /// Seed of everything random, where it is stated beside the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
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
    /// How the run ended, where the file is that of a whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<String>,
    /// What made the solver stop, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Value>,
    /// Number of grains, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grains: Option<usize>,
    /// The results, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub results: Option<Value>,
    /// Files beside it that it vouches for, by name, with their digests.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, String>,
    /// Hash of all that the file states but this.
    pub fingerprint: Option<String>,
}

/// Hash of all that a JSON object states but its own fingerprint: of names, values and numbers to
/// the last bit, however they are laid out.
pub fn fingerprint(stated: &Value) -> String {
    let mut hasher = blake3::Hasher::new();
    let empty = Map::new();
    let mut entries: Vec<_> = stated.as_object().unwrap_or(&empty).iter().collect();
    entries.retain(|(name, _)| *name != FINGERPRINT);
    hash_entries(entries, &mut hasher);
    hasher.finalize().to_hex()[..32].to_owned()
}

fn hash_entries(mut entries: Vec<(&String, &Value)>, hasher: &mut blake3::Hasher) {
    entries.sort_by_key(|(name, _)| *name);
    hasher
        .update(b"{")
        .update(&(entries.len() as u64).to_le_bytes());
    for (name, value) in entries {
        hash_text(name, hasher);
        hash_value(value, hasher);
    }
}

fn hash_text(text: &str, hasher: &mut blake3::Hasher) {
    hasher
        .update(b"\"")
        .update(&(text.len() as u64).to_le_bytes());
    hasher.update(text.as_bytes());
}

fn hash_value(value: &Value, hasher: &mut blake3::Hasher) {
    match value {
        Value::Null => {
            hasher.update(b"n");
        }
        Value::Bool(is) => {
            hasher.update(if *is { b"t" } else { b"f" });
        }
        Value::String(text) => hash_text(text, hasher),
        Value::Number(number) => {
            match (number.as_u64(), number.as_i64(), number.as_f64()) {
                (Some(n), ..) => hasher.update(b"u").update(&n.to_le_bytes()),
                (_, Some(n), _) => hasher.update(b"i").update(&n.to_le_bytes()),
                (.., x) => hasher
                    .update(b"x")
                    .update(&x.unwrap_or(f64::NAN).to_le_bytes()),
            };
        }
        Value::Array(list) => {
            hasher
                .update(b"[")
                .update(&(list.len() as u64).to_le_bytes());
            for value in list {
                hash_value(value, hasher);
            }
        }
        Value::Object(map) => hash_entries(map.iter().collect(), hasher),
    }
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
            status: None,
            seed: None,
            fault: None,
            grains: None,
            results: None,
            files: BTreeMap::new(),
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
            "the scene and its changes cannot be written as JSON, so they have no fingerprint";
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
        // What a record is missing of is told where it is written to a file.
        let stated = serde_json::to_value(self).ok()?;
        Some(fingerprint(&stated))
    }
}
