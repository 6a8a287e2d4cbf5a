//! Claims about pictures and films whose size, rate and span a person chose: what is in the file is
//! what was asked for, and the window and the run are afterwards as before.

use crate::recording::{film, order, pictures_in, state, studio_with_camera};
use crate::timeline::carried_out;
use crate::view::{laboratory, panel_camera, studio};
use crate::window::words;
use crate::window_of_panels::standing;
use crate::windowless::{simulation, until};
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy_egui::EguiPlugin;
use grainfall::lab::Status;
use grainfall::run::Command;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{
    FilmOrder, FilmSpan, FilmState, PictureOf, PictureOrder, ScreenshotOrder, UiPlugin,
};
use grainfall_app::view::{FilmKind, Pace};
use grainfall_app::window::ScreenshotPlugin;
use image::RgbaImage;
use std::path::Path;

/// Takes a picture of this `size` [pixels] and reads it back.
fn taken(app: &mut App, path: &Path, of: PictureOf, size: UVec2) -> image::DynamicImage {
    let path = path.to_owned();
    let asked = PictureOrder {
        path: path.clone(),
        of,
        size: Some(size),
    };
    order(app, ScreenshotOrder::Picture(asked));
    until(app, |_| path.exists());
    app.update();
    image::open(&path).unwrap()
}

/// Width and height of the box round all pixels of which `is_grain` [pixels].
fn extent(picture: &RgbaImage, is_grain: impl Fn(&image::Rgba<u8>) -> bool) -> [u32; 2] {
    let grains = || picture.enumerate_pixels().filter(|(_, _, p)| is_grain(p));
    let range = |side: fn(u32, u32) -> u32| {
        let least = grains().map(|(x, y, _)| side(x, y)).min().unwrap();
        grains().map(|(x, y, _)| side(x, y)).max().unwrap() - least + 1
    };
    [range(|x, _| x), range(|_, y| y)]
}

/// A grain is amber: much more red than blue.
fn is_amber(image::Rgba(pixel): image::Rgba<u8>) -> bool {
    pixel[0] > 120 && pixel[0].saturating_sub(pixel[2]) > 80
}

#[test]
fn a_picture_has_the_size_that_was_chosen_and_is_drawn_at_it() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    // The window has 160 × 120 pixels.
    let mut app = studio_with_camera();
    let mut grains = |name: &str, size| {
        let picture = taken(&mut app, &folder.path().join(name), PictureOf::Grains, size);
        assert_eq!(UVec2::new(picture.width(), picture.height()), size);
        picture.to_rgba8()
    };
    let [small, large] = [
        grains("small.png", UVec2::new(160, 120)),
        grains("large.png", UVec2::new(1600, 1200)),
    ];
    let [small_grain, large_grain] =
        [&small, &large].map(|picture| extent(picture, |p| is_amber(*p)));
    // A pixel more or less at each edge of the small one.
    for (small, large) in small_grain.into_iter().zip(large_grain) {
        assert!((10 * small).abs_diff(large) <= 20, "{small} {large}");
    }
    // Scaled up, ten columns side by side would be equal.
    let is_edge = |x: u32, y: u32| large[(x, y)] != large[(x + 1, y)];
    let columns = (0..1599).filter(|x| (0..1200).step_by(7).any(|y| is_edge(*x, y)));
    let between = columns.filter(|x| x % 10 != 9).count();
    assert!(
        between > 50,
        "{between} columns differ within blocks of ten"
    );
    // Another shape shows the whole grain, round.
    let wide = grains("wide.png", UVec2::new(901, 301));
    let [width, height] = extent(&wide, |p| is_amber(*p));
    assert!(width.abs_diff(height) <= 3, "{width} {height}");
}

