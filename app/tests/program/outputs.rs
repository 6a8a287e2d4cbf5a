//! Claims about where files go: never over what is no regular file, never where there is no room
//! for them, and whether anybody listens to what is said about them or not.

use crate::headless::{Place, small_drum, text};
use std::fs;
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};

const PACK: [&str; 6] = ["pack", "small-column", "--set", "height=8mm", "--out", "it"];
const SWEEP: [&str; 8] = [
    "sweep",
    "bouncing-grain",
    "--vary",
    "seed=1",
    "--duration",
    "20ms",
    "--out",
    "swept",
];
const EXPORT: [&str; 9] = [
    "export",
    "small-drum",
    "--set",
    "count=3",
    "--unsettled",
    "--to",
    "liggghts",
    "--out",
    "deck",
];
const IMPORT: [&str; 7] = [
    "import",
    "deck/grains.data",
    "--out",
    "taken",
    "--restart",
    "--start",
    "it.ron",
];
const GRAIN: [&str; 6] = [
    "bouncing-grain",
    "--no-render",
    "--duration",
    "40ms",
    "--out",
    "out",
];

/// A place in which all these commands were carried out.
fn place() -> Place {
    let place = Place::new();
    for command in [&PACK[..], &SWEEP, &EXPORT, &IMPORT, &GRAIN] {
        let output = place.run(command);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    place
}

#[test]
fn links_pipes_and_folders_are_never_written_over() {
    let place = place();
    let other = place.write("others.txt", "of somebody else");
    let longer = [&GRAIN[..], &["--duration", "50ms"]].concat();
    let anew = [&GRAIN[..], &["--restart"]].concat();
    let commands: [(&str, &[&str]); 6] = [
        ("it", &PACK),
        ("swept/table.csv", &SWEEP),
        ("deck/in.liggghts", &EXPORT),
        ("it.ron", &IMPORT),
        ("out/series.csv", &longer),
        ("out/grains.pvd", &anew),
    ];
    for (name, command) in commands {
        let path = place.path(name);
        let whole = fs::read(&path).unwrap();
        let kinds: [(&str, &dyn Fn()); 3] = [
            ("symbolic link", &|| symlink(&other, &path).unwrap()),
            ("folder", &|| fs::create_dir(&path).unwrap()),
            ("pipe", &|| {
                let made = Command::new("mkfifo").arg(&path).status();
                assert!(made.unwrap().success());
            }),
        ];
        for (kind, make) in kinds {
            fs::remove_file(&path).unwrap();
            make();
            let output = place.run(command);
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{name}, {kind}: {message}");
            assert!(message.contains(name), "{name}, {kind}: {message}");
            let found = fs::symlink_metadata(&path).unwrap().file_type();
            assert!(!found.is_file(), "{name} is the {kind} still");
            if found.is_dir() {
                fs::remove_dir(&path).unwrap();
            } else {
                fs::remove_file(&path).unwrap();
            }
            fs::write(&path, &whole).unwrap();
        }
    }
    assert_eq!(fs::read_to_string(other).unwrap(), "of somebody else");
}

#[test]
fn what_was_begun_and_never_whole_is_taken_up() {
    let place = Place::new();
    for (folder, command) in [("deck", &EXPORT[..]), ("swept", &SWEEP), ("out", &GRAIN)] {
        fs::create_dir(place.path(folder)).unwrap();
        place.write(&format!("{folder}/.grainfall-a1b2c3"), "never whole");
        let output = place.run(command);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
}

#[test]
fn import_that_came_to_nothing_is_begun_anew_unasked() {
    let place = Place::new();
    assert!(place.run(&EXPORT).status.success());
    let whole = fs::read_to_string(place.path("deck/grains.data")).unwrap();
    let import = &IMPORT[..4];
    place.write("deck/grains.data", &whole[..whole.len() / 2]);
    assert_eq!(place.run(import).status.code(), Some(2));
    place.write("deck/grains.data", &whole);
    assert_eq!(place.run(import).status.code(), Some(0));
    let output = place.run(import);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("an import begins anew"));
}

/// Three terabytes.
#[test]
fn files_that_the_disk_has_no_room_for_are_refused_before_anything_is_written() {
    let place = Place::new();
    let long = ["--duration", "1000000s", "--output-interval", "1s"];
    let run = [
        "dry-r1.25",
        "--no-render",
        "--out",
        "out",
        "--beyond-memory",
    ];
    let output = place.run(&[&run[..], &long].concat());
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("has room for"), "{message}");
    assert!(message.contains("--beyond-disk"), "{message}");
    assert!(!place.path("out").exists());
}

#[test]
fn whether_anybody_listens_changes_no_ending() {
    let place = place();
    let again = [&EXPORT[..], &["--set", "nothing=3"]].concat();
    let commands: [(&[&str], i32); 11] = [
        (&["settings", "small-drum"], 0),
        (&["--help"], 0),
        (&["verify", "out/summary.json"], 0),
        (&["verify", "others.json"], 2),
        (&PACK, 0),
        (&EXPORT, 0),
        (&again, 2),
        (&IMPORT, 0),
        (&["import", "none.dump", "--scene", "small-drum"], 2),
        (&["paper", "kasper2021", "--small", "--list"], 0),
        (&small_drum("a week", "out"), 2),
    ];
    for (command, code) in commands {
        let mut child = place
            .command(command)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(code), "{command:?}");
    }
}
