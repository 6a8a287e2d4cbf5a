//! A lesson by keyboard alone, from its first step to its last; and in a session.

use crate::window_of_panels::{Window, prepared, ready, standing};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::lesson::{Change, Lesson, Prediction, Stage, built_in_lessons};
use grainfall::parameters::Parameter;
use grainfall::run::Command;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{LessonAct, Request, SessionLook};
use grainfall_app::view::ViewSettings;
use std::time::Duration;

const LESSON: &str = r#"Lesson(
    title: "Three beads",
    about: "What moves three beads?",
    scene: "small-drum",
    steps: [
        (title: "Look", text: "Three beads lie in a drum.", touch: ["play"]),
        (
            title: "Here",
            text: "The drum turns.",
            speed: 50,
            ask: Number(
                question: "How fast are they on average, in m/s?",
                quantity: "mean speed",
                of: Last,
                span: (0, 0.05),
                scatter: (deviation: 0.0001, runs: 8),
                tolerance: 0.1,
            ),
            hints: ["Slowly."],
            why: "The drum carries them.",
        ),
        (
            title: "On the Moon",
            text: "Everything weighs less.",
            set: {"gravity": "1.62"},
            speed: 50,
            ask: Change(
                question: "And there?",
                quantity: "mean speed",
                of: Last,
                span: (0, 0.05),
                scatter: (deviation: 0.0001, runs: 8),
                than: "Here",
                same_within: 0.5,
            ),
        ),
    ],
)"#;

fn lesson() -> Lesson {
    Lesson::parse("beads.ron", LESSON).unwrap_or_else(|error| panic!("{error}"))
}

fn window() -> Harness<'static, Window> {
    let mut harness = Window::of(prepared());
    harness
        .state_mut()
        .dock
        .lesson_opened("beads.ron", lesson());
    harness.run_steps(4);
    harness
}

/// Fulfils what was asked for, as the window does; says whether anything was.
fn fulfil(harness: &mut Harness<'_, Window>) -> bool {
    let window = harness.state_mut();
    let asked = std::mem::take(&mut window.asked);
    let some = !asked.is_empty();
    for request in asked {
        match request {
            Request::Lesson(act) => {
                for command in window.dock.lesson.act(act, &window.simulation) {
                    window.simulation.send(command);
                }
            }
            Request::Command(command) => window.simulation.send(command),
            other => panic!("{other:?}"),
        }
    }
    some
}

/// Presses a key and lets the window do what it asks for.
fn press(harness: &mut Harness<'_, Window>, key: Key) {
    harness.key_press(key);
    harness.run_steps(2);
    assert!(fulfil(harness), "{key:?} asks for nothing");
    harness.run_steps(3);
}

fn stage(harness: &Harness<'_, Window>) -> Stage {
    harness.state().dock.lesson.under_way().unwrap().stage()
}

/// Lets the run go on until the experiment has answered.
fn wait(harness: &mut Harness<'_, Window>) {
    for _ in 0..10_000 {
        harness
            .state_mut()
            .simulation
            .tick(Duration::from_millis(16));
        harness.step();
        fulfil(harness);
        if stage(harness) == Stage::Answered {
            harness.run_steps(3);
            return;
        }
    }
    panic!("still {:?}", stage(harness));
}

