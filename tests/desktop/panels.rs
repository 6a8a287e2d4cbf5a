//! Panels by their accessible labels, without Bevy's app and without a GPU: what a click or a typed
//! value asks for.

use crate::timeline::carried_out;
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers, Shape};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use grainfall::measure::{Avalanche, GrainQuantity, Measure, Sample, Series};
use grainfall::parameters::{Parameter, ParameterInfo, Value, Values};
use grainfall::physics::{LIQUID_CASES, PAPER_VOLUME};
use grainfall::scene::{Scene, built_in};
use grainfall::simulation::{
    BedStore, Command, DriverKind, LabCommand, Options, Simulation, Status,
};
use grainfall::solver::{Fault, FaultKind};
use grainfall::ui::{
    AvalanchePlots, Curves, Detail, Dock, Look, Purpose, Request, UserMemory, open_error_ui,
    parameter_ui, status_ui, theme,
};
use grainfall::view::{
    Background, CameraRequest, Caption, ColourBy, ColourRange, Cut, OrbitCamera, Side,
    ViewSettings, viewport_ui,
};
use std::path::Path;
use std::time::Duration;

/// A simulation of three grains, which needs no settling, at time zero.
fn three_grains() -> Simulation {
    let text = r#"(
        title: "Three grains",
        materials: {
            "glass": (youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500, restitution: 0.95, friction: 0.40, rolling_friction: 0.01),
            "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
        },
        pairs: [(between: ("glass", "drum"), restitution: 0.72, friction: 0.30, rolling_friction: 0.01)],
        container: Drum(radius_mm: 30, width_mm: 18, speed_rpm: 2, material: "drum"),
        grains: List([
            (position: (0, -0.02, 0), radius_mm: 3, material: "glass"),
            (position: (0.008, -0.02, 0), radius_mm: 3, material: "glass"),
            (position: (-0.008, -0.02, 0), radius_mm: 3, material: "glass"),
        ]),
    )"#;
    let scene = Scene::parse("three grains", text).expect("the scene is valid");
    Simulation::open(scene, standing())
}

/// How a scene is opened that stands still and is moved by the test.
pub fn standing() -> Options {
    Options {
        driver: DriverKind::Inline,
        threads: 1,
        autoplay: false,
        beds: BedStore::none(),
        ..Options::window()
    }
}

/// Three grains with a liquid between them, prepared.
fn wet() -> Simulation {
    let mut scene = three_grains().scene().clone();
    scene.liquid = Some(LIQUID_CASES[3].liquid());
    ready(Simulation::open(scene, standing()))
}

/// The three grains, prepared.
pub fn prepared() -> Simulation {
    ready(three_grains())
}

pub fn ready(mut simulation: Simulation) -> Simulation {
    for _ in 0..1000 {
        simulation.tick(Duration::from_millis(16));
        if !matches!(simulation.status(), Status::Preparing { .. }) {
            return simulation;
        }
    }
    panic!("still {:?}", simulation.status());
}

/// A window with all panels, without a picture.
pub struct Window {
    dock: Dock,
    pub simulation: Simulation,
    view: ViewSettings,
    pub asked: Vec<Request>,
}

impl Window {
    pub fn of(simulation: Simulation) -> Harness<'static, Self> {
        let window = Self {
            dock: Dock::default(),
            simulation,
            view: ViewSettings::default(),
            asked: Vec::new(),
        };
        let mut installed = false;
        let mut harness = Harness::builder()
            .with_size([1600.0, 1400.0])
            .build_ui_state(
                move |ui, window: &mut Window| {
                    if !std::mem::replace(&mut installed, true) {
                        theme::install(ui.ctx());
                    }
                    let simulation = Some(&window.simulation);
                    window
                        .dock
                        .ui(ui, simulation, &mut window.view, &mut window.asked);
                },
                window,
            );
        harness.run_steps(4);
        harness
    }

    pub fn show_panel(&mut self, title: &str) {
        self.dock.show_panel(title);
    }
}

pub fn commands(asked: &[Request]) -> Vec<Command> {
    let command = |request: &Request| match request {
        Request::Command(command) => Some(command.clone()),
        _ => None,
    };
    asked.iter().filter_map(command).collect()
}

pub fn friction() -> Parameter {
    Parameter::Friction("glass".into(), "glass".into())
}

pub fn set(parameter: Parameter, value: impl Into<Value>) -> Command {
    let value = value.into();
    Command::Set { parameter, value }
}

