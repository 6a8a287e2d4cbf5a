//! The picture: its settings, and clicks on it.

use crate::measured::caption;
use crate::window_of_panels::{Window, prepared};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::measure::GrainQuantity;
use grainfall_app::ui::Request;
use grainfall_app::view::{
    CameraRequest, Caption, ColourBy, ColourRange, Cut, Legend, OrbitCamera, ViewSettings,
    viewport_ui,
};

#[test]
fn view_settings_change_what_they_name() {
    let mut harness = Window::of(prepared());
    harness
        .get_by_role_and_label(Role::Button, "Picture")
        .click();
    harness.run_steps(10);
    harness
        .get_by_role_and_label(Role::ComboBox, "Colour by")
        .click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "Speed").click();
    harness.run_steps(3);
    assert_eq!(
        harness.state().view.colour_by,
        ColourBy::Quantity(GrainQuantity::Speed)
    );
    harness.get_by_label("Fixed").click();
    harness.run_steps(3);
    assert!(matches!(harness.state().view.range, ColourRange::Fixed(..)));
    harness.get_by_label("Across").click();
    harness.run_steps(3);
    assert!(harness.state().view.cut.is_some());
    harness.get_by_label("Cut position");
    harness.get_by_label("Quarter").click();
    harness.run_steps(3);
    let quarter = Cut::Quarter { x: 0.0, z: 0.0 };
    assert_eq!(harness.state().view.cut, Some(quarter));
    harness.get_by_label("Nothing").click();
    harness.run_steps(3);
    assert_eq!(harness.state().view.cut, None);
}

#[test]
fn what_lies_between_the_grains_is_chosen_by_name() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Picture").click();
    harness.run_steps(3);
    harness.get_by_label("Forces").click();
    harness.run_steps(3);
    let view = &harness.state().view;
    assert!(
        view.show_forces && view.grain_size < 0.5,
        "grains make room"
    );
    harness.get_by_label("Forces").click();
    harness.run_steps(3);
    assert_eq!(harness.state().view.grain_size, 1.0);
    harness.get_by_label("Velocities").click();
    harness.get_by_label("Axes").click();
    harness.get_by_label("Keep 2").click();
    harness.get_by_label("Show 2").click();
    harness.run_steps(3);
    let window = harness.state();
    assert!(window.view.show_velocities && window.view.show_axes);
    for request in [CameraRequest::Save(1), CameraRequest::Recall(1)] {
        assert!(window.asked.contains(&Request::Camera(request)));
    }
    assert!(
        harness.query_by_label("Bridges").is_none(),
        "nothing is wet"
    );
}

#[test]
fn what_the_colours_mean_stands_beside_the_picture() {
    let world = prepared().world().unwrap().clone();
    let of = |legend: Option<Legend>, height: f32| {
        let world = world.clone();
        let mut camera = OrbitCamera::default();
        camera.height = height;
        let settings = ViewSettings {
            legend,
            ..ViewSettings::default()
        };
        let mut harness = Harness::builder().with_size([640.0, 360.0]).build_ui_state(
            move |ui, (settings, camera): &mut (ViewSettings, OrbitCamera)| {
                let without_clock = Caption {
                    has_clock: false,
                    ..caption(&world)
                };
                viewport_ui(ui, &[without_clock], settings, camera);
            },
            (settings, camera),
        );
        harness.run_steps(2);
        let (settings, camera) = harness.state();
        let free = settings.free_rect.unwrap();
        assert_eq!(camera.viewport.x + settings.margin, free.width());
        (settings.margin, settings.margin_is_free)
    };
    assert_eq!(of(None, 1.0), (0.0, false));
    let speed = Legend {
        title: "Granular temperature",
        min: 0.0,
        max: 1.0,
        unit: "m²/s²",
        is_log: false,
    };
    let (margin, is_free) = of(Some(speed.clone()), 1.0);
    assert!(margin > 100.0 && is_free, "floor and walls go on there");
    // From so near that grains reach beyond the edge, the margin is the legend's alone.
    assert_eq!(of(Some(speed), 0.01), (margin, false));
}

#[test]
fn a_click_on_the_picture_picks_the_grain_under_it() {
    let simulation = prepared();
    let world = simulation.world().unwrap().clone();
    let mut camera = OrbitCamera::default();
    (camera.focus, camera.height, camera.yaw, camera.pitch) =
        (world.grains.position[1].as_vec3(), 0.05, 0.0, 0.0);
    let mut harness = Harness::builder().with_size([400.0, 300.0]).build_ui_state(
        move |ui, (settings, camera): &mut (ViewSettings, OrbitCamera)| {
            viewport_ui(ui, &[caption(&world)], settings, camera);
        },
        (ViewSettings::default(), camera),
    );
    harness.run_steps(2);
    let click = |harness: &mut Harness<'_, _>, pos: egui::Pos2, modifiers: Modifiers| {
        harness.event(egui::Event::PointerMoved(pos));
        for pressed in [true, false] {
            harness.event_modifiers(
                egui::Event::PointerButton {
                    pos,
                    button: egui::PointerButton::Primary,
                    pressed,
                    modifiers,
                },
                modifiers,
            );
            harness.run_steps(1);
        }
        harness.run_steps(1);
    };
    let rect = harness.state().0.free_rect.unwrap();
    click(&mut harness, rect.center(), Modifiers::NONE);
    assert_eq!(harness.state().0.selected, Some(1));
    let aside = rect.min + egui::vec2(5.0, 5.0);
    click(&mut harness, aside, Modifiers::NONE);
    assert_eq!(harness.state().0.selected, None);
    // With Shift it is traced, and with another click no longer.
    for traced in [vec![1], vec![]] {
        click(&mut harness, rect.center(), Modifiers::SHIFT);
        assert_eq!(harness.state().0.traced, traced);
        assert_eq!(harness.state().0.selected, None);
    }
}
