//! A file that keeps a paper's results: it counts as the folders do, and never for anything else.

use crate::runs::shared_beds;
use grainfall::paper::{self, Listed, PaperJob, Papered, Selection};
use grainfall::run::fingerprint;
use grainfall::sweep::SweepEnding;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use tempfile::TempDir;

/// A small paper with its folder and the file that keeps its results.
pub struct KeptPaper {
    paper: &'static str,
    home: TempDir,
}

impl KeptPaper {
    pub fn of(paper: &'static str) -> Self {
        let home = tempfile::tempdir().unwrap();
        Self { paper, home }
    }

    pub fn out(&self) -> PathBuf {
        self.home.path().join("out")
    }

    /// The file, in a folder that is not there yet.
    fn file(&self) -> PathBuf {
        self.home.path().join("results").join("kept.jsonl")
    }

    fn lines(&self) -> Vec<String> {
        let text = fs::read_to_string(self.file()).unwrap();
        text.lines().map(str::to_owned).collect()
    }

    fn write(&self, lines: &[String]) {
        fs::write(self.file(), lines.join("\n") + "\n").unwrap();
    }

    /// These parts of it; all where there are none.
    pub fn job(&self, parts: &[&str]) -> PaperJob {
        let selection = Selection {
            is_small: true,
            parts: parts.iter().map(|&part| part.to_owned()).collect(),
            ..Selection::default()
        };
        let paper = paper::paper(self.paper).unwrap();
        let job = PaperJob::new(paper, &selection, self.out(), 2).unwrap();
        job.with_beds(shared_beds()).with_kept(Some(self.file()))
    }

    /// That without the folder, in which all is done, the file makes the tables and files `there`
    /// again, to the byte, and nothing is computed.
    pub fn makes_again(&self, there: &Papered) {
        let (lines, expected) = (self.lines(), files(&self.out()));
        assert!(expected.len() > 8, "{:?}", expected.keys());
        assert!(lines.iter().all(|line| line.len() < 4000));
        fs::remove_dir_all(self.out()).unwrap();
        let job = self.job(&[]);
        let listed = paper::list(&job).unwrap();
        assert!(
            listed
                .iter()
                .all(|case| case.is_done() && case.to_string() == "kept")
        );
        let names: Vec<String> = lines.iter().map(|line| stated(line, "case")).collect();
        let mut sorted: Vec<&String> = listed.iter().map(|case| &case.name).collect();
        sorted.sort();
        assert!(sorted.iter().copied().eq(&names), "{names:?}");
        assert_eq!(job.estimate(2).unwrap().steps, 0.0);
        let again = run(&job);
        assert_eq!(again.ending, SweepEnding::Done);
        let texts = |papered: &Papered| -> Vec<String> {
            let tables = papered.tables.iter();
            tables.map(|table| table.text.clone()).collect()
        };
        assert_eq!(texts(&again), texts(there));
        assert_eq!(files(&self.out()), expected);
        assert!(names.iter().all(|name| !self.out().join(name).exists()));
        let lacking = again.lacking.unwrap();
        assert!(
            lacking.starts_with("plots/courses") && lacking.contains(&listed[0].name),
            "{lacking}"
        );
        assert_eq!(self.lines(), lines);
    }
}

pub fn run(job: &PaperJob) -> Papered {
    paper::run(job, &AtomicBool::new(false), &mut ()).unwrap()
}

/// Why neither running nor setting beside each other is done.
fn refusal(job: &PaperJob) -> String {
    let [run, beside] = [
        paper::run(job, &AtomicBool::new(false), &mut ()),
        paper::set_beside(job),
    ]
    .map(|done| done.err().expect("it is refused").to_string());
    assert_eq!(run, beside);
    run
}

/// `line` with other `values`, signed as if the program had written it.
fn rewritten(line: &str, values: &[(&str, Value)]) -> String {
    let mut value: Value = serde_json::from_str(line).unwrap();
    for (key, other) in values {
        value[key] = other.clone();
    }
    value["fingerprint"] = fingerprint(&value).into();
    value.to_string()
}

fn stated(line: &str, key: &str) -> String {
    let value: Value = serde_json::from_str(line).unwrap();
    value[key].as_str().unwrap().to_owned()
}

/// The files that stand in `folder` itself and, of the plots, those in which each case is a point.
fn files(folder: &Path) -> BTreeMap<PathBuf, String> {
    let of = |folder: PathBuf| {
        fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
    };
    let paths = of(folder.to_owned()).chain(of(folder.join("plots")));
    let is_compared = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        path.is_file() && name != "sweep.json" && !name.starts_with("velocity-profile")
    };
    let paths = paths.filter(is_compared);
    let read = paths.map(|path| (path.clone(), fs::read_to_string(path).unwrap()));
    read.collect()
}

