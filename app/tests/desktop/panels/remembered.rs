//! What the program remembers: how fast scenes ran, how much was shown, how everything looked.

use crate::window_of_panels::{Window, prepared, press};
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use grainfall::lesson::{Lesson, built_in_lessons};
use grainfall::scene::{Scene, built_in};
use grainfall_app::ui::{Detail, Look, Request, UserMemory};
use grainfall_app::view::Background;

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
            + built_in_lessons()
                .iter()
                .filter(|lesson| Lesson::open(lesson.name).unwrap().1.is_polyhedral())
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
        scale: Some(1.25),
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
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Plus);
    harness.run_steps(3);
    let scale = Some(1.4);
    assert_eq!(harness.ctx.zoom_factor(), 1.4);
    assert_eq!(UserMemory::at(path.clone()).look(), Look { scale, ..look });
    // The window's size decides again.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Num0);
    harness.run_steps(3);
    let scale = None;
    assert_eq!(harness.ctx.zoom_factor(), 1.0);
    assert_eq!(UserMemory::at(path).look(), Look { scale, ..look });
}

#[test]
fn the_gallery_is_in_groups_and_a_card_is_a_button_as_a_whole() {
    let mut harness = Window::of(prepared());
    harness.state_mut().dock.show_scenes();
    harness.run_steps(6);
    let titles = ["Start here", "Drums", "Columns", "One contact", "Papers"];
    let tops = titles.map(|title| harness.get_by_label(title).rect().top());
    assert!(tops.is_sorted(), "{tops:?}");
    let small = Scene::open("small-drum").unwrap();
    harness.get_by_label(&small.look_for).click();
    harness.run_steps(3);
    assert_eq!(harness.state().asked, [Request::Open("small-drum".into())]);
}
