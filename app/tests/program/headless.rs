//! Claims about the headless binary: exit codes, messages, and files that are whole.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// A folder for one test; beds are kept beside the other tests' files, not in the user's cache.
pub(crate) struct Place(TempDir);

impl Place {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grainfall"));
        command
            .args(arguments)
            .current_dir(self.0.path())
            .env("HOME", self.0.path())
            .env("XDG_CACHE_HOME", env!("CARGO_TARGET_TMPDIR"));
        command
    }

    /// A shell that carries out `script`.
    #[cfg(unix)]
    pub(crate) fn shell(&self, script: &str) -> Command {
        let program = self.command(&["-c", script]);
        let mut shell = Command::new("sh");
        shell.args(program.get_args()).current_dir(self.0.path());
        for (key, value) in program.get_envs() {
            shell.env(key, value.unwrap_or_default());
        }
        shell
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs the small drum into the folder `out`, which must work, and returns its summary.
    pub(crate) fn run_small_drum(&self, out: &str, more: &[&str]) -> Value {
        let output = self.run(&[&small_drum("200ms", out)[..], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        summary(&self.path(out))
    }

    /// Starts what runs the small drum for an hour into the folder `out`; it has left `file` there.
    #[cfg(unix)]
    pub(crate) fn start_long_run(&self, file: &str) -> Child {
        let mut command = self.command(&small_drum("1h", "out"));
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        wait_for(&self.path("out").join(file), &mut child);
        child
    }

    pub(crate) fn write(&self, name: &str, content: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, content).unwrap();
        path
    }
}

/// What a run leaves in its folder.
const FILES_OF_A_RUN: [&str; 12] = [
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
    "series.csv",
    "summary.json",
];

/// What runs the small drum for a `duration` into the folder `out`.
pub(crate) const fn small_drum<'a>(duration: &'a str, out: &'a str) -> [&'a str; 6] {
    [
        "small-drum",
        "--no-render",
        "--duration",
        duration,
        "--out",
        out,
    ]
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

pub(crate) fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap()
}

pub(crate) fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

pub(crate) fn series(folder: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(folder.join("series.csv")).unwrap();
    let head = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    let rows = reader
        .records()
        .map(|row| {
            row.unwrap()
                .iter()
                .map(|cell| cell.parse().unwrap())
                .collect()
        })
        .collect();
    (head, rows)
}

#[test]
fn run_leaves_series_grains_and_summary() {
    let place = Place::new();
    let summary = place.run_small_drum("out", &[]);
    let out = place.path("out");
    assert_eq!(names(&out), FILES_OF_A_RUN);
    // Every 0.05 s from 0 to 0.2 s.
    for kind in ["grains", "contacts"] {
        let frames: Vec<String> = (0..5).map(|k| format!("{kind}_{k:06}.vtp")).collect();
        assert_eq!(names(&out.join(kind)), frames);
        let collection = fs::read_to_string(out.join(format!("{kind}.pvd"))).unwrap();
        for frame in &frames {
            assert!(collection.contains(&format!("file=\"{kind}/{frame}\"")));
        }
    }
    let (head, rows) = series(&out);
    assert_eq!(head[..3], ["step [1]", "time [s]", "surface angle [rad]"]);
    assert_eq!(rows.len(), 11, "every 0.02 s from 0 to 0.2 s");
    assert_eq!(summary["status"], "done");
    assert_eq!(summary["program"], "grainfall");
    assert_eq!(summary["grains"], 100);
    assert_eq!(summary["state_hash"].as_str().unwrap().len(), 32);
    assert!(summary["time"].as_f64().unwrap() >= 0.2);
    assert!(
        summary["time_step"]["limits"]
            .as_array()
            .is_some_and(|limits| !limits.is_empty())
    );
}

