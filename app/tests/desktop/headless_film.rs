//! Claims about films without a window: each has a picture for every 25th of a second, of the size
//! asked for, and the run that is filmed is the one that is not.

use crate::recording::pictures_in;
use crate::view::studio;
use bevy::math::UVec2;
use grainfall::output::Ending;
use grainfall::recording::Recording;
use grainfall::runner::{self, Job, exit};
use grainfall::scene::Scene;
use grainfall_app::headless::Report;
use grainfall_app::window::{FilmJob, film_recording, film_run};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

const SIZE: UVec2 = UVec2::new(160, 120);

fn film(path: PathBuf) -> FilmJob {
    FilmJob {
        path,
        at: 0.0,
        speed: Some(0.5),
        rate: 25.0,
        size: SIZE,
        plain: false,
    }
}

/// A grain that falls for a tenth of a second, a state each fiftieth.
fn job(out: &Path) -> Job {
    let mut scene = Scene::open("bouncing-grain").unwrap();
    scene.set("duration", "100ms").unwrap();
    scene.set("output-interval", "20ms").unwrap();
    Job {
        threads: 1,
        checkpoints: true,
        ..Job::new("grain", scene, out)
    }
}

/// The pictures in the folder at `path`.
fn pictures(path: &Path) -> Vec<image::RgbImage> {
    let names = pictures_in(path).into_iter();
    names
        .map(|name| image::open(name).unwrap().to_rgb8())
        .collect()
}

#[test]
fn film_of_a_run_has_its_pictures_and_the_run_its_bits() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let [filmed, plain] = ["filmed", "plain"].map(|name| folder.path().join(name));
    let path = folder.path().join("film");
    let go_on = AtomicBool::new(false);
    let ending = film_run(&job(&filmed), &film(path.clone()), Report::Quiet, &go_on).unwrap();
    assert_eq!(ending, Ending::Done);
    // At half of real time a picture stands for a fiftieth of a second: at 0, 20 … 100 ms.
    let pictures_of_run = pictures(&path);
    assert_eq!(pictures_of_run.len(), 6);
    for picture in &pictures_of_run {
        assert_eq!(picture.dimensions(), SIZE.into());
    }
    assert!(pictures_of_run[0] != pictures_of_run[5], "it has fallen");
    runner::run(&job(&plain), &mut (), &|| false).unwrap();
    let state = |out: &Path| {
        let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
        [summary["state_hash"].clone(), summary["files"].clone()]
    };
    assert_eq!(state(&filmed), state(&plain));
    // It is done by now: a film would begin nowhere, and is made of its states instead.
    let other = folder.path().join("other");
    let refused = film_run(&job(&filmed), &film(other.clone()), Report::Quiet, &go_on);
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("--restart"), "{refused}");
    let recording = Recording::open(&filmed).unwrap();
    let code = film_recording(recording, &film(other.clone()), Report::Quiet, &go_on).unwrap();
    assert_eq!(code, exit::DONE);
    assert_eq!(pictures(&other).len(), 6);
}

#[test]
fn interrupted_run_leaves_no_film() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (out, path) = (folder.path().join("out"), folder.path().join("film.gif"));
    let stop = AtomicBool::new(true);
    let ending = film_run(&job(&out), &film(path.clone()), Report::Quiet, &stop).unwrap();
    assert_eq!(ending, Ending::Interrupted);
    assert!(!path.exists());
}
