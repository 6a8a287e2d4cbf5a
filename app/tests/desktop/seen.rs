//! Claims about what can be seen of a bed and its grains: the flowing layer, the temperature of each
//! cell, the drum's mark, where grains were when their run began, forces by their colour, what is wet.

use crate::measured::{camera, pictures, pointed_with};
use crate::timeline::carried_out;
use crate::view::{
    Photograph, SIZE, cosine, drum_of_grains, pair, photograph, photograph_of, studio, world,
};
use crate::window_of_panels::{ready, standing};
use bevy::math::{Vec2, Vec3};
use bevy_egui::egui;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use grainfall::lab::Kept;
use grainfall::measure::{FlowDepth, MeanFlow, NON_RIGID_TEMPERATURE, temperature_map};
use grainfall::physics::LIQUID_CASES;
use grainfall::run::Command;
use grainfall::runner;
use grainfall::scene::Scene;
use grainfall::world::{Shape, SpeciesId, Surface};
use grainfall_app::simulation::Simulation;
use grainfall_app::view::{
    CameraRequest, ColourBy, ColourMap, FlowLines, Measured, ProjectionKind, StandardView,
    StartPlace, ViewSettings,
};
use std::sync::Arc;

/// A layer that flows down 8 mm deep, over a bed that goes up.
fn flow() -> MeanFlow {
    let depth = |k: u32| {
        let depth = 0.001 * f64::from(k);
        FlowDepth {
            depth,
            velocity: 0.1 * (depth / 0.008 - 1.0),
            error: None,
            samples: 3,
        }
    };
    MeanFlow {
        depths: (0..40).map(depth).collect(),
    }
}

#[test]
fn the_flowing_layer_lies_below_the_surface_as_deep_as_it_is() {
    let surface = Measured::of(&drum_of_grains()).surface.unwrap();
    let lines = FlowLines::of(&surface, &flow(), 0.011).unwrap();
    assert!((lines.depth - 0.008).abs() < 1e-12, "{}", lines.depth);
    let [upper, lower] = lines.edges.map(|edge| edge.map(Vec3::as_dvec3));
    // A micrometre: single precision.
    for (above, below) in upper.iter().zip(&lower) {
        assert!((above.distance(*below) - 0.008).abs() < 1e-6);
    }
    let slope = |[from, to]: [DVec3; 2]| ((to.y - from.y) / (to.x - from.x)).atan();
    assert!((slope(lower) - surface.angle).abs() < 1e-5);
    // As long as the velocity is large: down the slope above, up below, none at the edge.
    let along = |[from, to]: [Vec3; 2]| (to - from).as_dvec3().truncate().dot(surface.direction);
    let first = along(lines.arrows[0]);
    assert!(first < 0.0, "{first}");
    for (k, arrow) in lines.arrows.iter().enumerate() {
        let expected = first * (1.0 - 4.0 * k as f64 / 8.0);
        assert!((along(*arrow) - expected).abs() < 1e-6, "{k}");
    }
    assert_eq!(lines.arrows.len(), 4, "to twice its depth");
}

#[test]
fn the_flowing_layer_in_the_picture_tells_its_depth_and_how_it_is_measured() {
    let world = Arc::new(drum_of_grains());
    let measured = Measured::of(&world);
    let surface = measured.surface.unwrap();
    let lines = FlowLines::of(&surface, &flow(), 0.011).unwrap();
    let settings = ViewSettings {
        show_flow: true,
        show_measured: false,
        measured: [
            measured.with_flow(Some(Arc::new(flow()))),
            Measured::NOTHING,
        ],
        ..ViewSettings::default()
    };
    let (at, _) = camera().project(lines.bracket[1]).unwrap();
    let harness = pointed_with(settings, &world, egui::pos2(at.x, at.y));
    harness.get_by_label_contains("changes its sign");
    let drawn = harness
        .output()
        .shapes
        .iter()
        .any(|clipped| match &clipped.shape {
            // Lengths in the picture have three digits, zeros at their end left out.
            egui::Shape::Text(text) => text.galley.text() == "flowing layer 8 mm",
            _ => false,
        });
    assert!(drawn);
}

