//! `grainfall verify FILE`: computes again what a file states.
//!
//! In: a run's `summary.json`, or a session or a list of changes that was saved in the window. Out:
//! whether the state is the same to the bit and all else that the file states is what the run comes
//! to: time, grains, how it ended, results; and whether the files that it vouches for are as they
//! were written.

use super::drive::{End, drive};
use super::rest::RestWatch;
use super::{Advance, DirectRun, RunnerError, Watch, exit};
use crate::files::read_whole;
use crate::output::{Ending, IMPORTED, RunSoFar, digest_of_file, is_name_below};
use crate::run::{BedStore, RunRecord, Session, VERSION, fingerprint};
use crate::scene::within_folders;
use crate::solver::Fault;
use crate::world::StateHash;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// Largest record that is read [bytes]: one of a scene with as many listed grains as a file holds.
const LARGEST_FILE: u64 = 256 << 20;
/// Most that two results may differ by, relative to the larger: they are measured with functions
/// that differ in the last digit from platform to platform; the state is not.
const SAME_RESULT: f64 = 1e-9;
/// Steps after its time within which a fault that is stated has to be met.
const STEPS_TO_A_FAULT: u64 = 100;
/// How deep below its folder a run's files lie: in it, or in a folder of it.
const DEPTH: usize = 2;
/// Most differences that are named.
const MOST_NAMED: usize = 10;

/// What became of computing a stated state again.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The state is the same to the bit, and so is all else that is stated.
    Same,
    /// The state is the same, and something else is not: what, in sentences.
    Differs(Vec<String>),
    /// The run came to a state with this hash.
    Other(StateHash),
    /// The run met a fault on the way.
    Faulted(Fault),
    /// Somebody stopped it.
    Interrupted,
}

impl Verdict {
    /// What the process ends with: 0, 4, 3 or 130.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Same => exit::DONE,
            Self::Other(_) | Self::Differs(_) => exit::OTHER_STATE,
            Self::Faulted(_) => exit::FAULT,
            Self::Interrupted => exit::INTERRUPTED,
        }
    }
}

/// What became of the files that a record vouches for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VouchedFiles {
    /// How many are as they were written.
    pub same: usize,
    /// Those that are other than they were, or cannot be read, each with what is wrong.
    pub altered: Vec<String>,
    /// Those that are not there: they may lie elsewhere.
    pub missing: Vec<String>,
}

impl RunRecord {
    /// The record in the file at `path`: a session or JSON.
    ///
    /// # Errors
    /// When the file cannot be read, holds no record, or was edited since it was written.
    pub fn read(path: &Path) -> Result<Self, RunnerError> {
        if Session::is_at(path) {
            let session = Session::read(path).map_err(|e| RunnerError::Input(e.to_string()))?;
            return Ok(session.into_record());
        }
        let refuse = |reason: String| refused(path, &reason);
        let (record, is_as_written) = Self::stated_by(path)?;
        if record.status.as_deref() == Some(IMPORTED) {
            return Err(refuse(
                "its run was imported from another engine, and cannot be computed again here"
                    .into(),
            ));
        }
        if record.state_hash.is_none() {
            return Err(refuse("states no state to come to".into()));
        }
        if !is_as_written {
            return Err(refuse(format!(
                "its fingerprint does not fit: the file was edited or damaged, or written by another version than \
                 {VERSION} (it says {})",
                record.version
            )));
        }
        Ok(record)
    }

    /// The record in the JSON file at `path`, whatever run it is of, and whether it is as it was
    /// written.
    ///
    /// # Errors
    /// When the file cannot be read, or states no run of a sound scene.
    pub fn stated_by(path: &Path) -> Result<(Self, bool), RunnerError> {
        let refuse = |reason: String| refused(path, &reason);
        let bytes = read_whole(path, LARGEST_FILE)
            .map_err(|error| refuse(format!("cannot be read: {error}")))?;
        // A packing lies where the program is called, as when the record was made, or beside it.
        let folders = [Path::new("."), path.parent().unwrap_or(Path::new("."))];
        let record: Self = within_folders(&folders, || serde_json::from_slice(&bytes))
            .map_err(|error| refuse(error.to_string()))?;
        let stated: Value =
            serde_json::from_slice(&bytes).map_err(|error| refuse(error.to_string()))?;
        if record.program != "grainfall" {
            return Err(refuse("states no run of Grainfall".into()));
        }
        record.check().map_err(refuse)?;
        let is_as_written = record.fingerprint == Some(fingerprint(&stated));
        Ok((record, is_as_written))
    }