/// A window that shows every parameter.
fn in_the_lab(simulation: Simulation) -> Harness<'static, Window> {
    let mut harness = Window::of(simulation);
    harness.get_by_label("Lab").click();
    harness.run_steps(4);
    harness
}

/// Types `text` into a field of a number: a click begins the edit, Return ends it.
pub fn type_number<S>(harness: &mut Harness<'_, S>, label: &str, text: &str) {
    harness
        .get_by_role_and_label(Role::SpinButton, label)
        .click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

#[test]
fn play_asks_to_play_and_pause_to_pause() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Play").click();
    harness.run_steps(2);
    assert_eq!(commands(&harness.state().asked), [Command::Play]);

    let window = harness.state_mut();
    window.simulation.send(Command::Play);
    window.simulation.tick(Duration::from_millis(16));
    window.asked.clear();
    harness.run_steps(2);
    assert!(harness.query_by_label("Play").is_none());
    harness.get_by_label("Pause").click();
    harness.run_steps(2);
    assert_eq!(commands(&harness.state().asked), [Command::Pause]);
}

#[test]
fn step_and_reset_are_one_command_each() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Single step").click();
    harness.run_steps(2);
    harness.get_by_label("Reset").click();
    harness.run_steps(2);
    assert_eq!(
        commands(&harness.state().asked),
        [Command::Step(1), Command::Reset]
    );
}

#[test]
fn speed_is_chosen_from_a_list_that_ends_with_as_fast_as_possible() {
    let mut harness = Window::of(prepared());
    for (name, speed) in [("0.5×", 0.5), ("max", f64::INFINITY)] {
        harness
            .get_by_role_and_label(Role::ComboBox, "Speed")
            .click();
        harness.run_steps(3);
        harness.get_by_label(name).click();
        harness.run_steps(3);
        let asked = commands(&harness.state().asked);
        assert_eq!(asked.last(), Some(&Command::Speed(speed)), "{name}");
    }
}

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
fn reset_all_sets_what_was_changed_and_nothing_else() {
    let mut simulation = prepared();
    let speed = simulation.value(&Parameter::DrumSpeed);
    simulation.send(set(friction(), 0.8));
    simulation.send(set(Parameter::DrumSpeed, 1.0));
    let mut harness = Window::of(simulation);
    harness.get_by_label("Reset all").click();
    harness.run_steps(2);
    let mut asked = commands(&harness.state().asked);
    asked.sort_by_key(|command| format!("{command:?}"));
    assert_eq!(
        asked,
        [set(Parameter::DrumSpeed, speed), set(friction(), 0.4)]
    );
}

#[test]
fn reset_all_brings_back_what_acts_at_the_next_start_too() {
    let original = prepared().scene().clone();
    let mut denser = original.clone();
    denser.materials[0].density = 5000.0;
    let opened = Simulation::open(denser, standing()).made_of(original.clone().into());
    let mut harness = Window::of(ready(opened));
    // Basics do not show the density: they say that something is another than in the scene.
    harness.get_by_label_contains("1 more changed");
    harness.get_by_label("Reset all").click();
    harness.run_steps(4);
    harness.get_by_label_contains("not yet in the run");
    press(&mut harness, "Start with these");
    assert_eq!(harness.state().asked, [Request::Start(Box::new(original))]);
}

#[test]
fn reset_all_forgets_what_is_not_yet_in_the_run() {
    let mut harness = in_the_lab(prepared());
    let reset = |harness: &Harness<'_, Window>| {
        let button = harness.get_by_label("Reset all");
        !button.accesskit_node().is_disabled()
    };
    assert!(!reset(&harness));
    type_number(&mut harness, "density glass", "5000");
    assert!(reset(&harness));
    press(&mut harness, "Reset all");
    assert_eq!(harness.state().asked, []);
    assert!(harness.query_by_label("Start with these").is_none());
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
        move |ui, asked: &mut Vec<Command>| {
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
    assert_eq!(
        harness.state().first(),
        Some(&set(Parameter::Share("red".into()), 0.5))
    );
}

