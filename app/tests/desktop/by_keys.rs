//! Claims about the keyboard alone: every dialog is reached, walked, answered and left by keys, with
//! a focus that is seen; the same requests are fulfilled as in a window.

use crate::window_of_panels::{friction, set};
use crate::windowless::{app, simulation, until};
use bevy::prelude::{App, Mut};
use bevy_egui::egui::{self, Event, Key, Modifiers, Rect, Shape, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::lab::Status;
use grainfall::lesson::built_in_lessons;
use grainfall::run::Command;
use grainfall::scene::built_in;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{
    Dock, FilmState, Request, Requests, ScreenshotOrder, ScreenshotOrders, theme,
};
use grainfall_app::view::{Background, CameraRequest, ColourRange, Cut, ViewSettings};
use std::path::Path;

/// The smallest window in which everything can be reached.
const SIZE: Vec2 = vec2(1024.0, 640.0);
const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// The app with its panels, which nobody can point at.
struct Keyboard {
    app: App,
    /// Whether the program was to end; what the app says of it is forgotten some frames later.
    has_ended: bool,
}

type Window = Harness<'static, Keyboard>;

/// Draws the panels of `app` and fulfils what they ask for.
fn update(app: &mut App, ui: &mut egui::Ui) {
    let mut asked = Vec::new();
    app.world_mut()
        .resource_scope(|world, mut dock: Mut<Dock>| {
            world.resource_scope(|world, mut view: Mut<ViewSettings>| {
                let simulation = world.get_resource::<Simulation>();
                dock.ui(ui, simulation, &mut view, &mut asked);
            });
        });
    let mut requests = app.world_mut().resource_mut::<Requests>();
    for request in asked {
        requests.ask(request);
    }
    app.update();
}

/// The window of `app`.
fn window(mut app: App) -> Window {
    let mut dock = app.world_mut().resource_mut::<Dock>();
    dock.path_dialog.is_always_typed = true;
    let mut is_new = true;
    let mut harness = Harness::builder().with_size(SIZE).build_ui_state(
        move |ui, keyboard: &mut Keyboard| {
            if std::mem::take(&mut is_new) {
                theme::install(ui.ctx());
            }
            update(&mut keyboard.app, ui);
            keyboard.has_ended |= keyboard.app.should_exit().is_some();
        },
        Keyboard {
            app,
            has_ended: false,
        },
    );
    harness.run_steps(6);
    harness
}

fn press(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(8);
}

fn type_text(window: &mut Window, text: &str) {
    window.event(Event::Text(text.to_owned()));
    window.run_steps(4);
}

/// What has the keyboard's focus: what it is called, and where it is.
fn focused(window: &Window) -> Option<(String, Rect)> {
    let mut nodes = window.root().children_recursive();
    let node = nodes.find(|node| node.accesskit_node().is_focused())?;
    let label = node.accesskit_node().label()?;
    Some((label, node.rect()))
}

/// Asserts that what is called `label` has the focus and is seen with a ring round it.
#[track_caller]
fn assert_focused(window: &Window, label: &str) {
    let Some((name, place)) = focused(window) else {
        panic!("nothing, not {label}");
    };
    assert_eq!(name, label);
    assert_seen(window, &name, place);
}

/// Asserts that what is called `name` is in the window at this `place`, with a ring round it.
#[track_caller]
fn assert_seen(window: &Window, name: &str, place: Rect) {
    let whole = Rect::from_min_size(egui::Pos2::ZERO, SIZE);
    assert!(whole.contains_rect(place), "{name}: {place:?}");
    let is_ring = |shape: &Shape| match shape {
        Shape::Rect(ring) => ring.stroke.width == 2.0 && ring.rect.contains_rect(place),
        _ => false,
    };
    let mut shapes = window.output().shapes.iter();
    assert!(shapes.any(|own| is_ring(&own.shape)), "{name} has no ring");
}

/// Walks the `controls` of a dialog by Tab and back by Shift+Tab: the first of them has the focus
/// first, and the focus does not leave them.
#[track_caller]
fn assert_walked(window: &mut Window, controls: &[&str]) {
    assert_focused(window, controls[0]);
    for control in controls.iter().cycle().skip(1).take(controls.len()) {
        press(window, NONE, Key::Tab);
        assert_focused(window, control);
    }
    for control in controls.iter().rev() {
        press(window, SHIFT, Key::Tab);
        assert_focused(window, control);
    }
}

fn is_there(window: &Window, title: &str) -> bool {
    window.query_all_by_label(title).next().is_some()
}

const OPEN: &str = "Open a scene, a lesson, a session or a recording";
const OPEN_PATH: &str =
    "Path of a file or of a run's folder, or name of a built-in scene or lesson";
const FILM_PATH: &str = "Path; it ends in .gif, or with ffmpeg in .mp4, .webm or .mov; without an ending, a folder of PNG pictures";

#[test]
fn every_dialog_is_opened_walked_and_left_by_keys() {
    let mut window = window(app());
    let film = [
        FILM_PATH,
        "Shows",
        "Size",
        "Frames a second",
        "Speed",
        "From now until it is stopped",
        "What is recorded",
        "Record",
        "Cancel",
    ];
    let picture = ["Path of the PNG file", "Shows", "Size", "Save", "Cancel"];
    let session = ["Path of the session's file", "Save", "Cancel"];
    let cases: [(Modifiers, Key, &str, &[&str]); 7] = [
        (CTRL, Key::O, OPEN, &[OPEN_PATH, "Cancel"]),
        (CTRL_SHIFT, Key::S, "Save the session", &session),
        (CTRL, Key::P, "Save a picture", &picture),
        (CTRL, Key::R, "Record a film", &film),
        (NONE, Key::F1, "Shortcuts", &["Close"]),
        (NONE, Key::G, "Go to a moment", &["Time", "Go", "Cancel"]),
        (
            NONE,
            Key::F2,
            "Name the run that is shown",
            &["Name", "Name it", "Cancel"],
        ),
    ];
    for (modifiers, key, title, controls) in cases {
        assert!(!is_there(&window, title), "{title}");
        press(&mut window, modifiers, key);
        assert!(is_there(&window, title), "{title}");
        assert_walked(&mut window, controls);
        press(&mut window, NONE, Key::Escape);
        assert!(!is_there(&window, title), "{title}");
        assert_eq!(focused(&window), None, "{title}: as before");
    }
    let app = &window.state().app;
    assert_eq!(simulation(app).step(), 0);
    assert!(app.world().resource::<ScreenshotOrders>().asked.is_empty());
}

#[test]
fn the_gallery_is_walked_by_keys_and_return_opens_what_has_the_focus() {
    let mut window = window(app());
    press(&mut window, CTRL, Key::G);
    let mut walked = Vec::new();
    for key in [Key::Tab, Key::ArrowDown, Key::ArrowRight]
        .into_iter()
        .cycle()
    {
        let (name, place) = focused(&window).unwrap();
        if walked.first() == Some(&name) {
            break;
        }
        // It scrolls to it.
        window.run_steps(20);
        let place = focused(&window).map_or(place, |(_, place)| place);
        assert_seen(&window, &name, place);
        walked.push(name);
        press(&mut window, NONE, key);
    }
    let all = built_in_lessons().len() + built_in().len();
    assert_eq!(walked.len(), all + 2, "{walked:?}");
    assert_eq!(walked[all..], ["Open a file…", "Close"]);
    press(&mut window, NONE, Key::ArrowUp);
    assert_focused(&window, "Close");
    press(&mut window, NONE, Key::ArrowDown);
    press(&mut window, NONE, Key::Enter);
    until(&mut window.state_mut().app, |app| {
        app.world().resource::<Dock>().lesson.under_way().is_some()
    });
}

#[test]
fn a_sheet_is_read_to_its_end_by_keys() {
    let mut window = window(app());
    press(&mut window, NONE, Key::F1);
    let last = "Draw its trail, or no longer";
    let bottom = |window: &Window| window.get_by_label(last).rect().bottom();
    let close = window.get_by_label("Close").rect().top();
    assert!(bottom(&window) > close, "it is longer than the window");
    for (there, back, times) in [
        (Key::End, Key::Home, 1),
        (Key::PageDown, Key::PageUp, 5),
        (Key::ArrowDown, Key::ArrowUp, 40),
    ] {
        for (key, is_end) in [(there, true), (back, false)] {
            for _ in 0..times {
                press(&mut window, NONE, key);
            }
            window.run_steps(30);
            assert_eq!(bottom(&window) < close, is_end, "{key:?}");
        }
    }
    press(&mut window, NONE, Key::Enter);
    assert!(!is_there(&window, "Shortcuts"));
}

#[test]
fn a_menu_is_opened_walked_and_left_by_keys() {
    let mut window = window(app());
    for _ in 0..2 {
        press(&mut window, NONE, Key::F10);
        assert_focused(&window, "File");
        for menu in ["Edit", "View", "Help"] {
            press(&mut window, NONE, Key::Tab);
            assert_focused(&window, menu);
        }
        press(&mut window, NONE, Key::Enter);
        press(&mut window, NONE, Key::ArrowDown);
        assert!(focused(&window).unwrap().0.starts_with("Shortcuts"));
        press(&mut window, NONE, Key::ArrowDown);
        assert!(focused(&window).unwrap().0.starts_with("About"));
        press(&mut window, NONE, Key::ArrowUp);
        press(&mut window, NONE, Key::Escape);
        assert!(!is_there(&window, "About Grainfall"));
        assert_eq!(focused(&window), None, "who leaves a menu plays on");
    }
    press(&mut window, NONE, Key::F10);
    for key in [Key::Tab, Key::Tab, Key::Tab, Key::Enter] {
        press(&mut window, NONE, key);
    }
    for key in [Key::ArrowDown, Key::ArrowDown, Key::Enter] {
        press(&mut window, NONE, key);
    }
    assert_walked(&mut window, &["Close"]);
    press(&mut window, NONE, Key::Enter);
    assert_eq!(focused(&window), None);
    // Space plays then, and opens no menu.
    press(&mut window, NONE, Key::Space);
    until(&mut window.state_mut().app, |app| {
        simulation(app).step() > 0
    });
}

#[test]
fn a_list_is_opened_and_chosen_from_by_keys() {
    let mut window = window(app());
    press(&mut window, CTRL, Key::P);
    press(&mut window, NONE, Key::Tab);
    press(&mut window, NONE, Key::Tab);
    assert_focused(&window, "Size");
    press(&mut window, NONE, Key::Enter);
    press(&mut window, NONE, Key::ArrowDown);
    assert_focused(&window, "As in the window");
    // Esc closes the list alone.
    press(&mut window, NONE, Key::Escape);
    assert!(is_there(&window, "Save a picture"));
    assert_focused(&window, "Size");
    press(&mut window, NONE, Key::Enter);
    for _ in 0..4 {
        press(&mut window, NONE, Key::ArrowDown);
    }
    assert_focused(&window, "Another");
    press(&mut window, NONE, Key::Enter);
    assert_focused(&window, "Size");
    press(&mut window, NONE, Key::Tab);
    assert_focused(&window, "Width × height");
    press(&mut window, CTRL, Key::A);
    type_text(&mut window, "800 × 600");
    press(&mut window, NONE, Key::Enter);
    let orders = window.state().app.world().resource::<ScreenshotOrders>();
    let [ScreenshotOrder::Picture(order)] = &orders.asked[..] else {
        panic!("{:?}", orders.asked);
    };
    assert_eq!(order.size, Some(bevy::math::UVec2::new(800, 600)));
}

/// Opens a dialog for a path, types it and presses Return.
fn answer(window: &mut Window, modifiers: Modifiers, key: Key, path: &Path) {
    press(window, modifiers, key);
    type_text(window, &path.display().to_string());
    press(window, NONE, Key::Enter);
}

#[test]
fn return_does_what_a_dialog_is_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(app());
    // A moment, typed in the place of the one shown.
    press(&mut window, NONE, Key::G);
    type_text(&mut window, "0.002");
    press(&mut window, NONE, Key::Enter);
    until(&mut window.state_mut().app, |app| {
        let run = simulation(app);
        let time = run.world().unwrap().time();
        (time - 0.002).abs() < 1e-5 && *run.status() == Status::Paused
    });
    // A name, and none again.
    for name in ["steep", ""] {
        press(&mut window, NONE, Key::F2);
        if name.is_empty() {
            press(&mut window, NONE, Key::Backspace);
        } else {
            type_text(&mut window, name);
        }
        press(&mut window, NONE, Key::Enter);
        until(&mut window.state_mut().app, |app| {
            let past = simulation(app).past();
            past.names.of(past.number).unwrap_or_default() == name
        });
    }
    let session = folder.path().join("mine.grainfall");
    answer(&mut window, CTRL, Key::S, &session);
    until(&mut window.state_mut().app, |app| {
        !simulation(app).is_saving()
    });
    assert!(session.exists());
    answer(&mut window, CTRL, Key::R, &folder.path().join("film"));
    let orders = window.state().app.world().resource::<ScreenshotOrders>();
    assert!(matches!(orders.asked[..], [ScreenshotOrder::Film(_)]));
    // What cannot be opened says why; Return closes that.
    answer(&mut window, CTRL, Key::O, Path::new("nothing.ron"));
    assert!(is_there(&window, "This file cannot be opened"));
    assert_walked(&mut window, &["Close"]);
    press(&mut window, NONE, Key::Enter);
    answer(&mut window, CTRL, Key::O, Path::new("two-grains"));
    let title = "two-grains";
    until(&mut window.state_mut().app, |app| {
        *simulation(app).scene() == grainfall::scene::Scene::open(title).unwrap()
    });
}

