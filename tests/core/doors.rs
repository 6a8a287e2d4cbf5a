//! Claims about files that somebody else made: what is read of them, what they may name, what they
//! may ask for.

use crate::small_export::export_drum;
use grainfall::engines::ExportRecord;
use grainfall::run::{RunRecord, Session};
use grainfall::runner::read_commands;
use grainfall::scene::{Scene, StoredCells, within_folders};
use grainfall::world::Packing;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The error of `done`, as people read it.
fn refusal<T, E: std::fmt::Display>(done: Result<T, E>) -> String {
    done.err().expect("it is refused").to_string()
}

#[cfg(unix)]
#[test]
fn no_door_reads_a_device_or_waits_at_a_pipe() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.json");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let started = Instant::now();
    for path in [Path::new("/dev/zero"), &pipe, folder.path()] {
        for message in [
            refusal(Scene::load(path)),
            refusal(read_commands(path)),
            refusal(RunRecord::read(path)),
            refusal(Session::read(path)),
            refusal(StoredCells::read(path)),
        ] {
            assert!(message.contains("only regular files are read"), "{message}");
        }
        assert!(!Session::is_at(path));
    }
    assert!(started.elapsed() < Duration::from_secs(10));
}

#[test]
fn brackets_without_end_are_refused_at_once() {
    let started = Instant::now();
    for (before, bracket) in [("(title: ", "["), ("(title: ", "("), ("", "{"), ("[", "[")] {
        let text = format!("{before}{}", bracket.repeat(40_000));
        let message = refusal(Scene::parse("deep.ron", &text));
        assert!(message.len() < 1000, "{message}");
        let folder = tempfile::tempdir().unwrap();
        for name in ["deep.ron", "deep.json"] {
            let path = folder.path().join(name);
            fs::write(&path, &text).unwrap();
            assert!(refusal(read_commands(&path)).len() < 1000);
            assert!(refusal(RunRecord::read(&path)).len() < 1000);
        }
    }
    assert!(started.elapsed() < Duration::from_secs(5));
}

/// A sheet has one cell along its thickness, however thin: 2 500 million of them.
#[test]
fn cells_of_a_sheet_are_counted_as_the_lattice_does() {
    let sheet = |thickness: &str, size: &str| {
        let text = format!(
            "(title: \"a sheet\", materials: {{\"m\": ()}}, container: Box(min: (0, 0, 0), max: ({size}, {thickness}, \
             {size}), material: \"m\"), grains: Voronoi(cell: 0.02, species: [(material: \"m\")]))"
        );
        Scene::parse("sheet.ron", &text)
    };
    let message = refusal(sheet("0.000001", "1000"));
    assert!(message.contains("1666666666 Voronoi cells"), "{message}");
    assert!(message.contains("Take larger cells"), "{message}");
    let message = refusal(sheet("0.000001", "20"));
    assert!(message.contains("polyhedra"), "{message}");
    assert!(sheet("0.02", "0.2").is_ok());
    // Of a box as high as a house the lowest part alone is filled.
    let low = "(title: \"low\", materials: {\"m\": ()}, container: Box(min: (0, 0, 0), max: (1, 1, 1), material: \"m\"), \
               grains: Voronoi(cell: 0.005, bulk_fraction: 0.01, species: [(material: \"m\")]))";
    let message = refusal(Scene::parse("low.ron", low));
    assert!(message.contains("a lattice of 8000000 cells"), "{message}");
}

/// A packing in a folder of its own, and scenes in another.
fn packing() -> (TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let (scenes, other) = (folder.path().join("scenes"), folder.path().join("other"));
    fs::create_dir_all(scenes.join("below")).unwrap();
    fs::create_dir_all(&other).unwrap();
    let cut = Packing::new(&Scene::open("small-column").unwrap()).unwrap();
    fs::write(
        other.join("cells.pack"),
        StoredCells::encode(&cut.finish()).unwrap(),
    )
    .unwrap();
    (folder, scenes, other)
}

fn scene_of(packing: &str) -> String {
    format!(
        "(title: \"From a file\", materials: {{\"stone\": (), \"floor\": ()}}, container: Column(radius_mm: 20, \
         height_mm: 25, material: \"floor\"), grains: Voronoi(packing: {packing:?}, species: [(material: \"stone\")]))"
    )
}

#[test]
fn a_scene_opens_packings_beside_it_alone() {
    let (_folder, scenes, other) = packing();
    let load = |packing: &str| {
        let file = scenes.join("scene.ron");
        fs::write(&file, scene_of(packing)).unwrap();
        Scene::load(&file)
    };
    let absolute = other.join("cells.pack");
    for elsewhere in ["../other/cells.pack", absolute.to_str().unwrap()] {
        let message = refusal(load(elsewhere));
        assert!(message.contains("--packings-anywhere"), "{message}");
        assert!(message.contains("cells.pack"), "{message}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&absolute, scenes.join("link.pack")).unwrap();
        let message = refusal(load("link.pack"));
        assert!(message.contains("--packings-anywhere"), "{message}");
    }
    let message = refusal(load("../other/none.pack"));
    assert!(message.contains("cannot be read"), "{message}");
    fs::copy(&absolute, scenes.join("below/cells.pack")).unwrap();
    assert!(load("below/cells.pack").is_ok());
}

#[test]
fn a_record_opens_packings_in_the_folders_of_its_reader_alone() {
    let (_folder, scenes, other) = packing();
    let path = scenes.join("cells.pack");
    fs::copy(other.join("cells.pack"), &path).unwrap();
    fs::write(scenes.join("scene.ron"), scene_of("cells.pack")).unwrap();
    let text = serde_json::to_string(&Scene::load(scenes.join("scene.ron")).unwrap()).unwrap();
    let read = |folders: &[&Path]| within_folders(folders, || serde_json::from_str::<Scene>(&text));
    assert!(read(&[&scenes]).is_ok());
    let message = refusal(read(&[&other]));
    assert!(message.contains("--packings-anywhere"), "{message}");
    assert!(refusal(read(&[])).contains("--packings-anywhere"));
    // Who asks for nothing of the kind reads what is there.
    assert!(serde_json::from_str::<Scene>(&text).is_ok());
}

#[test]
fn the_record_of_an_export_opens_no_packing_elsewhere() {
    let (_folder, scenes, other) = packing();
    let deck = scenes.join("deck");
    export_drum(&deck).unwrap();
    fs::copy(other.join("cells.pack"), scenes.join("cells.pack")).unwrap();
    fs::write(scenes.join("scene.ron"), scene_of("cells.pack")).unwrap();
    let forged = Scene::load(scenes.join("scene.ron")).unwrap();
    let text = fs::read_to_string(deck.join("export.json")).unwrap();
    let mut record: serde_json::Value = serde_json::from_str(&text).unwrap();
    record["scene"] = serde_json::to_value(forged).unwrap();
    fs::write(deck.join("export.json"), record.to_string()).unwrap();
    let message = refusal(ExportRecord::read(&deck));
    assert!(message.contains("--packings-anywhere"), "{message}");
}
