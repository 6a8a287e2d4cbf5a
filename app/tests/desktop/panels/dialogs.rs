//! Windows over the rest: what cannot be opened, work in no file, a path to choose.

use crate::window_of_panels::{Window, prepared};
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::lab::Status;
use grainfall::scene::Scene;
use grainfall_app::ui::{Purpose, Request, Sheet, open_error_ui};
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
    // The keyboard alone: Escape stays, Return chooses.
    let mut harness = Window::of(prepared());
    harness.state_mut().dock.ask_to_save(Request::Quit);
    harness.run_steps(3);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert_eq!(harness.state().asked, []);
    assert!(harness.query_by_label("Save the session?").is_none());
    harness.state_mut().dock.ask_to_save(Request::Quit);
    harness.run_steps(3);
    // The first answer has the focus.
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

/// Sizes of windows in which everything can be reached [points].
const SIZES: [[f32; 2]; 2] = [[1440.0, 900.0], [1024.0, 640.0]];

#[test]
fn sheets_lie_within_the_window_and_scroll_to_their_end() {
    for [width, height] in SIZES {
        let mut harness = Window::of(prepared());
        harness.set_size(egui::vec2(width, height));
        harness.state_mut().dock.show_sheet(Sheet::Shortcuts);
        harness.run_steps(6);
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(width, height));
        for label in ["Shortcuts", "Close"] {
            let place = harness.get_all_by_label(label).map(|node| node.rect());
            assert!(
                place.into_iter().any(|place| window.contains_rect(place)),
                "{label}"
            );
        }
        let last = "Draw its trail, or no longer";
        harness.get_by_label(last).scroll_to_me();
        harness.run_steps(30);
        let place = harness.get_by_label(last).rect();
        let close = harness.get_by_label("Close").rect();
        assert!(place.bottom() <= close.top(), "{place:?} {close:?}");
    }
}

#[test]
fn a_long_error_is_read_without_scrolling_sideways() {
    let reason = format!(
        "{}/scene.ron, line 3: expected a title",
        "a long folder/".repeat(20)
    );
    for [width, height] in SIZES {
        let shown = reason.clone();
        let mut harness = Harness::builder()
            .with_size([width, height])
            .build_ui(move |ui| assert!(open_error_ui(ui.ctx(), &shown)));
        harness.run_steps(4);
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(width, height));
        for label in [reason.as_str(), "Close"] {
            let place = harness.get_by_label(label).rect();
            assert!(window.contains_rect(place), "{label}: {place:?}");
        }
    }
}

#[test]
fn what_is_typed_takes_the_place_of_the_path_that_is_suggested() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = Window::of(prepared());
    let dialog = &mut harness.state_mut().dock.path_dialog;
    dialog.type_path(Purpose::Session, "There is no dialog here.");
    harness.run_steps(4);
    let path = folder.path().join("mine");
    harness.event(egui::Event::Text(path.display().to_string()));
    harness.run_steps(3);
    let whole = path.with_extension("grainfall");
    harness.get_by_label(&format!("Goes to {}", whole.display()));
    // A folder that is not there is a slip more often than a wish.
    harness.event(egui::Event::Text("/other/mine".into()));
    harness.run_steps(3);
    harness.get_by_label_contains("There is no folder");
    assert!(harness.get_by_label("Save").accesskit_node().is_disabled());
}

#[test]
fn a_dialog_and_a_picture_close_what_tells_of_the_place_under_the_pointer() {
    for opens_dialog in [true, false] {
        let mut harness = Window::of(prepared());
        let play = harness.get_by_label("Single step").rect().center();
        harness.event(egui::Event::PointerMoved(play));
        harness.run_steps(60);
        assert!(is_drawn(&harness, "One time step"));
        if opens_dialog {
            harness.state_mut().dock.show_scenes();
        } else {
            harness.state_mut().dock.is_photographed = true;
        }
        harness.run_steps(4);
        assert!(!is_drawn(&harness, "One time step"), "{opens_dialog}");
    }
}

/// Whether `words` are drawn in the window.
fn is_drawn(harness: &Harness<'_, Window>, words: &str) -> bool {
    harness
        .output()
        .shapes
        .iter()
        .any(|clipped| match &clipped.shape {
            egui::Shape::Text(text) => text.galley.text().contains(words),
            _ => false,
        })
}