    /// Computes the state again on `threads` threads, from time zero, until `stop` says so, and
    /// compares all that is stated with it; `watch` hears how far it has come.
    ///
    /// # Errors
    /// When the scene or the commands cannot be run.
    pub fn verify(
        &self,
        threads: usize,
        beds: BedStore,
        watch: &mut dyn Watch,
        stop: &dyn Fn() -> bool,
    ) -> Result<Verdict, RunnerError> {
        let scene = Arc::new(self.scene.clone());
        let mut run = DirectRun::new(scene, self.commands.clone(), threads, beds).of_record();
        let end = End::Step(self.steps, self.time);
        let ending = drive(&mut run, end, None, watch, stop);
        let ending = ending.map_err(|error| error.within(&self.name))?;
        let view = match (ending, run.at().state()) {
            (Ending::Faulted(fault), _) => return Ok(Verdict::Faulted(fault)),
            (Ending::Interrupted, _) | (_, None) => return Ok(Verdict::Interrupted),
            (Ending::Done, Some(view)) => view,
        };
        let hash = view.world.hash();
        if self.state_hash != Some(hash.to_string()) {
            return Ok(Verdict::Other(hash));
        }
        let mut differences = self.differences(view);
        if self.status.as_deref() == Some("fault") {
            differences.extend(self.other_fault(&mut run, watch, stop)?);
        }
        differences.truncate(MOST_NAMED);
        Ok(if differences.is_empty() {
            Verdict::Same
        } else {
            Verdict::Differs(differences)
        })
    }

    /// What is stated beside the state and is not what `run` came to.
    fn differences(&self, run: RunSoFar) -> Vec<String> {
        let (world, mut found) = (run.world, Vec::new());
        let mut compare = |what: &str, stated: String, found_: String| {
            if stated != found_ {
                found.push(format!(
                    "{what}: {stated} is stated, the run comes to {found_}"
                ));
            }
        };
        compare(
            "time",
            format!("{:?} s", self.time),
            format!("{:?} s", world.time()),
        );
        if let Some(seed) = self.seed {
            compare("seed", seed.to_string(), self.scene.seed.to_string());
        }
        if self.fault.is_some() && self.status.as_deref() != Some("fault") {
            compare("fault", "one".into(), "none".into());
        }
        if let Some(grains) = self.grains {
            compare("grains", grains.to_string(), world.grains.len().to_string());
        }
        let last = world.clock.step_at(self.scene.duration);
        let rest = RestWatch::of_scene(&self.scene, self.commands.len());
        let is_at_rest = rest.is_some_and(|rest| rest.ends(world, run.series, run.commands.len()));
        let status = match self.status.as_deref() {
            Some("fault") | None => None,
            Some(_) if world.clock.step >= last || is_at_rest => Some("done"),
            Some(_) => Some("interrupted"),
        };
        if let (Some(status), Some(stated)) = (status, &self.status) {
            compare("status", stated.clone(), status.to_owned());
        }
        if let Some(stated) = &self.results {
            match serde_json::to_value(run.results()) {
                Ok(results) => compare_values("results", stated, &results, &mut found),
                Err(error) => found.push(format!("results: cannot be compared: {error}")),
            }
        }
        found
    }

    /// Whether the fault that is stated is not met: how, in a sentence.
    fn other_fault(
        &self,
        run: &mut DirectRun,
        watch: &mut dyn Watch,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<String>, RunnerError> {
        let fault = self.fault.as_ref();
        let Some(time) = fault.and_then(|fault| fault["time"].as_f64()) else {
            return Ok(Some(
                "status: a fault is stated, and none is described".into(),
            ));
        };
        let Some(clock) = run.at().state().map(|view| view.world.clock) else {
            return Ok(None);
        };
        let step = clock.step_at(time.min(self.scene.duration)) + STEPS_TO_A_FAULT;
        Ok(
            match drive(run, End::Step(step, time), None, watch, stop)? {
                Ending::Faulted(met) if is_stated(&met, fault) => None,
                Ending::Faulted(met) => Some(format!("fault: another one is met: {met}")),
                Ending::Interrupted => Some("fault: stopped before it could be met".into()),
                Ending::Done => Some(format!(
                    "status: a fault at t = {time:.6} s is stated, and none is met"
                )),
            },
        )
    }

    /// Compares the files that it vouches for, in `folder`, with what they were when they were
    /// written.
    pub fn check_files(&self, folder: &Path) -> VouchedFiles {
        check_digests(&self.files, folder, DEPTH)
    }
}

/// Compares these `files` below `folder`, at most so `deep` and each with its digest, with what they
/// were when they were written.
pub fn check_digests<'a>(
    files: impl IntoIterator<Item = (&'a String, &'a String)>,
    folder: &Path,
    deep: usize,
) -> VouchedFiles {
    let mut found = VouchedFiles::default();
    for (name, digest) in files {
        let path = folder.join(name);
        if !is_name_below(name, deep) {
            found
                .altered
                .push(format!("{name:?} is no name of a run's file"));
        } else if !path.exists() {
            found.missing.push(name.clone());
        } else if !fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_file()) {
            found.altered.push(format!("{name} is no file"));
        } else {
            match digest_of_file(&path) {
                Ok(own) if own == *digest => found.same += 1,
                Ok(_) => found
                    .altered
                    .push(format!("{name} was changed since it was written")),
                Err(error) => found
                    .altered
                    .push(format!("{name} cannot be read: {error}")),
            }
        }
    }
    found
}

