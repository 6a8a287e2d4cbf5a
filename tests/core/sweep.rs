//! Sweeps: cases, results side by side, stopping and going on, wrong input.

use crate::runs::until_done;
use grainfall::output::Ending;
use grainfall::run::BedStore;
use grainfall::runner::RunnerError;
use grainfall::scene::Scene;
use grainfall::sweep::{self, Sweep, SweepEnding, Variation};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const DRUM: &str = r#"(
    title: "Small wet drum",
    materials: {"glass": (friction: 0.4, wet_friction: 0.1), "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35)},
    container: Drum(radius_mm: 24, width_mm: 16, speed_rpm: 10, material: "drum"),
    grains: Fill(count: 30, species: [(radius_mm: 3, material: "glass")]),
    liquid: (case: 2, volume_ml: 0.3),
    duration: 0.3,
    output_interval: 0.1,
)"#;

fn sweep(out: &Path, variations: &[&str]) -> Sweep {
    Sweep {
        name: "drum".into(),
        scene: Scene::parse("drum", DRUM).unwrap(),
        settings: vec!["drum-speed=5rpm".into()],
        variations: variations
            .iter()
            .map(|v| Variation::parse(v).unwrap())
            .collect(),
        out: out.to_owned(),
        jobs: 2,
        beds: BedStore::none(),
        restart: false,
    }
}

fn run(sweep: &Sweep, stop: &AtomicBool) -> Result<SweepEnding, RunnerError> {
    sweep::run(sweep, stop, &mut ()).map(|swept| swept.ending)
}

fn hashes(out: &Path) -> Vec<String> {
    let table = fs::read_to_string(out.join("table.csv")).unwrap();
    let rows = table.lines().skip(1);
    rows.map(|row| row.rsplit(',').next().unwrap().to_owned())
        .collect()
}

#[test]
fn sweep_sets_every_combination_beside_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let sweep = sweep(&out, &["liquid=0,7", "radius=3mm,2.5mm"]);
    let ending = run(&sweep, &AtomicBool::new(false)).unwrap();
    assert_eq!((ending, ending.exit_code()), (SweepEnding::Done, 0));
    let table = fs::read_to_string(out.join("table.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    let begin = "liquid,radius [m],surface angle [rad],";
    assert!(rows[0].starts_with(begin), "{}", rows[0]);
    let starts = ["dry,0.003,", "dry,0.0025,", "7,0.003,", "7,0.0025,"];
    assert_eq!(rows.len(), 5);
    for (row, start) in rows[1..].iter().zip(starts) {
        assert!(row.starts_with(start) && row.contains(",done,"), "{row}");
    }
    let markdown = fs::read_to_string(out.join("table.md")).unwrap();
    assert_eq!(markdown.lines().count(), 6);
    for file in ["summary.json", "series.csv"] {
        assert!(
            out.join("liquid=7_radius=3mm").join(file).is_file(),
            "{file}"
        );
    }
    for plot in [
        "surface-angle.svg",
        "packing-fraction.svg",
        "courses/liquid=7_radius=3mm-angle.svg",
    ] {
        let text = fs::read_to_string(out.join("plots").join(plot)).unwrap();
        assert!(
            text.starts_with("<svg") && text.trim_end().ends_with("</svg>"),
            "{plot}"
        );
        assert!(text.contains("<desc>Grainfall 0."), "{plot}");
    }
    let summary = fs::read_to_string(out.join("liquid=7_radius=3mm/summary.json")).unwrap();
    assert!(
        summary.contains("drum-speed"),
        "settings hold in every case"
    );
}

#[test]
fn stopped_sweep_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let variations = ["viscosity=0.01,0.5"];
    run(&sweep(&whole, &variations), &AtomicBool::new(false)).unwrap();
    let ending = until_done(&SweepEnding::Interrupted, |stop| {
        run(&sweep(&parts, &variations), stop).unwrap()
    });
    assert_eq!(ending, SweepEnding::Done);
    assert_eq!(hashes(&parts), hashes(&whole));
    // A finished one is only read.
    run(&sweep(&parts, &variations), &AtomicBool::new(false)).unwrap();
    assert_eq!(hashes(&parts), hashes(&whole));
}