#[test]
fn the_mark_of_a_drum_says_what_it_is_and_how_far_it_has_turned() {
    let mut turned = drum_of_grains();
    turned.container.angle = 0.5;
    let world = Arc::new(turned);
    let (sin, cos) = 0.5_f32.sin_cos();
    let on_mark = 0.9 * 0.0605 * Vec3::new(cos, sin, 0.0) + 0.011 * Vec3::Z;
    let (at, _) = camera().project(on_mark).unwrap();
    let harness = pointed_with(ViewSettings::default(), &world, egui::pos2(at.x, at.y));
    harness.get_by_label_contains("turns with the drum");
    let settings = ViewSettings {
        measured: [Measured::of(&world), Measured::NOTHING],
        ..ViewSettings::default()
    };
    let harness = pointed_with(settings, &world, egui::pos2(1.0, 1.0));
    let drawn = harness
        .output()
        .shapes
        .iter()
        .any(|clipped| match &clipped.shape {
            egui::Shape::Text(text) => text.galley.text() == "turned 29°",
            _ => false,
        });
    assert!(drawn, "0.5 rad");
}

#[test]
fn labels_stand_apart_wherever_the_drum_has_turned_to() {
    let mut met = 0;
    for degrees in (0..360).step_by(4) {
        let mut turned = drum_of_grains();
        turned.container.angle = f64::from(degrees).to_radians();
        let world = Arc::new(turned);
        let settings = ViewSettings {
            measured: [Measured::of(&world), Measured::NOTHING],
            ..ViewSettings::default()
        };
        let harness = pointed_with(settings, &world, egui::pos2(1.0, 1.0));
        let shapes = &harness.output().shapes;
        let place_of = |begin: &str| {
            let mut texts = shapes.iter().filter_map(|clipped| match &clipped.shape {
                egui::Shape::Text(text) => Some(text),
                _ => None,
            });
            let found = texts.find(|text| text.galley.text().starts_with(begin));
            found.map(egui::epaint::TextShape::visual_bounding_rect)
        };
        if let (Some(angle), Some(mark)) = (place_of("θ = "), place_of("turned ")) {
            assert!(!angle.intersects(mark), "{degrees}°: {angle:?}, {mark:?}");
            met += 1;
        }
    }
    assert!(met > 80, "{met} of 90");
}

/// How far the colours are apart.
fn apart(a: [u8; 3], b: [u8; 3]) -> u32 {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum()
}

#[test]
fn the_veil_has_the_colour_of_each_cell_s_temperature() {
    let Some(_studio) = studio() else {
        return;
    };
    let world = Arc::new(drum_of_grains());
    let map = temperature_map(&world).unwrap();
    let set = |drawn| {
        move |view: &mut ViewSettings| {
            (view.show_measured, view.show_temperature) = (false, drawn);
        }
    };
    let ([with, without], [settings, last]) = pictures(&world, "veil", [&set(true), &set(false)]);
    let legend = settings.veil.unwrap();
    assert_eq!((legend.title, legend.is_log), ("Tg", true));
    assert_eq!(last.veil, None);
    let hottest = map.cells().fold(0.0_f64, |most, (_, t)| most.max(t));
    assert!(hottest > NON_RIGID_TEMPERATURE && legend.max >= hottest);
    let mut looked_at = 0;
    for (corner, temperature) in map.cells() {
        let middle = (corner + 0.5 * map.spacing).extend(0.011).as_vec3();
        // The veil ends where the drum does.
        if middle.truncate().length() > 0.06 {
            continue;
        }
        looked_at += 1;
        let (at, _) = with.camera.project(middle).unwrap();
        let colour = ColourMap::Magma.colour(legend.share(temperature));
        let [before, after] = [&without, &with].map(|picture| apart(picture.at(at), colour));
        // Half the way or more to it; dark cells have little way to go.
        assert!(
            after <= before / 2 + 30,
            "{temperature}: {before} {after} {colour:?}"
        );
    }
    assert!(looked_at > 10, "{looked_at}");
    // Beside the bed is no veil.
    let beside = Vec2::new(20.0, 20.0);
    assert_eq!(with.at(beside), without.at(beside));
}

