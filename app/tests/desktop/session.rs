//! Claims about saving, leaving and opening in the app as a whole: requests go in as panels make
//! them, and nothing is drawn.

use crate::window_of_panels::{friction, set};
use crate::windowless::{app, ask, simulation, update_until};
use bevy::prelude::*;
use bevy::window::{FileDragAndDrop, WindowCloseRequested};
use grainfall::lab::Status;
use grainfall::run::Command;
use grainfall::world::StateHash;
use grainfall_app::ui::{Dock, FilmState, Rearrangement, Request, ScreenshotOrders};
use grainfall_app::view::{ColourBy, Cut, OrbitCamera, StartPlace, ViewSettings};
use std::path::Path;

/// Asks for `command` and waits until it has been carried out.
fn command(app: &mut App, command: Command) {
    ask(app, Request::Command(command));
    update_until(app, |s| s.has_answered() && *s.status() == Status::Paused);
}

fn has_ended(app: &App) -> bool {
    app.should_exit().is_some()
}

fn hash(app: &App) -> Option<StateHash> {
    simulation(app).world().map(|world| world.hash())
}

/// Some work: a change in the middle, and another run from before it.
fn work(app: &mut App) {
    command(app, Command::Step(500));
    command(app, set(friction(), 0.2));
    command(app, Command::Step(500));
    command(app, Command::Seek(250));
    command(app, set(friction(), 0.7));
    command(app, Command::Step(300));
}

fn saved(app: &mut App, path: &Path) {
    ask(app, Request::SaveSession(path.to_owned()));
    update_until(app, |s| !s.is_saving());
    app.update();
    assert!(path.exists());
}

#[test]
fn saved_session_is_dropped_on_another_and_is_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.grainfall");
    let mut app = app();
    work(&mut app);
    let (state, step) = (hash(&app), simulation(&app).step());
    saved(&mut app, &path);
    // Saved: leaving asks nothing.
    ask(&mut app, Request::Open("bouncing-grain".into()));
    update_until(&mut app, |s| s.world().is_some());
    assert_ne!(hash(&app), state);
    let window = Entity::PLACEHOLDER;
    let path_buf = path.clone();
    let hovers = |app: &mut App, message| {
        app.world_mut().write_message(message);
        app.update();
        app.world().resource::<Dock>().file_hovers
    };
    let hovered = FileDragAndDrop::HoveredFile { window, path_buf };
    assert!(hovers(&mut app, hovered));
    let away = FileDragAndDrop::HoveredFileCanceled { window };
    assert!(!hovers(&mut app, away));
    let path_buf = path.clone();
    let dropped = FileDragAndDrop::DroppedFile { window, path_buf };
    assert!(!hovers(&mut app, dropped));
    update_until(&mut app, |s| s.step() == step && s.world().is_some());
    assert_eq!(hash(&app), state);
    assert_eq!(simulation(&app).past().kept.len(), 1);
    command(&mut app, Command::Undo);
    assert_eq!(simulation(&app).value(&friction()), Some(0.4.into()));
    // It has a file now: saving asks for none.
    let before = std::fs::read(&path).unwrap();
    ask(&mut app, Request::Save);
    update_until(&mut app, |s| !s.is_saving());
    assert_ne!(std::fs::read(&path).unwrap(), before);
}

#[test]
fn closing_with_work_in_no_file_waits_for_an_answer() {
    let mut app = app();
    app.world_mut().write_message(WindowCloseRequested {
        window: Entity::PLACEHOLDER,
    });
    app.update();
    assert!(has_ended(&app), "nothing would be lost");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.grainfall");
    let mut app = self::app();
    work(&mut app);
    let state = hash(&app);
    for request in [Request::Quit, Request::Open("bouncing-grain".into())] {
        ask(&mut app, request);
        app.update();
        assert!(!has_ended(&app) && hash(&app) == state);
    }
    // To save where that cannot be keeps the window open.
    saved_nowhere(&mut app, folder.path());
    assert!(!has_ended(&app) && simulation(&app).is_unsaved());
    saved(&mut app, &path);
    command(&mut app, set(friction(), 0.3));
    ask(&mut app, Request::SaveThen(Box::new(Request::Quit)));
    update_until(&mut app, |s| !s.is_saving());
    app.update();
    app.update();
    assert!(has_ended(&app), "saved to the file it has, then ended");
}

/// Tries to save to a path below a file.
fn saved_nowhere(app: &mut App, folder: &Path) {
    let file = folder.join("file");
    std::fs::write(&file, "").unwrap();
    ask(app, Request::SaveSession(file.join("work.grainfall")));
    update_until(app, |s| !s.is_saving());
    app.update();
}

