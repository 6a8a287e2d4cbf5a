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
use grainfall_app::ui::PictureOf;
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
        threads: None,
        script: Vec::new(),
        compared: None,
        picture: Some(PictureJob {
            path: path.to_owned(),
            at: 0.05,
            size: UVec2::new(1280, 720),
            offscreen: true,
            of: PictureOf::Window,
        }),
    }
}

/// The texts in a picture by their names.
pub fn words(path: &Path) -> BTreeMap<String, String> {
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
    let Some(_studio) = studio() else {
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

/// `front` laid on `ground`, as browsers do.
fn laid(front: image::Rgba<u8>, ground: [u8; 3]) -> [u8; 3] {
    let alpha = f64::from(front[3]) / 255.0;
    [0, 1, 2].map(|channel| {
        let [front, ground] = [front[channel], ground[channel]].map(f64::from);
        (alpha * front + (1.0 - alpha) * ground).round() as u8
    })
}

#[test]
fn grains_without_a_background_look_the_same_on_another_one() {
    let Some(_studio) = studio() else {
        return;
    };
    let taken = |name: &str, of: PictureOf| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let mut job = job(&path);
        if let Some(picture) = &mut job.picture {
            (picture.of, picture.size) = (of, UVec2::new(640, 480));
        }
        run(job).unwrap();
        image::open(&path).unwrap()
    };
    let whole = taken("grains.png", PictureOf::Grains);
    assert!(!whole.color().has_alpha());
    let cut_out = taken("cut-out.png", PictureOf::CutOut);
    assert!(cut_out.color().has_alpha());
    let (whole, cut_out) = (whole.to_rgb8(), cut_out.to_rgba8());
    assert_eq!(whole.dimensions(), cut_out.dimensions());
    // The corner is ground alone, the middle of the grain hides it, its edge does in part.
    let ground = whole.get_pixel(1, 1).0;
    assert_eq!(cut_out.get_pixel(1, 1)[3], 0);
    let alphas = || cut_out.pixels().map(|pixel| pixel[3]);
    assert!(alphas().filter(|alpha| *alpha == 255).count() > 300);
    let edges = alphas().filter(|alpha| (20..235).contains(alpha)).count();
    assert!(edges > 30, "{edges} pixels at edges");
    // Laid on that ground it is the picture: the renderer blends light, a browser its sRGB numbers,
    // which are apart by less than 50 of 255 at half a pixel, and nowhere else.
    let differences = whole.pixels().zip(cut_out.pixels()).map(|(seen, front)| {
        let laid = laid(*front, ground);
        let channels = laid.iter().zip(seen.0).map(|(a, b)| a.abs_diff(b));
        (channels.max().unwrap_or(0), front[3])
    });
    for (difference, alpha) in differences {
        let most = if matches!(alpha, 0 | 255) { 3 } else { 50 };
        assert!(difference <= most, "{difference} at alpha {alpha}");
    }
}

#[test]
fn picture_that_cannot_be_written_is_told() {
    let Some(_studio) = studio() else {
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
