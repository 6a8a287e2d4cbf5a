//! Every call about a file fails once, or is the last one before the program or the power stops:
//! what is said, what is left, and that the same comes of the same command afterwards.

#[path = "../../tests/common/small_export.rs"]
mod small_export;

use super::{Job, RunnerError, run};
use crate::engines::{ImportSource, import};
use crate::files::{FailingCalls, is_temporary};
#[cfg(unix)]
use crate::files::{PowerCuts, Stop};
use crate::run::{BedKey, BedStore, Command, Parameter, Run, Session, Timeline};
use crate::scene::Scene;
use crate::solver::advise;
use crate::sweep::{self, Sweep, Variation};
use crate::world::{World, build};
use small_export::export_drum;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use tempfile::TempDir;

/// Something that reads and writes files in a folder.
struct Task {
    /// Is done in the folder before anything fails.
    before: fn(&Path),
    /// What comes of it, the same however often it is done; or what is said.
    act: fn(&Path) -> Result<String, String>,
    /// Whether what cannot be read or written is done without.
    does_without: bool,
}

const RUN: Task = Task {
    before: |_| {},
    act: run_once,
    does_without: false,
};

fn scene() -> Scene {
    let mut scene = Scene::open("bouncing-grain").unwrap();
    let values = [
        ("duration", "6ms"),
        ("output-interval", "2ms"),
        ("sample-interval", "1ms"),
    ];
    scene.set_all(&values).unwrap();
    scene
}

fn job(out: &Path) -> Job {
    Job {
        threads: 1,
        beds: BedStore::none(),
        checkpoints: true,
        ..Job::new("grain", scene(), out.join("run"))
    }
}

/// The message, after which the program ends with a code that suits it.
fn said(error: RunnerError) -> String {
    assert!(matches!(error.exit_code(), 1 | 2), "{error}");
    error.to_string()
}

fn run_once(out: &Path) -> Result<String, String> {
    act(&job(out))
}

