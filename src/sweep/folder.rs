//! The folder of a sweep: whose it is, and what it holds already.
//!
//! In: a sweep and its cases. Out: a folder with `sweep.json`, which says that it is a sweep's,
//! what is varied there, and in the end the states that the cases came to and the digests of tables
//! and plots. A folder that holds anything but a sweep, or cases of another one, is left alone;
//! tables and plots of an earlier sweep that a later one does not write give way.

use super::case::{self, CaseResult};
use super::{Case, Sweep};
use crate::files::{holds_files, read_whole, remove_file};
use crate::output::{OutputError, digest_of_file, write_file};
use crate::run::VERSION;
use crate::runner::{RunnerError, look};
use serde_json::{Map, Value, json};
use std::io::ErrorKind;
use std::path::PathBuf;

/// The file that says a folder is a sweep's.
pub const SWEEP: &str = "sweep.json";
/// Largest such file that is read [bytes].
const LARGEST: u64 = 256 << 20;

/// A sweep's folder.
pub struct SweepFolder {
    path: PathBuf,
}

impl SweepFolder {
    /// Makes the folder of `sweep`, or finds the one it goes on in. Every case is checked before
    /// anything is written.
    ///
    /// # Errors
    /// When a case asks for something that cannot be, the folder holds other files or other cases,
    /// or it cannot be written.
    pub fn open(sweep: &Sweep, cases: &[Case]) -> Result<Self, RunnerError> {
        for case in cases {
            look(&case::job(sweep, case)).map_err(|error| error.within(&case.name))?;
        }
        let folder = Self {
            path: sweep.out.clone(),
        };
        let failed = |source| OutputError::write(&sweep.out, source);
        // Another sweep may have made the folder its own between one look and the next.
        let is_foreign = folder.record()?.is_none()
            && holds_files(&folder.path).map_err(failed)?
            && folder.record()?.is_none();
        if is_foreign {
            return Err(RunnerError::Input(format!(
                "the output folder {} holds files that are not a sweep's: choose another with \
                 --out, or empty it",
                sweep.out.display()
            )));
        }
        if folder.record()?.is_none() {
            folder.write(sweep, &[], &Map::new())?;
        }
        Ok(folder)
    }

    /// Whether somebody began `sweep` already.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn exists(sweep: &Sweep) -> Result<bool, OutputError> {
        let path = sweep.out.clone();
        Ok(Self { path }.record()?.is_some())
    }

    /// States in the folder what the cases came to, with the digests of the `files` that were
    /// written there; those of an earlier sweep that were not are removed.
    ///
    /// # Errors
    /// When a file cannot be read, written or removed.
    pub fn close(
        &self,
        sweep: &Sweep,
        outcomes: &[CaseResult],
        files: Vec<String>,
    ) -> Result<(), RunnerError> {
        let mut digests = Map::new();
        for name in files {
            let path = self.path.join(&name);
            let digest =
                digest_of_file(&path).map_err(|source| OutputError::write(&path, source))?;
            digests.insert(name, digest.into());
        }
        let record = self.record()?.unwrap_or_default();
        let earlier = record["files"].as_object().into_iter().flatten();
        for (name, digest) in earlier.filter(|(name, _)| !digests.contains_key(*name)) {
            let path = self.path.join(name);
            // What was changed since is somebody's.
            let removed = match digest_of_file(&path) {
                Ok(own) if *digest == own => remove_file(&path),
                Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
                _ => Ok(()),
            };
            removed.map_err(|source| OutputError::write(&path, source))?;
        }
        self.write(sweep, outcomes, &digests)
    }

    fn write(
        &self,
        sweep: &Sweep,
        outcomes: &[CaseResult],
        files: &Map<String, Value>,
    ) -> Result<(), RunnerError> {
        let varied = sweep.variations.iter().map(|variation| {
            json!({
                "key": variation.key,
                "values": variation.values,
                "tied": variation.is_tied,
            })
        });
        let cases = outcomes.iter().map(|outcome| {
            json!({
                "name": outcome.case.name,
                "status": outcome.ending.status(),
                "state_hash": outcome.hash,
            })
        });
        let record = json!({
            "program": "grainfall",
            "version": VERSION,
            "scene": sweep.name,
            "varied": varied.collect::<Vec<_>>(),
            "settings": sweep.settings,
            "cases": cases.collect::<Vec<_>>(),
            "files": files,
        });
        write_file(&self.path.join(SWEEP), |file| {
            serde_json::to_writer_pretty(&mut *file, &record)?;
            file.write_all(b"\n")
        })?;
        Ok(())
    }

    /// What `sweep.json` states; none where there is no such file of a sweep's.
    ///
    /// # Errors
    /// When it cannot be read.
    fn record(&self) -> Result<Option<Value>, OutputError> {
        let path = self.path.join(SWEEP);
        let bytes = match read_whole(&path, LARGEST) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(OutputError::write(&path, error)),
        };
        // What is no JSON is no sweep's file either.
        let record: Value = serde_json::from_slice(&bytes).unwrap_or_default();
        Ok((record["program"] == "grainfall").then_some(record))
    }
}
