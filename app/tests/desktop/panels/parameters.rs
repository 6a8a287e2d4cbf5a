//! Live parameters: what is typed, dragged or chosen by name becomes one command in SI units.

use crate::timeline::carried_out;
use crate::window_of_panels::{
    Window, commands, friction, in_the_lab, prepared, ready, set, standing, type_number, wet,
};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::parameters::{Parameter, ParameterInfo, Value, Values};
use grainfall::physics::{LIQUID_CASES, PAPER_VOLUME};
use grainfall::run::Command;
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Detail, Request, parameter_ui};

#[test]
fn a_typed_friction_is_set_once() {
    let mut harness = Window::of(prepared());
    type_number(&mut harness, "friction glass – glass", "0.25");
    assert_eq!(commands(&harness.state().asked), [set(friction(), 0.25)]);
}

#[test]
fn a_liquid_is_chosen_with_all_that_makes_it() {
    let mut harness = Window::of(wet());
    harness.get_by_label("glycerol").click();
    harness.run_steps(2);
    let glycerol = &LIQUID_CASES[6];
    let expected = [
        set(Parameter::Viscosity, glycerol.viscosity),
        set(Parameter::SurfaceTension, glycerol.surface_tension()),
        set(Parameter::ContactAngle, glycerol.contact_angle()),
    ];
    assert_eq!(commands(&harness.state().asked), expected);
}

#[test]
fn dry_takes_the_liquid_away_and_a_liquid_brings_it_back() {
    let mut harness = Window::of(wet());
    harness.get_by_label("dry").click();
    harness.run_steps(2);
    let dried = set(Parameter::LiquidVolume, 0.0);
    assert_eq!(
        commands(&harness.state().asked),
        std::slice::from_ref(&dried)
    );
    harness.state_mut().simulation.send(dried);
    harness.state_mut().asked.clear();
    harness.run_steps(2);
    harness.get_by_label("water").click();
    harness.run_steps(2);
    let poured = commands(&harness.state().asked);
    assert_eq!(poured[0], set(Parameter::LiquidVolume, PAPER_VOLUME));
    assert_eq!(poured.len(), 4);
}

#[test]
fn bridge_laws_are_chosen_by_name() {
    let mut harness = in_the_lab(wet());
    harness.get_by_label("as coded").click();
    harness.run_steps(2);
    let asked = commands(&harness.state().asked);
    let as_coded = Parameter::BridgeLaw.row().parse("as-coded").unwrap();
    assert_eq!(asked, [set(Parameter::BridgeLaw, as_coded)]);
}

#[test]
fn a_viscosity_typed_in_millipascal_seconds_is_set_in_pascal_seconds() {
    let mut harness = Window::of(wet());
    type_number(&mut harness, "viscosity", "250");
    let asked = commands(&harness.state().asked);
    assert_eq!(asked, [set(Parameter::Viscosity, 0.25)]);
}

#[test]
fn a_small_value_of_a_wide_range_keeps_its_digits() {
    let mut simulation = wet();
    carried_out(&mut simulation, set(Parameter::Viscosity, 1.01e-3));
    let mut harness = Window::of(simulation);
    let viscosity = harness.get_by_role_and_label(Role::SpinButton, "viscosity");
    let value = viscosity.accesskit_node().value();
    assert_eq!(value.as_deref(), Some("1.01 mPa s"));
    type_number(&mut harness, "viscosity", "1.55");
    let asked = commands(&harness.state().asked);
    assert_eq!(asked, [set(Parameter::Viscosity, 1.55e-3)]);
}

#[test]
fn dry_scenes_show_nothing_of_liquids() {
    let dry = Window::of(prepared());
    assert!(dry.query_by_label("glycerol").is_none());
    assert!(dry.query_by_label("Beside the paper").is_none());
    let wet = Window::of(wet());
    assert!(wet.query_by_label("glycerol").is_some());
    assert!(wet.query_by_label("Beside the paper").is_some());
}

#[test]
fn a_drum_speed_typed_in_rpm_is_set_in_radians_per_second() {
    let mut harness = Window::of(prepared());
    type_number(&mut harness, "drum speed", "3");
    let asked = commands(&harness.state().asked);
    let [
        Command::Set {
            parameter: Parameter::DrumSpeed,
            value,
        },
    ] = asked[..]
    else {
        panic!("{asked:?}");
    };
    // 3 rpm = π/10 rad/s; the two conversions round once each.
    assert!(
        (value.number() - std::f64::consts::PI / 10.0).abs() < 1e-15,
        "{value}"
    );
}