#[test]
fn a_scene_that_stands_still_has_one_big_button() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Play Three grains").click();
    harness.run_steps(2);
    assert_eq!(commands(&harness.state().asked), [Command::Play]);
    harness.state_mut().asked.clear();
    harness.get_by_label("Other scenes…").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::ShowScenes]);
    let simulation = &mut harness.state_mut().simulation;
    simulation.send(Command::Step(3));
    simulation.tick(Duration::from_millis(16));
    harness.run_steps(2);
    assert!(harness.query_by_label("Play Three grains").is_none());
}

#[test]
fn the_gallery_says_what_to_look_for_and_how_fast_scenes_run_here() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = UserMemory::at(folder.path().join("remembered.json"));
    memory.ran("small-drum", 12.0);
    memory.opened("lecture/slides.grainfall");
    let mut harness = Window::of(prepared());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::G);
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::ShowScenes]);
    harness.state_mut().asked.clear();
    harness.state_mut().dock.remember(memory);
    harness.state_mut().dock.show_scenes();
    harness.run_steps(6);
    // It is as high as the window lets it be.
    let gallery_end = harness.get_by_label("Close").rect().bottom();
    assert!(gallery_end > 0.8 * 1400.0, "{gallery_end}");
    let small = Scene::open("small-drum").unwrap();
    harness.get_by_label(&small.look_for);
    harness.get_by_label_contains("100 grains · 12 times real time here");
    // A drum of more grains is expected to be slower; of polyhedra nothing is known.
    assert!(
        harness
            .get_all_by_label_contains("here, by its size")
            .count()
            > 5
    );
    assert_eq!(
        harness
            .get_all_by_label_contains("not run here yet")
            .count(),
        built_in()
            .iter()
            .filter(|scene| Scene::open(scene.name).unwrap().is_polyhedral())
            .count()
    );
    press(&mut harness, &format!("Open {}", small.title));
    assert_eq!(harness.state().asked, [Request::Open("small-drum".into())]);
    assert!(
        harness.query_by_label("Files opened last").is_none(),
        "it is closed"
    );
    harness.state_mut().asked.clear();
    harness.state_mut().dock.show_scenes();
    harness.run_steps(10);
    press(&mut harness, "lecture/slides.grainfall");
    let file = Request::Open("lecture/slides.grainfall".into());
    assert_eq!(harness.state().asked, [file]);
}

#[test]
fn how_much_is_shown_is_remembered() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("remembered.json");
    let mut harness = Window::of(prepared());
    harness
        .state_mut()
        .dock
        .remember(UserMemory::at(path.clone()));
    harness.get_by_label("Lab").click();
    harness.run_steps(4);
    assert_eq!(UserMemory::at(path).detail(), Detail::Lab);
}

#[test]
fn the_look_is_as_it_was_the_last_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("remembered.json");
    let look = Look {
        scale: 1.25,
        background: Background::Light,
    };
    UserMemory::at(path.clone()).keep_look(look);
    let mut harness = Window::of(prepared());
    harness
        .state_mut()
        .dock
        .remember(UserMemory::at(path.clone()));
    harness.run_steps(4);
    assert_eq!(harness.ctx.theme(), egui::Theme::Light);
    assert_eq!(harness.ctx.zoom_factor(), 1.25);
    assert_eq!(
        UserMemory::at(path.clone()).look(),
        look,
        "nobody changed it"
    );
    harness.ctx.set_zoom_factor(1.5);
    harness.run_steps(2);
    let look = Look { scale: 1.5, ..look };
    assert_eq!(UserMemory::at(path).look(), look);
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
    let slider = harness
        .get_by_role_and_label(Role::Slider, "friction glass – glass")
        .rect();
    // A pixel beside the place of 0.1: between the knob's halves lies the range from 0 to 1.
    let knob = slider.height() / 2.5;
    let span = slider.x_range().shrink(knob);
    let near = egui::pos2(egui::lerp(span, 0.1) + 1.5, slider.center().y);
    harness.state_mut().asked.clear();
    harness.drag_at(near);
    harness.run_steps(2);
    assert_eq!(
        commands(&harness.state().asked).last(),
        Some(&set(friction(), 0.1))
    );
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

