//! Claims about what a sweep leaves: `verify` confirms all of it, and finds what was changed.

use crate::headless::{Place, text};
use std::fs;
use std::path::Path;

/// Two short runs of a small drum, side by side.
fn swept(place: &Place) {
    let sweep = [
        "sweep",
        "small-drum",
        "--vary",
        "drum-speed=3rpm,6rpm",
        "--set",
        "count=40",
        "--duration",
        "100ms",
        "--out",
        "out",
        "--quiet",
    ];
    let output = place.run(&sweep);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn verify_confirms_every_case_of_a_sweep_with_its_tables_and_plots() {
    let place = Place::new();
    swept(&place);
    for named in ["out", "out/sweep.json"] {
        let output = place.run(&["verify", named, "--threads", "1"]);
        let said = text(&output.stdout);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(said.contains("the same: drum-speed=3rpm"), "{said}");
        assert!(said.contains("all 2 cases are the same"), "{said}");
    }
    let curves = fs::read_dir(place.path("out/plots/curves")).unwrap();
    assert!(curves.count() > 3, "each result over what was varied");
}

#[test]
fn verify_finds_a_table_that_was_changed_and_a_case_that_was_replaced() {
    let place = Place::new();
    swept(&place);
    let change = |name: &str, edit: &dyn Fn(String) -> String| {
        let path = place.path(name);
        let before = fs::read_to_string(&path).unwrap();
        fs::write(&path, edit(before.clone())).unwrap();
        let output = place.run(&["verify", "out", "--threads", "1"]);
        fs::write(&path, before).unwrap();
        (output.status.code(), text(&output.stderr))
    };
    let (code, said) = change("out/table.csv", &|own| own + "\n");
    assert_eq!(code, Some(4), "{said}");
    assert!(said.contains("table.csv was changed"), "{said}");
    let other = fs::read_to_string(place.path("out/drum-speed=6rpm/summary.json")).unwrap();
    let (code, said) = change("out/drum-speed=3rpm/summary.json", &|_| other.clone());
    assert_eq!(code, Some(4), "{said}");
    assert!(said.contains("the sweep's table was made of"), "{said}");
}

#[test]
fn verify_reads_no_case_outside_a_sweeps_folder() {
    let place = Place::new();
    let out = place.path("out");
    fs::create_dir(&out).unwrap();
    let record =
        |cases: &str| format!(r#"{{"program": "grainfall", "cases": [{cases}], "files": {{}}}}"#);
    let verify = |cases: &str| {
        fs::write(Path::new(&out).join("sweep.json"), record(cases)).unwrap();
        let output = place.run(&["verify", "out"]);
        (output.status.code(), text(&output.stderr))
    };
    let (code, said) = verify(r#"{"name": "../elsewhere", "state_hash": "0"}"#);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("a case without name or state"), "{said}");
    let (code, said) = verify("");
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("run the sweep to its end first"), "{said}");
}
