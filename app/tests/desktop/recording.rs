//! Claims about films: every picture of one stands at its simulated time, and a film is whole or
//! not there.

use crate::view::{laboratory, studio};
use crate::window_of_panels::standing;
use crate::windowless::until;
use bevy::math::UVec2;
use bevy::prelude::*;
use grainfall::parameters::Parameter;
use grainfall::run::Command;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{
    FilmOrder, FilmSpan, FilmState, PictureOf, PictureOrder, ScreenshotOrder, ScreenshotOrders,
};
use grainfall_app::view::{FILM_RATE, Pace, ViewSettings};
use grainfall_app::window::ScreenshotPlugin;
use std::path::{Path, PathBuf};

/// A film of the picture from now on at `speed` times real time.
pub fn film(path: &Path, speed: f64) -> FilmOrder {
    FilmOrder {
        path: path.to_owned(),
        of: PictureOf::Picture,
        size: None,
        pace: Pace {
            rate: FILM_RATE,
            speed,
        },
        span: FilmSpan::FromNow,
    }
}

/// A picture of this, as large as in the window.
pub fn picture(path: &Path, of: PictureOf) -> ScreenshotOrder {
    ScreenshotOrder::Picture(PictureOrder {
        path: path.to_owned(),
        of,
        size: None,
    })
}

/// A laboratory that takes pictures.
pub fn studio_with_camera() -> App {
    laboratory(UVec2::new(160, 120), standing(), ScreenshotPlugin)
}

/// The pictures in the folder at `path`, in order.
pub fn pictures_in(path: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(path).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    names.sort();
    names
}

pub fn order(app: &mut App, order: ScreenshotOrder) {
    (app.world_mut().resource_mut::<ScreenshotOrders>())
        .asked
        .push(order);
}

pub fn state(app: &App) -> FilmState {
    app.world().resource::<ScreenshotOrders>().film
}

fn pictures(app: &App) -> usize {
    match state(app) {
        FilmState::Recording { pictures, .. } => pictures,
        _ => 0,
    }
}

/// Records the state that stands, then what follows, until there are `count` pictures.
fn record(app: &mut App, path: &Path, count: usize) {
    (app.world_mut().resource_mut::<Simulation>()).send(Command::Speed(1.0));
    order(app, ScreenshotOrder::Film(film(path, 1.0)));
    until(app, |app| pictures(app) == 1);
    (app.world_mut().resource_mut::<Simulation>()).send(Command::Play);
    until(app, |app| pictures(app) >= count);
}

#[test]
fn film_has_a_picture_for_every_frame_of_simulated_time() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film");
    let mut app = studio_with_camera();
    let begun = app.world().resource::<Simulation>().world().unwrap().time();
    record(&mut app, &path, 4);
    let FilmState::Recording { pictures, time } = state(&app) else {
        panic!("{:?}", state(&app));
    };
    // One 25th of a second from picture to picture, to a step.
    let expected = (pictures - 1) as f64 / FILM_RATE;
    assert!((time - expected).abs() < 1e-3, "{time} {expected}");
    // The run waits for its next picture.
    let world = app
        .world()
        .resource::<Simulation>()
        .world()
        .unwrap()
        .clone();
    let reached = (world.time() - begun) * FILM_RATE;
    assert!(reached < pictures as f64 + 0.01, "{reached}");
    order(&mut app, ScreenshotOrder::EndFilm);
    until(&mut app, |app| state(app) == FilmState::Idle);
    let written: Vec<_> = std::fs::read_dir(&path).unwrap().collect();
    assert!(written.len() >= 4, "{}", written.len());
    let [first, last] = ["00000.png", "00003.png"].map(|name| {
        let picture = image::open(path.join(name)).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (160, 120));
        picture
    });
    assert!(first != last, "the grain has fallen");
    // Afterwards the run goes on by itself.
    let before = app.world().resource::<Simulation>().step();
    until(&mut app, |app| {
        app.world().resource::<Simulation>().step() > before
    });
}

#[test]
fn film_keeps_its_pace_where_the_time_step_changes() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut app = studio_with_camera();
    let now = |app: &App| {
        app.world()
            .resource::<Simulation>()
            .world()
            .unwrap()
            .clone()
    };
    let (begun, step) = (now(&app).time(), now(&app).clock.time_step);
    record(&mut app, &folder.path().join("film"), 2);
    (app.world_mut().resource_mut::<Simulation>()).send(Command::Set {
        parameter: Parameter::TimeStep,
        value: (0.25 * step).into(),
    });
    let so_far = pictures(&app);
    until(&mut app, |app| pictures(app) >= so_far + 4);
    // The run waits for its next picture, one 25th of a second after the last one.
    let taken = pictures(&app) as f64;
    until(&mut app, |app| {
        pictures(app) as f64 > taken || (now(app).time() - begun) * FILM_RATE > taken - 1.01
    });
    let reached = (now(&app).time() - begun) * FILM_RATE;
    let taken = pictures(&app) as f64;
    assert!(
        taken - 2.0 < reached && reached < taken + 0.01,
        "{reached} {taken}"
    );
    assert_eq!(now(&app).clock.time_step, 0.25 * step);
    order(&mut app, ScreenshotOrder::CancelFilm);
    until(&mut app, |app| state(app) == FilmState::Idle);
}

#[test]
fn cancelled_film_leaves_nothing_and_lets_the_run_go() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut app = studio_with_camera();
    record(&mut app, &folder.path().join("film.gif"), 2);
    order(&mut app, ScreenshotOrder::CancelFilm);
    until(&mut app, |app| state(app) == FilmState::Idle);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    // A film of a kind that there is not is refused.
    order(
        &mut app,
        ScreenshotOrder::Film(film(&folder.path().join("film.avi"), 1.0)),
    );
    app.update();
    app.update();
    assert_eq!(state(&app), FilmState::Idle);
}

#[test]
fn picture_is_taken_beside_a_film_and_shows_the_state_that_it_names() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let [path, saved] = ["film.gif", "picture.png"].map(|name| folder.path().join(name));
    let mut app = studio_with_camera();
    record(&mut app, &path, 2);
    order(&mut app, picture(&saved, PictureOf::Window));
    until(&mut app, |_| saved.exists());
    let size = image::open(&saved).unwrap().to_rgb8().dimensions();
    assert_eq!(size, (160, 120));
    assert!(pictures(&app) >= 2, "the film goes on: {:?}", state(&app));
    order(&mut app, ScreenshotOrder::EndFilm);
    until(&mut app, |app| state(app) == FilmState::Idle);
    assert!(path.exists());
}

#[test]
fn grains_without_a_background_are_taken_of_a_window_that_looks_as_before() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let [path, saved] = ["film.gif", "picture.png"].map(|name| folder.path().join(name));
    let mut app = studio_with_camera();
    let before = app.world().resource::<ViewSettings>().clone();
    order(&mut app, picture(&saved, PictureOf::CutOut));
    until(&mut app, |_| saved.exists());
    app.update();
    let image = image::open(&saved).unwrap().to_rgba8();
    assert!(image.pixels().any(|pixel| pixel[3] == 0) && image.pixels().any(|p| p[3] == 255));
    let after = app.world().resource::<ViewSettings>();
    assert_eq!(
        (after.show_overlay, after.show_measured),
        (before.show_overlay, before.show_measured)
    );
    // A film has the window for itself.
    record(&mut app, &path, 1);
    let second = folder.path().join("second.png");
    order(&mut app, picture(&second, PictureOf::CutOut));
    let taken = pictures(&app);
    until(&mut app, |app| pictures(app) > taken + 2);
    assert!(!second.exists());
}
