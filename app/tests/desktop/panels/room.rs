//! Room: how much of the window the picture has, how large text is, where panels stand, what is left
//! of them while something is presented.

use crate::measured::caption;
use crate::window_of_panels::{Window, in_the_lab, prepared, ready, standing};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Event, Key, Pos2, Rect, Shape, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::measure::numeral::moment;
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Request, UserMemory};
use grainfall_app::view::{Caption, Measured, OrbitCamera, ViewSettings, viewport_ui};

/// Share of the window that the picture has at least.
const PICTURE: f32 = 0.45;
/// Margin that the tests' window has round everything, and a real one has not [points].
const MARGIN: f32 = 8.0;

/// Scenes of each kind that open at once: a drum, one grain, a heap of a few.
fn simulations() -> Vec<Simulation> {
    let open = |name: &str| Simulation::open(Scene::open(name).unwrap(), standing());
    let known = ["bouncing-grain", "slide-to-roll", "two-grains"].map(open);
    let known = known.into_iter().map(ready);
    known.chain([prepared()]).collect()
}

/// What sticks out of the window of this `size` to the left or the right, or out of the side that it
/// stands on into the picture.
fn overflowing(harness: &Harness<'_, Window>, size: Vec2) -> Vec<String> {
    let free = harness.state().free;
    let nodes = harness.root().children_recursive();
    let named = nodes.filter(|node| node.accesskit_node().label().is_some());
    let sticks_out = |place: Rect| {
        let beyond = place.left() < -0.5 || place.right() > size.x + 0.5;
        let side = place.left() < free.left() - 0.5 || place.right() > free.right() + 0.5;
        let picture = place.top() >= free.top() && place.bottom() <= free.bottom();
        let over = side && picture && place.intersect(free).width() > 1.0;
        beyond || over
    };
    let out = named.filter(|node| node.rect().is_positive() && sticks_out(node.rect()));
    out.map(|node| {
        let label = node.accesskit_node().label();
        format!("{label:?} {:?} free {free:?}", node.rect())
    })
    .collect()
}

#[test]
fn the_picture_has_its_share_of_every_window_and_nothing_sticks_out() {
    for simulation in simulations() {
        let mut harness = in_the_lab(simulation);
        for size in [
            [1024.0, 640.0],
            [1280.0, 720.0],
            [1440.0, 900.0],
            [700.0, 600.0],
        ] {
            let size = Vec2::from(size);
            harness.set_size(size);
            harness.run_steps(8);
            let free = harness.state().free.expand(MARGIN);
            let share = free.area() / (size.x * size.y);
            assert!(share >= PICTURE, "{size}: {share} {free:?}");
            assert_eq!(overflowing(&harness, size), [""; 0], "{size}");
        }
        // The other side alone.
        harness.set_size(vec2(1024.0, 640.0));
        harness.get_by_label("View").click();
        harness.run_steps(4);
        harness.get_by_label("Controls on the left").click();
        harness.run_steps(12);
        harness.key_press(Key::Escape);
        harness.run_steps(12);
        let free = harness.state().free.expand(MARGIN);
        let share = free.area() / (1024.0 * 640.0);
        assert!(share >= PICTURE && free.left() < 1.0, "{share} {free:?}");
        assert_eq!(overflowing(&harness, vec2(1024.0, 640.0)), [""; 0]);
    }
}

#[test]
fn text_is_twice_as_large_in_a_window_of_four_times_the_pixels() {
    let mut harness = Window::of(prepared());
    for (size, scale) in [([1440.0, 900.0], 1.0), ([3840.0, 2160.0], 2.0)] {
        harness.set_size(Vec2::from(size));
        harness.state_mut().dock.window = Some(Vec2::from(size));
        harness.run_steps(3);
        assert_eq!(harness.ctx.zoom_factor(), scale);
    }
    let entry = "As large as suits the window";
    let sizes = "Size of text and controls";
    harness.get_by_label("View").click();
    harness.run_steps(4);
    harness.get_by_label_contains(sizes).click();
    harness.run_steps(4);
    harness.get_by_label_contains("Smaller").click();
    harness.run_steps(4);
    assert_eq!(harness.ctx.zoom_factor(), 1.9);
    harness.get_by_label("View").click();
    harness.run_steps(4);
    harness.get_by_label_contains(sizes).click();
    harness.run_steps(4);
    harness.get_by_label_contains(entry).click();
    harness.run_steps(4);
    assert_eq!(harness.ctx.zoom_factor(), 2.0);
}

/// Does what the panels asked of their own places.
fn carry_out(harness: &mut Harness<'_, Window>) {
    let window = harness.state_mut();
    for asked in std::mem::take(&mut window.asked) {
        match asked {
            Request::Arrange(asked) => window.dock.rearrange(asked, Some(&window.simulation)),
            Request::Present => window.dock.present(),
            _ => {}
        }
    }
    harness.run_steps(12);
}