fn act(job: &Job) -> Result<String, String> {
    let (_, run) = run(job, &mut (), &|| false).map_err(said)?;
    let run = run.into_run().map_err(|_| ()).unwrap();
    let summary = fs::read_to_string(job.out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    Ok(format!("{} {}", run.world().hash(), summary["files"]))
}

/// The same in the place of whatever run is there.
fn restart_once(out: &Path) -> Result<String, String> {
    act(&Job {
        restart: true,
        ..job(out)
    })
}

/// Leaves a longer run of another scene with files that the run has none of, done.
fn another_run(out: &Path) {
    let mut other = job(out);
    let values = [("duration", "12ms"), ("sample-interval", "2ms")];
    other.scene.set_all(&values).unwrap();
    act(&other).unwrap();
    fs::write(out.join("run/flow.csv"), "of the other run\n").unwrap();
}

/// Leaves a run that was stopped at its second output.
fn stop_early(out: &Path) {
    let calls = std::cell::Cell::new(0);
    let stop = || calls.replace(calls.get() + 1) >= 2;
    let (finished, run) = run(&job(out), &mut (), &stop).unwrap();
    assert_eq!(finished.ending.status(), "interrupted");
    assert!(run.run().is_some_and(|run| run.world().clock.step > 0));
}

fn sweep_once(out: &Path) -> Result<String, String> {
    let sweep = Sweep {
        name: "grain".into(),
        scene: scene(),
        settings: Vec::new(),
        variations: vec![Variation::parse("seed=1").unwrap()],
        out: out.join("sweep"),
        jobs: 1,
        beds: BedStore::none(),
        restart: false,
    };
    sweep::run(&sweep, &AtomicBool::new(false), &mut ()).map_err(said)?;
    Ok(fs::read_to_string(out.join("sweep/table.csv")).unwrap())
}

fn world() -> World {
    let scene = scene();
    build(&scene, advise(&scene).time_step)
}

fn session(value: f64) -> Session {
    let mut timeline = Timeline::new(Run::new(Arc::new(scene()), world(), 1), 0);
    let gravity = Command::Set {
        parameter: Parameter::Gravity,
        value: value.into(),
    };
    timeline.advance_to(20).unwrap();
    timeline.change(gravity, false).unwrap();
    timeline.advance_to(40).unwrap();
    Session::of("grain", &timeline)
}

/// The state in a session that was saved over an earlier one.
fn save_once(out: &Path) -> Result<String, String> {
    let path = out.join("a.grainfall");
    let named = |error| format!("{}: {error}", path.display());
    session(5.0).write(&path).map_err(named)?;
    let session = Session::read(&path).map_err(|error| error.to_string())?;
    Ok(session.record().state_hash.clone().unwrap())
}

/// The state of a bed that is found or else kept.
fn keep_bed(out: &Path) -> Result<String, String> {
    let (world, beds) = (world(), BedStore::at(out.join("beds")));
    let key = BedKey::of(&world, world.clock.time_step).unwrap();
    let found = beds.find(key, &world);
    if found.is_none() {
        beds.keep(key, &world)?;
    }
    Ok(found.unwrap_or(world).hash().to_string())
}

/// Every file below `folder` with its text, but what was never whole.
fn texts(folder: &Path) -> String {
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.retain(|path| !is_temporary(path.file_name().unwrap().to_str().unwrap()));
    paths.sort();
    let text = |path| fs::read_to_string(path).unwrap();
    paths.iter().map(text).collect()
}

fn export_once(out: &Path) -> Result<String, String> {
    export_drum(&out.join("deck")).map_err(|error| error.to_string())?;
    Ok(texts(&out.join("deck")))
}

fn import_once(out: &Path) -> Result<String, String> {
    let deck = out.join("deck");
    let source = ImportSource::beside(&deck).map_err(|error| error.to_string())?;
    let files = [deck.join("grains.data")];
    let imported = import(
        &files,
        &source.unwrap(),
        &out.join("imported"),
        false,
        &mut (),
    );
    match imported {
        Ok(imported) => Ok(imported.last.hash().to_string()),
        // What is there already is not replaced unasked.
        Err(error) if error.to_string().contains("an import begins anew") => {
            let summary = fs::read_to_string(out.join("imported/summary.json")).unwrap();
            let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
            Ok(summary["state_hash"].as_str().unwrap().to_owned())
        }
        Err(error) => Err(error.to_string()),
    }
}

/// What a stop may leave: files that are whole; after a power cut those that others vouch for, and
/// sessions.
fn assert_whole(folder: &Path, after_power_cut: bool) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            assert_whole(&path, after_power_cut);
            continue;
        }
        let Ok(text) = fs::read(&path) else { continue };
        let ends = |end: &[u8]| assert!(text.ends_with(end), "{}", path.display());
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("json") => drop(serde_json::from_slice::<serde_json::Value>(&text).unwrap()),
            Some("grainfall") => drop(Session::read(&path).unwrap()),
            _ if after_power_cut => {}
            Some("pvd" | "vtp") => ends(b"</VTKFile>\n"),
            Some("csv" | "data" | "sh" | "txt") => ends(b"\n"),
            _ => {}
        }
    }
}

/// A folder in memory where the system has such a place: no disk is waited for.
fn folder() -> TempDir {
    let in_memory = Path::new("/dev/shm");
    let made = if in_memory.is_dir() {
        tempfile::tempdir_in(in_memory)
    } else {
        tempfile::tempdir()
    };
    made.unwrap()
}

impl Task {
    /// What comes of it where nothing fails, in a folder of its own.
    fn undisturbed(&self) -> String {
        let home = folder();
        (self.before)(home.path());
        (self.act)(home.path()).unwrap()
    }