/// Scrolls to a button and presses it.
fn press(harness: &mut Harness<'_, Window>, label: &str) {
    harness.get_by_label(label).scroll_to_me();
    harness.run_steps(30);
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

#[test]
fn what_acts_later_waits_for_the_next_start() {
    let mut harness = in_the_lab(prepared());
    type_number(&mut harness, "density glass", "5000");
    type_number(&mut harness, "Poisson's ratio drum", "0.3");
    assert_eq!(harness.state().asked, [], "the run goes on as it is");
    harness.get_by_label_contains("not yet in the run");
    press(&mut harness, "Reset Poisson's ratio drum");
    press(&mut harness, "Start with these");
    let mut expected = harness.state().simulation.scene().clone();
    expected.materials[0].density = 5000.0;
    assert_eq!(harness.state().asked, [Request::Start(Box::new(expected))]);
    press(&mut harness, "Forget these");
    assert!(harness.query_by_label("Start with these").is_none());
}

#[test]
fn keys_ask_for_what_the_sheet_of_shortcuts_says() {
    let mut harness = Window::of(prepared());
    let cases = [
        (Key::Space, Request::Command(Command::Play)),
        (Key::Period, Request::Command(Command::Step(1))),
        (Key::ArrowRight, Request::Command(Command::Step(1))),
        (Key::R, Request::Command(Command::Reset)),
        (Key::F, Request::Camera(CameraRequest::Fit)),
        (Key::Num5, Request::Camera(CameraRequest::From(Side::Above))),
    ];
    for (key, request) in cases {
        harness.state_mut().asked.clear();
        harness.key_press(key);
        harness.run_steps(2);
        assert_eq!(harness.state().asked, [request], "{key:?}");
    }
    harness.state_mut().asked.clear();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::ChooseFile]);
}

#[test]
fn keys_written_into_a_field_are_no_shortcuts() {
    let mut harness = Window::of(prepared());
    harness
        .get_by_role_and_label(Role::SpinButton, "friction glass – glass")
        .click();
    harness.run_steps(2);
    for key in [Key::Space, Key::R, Key::Num1, Key::Period] {
        harness.key_press(key);
        harness.run_steps(2);
    }
    assert_eq!(harness.state().asked, []);
}

#[test]
fn while_the_bed_is_prepared_there_is_progress_and_nothing_to_play() {
    let mut harness = Window::of(three_grains());
    harness.get_by_label("Preparing the bed");
    for label in ["Play", "Single step", "Reset"] {
        harness.get_by_label(label).click();
        harness.run_steps(2);
    }
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert_eq!(harness.state().asked, []);

    let status = Status::Preparing {
        stage: "settling".into(),
        progress: 0.43,
    };
    let harness = Harness::new_ui(move |ui| status_ui(ui, &status, 1e-5, true, &mut Vec::new()));
    let bar = harness.get_by_role_and_label(Role::ProgressIndicator, "Preparing the bed");
    assert_eq!(numeric_value(&bar), Some(f64::from(0.43_f32)));
}

fn numeric_value(node: &Node<'_>) -> Option<f64> {
    use egui_kittest::kittest::NodeT;
    node.accesskit_node().numeric_value()
}

#[test]
fn a_fault_says_what_happened_and_what_to_do() {
    let status = Status::Faulted(Fault {
        grain: 17,
        time: 1.25,
        good_time: 1.24,
        kind: FaultKind::NotFinite("velocity"),
    });
    let mut harness = Harness::new_ui_state(
        move |ui, asked: &mut Vec<Request>| status_ui(ui, &status, 2e-5, true, asked),
        Vec::new(),
    );
    harness.get_by_label_contains("grain 17 at t = 1.250000 s");
    harness.get_by_label_contains("time_step");
    harness.get_by_label("Back to time zero").click();
    harness.run();
    assert_eq!(*harness.state(), [Request::Command(Command::Reset)]);
}

#[test]
fn a_scene_that_cannot_be_opened_is_explained_until_it_is_closed() {
    let reason = Scene::parse("bad.ron", "(title: 3)")
        .expect_err("a title is a text")
        .to_string();
    let shown = reason.clone();
    let mut harness = Harness::new_ui_state(
        move |ui, open: &mut bool| {
            if *open {
                *open = open_error_ui(ui.ctx(), &shown);
            }
        },
        true,
    );
    harness.run_steps(3);
    harness.get_by_label(&reason);
    assert!(*harness.state(), "it stays until it is closed");
    harness.get_by_label("Close").click();
    harness.run_steps(3);
    assert!(!*harness.state());
}

#[test]
fn a_scene_error_leaves_the_present_scene_as_it_is() {
    let mut harness = Window::of(prepared());
    harness
        .state_mut()
        .dock
        .show_open_error("bad.ron, line 3: no".into());
    harness.run_steps(3);
    harness.get_by_label("bad.ron, line 3: no");
    assert_eq!(*harness.state().simulation.status(), Status::Paused);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert_eq!(
        harness.state().asked,
        [],
        "keys wait until the message is closed"
    );
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("bad.ron, line 3: no").is_none());
}

