//! What becomes of work in no file when the program ends unasked.

use crate::window_of_panels::set;
use crate::windowless::{open_three_grains, simulation, until, without_scene};
use bevy::app::AppExit;
use bevy::prelude::*;
use grainfall::run::{Command, Parameter, Rescue};
use grainfall::world::StateHash;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Request, Requests, RescuePlugin};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A window of three grains, without panels, that keeps its work below `home`.
fn window(home: &Path) -> (App, Arc<AtomicBool>) {
    let stop = Arc::new(AtomicBool::new(false));
    let mut app = without_scene();
    app.add_plugins(RescuePlugin {
        home: home.to_owned(),
        stop: stop.clone(),
    });
    open_three_grains(&mut app);
    (app, stop)
}

/// Changes the gravity and takes a step with it; the state then.
fn work(app: &mut App) -> StateHash {
    let change = set(Parameter::Gravity, 3.0);
    let mut open = app.world_mut().resource_mut::<Simulation>();
    open.send(change);
    open.send(Command::Step(1));
    until(app, |app| {
        let simulation = simulation(app);
        simulation.is_unsaved() && simulation.world().is_some_and(|world| world.clock.step > 0)
    });
    simulation(app).world().unwrap().hash()
}

#[test]
fn work_of_a_window_that_was_killed_is_offered_and_goes_on() {
    let home = tempfile::tempdir().unwrap();
    let (mut app, _) = window(home.path());
    let state = work(&mut app);
    let file = home.path().join("0/rescued.grainfall");
    until(&mut app, |_| file.exists());
    assert_eq!(Rescue::left(home.path()).len(), 0, "the window is there");
    drop(app);
    assert_eq!(Rescue::left(home.path()), std::slice::from_ref(&file));

    let (mut app, _) = window(home.path());
    app.world_mut()
        .resource_mut::<Requests>()
        .ask(Request::OpenLeft(file.clone()));
    until(&mut app, |app| {
        simulation(app)
            .world()
            .is_some_and(|world| world.hash() == state)
    });
    assert!(
        simulation(&app).is_unsaved(),
        "it is in no file that a person knows of"
    );
    // It is this window's work now, and no earlier one's.
    until(&mut app, |_| !file.exists());
    drop(app);
    assert_eq!(Rescue::left(home.path()).len(), 1);
}

#[test]
fn a_signal_ends_the_window_when_its_work_is_kept() {
    let home = tempfile::tempdir().unwrap();
    let (mut app, stop) = window(home.path());
    work(&mut app);
    stop.store(true, Ordering::Relaxed);
    until(&mut app, |app| app.should_exit() == Some(AppExit::Success));
    drop(app);
    assert_eq!(Rescue::left(home.path()).len(), 1);
}

#[test]
fn a_person_who_closes_the_window_leaves_nothing() {
    let home = tempfile::tempdir().unwrap();
    let (mut app, _) = window(home.path());
    work(&mut app);
    let file = home.path().join("0/rescued.grainfall");
    until(&mut app, |_| file.exists());
    let quit = Request::Leave(Box::new(Request::Quit));
    app.world_mut().resource_mut::<Requests>().ask(quit);
    until(&mut app, |app| app.should_exit().is_some());
    drop(app);
    assert!(!file.exists());
    assert_eq!(Rescue::left(home.path()).len(), 0);
}