/// The two cases of the smallest part, run.
fn two_cases() -> (KeptPaper, PaperJob) {
    let kept = KeptPaper::of("kasper2021");
    let job = kept.job(&["coded"]);
    assert_eq!(run(&job).ending, SweepEnding::Done);
    assert_eq!(kept.lines().len(), 2);
    (kept, job)
}

#[test]
fn only_lines_of_this_method_and_this_scene_count_and_others_stay() {
    let (kept, job) = two_cases();
    let aside = kept.home.path().join("aside");
    fs::rename(kept.out(), &aside).unwrap();
    let own = kept.lines();
    let others = [
        rewritten(&own[0], &[("method", "0123456789abcdef".into())]),
        rewritten(&own[1], &[("scene", "0".repeat(32).into())]),
    ];
    kept.write(&others);
    let rest = paper::set_beside(&job).unwrap();
    assert_eq!(rest.ending, SweepEnding::Interrupted);
    let named = |case: usize, reason: &str| {
        assert!(
            rest.missing[case].contains("not begun; "),
            "{:?}",
            rest.missing
        );
        assert!(rest.missing[case].contains(reason), "{:?}", rest.missing);
    };
    named(
        0,
        "kept.jsonl has it computed by another method, 0123456789abcdef",
    );
    named(
        1,
        "kept.jsonl has it computed with other values of its scene",
    );
    let listed = paper::list(&job).unwrap();
    assert!(listed.iter().all(|case| !case.is_done()));
    assert!(listed[0].to_string().contains("another method"));
    assert!(job.estimate(2).unwrap().steps > 0.0);
    // What a folder holds is put beside them, and they stay.
    fs::remove_dir_all(kept.out()).unwrap();
    fs::rename(&aside, kept.out()).unwrap();
    assert!(paper::set_beside(&job).unwrap().missing.is_empty());
    let both = kept.lines();
    assert_eq!(both.len(), 4);
    assert!(own.iter().chain(&others).all(|line| both.contains(line)));
    assert_ne!(stated(&own[0], "scene"), stated(&own[1], "scene"));
}

#[test]
fn what_two_papers_have_in_common_is_computed_and_kept_once() {
    let kept = KeptPaper::of("kasper2021");
    assert_eq!(run(&kept.job(&["r3"])).ending, SweepEnding::Done);
    let lines = kept.lines();
    assert_eq!(lines.len(), 6);
    fs::remove_dir_all(kept.out()).unwrap();
    let other = KeptPaper {
        paper: "kasper2021-readings",
        ..kept
    };
    let job = other.job(&["r3"]);
    let listed = paper::list(&job).unwrap();
    assert_eq!(listed.len(), 6);
    assert!(listed.iter().all(Listed::is_kept));
    assert!(listed.iter().all(|case| case.name.starts_with("reading=")));
    assert_eq!(run(&job).ending, SweepEnding::Done);
    assert_eq!(other.lines(), lines);
}

#[test]
fn a_damaged_line_is_refused_with_its_number_and_what_to_do() {
    let (kept, job) = two_cases();
    let own = kept.lines();
    let refused = |second: &str, reason: &str| {
        kept.write(&[own[0].clone(), second.to_owned()]);
        let message = refusal(&job);
        assert!(message.contains("kept.jsonl, line 2: "), "{message}");
        assert!(message.contains(reason), "{message}");
        assert!(message.contains("take it out"), "{message}");
        assert_eq!(paper::list(&job).err().unwrap().to_string(), message);
    };
    refused(&own[1][..own[1].len() - 1], "no JSON");
    refused("<<<<<<< HEAD", "no JSON");
    let edited = own[1].replacen("\"samples\":", "\"samples\":1", 1);
    refused(&edited, "edited or damaged");
    let unknown = rewritten(&own[1], &[("results", Value::Null)]);
    refused(&unknown, "invalid type");
    let running = rewritten(&own[1], &[("ended", "running".into())]);
    refused(&running, "did not end as `done`");
    let other = rewritten(&own[0], &[("state", "0".repeat(32).into())]);
    refused(&other, "another last state than line 1");
    // The same line twice, as when two versions were joined, is no harm.
    kept.write(&[own[0].clone(), own[0].clone(), own[1].clone()]);
    assert!(paper::set_beside(&job).unwrap().missing.is_empty());
}

#[test]
fn another_last_state_than_the_folders_is_refused_until_the_case_is_computed_anew() {
    let (kept, job) = two_cases();
    let own = kept.lines();
    let other = "0123456789abcdef".repeat(2);
    kept.write(&[
        rewritten(&own[0], &[("state", other.clone().into())]),
        own[1].clone(),
    ]);
    let message = refusal(&job);
    for part in [
        &other,
        &stated(&own[0], "state"),
        "line 1",
        "--restart --only",
    ] {
        assert!(message.contains(part), "{message}");
    }
    let ending = run(&kept.job(&["coded"]).restarting(true)).ending;
    assert_eq!(ending, SweepEnding::Done);
    assert_eq!(kept.lines(), own, "computed anew, to the same bits");
}
