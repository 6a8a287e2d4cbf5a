//! The bars: what playing, stepping, speed and a fault ask for, the film that is recorded, the title
//! and what a scene that was not played invites to.

use crate::window_of_panels::{
    Window, commands, prepared, ready, set, standing, three_grains, wet,
};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use grainfall::lab::Status;
use grainfall::parameters::Parameter;
use grainfall::physics::LIQUID_CASES;
use grainfall::run::Command;
use grainfall::solver::{Fault, FaultKind};
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Request, status_ui};
use std::time::Duration;

/// Asserts that the bar calls what `simulation` shows by this `title`.
#[track_caller]
fn assert_titled(simulation: Simulation, title: &str) {
    let harness = Window::of(simulation);
    let titles = harness.query_all_by_label(title).count();
    assert!(titles >= 2, "in the bar and in the panel about the scene");
}

#[test]
fn title_tells_of_a_liquid_that_the_scene_did_not_state() {
    let with = |parameter: Parameter, value: f64| {
        let mut simulation = wet();
        simulation.send(set(parameter, value));
        simulation.tick(Duration::from_millis(16));
        simulation
    };
    assert_titled(prepared(), "Three grains");
    assert_titled(wet(), "Three grains");
    // More of the same liquid is the same liquid.
    assert_titled(with(Parameter::LiquidVolume, 2e-6), "Three grains");
    let thin = with(Parameter::Viscosity, 0.012);
    assert_titled(thin, "Three grains · now η = 12 mPa s");
    let dry = with(Parameter::LiquidVolume, 0.0);
    assert_titled(dry, "Three grains · now dry");
    let original = wet().scene().clone();
    let mut other = original.clone();
    other.liquid = Some(LIQUID_CASES[6].liquid());
    let chosen = Simulation::open(other, standing()).made_of(original.into());
    assert_titled(ready(chosen), "Three grains · now glycerol");
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
fn a_scene_that_was_not_played_invites_to_play_and_to_other_scenes() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Play").click();
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
    assert!(harness.query_by_label("Other scenes…").is_none());
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
fn a_film_that_is_recorded_can_be_ended_or_cancelled() {
    use grainfall_app::ui::{FilmState, ScreenshotOrder, film_bar_ui};
    let film = FilmState::Recording {
        pictures: 7,
        time: 0.24,
    };
    let mut harness = Harness::builder().with_size([600.0, 200.0]).build_ui_state(
        |ui, (film, asked): &mut (FilmState, Vec<Request>)| film_bar_ui(ui, *film, false, asked),
        (film, Vec::new()),
    );
    harness.run_steps(2);
    harness.get_by_label("Recording: 240.0 ms, 7 pictures");
    harness.get_by_label("Stop and save").click();
    harness.get_by_label("Cancel the film").click();
    harness.run_steps(2);
    let orders = [ScreenshotOrder::EndFilm, ScreenshotOrder::CancelFilm].map(Request::Screenshot);
    assert_eq!(harness.state().1, orders);
    harness.state_mut().0 = FilmState::Replaying {
        pictures: 3,
        all: 12,
    };
    harness.run_steps(2);
    harness.get_by_label("Filming what is recorded: 3 of 12 pictures");
    let progress = harness.get_by_role_and_label(Role::ProgressIndicator, "Film");
    assert_eq!(progress.accesskit_node().numeric_value(), Some(0.25));
    harness.get_by_label("Stop and save");
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
fn a_film_of_a_run_that_stands_says_what_it_waits_for() {
    use grainfall_app::ui::{FilmState, film_bar_ui};
    let film = FilmState::Recording {
        pictures: 1,
        time: 0.0,
    };
    let mut harness = Harness::builder()
        .with_size([600.0, 200.0])
        .build_ui(move |ui| film_bar_ui(ui, film, true, &mut Vec::new()));
    harness.run_steps(2);
    harness.get_by_label_contains("The run stands still: press Play (Space)");
}