/// Chooses `entry` in the menu of the place of the panel called `title`.
fn choose(harness: &mut Harness<'_, Window>, title: &str, entry: &str) {
    let label = format!("Place of {title}");
    harness.get_by_label(&label).scroll_to_me();
    harness.run_steps(20);
    harness.get_by_label(&label).click();
    harness.run_steps(4);
    harness.get_by_label(entry).click();
    harness.run_steps(4);
    carry_out(harness);
}

fn title_of(harness: &Harness<'_, Window>, title: &str) -> Option<Rect> {
    let label = format!("Place of {title}");
    harness.query_by_label(&label).map(|node| node.rect())
}

#[test]
fn a_panel_goes_where_a_person_wants_it_and_stands_there_the_next_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("remembered.json");
    let mut harness = Window::of(prepared());
    let memory = || UserMemory::at(path.clone());
    harness.state_mut().dock.remember(memory());
    let top = |harness: &Harness<'_, Window>, title: &str| title_of(harness, title).unwrap().top();
    assert!(top(&harness, "Picture") > top(&harness, "Changes and runs"));
    choose(&mut harness, "Picture", "Up");
    choose(&mut harness, "Results", "To the left side");
    choose(&mut harness, "Solver", "Close");
    let assert_arranged = |harness: &Harness<'_, Window>| {
        let top = |title: &str| top(harness, title);
        assert!(top("Picture") < top("Changes and runs"));
        let results = title_of(harness, "Results").unwrap();
        assert!(results.right() < 700.0 && results.top() < top("Scene"));
        assert_eq!(title_of(harness, "Solver"), None);
    };
    assert_arranged(&harness);
    let mut again = Window::of(prepared());
    again.state_mut().dock.remember(memory());
    again.run_steps(10);
    assert_arranged(&again);
    // Another scene, or another kind of it.
    again.state_mut().dock.scene_opened("small-drum");
    again.run_steps(10);
    assert_arranged(&again);
    let panels = |harness: &mut Harness<'_, Window>, entry: &str| {
        harness.get_by_label("View").click();
        harness.run_steps(4);
        harness.get_by_label_contains("Panels").click();
        harness.run_steps(4);
        harness.get_by_role_and_label(Role::CheckBox, "Solver");
        harness.get_by_label_contains(entry).click();
        harness.run_steps(4);
        carry_out(harness);
    };
    panels(&mut again, "All as at first");
    assert!(title_of(&again, "Solver").is_some());
    assert!(title_of(&again, "Results").unwrap().left() > 700.0);
    assert_eq!(
        memory().panels().left,
        [""; 0],
        "nothing is to be remembered"
    );
}

#[test]
fn presenting_leaves_the_picture_alone_until_p_or_esc() {
    let mut harness = Window::of(prepared());
    let whole = Rect::from_min_size(Pos2::ZERO, vec2(1600.0, 1400.0));
    let whole = whole.shrink(MARGIN);
    for key in [Key::P, Key::Escape] {
        harness.key_press(Key::P);
        harness.run_steps(3);
        assert_eq!(harness.state().asked, [Request::Present]);
        carry_out(&mut harness);
        assert_eq!(harness.state().free, whole);
        assert!(harness.state().dock.is_full_screen);
        assert!(harness.query_by_label("View").is_none());
        harness.get_by_label_contains("brings the panels back");
        assert!(!harness.state().dock.shows_time(), "the picture does");
        harness.key_press(key);
        harness.run_steps(3);
        carry_out(&mut harness);
        harness.get_by_label("View");
        assert!(!harness.state().dock.is_full_screen);
    }
    // Keys still play.
    harness.key_press(Key::P);
    harness.run_steps(3);
    carry_out(&mut harness);
    harness.event(Event::Key {
        key: Key::Space,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: egui::Modifiers::NONE,
    });
    harness.run_steps(2);
    assert_eq!(harness.state().asked.len(), 1);
}

#[test]
fn what_is_presented_is_read_from_the_last_row() {
    let world = crate::view::drum_of_grains();
    let measured = Measured::of(&world);
    let angle = measured.in_words().unwrap();
    let settings = ViewSettings {
        measured: [measured, Measured::NOTHING],
        ..ViewSettings::default()
    };
    let size = vec2(1280.0, 720.0);
    let mut harness = Harness::builder().with_size(size).build_ui_state(
        move |ui, (settings, camera): &mut (ViewSettings, OrbitCamera)| {
            let afar = Caption {
                is_for_afar: true,
                ..caption(&world)
            };
            viewport_ui(ui, &[afar], settings, camera);
        },
        (settings, OrbitCamera::default()),
    );
    harness.run_steps(2);
    let height = |words: &str| {
        let shapes = harness.output().shapes.iter();
        let heights = shapes.filter_map(|clipped| match &clipped.shape {
            Shape::Text(text) if text.galley.text() == words => Some(text.galley.size().y),
            _ => None,
        });
        heights.fold(0.0, f32::max)
    };
    assert!(angle.starts_with("θ = "), "{angle}");
    let moment = moment(0.0);
    for words in [angle.as_str(), moment.as_str()] {
        assert!(height(words) > size.y / 14.0, "{words}: {}", height(words));
    }
}
