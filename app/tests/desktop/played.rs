//! Claims about recordings in the app: a run's folder opens as a person opens it, plays to its end,
//! pauses and draws its grains; what takes a run is answered with the way to one.

use crate::view::{laboratory, studio};
use crate::window_of_panels::standing;
use crate::windowless::{ask, simulation, until, update_until, without_scene};
use bevy::math::UVec2;
use bevy::prelude::*;
use grainfall::lab::Status;
use grainfall::recording::Recording;
use grainfall::run::{Command, Parameter};
use grainfall::runner;
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Dock, FilmState, PictureOf, Request, ScreenshotOrder, ScreenshotOrders};
use grainfall_app::window::{PictureJob, ScreenshotPlugin, WindowJob, run};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The folder of a run in which a grain falls on a floor.
fn recorded() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("bounce");
    let mut scene = Scene::open("bouncing-grain").unwrap();
    let values = [("duration", "100ms"), ("output-interval", "10ms")];
    scene.set_all(&values).unwrap();
    let job = runner::Job::new("bounce", scene, &out);
    runner::run(&job, &mut (), &|| false).unwrap();
    (folder, out)
}

/// The app with everything but pictures, in which `name` was opened.
fn app(name: &Path) -> App {
    let mut app = without_scene();
    ask(&mut app, Request::Open(name.display().to_string()));
    update_until(&mut app, |simulation| simulation.world().is_some());
    app
}

#[test]
fn a_runs_folder_plays_to_its_end_and_leads_to_a_run() {
    let (_folder, out) = recorded();
    let mut app = app(&out.join("grains.pvd"));
    assert_eq!(simulation(&app).status(), &Status::Paused);
    ask(&mut app, Request::Command(Command::Play));
    until(&mut app, |app| {
        let shown = simulation(app);
        shown.step() == shown.past().end.step && *shown.status() == Status::Paused
    });
    let last = simulation(&app).world().unwrap().time();
    assert!((last - 0.1).abs() < 1e-3, "{last}");
    // What takes a run is answered, and sends nothing.
    let gravity = Command::Set {
        parameter: Parameter::Gravity,
        value: 1.0.into(),
    };
    for request in [Request::Command(gravity), Request::Save] {
        ask(&mut app, request);
        let said = app.world().resource::<Dock>().notice().unwrap_or_default();
        assert!(said.contains("Run anew"), "{said}");
    }
    assert_eq!(simulation(&app).warnings(), [""; 0]);
    ask(&mut app, Request::RunAnew);
    until(&mut app, is_run);
    assert_eq!(simulation(&app).step(), 0);
    assert_eq!(simulation(&app).parameters().len(), {
        let recording = Recording::open(&out).unwrap();
        recording.parameters().len()
    });
}

fn is_run(app: &App) -> bool {
    let run = simulation(app);
    run.recording().is_none() && run.world().is_some()
}

#[test]
fn a_run_goes_on_from_a_moment_of_a_recording() {
    let (_folder, out) = recorded();
    let mut app = app(&out);
    let end = simulation(&app).past().end.step;
    ask(&mut app, Request::Command(Command::Seek(end)));
    until(&mut app, |app| {
        simulation(app).step() == end && simulation(app).has_answered()
    });
    let grains = simulation(&app).world().unwrap().grains.clone();
    ask(&mut app, Request::RunOn);
    until(&mut app, is_run);
    let begun = simulation(&app).world().unwrap();
    assert_eq!(begun.time(), 0.0);
    assert_eq!(begun.grains.position, grains.position);
    assert_eq!(begun.grains.velocity, grains.velocity);
    assert!(simulation(&app).scene().title.contains("from t = 0.100 s"));
}

#[test]
fn a_film_of_a_recording_keeps_its_time_and_ends_with_it() {
    let Some(_studio) = studio() else {
        return;
    };
    let (folder, out) = recorded();
    let mut app = laboratory(UVec2::new(160, 120), standing(), ScreenshotPlugin);
    let recording = Recording::open(&out).unwrap();
    app.insert_resource(Simulation::play_back(recording, standing()));
    until(&mut app, |app| simulation(app).world().is_some());
    let film = folder.path().join("film");
    (app.world_mut().resource_mut::<ScreenshotOrders>())
        .asked
        .push(ScreenshotOrder::Film(crate::recording::film(&film, 0.5)));
    let state = |app: &App| app.world().resource::<ScreenshotOrders>().film;
    until(&mut app, |app| {
        matches!(state(app), FilmState::Recording { pictures: 1, .. })
    });
    (app.world_mut().resource_mut::<Simulation>()).send(Command::Play);
    until(&mut app, |app| state(app) == FilmState::Idle);
    // One each 20 ms of 100 ms, the first and the last included.
    assert_eq!(std::fs::read_dir(&film).unwrap().count(), 6);
}

#[test]
fn the_last_state_of_a_recording_is_drawn() {
    let Some(_studio) = studio() else {
        return;
    };
    let (folder, out) = recorded();
    let path = folder.path().join("recording.png");
    let job = WindowJob {
        name: out.display().to_string(),
        opened: Recording::open(&out).unwrap().into(),
        threads: None,
        script: Vec::new(),
        compared: None,
        picture: Some(PictureJob {
            path: path.clone(),
            // Beyond its end: its last state.
            at: 1.0,
            size: UVec2::new(1280, 720),
            offscreen: true,
            of: PictureOf::Grains,
        }),
    };
    run(job).unwrap();
    let picture = image::open(&path).unwrap().to_rgb8();
    let amber = picture
        .pixels()
        .filter(|p| p[0] > 120 && p[0].saturating_sub(p[2]) > 80);
    assert!(amber.count() > 300);
}