#[test]
fn longer_sweep_goes_on_from_a_shorter_one_and_another_scene_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let mut shorter = sweep(&out, &["viscosity=0.1"]);
    shorter.scene.duration = 0.1;
    run(&shorter, &AtomicBool::new(false)).unwrap();
    let first = hashes(&out);
    let longer = sweep(&out, &["viscosity=0.1"]);
    run(&longer, &AtomicBool::new(false)).unwrap();
    let second = hashes(&out);
    assert_ne!(first, second);
    let fresh = folder.path().join("fresh");
    run(&sweep(&fresh, &["viscosity=0.1"]), &AtomicBool::new(false)).unwrap();
    assert_eq!(hashes(&fresh), second);
    let mut other = sweep(&out, &["viscosity=0.1"]);
    other.settings = vec!["drum-speed=7rpm".into()];
    let refused = run(&other, &AtomicBool::new(false)).unwrap_err();
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.to_string().contains("other values"), "{refused}");
    assert_eq!(hashes(&out), second, "what is there stays");
    other.restart = true;
    run(&other, &AtomicBool::new(false)).unwrap();
    assert_ne!(
        hashes(&out),
        second,
        "its checkpoint is not taken for another's"
    );
}

#[test]
fn sweep_leaves_a_folder_of_others_alone_and_takes_its_own_up_however_it_was_left() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("table.csv"), "my own").unwrap();
    let sweep = sweep(&out, &["viscosity=0.1"]);
    let refused = run(&sweep, &AtomicBool::new(false)).unwrap_err();
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.to_string().contains("not a sweep's"), "{refused}");
    assert_eq!(fs::read(out.join("table.csv")).unwrap(), b"my own");
    assert_eq!(fs::read_dir(&out).unwrap().count(), 1);
    // Killed before its first file was whole.
    fs::remove_file(out.join("table.csv")).unwrap();
    fs::write(out.join(".grainfall-a1b2c3"), "").unwrap();
    run(&sweep, &AtomicBool::new(false)).unwrap();
    // So is a case.
    let case = out.join("viscosity=0.2");
    fs::create_dir(&case).unwrap();
    fs::write(case.join(".grainfall-a1b2c3"), "").unwrap();
    run(
        &self::sweep(&out, &["viscosity=0.2"]),
        &AtomicBool::new(false),
    )
    .unwrap();
    assert!(!case.join(".grainfall-a1b2c3").exists());
}

#[test]
fn live_value_that_cannot_be_is_found_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let sweep = sweep(&out, &["viscosity=0.1,0.2,1e9"]);
    let error = run(&sweep, &AtomicBool::new(false)).unwrap_err();
    assert!(error.to_string().contains("viscosity=1e9"), "{error}");
    assert!(!out.exists());
}

#[test]
fn numbers_of_cases_are_counted_without_wrapping() {
    let all = "seed=-9223372036854775808..9223372036854775807";
    let message = Variation::parse(all).unwrap_err().to_string();
    assert!(
        message.contains("at most 10000 values, not 18446744073709551616"),
        "{message}"
    );
    let folder = tempfile::tempdir().unwrap();
    // 2⁶⁴ combinations.
    let many = sweep(&folder.path().join("many"), &["seed=0..255"; 8]);
    let message = run(&many, &AtomicBool::new(false)).unwrap_err().to_string();
    assert!(
        message.contains("18446744073709551616 cases; expected at most 10000"),
        "{message}"
    );
    let twice = sweep(&folder.path().join("twice"), &["seed=1,1"]);
    let message = run(&twice, &AtomicBool::new(false))
        .unwrap_err()
        .to_string();
    assert!(message.contains("two cases are called seed=1"), "{message}");
}

