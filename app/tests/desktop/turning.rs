//! Claims about the pattern that shows how a sphere turns: how far it has turned is read from one
//! picture, and wherever a run is looked at it has turned as far as there.

use crate::timeline::carried_out;
use crate::view::{SIZE, photographed, studio, world};
use crate::window_of_panels::{ready, standing};
use bevy::math::{Quat, Vec2, Vec3};
use bevy::prelude::*;
use glam::DVec3;
use grainfall::lab::Options;
use grainfall::run::Command;
use grainfall::scene::Scene;
use grainfall::world::{Shape, SpeciesId};
use grainfall_app::simulation::Simulation;
use grainfall_app::view::{
    OrbitCamera, ProjectionKind, ShownWorlds, StandardView, ViewPlugin, ViewSettings,
};
use grainfall_app::window::canvas::{CanvasPlugin, make_ready, offscreen_plugins};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

/// Five degrees [rad].
const CLOSE: f32 = 5.0 * PI / 180.0;

/// How far two angles are apart [rad].
fn apart(a: f32, b: f32) -> f32 {
    ((a - b + PI).rem_euclid(TAU) - PI).abs()
}

#[test]
fn how_far_a_sphere_has_turned_is_read_from_its_picture() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut app = App::new();
    app.add_plugins(offscreen_plugins().disable::<bevy::log::LogPlugin>())
        .add_plugins((CanvasPlugin(SIZE), ViewPlugin));
    let mut camera = OrbitCamera::default();
    camera.look_from(StandardView::Front);
    app.insert_resource(camera).insert_resource(ViewSettings {
        projection: ProjectionKind::Orthographic,
        show_overlay: false,
        ..default()
    });
    make_ready(&mut app);
    let mut show = |turn: f32, has_pattern: bool| {
        let mut one = world(Shape::Planes, Vec::new());
        (one.grains).push_sphere(DVec3::ZERO, 5e-3, 2500.0, SpeciesId(0));
        let turned = [Quat::from_rotation_z(turn)];
        let mut shown = app.world_mut().resource_mut::<ShownWorlds>();
        shown.show_turned(Arc::new(one), Arc::new(turned));
        app.world_mut().resource_mut::<ViewSettings>().show_turning = Some(has_pattern);
        photographed(&mut app, "turned")
    };
    let plain = show(0.0, false);
    for turn in [0.0, 0.7, 2.5, 4.4] {
        let picture = show(turn, true);
        let (centre, per_metre) = picture.camera.project(Vec3::ZERO).unwrap();
        // On a circle about the centre the dark half fills one half: its middle tells the angle.
        let mut sum = Vec2::ZERO;
        for k in 0..720 {
            let way = Vec2::from_angle(TAU * k as f32 / 720.0);
            let place = centre + 0.6 * 5e-3 * per_metre * Vec2::new(way.x, -way.y);
            let [seen, unpainted] = [&picture, &plain]
                .map(|picture| picture.at(place).iter().map(|c| f32::from(*c)).sum::<f32>());
            // In sRGB 0.38 of the light is 0.65 of the number.
            sum += if seen < 0.8 * unpainted {
                way
            } else {
                Vec2::ZERO
            };
        }
        assert!(sum.length() > 100.0, "{sum}");
        let seen = sum.to_angle();
        assert!(apart(seen, turn) < CLOSE, "{turn}: {seen}");
    }
}

/// The turn of the only grain about the z axis, counted round and round by what it was `before`.
fn turn_about_z(simulation: &Simulation) -> f32 {
    let turn = simulation.orientations().expect("followed in a window")[0];
    2.0 * turn.z.atan2(turn.w)
}

#[test]
fn a_rolling_grain_turns_by_its_way_over_its_radius_wherever_it_is_looked_at() {
    let scene = Scene::open("slide-to-roll").unwrap();
    let mut simulation = ready(Simulation::open(scene.clone(), standing()));
    let mut steps = 0;
    // The angle by Simpson's rule of the spins, step by step as seen from outside.
    let (mut angle, mut marks) = (0.0, Vec::new());
    let spin = |simulation: &Simulation| simulation.world().unwrap().grains.spin[0].z;
    let step = simulation.world().unwrap().clock.time_step;
    let piece = 200;
    for _ in 0..60 {
        let before = spin(&simulation);
        carried_out(&mut simulation, Command::Step(piece));
        angle += 0.5 * step * piece as f64 * (before + spin(&simulation));
        steps += piece;
        marks.push((steps, turn_about_z(&simulation)));
        let seen = apart(turn_about_z(&simulation), angle as f32);
        assert!(seen < 0.01, "{steps}: {seen}");
    }
    assert!(angle.abs() > 0.5, "it turns: {angle}");
    // Earlier moments, from keyframes or from time zero.
    for (step, mark) in [marks[7], marks[31], marks[0], marks[59]] {
        carried_out(&mut simulation, Command::Seek(step));
        assert!(apart(turn_about_z(&simulation), mark) < 1e-3, "{step}");
    }
    let options = Options {
        memory: 0,
        ..standing()
    };
    let headless = ready(Simulation::open(scene, options));
    assert_eq!(headless.orientations(), None, "where nobody looks");
}
