//! Checkpoints: a run as it stood, kept in its case's folder, so that a sweep that was stopped can go on.
//!
//! A finished case keeps its last checkpoint: calling the sweep again reads its results from it, and a longer duration goes
//! on from there. A checkpoint of another scene, script or version, or a damaged one, is none.

use super::Case;
use super::case::write;
use crate::headless::HeadlessError;
use crate::scene::Scene;
use crate::simulation::Checkpoint;
use std::fs;
use std::path::Path;

/// The file's name.
const FILE: &str = "checkpoint.bin";

/// What a checkpoint belongs to: a hash of version, scene and script; how long the run goes on and how often it is written
/// do not matter.
pub struct CaseKey(blake3::Hash);

impl CaseKey {
    /// The key of `case`.
    pub fn of(case: &Case) -> Self {
        let scene = Scene {
            duration: 0.0,
            output_interval: 0.0,
            ..case.scene.clone()
        };
        let all = (
            env!("CARGO_PKG_VERSION"),
            scene,
            case.time_step,
            &case.script,
        );
        Self(blake3::hash(&postcard::to_stdvec(&all).unwrap_or_default()))
    }
}

/// The checkpoint in `folder`, if it belongs to `key` and is whole.
pub fn read(folder: &Path, key: &CaseKey) -> Option<Checkpoint> {
    let bytes = fs::read(folder.join(FILE)).ok()?;
    let (found, rest) = bytes.split_at_checked(blake3::OUT_LEN)?;
    let (checksum, contents) = rest.split_at_checked(blake3::OUT_LEN)?;
    let sound = found == key.0.as_bytes() && checksum == blake3::hash(contents).as_bytes();
    sound.then(|| postcard::from_bytes(contents).ok()).flatten()
}

/// Keeps `checkpoint` in `folder`.
///
/// # Errors
/// When it cannot be written.
pub fn write_checkpoint(
    folder: &Path,
    key: &CaseKey,
    checkpoint: &Checkpoint,
) -> Result<(), HeadlessError> {
    let contents = postcard::to_stdvec(checkpoint).unwrap_or_default();
    write(&folder.join(FILE), |file| {
        file.write_all(key.0.as_bytes())?;
        file.write_all(blake3::hash(&contents).as_bytes())?;
        file.write_all(&contents)
    })
}
