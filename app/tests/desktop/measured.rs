//! Claims about what is measured, drawn where it is measured: the line in the picture has the slope
//! that the samples state, and a curve and its mark tell of each other.

use crate::view::{Photograph, SIZE, drum_of_grains, panel_camera, photographed, studio};
use crate::window_of_panels::{Window, after, ready, standing, with_samples};
use bevy::math::{Vec2, Vec3};
use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPlugin, EguiPrimaryContextPass, egui};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::measure::Measure;
use grainfall::run::opening;
use grainfall::world::World as Grains;
use grainfall_app::simulation::Simulation;
use grainfall_app::view::{
    Caption, Measured, OrbitCamera, ProjectionKind, Protractor, ShownWorlds, StandardView,
    ViewPlugin, ViewSettings, viewport_ui,
};
use grainfall_app::window::canvas::{CanvasPlugin, make_ready, offscreen_plugins};
use std::sync::Arc;

/// A hundredth of a degree [rad].
const CLOSE: f64 = 1.745e-4;

/// Slope of a line from its lower end to its upper one, as `θ` counts it [rad].
fn slope([from, to]: [Vec3; 2]) -> f64 {
    let way = (to - from).as_dvec3();
    (way.y / way.x).atan()
}

#[test]
fn the_line_has_the_angle_of_the_samples_at_every_moment() {
    // On its way to an avalanche: steep.
    let mut simulation = ready(Simulation::resume(opening("dry-r3").unwrap(), standing()));
    let mut steepest = 0.0_f64;
    for moment in 1..6 {
        simulation = after(simulation, 9.0 + 0.02 * f64::from(moment));
        let world = simulation.world().unwrap();
        let surface = Measured::of(world).surface.unwrap();
        let line = Protractor::of(&surface, 0.011);
        let series = simulation.series();
        assert_eq!(series.steps().last(), Some(&world.clock.step));
        let sampled = *series.column(Measure::SurfaceAngle).last().unwrap();
        assert!((slope(line.line) - sampled).abs() < CLOSE, "{moment}");
        // Arc and level make the same angle with each other.
        let [corner, level] = line.level.map(Vec3::as_dvec3);
        let end = line.arc.last().unwrap().as_dvec3() - corner;
        let arc = end.angle_between(level - corner);
        assert!((arc - sampled.abs()).abs() < CLOSE, "{moment}: {arc}");
        steepest = steepest.max(sampled.abs());
    }
    assert!(steepest > 0.4, "{steepest}");
}

/// What the picture of a world is written into.
#[derive(Resource)]
struct Pictured(Arc<Grains>);

fn write_picture(
    pictured: Res<Pictured>,
    mut contexts: EguiContexts,
    mut settings: ResMut<ViewSettings>,
    mut camera: ResMut<OrbitCamera>,
) -> Result {
    let ctx = contexts.ctx_mut()?.clone();
    let builder = egui::UiBuilder::new()
        .layer_id(egui::LayerId::background())
        .max_rect(ctx.viewport_rect());
    let mut root = egui::Ui::new(ctx, "root".into(), builder);
    viewport_ui(
        &mut root,
        &[caption(&pictured.0)],
        &mut settings,
        &mut camera,
    );
    Ok(())
}

/// A picture of `world`, with a clock.
pub fn caption(world: &Grains) -> Caption<'_> {
    Caption {
        world: Some(world),
        real_time_factor: None,
        title: None,
        has_clock: true,
        is_for_afar: false,
    }
}

/// Pictures of `world` from the front, its grains small and what is measured drawn, then not.
fn with_and_without(world: &Arc<Grains>) -> [Photograph; 2] {
    let set = |drawn| move |view: &mut ViewSettings| view.show_measured = drawn;
    pictures(world, "measured", [&set(true), &set(false)]).0
}

/// Pictures of `world` from the front, its grains small, with each of these settings, and what the
/// settings became.
pub fn pictures(
    world: &Arc<Grains>,
    name: &str,
    settings: [&dyn Fn(&mut ViewSettings); 2],
) -> ([Photograph; 2], [ViewSettings; 2]) {
    let mut app = App::new();
    app.add_plugins(offscreen_plugins().disable::<bevy::log::LogPlugin>())
        .add_plugins(EguiPlugin::default())
        .add_plugins((CanvasPlugin(SIZE), ViewPlugin, panel_camera))
        .insert_resource(Pictured(world.clone()))
        .add_systems(EguiPrimaryContextPass, write_picture);
    let mut camera = OrbitCamera::default();
    camera.look_from(StandardView::Front);
    app.insert_resource(camera).insert_resource(ViewSettings {
        projection: ProjectionKind::Orthographic,
        show_overlay: false,
        show_container: false,
        grain_size: 0.05,
        ..default()
    });
    (app.world_mut().resource_mut::<ShownWorlds>()).show(Some(world.clone()));
    make_ready(&mut app);
    let mut shown = Vec::new();
    let taken = [0, 1].map(|i| {
        settings[i](&mut app.world_mut().resource_mut::<ViewSettings>());
        let taken = photographed(&mut app, &format!("{name}-{i}"));
        shown.push(app.world().resource::<ViewSettings>().clone());
        taken
    });
    let second = shown.pop().unwrap();
    (taken, [shown.pop().unwrap(), second])
}

