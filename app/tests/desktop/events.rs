//! The list of events, its keys, and the part of a run that is repeated, by their accessible labels.

use crate::window_of_panels::{Window, after, commands, ready, standing};
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::run::{Command, EventKind};
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::Request;

/// A grain that has met the floor twice, and left it.
fn bounced() -> Simulation {
    let scene = Scene::open("bouncing-grain").unwrap();
    after(ready(Simulation::open(scene, standing())), 0.3)
}

fn window() -> Harness<'static, Window> {
    let mut harness = Window::of(bounced());
    harness.state_mut().show_panel("Events");
    harness.run_steps(6);
    harness
}

/// The steps of the events of these `kinds`.
fn steps(simulation: &Simulation, kinds: &[EventKind]) -> Vec<u64> {
    let times = simulation.step_times().unwrap();
    let events = simulation.events().iter();
    let events = events.filter(|event| kinds.contains(&event.kind()));
    events.map(|event| times.step_at(event.time)).collect()
}

/// What was asked for last.
fn asked(harness: &mut Harness<'_, Window>) -> Vec<Command> {
    harness.run_steps(3);
    commands(&std::mem::take(&mut harness.state_mut().asked))
}

#[test]
fn a_click_on_an_impact_asks_for_its_moment() {
    let mut harness = window();
    let impacts = steps(&harness.state().simulation, &[EventKind::Impact]);
    assert_eq!(impacts.len(), 2);
    // 5 cm in 101 ms, then 0.8 of the speed of 0.99 m/s.
    let rows = [
        "grain 0 and floor meet at 990",
        "grain 0 and floor meet at 79",
    ];
    for (row, step) in rows.into_iter().zip(impacts) {
        harness.get_by_label_contains(row).click();
        assert_eq!(asked(&mut harness), [Command::Seek(step)], "{row}");
    }
}

#[test]
fn kinds_are_hidden_and_shown_and_words_are_searched_for() {
    let mut harness = window();
    let parts = |harness: &Harness<'_, Window>| {
        harness
            .query_all_by_label_contains("floor part, after")
            .count()
    };
    let meets = |harness: &Harness<'_, Window>| {
        harness.query_all_by_label_contains("floor meet at").count()
    };
    assert_eq!((meets(&harness), parts(&harness)), (2, 0));
    harness.get_by_label("Partings 2").click();
    harness.run_steps(3);
    assert_eq!((meets(&harness), parts(&harness)), (2, 2));
    harness.get_by_label("Search events").focus();
    harness.run_steps(2);
    harness.event(egui::Event::Text("Part µs".to_owned()));
    harness.run_steps(3);
    assert_eq!((meets(&harness), parts(&harness)), (0, 2));
    harness.event(egui::Event::Text("zzz".to_owned()));
    harness.run_steps(3);
    assert_eq!((meets(&harness), parts(&harness)), (0, 0));
    harness.get_by_label_contains("No event is of these kinds");
}

#[test]
fn keys_lead_from_event_to_event_of_the_kinds_shown() {
    let mut harness = window();
    let impacts = steps(&harness.state().simulation, &[EventKind::Impact]);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::E);
    assert_eq!(asked(&mut harness), [Command::Seek(impacts[1])]);
    // At the newest state there is none after it.
    harness.key_press(Key::E);
    assert_eq!(asked(&mut harness), []);
    harness.get_by_label("Partings 2").click();
    harness.run_steps(3);
    let all = [EventKind::Impact, EventKind::Parting];
    let all = steps(&harness.state().simulation, &all);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::E);
    assert_eq!(asked(&mut harness), [Command::Seek(all[3])]);
    assert!(all[3] > impacts[1]);
}

#[test]
fn a_key_and_a_button_mark_what_is_repeated() {
    let mut harness = window();
    harness.get_by_label("Repeat a part").click();
    harness.run_steps(3);
    harness.key_press(Key::L);
    harness.run_steps(3);
    let repeats = [Request::Repeat, Request::Repeat];
    assert_eq!(harness.state().asked, repeats);
}
