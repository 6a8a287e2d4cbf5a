//! An exported drum in LIGGGHTS and LAMMPS on two processes, beside the same drum here. They need
//! the programs, and are asked for by name:
//! `cargo test --test core engines::beside -- --ignored`. `MPIRUN` is what starts them.

use crate::meshes::{drum, key};
use glam::DVec3;
use grainfall::engines::{Export, MpiEngine, export, read_frames};
use grainfall::runner::{Advance, DirectRun, Job};
use grainfall::scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The job's run at time zero.
fn begun(job: &Job) -> DirectRun {
    let mut run = DirectRun::of(job);
    while run.run().is_none() {
        run.advance(0).unwrap();
    }
    run
}

/// Lets `engine` compute the export in `folder`.
fn compute(engine: MpiEngine, folder: &Path) {
    let mpirun = std::env::var("MPIRUN");
    let mpirun = mpirun.unwrap_or("mpirun --allow-run-as-root --oversubscribe".to_owned());
    let output = Command::new("sh")
        .args([folder.join("run.sh").as_os_str(), "2".as_ref()])
        .env("MPIRUN", mpirun)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{engine}: {said}");
}

/// Distances of grains in `engine` from where they are here, at the last dump, and the median way
/// that they have come [m].
fn distances(mut scene: Scene, settings: &[(&str, &str)], engine: MpiEngine) -> (Vec<f64>, f64) {
    scene.set_all(settings).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let job = Job::new("drum", scene, folder.path().join("ours"));
    let mut run = begun(&job);
    let start: Vec<DVec3> = run.run().unwrap().world().grains.position.to_vec();
    let out = folder.path().join("theirs");
    let handed = Export {
        name: "drum",
        scene: &job.scene,
        commands: &[],
        world: run.run().unwrap().world(),
        is_settled: true,
    };
    export(handed, engine, &out).unwrap();
    compute(engine, &out);
    let mut dumps: Vec<PathBuf> = (fs::read_dir(out.join("dumps")).unwrap())
        .map(|entry| entry.unwrap().path())
        .collect();
    dumps.sort();
    let frame = read_frames(dumps.last().unwrap()).unwrap().pop().unwrap();
    while run.run().unwrap().world().clock.step < frame.step {
        run.advance(frame.step).unwrap();
    }
    let ours = &run.run().unwrap().world().grains.position;
    let pairs = frame.atoms.iter().zip(ours.iter());
    let way = ours.iter().zip(&start).map(|(x, start)| x.distance(*start));
    (
        sorted(pairs.map(|(atom, x)| atom.position.distance(*x))),
        median(&sorted(way)),
    )
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

fn median(sorted: &[f64]) -> f64 {
    sorted[sorted.len() / 2]
}

/// The median distance after 0.1 s is below `bound` [m], and grains have moved.
fn stands_beside(scene: Scene, settings: &[(&str, &str)], engine: MpiEngine, bound: f64) {
    let length = [("duration", "100ms"), ("output-interval", "100ms")];
    let settings = [settings, &length].concat();
    let title = scene.title.clone();
    let (distances, way) = distances(scene, &settings, engine);
    let (middle, farthest) = (median(&distances), distances[distances.len() - 1]);
    println!(
        "{title} in {engine}: median {:.2} um, at most {:.1} um, of a way of {:.1} um",
        middle * 1e6,
        farthest * 1e6,
        way * 1e6
    );
    assert!(way > 1e-4 && middle < bound);
}

#[test]
#[ignore = "needs LIGGGHTS and mpirun"]
fn dry_drum_in_liggghts_stands_within_micrometres_of_ours() {
    stands_beside(
        Scene::open("dry-r3").unwrap(),
        &[],
        MpiEngine::Liggghts,
        3e-6,
    );
}

#[test]
#[ignore = "needs LIGGGHTS and mpirun"]
fn wet_drum_as_coded_in_liggghts_stands_within_micrometres_of_ours() {
    let as_coded = [("bridge-law", "as-coded")];
    stands_beside(
        Scene::open("wet").unwrap(),
        &as_coded,
        MpiEngine::Liggghts,
        15e-6,
    );
}

#[test]
#[ignore = "needs LIGGGHTS and mpirun"]
fn meshed_drum_in_liggghts_stands_within_micrometres_of_ours() {
    let text = format!(
        "(title: \"A meshed drum\", materials: {{\"glass\": (), \"drum\": (friction: 0.5)}}, container: Mesh({}, material: \
         \"drum\", motion: Turning(axis: (0, 0, 1), speed_rpm: 4)), \
         grains: Fill(count: 90, species: [(radius_mm: 2, material: \"glass\")]))",
        key(&drum(0.03, 0.012, 360))
    );
    let scene = Scene::parse("meshed drum", &text).unwrap();
    stands_beside(scene, &[], MpiEngine::Liggghts, 10e-6);
}

#[test]
#[ignore = "needs LAMMPS and mpirun"]
fn dry_drum_in_lammps_stands_within_micrometres_of_ours() {
    stands_beside(Scene::open("dry-r3").unwrap(), &[], MpiEngine::Lammps, 3e-6);
}