/// Slope of the straight line through what one picture has and the other has not, near the line
/// between these points of it, in the part where nothing else is drawn.
fn slope_seen(pictures: &[Photograph; 2], [from, to]: [Vec2; 2]) -> f64 {
    let difference = |x: f32, y: f32| {
        let [with, without] = [0, 1].map(|i| pictures[i].at(Vec2::new(x, y)));
        (0..3)
            .map(|i| f64::from(with[i].abs_diff(without[i])))
            .sum::<f64>()
    };
    let mut points = Vec::new();
    let (left, right) = (from.x.min(to.x), from.x.max(to.x));
    for x in left as usize..right as usize {
        let x = x as f32 + 0.5;
        let share = (x - from.x) / (to.x - from.x);
        // Beyond the arc on one side, before the corner on the other.
        if !((0.03..0.36).contains(&share) || (0.45..0.8).contains(&share)) {
            continue;
        }
        let middle = from.y + share * (to.y - from.y);
        let rows = (-6..=6).map(|row| (middle.floor() + row as f32 + 0.5, row));
        let (mut weight, mut moment) = (0.0, 0.0);
        for (y, _) in rows {
            weight += difference(x, y);
            moment += difference(x, y) * f64::from(y);
        }
        assert!(weight > 100.0, "no line at {x}");
        points.push((f64::from(x), moment / weight));
    }
    let count = points.len() as f64;
    let mean = |value: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let slope = mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2));
    // The picture's y points down.
    -slope.atan()
}

#[test]
fn the_line_in_the_picture_has_the_slope_that_its_number_states() {
    let Some(_studio) = studio() else {
        return;
    };
    let world = Arc::new(drum_of_grains());
    let surface = Measured::of(&world).surface.unwrap();
    let pictures = with_and_without(&world);
    let line = Protractor::of(&surface, 0.011).line;
    let ends = line.map(|x| pictures[0].camera.project(x).unwrap().0);
    let seen = slope_seen(&pictures, ends);
    assert!(surface.angle > 0.3, "{}", surface.angle);
    // The pixels of two hundred columns tell a hundredth of a degree.
    assert!(
        (seen - surface.angle).abs() < CLOSE,
        "{seen} {}",
        surface.angle
    );
}

/// A window's picture alone, with the pointer at `pointer`.
fn pointed_at(world: &Arc<Grains>, pointer: egui::Pos2) -> Harness<'static, ViewSettings> {
    let settings = ViewSettings {
        measured: [Measured::of(world), Measured::NOTHING],
        ..ViewSettings::default()
    };
    pointed_with(settings, world, pointer)
}

/// The same with these `settings`.
pub fn pointed_with(
    mut settings: ViewSettings,
    world: &Arc<Grains>,
    pointer: egui::Pos2,
) -> Harness<'static, ViewSettings> {
    settings.show_overlay = false;
    let (world, mut camera) = (world.clone(), camera());
    let mut harness = Harness::builder().with_size([640.0, 360.0]).build_ui_state(
        move |ui, settings: &mut ViewSettings| {
            viewport_ui(ui, &[caption(&world)], settings, &mut camera);
        },
        settings,
    );
    harness.run_steps(2);
    harness.event(egui::Event::PointerMoved(pointer));
    harness.run_steps(60);
    harness
}

/// From the front, as high as the drum.
pub fn camera() -> OrbitCamera {
    let mut camera = OrbitCamera::default();
    camera.projection = ProjectionKind::Orthographic;
    (camera.viewport, camera.height) = (Vec2::new(640.0, 360.0), 0.13);
    (camera.yaw, camera.pitch) = (0.0, 0.0);
    camera
}

#[test]
fn a_mark_tells_how_it_is_measured_and_its_curve_stands_out() {
    let world = Arc::new(drum_of_grains());
    let surface = Measured::of(&world).surface.unwrap();
    let on_line = (surface.midpoint).extend(0.011).as_vec3();
    let (at, _) = camera().project(on_line).unwrap();
    let harness = pointed_at(&world, egui::pos2(at.x, at.y));
    assert_eq!(harness.state().lit_by_picture, Some(Measure::SurfaceAngle));
    harness.get_by_label_contains("y = y₀ + x tan θ");
    let aside = pointed_at(&world, egui::pos2(620.0, 340.0));
    assert_eq!(aside.state().lit_by_picture, None);
}

#[test]
fn a_curve_under_the_pointer_is_told_to_the_picture() {
    let mut harness = Window::of(with_samples());
    assert_eq!(harness.state().view.lit_by_plot, None);
    let below = |label: &str| {
        let title = harness.get_by_label(label).rect();
        title.left_bottom() + egui::vec2(80.0, 60.0)
    };
    let places = [
        (below("Surface angle θ [°]"), Measure::SurfaceAngle),
        (
            below("Granular temperature Tg [m²/s²]"),
            Measure::GranularTemperature,
        ),
    ];
    for (place, measure) in places {
        harness.event(egui::Event::PointerMoved(place));
        harness.run_steps(3);
        assert_eq!(harness.state().view.lit_by_plot, Some(measure));
    }
}

#[test]
fn what_is_measured_is_shown_until_somebody_says_otherwise() {
    let mut harness = Window::of(with_samples());
    assert!(harness.state().view.show_measured);
    harness.get_by_label("View").click();
    harness.run_steps(3);
    harness.get_by_label("Show what is measured").click();
    harness.run_steps(3);
    assert!(!harness.state().view.show_measured);
}