#[test]
fn work_in_no_file_is_saved_discarded_or_kept_open() {
    let leave = || Request::Leave(Box::new(Request::Quit));
    let save = || Request::SaveThen(Box::new(Request::Quit));
    for (answer, expected) in [
        ("Save", vec![save()]),
        ("Discard", vec![leave()]),
        ("Cancel", Vec::new()),
    ] {
        let mut harness = Window::of(prepared());
        harness.state_mut().dock.ask_to_save(Request::Quit);
        harness.run_steps(3);
        harness.key_press(Key::R);
        harness.run_steps(2);
        assert_eq!(harness.state().asked, [], "keys wait for the answer");
        harness.get_by_label(answer).click();
        harness.run_steps(3);
        assert_eq!(harness.state().asked, expected, "{answer}");
        assert!(harness.query_by_label("Save the session?").is_none());
    }
    // The keyboard alone: Escape stays, Tab and Return choose.
    let mut harness = Window::of(prepared());
    harness.state_mut().dock.ask_to_save(Request::Quit);
    harness.run_steps(3);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert_eq!(harness.state().asked, []);
    assert!(harness.query_by_label("Save the session?").is_none());
    harness.state_mut().dock.ask_to_save(Request::Quit);
    harness.run_steps(3);
    harness.key_press(Key::Tab);
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(harness.state().asked, [save()]);
}

#[test]
fn sessions_are_saved_by_key_and_by_menu() {
    let mut harness = Window::of(prepared());
    let ctrl_shift = Modifiers::COMMAND | Modifiers::SHIFT;
    for (modifiers, request) in [
        (Modifiers::COMMAND, Request::Save),
        (ctrl_shift, Request::ChooseSession),
    ] {
        harness.state_mut().asked.clear();
        harness.key_press_modifiers(modifiers, Key::S);
        harness.run_steps(2);
        assert_eq!(harness.state().asked, [request]);
    }
    harness.state_mut().asked.clear();
    harness.get_by_label("File").click();
    harness.run_steps(4);
    harness.get_by_label_contains("Save the session as").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::ChooseSession]);
}

#[test]
fn a_path_can_be_typed_where_the_system_has_no_dialog() {
    let mut harness = Window::of(prepared());
    let purpose = Purpose::Open;
    harness
        .state_mut()
        .dock
        .path_dialog
        .type_path(purpose, "There is no dialog here.");
    harness.run_steps(3);
    harness.get_by_label("There is no dialog here.");
    harness.event(egui::Event::Text("scenes/mine.ron".into()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(
        harness.state().asked,
        [Request::Open("scenes/mine.ron".into())]
    );
    assert!(harness.query_by_label("There is no dialog here.").is_none());
}

#[test]
fn a_panel_that_opens_scrolls_into_view_and_asks_to_export_its_plot() {
    let mut simulation = prepared();
    simulation.send(Command::Step(2000));
    let mut harness = Window::of(ready(simulation));
    harness.set_size(egui::vec2(1280.0, 640.0));
    harness.run_steps(4);
    harness.get_by_label("Any quantity").click();
    harness.run_steps(60);
    let export = harness.get_by_label("Export…");
    assert!(export.rect().bottom() < 640.0, "{:?}", export.rect());
    export.click();
    harness.run_steps(2);
    assert!(matches!(
        harness.state().asked[..],
        [Request::ExportPlot(_)]
    ));
}

#[test]
fn a_narrow_window_shows_the_side_that_is_wanted_and_says_why_not_both() {
    let mut harness = Window::of(prepared());
    harness.set_size(egui::vec2(800.0, 700.0));
    harness.run_steps(4);
    assert!(harness.query_by_label("Last 20 s").is_none());
    harness.get_by_label("View").click();
    harness.run_steps(4);
    harness.get_by_label_contains("room for one of them");
    harness.get_by_label("Controls on the left").click();
    harness.run_steps(10);
    harness.get_by_label("Last 20 s");
}

#[test]
fn a_control_that_the_focus_comes_to_scrolls_into_view() {
    let mut harness = Window::of(prepared());
    harness.set_size(egui::vec2(1280.0, 500.0));
    harness.run_steps(4);
    let field = |harness: &Harness<'_, Window>| {
        let field = harness.get_by_role_and_label(Role::SpinButton, "Averages from");
        field.focus();
        field.rect()
    };
    assert!(field(&harness).top() > 500.0);
    harness.run_steps(60);
    assert!(field(&harness).bottom() < 500.0);
}

#[test]
fn it_is_said_where_a_file_goes_and_what_it_replaces() {
    let folder = tempfile::tempdir().unwrap();
    let taken = folder.path().join("taken.grainfall");
    std::fs::write(&taken, "").unwrap();
    let mut harness = Window::of(prepared());
    let dialog = &mut harness.state_mut().dock.path_dialog;
    dialog.type_path(Purpose::Session, "There is no dialog here.");
    harness.run_steps(3);
    let mut write = |path: &Path| {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.event(egui::Event::Text(path.display().to_string()));
        harness.run_steps(3);
        let labels = ["Goes to", "Replaces", "There is a folder"];
        let said = labels.map(|words| harness.query_by_label_contains(words).is_some());
        (
            said,
            harness.get_by_label("Save").accesskit_node().is_disabled(),
        )
    };
    assert_eq!(
        write(&folder.path().join("free")),
        ([true, false, false], false)
    );
    assert_eq!(
        write(&folder.path().join("taken")),
        ([false, true, false], false)
    );
    std::fs::remove_file(&taken).unwrap();
    std::fs::create_dir(&taken).unwrap();
    assert_eq!(write(&taken), ([false, false, true], true));
}

#[test]
fn the_file_menu_opens_built_in_scenes() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("File").click();
    harness.run_steps(4);
    harness.get_by_label_contains("Built-in scenes").click();
    harness.run_steps(4);
    harness.get_by_label_contains("dry-r2").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::Open("dry-r2".into())]);
}

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

