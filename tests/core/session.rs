//! Claims about sessions in files: they reopen to the same bits, and a file that cannot is refused
//! in words.

use crate::runs::{bits, prepared, set};
use crate::timeline::{Explored, arrive, change, column_lab, go_on, hash, wet_lab};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use grainfall::lab::{DriverKind, Lab, LabCommand, Options, Status};
use grainfall::run::{BedStore, Command, Parameter, RunRecord, Session, Timeline, VERSION};
use grainfall::runner::Verdict;
use grainfall::scene::{Scene, StoredCells};
use grainfall::world::Packing;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

const PLENTY: usize = 1 << 28;

fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.grainfall");
    (folder, path)
}

fn reopened(path: &Path, memory: usize) -> Timeline {
    Session::read(path).unwrap().into_timeline(1, memory)
}

/// A run with changes, a branch from its middle that goes on, a change there that was taken back,
/// and a moment of the branch that is not its newest.
fn explored(lab: &Explored) -> Timeline {
    let (mut timeline, _) = lab.recorded(PLENTY);
    lab.seek(&mut timeline, 7);
    change(&mut timeline, lab.last_change());
    go_on(&mut timeline, 11 * lab.unit);
    change(&mut timeline, set(Parameter::Gravity, 4.0));
    go_on(&mut timeline, 12 * lab.unit);
    timeline.undo();
    arrive(&mut timeline);
    go_on(&mut timeline, 13 * lab.unit);
    lab.seek(&mut timeline, 9);
    timeline
}

/// What can be done with a session next, each way on its own.
const NEXT: [fn(&mut Timeline); 5] = [
    |timeline| timeline.seek(timeline.branch().end.step),
    |timeline| timeline.seek(0),
    Timeline::undo,
    |timeline| timeline.take_up(0),
    |timeline| change(timeline, set(Parameter::Gravity, 7.0)),
];

fn reopens_to_the_same_bits(lab: &Explored) {
    let (_folder, path) = place();
    let mut timeline = explored(lab);
    Session::of("explored", &timeline).write(&path).unwrap();
    assert_eq!(
        timeline.kept().len(),
        2,
        "the run that was left, and the end that was undone"
    );
    // With and without room for states beside the one shown.
    for memory in [PLENTY, 0] {
        let same = reopened(&path, memory);
        assert_eq!(hash(&same), hash(&timeline));
        assert_eq!(bits(&same.branch().series), bits(&timeline.branch().series));
        assert_eq!(bits(same.run().series()), bits(timeline.run().series()));
        assert_eq!(same.run().commands(), timeline.run().commands());
        let changes = |timeline: &Timeline| timeline.branch().history.changes().to_vec();
        assert_eq!(changes(&same), changes(&timeline));
        let (past, before) = (same.past(), timeline.past());
        assert_eq!((past.number, past.end), (before.number, before.end));
        assert_eq!((past.undo, past.redo), (before.undo, before.redo));
        let kept = |timeline: &Timeline| -> Vec<_> {
            let series = timeline.kept().iter().map(|record| bits(&record.series));
            series.collect()
        };
        assert_eq!(kept(&same), kept(&timeline));
    }
    for (index, next) in NEXT.into_iter().enumerate() {
        let mut same = reopened(&path, PLENTY);
        for timeline in [&mut timeline, &mut same] {
            next(timeline);
            arrive(timeline);
            let step = timeline.run().world().clock.step;
            go_on(timeline, step + lab.unit / 3);
        }
        assert_eq!(hash(&same), hash(&timeline), "way {index}");
        assert_eq!(bits(&same.branch().series), bits(&timeline.branch().series));
        timeline = reopened(&path, PLENTY);
    }
    let record = RunRecord::read(&path).unwrap();
    let verdict = record
        .verify(2, lab.beds.clone(), &mut (), &|| false)
        .unwrap();
    assert_eq!(verdict, Verdict::Same);
}