/// The hue at the place of the grain at `x` [m] as a share of the map.
fn share_seen(picture: &Photograph, x: DVec3) -> f64 {
    let seen = picture.at(picture.camera.project(x.as_vec3()).unwrap().0);
    let distance = |t: &u8| {
        let colour = ColourMap::Viridis.colour(f64::from(*t) / 20.0);
        let cosine = cosine(seen.map(f32::from), colour.map(f32::from));
        (1e6 * (1.0 - cosine)) as i64
    };
    f64::from((0..=20).min_by_key(distance).unwrap()) / 20.0
}

#[test]
fn grains_keep_the_colour_of_where_they_began_wherever_they_are() {
    let Some(_studio) = studio() else {
        return;
    };
    let places = [-0.02, -0.01, 0.0, 0.01, 0.02];
    let mut start = world(Shape::Planes, Vec::new());
    for x in places {
        (start.grains).push_sphere(DVec3::new(x, 0.0, 0.0), 4e-3, 2500.0, SpeciesId(0));
    }
    // Later they stand the other way round.
    let mut later = start.clone();
    for position in &mut later.grains.position {
        position.x = -position.x;
    }
    let picture = photograph_of(
        "start",
        |shown| shown.show_since(Arc::new(start), Arc::new(later)),
        |settings, camera| {
            camera.look_from(StandardView::Front);
            settings.projection = ProjectionKind::Orthographic;
            settings.show_overlay = false;
            settings.colour_by = ColourBy::Start(StartPlace::X);
        },
    );
    for (k, x) in places.into_iter().enumerate() {
        let share = share_seen(&picture, DVec3::new(-x, 0.0, 0.0));
        assert!((share - 0.25 * k as f64).abs() <= 0.1, "{x}: {share}");
    }
}

#[test]
fn a_run_knows_where_its_grains_began_wherever_it_is_looked_at() {
    let scene = Scene::open("two-grains").unwrap();
    let mut simulation = ready(Simulation::open(scene.clone(), standing()));
    let began = simulation.world().unwrap().grains.position.to_vec();
    let assert_begins = |simulation: &Simulation, when: &str| {
        let start = simulation.start().unwrap();
        assert_eq!(start.grains.position.to_vec(), began, "{when}");
    };
    carried_out(&mut simulation, Command::Step(400));
    assert_ne!(simulation.world().unwrap().grains.position.to_vec(), began);
    assert_begins(&simulation, "later");
    carried_out(&mut simulation, Command::Seek(200));
    assert_begins(&simulation, "earlier");
    carried_out(&mut simulation, Command::Reset);
    carried_out(&mut simulation, Command::Step(300));
    assert_begins(&simulation, "in another branch");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.grainfall");
    simulation.send(grainfall::lab::LabCommand::Save {
        path: path.clone(),
        look: String::new(),
    });
    while simulation.take_saved().is_empty() {
        simulation.tick(std::time::Duration::from_millis(16));
    }
    let Ok(Kept::Session(session)) = Kept::read(&path) else {
        panic!("a session");
    };
    let resumed = ready(Simulation::resume(*session, standing()));
    assert_eq!(resumed.world().unwrap().clock.step, 300);
    assert_begins(&resumed, "in a session");
    let out = folder.path().join("run");
    let mut short = scene;
    let values = [("duration", "20ms"), ("output-interval", "5ms")];
    short.set_all(&values).unwrap();
    runner::run(&runner::Job::new("two", short, &out), &mut (), &|| false).unwrap();
    let Ok(Kept::Recording(recording)) = Kept::read(&out) else {
        panic!("a recording");
    };
    let mut played = ready(Simulation::play_back(*recording, standing()));
    carried_out(&mut played, Command::Seek(u64::MAX));
    let first = &played.start().unwrap().grains.position;
    // Files hold single precision.
    let close = first.iter().zip(&began).all(|(a, b)| a.distance(*b) < 1e-7);
    assert!(close, "{first:?}");
    assert!(played.world().unwrap().grains.position[0].distance(began[0]) > 1e-4);
}

