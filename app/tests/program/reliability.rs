//! Claims about what is lost when something goes wrong: nothing. Kills, pipes, full disks, two
//! programs in one folder, wrong input, forged records.

use crate::headless::{Place, names, small_drum, summary, text};
#[cfg(unix)]
use crate::headless::{exit_code, wait_for, wait_until};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// Every file below `folder` with its bytes, but for the one that is locked.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            let inner = contents(&path).into_iter();
            found.extend(inner.map(|(inside, bytes)| (format!("{name}/{inside}"), bytes)));
        } else if name != ".grainfall.lock" {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

fn refused(place: &Place, arguments: &[&str], expected: &str) {
    let output = place.run(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.contains(expected), "{arguments:?}: {message}");
}

const RUN: [&str; 6] = small_drum("200ms", "out");

#[test]
fn refused_run_leaves_earlier_results_as_they_were() {
    let place = Place::new();
    place.run_small_drum("out", &[]);
    place.write(
        "late.ron",
        "[(time: 0.1, command: Set(parameter: \"drum-speed\", value: 999.0))]",
    );
    let before = contents(&place.path("out"));
    for (more, expected) in [
        (&["--set", "friction.glass.glass=9"][..], "expected 0 … 1"),
        (&["--commands", "late.ron"], "drum-speed"),
        (&["--set", "drum-speed=20rpm"], "`drum-speed` cannot be"),
        (&["--set", "drum-speed=9rpm"], "another run"),
        (&["--duration", "100ms"], "beyond"),
    ] {
        refused(&place, &[&RUN[..], more].concat(), expected);
        assert!(contents(&place.path("out")) == before, "{more:?}");
    }
    let absurd = [&RUN[..], &["--restart", "--commands", "late.ron"]].concat();
    refused(&place, &absurd, "drum-speed");
    assert!(contents(&place.path("out")) == before);
}

#[test]
fn finished_run_says_so_and_a_longer_one_goes_on_from_it() {
    let place = Place::new();
    place.run_small_drum("out", &[]);
    let before = contents(&place.path("out"));
    let again = place.run(&RUN);
    assert!(again.status.success());
    assert!(text(&again.stderr).contains("done already"));
    assert!(text(&again.stdout).contains("done: 100 grains"));
    assert!(contents(&place.path("out")) == before);
    let longer = ["--duration", "300ms"];
    let went_on = place.run(&[&RUN[..], &longer].concat());
    assert!(text(&went_on.stderr).contains("going on from t = 0.2"));
    let whole = place.run_small_drum("whole", &longer);
    let parts = summary(&place.path("out"));
    for key in ["state_hash", "results", "files"] {
        assert_eq!(parts[key], whole[key], "{key}");
    }
}

#[test]
fn nothing_of_an_earlier_run_survives_into_a_later_one() {
    let place = Place::new();
    place.run_small_drum("out", &["--duration", "1s"]);
    let out = place.path("out");
    assert!(out.join("flow.csv").is_file());
    place.write("out/notes.txt", "mine");
    place.write("out/.grainfall-a1b2c3", "never whole");
    let grain = ["bouncing-grain", "--no-render", "--out", "out"];
    refused(&place, &grain, "another scene");
    let output = place.run(&[&grain[..], &["--restart", "--duration", "50ms"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(
        names(&out),
        [
            ".grainfall.lock",
            "checkpoint-frames.bin",
            "checkpoint-samples.bin",
            "checkpoint.bin",
            "contacts",
            "contacts.pvd",
            "container.vtp",
            "csv-metadata.json",
            "grains",
            "grains.pvd",
            "notes.txt",
            "series.csv",
            "summary.json"
        ]
    );
    let metadata = fs::read_to_string(out.join("csv-metadata.json")).unwrap();
    let metadata: Value = serde_json::from_str(&metadata).unwrap();
    let tables = metadata["tables"].as_array().unwrap();
    let tables: Vec<&Value> = tables.iter().map(|table| &table["url"]).collect();
    assert_eq!(tables, ["series.csv"]);
}

#[test]
fn damaged_or_foreign_checkpoint_is_refused_with_its_reason() {
    let place = Place::new();
    place.run_small_drum("out", &[]);
    let longer = [&RUN[..], &["--duration", "300ms"]].concat();
    for (file, expected) in [
        ("checkpoint.bin", "its checksum does not fit"),
        ("checkpoint-samples.bin", "does not fit"),
        ("checkpoint-frames.bin", "does not fit"),
    ] {
        let path = place.path("out").join(file);
        let whole = fs::read(&path).unwrap();
        let mut damaged = whole.clone();
        damaged[whole.len() / 2] ^= 1;
        fs::write(&path, &damaged).unwrap();
        refused(&place, &longer, expected);
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        refused(&place, &longer, "cannot be used");
        fs::write(&path, &whole).unwrap();
    }
    let path = place.path("out/checkpoint.bin");
    let whole = fs::read(&path).unwrap();
    let version = concat!(" ", env!("CARGO_PKG_VERSION"), " ").as_bytes();
    let at = whole
        .windows(version.len())
        .position(|part| part == version)
        .unwrap();
    let other = [&whole[..at], b" 0.0.9 ", &whole[at + version.len()..]].concat();
    fs::write(&path, other).unwrap();
    refused(&place, &longer, "computed by Grainfall 0.0.9");
    fs::remove_file(&path).unwrap();
    refused(&place, &longer, "no checkpoint");
    let anew = place.run(&[&longer[..], &["--restart"]].concat());
    assert!(anew.status.success(), "{}", text(&anew.stderr));
}

/// Each forgery with a fingerprint that fits.
#[test]
fn verify_compares_all_that_is_stated() {
    let place = Place::new();
    let whole = place.run_small_drum("out", &[]);
    assert!(place.run(&["verify", "out/summary.json"]).status.success());
    let forged = |key: &str, value: Value| {
        let mut record = whole.clone();
        record[key] = value;
        record["fingerprint"] = grainfall::run::fingerprint(&record).into();
        place.write("out/forged.json", &record.to_string());
        let output = place.run(&["verify", "out/forged.json"]);
        (output.status.code(), text(&output.stderr))
    };
    let mut results = whole["results"].clone();
    results["entries"][0]["value"] = json!(0.5);
    let mut files = whole["files"].clone();
    files["series.csv"] = json!("0".repeat(64));
    for (key, value, expected) in [
        ("results", results, "results.entries."),
        ("time", json!(3.0), "time: 3.0 s is stated"),
        ("status", json!("interrupted"), "status: interrupted"),
        ("status", json!("fault"), "status: a fault is stated"),
        ("grains", json!(99), "grains: 99"),
        ("files", files, "series.csv was changed"),
        ("files", json!({ "../x": "0" }), "no name of a run's file"),
    ] {
        let (code, message) = forged(key, value);
        assert_eq!(code, Some(4), "{key}: {message}");
        assert!(message.contains(expected), "{key}: {message}");
    }
    let (code, message) = forged("state_hash", json!("0".repeat(32)));
    assert_eq!(code, Some(4), "{message}");
    assert!(message.contains("which is this one"), "{message}");
    let mut older = whole.clone();
    older["version"] = json!("0.0.9");
    older["state_hash"] = json!("0".repeat(32));
    let (code, message) = forged("version", json!("0.0.9"));
    assert_eq!(code, Some(0), "the same bits of another version: {message}");
    older["fingerprint"] = grainfall::run::fingerprint(&older).into();
    place.write("out/older.json", &older.to_string());
    let output = place.run(&["verify", "out/older.json"]);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(
        message.contains("written by version 0.0.9, and this is 0."),
        "{message}"
    );
    // Any edit without a fingerprint that fits.
    for key in ["name", "version", "time", "status", "grains", "results"] {
        let mut record = whole.clone();
        record[key] = json!("other");
        place.write("out/edited.json", &record.to_string());
        refused(&place, &["verify", "out/edited.json"], "out/edited.json");
    }
}

#[test]
fn record_vouches_for_every_file_and_verify_looks_at_them() {
    let place = Place::new();
    let whole = place.run_small_drum("out", &[]);
    let out = place.path("out");
    let mut vouched: Vec<&String> = whole["files"].as_object().unwrap().keys().collect();
    vouched.sort();
    let own = [
        "summary.json",
        "checkpoint.bin",
        "checkpoint-samples.bin",
        "checkpoint-frames.bin",
    ];
    let there = contents(&out);
    let there: Vec<&String> = there
        .keys()
        .filter(|name| !own.contains(&name.as_str()))
        .collect();
    assert_eq!(vouched, there);
    let path = out.join("grains/grains_000002.vtp");
    let mut bytes = fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() = b' ';
    fs::write(&path, bytes).unwrap();
    let output = place.run(&["verify", "out/summary.json"]);
    assert_eq!(output.status.code(), Some(4));
    assert!(text(&output.stderr).contains("grains_000002.vtp was changed"));
    fs::remove_file(&path).unwrap();
    let output = place.run(&["verify", "out/summary.json"]);
    assert_eq!(output.status.code(), Some(0), "it may lie elsewhere");
    assert!(text(&output.stderr).contains("not beside it"));
}

#[cfg(unix)]
fn start(place: &Place, arguments: &[&str]) -> Child {
    let mut command = place.command(arguments);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

#[cfg(unix)]
fn signal(name: &str, child: &Child) {
    let status = std::process::Command::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(status.unwrap().success());
}

/// Asserts that what a killed run left can be read.
#[cfg(unix)]
fn assert_whole(out: &Path) {
    let list = out.join("grains.pvd");
    if let Ok(list) = fs::read_to_string(list) {
        assert!(list.ends_with("  </Collection>\n</VTKFile>\n"), "{list}");
        for part in list.split("file=\"").skip(1) {
            let name = part.split('"').next().unwrap();
            let bytes = fs::read(out.join(name)).unwrap();
            assert!(bytes.ends_with(b"</VTKFile>\n"), "{name}");
        }
    }
    if let Ok(series) = fs::read_to_string(out.join("series.csv")) {
        assert!(series.ends_with('\n'));
        let mut reader = csv::Reader::from_reader(series.as_bytes());
        assert!(reader.records().all(|row| row.is_ok()));
    }
}

/// How many times a run is killed. `GRAINFALL_KILLS` asks for more.
#[cfg(unix)]
fn kills() -> u32 {
    let asked = std::env::var("GRAINFALL_KILLS").ok();
    asked.map_or(4, |asked| asked.parse().unwrap())
}

/// Kills what `command` starts [`kills`] times, each time later, and then lets it end; it writes to
/// the folder `out`, which `look` is shown after each kill.
#[cfg(unix)]
fn kill_and_go_on(place: &Place, command: &[&str], look: fn(&Path)) {
    let out = place.path("out");
    let mut lived = Duration::from_millis(40);
    let (mut kills_left, mut ended) = (kills(), 0);
    while kills_left > 0 {
        let mut child = start(place, command);
        std::thread::sleep(lived);
        if child.try_wait().unwrap().is_some() {
            ended += 1;
            fs::remove_dir_all(&out).unwrap();
            lived = Duration::from_millis(40);
            continue;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        if out.is_dir() {
            look(&out);
        }
        kills_left -= 1;
        lived = lived * 4 / 3;
    }
    let output = place.run(command);
    assert!(output.status.success(), "{}", text(&output.stderr));
    println!("{} kills, {ended} ends between them", kills());
}

#[cfg(unix)]
#[test]
fn killed_sweep_goes_on_to_the_same_table() {
    let place = Place::new();
    let sweep = |out| {
        let scene = ["sweep", "small-drum", "--duration", "600ms"];
        let varied = ["--vary", "seed=1,2", "--jobs", "1", "--out", out];
        [&scene[..], &varied].concat()
    };
    assert!(place.run(&sweep("whole")).status.success());
    kill_and_go_on(&place, &sweep("out"), |_| {});
    for table in ["table.csv", "ensembles.csv"] {
        let [whole, killed] =
            ["whole", "out"].map(|out| fs::read(place.path(out).join(table)).unwrap());
        assert!(whole == killed, "{table}");
    }
}

#[cfg(unix)]
#[test]
fn killed_run_goes_on_to_the_same_bits() {
    let place = Place::new();
    let longer = ["--duration", "2s", "--output-interval", "20ms"];
    place.run_small_drum("whole", &longer);
    kill_and_go_on(&place, &[&RUN[..], &longer].concat(), assert_whole);
    let [whole, parts] = ["whole", "out"].map(|out| summary(&place.path(out)));
    for key in ["state_hash", "results", "files"] {
        assert_eq!(parts[key], whole[key], "{key}");
    }
    let left = names(&place.path("out"));
    assert!(
        !left.iter().any(|name| name.starts_with(".grainfall-")),
        "{left:?}"
    );
}

#[cfg(unix)]
#[test]
fn folder_is_one_programs_at_a_time_and_says_whose() {
    let place = Place::new();
    let mut child = place.start_long_run("grains/grains_000001.vtp");
    for more in [&[][..], &["--restart"]] {
        let second = place.run(&[&small_drum("1h", "out")[..], more].concat());
        let message = text(&second.stderr);
        assert_eq!(second.status.code(), Some(5), "{message}");
        assert!(
            message.contains(&format!("process {}", child.id())),
            "{message}"
        );
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // Files of the run that was killed are there, so the next one's name in the lock is waited for.
    let mut child = place.start_long_run(".grainfall.lock");
    let process = child.id().to_string();
    wait_until(&mut child, "its name in the lock", || {
        let holder = fs::read_to_string(place.path("out/.grainfall.lock")).unwrap();
        holder.split_whitespace().nth(1) == Some(process.as_str())
    });
    signal("-TERM", &child);
    assert_eq!(exit_code(&mut child), Some(130));
}

#[cfg(unix)]
#[test]
fn closed_pipes_change_nothing() {
    let place = Place::new();
    let mut whole = place.command(&RUN);
    whole.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = whole.spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(summary(&place.path("out"))["status"], "done");
    let sweep = [
        "sweep",
        "small-drum",
        "--vary",
        "seed=1,2",
        "--duration",
        "100ms",
        "--out",
        "swept",
    ];
    let mut command = place.command(&sweep);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(place.path("swept/table.csv").is_file());
}

#[cfg(unix)]
#[test]
fn signals_that_are_ignored_stay_ignored() {
    let place = Place::new();
    let program = env!("CARGO_BIN_EXE_grainfall");
    let script =
        format!("trap '' INT HUP; exec {program} small-drum --no-render --duration 1h --out out");
    let mut shell = place.shell(&script);
    let mut child = shell
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(&place.path("out/grains/grains_000001.vtp"), &mut child);
    signal("-INT", &child);
    signal("-HUP", &child);
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it goes on");
    signal("-TERM", &child);
    assert_eq!(exit_code(&mut child), Some(130));
}

/// Long slices: stiff grains, weak gravity.
#[cfg(unix)]
#[test]
fn settling_hears_that_it_is_to_stop() {
    let place = Place::new();
    place.write(
        "slow.ron",
        r#"(
            title: "Slow to settle",
            materials: {"steel": (youngs_modulus: 200e9, density: 8000)},
            container: Drum(radius_mm: 60, width_mm: 40, speed_rpm: 1, material: "steel"),
            grains: Fill(count: 1500, species: [(radius_mm: 2, material: "steel")]),
            gravity: (0, -0.01, 0),
        )"#,
    );
    let arguments = ["slow.ron", "--no-render", "--threads", "1", "--out", "out"];
    let mut child = start(&place, &arguments);
    wait_for(&place.path("out/summary.json"), &mut child);
    std::thread::sleep(Duration::from_millis(700));
    let asked = Instant::now();
    signal("-INT", &child);
    assert_eq!(exit_code(&mut child), Some(130));
    let answered = asked.elapsed();
    println!("{answered:?}");
    assert!(answered < Duration::from_secs(2), "{answered:?}");
}

/// Where no file may be larger than so many blocks, as a full disk has it.
#[cfg(unix)]
#[test]
fn full_disk_is_told_and_loses_nothing() {
    let place = Place::new();
    let longer = ["--duration", "2s"];
    place.run_small_drum("whole", &longer);
    let program = env!("CARGO_BIN_EXE_grainfall");
    let command = [&RUN[..], &longer].concat().join(" ");
    let script = format!("trap '' XFSZ; ulimit -f 24; exec {program} {command}");
    let output = place.shell(&script).output().unwrap();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write out/"), "{message}");
    assert!(message.contains("because: "), "{message}");
    assert!(message.contains("the same command goes on"), "{message}");
    assert_whole(&place.path("out"));
    let (_, rows) = crate::headless::series(&place.path("out"));
    assert!(!rows.is_empty());
    let output = place.run(&[&RUN[..], &longer].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let [whole, parts] = ["whole", "out"].map(|out| summary(&place.path(out)));
    assert_eq!(parts["files"], whole["files"]);
}

#[test]
fn titles_break_neither_files_nor_terminals() {
    let place = Place::new();
    let scene = include_str!("../../../scenes/gallery/bouncing-grain.ron");
    let title = r#"title: "Drum --- wet -->\u{1b}[31m\u{0}","#;
    let begin = scene.find("title:").unwrap();
    let end = begin + scene[begin..].find('\n').unwrap();
    let hostile = format!("{}{title}{}", &scene[..begin], &scene[end..]);
    place.write("hostile.ron", &hostile);
    let run = [
        "hostile.ron",
        "--no-render",
        "--duration",
        "50ms",
        "--out",
        "out",
    ];
    let output = place.run(&run);
    assert!(output.status.success(), "{}", text(&output.stderr));
    for file in ["grains.pvd", "grains/grains_000000.vtp"] {
        let content = text(&fs::read(place.path("out").join(file)).unwrap());
        let begin = content.find("<!--").unwrap();
        let comment = &content[begin + 4..begin + content[begin..].find("-->").unwrap()];
        assert!(comment.contains("seed"), "the comment is whole: {comment}");
        assert!(
            !comment.contains("--") && !comment.contains('\u{1b}'),
            "{comment:?}"
        );
    }
    place.write("\u{1b}[2Jodd.ron", "(title: 3)");
    let output = place.run(&["\u{1b}[2Jodd.ron", "--no-render"]);
    let said = text(&output.stderr);
    assert!(
        said.contains("odd.ron") && !said.contains('\u{1b}'),
        "{said:?}"
    );
}

#[test]
fn more_threads_than_cores_are_told_once_and_quiet_and_json_say_what_they_promise() {
    let place = Place::new();
    let many = 1 + grainfall::run::available_threads();
    let output = place.run(&[&RUN[..], &["--threads", &many.to_string()]].concat());
    let told = text(&output.stderr);
    let note = format!("{many} threads share");
    assert_eq!(told.matches(&note).count(), 1, "{told}");
    let quiet = place.run(&[&RUN[..], &["--restart", "--quiet"]].concat());
    assert!(quiet.status.success());
    assert_eq!(
        (text(&quiet.stdout), text(&quiet.stderr)),
        Default::default()
    );
    let json = place.run(&[&RUN[..], &["--json"]].concat());
    let printed: Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(printed, summary(&place.path("out")));
}

#[cfg(unix)]
#[test]
fn two_sweeps_on_one_folder_share_the_cases() {
    let place = Place::new();
    let sweep = |out| {
        let varied = ["sweep", "small-drum", "--vary", "seed=1..6", "--jobs", "1"];
        [&varied[..], &["--duration", "300ms", "--out", out]].concat()
    };
    let alone = place.run(&sweep("alone"));
    assert!(alone.status.success(), "{}", text(&alone.stderr));
    let mut first = start(&place, &sweep("shared"));
    let second = place.run(&sweep("shared"));
    assert!(second.status.success(), "{}", text(&second.stderr));
    assert_eq!(first.wait().unwrap().code(), Some(0));
    let table = |out: &str| fs::read_to_string(place.path(out).join("table.csv")).unwrap();
    assert_eq!(table("shared"), table("alone"));
    let record = fs::read_to_string(place.path("shared/sweep.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["cases"].as_array().unwrap().len(), 6);
    assert_eq!(record["files"]["table.csv"].as_str().unwrap().len(), 64);
}