#[test]
fn a_value_out_of_range_is_brought_into_it_and_said_to_be() {
    let mut harness = Window::of(prepared());
    type_number(&mut harness, "friction glass – glass", "7");
    assert_eq!(commands(&harness.state().asked), [set(friction(), 1.0)]);
    harness.get_by_label("7 is out of range, so 1 was taken. Expected: 0 to 1.");
}

#[test]
fn what_is_no_number_is_answered_and_changes_nothing() {
    let mut harness = Window::of(prepared());
    type_number(&mut harness, "drum speed", "fast");
    assert_eq!(harness.state().asked, []);
    let speed = "“fast” is not a number, so nothing was changed. Expected: −10 to 10 rpm.";
    harness.get_by_label(speed);
    // Another field is another matter; the same one is free of it once it is put right.
    type_number(&mut harness, "friction glass – glass", "0,25");
    assert_eq!(commands(&harness.state().asked), [set(friction(), 0.25)]);
    harness.get_by_label(speed);
    type_number(&mut harness, "drum speed", "3 rpm");
    assert_eq!(harness.state().asked.len(), 2);
    assert!(harness.query_by_label(speed).is_none());
}

#[test]
fn a_field_that_is_only_passed_through_changes_nothing() {
    let mut simulation = prepared();
    simulation.send(set(friction(), 1.0 / 3.0));
    let mut harness = Window::of(simulation);
    harness
        .get_by_role_and_label(Role::SpinButton, "friction glass – glass")
        .click();
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(harness.state().asked, []);
}

#[test]
fn each_parameter_leads_to_its_comparison() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Compare drum speed…").click();
    harness.run_steps(2);
    let request = Request::Compare(Some(Parameter::DrumSpeed));
    assert_eq!(harness.state().asked, [request]);
    harness
        .state_mut()
        .dock
        .compare(Some(&Parameter::DrumSpeed));
    harness.run_steps(8);
    harness.get_by_label("Left: 2 rpm, the present value");
}

#[test]
fn dragging_a_slider_sets_at_most_one_value_a_frame_and_none_while_it_rests() {
    let mut harness = Window::of(prepared());
    let slider = harness
        .get_by_role_and_label(Role::Slider, "friction glass – glass")
        .rect();
    let at = |share: f32| egui::pos2(egui::lerp(slider.x_range(), share), slider.center().y);
    harness.drag_at(at(0.4));
    harness.run_steps(2);
    let mut values = Vec::new();
    for share in [0.5, 0.6, 0.7] {
        harness.state_mut().asked.clear();
        harness.hover_at(at(share));
        harness.step();
        let asked = commands(&harness.state().asked);
        assert_eq!(asked.len(), 1, "one command for one move: {asked:?}");
        let Command::Set { parameter, value } = asked[0].clone() else {
            panic!("{asked:?}");
        };
        assert_eq!(parameter, friction());
        harness.state_mut().simulation.send(asked[0].clone());
        harness.state_mut().asked.clear();
        harness.run_steps(3);
        assert!(
            harness.state().asked.is_empty(),
            "a resting pointer changes nothing"
        );
        values.push(value.number());
    }
    assert!(values.is_sorted() && values[0] < values[2], "{values:?}");
}

#[test]
fn one_parameter_goes_back_to_the_scenes_value_by_its_own_button() {
    let mut simulation = prepared();
    simulation.send(set(friction(), 0.8));
    simulation.send(set(Parameter::DrumSpeed, 1.0));
    let mut harness = Window::of(simulation);
    harness.get_by_label("Reset friction glass – glass").click();
    harness.run_steps(2);
    assert_eq!(commands(&harness.state().asked), [set(friction(), 0.4)]);
}

#[test]
fn a_parameter_is_shown_in_the_unit_people_think_in() {
    let info = ParameterInfo {
        parameter: Parameter::Share("red".into()),
        label: "share red".into(),
        values: Values::Range(0.0..=1.0),
        default: 0.3.into(),
        acts: true,
    };
    let scene = Scene::open("two-frictions-drum").unwrap();
    let mut harness = Harness::new_ui_state(
        move |ui, asked: &mut Vec<Value>| {
            asked.extend(parameter_ui(
                ui,
                &info,
                0.3.into(),
                Detail::Lab,
                &scene,
                |_| (),
            ));
        },
        Vec::new(),
    );
    harness.run();
    let shown = harness
        .get_by_role_and_label(Role::SpinButton, "share red")
        .value();
    assert_eq!(shown.as_deref(), Some("30.00 %"));
    type_number(&mut harness, "share red", "50");
    assert_eq!(harness.state().first(), Some(&Value::Number(0.5)));
}

