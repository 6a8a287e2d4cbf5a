//! A paper in one command: its small setting, stopping and going on, tables of what is there.

use crate::kept_results::{KeptPaper, run};
use crate::runs::{shared_beds, until_done};
use grainfall::paper::{self, PAPERS, PaperJob, Papered, Selection};
use grainfall::sweep::SweepEnding;
use std::cell::Cell;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The small setting of the paper called `name`, of the parts named.
fn small(name: &str, parts: &[&str], folder: &Path) -> PaperJob {
    let selection = Selection {
        is_small: true,
        parts: parts.iter().map(|&part| part.to_owned()).collect(),
        ..Selection::default()
    };
    let paper = paper::paper(name).unwrap();
    let job = PaperJob::new(paper, &selection, folder.join("out"), 2).unwrap();
    job.with_beds(shared_beds())
}

fn text<'a>(papered: &'a Papered, name: &str) -> &'a str {
    let found = papered.tables.iter().find(|table| table.name == name);
    &found.unwrap_or_else(|| panic!("no table {name}")).text
}

#[test]
fn every_paper_made_small_ends_with_its_tables_and_figures_and_kept_results_make_them_again() {
    for paper in PAPERS {
        let kept = KeptPaper::of(paper.name);
        // What comes last is done first: the file goes by names all the same.
        run(&kept.job(&[paper.small_batches[1].part]));
        let papered = run(&kept.job(&[]));
        assert_eq!(papered.ending, SweepEnding::Done);
        assert!(papered.missing.is_empty(), "{:?}", papered.missing);
        assert_eq!(papered.lacking, None);
        let out = kept.out();
        let page = fs::read_to_string(out.join("tables.md")).unwrap();
        for table in &papered.tables {
            let heads = table.text.lines().next().unwrap().matches('|').count();
            let rows = table.text.lines().filter(|line| line.starts_with('|'));
            let is_whole = |line: &str| line.matches('|').count() == heads;
            assert!(rows.clone().count() > 2, "{}: {}", table.name, table.text);
            assert!(rows.clone().all(is_whole), "{}: {}", table.name, table.text);
            assert!(page.contains(&table.text), "{}", table.name);
        }
        for file in ["ensembles.csv", "table.csv", "statements.md"] {
            assert!(out.join(file).is_file(), "{}: {file}", paper.name);
        }
        assert!(fs::read_dir(out.join("plots")).unwrap().count() > 5);
        kept.makes_again(&papered);
    }
}

#[test]
fn rows_of_kaspers_tables_are_drums_and_means_have_errors_over_the_seeds() {
    let folder = tempfile::tempdir().unwrap();
    let there = run(&small("kasper2021", &["r3"], folder.path()));
    let of_angle = |line: &&str| line.starts_with("| θ [°]");
    let angle = text(&there, "dry").lines().find(of_angle).unwrap();
    assert!(angle.contains(" ± ") && !angle.contains('?'), "{angle}");
    let wet: Vec<&str> = text(&there, "wet").lines().skip(2).collect();
    assert!(wet[0].starts_with("| 3 | 0 | dry | 2 |"), "{}", wet[0]);
    assert!(wet[2].starts_with("| 3 | 7 | 1410 | 2 |"), "{}", wet[2]);
    assert_eq!(text(&there, "coded").lines().count(), 2, "heads alone");
}

#[test]
fn a_stopped_paper_goes_on_and_its_tables_name_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let job = small("kasper2021", &["coded"], folder.path());
    let nothing = paper::set_beside(&job).unwrap();
    assert_eq!(nothing.ending, SweepEnding::Interrupted);
    let first = "1, bridge-law=as-coded_radius=3mm_liquid=7_seed=1: not begun";
    assert_eq!(
        (nothing.missing.len(), nothing.missing[0].as_str()),
        (2, first)
    );
    let stops = Cell::new(0);
    let ending = until_done(&SweepEnding::Interrupted, |stop| {
        let papered = paper::run(&job, stop, &mut ()).unwrap();
        let is_done = papered.ending == SweepEnding::Done;
        stops.set(stops.get() + usize::from(!is_done));
        assert_eq!(papered.missing.is_empty(), is_done);
        papered.ending
    });
    assert!(stops.get() > 0);
    assert_eq!(ending, SweepEnding::Done);
    assert!(paper::set_beside(&job).unwrap().missing.is_empty());
    let listed = paper::list(&job).unwrap();
    assert!(
        listed
            .iter()
            .all(|case| case.is_done() && case.to_string() == "done")
    );
}

#[test]
fn results_of_another_method_are_never_mixed_in_silence() {
    let folder = tempfile::tempdir().unwrap();
    let job = small("kasper2021", &["coded"], folder.path());
    let papered = run(&job);
    assert!(papered.missing.is_empty());
    let runs = text(&papered, "runs").to_owned();
    let own = runs
        .trim_end()
        .rsplit(' ')
        .next()
        .unwrap()
        .trim_end_matches('.');
    assert_eq!(own.len(), 16, "{runs}");
    let case = paper::list(&job).unwrap()[0].name.clone();
    let path = folder.path().join("out").join(case).join("summary.json");
    let summary = fs::read_to_string(&path).unwrap();
    fs::write(&path, summary.replace(own, "0123456789abcdef")).unwrap();
    let refused = paper::run(&job, &AtomicBool::new(false), &mut ());
    let message = refused.err().unwrap().to_string();
    assert!(
        message.contains("by method 0123456789abcdef") && message.contains(own),
        "{message}"
    );
    assert!(message.contains("--restart"), "{message}");
    let rest = paper::set_beside(&job).unwrap();
    assert_eq!(rest.missing.len(), 1);
    assert!(
        rest.missing[0].contains("another method, 0123456789abcdef"),
        "{:?}",
        rest.missing
    );
    assert!(
        text(&rest, "runs").contains("| coded | 1 | 2 | 1 |"),
        "{}",
        text(&rest, "runs")
    );
}

#[test]
fn markers_of_the_validation_name_tables_that_its_papers_make() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/validation.md");
    let mut text = fs::read_to_string(path).unwrap();
    let before: Vec<String> = outside(&text);
    for paper in PAPERS {
        let folder = tempfile::tempdir().unwrap();
        let tables = paper::set_beside(&small(paper.name, &[], folder.path())).unwrap();
        // An unknown name is refused, and so is a document without a marker of the paper.
        text = paper::replace(&text, paper.name, &tables.tables).unwrap();
    }
    assert_eq!(
        outside(&text),
        before,
        "what stands around the tables is ours"
    );
    assert!(before.len() > PAPERS.len());
}

/// The lines of a document that stand outside its tables.
fn outside(text: &str) -> Vec<String> {
    let mut is_inside = false;
    let lines = text.lines().filter(|line| {
        is_inside = (is_inside || line.starts_with("<!-- table: ")) && *line != "<!-- end -->";
        !is_inside
    });
    lines.map(str::to_owned).collect()
}