#[test]
fn a_picture_without_a_background_is_clear_in_a_corner_and_solid_on_a_grain() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut app = studio_with_camera();
    let path = folder.path().join("cut-out.png");
    let picture = taken(&mut app, &path, PictureOf::CutOut, UVec2::new(1280, 720));
    assert!(picture.color().has_alpha());
    let picture = picture.to_rgba8();
    assert_eq!(picture.dimensions(), (1280, 720));
    assert_eq!(picture[(1, 1)][3], 0);
    let grain: Vec<_> = (picture.pixels().filter(|p| p[3] > 0 && is_amber(**p))).collect();
    let solid = grain.iter().filter(|p| p[3] == 255).count();
    assert!(
        solid > 300 && 10 * solid > 8 * grain.len(),
        "{solid} of {}",
        grain.len()
    );
}

#[test]
fn the_whole_window_is_laid_out_anew_for_a_picture_of_another_size() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let options = standing();
    let panels = UiPlugin {
        options: options.clone(),
    };
    let plugins = (
        EguiPlugin::default(),
        panel_camera,
        ScreenshotPlugin,
        panels,
    );
    let mut app = laboratory(UVec2::new(1024, 640), options, plugins);
    for _ in 0..10 {
        app.update();
    }
    let path = folder.path().join("window.png");
    let picture = taken(&mut app, &path, PictureOf::Window, UVec2::new(1600, 900)).to_rgba8();
    assert_eq!(picture.dimensions(), (1600, 900));
    // Panels stand left and right, with bright text, and the grain between them.
    for columns in [0..280, 1280..1600] {
        let text = picture.enumerate_pixels();
        let text = text
            .filter(|(x, _, p)| columns.contains(x) && p[1] > 180)
            .count();
        assert!(text > 300, "{text} bright pixels in columns {columns:?}");
    }
    let marks = folder.path().join("marks.png");
    let marked = taken(&mut app, &marks, PictureOf::Picture, UVec2::new(640, 480)).to_rgba8();
    let plain = folder.path().join("plain.png");
    let plain = taken(&mut app, &plain, PictureOf::Grains, UVec2::new(640, 480)).to_rgba8();
    // The scale bar stands in the lower left corner of the one that has marks.
    let bright = |picture: &RgbaImage| {
        let corner = picture.enumerate_pixels();
        let corner = corner.filter(|(x, y, p)| *x < 220 && *y > 400 && p[1] > 150);
        corner.count()
    };
    assert!(
        bright(&marked) > 50 + bright(&plain),
        "{} {}",
        bright(&marked),
        bright(&plain)
    );
}

/// A laboratory whose grain has fallen for a tenth of a second and whose present moment is `shown`
/// [s].
fn fallen(shown: f64) -> App {
    let mut app = studio_with_camera();
    let mut run = app.world_mut().resource_mut::<Simulation>();
    let clock = run.world().unwrap().clock;
    carried_out(&mut run, Command::Step(clock.step_at(0.1)));
    carried_out(&mut run, Command::Seek(clock.step_at(shown)));
    app
}

/// A film of what is recorded from 20 ms to 80 ms, ten frames a second, a tenth as fast as the run.
fn of_the_past(path: &Path, of: PictureOf) -> FilmOrder {
    FilmOrder {
        of,
        size: Some(UVec2::new(321, 241)),
        pace: Pace {
            rate: 10.0,
            speed: 0.1,
        },
        span: FilmSpan::Recorded {
            from: 0.02,
            to: 0.08,
        },
        ..film(path, 1.0)
    }
}