/// Ten thousand samples of a sawtooth, with its avalanches.
struct Sawtooth {
    series: Series,
    avalanches: Vec<Avalanche>,
}

impl Sawtooth {
    fn new() -> Self {
        let mut series = Series::default();
        for i in 0..10_000 {
            let time = f64::from(i) * 0.02;
            let temperature = if time % 1.0 < 0.1 { 1e-5 } else { 1e-10 };
            series.push(sample(time, 0.4 + 0.05 * (time % 1.0), temperature));
        }
        let avalanche = |i: u32| Avalanche {
            start: f64::from(i),
            end: f64::from(i) + 0.1,
            theta_m: 0.45,
            theta_r: 0.40,
        };
        Self {
            series,
            avalanches: (0..200).map(avalanche).collect(),
        }
    }

    fn curves(&self) -> Curves<'_> {
        Curves {
            series: &self.series,
            compared: None,
            avalanches: &self.avalanches,
            changes: &[3.0, 3.01, 190.0],
            kept: &[],
            shown: None,
        }
    }
}

/// A sample at `time` [s] of a surface of this `angle` [rad].
pub fn sample(time: f64, angle: f64, temperature: f64) -> Sample {
    let mut values = [f64::NAN; Measure::COUNT];
    values[Measure::SurfaceAngle as usize] = angle;
    values[Measure::GranularTemperature as usize] = temperature;
    Sample {
        step: (time * 1e5).round() as u64,
        time,
        values,
    }
}

#[test]
fn ten_thousand_samples_are_drawn_with_no_more_points_than_pixels_need() {
    let width = 400.0;
    let data = Sawtooth::new();
    let mut plots = AvalanchePlots::default();
    let mut harness = Harness::builder()
        .with_size([width, 500.0])
        .build_ui(move |ui| assert_eq!(plots.curves_ui(ui, &data.curves()), None));
    harness.run_steps(2);
    harness.get_by_label("All").click();
    harness.run_steps(3);
    let longest = longest_line(&harness.output().shapes);
    assert!(longest > 200, "the curve is drawn: {longest} points");
    assert!(
        longest < 2 * width as usize + 10,
        "{longest} points for {width} pixels"
    );
}

#[test]
fn plots_without_samples_draw_nothing_and_do_not_fail() {
    let mut plots = AvalanchePlots::default();
    let series = Series::default();
    let mut harness = Harness::new_ui(move |ui| {
        let empty = Curves {
            series: &series,
            compared: None,
            avalanches: &[],
            changes: &[],
            kept: &[],
            shown: None,
        };
        assert_eq!(plots.curves_ui(ui, &empty), None);
    });
    harness.run_steps(3);
    harness.get_by_label("Surface angle θ [°]");
}