#[test]
fn session_reopens_to_the_same_bits_mid_avalanche_with_liquid() {
    reopens_to_the_same_bits(&wet_lab());
}

#[test]
fn session_reopens_to_the_same_bits_mid_collapse_with_polyhedra() {
    reopens_to_the_same_bits(&column_lab());
}

#[test]
fn shapes_of_polyhedra_are_kept_once() {
    let lab = column_lab();
    let (_folder, path) = place();
    let timeline = explored(&lab);
    Session::of("column", &timeline).write(&path).unwrap();
    let same = reopened(&path, PLENTY);
    let shapes = |timeline: &Timeline| {
        let world = timeline.run().world();
        world.polyhedra.as_ref().unwrap().shapes.clone()
    };
    let bed = same.run().bed().polyhedra.as_ref().unwrap().shapes.clone();
    assert!(std::sync::Arc::ptr_eq(&shapes(&same), &bed));
    assert_eq!(shapes(&same), shapes(&timeline));
}

#[test]
fn file_that_is_no_session_is_refused_with_what_to_do() {
    let (_folder, path) = place();
    Session::of("wet", &explored(&wet_lab()))
        .write(&path)
        .unwrap();
    let whole = fs::read(&path).unwrap();
    let edited = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        bytes
    };
    let renamed = |from: &str, to: &str| {
        let mut bytes = to.as_bytes().to_vec();
        bytes.extend_from_slice(whole.strip_prefix(from.as_bytes()).unwrap());
        bytes
    };
    let other = format!("grainfall session 7 {VERSION}");
    let cases: [(Vec<u8>, [&str; 2]); 8] = [
        (
            whole[..whole.len() - 1].to_vec(),
            ["damaged", "Open another copy"],
        ),
        (whole[..40].to_vec(), ["is no session", "Save the session"]),
        (edited(whole.len() / 2), ["checksum", "--commands"]),
        (edited(whole.len() - 1), ["checksum", "--commands"]),
        (
            renamed(&other, &format!("grainfall session 1 {VERSION}")),
            ["of another build", "--commands"],
        ),
        (
            renamed(&other, "grainfall session 3 0.0.7"),
            ["saved by Grainfall 0.0.7", "Open it with Grainfall 0.0.7"],
        ),
        (
            renamed(&other, "grainfall session 9 9.9"),
            ["Grainfall 9.9", "--commands"],
        ),
        (
            b"(title: \"a scene\")\n".to_vec(),
            ["is no session", "Save the session"],
        ),
    ];
    for (bytes, expected) in cases {
        fs::write(&path, bytes).unwrap();
        let error = Session::read(&path)
            .err()
            .expect("it is refused")
            .to_string();
        assert!(error.contains("kept.grainfall"), "{error}");
        for part in expected {
            assert!(error.contains(part), "{part}: {error}");
        }
    }
    fs::remove_file(&path).unwrap();
    let error = Session::read(&path).err().unwrap().to_string();
    assert!(error.contains("cannot be read"), "{error}");
}

#[test]
fn session_holds_the_grains_that_its_scene_takes_from_a_file() {
    let (folder, path) = place();
    let cells = folder.path().join("cells.pack");
    let cut = Packing::new(&Scene::open("small-column").unwrap()).unwrap();
    fs::write(&cells, StoredCells::encode(&cut.finish()).unwrap()).unwrap();
    let scene = r#"(
        title: "From a file", materials: {"stone": (friction: 0.3), "floor": ()},
        container: Column(radius_mm: 20, height_mm: 25, material: "floor"),
        grains: Voronoi(packing: "cells.pack", species: [(material: "stone")]),
    )"#;
    let file = folder.path().join("scene.ron");
    fs::write(&file, scene).unwrap();
    let scene = Scene::load(&file).unwrap();
    let (run, _) = prepared(&scene, 1, BedStore::none());
    let mut timeline = Timeline::new(run, PLENTY);
    timeline.advance_to(20).unwrap();
    Session::of("from a file", &timeline).write(&path).unwrap();

    fs::remove_file(&cells).unwrap();
    let session = Session::read(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(session.record().scene, scene);
    let verdict = session
        .record()
        .verify(1, BedStore::none(), &mut (), &|| false);
    assert_eq!(verdict.unwrap(), Verdict::Same);
    assert_eq!(hash(&session.into_timeline(1, PLENTY)), hash(&timeline));
    // Saved again by whoever has the file no more.
    Session::of("again", &reopened(&path, PLENTY))
        .write(&path)
        .unwrap();
    drop((scene, timeline));
    assert!(Session::read(&path).is_ok());
}