/// That the file at `path` holds no record, and what it should be.
fn refused(path: &Path, reason: &str) -> RunnerError {
    RunnerError::Input(format!(
        "{}: {reason}; expected a run's summary.json, or a session or a list of changes saved in the window",
        path.display()
    ))
}

/// Whether the fault that was `met` is the one `stated`. Up to which state it is undone depends on
/// the pieces in which a run goes on, and does not count.
fn is_stated(met: &Fault, stated: Option<&Value>) -> bool {
    let (Ok(met), Some(stated)) = (serde_json::to_value(met), stated) else {
        return false;
    };
    ["grain", "time", "kind"]
        .iter()
        .all(|key| met[key] == stated[key])
}

/// Adds to `found` where `stated` is not what it `is`.
fn compare_values(place: &str, stated: &Value, is: &Value, found: &mut Vec<String>) {
    match (stated, is) {
        (Value::Object(stated), Value::Object(is)) => {
            let keys = stated
                .keys()
                .chain(is.keys().filter(|key| !stated.contains_key(*key)));
            for key in keys {
                let of = |map: &serde_json::Map<_, _>| map.get(key).cloned().unwrap_or_default();
                compare_values(&format!("{place}.{key}"), &of(stated), &of(is), found);
            }
        }
        (Value::Array(stated), Value::Array(is)) if stated.len() == is.len() => {
            for (index, (stated, is)) in stated.iter().zip(is).enumerate() {
                let name = is["name"].as_str();
                let name = name.map_or_else(|| index.to_string(), str::to_owned);
                compare_values(&format!("{place}.{name}"), stated, is, found);
            }
        }
        (stated, is) if are_same(stated, is) => {}
        (stated, is) => found.push(format!(
            "{place}: {stated} is stated, the run comes to {is}"
        )),
    }
}

fn are_same(stated: &Value, is: &Value) -> bool {
    match (stated.as_f64(), is.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME_RESULT * a.abs().max(b.abs()),
        _ => stated == is,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Job, run};
    use super::*;
    use crate::scene::Scene;
    use serde_json::json;

    /// A seed beside the scene's, and a fault of a run that is said to be done, were passed over.
    #[test]
    fn seed_and_fault_that_are_forged_with_a_fingerprint_that_fits_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = Scene::open("bouncing-grain").unwrap();
        let values = [("duration", "6ms"), ("output-interval", "2ms")];
        scene.set_all(&values).unwrap();
        let job = Job {
            threads: 1,
            beds: BedStore::none(),
            ..Job::new("grain", scene, folder.path())
        };
        run(&job, &mut (), &|| false).unwrap();
        let path = folder.path().join("summary.json");
        let whole: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        let verdict = |key: &str, value: Value| {
            let mut record = whole.clone();
            record[key] = value;
            record["fingerprint"] = fingerprint(&record).into();
            fs::write(&path, record.to_string()).unwrap();
            let record = RunRecord::read(&path).unwrap();
            record
                .verify(1, BedStore::none(), &mut (), &|| false)
                .unwrap()
        };
        assert_eq!(verdict("seed", whole["seed"].clone()), Verdict::Same);
        for (key, value, expected) in [
            ("seed", json!(99), "seed: 99 is stated, the run comes to 1"),
            ("fault", json!({"time": 0.001}), "fault: one is stated"),
        ] {
            let Verdict::Differs(what) = verdict(key, value) else {
                panic!("a forged {key} is found");
            };
            assert!(what[0].contains(expected) && what.len() == 1, "{what:?}");
        }
    }
}
