//! A run that forgets what it measured, as that stands in files, and one that forgets nothing: the
//! same results, the same files, to the bit.

use super::{Advance, At, DirectRun, Halt, Job, Runner};
use crate::measure::Summary;
use crate::run::{BedStore, Command, Measured, Parameter, Run, ScriptedCommand, Stored};
use crate::scene::Scene;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A run, and what it keeps on its way.
struct Watched {
    run: DirectRun,
    /// Whether it may forget.
    forgets: bool,
    /// The most samples that it kept at once.
    most: usize,
    /// Whether samples and profiles were forgotten.
    was_part: bool,
}

impl Advance for Watched {
    fn at(&self) -> At<'_> {
        self.run.at()
    }

    fn advance(&mut self, goal: u64) -> Result<(), Halt> {
        let done = self.run.advance(goal);
        if let Some(run) = self.run.run() {
            self.most = self.most.max(run.series().len());
            self.was_part |= run.series().is_part() && run.flow().is_part();
        }
        done
    }

    fn warnings(&self) -> Vec<String> {
        self.run.warnings()
    }

    fn forget(&mut self, stored: Stored) {
        if self.forgets {
            self.run.forget(stored);
        }
    }

    fn remember(&mut self, measured: Measured) {
        assert!(self.forgets);
        self.run.remember(measured);
    }
}

/// Three seconds of a drum of few grains that flow; it turns more slowly on the way.
fn job(out: &Path) -> Job {
    let mut scene = Scene::open("small-drum").unwrap();
    let values = [
        ("count", "20"),
        ("duration", "3.3s"),
        ("output-interval", "0.5s"),
    ];
    scene.set_all(&values).unwrap();
    let turning = |time: f64, speed: f64| ScriptedCommand {
        step: None,
        time: Some(time),
        command: Command::Set {
            parameter: Parameter::DrumSpeed,
            value: speed.into(),
        },
    };
    Job {
        threads: 1,
        beds: BedStore::none(),
        checkpoints: true,
        script: vec![turning(0.0, 1.0), turning(1.7, 0.5)],
        ..Job::new("drum", scene, out)
    }
}

/// Runs the job, until `stops` looks at whether to stop; returns its results and how it went.
fn run(job: &Job, forgets: bool, stops: u32) -> (Summary, Watched) {
    let mut runner = Runner::open(job).unwrap().keeping_always();
    let run = DirectRun::of(job).from_checkpoint(runner.take_checkpoint());
    let mut run = Watched {
        run,
        forgets,
        most: 0,
        was_part: false,
    };
    let looks = Cell::new(0);
    let stop = || looks.replace(looks.get() + 1) >= stops;
    let finished = runner.finish(&mut run, &mut (), &stop).unwrap();
    (finished.results, run)
}

/// The files of a finished run, but for the time that it took and what it goes on from.
fn files(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(out).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() || name.starts_with('.') || name == "checkpoint.bin" {
            continue;
        }
        let mut bytes = fs::read(&path).unwrap();
        if name == "summary.json" {
            let mut summary: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
            summary["wall_time"] = 0.into();
            summary["fingerprint"] = 0.into();
            bytes = summary.to_string().into_bytes();
        }
        found.insert(name, bytes);
    }
    found
}

/// All samples of a run stayed in memory beside the files that hold them: 40 kB for a simulated
/// second.
#[test]
fn run_that_forgets_what_stands_in_files_comes_to_the_same_results_and_files() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| job(&home.path().join(name));
    let (results, kept) = run(&at("keeps"), false, u32::MAX);
    let (forgotten, run_of_parts) = run(&at("forgets"), true, u32::MAX);
    assert!(run_of_parts.was_part && !kept.was_part);
    assert_eq!(forgotten, results);
    let whole = files(&at("keeps").out);
    for name in [
        "series.csv",
        "flow.csv",
        "velocity.csv",
        "events.csv",
        "summary.json",
        "checkpoint-profiles.bin",
        "checkpoint-frames.bin",
        "grains.pvd",
    ] {
        assert!(
            whole.contains_key(name),
            "{name} is among {:?}",
            whole.keys()
        );
    }
    for (name, bytes) in &whole {
        assert!(files(&at("forgets").out)[name] == *bytes, "{name}");
    }
    // Stopped, gone on with by one that forgets, and by one that does not.
    run(&at("stopped"), true, 60);
    let (results_after, _) = run(&at("stopped"), true, 60);
    assert_ne!(results_after, results, "it is stopped again");
    let (went_on, _) = run(&at("stopped"), false, u32::MAX);
    assert_eq!(went_on, results);
    assert!(files(&at("stopped").out) == whole);
    // What is shown at the end is all of it.
    let [kept, forgot] = [&kept.run, &run_of_parts.run].map(|run| run.run().unwrap());
    let bits = |run: &Run| postcard::to_stdvec(&(run.series(), &**run.flow())).unwrap();
    assert!(bits(forgot) == bits(kept));
    assert_eq!(kept.series().taken(), kept.series().len());
}

/// What a run keeps does not grow with its length.
#[test]
fn run_that_forgets_keeps_as_many_samples_however_long_it_is() {
    let home = tempfile::tempdir().unwrap();
    for (duration, samples) in [("100ms", 100), ("400ms", 400)] {
        let mut job = job(&home.path().join(duration));
        job.script.clear();
        let values = [
            ("duration", duration),
            ("sample-interval", "1ms"),
            ("output-interval", "10ms"),
        ];
        job.scene.set_all(&values).unwrap();
        let (results, run) = run(&job, true, u32::MAX);
        assert!(results.samples > samples / 2);
        assert!(run.run.run().unwrap().series().len() > samples);
        // As many as between two outputs.
        assert!(run.most <= 12, "{} samples at once", run.most);
    }
}