/// Every file of its own checksum but with another state is refused: the hash of the state decides.
#[test]
fn state_is_checked_by_its_hash() {
    let (_folder, path) = place();
    let lab = wet_lab();
    let timeline = explored(&lab);
    Session::of("wet", &timeline).write(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    let body = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let position = timeline.run().world().grains.position[17].x;
    let at = (body..whole.len() - 8)
        .rfind(|at| whole[*at..*at + 8] == position.to_le_bytes())
        .expect("the state shown is in the file");
    let mut bytes = whole[body..].to_vec();
    bytes[at - body] ^= 1;
    let head = format!(
        "grainfall session 3 {VERSION} {}\n",
        blake3::hash(&bytes).to_hex()
    );
    fs::write(&path, [head.as_bytes(), &bytes].concat()).unwrap();
    let error = Session::read(&path).err().unwrap().to_string();
    assert!(error.contains("another hash"), "{error}");
}

fn options(lab: &Explored, driver: DriverKind) -> Options {
    Options {
        driver,
        threads: 1,
        autoplay: false,
        beds: lab.beds.clone(),
        ..Options::window()
    }
}

fn tick_until(simulation: &mut Lab, done: impl Fn(&Lab) -> bool) {
    for _ in 0..60_000 {
        simulation.tick(Duration::from_millis(2));
        if done(simulation) {
            return;
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    panic!("still {:?}", simulation.status());
}

/// Saves, waits for the file, and says why there is none, if there is none.
fn saved(simulation: &mut Lab, path: &Path) -> Option<String> {
    simulation.send(LabCommand::Save {
        path: path.to_owned(),
        look: "a look".into(),
    });
    for _ in 0..60_000 {
        simulation.tick(Duration::from_millis(2));
        if let Some(file) = simulation.take_saved().pop() {
            assert_eq!(file.path, path);
            return file.outcome.err();
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    panic!("nothing was heard of {}", path.display());
}

#[test]
fn simulation_knows_what_no_file_holds_and_reopens_as_it_was() {
    let lab = wet_lab();
    for driver in [DriverKind::Inline, DriverKind::Thread] {
        let (_folder, path) = place();
        let mut original = lab.scene.clone();
        original.seed += 1;
        let simulation = Lab::open(lab.scene.clone(), options(&lab, driver));
        let mut simulation = simulation.made_of(original.clone().into());
        tick_until(&mut simulation, |s| *s.status() == Status::Paused);
        assert!(!simulation.is_unsaved());
        let held = |s: &Lab| s.has_answered() && *s.status() == Status::Paused;
        simulation.send(Command::Step(300));
        tick_until(&mut simulation, held);
        assert!(!simulation.is_unsaved(), "that is done again by playing");
        simulation.send(lab.last_change());
        simulation.send(Command::Step(200));
        tick_until(&mut simulation, held);
        assert!(simulation.is_unsaved());
        let nowhere = path.join("file");
        fs::write(&path, "").unwrap();
        assert!(
            saved(&mut simulation, &nowhere).is_some(),
            "a file is no folder"
        );
        assert!(simulation.is_unsaved());
        // Kept for the case that the program is killed, it does not count as saved.
        let aside = path.with_file_name("rescued.grainfall");
        for path in [&aside, &nowhere, &nowhere] {
            let (path, look) = (path.clone(), "a look".into());
            simulation.send(LabCommand::Rescue { path, look });
        }
        tick_until(&mut simulation, held);
        assert!(simulation.is_unsaved() && simulation.take_saved().is_empty());
        let warnings = simulation.warnings().iter();
        let told = warnings.filter(|text| text.contains("would be lost"));
        assert_eq!(told.count(), 1, "{:?}", simulation.warnings());
        let rescued = Session::read(&aside).unwrap().record().state_hash.clone();
        assert_eq!(saved(&mut simulation, &path), None);
        assert!(!simulation.is_unsaved());
        let kept = Session::read(&path).unwrap().record().state_hash.clone();
        assert_eq!(rescued, kept);

        let session = Session::read(&path).unwrap();
        assert_eq!(*session.original(), original);
        let mut same = Lab::resume(session, options(&lab, driver));
        assert_eq!(**same.original(), original);
        tick_until(&mut same, |s| s.world().is_some());
        assert_eq!(*same.status(), Status::Paused);
        let state = |s: &Lab| s.world().map(|world| world.hash());
        assert_eq!(state(&same), state(&simulation));
        assert_eq!(bits(same.series()), bits(simulation.series()));
        assert_eq!(same.commands(), simulation.commands());
        assert!(!same.is_unsaved() && same.past().undo.is_some());
        same.send(Command::Undo);
        tick_until(&mut same, held);
        assert_eq!(same.step(), 300);
        assert!(same.is_unsaved(), "what was undone is not in the file");
    }
}

#[test]
fn run_that_is_still_prepared_has_nothing_to_save_yet_and_waits() {
    let lab = column_lab();
    let (_folder, path) = place();
    let options = options(&lab, DriverKind::Inline);
    let mut simulation = Lab::open(lab.scene.clone(), options);
    simulation.send(LabCommand::Save {
        path: path.clone(),
        look: String::new(),
    });
    assert!(simulation.world().is_none());
    tick_until(&mut simulation, |s| s.world().is_some());
    simulation.tick(Duration::ZERO);
    assert_eq!(simulation.take_saved().len(), 1);
    let same = reopened(&path, 0);
    assert_eq!(
        Some(same.run().world().hash()),
        simulation.world().map(|w| w.hash())
    );
}

#[test]
fn packed_session_reopens_to_the_same_bits_and_a_bomb_is_refused() {
    let (_folder, path) = place();
    let timeline = explored(&column_lab());
    let session = Session::of("packed", &timeline).looking("a look".into());
    session.write(&path).unwrap();
    let plain = fs::metadata(&path).unwrap().len();
    session.write_packed(&path).unwrap();
    assert!(fs::metadata(&path).unwrap().len() < plain);
    assert_eq!(Session::read(&path).unwrap().look(), "a look");
    let same = reopened(&path, PLENTY);
    assert_eq!(hash(&same), hash(&timeline));
    assert_eq!(bits(&same.branch().series), bits(&timeline.branch().series));

    // States that would fill the memory, in a file whose checksum is right.
    let bytes = fs::read(&path).unwrap();
    let lines: Vec<&[u8]> = bytes.splitn(3, |byte| *byte == b'\n').collect();
    let mut bomb = ZlibEncoder::new(Vec::new(), Compression::best());
    bomb.write_all(&vec![0; 65 << 20]).unwrap();
    let body = [lines[1], b"\n", &bomb.finish().unwrap()].concat();
    let first = String::from_utf8(lines[0].to_vec()).unwrap();
    let known = first.rsplit_once(' ').unwrap().0;
    let first = format!("{known} {}\n", blake3::hash(&body).to_hex());
    fs::write(&path, [first.as_bytes(), &body].concat()).unwrap();
    let refusal = Session::read(&path).err().unwrap().to_string();
    assert!(refusal.contains("cannot be unpacked"), "{refusal}");
}
