//! The dialogs of pictures and films: what is chosen there is ordered, and what cannot be is said.

use crate::window_of_panels::{Window, prepared, with_samples};
use bevy::math::UVec2;
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::run::Command;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{
    CaptureChoice, CaptureForm, FilmOrder, FilmSpan, PictureOf, PictureOrder, Purpose, Request,
    ScreenshotOrder, UserMemory,
};
use std::path::Path;

/// A window in which somebody is asked what a film is to be like.
fn film_dialog(simulation: Simulation, last: &CaptureChoice) -> Harness<'static, Window> {
    let mut harness = Window::of(simulation);
    let form = CaptureForm::film(last, &harness.state().simulation);
    let dialog = &mut harness.state_mut().dock.path_dialog;
    dialog.ask_with(Purpose::Film, form);
    harness.run_steps(4);
    harness
}

/// The same for a picture.
fn picture_dialog(last: &CaptureChoice) -> Harness<'static, Window> {
    let mut harness = Window::of(prepared());
    let form = CaptureForm::picture(PictureOf::Grains, last);
    let dialog = &mut harness.state_mut().dock.path_dialog;
    dialog.ask_with(Purpose::Picture, form);
    harness.run_steps(4);
    harness
}

/// Types `text` in the place of what the field called `label` holds.
fn write(harness: &mut Harness<'_, Window>, label: &str, text: &str) {
    harness
        .get_by_role_and_label(Role::TextInput, label)
        .focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(3);
}

/// Chooses `entry` of the list called `label`.
fn choose(harness: &mut Harness<'_, Window>, label: &str, entry: &str) {
    harness.get_by_role_and_label(Role::ComboBox, label).click();
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::Button, entry).click();
    harness.run_steps(4);
}

fn is_refused(harness: &Harness<'_, Window>, verb: &str, words: &str) -> bool {
    let is_said = harness.query_by_label_contains(words).is_some();
    is_said && harness.get_by_label(verb).accesskit_node().is_disabled()
}

/// The film that is ordered when Record is pressed.
fn recorded(harness: &mut Harness<'_, Window>) -> FilmOrder {
    harness.get_by_label("Record").click();
    harness.run_steps(3);
    match &harness.state().asked[..] {
        [Request::Screenshot(ScreenshotOrder::Film(order))] => order.clone(),
        asked => panic!("{asked:?}"),
    }
}

const FILM_PATH: &str = "Path; it ends in .gif, or with ffmpeg in .mp4, .webm or .mov; without an ending, a folder of PNG pictures";

#[test]
fn a_picture_is_ordered_at_the_size_that_was_chosen_or_typed() {
    let folder = tempfile::tempdir().unwrap();
    for (chosen, typed, size) in [
        ("3840 × 2160", None, Some(UVec2::new(3840, 2160))),
        ("As in the window", None, None),
        ("Another", Some("1000x500"), Some(UVec2::new(1000, 500))),
    ] {
        let mut harness = picture_dialog(&CaptureChoice::default());
        let path = folder.path().join("picture.png");
        write(
            &mut harness,
            "Path of the PNG file",
            &path.display().to_string(),
        );
        choose(&mut harness, "Size", chosen);
        choose(&mut harness, "Shows", PictureOf::CutOut.label());
        if let Some(typed) = typed {
            write(&mut harness, "Width × height", typed);
        }
        harness.get_by_label("Save").click();
        harness.run_steps(3);
        let of = PictureOf::CutOut;
        let order = ScreenshotOrder::Picture(PictureOrder { path, of, size });
        assert_eq!(harness.state().asked, [Request::Screenshot(order)]);
    }
}

#[test]
fn sizes_that_cannot_be_are_refused_in_the_dialog() {
    let mut harness = picture_dialog(&CaptureChoice::default());
    choose(&mut harness, "Size", "Another");
    for (typed, words) in [
        ("0 × 0", "expected 64 to 8192"),
        ("100000 × 100000", "expected 64 to 8192"),
        ("8192 × 8192", "as many as 7680 × 4320"),
        ("large", "expected width × height"),
        ("", "expected width × height"),
    ] {
        write(&mut harness, "Width × height", typed);
        assert!(is_refused(&harness, "Save", words), "{typed}");
        harness.key_press(Key::Enter);
        harness.run_steps(2);
        assert_eq!(harness.state().asked, [], "{typed}");
    }
}

#[test]
fn a_film_is_ordered_with_its_rate_speed_span_and_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film");
    let mut harness = film_dialog(with_samples(), &CaptureChoice::default());
    write(&mut harness, FILM_PATH, &path.display().to_string());
    choose(&mut harness, "Size", "1920 × 1080");
    choose(&mut harness, "Shows", PictureOf::CutOut.label());
    write(&mut harness, "Frames a second", "50");
    write(&mut harness, "Speed", "0,25");
    harness.get_by_label_contains("5.000 ms of simulated time from frame to frame");
    harness.get_by_label_contains("slow motion, 4 times slower than real time");
    harness.get_by_label("What is recorded").click();
    harness.run_steps(3);
    write(&mut harness, "from", "0.1");
    write(&mut harness, "to", "0.3");
    harness.get_by_label_contains("41 pictures: a film of 0.82 s");
    let order = recorded(&mut harness);
    assert_eq!((order.path, order.of), (path, PictureOf::CutOut));
    assert_eq!(order.size, Some(UVec2::new(1920, 1080)));
    assert_eq!((order.pace.rate, order.pace.speed), (50.0, 0.25));
    assert_eq!(order.span, FilmSpan::Recorded { from: 0.1, to: 0.3 });
}

