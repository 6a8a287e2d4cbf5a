//! The app with everything but pictures: requests go in as panels make them, and nothing is drawn.

use crate::window_of_panels::{prepared, standing};
use bevy::MinimalPlugins;
use bevy::prelude::*;
use grainfall::lab::{DriverKind, Options};
use grainfall_app::simulation::{Simulation, SimulationPlugin};
use grainfall_app::ui::{DockPlugin, Request, Requests};
use std::time::Duration;

/// Without a scene.
pub fn without_scene() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, SimulationPlugin))
        .add_plugins(DockPlugin { options: options() });
    app
}

/// With three grains at time zero.
pub fn app() -> App {
    let mut app = without_scene();
    open_three_grains(&mut app);
    app
}

/// Opens three grains and waits until they stand.
pub fn open_three_grains(app: &mut App) {
    let scene = prepared().scene().clone();
    app.insert_resource(Simulation::open(scene, options()));
    update_until(app, |simulation| simulation.world().is_some());
}

/// A run on a thread of its own, as in a window.
fn options() -> Options {
    Options {
        driver: DriverKind::Thread,
        ..standing()
    }
}

pub fn simulation(app: &App) -> &Simulation {
    app.world().resource::<Simulation>()
}

/// Asks for `request` as a panel does.
pub fn ask(app: &mut App, request: Request) {
    app.world_mut().resource_mut::<Requests>().ask(request);
    app.update();
}

/// Updates `app` until it is as wanted.
pub fn until(app: &mut App, done: impl Fn(&App) -> bool) {
    for _ in 0..20_000 {
        app.update();
        if done(app) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let simulation = app.world().get_resource::<Simulation>();
    panic!(
        "still {:?}",
        simulation.map(|simulation| simulation.status())
    );
}

/// Updates `app` until its simulation is as wanted.
pub fn update_until(app: &mut App, done: impl Fn(&Simulation) -> bool) {
    until(app, |app| {
        app.world().get_resource::<Simulation>().is_some_and(&done)
    });
}