#[test]
fn a_key_that_is_given_twice_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let message = |settings: &[&str], variations: &[&str]| {
        let mut sweep = sweep(&folder.path().join("none"), variations);
        sweep.settings = settings.iter().map(|&own| own.to_owned()).collect();
        run(&sweep, &AtomicBool::new(false))
            .unwrap_err()
            .to_string()
    };
    let undone = message(&["seed=5"], &["seed=1..3"]);
    assert!(
        undone.contains("--set seed=5 undoes the variation of seed"),
        "{undone}"
    );
    let twice = message(&[], &["seed=1,2", "seed=3,4"]);
    assert!(twice.contains("seed is varied twice"), "{twice}");
}

#[test]
fn seeds_repeat_an_experiment_and_the_tables_hold_their_means() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sweep");
    let mut sweep = sweep(&out, &["liquid=0,7"]);
    sweep.variations.push(Variation::of_seeds(3, 3));
    let swept = sweep::run(&sweep, &AtomicBool::new(false), &mut ()).unwrap();
    assert_eq!(swept.ending, SweepEnding::Done);
    assert!(
        swept.table.starts_with("| liquid | seeds | θ [°] |"),
        "{}",
        swept.table
    );
    let read = |name: &str| {
        let mut reader = csv::Reader::from_path(out.join(name)).unwrap();
        let heads = reader.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        (heads, rows)
    };
    let (heads, cases) = read("table.csv");
    let column = |heads: &csv::StringRecord, head: &str| {
        let place = heads.iter().position(|own| own == head);
        place.unwrap_or_else(|| panic!("no {head} in {heads:?}"))
    };
    let number = |row: &csv::StringRecord, at: usize| row[at].parse::<f64>().unwrap();
    let at = column(&heads, "packing fraction [1]");
    assert_eq!(cases.len(), 6);
    assert_eq!(&cases[2][column(&heads, "seed [1]")], "5");
    // 0.3 s with samples every 20 ms: too few for an error of one run.
    assert_eq!(&cases[0][column(&heads, "packing fraction error [1]")], "");
    let (heads, ensembles) = read("ensembles.csv");
    assert_eq!(ensembles.len(), 2);
    for (ensemble, cases) in ensembles.iter().zip(cases.chunks(3)) {
        let values: Vec<f64> = cases.iter().map(|case| number(case, at)).collect();
        let mean = values.iter().sum::<f64>() / 3.0;
        let squares: f64 = values
            .iter()
            .map(|value| (value - mean) * (value - mean))
            .sum();
        let heads_of_both = ["packing fraction [1]", "packing fraction error [1]"];
        let [own, error] = heads_of_both.map(|head| number(ensemble, column(&heads, head)));
        assert!((own - mean).abs() < 1e-12, "{own} {mean}");
        assert!(
            (error - (squares / 6.0).sqrt()).abs() < 1e-12,
            "{error} {squares}"
        );
        assert_eq!(
            &ensemble[column(&heads, "packing fraction samples [1]")],
            "3"
        );
        assert_eq!(&ensemble[column(&heads, "seeds [1]")], "3");
    }
    let statements = fs::read_to_string(out.join("statements.md")).unwrap();
    assert!(
        statements.contains("| Wet beds are denser than dry ones |"),
        "{statements}"
    );
    let metadata = fs::read_to_string(out.join("csv-metadata.json")).unwrap();
    assert!(metadata.contains("table.csv") && metadata.contains("ensembles.csv"));
    let plot = fs::read_to_string(out.join("plots/packing-fraction.svg")).unwrap();
    assert!(plot.contains("<svg"));
}