#[test]
fn a_scene_that_was_opened_is_played_by_space_whatever_had_the_focus_before() {
    let mut window = window(app());
    press(&mut window, CTRL, Key::Comma);
    window.run_steps(40);
    assert_focused(&window, "Picture");
    answer(&mut window, CTRL, Key::O, Path::new("two-grains"));
    until(&mut window.state_mut().app, |app| {
        simulation(app)
            .world()
            .is_some_and(|world| world.grains.len() == 2)
    });
    window.run_steps(8);
    assert_eq!(focused(&window), None);
    press(&mut window, NONE, Key::Space);
    until(&mut window.state_mut().app, |app| {
        simulation(app).step() > 0
    });
}

#[test]
fn questions_are_answered_by_keys() {
    let mut app = app();
    let mut run = app.world_mut().resource_mut::<Simulation>();
    run.send(set(friction(), 0.7));
    run.send(Command::Step(10));
    until(&mut app, |app| simulation(app).is_unsaved());
    let mut window = window(app);
    press(&mut window, CTRL, Key::Q);
    assert!(is_there(&window, "Save the session?"));
    assert_walked(&mut window, &["Save", "Discard", "Cancel"]);
    press(&mut window, NONE, Key::Escape);
    assert!(!is_there(&window, "Save the session?"));
    // Save leads to the path, and Esc there back to the run.
    press(&mut window, CTRL, Key::Q);
    press(&mut window, NONE, Key::Enter);
    assert_focused(&window, "Path of the session's file");
    press(&mut window, NONE, Key::Escape);
    assert!(!window.state().has_ended);
    let dock = |window: &mut Window, ask: &dyn Fn(&mut Dock)| {
        ask(&mut window.state_mut().app.world_mut().resource_mut::<Dock>());
        window.run_steps(8);
    };
    let large = |dock: &mut Dock| {
        let open = Request::Open("small-drum".into());
        dock.doubt("It takes 100 GiB of memory.".into(), open);
    };
    dock(&mut window, &large);
    assert_walked(&mut window, &["Open it", "Cancel"]);
    press(&mut window, NONE, Key::Escape);
    dock(&mut window, &|dock| {
        dock.offer_left(vec!["left.grainfall".into()]);
    });
    assert_walked(&mut window, &["Open", "Discard", "Later"]);
    press(&mut window, NONE, Key::ArrowRight);
    press(&mut window, NONE, Key::ArrowRight);
    assert_focused(&window, "Later");
    press(&mut window, NONE, Key::Enter);
    assert!(!is_there(&window, "Go on with what was not saved?"));
    press(&mut window, CTRL, Key::Q);
    press(&mut window, NONE, Key::Tab);
    press(&mut window, NONE, Key::Enter);
    assert!(window.state().has_ended);
}