#[test]
fn start_with_another_scene_takes_the_present_values_along() {
    let mut app = app();
    command(&mut app, set(friction(), 0.2));
    let mut scene = simulation(&app).scene().clone();
    scene.materials[0].density = 5000.0;
    let start = Request::Start(Box::new(scene));
    ask(&mut app, start.clone());
    app.update();
    assert_eq!(
        simulation(&app).scene().materials[0].density,
        2500.0,
        "it asks first"
    );
    ask(&mut app, Request::Leave(Box::new(start)));
    update_until(&mut app, |s| s.world().is_some());
    assert_eq!(simulation(&app).scene().materials[0].density, 5000.0);
    assert_eq!(simulation(&app).original().materials[0].density, 2500.0);
    assert_eq!(simulation(&app).value(&friction()), Some(0.2.into()));
}

#[test]
fn what_cannot_be_opened_is_told_before_anybody_is_asked_to_save() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.ron");
    std::fs::write(&path, "(title: 3)").unwrap();
    let mut app = app();
    work(&mut app);
    ask(&mut app, Request::Open(path.display().to_string()));
    let reason = app.world().resource::<Dock>().open_error();
    assert!(reason.is_some_and(|reason| reason.contains("bad.ron")));
    assert!(simulation(&app).is_unsaved());
}

#[test]
fn discarded_work_is_left() {
    let mut app = app();
    work(&mut app);
    let open = Request::Open("bouncing-grain".into());
    ask(&mut app, Request::Leave(Box::new(open)));
    update_until(&mut app, |s| s.world().is_some());
    assert_eq!(simulation(&app).scene().grain_count(), 1);
}

#[test]
fn damaged_session_leaves_what_is_open() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.grainfall");
    let mut app = app();
    work(&mut app);
    saved(&mut app, &path);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 9]).unwrap();
    let state = hash(&app);
    ask(&mut app, Request::Open(path.display().to_string()));
    for _ in 0..200 {
        app.update();
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert_eq!(hash(&app), state);
    let reason = app.world().resource::<Dock>().open_error();
    assert!(
        reason.is_some_and(|reason| reason.contains("damaged")),
        "{reason:?}"
    );
}

#[test]
fn a_session_looks_as_it_did() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("work.grainfall");
    let mut app = app();
    app.insert_resource(OrbitCamera::default());
    work(&mut app);
    let chosen = |app: &App| {
        let view = app.world().resource::<ViewSettings>();
        let marks = (view.show_axes, view.show_measured, view.show_temperature);
        let shown = (view.colour_by, view.cut, marks, view.selected);
        let panels = app.world().resource::<Dock>().arrangement();
        (shown, app.world().resource::<OrbitCamera>().pose(), panels)
    };
    let first = chosen(&app);
    let mut view = app.world_mut().resource_mut::<ViewSettings>();
    view.colour_by = ColourBy::Start(StartPlace::Y);
    view.cut = Some(Cut::Quarter { x: 0.01, z: 0.0 });
    (view.show_axes, view.show_measured) = (true, false);
    view.selected = Some(2);
    view.show_temperature = true;
    let mut dock = app.world_mut().resource_mut::<Dock>();
    dock.rearrange(Rearrangement::Across("Solver"), None);
    dock.rearrange(Rearrangement::Close("Energy"), None);
    let mut camera = app.world_mut().resource_mut::<OrbitCamera>();
    camera.orbit(Vec2::new(40.0, 10.0));
    camera.zoom(120.0, Vec2::ZERO);
    let own = chosen(&app);
    assert_ne!(own, first);
    saved(&mut app, &path);
    ask(&mut app, Request::Open("bouncing-grain".into()));
    update_until(&mut app, |s| s.world().is_some());
    app.insert_resource(OrbitCamera::default());
    app.insert_resource(ViewSettings::default());
    app.insert_resource(Dock::default());
    assert_eq!(chosen(&app), first);
    ask(&mut app, Request::Open(path.display().to_string()));
    update_until(&mut app, |s| {
        s.scene().title == "Three grains" && s.world().is_some()
    });
    app.update();
    assert_eq!(chosen(&app), own);
}

#[test]
fn one_drag_is_one_change_however_long_it_takes_and_two_clicks_are_two() {
    let mut app = app();
    command(&mut app, Command::Step(10));
    let hold = |app: &mut App, is_held| {
        app.world_mut().resource_mut::<Dock>().is_holding = is_held;
    };
    hold(&mut app, true);
    for value in [0.2, 0.25, 0.3] {
        command(&mut app, set(friction(), value));
        std::thread::sleep(std::time::Duration::from_millis(450));
    }
    hold(&mut app, false);
    app.update();
    let changes = |app: &App| simulation(app).changes().len();
    assert_eq!(changes(&app), 1, "a drag that took more than a second");
    for value in [0.5, 0.6] {
        command(&mut app, set(friction(), value));
    }
    assert_eq!(changes(&app), 3, "two clicks at once");
    command(&mut app, Command::Undo);
    assert_eq!(simulation(&app).value(&friction()), Some(0.5.into()));
}

#[test]
fn a_film_that_is_recorded_is_the_only_one() {
    let mut app = app();
    app.world_mut().resource_mut::<ScreenshotOrders>().film = FilmState::Recording {
        pictures: 3,
        time: 0.1,
    };
    ask(&mut app, Request::ChooseFilm);
    assert!(!app.world().resource::<Dock>().path_dialog.is_open());
}