#[test]
fn a_film_of_what_is_recorded_has_its_moments_and_leaves_the_run_where_it_was() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film");
    let mut app = fallen(0.05);
    let before = simulation(&app).world().unwrap().clone();
    let end = simulation(&app).past().end;
    order(
        &mut app,
        ScreenshotOrder::Film(of_the_past(&path, PictureOf::CutOut)),
    );
    until(&mut app, |app| {
        matches!(
            state(app),
            FilmState::Replaying {
                pictures: 3,
                all: 7
            }
        )
    });
    until(&mut app, |app| state(app) == FilmState::Idle);
    // 20, 30 … 80 ms.
    let written = pictures_in(&path);
    assert_eq!(written.len(), 7);
    let mut last = None;
    for (number, picture) in written.iter().enumerate() {
        let time: f64 = words(picture)["Time"]
            .trim_end_matches(" s")
            .parse()
            .unwrap();
        let due = 0.02 + 0.01 * number as f64;
        // The step that is nearest to its time.
        let apart = (time - due).abs();
        assert!(apart <= 0.501 * before.clock.time_step, "{time} {due}");
        let picture = image::open(picture).unwrap().to_rgba8();
        assert_eq!(picture.dimensions(), (321, 241));
        assert_eq!(picture[(1, 1)][3], 0);
        assert!(picture.pixels().any(|p| p[3] == 255 && is_amber(*p)));
        assert!(last.as_ref() != Some(&picture), "it falls");
        last = Some(picture);
    }
    until(&mut app, |app| {
        simulation(app).has_answered() && *simulation(app).status() == Status::Paused
    });
    assert_eq!(simulation(&app).world().unwrap().hash(), before.hash());
    assert_eq!(simulation(&app).past().end, end);
}

#[test]
fn a_film_of_what_is_recorded_can_be_stopped_or_cancelled_halfway() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for (ends, is_there) in [
        (ScreenshotOrder::EndFilm, true),
        (ScreenshotOrder::CancelFilm, false),
    ] {
        let path = folder.path().join(format!("film-{is_there}"));
        let mut app = fallen(0.1);
        let before = simulation(&app).step();
        order(
            &mut app,
            ScreenshotOrder::Film(of_the_past(&path, PictureOf::Grains)),
        );
        until(&mut app, |app| {
            matches!(state(app), FilmState::Replaying { pictures: 3, .. })
        });
        order(&mut app, ends);
        until(&mut app, |app| state(app) == FilmState::Idle);
        assert_eq!(path.exists(), is_there);
        if is_there {
            assert!((3..7).contains(&pictures_in(&path).len()));
        }
        until(&mut app, |app| *simulation(app).status() == Status::Paused);
        assert_eq!(simulation(&app).step(), before);
    }
}

#[test]
fn a_gif_has_the_rate_and_the_size_that_were_chosen() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.gif");
    let mut app = fallen(0.1);
    order(
        &mut app,
        ScreenshotOrder::Film(of_the_past(&path, PictureOf::Picture)),
    );
    until(&mut app, |app| {
        state(app) == FilmState::Idle && path.exists()
    });
    let mut decoder = gif::DecodeOptions::new()
        .read_info(std::fs::File::open(&path).unwrap())
        .unwrap();
    assert_eq!((decoder.width(), decoder.height()), (321, 241));
    let mut delays = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        delays.push(frame.delay);
    }
    assert_eq!(delays, [10; 7]);
}

/// What ffprobe says of the video at `path`: codec, width, height, rate, frames.
fn probed(path: &Path) -> String {
    let mut probe = std::process::Command::new("ffprobe");
    let entries = "stream=codec_name,width,height,r_frame_rate,nb_read_frames";
    probe.args(["-v", "error", "-count_frames", "-show_entries", entries]);
    probe.args(["-of", "csv=p=0"]).arg(path);
    String::from_utf8(probe.output().unwrap().stdout)
        .unwrap()
        .trim()
        .to_owned()
}

#[test]
fn a_transparent_video_has_its_frames() {
    let Some(_studio) = studio() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for (name, said) in [
        ("film.webm", "vp9,320,240,10/1,7"),
        ("film.mov", "prores,320,240,10/1,7"),
    ] {
        let path = folder.path().join(name);
        // What this machine cannot encode is refused in words, as a test of its own claims.
        if FilmKind::of(&path).is_err() {
            continue;
        }
        let mut app = fallen(0.1);
        order(
            &mut app,
            ScreenshotOrder::Film(of_the_past(&path, PictureOf::CutOut)),
        );
        until(&mut app, |app| {
            state(app) == FilmState::Idle && path.exists()
        });
        assert_eq!(probed(&path), said);
    }
}