/// Presses Tab until what is called `label` has the focus, and is seen.
#[track_caller]
fn tab_to(window: &mut Window, label: &str) {
    tab_on_to(window, label);
    window.run_steps(30);
    assert_focused(window, label);
}

/// Presses Tab until what is called `label` has the focus. A slider's ring is round what is moved,
/// not round its number too.
#[track_caller]
fn tab_on_to(window: &mut Window, label: &str) {
    for _ in 0..30 {
        if focused(window).is_some_and(|(name, _)| name == label) {
            return;
        }
        press(window, NONE, Key::Tab);
    }
    panic!("Tab does not come to {label}");
}

#[test]
fn panels_with_forms_are_opened_and_worked_by_keys() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(app());
    let dock = |window: &Window| window.state().app.world().resource::<Dock>().sweeps.clone();
    dock(&window).settle_in(folder.path().into());
    // A sweep.
    press(&mut window, CTRL_SHIFT, Key::T);
    window.run_steps(40);
    assert_focused(&window, "Parameter sweep");
    tab_to(&mut window, "first value");
    for text in ["0.1", "0.3", "2"] {
        press(&mut window, CTRL, Key::A);
        type_text(&mut window, text);
        press(&mut window, NONE, Key::Tab);
    }
    tab_to(&mut window, "duration of each run");
    press(&mut window, CTRL, Key::A);
    type_text(&mut window, "0.01");
    tab_to(&mut window, "Folder…");
    press(&mut window, NONE, Key::Enter);
    assert_focused(
        &window,
        "Path of a folder, in which each sweep has one of its own",
    );
    press(&mut window, NONE, Key::Escape);
    assert_focused(&window, "Folder…");
    tab_to(&mut window, "Start the sweep");
    press(&mut window, NONE, Key::Enter);
    until(&mut window.state_mut().app, |app| {
        let seen = app.world().resource::<Dock>().sweeps.seen();
        seen.is_some_and(|seen| !seen.is_running() && seen.standing.outcomes.len() == 2)
    });
    press(&mut window, NONE, Key::Escape);
    // A plot, on its way to a file.
    press(&mut window, CTRL, Key::E);
    window.run_steps(40);
    assert_focused(&window, "Any quantity");
    tab_to(&mut window, "Export…");
    press(&mut window, NONE, Key::Enter);
    let path = "Path; it ends in .svg or .png for a picture, in .csv for all samples";
    assert_walked(&mut window, &[path, "Save", "Cancel"]);
    let table = folder.path().join("plot.csv");
    type_text(&mut window, &table.display().to_string());
    press(&mut window, NONE, Key::Enter);
    assert!(table.exists());
    assert_focused(&window, "Export…");
    press(&mut window, NONE, Key::Escape);
    // Two values side by side.
    press(&mut window, CTRL, Key::T);
    window.run_steps(40);
    tab_to(&mut window, "Start side by side");
    press(&mut window, NONE, Key::Enter);
    until(&mut window.state_mut().app, |app| {
        simulation(app).comparison().is_some()
    });
}

