//! Checkpoints: a run as it stood, kept in its folder, so that a run that was stopped can go on.
//!
//! In: a run and what was written of it. Out: a file, and from it the same. A finished run keeps
//! its last checkpoint: the same command again reads its results from it, and a longer duration
//! goes on from there. A checkpoint of another scene, script or version is none.

use super::Job;
use crate::output::{CHECKPOINT, OutputError, Written, write_file};
use crate::run::{Checkpoint, VERSION};
use crate::scene::Scene;
use crate::solver::advise;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{self, ErrorKind};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Raised whenever the file is laid out otherwise.
const LAYOUT: u32 = 3;
/// Wall-clock time between two checkpoints.
const CHECKPOINT_TIME: Duration = Duration::from_secs(20);

/// A run as it stood and what was written of it until then.
#[derive(Serialize, Deserialize)]
pub struct Kept {
    /// The run.
    pub checkpoint: Checkpoint,
    /// Its files.
    pub written: Written,
}

/// What became of looking for a checkpoint.
pub enum CheckpointLookup {
    /// It is there.
    Kept(Box<Kept>),
    /// There is none of this run.
    Nothing,
    /// There is one that cannot be read, for the reason given.
    Damaged(String),
}

/// The file that a run's checkpoints are kept in.
pub struct CheckpointFile {
    path: PathBuf,
    /// What the run is: version, scene and script. How long it goes on does not matter, nor, where
    /// no grains are written, how often they would be.
    key: blake3::Hash,
    written: Instant,
}

impl CheckpointFile {
    /// The file of the run that `job` asks for.
    ///
    /// # Errors
    /// When the job cannot be told from others.
    pub fn of(job: &Job) -> Result<Self, OutputError> {
        let path = job.out.join(CHECKPOINT);
        let scene = Scene {
            duration: 0.0,
            output_interval: if job.grains {
                job.scene.output_interval
            } else {
                0.0
            },
            ..job.scene.clone()
        };
        let time_step = advise(&job.scene).time_step;
        let all = (LAYOUT, VERSION, scene, time_step, &job.script, job.grains);
        let all = postcard::to_stdvec(&all)
            .map_err(|error| OutputError::write(&path, io::Error::other(error)))?;
        Ok(Self {
            key: blake3::hash(&all),
            path,
            written: Instant::now(),
        })
    }

    /// What is kept of the run.
    pub fn read(&self) -> CheckpointLookup {
        let bytes = match fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return CheckpointLookup::Nothing,
            Err(error) => return self.damaged(&error.to_string()),
        };
        let Some((found, rest)) = bytes.split_at_checked(blake3::OUT_LEN) else {
            return self.damaged("it was cut off");
        };
        if found != self.key.as_bytes() {
            return CheckpointLookup::Nothing;
        }
        let Some((checksum, contents)) = rest.split_at_checked(blake3::OUT_LEN) else {
            return self.damaged("it was cut off");
        };
        if checksum != blake3::hash(contents).as_bytes() {
            return self.damaged("its checksum does not fit");
        }
        match postcard::from_bytes(contents) {
            Ok(kept) => CheckpointLookup::Kept(Box::new(kept)),
            Err(error) => self.damaged(&error.to_string()),
        }
    }

    fn damaged(&self, reason: &str) -> CheckpointLookup {
        CheckpointLookup::Damaged(format!(
            "the checkpoint in {} cannot be used: {reason}; the run was begun anew",
            self.path.display()
        ))
    }

    /// Whether the last checkpoint is so old that another is due.
    pub fn is_due(&self) -> bool {
        self.written.elapsed() > CHECKPOINT_TIME
    }

    /// Keeps `kept`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&mut self, kept: &Kept) -> Result<(), OutputError> {
        let contents = postcard::to_stdvec(kept)
            .map_err(|error| OutputError::write(&self.path, io::Error::other(error)))?;
        write_file(&self.path, |file| {
            file.write_all(self.key.as_bytes())?;
            file.write_all(blake3::hash(&contents).as_bytes())?;
            file.write_all(&contents)
        })?;
        self.written = Instant::now();
        Ok(())
    }
}