#[test]
fn basics_show_the_few_that_matter_and_lab_shows_all() {
    let mut simulation = prepared();
    simulation.send(set(Parameter::Gravity, 3.0));
    let mut harness = Window::of(simulation);
    let slider = |harness: &Harness<'_, Window>, label: &str| {
        harness
            .query_by_role_and_label(Role::Slider, label)
            .is_some()
    };
    assert!(slider(&harness, "drum speed") && slider(&harness, "friction glass – glass"));
    let beyond = [
        "gravity",
        "rolling friction glass – glass",
        "density glass",
        "seed",
    ];
    assert!(beyond.iter().all(|label| !slider(&harness, label)));
    // What was changed out of sight is not hidden.
    harness.get_by_label_contains("1 more changed").click();
    harness.run_steps(4);
    assert!(beyond.iter().all(|label| slider(&harness, label)));
    assert!(harness.get_all_by_label_contains("acts at once").count() > 5);
    assert!(
        harness
            .get_all_by_label_contains("acts at the next start")
            .count()
            > 5
    );
    let every = harness.state().simulation.parameters().to_vec();
    assert!(every.iter().all(|info| slider(&harness, &info.label)));
    harness.get_by_label("Basics").click();
    harness.run_steps(4);
    assert!(!slider(&harness, "gravity"));
}

#[test]
fn named_values_are_set_by_their_names_and_hold_a_slider() {
    let mut harness = Window::of(prepared());
    harness
        .get_by_label("friction glass – glass: smooth")
        .click();
    harness.run_steps(2);
    assert_eq!(commands(&harness.state().asked), [set(friction(), 0.1)]);
    // Drawn slowly over the lower part of its range, the slider stays there a while.
    let slider = harness
        .get_by_role_and_label(Role::Slider, "friction glass – glass")
        .rect();
    let at = |pixel: f32| slider.left_center() + egui::vec2(pixel, 0.0);
    harness.state_mut().asked.clear();
    harness.drag_at(at(0.0));
    harness.run_steps(2);
    let last = slider.width() / 4.0;
    for pixel in 1..last as u32 {
        harness.hover_at(at(pixel as f32));
        harness.step();
    }
    let asked = commands(&harness.state().asked);
    let held = asked.iter().filter(|asked| **asked == set(friction(), 0.1));
    assert!(held.count() > 1, "{asked:?}");
}

#[test]
fn arrow_keys_step_the_control_that_has_the_focus() {
    let mut harness = Window::of(prepared());
    harness
        .get_by_role_and_label(Role::Slider, "friction glass – glass")
        .focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowRight);
    harness.run_steps(2);
    let asked = commands(&harness.state().asked);
    let [Command::Set { parameter, value }] = &asked[..] else {
        panic!("{asked:?}");
    };
    assert!(
        *parameter == friction() && (0.4..0.45).contains(&value.number()) && value.number() > 0.4,
        "{value}"
    );
    harness.state_mut().asked.clear();
    harness.key_press(Key::R);
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::Command(Command::Reset)]);
}

#[test]
fn a_grain_alone_has_walls_to_meet_and_what_acts_on_it_comes_first() {
    let scene = Scene::open("slide-to-roll").unwrap();
    let alone = ready(Simulation::open(scene, standing()));
    let harness = in_the_lab(alone);
    assert!(harness.query_by_label("Grain – grain").is_none());
    harness.get_by_label("Grain – wall");
    let row = |name: &str| {
        let label = format!("{name} glass – glass");
        harness
            .get_by_role_and_label(Role::SpinButton, &label)
            .rect()
    };
    assert!(row("friction").top() < row("restitution").top());
    let scene = Scene::open("bouncing-grain").unwrap();
    let harness = in_the_lab(ready(Simulation::open(scene, standing())));
    let row = |name: &str| {
        let label = format!("{name} glass – floor");
        harness
            .get_by_role_and_label(Role::SpinButton, &label)
            .rect()
    };
    assert!(row("restitution").top() < row("friction").top());
}

#[test]
fn a_share_that_follows_from_the_one_shown_is_no_further_change() {
    let mut scene = Scene::open("two-frictions-drum").unwrap();
    scene.set("count", "30").unwrap();
    let mut simulation = ready(Simulation::open(scene, standing()));
    let share = Parameter::Share("rough".into());
    carried_out(&mut simulation, set(share, 0.5));
    let harness = Window::of(simulation);
    assert!(harness.query_by_label_contains("more changed").is_none());
}
