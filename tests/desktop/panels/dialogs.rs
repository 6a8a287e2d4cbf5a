//! Windows over the rest: what cannot be opened, work in no file, a path to choose.

use crate::window_of_panels::{Window, prepared};
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::scene::Scene;
use grainfall::simulation::Status;
use grainfall::ui::{Purpose, Request, open_error_ui};
use std::path::Path;

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