#[test]
fn films_that_cannot_be_are_refused_in_the_dialog() {
    let mut harness = film_dialog(with_samples(), &CaptureChoice::default());
    let mut refused = |field: &str, typed: &str, good: &str, words: &str| {
        write(&mut harness, field, typed);
        assert!(is_refused(&harness, "Record", words), "{field} {typed}");
        write(&mut harness, field, good);
    };
    refused(
        "Frames a second",
        "0",
        "25",
        "Frames a second: 0 cannot be. Expected: 1 to 60",
    );
    refused("Frames a second", "many", "25", "“many” is not a number");
    refused("Speed", "0", "1", "The speed: 0 cannot be");
    refused("Speed", "-1", "1", "The speed: -1 cannot be");
    refused(FILM_PATH, "film.avi", "film.gif", "not .avi");
    harness.get_by_label("What is recorded").click();
    harness.run_steps(3);
    let mut refused = |field: &str, typed: &str, good: &str, words: &str| {
        write(&mut harness, field, typed);
        assert!(is_refused(&harness, "Record", words), "{field} {typed}");
        write(&mut harness, field, good);
    };
    refused("to", "9", "0.3", "The end: 9 cannot be. Expected: 0 to 0.4");
    refused("from", "-1", "0.1", "The start: -1 cannot be");
    refused(
        "from",
        "0.35",
        "0.1",
        "The film would start at 0.35 s, after its end at 0.3 s",
    );
    refused("Speed", "0.000001", "1", "pictures are too many");
    choose(&mut harness, "Shows", PictureOf::CutOut.label());
    assert!(is_refused(
        &harness,
        "Record",
        "A GIF has no half-transparent pixels"
    ));
    write(&mut harness, FILM_PATH, "film");
    assert_eq!(recorded(&mut harness).path, Path::new("film"));
}

#[test]
fn a_film_of_a_moment_in_the_past_is_one_of_what_is_recorded() {
    let mut simulation = with_samples();
    let end = simulation.past().end;
    crate::timeline::carried_out(&mut simulation, Command::Seek(end.step / 2));
    let mut harness = film_dialog(simulation, &CaptureChoice::default());
    let FilmSpan::Recorded { from, to } = recorded(&mut harness).span else {
        panic!("the run looks back");
    };
    // Up to the last microsecond that there is.
    assert_eq!(from, 0.0);
    assert!(
        to <= end.time && end.time - to < 1.1e-6,
        "{to} {}",
        end.time
    );
    let mut harness = film_dialog(with_samples(), &CaptureChoice::default());
    assert_eq!(recorded(&mut harness).span, FilmSpan::FromNow);
}

#[test]
fn what_was_chosen_is_offered_the_next_time() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("remembered.json");
    let mut harness = film_dialog(prepared(), &CaptureChoice::default());
    choose(&mut harness, "Size", "Another");
    write(&mut harness, "Width × height", "800 × 450");
    choose(&mut harness, "Shows", PictureOf::Grains.label());
    write(&mut harness, "Frames a second", "20");
    let film = recorded(&mut harness);
    let mut memory = UserMemory::at(file.clone());
    memory.keep_capture(&ScreenshotOrder::Film(film.clone()));
    let again = UserMemory::at(file.clone());
    let mut harness = film_dialog(prepared(), again.capture());
    let next = recorded(&mut harness);
    assert_eq!(
        (next.size, next.of, next.pace),
        (film.size, film.of, film.pace)
    );
    // A file that somebody has written by hand asks for nothing that cannot be.
    std::fs::write(
        &file,
        r#"{"capture": {"film_size": [0, 9], "film_rate": -3.0}}"#,
    )
    .unwrap();
    let damaged = UserMemory::at(file);
    assert_eq!(damaged.capture().film_size(), None);
    assert_eq!(damaged.capture().film_rate(), 25.0);
}

#[test]
fn the_dialogs_fit_into_a_small_window_and_are_worked_by_keys() {
    let mut harness = film_dialog(with_samples(), &CaptureChoice::default());
    choose(&mut harness, "Size", "Another");
    harness.get_by_label("What is recorded").click();
    harness.set_size(egui::vec2(1024.0, 640.0));
    harness.run_steps(6);
    let window = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1024.0, 640.0));
    for label in ["Record a film", "Record", "Cancel", "to", "Frames a second"] {
        let places = harness.get_all_by_label(label).map(|node| node.rect());
        let places: Vec<_> = places.collect();
        assert!(
            places.iter().all(|place| window.contains_rect(*place)),
            "{label}: {places:?}"
        );
    }
    // From the path on, Tab comes to every control, and Enter in a field records.
    let path = harness.get_by_role_and_label(Role::TextInput, FILM_PATH);
    path.focus();
    harness.run_steps(2);
    let mut left = vec![
        "Shows",
        "Size",
        "Frames a second",
        "What is recorded",
        "Record",
        "Cancel",
    ];
    for _ in 0..12 {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        left.retain(|label| {
            let mut nodes = harness.get_all_by_label(label);
            !nodes.any(|node| node.accesskit_node().is_focused())
        });
    }
    assert_eq!(left, [""; 0], "Tab does not come to them");
    write(&mut harness, "Frames a second", "10");
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert!(matches!(
        &harness.state().asked[..],
        [Request::Screenshot(ScreenshotOrder::Film(_))]
    ));
}
