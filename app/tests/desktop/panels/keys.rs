//! Keys: shortcuts, and the focus that the keyboard moves.

use crate::window_of_panels::{Window, prepared, type_number};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::run::Command;
use grainfall_app::ui::Request;
use grainfall_app::view::{CameraRequest, StandardView};

#[test]
fn keys_ask_for_what_the_sheet_of_shortcuts_says() {
    let mut harness = Window::of(prepared());
    let cases = [
        (Key::Space, Request::Command(Command::Play)),
        (Key::Period, Request::Command(Command::Step(1))),
        (Key::ArrowRight, Request::Command(Command::Step(1))),
        (Key::R, Request::Command(Command::Reset)),
        (Key::F, Request::Camera(CameraRequest::Fit)),
        (
            Key::Num5,
            Request::Camera(CameraRequest::From(StandardView::Above)),
        ),
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
fn ten_or_a_hundred_steps_and_a_typed_time_are_one_gesture() {
    let mut harness = Window::of(prepared());
    let shift = Modifiers::COMMAND.plus(Modifiers::SHIFT);
    for (modifiers, steps) in [(Modifiers::COMMAND, 10), (shift, 100)] {
        harness.state_mut().asked.clear();
        harness.key_press_modifiers(modifiers, Key::ArrowRight);
        harness.run_steps(2);
        let step = Request::Command(Command::Step(steps));
        assert_eq!(harness.state().asked, [step]);
    }
    harness.state_mut().asked.clear();
    type_number(&mut harness, "Time", "0.01");
    let time_step = harness.state().simulation.world().unwrap().clock.time_step;
    let steps = (0.01 / time_step).round() as u64;
    assert_eq!(
        harness.state().asked,
        [Request::Command(Command::Step(steps))]
    );
}