/// Points of the longest line among `shapes`.
fn longest_line(shapes: &[egui::epaint::ClippedShape]) -> usize {
    fn points(shape: &Shape) -> usize {
        match shape {
            Shape::Path(path) => path.points.len(),
            Shape::Vec(shapes) => shapes.iter().map(points).max().unwrap_or(0),
            _ => 0,
        }
    }
    shapes
        .iter()
        .map(|clipped| points(&clipped.shape))
        .max()
        .unwrap_or(0)
}

#[test]
fn velocities_are_seen_from_the_laboratory_and_from_the_drum() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Velocity map").click();
    harness.run_steps(12);
    // At time zero the grains rest while the drum turns at 0.209 rad/s, 20 to 21.5 mm from its
    // axis.
    harness.get_by_label("Velocity map, up to 0 m/s");
    harness.get_by_label("Relative to the drum").click();
    harness.run_steps(4);
    let map = harness.get_by_label_contains("Velocity map, up to 4.");
    let label = map.accesskit_node().label().unwrap_or_default();
    let number = label.trim_start_matches("Velocity map, up to ");
    let speed: f64 = number.trim_end_matches(" mm/s").parse().unwrap();
    assert!((4.18..4.51).contains(&speed), "{label}");
}

/// `simulation` after `time` of its run.
fn after(mut simulation: Simulation, time: f64) -> Simulation {
    let step = simulation.world().unwrap().clock.step_at(time);
    simulation.send(LabCommand::Hold(Some(step)));
    simulation.send(Command::Speed(f64::INFINITY));
    simulation.send(Command::Play);
    for _ in 0..100_000 {
        simulation.tick(Duration::from_millis(16));
        if simulation.world().unwrap().clock.step >= step {
            return simulation;
        }
    }
    panic!("it does not get there");
}

#[test]
fn microscope_shows_a_grain_its_contacts_and_every_term_of_their_forces() {
    let mut harness = Window::of(after(prepared(), 0.2));
    harness.get_by_label("Microscope").click();
    harness.run_steps(3);
    harness.get_by_label("choose by number").click();
    harness.run_steps(3);
    assert_eq!(harness.state().view.selected, Some(0));
    for label in [
        "Position",
        "Velocity",
        "Spin",
        "Mass",
        "Coordination",
        "Kinetic energy",
    ] {
        harness.get_by_label(label);
    }
    harness.get_by_label("Choose a contact to see its forces.");
    harness.get_by_label_contains("Rim · touches").click();
    harness.run_steps(3);
    for label in [
        "Normal spring",
        "Normal dashpot",
        "Tangential spring",
        "Coulomb bound",
        "Rolling torque",
    ] {
        harness.get_by_label(label);
    }
    harness.get_by_label_contains("Force over gap: ");
    type_number(&mut harness, "Grain", "2");
    assert_eq!(harness.state().view.selected, Some(2));
    harness.get_by_label("Look at no grain").click();
    harness.run_steps(2);
    assert_eq!(harness.state().view.selected, None);
}

