//! Claims about the program as a whole: it draws itself without a display, and says why where it
//! cannot.

use crate::timeline::carried_out;
use crate::view::studio;
use crate::window_of_panels::ready;
use bevy::math::UVec2;
use grainfall::lab::{DriverKind, Options};
use grainfall::run::Command;
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::window::{PictureJob, WindowError, WindowJob, run};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// A grain before a floor, listed one by one, so that nothing must settle.
fn job(path: &Path) -> WindowJob {
    WindowJob {
        name: "bouncing-grain".to_owned(),
        opened: Scene::open("bouncing-grain").unwrap().into(),
        options: Options::window(),
        compared: None,
        picture: Some(PictureJob {
            path: path.to_owned(),
            at: 0.05,
            size: UVec2::new(1280, 720),
            offscreen: true,
            plain: false,
        }),
    }
}

/// The texts in a picture by their names.
fn words(path: &Path) -> BTreeMap<String, String> {
    let file = BufReader::new(File::open(path).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    let texts = reader.info().utf8_text.iter();
    texts
        .map(|chunk| (chunk.keyword.clone(), chunk.get_text().unwrap()))
        .collect()
}

/// Hash of the grain's state after so many steps, computed again.
fn state_at(step: &str) -> String {
    let options = Options {
        driver: DriverKind::Inline,
        autoplay: false,
        threads: 1,
        ..Options::window()
    };
    let scene = Scene::open("bouncing-grain").unwrap();
    let mut simulation = ready(Simulation::open(scene, options));
    carried_out(&mut simulation, Command::Step(step.parse().unwrap()));
    simulation.world().unwrap().hash().to_string()
}

#[test]
fn laboratory_draws_itself_without_a_display() {
    let Some(_studio) = studio("laboratory_draws_itself_without_a_display") else {
        return;
    };
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("laboratory.png");
    run(job(&path)).unwrap();
    let picture = image::open(&path).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (1280, 720));
    let opened = Scene::open("bouncing-grain").unwrap();
    let chunks = words(&path);
    assert_eq!(chunks["Title"], opened.title);
    assert_eq!(chunks["Seed"], opened.seed.to_string());
    let time: f64 = chunks["Time"].trim_end_matches(" s").parse().unwrap();
    assert!((0.05..0.0501).contains(&time), "{time}");
    assert_eq!(chunks["State hash"], state_at(&chunks["Step"]));
    // The grain is amber; nothing else in the window has so much more red than blue over so many
    // pixels.
    let amber = picture
        .pixels()
        .filter(|p| p[0] > 120 && p[0].saturating_sub(p[2]) > 80)
        .count();
    assert!(amber > 300, "{amber} pixels of the grain");
    // Panels stand left and right: their text is bright.
    for columns in [0..280, 960..1280] {
        let bright = picture
            .enumerate_pixels()
            .filter(|(x, _, p)| columns.contains(x) && p[1] > 180)
            .count();
        assert!(
            bright > 300,
            "{bright} bright pixels in columns {columns:?}"
        );
    }
}

#[test]
fn picture_that_cannot_be_written_is_told() {
    let Some(_studio) = studio("picture_that_cannot_be_written_is_told") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let error = run(job(&file.join("picture.png"))).unwrap_err();
    assert!(matches!(error, WindowError::Picture(_)), "{error}");
    assert!(error.to_string().contains("picture.png"), "{error}");
    assert_eq!(error.exit_code(), 1);
}