#[test]
fn a_lesson_is_followed_by_keyboard_alone() {
    let mut harness = window();
    harness.get_by_label("Step 1 of 3");
    harness.get_by_label("Three beads lie in a drum.");
    press(&mut harness, Key::Enter);
    harness.get_by_label("Step 2 of 3");
    // The field has the focus: a number, Enter, Enter.
    assert_eq!(stage(&harness), Stage::Asking);
    harness.event(egui::Event::Text("slow".to_owned()));
    harness.run_steps(2);
    harness.get_by_label_contains("is no number");
    for _ in 0..4 {
        harness.key_press(Key::Backspace);
    }
    harness.event(egui::Event::Text("0,5".to_owned()));
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    assert_eq!(stage(&harness), Stage::Predicted);
    harness.get_by_label("You say 0.5 m/s.");
    press(&mut harness, Key::Enter);
    assert!(matches!(stage(&harness), Stage::Playing(_)));
    wait(&mut harness);
    harness.get_by_label_contains("You said 0.5 m/s. Measured: ");
    harness.get_by_label_contains("too high");
    harness.get_by_label("The drum carries them.");
    harness.get_by_label("Hint: Slowly.");

    press(&mut harness, Key::N);
    harness.get_by_label("Step 3 of 3");
    press(&mut harness, Key::Minus);
    let said = harness
        .state()
        .dock
        .lesson
        .under_way()
        .unwrap()
        .answer()
        .prediction;
    assert_eq!(said, Some(Prediction::Change(Change::Lower)));
    press(&mut harness, Key::Equals);
    // What the step sets is shown, though it is none of the basics.
    harness.get_by_role_and_label(Role::SpinButton, "gravity");
    harness.get_by_label_contains("with gravity = 1.62 m/s²");
    press(&mut harness, Key::Enter);
    wait(&mut harness);
    harness.get_by_label_contains("You said the same. Measured: ");
    harness.get_by_label_contains("It is the same: well predicted.");
    let gravity = harness.state().simulation.value(&Parameter::Gravity);
    assert_eq!(gravity, Some(1.62.into()));

    press(&mut harness, Key::B);
    harness.get_by_label_contains("You said 0.5 m/s.");
    press(&mut harness, Key::A);
    assert_eq!(stage(&harness), Stage::Asking);
}

#[test]
fn buttons_ask_for_the_same_as_keys() {
    let mut harness = window();
    for (label, act) in [
        ("Next  (N)", LessonAct::Next),
        ("Leave the lesson", LessonAct::Leave),
    ] {
        harness.get_by_label(label).click();
        harness.run_steps(2);
        assert_eq!(harness.state().asked, [Request::Lesson(act)], "{label}");
        fulfil(&mut harness);
        harness.run_steps(3);
    }
    assert!(harness.state().dock.lesson.under_way().is_none());
    assert!(harness.query_by_label("Step 2 of 3").is_none());
}

#[test]
fn a_session_goes_on_in_its_step_with_its_answers() {
    let mut harness = window();
    press(&mut harness, Key::N);
    let view = ViewSettings::default();
    let window = harness.state_mut();
    let say = LessonAct::Say(Prediction::Number(0.01));
    window.dock.lesson.act(say, &window.simulation);
    let words = SessionLook::of(&view, None, &window.dock).in_words();
    let kept = window.dock.lesson.under_way().cloned();

    let mut other = Window::of(prepared());
    let window = other.state_mut();
    let scene = window.simulation.scene().clone();
    let look = SessionLook::read(&words).unwrap();
    look.restore(&mut window.view, None, &mut window.dock, &scene);
    other.run_steps(4);
    assert_eq!(other.state().dock.lesson.under_way().cloned(), kept);
    other.get_by_label("Step 2 of 3");
    other.get_by_label("You say 0.01 m/s.");
}

#[test]
fn lessons_stand_first_in_the_gallery() {
    let mut harness = Window::of(prepared());
    harness.state_mut().dock.show_scenes();
    harness.run_steps(4);
    let lessons = harness.get_by_label("Lessons").rect();
    assert!(lessons.bottom() < harness.get_by_label("Start here").rect().top());
    let own = &built_in_lessons()[0];
    let (lesson, scene) = Lesson::open(own.name).unwrap();
    harness
        .get_by_label(&format!("Open {}", lesson.title))
        .click();
    harness.run_steps(3);
    assert_eq!(harness.state().asked, [Request::Open(own.name.to_owned())]);
    assert!(scene.grain_count() <= 200, "it opens at once");
}

#[test]
fn a_lesson_leaves_room_for_what_it_speaks_of() {
    let mut harness = Window::of(ready(Simulation::open(
        prepared().scene().clone(),
        standing(),
    )));
    harness.set_size(egui::vec2(1024.0, 640.0));
    harness
        .state_mut()
        .dock
        .lesson_opened("beads.ron", lesson());
    harness.run_steps(6);
    let next = harness.get_by_label("Next  (N)").rect();
    assert!(next.bottom() < 520.0, "{next:?}");
    harness.get_by_label("Parameters");
    let play = Request::Command(Command::Play);
    harness.state_mut().asked.clear();
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [play]);
}