#[test]
fn grains_file_reads_back_as_the_grains() {
    let place = Place::new();
    place.run_small_drum("out", &[]);
    let bytes = fs::read(place.path("out/grains/grains_000004.vtp")).unwrap();
    let file = crate::vtk_file::File::parse(&bytes);
    assert!(
        file.header
            .contains("NumberOfPoints=\"100\" NumberOfVerts=\"100\"")
    );
    assert!(file.floats("radius").iter().all(|radius| *radius == 0.003));
    let lengths = ["radius", "v", "omega", "f"].map(|name| file.floats(name).len());
    assert_eq!(lengths, [100, 300, 300, 300]);
    assert_eq!(file.integers("shapetype").len(), 100);
    assert_eq!(file.floats("Points").len(), 300);
}

#[test]
fn threads_do_not_show_in_the_state() {
    let place = Place::new();
    let hash =
        |threads| place.run_small_drum(threads, &["--threads", threads])["state_hash"].clone();
    let one = hash("1");
    assert_eq!(hash("2"), one);
    assert_eq!(hash("3"), one);
}

#[test]
fn summary_plays_its_run_again() {
    let place = Place::new();
    let list = place.write(
        "commands.ron",
        r#"[(time: 0.1, command: Set(parameter: "friction.glass.glass", value: 0.1))]"#,
    );
    let changes = [
        "--set",
        "drum-speed=3 rpm",
        "--commands",
        list.to_str().unwrap(),
    ];
    let first = place.run_small_drum("first", &changes);
    assert_eq!(first["commands"].as_array().unwrap().len(), 2);
    assert_ne!(
        first["state_hash"],
        place.run_small_drum("plain", &[])["state_hash"]
    );
    let again = place.run_small_drum("again", &["--commands", "first/summary.json"]);
    assert_eq!(again["state_hash"], first["state_hash"]);
    assert_eq!(again["commands"], first["commands"]);
}

#[test]
fn every_file_says_where_it_came_from_and_tables_still_begin_with_their_header() {
    let place = Place::new();
    let summary = place.run_small_drum("out", &["--seed", "7"]);
    let out = place.path("out");
    let hash = summary["state_hash"].as_str().unwrap();
    let title = summary["scene"]["title"].as_str().unwrap();
    let state = format!(
        "“{title}”, seed 7, t = {:?} s, step {}, state {hash}",
        summary["time"].as_f64().unwrap(),
        summary["steps"]
    );
    for file in ["grains.pvd", "grains/grains_000004.vtp"] {
        let content = text(&fs::read(out.join(file)).unwrap());
        let comment = content
            .lines()
            .find(|line| line.starts_with("<!-- "))
            .unwrap();
        assert!(comment.contains(&state), "{file}: {comment}");
        assert!(comment.contains("Grainfall 0."), "{comment}");
    }
    let metadata = fs::read_to_string(out.join("csv-metadata.json")).unwrap();
    let metadata: Value = serde_json::from_str(&metadata).unwrap();
    assert_eq!(metadata["@context"], "http://www.w3.org/ns/csvw");
    let tables = metadata["tables"].as_array().unwrap();
    assert_eq!(tables.len(), 1);
    assert_eq!(tables[0]["url"], "series.csv");
    assert_eq!(metadata["notes"][0]["state hash"], hash);
    assert!(metadata["dc:source"].as_str().unwrap().contains(&state));
    let (head, _) = series(&out);
    assert_eq!(head[0], "step [1]");
    let columns = tables[0]["tableSchema"]["columns"].as_array().unwrap();
    let declared: Vec<&str> = (columns.iter())
        .map(|column| column["titles"].as_str().unwrap())
        .collect();
    assert_eq!(declared, head, "every column is declared by its head");
    assert_eq!(columns[0]["datatype"], "integer");
    assert_eq!(columns[2]["schema:unitText"], "rad");
}