#[test]
fn a_force_has_the_colour_that_the_legend_gives_it() {
    let Some(_studio) = studio() else {
        return;
    };
    // The reference is the next round number: 1 mN.
    for (force, share) in [(1e-3, 1.0), (0.6e-3, 0.6)] {
        let picture = photograph("force-colour", pair(force), |settings, camera| {
            settings.show_forces = true;
            settings.grain_size = 0.2;
            settings.show_overlay = false;
            settings.projection = ProjectionKind::Orthographic;
            camera.look_from(StandardView::Front);
        });
        let seen = picture.at(picture.camera.project(Vec3::ZERO).unwrap().0);
        let hue = |share: f64| {
            let colour = ColourMap::Plasma.colour(share).map(f32::from);
            cosine(seen.map(f32::from), colour)
        };
        let other = 1.6 - share;
        assert!(
            hue(share) > 0.98 && hue(share) > hue(other),
            "{force}: {seen:?}"
        );
    }
}

#[test]
fn a_wet_grain_mirrors_the_light_in_a_spot_and_is_darker_around() {
    let Some(_studio) = studio() else {
        return;
    };
    let lightness = |is_wet: bool| {
        let mut shown = pair(0.0);
        if is_wet {
            shown.liquid = Some(LIQUID_CASES[1].liquid());
            shown.grains.film.set(vec![1e-8; 2]);
        }
        let picture = photograph("gloss", shown, |settings, camera| {
            camera.look_from(StandardView::Front);
            settings.projection = ProjectionKind::Orthographic;
            (settings.show_overlay, settings.show_turning) = (false, Some(false));
        });
        let at = |x: f64, y: f64| {
            let x = DVec3::new(-5e-3 + 5e-3 * x, 5e-3 * y, 0.0).as_vec3();
            let seen = picture.at(picture.camera.project(x).unwrap().0);
            seen.iter().map(|c| u32::from(*c)).sum::<u32>()
        };
        // Half way between eye and light, a sphere mirrors the one into the other.
        let spot = (-20..=20).flat_map(|i| (-20..=20).map(move |j| (i, j)));
        let brightest = spot
            .map(|(i, j)| at(0.03 * f64::from(i), 0.03 * f64::from(j)))
            .max();
        (brightest.unwrap(), at(0.3, -0.5))
    };
    let ((dry, dry_aside), (wet, wet_aside)) = (lightness(false), lightness(true));
    assert!(wet > dry + 60, "{wet} {dry}");
    assert!(wet_aside + 15 < dry_aside, "{wet_aside} {dry_aside}");
}

#[test]
fn the_floor_goes_on_under_what_the_colours_mean() {
    let Some(_studio) = studio() else {
        return;
    };
    let shape = Shape::Column {
        radius: 0.02,
        height: 0.02,
    };
    let floor = Surface::Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    };
    let mut column = world(shape, vec![floor]);
    for x in [-0.01, 0.0, 0.01] {
        let kind = SpeciesId(u16::from(x > 0.0));
        let place = DVec3::new(x, 4e-3, 0.0);
        column.grains.push_sphere(place, 4e-3, 2500.0, kind);
    }
    let set = |view: &mut ViewSettings| {
        view.show_overlay = true;
        view.show_container = true;
        view.show_measured = false;
        view.grain_size = 1.0;
        view.camera_request = Some(CameraRequest::Home);
    };
    let ([picture, _], [settings, _]) = pictures(&Arc::new(column), "wet-column", [&set, &set]);
    assert!(settings.margin > 50.0 && settings.margin_is_free);
    let edge = SIZE.x as f32 - settings.margin;
    let mut seen = 0;
    // Above the numbers on the floor.
    for y in (20..280).step_by(4) {
        let at = |x: f32| picture.at(Vec2::new(edge + x, y as f32));
        let step = apart(at(-2.5), at(2.5));
        // What the lines on the floor change within five pixels; the edge of a picture is as far from
        // the background as the floor is.
        assert!(step < 45, "{y}: {:?}, {:?}", at(-2.5), at(2.5));
        seen += u32::from(picture.contrast(Vec2::new(edge + 6.0, y as f32)) > 3);
    }
    assert!(seen > 8, "{seen}");
}