#[test]
fn a_grain_that_is_clicked_opens_the_microscope() {
    let mut harness = Window::of(after(wet(), 0.2));
    assert!(harness.query_by_label("Coordination").is_none());
    harness.state_mut().view.selected = Some(1);
    harness.run_steps(4);
    harness.get_by_label("Coordination");
    // A wall holds no liquid; another grain on a bridge does.
    if let Some(wet) = harness.query_by_label_contains("touches, wet") {
        wet.click();
        harness.run_steps(3);
        harness.get_by_label("Capillary");
        harness.get_by_label("Viscous, normal");
    }
    // A grain that the next scene does not have is no grain.
    harness.state_mut().view.selected = Some(1000);
    harness.run_steps(3);
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
fn a_click_on_the_picture_picks_the_grain_under_it() {
    let simulation = prepared();
    let world = simulation.world().unwrap().clone();
    let mut camera = OrbitCamera::default();
    (camera.focus, camera.height, camera.yaw, camera.pitch) =
        (world.grains.position[1].as_vec3(), 0.05, 0.0, 0.0);
    let mut harness = Harness::builder().with_size([400.0, 300.0]).build_ui_state(
        move |ui, (settings, camera): &mut (ViewSettings, OrbitCamera)| {
            let caption = Caption {
                world: Some(&world),
                real_time_factor: None,
                title: None,
            };
            viewport_ui(ui, &[caption], settings, camera);
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

/// A drum whose surface has slid twice, as its samples tell.
fn with_samples() -> Simulation {
    after(prepared(), 0.4)
}

#[test]
fn any_quantity_is_plotted_over_any_other_and_can_be_taken_home() {
    let mut harness = Window::of(with_samples());
    harness.get_by_label("Any quantity").click();
    harness.run_steps(10);
    harness.get_by_label_contains("Kinetic energy E_kin [J] over Time t [s], now ");
    harness
        .get_by_role_and_label(Role::ComboBox, "Over")
        .click();
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::Button, "Coordination number Z")
        .click();
    harness.run_steps(5);
    harness.get_by_label_contains("Kinetic energy E_kin [J] over Coordination number Z, now ");
    harness.get_by_label("Export…").click();
    harness.run_steps(2);
    let asked = std::mem::take(&mut harness.state_mut().asked);
    let [Request::ExportPlot(export)] = &asked[..] else {
        panic!("{asked:?}");
    };
    let folder = tempfile::tempdir().unwrap();
    let samples = harness.state().simulation.series().len();
    let path = folder.path().join("plot.csv");
    export.write(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.lines().count(), samples + 1);
    assert!(text.starts_with("run,time [s],coordination number [1],kinetic energy [J]\n"));
    let path = folder.path().join("plot.svg");
    export.write(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("Coordination number Z") && text.contains("</svg>"));
}

#[test]
fn grains_without_a_bed_are_seen_by_their_energy() {
    let scene = Scene::open("two-grains").unwrap();
    let mut simulation = ready(Simulation::open(scene, standing()));
    carried_out(&mut simulation, Command::Step(2000));
    let harness = Window::of(simulation);
    harness.get_by_label("Kinetic energy E_kin [J] over Time t [s]");
    harness.get_by_label_contains("Where the energy is and went");
    assert!(harness.query_by_label("Surface angle θ [°]").is_none());
    let bed = Window::of(prepared());
    bed.get_by_label("Surface angle θ [°]");
    assert!(
        bed.query_by_label_contains("Where the energy is and went")
            .is_none()
    );
}

#[test]
fn energy_stands_as_a_stack_with_its_residual() {
    let mut harness = Window::of(with_samples());
    harness.get_by_label("Energy").click();
    harness.run_steps(10);
    harness.get_by_label("Energy over time");
    harness.get_by_label_contains("Dashpot loss D_d: ");
    // Here, and among the results.
    let residuals = harness.get_all_by_label("Energy residual ΔE").count();
    assert_eq!(residuals, 2);
}

#[test]
fn a_film_that_is_recorded_can_be_ended_or_cancelled() {
    use grainfall::ui::{FilmState, ScreenshotOrder, film_bar_ui};
    let film = FilmState::Recording {
        pictures: 7,
        time: 0.24,
    };
    let mut harness = Harness::builder().with_size([600.0, 200.0]).build_ui_state(
        |ui, (film, asked): &mut (FilmState, Vec<Request>)| film_bar_ui(ui, *film, asked),
        (film, Vec::new()),
    );
    harness.run_steps(2);
    harness.get_by_label("Recording: 0.24 s, 7 pictures");
    harness.get_by_label("Stop and save").click();
    harness.get_by_label("Cancel the film").click();
    harness.run_steps(2);
    let orders = [ScreenshotOrder::EndFilm, ScreenshotOrder::CancelFilm].map(Request::Screenshot);
    assert_eq!(harness.state().1, orders);
    harness.state_mut().0 = FilmState::Writing(3);
    harness.run_steps(2);
    harness.get_by_label("Writing the film: 3 pictures left");
    assert!(harness.query_by_label("Stop and save").is_none());
    harness.state_mut().0 = FilmState::Idle;
    harness.run_steps(2);
    assert!(harness.query_by_label("Cancel the film").is_none());
}

#[test]
fn a_film_is_asked_for_in_the_menu_and_by_its_key() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("File").click();
    harness.run_steps(3);
    harness.get_by_label_contains("Record a film…").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::ChooseFilm]);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
    harness.run_steps(2);
    assert_eq!(harness.state().asked.len(), 2);
}