fn view(window: &Window) -> &ViewSettings {
    window.state().app.world().resource::<ViewSettings>()
}

#[test]
fn how_the_picture_is_drawn_is_chosen_by_keys() {
    let mut window = window(app());
    press(&mut window, CTRL, Key::Comma);
    window.run_steps(40);
    assert_focused(&window, "Picture");
    tab_to(&mut window, "Colour by");
    press(&mut window, NONE, Key::Enter);
    press(&mut window, NONE, Key::ArrowDown);
    press(&mut window, NONE, Key::ArrowDown);
    press(&mut window, NONE, Key::Enter);
    let colours = view(&window).colour_by;
    assert!(colours.quantity().is_some(), "{colours:?}");
    tab_to(&mut window, "Fixed");
    press(&mut window, NONE, Key::Enter);
    tab_to(&mut window, "to");
    press(&mut window, CTRL, Key::A);
    type_text(&mut window, "7.5");
    press(&mut window, NONE, Key::Tab);
    assert!(matches!(view(&window).range, ColourRange::Fixed(_, 7.5)));
    tab_to(&mut window, "Quarter");
    press(&mut window, NONE, Key::Enter);
    assert!(matches!(view(&window).cut, Some(Cut::Quarter { .. })));
    tab_on_to(&mut window, "Grain size");
    press(&mut window, NONE, Key::ArrowLeft);
    assert!(view(&window).grain_size < 1.0);
    tab_to(&mut window, "What is measured");
    press(&mut window, NONE, Key::Space);
    assert!(!view(&window).show_measured);
    tab_to(&mut window, "Light");
    press(&mut window, NONE, Key::Space);
    assert_eq!(view(&window).background, Background::Light);
    tab_to(&mut window, "Show 3");
    press(&mut window, NONE, Key::Enter);
    let asked = view(&window).camera_request;
    assert_eq!(asked, Some(CameraRequest::Recall(2)));
}

#[test]
fn a_film_that_is_recorded_is_stopped_by_the_key_that_began_it() {
    let mut window = window(app());
    let films = |window: &mut Window, film| {
        let world = window.state_mut().app.world_mut();
        world.resource_mut::<ScreenshotOrders>().film = film;
        press(window, CTRL, Key::R);
        let orders = window.state_mut().app.world_mut();
        std::mem::take(&mut orders.resource_mut::<ScreenshotOrders>().asked)
    };
    let (pictures, time) = (3, 0.1);
    for film in [
        FilmState::Recording { pictures, time },
        FilmState::Replaying { pictures, all: 9 },
    ] {
        assert_eq!(films(&mut window, film), [ScreenshotOrder::EndFilm]);
    }
    assert_eq!(films(&mut window, FilmState::Writing(2)), []);
    assert!(!is_there(&window, "Record a film"));
    films(&mut window, FilmState::Idle);
    assert!(is_there(&window, "Record a film"));
}