#[test]
fn verify_computes_a_run_again_and_confirms_its_state() {
    let place = Place::new();
    let summary = place.run_small_drum("out", &["--set", "drum-speed=3 rpm", "--set", "count=60"]);
    let output = place.run(&["verify", "out/summary.json", "--threads", "2"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.starts_with("the same"), "{said}");
    assert!(
        said.contains(summary["state_hash"].as_str().unwrap()),
        "{said}"
    );
}

#[test]
fn session_is_verified_and_repeated_without_a_window_and_refused_as_a_scene() {
    use grainfall::run::{BedStore, Parameter, Session, Timeline};
    let place = Place::new();
    let scene = grainfall::scene::Scene::open("bouncing-grain").unwrap();
    let run = crate::runs::prepared(&scene, 1, BedStore::none()).0;
    let mut timeline = Timeline::new(run, 0);
    timeline.advance_to(300).unwrap();
    let weaker = crate::runs::set(Parameter::Gravity, 3.0);
    timeline.change(weaker, false).unwrap();
    timeline.advance_to(500).unwrap();
    let hash = timeline.run().world().hash().to_string();
    let path = place.path("class.grainfall");
    Session::of("grain", &timeline).write(&path).unwrap();

    let verified = place.run(&["verify", "class.grainfall"]);
    let said = text(&verified.stdout);
    assert!(
        verified.status.success() && said.starts_with("the same"),
        "{said}"
    );
    assert!(said.contains(&hash), "{said}");
    let time = format!("{:?}s", timeline.run().world().time());
    let repeat = [
        "bouncing-grain",
        "--no-render",
        "--commands",
        "class.grainfall",
        "--duration",
    ];
    let repeated = place.run(&[&repeat[..], &[&time, "--out", "again"]].concat());
    assert!(repeated.status.success(), "{}", text(&repeated.stderr));
    assert_eq!(summary(&place.path("again"))["state_hash"], hash);

    let refused = place.run(&["class.grainfall", "--no-render"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("`grainfall verify` computes it again"));
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 3]).unwrap();
    let damaged = place.run(&["verify", "class.grainfall"]);
    assert_eq!(damaged.status.code(), Some(2));
    assert!(
        text(&damaged.stderr).contains("damaged"),
        "{}",
        text(&damaged.stderr)
    );
}

#[test]
fn verify_refuses_what_was_edited_or_states_nothing() {
    let place = Place::new();
    place.run_small_drum("out", &[]);
    let whole = fs::read_to_string(place.path("out/summary.json")).unwrap();
    let hash = summary(&place.path("out"))["state_hash"]
        .as_str()
        .unwrap()
        .to_owned();
    let zeros = "0".repeat(hash.len());
    let cases = [
        (
            whole.replace("\"friction\": 0.4", "\"friction\": 0.3"),
            "fingerprint",
        ),
        (whole.replace(&hash, &zeros), "fingerprint"),
        (
            whole.replace(&format!("\"{hash}\""), "null"),
            "states no state",
        ),
        (whole[..whole.len() / 2].to_owned(), "expected"),
        ("[]".to_owned(), "expected"),
    ];
    for (content, expected) in cases {
        assert_ne!(content, whole, "{expected}");
        place.write("edited.json", &content);
        let output = place.run(&["verify", "edited.json"]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message}");
        assert_eq!(message.matches("error: ").count(), 1, "{message}");
    }
    let missing = place.run(&["verify", "nothing.json"]);
    assert_eq!(missing.status.code(), Some(2));
}