#[test]
fn wrong_variations_say_what_was_expected() {
    for text in [
        "liquid",
        "liquid=",
        "=3",
        "liquid=7..0",
        "radius=3mm,,2mm",
        "liquid=0..99999999",
    ] {
        let message = Variation::parse(text).unwrap_err().to_string();
        assert!(
            message.contains(&format!("--vary {text}: expected KEY=VALUES")),
            "{message}"
        );
    }
    let folder = tempfile::tempdir().unwrap();
    for (variation, expected) in [
        ("liquid=0..9", "1 (water) to 7 (glycerol)"),
        ("liqud=1", "no parameter is called `liqud`"),
        ("viscosity=1e9", "`viscosity` cannot be"),
    ] {
        let out = folder.path().join("none");
        let error = run(&sweep(&out, &[variation]), &AtomicBool::new(false)).unwrap_err();
        assert!(matches!(
            error,
            RunnerError::Scene(_) | RunnerError::Input(_)
        ));
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(expected), "{error}");
    }
}

#[test]
fn cases_run_one_by_one_and_merged_are_the_sweep_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let tied = |out: &Path| {
        let mut sweep = sweep(out, &["seed=1,2"]);
        let lists = Variation::parse_tied("viscosity=0.01,0.5; radius=3mm,2.5mm").unwrap();
        sweep.variations.splice(0..0, lists);
        sweep
    };
    let never = AtomicBool::new(false);
    // Four threads for each of the four, one for each of the parts.
    let shared = Sweep {
        jobs: 16,
        ..tied(&whole)
    };
    run(&shared, &never).unwrap();
    let parts = tied(&parts);
    assert_eq!(sweep::count(&parts).unwrap(), 4);
    let message = sweep::merge(&parts).unwrap_err().to_string();
    assert!(message.contains("holds no sweep"), "{message}");
    assert!(!parts.out.exists(), "nothing is begun");
    for number in [4, 2, 1] {
        let (name, ending) = sweep::run_case(&parts, number, &never, &mut ()).unwrap();
        assert_eq!(ending, Ending::Done, "{name}");
    }
    let partial = sweep::merge(&parts).unwrap();
    assert_eq!(partial.ending, SweepEnding::Interrupted);
    let missing = "3, viscosity=0.5_radius=2.5mm_seed=1: not begun";
    assert_eq!(partial.missing, [missing]);
    assert_eq!(hashes(&parts.out).len(), 3);
    assert!(!parts.out.join("viscosity=0.5_radius=2.5mm_seed=1").exists());
    sweep::run_case(&parts, 3, &never, &mut ()).unwrap();
    let merged = sweep::merge(&parts).unwrap();
    assert_eq!(
        (merged.ending, merged.missing.len()),
        (SweepEnding::Done, 0)
    );
    for table in ["table.csv", "table.md", "csv-metadata.json"] {
        let read = |out: &Path| fs::read_to_string(out.join(table)).unwrap();
        assert_eq!(read(&parts.out), read(&whole), "{table}");
    }
    for number in [0, 5] {
        let refused = sweep::run_case(&parts, number, &never, &mut ());
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("expected one of 1 to 4"), "{message}");
    }
}

#[test]
fn case_that_was_stopped_is_missing_and_other_values_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = sweep(&folder.path().join("sweep"), &["viscosity=0.1,0.2"]);
    let stopped = AtomicBool::new(true);
    let (_, ending) = sweep::run_case(&sweep, 1, &stopped, &mut ()).unwrap();
    assert_eq!(ending, Ending::Interrupted);
    let mut shorter = sweep.clone();
    shorter.scene.duration = 0.1;
    sweep::run_case(&shorter, 2, &AtomicBool::new(false), &mut ()).unwrap();
    let merged = sweep::merge(&sweep).unwrap();
    let [first, second] = &merged.missing[..] else {
        panic!("{:?}", merged.missing);
    };
    assert!(first.starts_with("1, viscosity=0.1: "), "{first}");
    let stopped = "2, viscosity=0.2: stopped at t = 0.1";
    assert!(second.starts_with(stopped), "{second}");
    let mut other = sweep;
    other.settings = vec!["drum-speed=7rpm".into()];
    for refused in [
        sweep::merge(&other).map(drop),
        sweep::run_case(&other, 2, &AtomicBool::new(false), &mut ()).map(drop),
    ] {
        let error = refused.unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("other values"), "{error}");
    }
}
