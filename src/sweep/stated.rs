//! What a sweep's folder states, to be confirmed.
//!
//! In: `sweep.json`. Out: the cases with the states that they came to, and whether tables and plots
//! are as they were written. Nothing is computed.

use super::folder::SWEEP;
use crate::files::read_whole;
use crate::output::{SUMMARY, is_name_below};
use crate::run::RunRecord;
use crate::runner::{RunnerError, VouchedFiles, check_digests};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Largest file that is read [bytes].
const LARGEST: u64 = 256 << 20;

/// How deep below its folder a sweep's plots lie: in folders of one.
const DEPTH: usize = 3;

/// A sweep as its folder states it.
#[derive(Clone, Debug)]
pub struct StatedSweep {
    folder: PathBuf,
    /// Its cases, by the names of their folders, each with the hash of the state that it came to.
    pub cases: Vec<(String, String)>,
    files: BTreeMap<String, String>,
}

impl StatedSweep {
    /// The file of the sweep at `path`, where that is one or the folder of one.
    pub fn at(path: &Path) -> Option<PathBuf> {
        let file = if path.is_dir() {
            path.join(SWEEP)
        } else {
            path.to_owned()
        };
        let is_sweeps = file.file_name().is_some_and(|name| name == SWEEP);
        (is_sweeps && file.is_file()).then_some(file)
    }

    /// What the `file` of a sweep states.
    ///
    /// # Errors
    /// When it cannot be read, or states no finished sweep.
    pub fn read(file: &Path) -> Result<Self, RunnerError> {
        let refuse = |reason: String| RunnerError::Input(format!("{}: {reason}", file.display()));
        let bytes = read_whole(file, LARGEST)
            .map_err(|error| refuse(format!("cannot be read: {error}")))?;
        let stated: Value =
            serde_json::from_slice(&bytes).map_err(|error| refuse(error.to_string()))?;
        if stated["program"] != "grainfall" {
            return Err(refuse("states no sweep of Grainfall".into()));
        }
        let case = |case: &Value| {
            let name = case["name"]
                .as_str()
                .filter(|name| is_name_below(name, 1))?;
            Some((name.to_owned(), case["state_hash"].as_str()?.to_owned()))
        };
        let listed = stated["cases"].as_array();
        let cases: Option<Vec<_>> = listed.into_iter().flatten().map(case).collect();
        let cases = cases.ok_or_else(|| refuse("states a case without name or state".into()))?;
        if cases.is_empty() {
            let reason = "states no case that is done: run the sweep to its end first";
            return Err(refuse(reason.into()));
        }
        let files = stated["files"].as_object().into_iter().flatten();
        let digest = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        Ok(Self {
            folder: file.parent().unwrap_or(Path::new("")).to_owned(),
            cases,
            files: files
                .map(|(name, own)| (name.clone(), digest(own)))
                .collect(),
        })
    }

    /// The record of the case called `name`.
    pub fn summary(&self, name: &str) -> PathBuf {
        self.folder.join(name).join(SUMMARY)
    }

    /// Whether `record`, that of the case called `name`, states what the sweep does: how not, in a
    /// sentence.
    pub fn difference(&self, name: &str, record: &RunRecord) -> Option<String> {
        let (_, stated) = self.cases.iter().find(|(own, _)| own == name)?;
        let own = record.state_hash.as_deref().unwrap_or("none");
        (own != stated).then(|| {
            format!(
                "{name}: its summary states state {own}, the sweep's table was made of {stated}"
            )
        })
    }

    /// Compares tables and plots with what they were when they were written.
    pub fn check_files(&self) -> VouchedFiles {
        check_digests(&self.files, &self.folder, DEPTH)
    }
}