#[test]
fn claim_of_a_state_that_the_run_does_not_come_to_is_not_confirmed() {
    use grainfall::run::{BedStore, RunRecord};
    use grainfall::runner::Verdict;
    let scene = grainfall::scene::Scene::open("bouncing-grain").unwrap();
    let run = || crate::runs::prepared(&scene, 1, BedStore::none()).0;
    let (mut honest, mut other) = (run(), run());
    let drop = crate::runs::set(grainfall::run::Parameter::Gravity, 3.0);
    other.apply(drop).unwrap();
    for run in [&mut honest, &mut other] {
        run.advance_to(400).unwrap();
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("claim.json");
    let verdict = |commands, world| {
        RunRecord::of("grain", &scene, commands, world)
            .write(&path)
            .unwrap();
        let record = RunRecord::read(&path).unwrap();
        record
            .verify(1, BedStore::none(), &mut (), &|| false)
            .unwrap()
    };
    assert_eq!(verdict(honest.commands(), honest.world()), Verdict::Same);
    assert_eq!(verdict(other.commands(), other.world()), Verdict::Same);
    let wrong = verdict(&[], other.world());
    assert_eq!(wrong, Verdict::Other(honest.world().hash()));
    assert_eq!(wrong.exit_code(), 4);
}

#[test]
fn later_run_clears_the_files_of_an_earlier_one() {
    let place = Place::new();
    place.run_small_drum("out", &[]);
    place.run_small_drum("out", &["--duration", "50ms", "--restart"]);
    assert_eq!(names(&place.path("out/grains")).len(), 2);
}

#[test]
fn folder_with_other_files_is_left_alone() {
    let place = Place::new();
    fs::create_dir(place.path("thesis")).unwrap();
    place.write("thesis/summary.json", "{}");
    let output = place.run(&["small-drum", "--no-render", "--out", "thesis"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("holds files that are not a run's"));
    assert_eq!(names(&place.path("thesis")), ["summary.json"]);
}

#[test]
fn bad_input_ends_with_2_and_says_what_was_expected() {
    let place = Place::new();
    place.write("broken.ron", "(title: \"x\", colour: 3)");
    place.write("list.ron", "[(time: 1, command: Fly)]");
    place.write("reset.ron", "[(time: 1, command: Reset)]");
    let cases: [(&[&str], &str); 12] = [
        (&["no-such-scene"], "no-such-scene"),
        (&["broken.ron"], "broken.ron"),
        (&["small-drum", "--duration", "soon"], "a time such as"),
        (&["small-drum", "--seed", "-1"], "seed"),
        (&["small-drum", "--threads", "0"], "--threads"),
        (&["small-drum", "--set", "drum-speed"], "expected KEY=VALUE"),
        (
            &["small-drum", "--set", "colour=red"],
            "no parameter is called `colour`",
        ),
        (&["small-drum", "--set", "drum-speed=fast"], "rpm"),
        (
            &["small-drum", "--set", "friction.glass.gold=0.3"],
            "friction.glass.drum",
        ),
        (
            &["small-drum", "--set", "friction.glass.glass=-1"],
            "expected 0 … 1",
        ),
        (&["small-drum", "--commands", "list.ron"], "list.ron"),
        (&["small-drum", "--commands", "reset.ron"], "Reset"),
    ];
    for (arguments, expected) in cases {
        let output = place.run(&[arguments, &["--no-render", "--out", "out"]].concat());
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(expected), "{arguments:?}: {message}");
        assert_eq!(
            message.matches("error: ").count(),
            1,
            "said once: {message}"
        );
        assert!(!message.contains("panicked"), "{arguments:?}: {message}");
    }
}

#[test]
fn fault_ends_with_3_and_keeps_the_files_until_then() {
    let place = Place::new();
    let output = place.run(&[
        "small-drum",
        "--no-render",
        "--out",
        "out",
        "--time-step",
        "1e-3",
        "--duration",
        "1s",
    ]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    let summary = summary(&place.path("out"));
    assert_eq!(summary["status"], "fault");
    assert!(summary["fault"]["time"].is_number());
}

#[cfg(unix)]
#[test]
fn interrupted_run_leaves_whole_files() {
    let place = Place::new();
    let mut child = place.start_long_run("grains/grains_000003.vtp");
    // Twice at once, as `timeout` does it: that is one wish.
    let process = child.id().to_string();
    let interrupt = Command::new("kill")
        .args(["-INT", &process, &process])
        .status();
    assert!(interrupt.unwrap().success());
    assert_eq!(exit_code(&mut child), Some(130));
    let out = place.path("out");
    assert_eq!(names(&out), FILES_OF_A_RUN);
    let summary = summary(&out);
    assert_eq!(summary["status"], "interrupted");
    let (_, rows) = series(&out);
    assert!(rows.last().unwrap()[1] <= summary["time"].as_f64().unwrap());
    let frames = names(&out.join("grains"));
    let collection = fs::read_to_string(out.join("grains.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), frames.len());
}

#[test]
fn run_that_keeps_checkpoints_goes_on_after_a_stop_to_the_same_bits() {
    use grainfall::output::Ending;
    use grainfall::run::{Command, Parameter, ScriptedCommand};
    use grainfall::runner::Job;
    use grainfall_app::headless::{Report, run};
    use std::sync::atomic::AtomicBool;
    let place = Place::new();
    let mut scene = grainfall::scene::Scene::open("small-drum").unwrap();
    scene.set("duration", "600ms").unwrap();
    let slower = |time, value| ScriptedCommand {
        step: None,
        time: Some(time),
        command: Command::Set {
            parameter: Parameter::DrumSpeed,
            value,
        },
    };
    let job = |out: &str| Job {
        threads: 1,
        script: vec![slower(0.0, 0.5.into()), slower(0.3, 0.2.into())],
        beds: crate::runs::shared_beds(),
        checkpoints: true,
        ..Job::new("drum", scene.clone(), place.path(out))
    };
    let never = AtomicBool::new(false);
    assert_eq!(
        run(&job("whole"), Report::Quiet, &never).unwrap(),
        Ending::Done
    );
    let ending = crate::runs::until_done(&Ending::Interrupted, |stop| {
        run(&job("parts"), Report::Quiet, stop).unwrap()
    });
    assert_eq!(ending, Ending::Done);
    let [whole, parts] = ["whole", "parts"].map(|out| place.path(out));
    assert_eq!(summary(&parts)["state_hash"], summary(&whole)["state_hash"]);
    assert_eq!(summary(&parts)["commands"], summary(&whole)["commands"]);
    assert_eq!(series(&parts), series(&whole));
    for kind in ["grains", "contacts"] {
        let files = |out: &Path| {
            let folder = out.join(kind);
            let files = names(&folder).into_iter();
            files
                .map(|name| fs::read(folder.join(name)).unwrap())
                .collect::<Vec<_>>()
        };
        assert!(files(&parts) == files(&whole), "the same files of {kind}");
    }
    for list in ["grains.pvd", "contacts.pvd", "container.vtp"] {
        let read = |out: &Path| fs::read(out.join(list)).unwrap();
        assert!(read(&parts) == read(&whole), "{list}");
    }
}

/// Waits until `path` exists, a minute at most, while `child` runs.
#[cfg(unix)]
pub(crate) fn wait_for(path: &Path, child: &mut Child) {
    wait_until(child, &path.display().to_string(), || path.exists());
}

/// Waits until `is_there`, a minute at most, while `child` runs.
#[cfg(unix)]
pub(crate) fn wait_until(child: &mut Child, what: &str, is_there: impl Fn() -> bool) {
    let came = within_a_minute(|| {
        assert!(
            child.try_wait().unwrap().is_none(),
            "the run ended by itself"
        );
        is_there().then_some(())
    });
    assert!(came.is_some(), "{what} never came");
}

/// What `child` ends with, within a minute.
#[cfg(unix)]
pub(crate) fn exit_code(child: &mut Child) -> Option<i32> {
    let Some(status) = within_a_minute(|| child.try_wait().unwrap()) else {
        child.kill().unwrap();
        panic!(
            "the run does not end: it was asked to, unless what started the tests ignores Ctrl-C"
        );
    };
    status.code()
}

/// What `found` gives first, asked every 10 ms.
#[cfg(unix)]
fn within_a_minute<T>(mut found: impl FnMut() -> Option<T>) -> Option<T> {
    for _ in 0..6000 {
        let thing = found();
        if thing.is_some() {
            return thing;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    None
}