    /// Does it where the n-th call fails, for every n, or all from the n-th on; returns how many
    /// calls there are.
    fn fail_each(&self, lasting: bool) -> u64 {
        let whole = self.undisturbed();
        let mut n = 0;
        loop {
            let home = folder();
            let out = home.path();
            (self.before)(out);
            let failing = FailingCalls::below(out, move |call| call == n || (lasting && call > n));
            let outcome = (self.act)(out);
            let calls = failing.calls();
            drop(failing);
            assert_whole(out, false);
            match outcome {
                Err(message) => assert!(
                    message.contains(&out.display().to_string()),
                    "call {n} names its file: {message}"
                ),
                Ok(_) if self.does_without => {}
                Ok(_) => assert!(calls <= n, "call {n} of {calls} failed, and nobody said so"),
            }
            assert_eq!((self.act)(out), Ok(whole.clone()), "call {n}");
            if calls <= n {
                return n;
            }
            n += 1;
        }
    }

    /// Does it once more from every folder that a stop of the program or a power cut may leave on
    /// the way; returns how many these are.
    #[cfg(unix)]
    fn stop_each(&self) -> usize {
        let whole = self.undisturbed();
        let home = folder();
        (self.before)(home.path());
        let cuts = PowerCuts::of(home.path());
        assert_eq!((self.act)(home.path()), Ok(whole.clone()));
        let left = cuts.left();
        for (stop, left) in &left {
            let home = folder();
            for (name, bytes) in left {
                let path = home.path().join(name);
                match bytes {
                    Some(bytes) => fs::write(path, bytes).unwrap(),
                    None => fs::create_dir(path).unwrap(),
                }
            }
            assert_whole(home.path(), *stop == Stop::Power);
            let names: Vec<_> = left.keys().collect();
            let again = (self.act)(home.path());
            assert_eq!(again, Ok(whole.clone()), "{stop:?}: {names:?}");
        }
        // What is said to be done is on the disk.
        let lock = |name: &Path| name.ends_with(".grainfall.lock");
        let [mut there, mut durable] = cuts.now();
        there.retain(|name, _| !lock(name));
        durable.retain(|name, _| !lock(name));
        assert!(there == durable, "{:?}", durable.keys());
        left.len()
    }
}

fn try_all(name: &str, task: &Task) {
    let calls = task.fail_each(false);
    assert_eq!(task.fail_each(true), calls);
    #[cfg(unix)]
    println!(
        "{name}: {calls} calls, {} folders left by a stop",
        task.stop_each()
    );
    #[cfg(not(unix))]
    println!("{name}: {calls} calls");
}

#[test]
fn any_call_of_a_run_may_fail_or_be_its_last() {
    try_all("a run", &RUN);
}

#[test]
fn any_call_of_a_run_that_goes_on_may_fail_or_be_its_last() {
    let task = Task {
        before: stop_early,
        ..RUN
    };
    try_all("a run that goes on", &task);
}

/// Nothing of the run that is replaced is taken for the new one's, wherever that stops.
#[test]
fn any_call_of_a_run_that_replaces_another_may_fail_or_be_its_last() {
    let task = Task {
        before: another_run,
        act: restart_once,
        does_without: false,
    };
    let home = folder();
    assert_eq!(task.undisturbed(), run_once(home.path()).unwrap());
    try_all("a run in the place of another", &task);
}

#[test]
fn any_call_of_a_sweep_may_fail_or_be_its_last() {
    let task = Task {
        act: sweep_once,
        ..RUN
    };
    try_all("a sweep", &task);
}

#[test]
fn any_call_of_saving_a_session_may_fail_or_be_its_last() {
    let task = Task {
        before: |out| session(7.0).write(&out.join("a.grainfall")).unwrap(),
        act: save_once,
        does_without: false,
    };
    try_all("a session", &task);
}

#[test]
fn any_call_about_a_bed_may_fail_or_be_its_last() {
    let task = Task {
        act: keep_bed,
        does_without: true,
        ..RUN
    };
    try_all("a bed", &task);
    let found = Task {
        before: |out| drop(keep_bed(out).unwrap()),
        ..task
    };
    try_all("a bed that is there", &found);
}

#[test]
fn any_call_of_an_export_and_an_import_may_fail_or_be_its_last() {
    let task = Task {
        act: export_once,
        ..RUN
    };
    try_all("an export", &task);
    let task = Task {
        before: |out| drop(export_once(out).unwrap()),
        act: import_once,
        ..RUN
    };
    try_all("an import", &task);
}
