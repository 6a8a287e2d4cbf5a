//! What panels ask for, fulfilled: the only place that changes the run, opens scenes and writes pictures for them.

use super::{Desk, OpenWith, Purpose, Request, Requests};
use crate::headless::Claim;
use crate::scene::Scene;
use crate::simulation::{Options, Simulation};
use crate::view::{ViewSettings, save_png};
use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// Fulfils every request in the order in which it was made.
pub fn fulfil_requests(
    mut requests: ResMut<Requests>,
    mut simulation: Option<ResMut<Simulation>>,
    mut view: ResMut<ViewSettings>,
    mut desk: ResMut<Desk>,
    mut exit: MessageWriter<AppExit>,
    options: Res<OpenWith>,
    mut commands: Commands,
) {
    for request in std::mem::take(&mut requests.0) {
        match request {
            Request::Command(command) => {
                if let Some(simulation) = &mut simulation {
                    simulation.send(command);
                }
            }
            Request::Camera(request) => view.camera_request = Some(request),
            Request::ChooseScene => desk.path_dialog.ask(Purpose::Scene),
            Request::ChoosePicture => desk.path_dialog.ask(Purpose::Picture),
            Request::Open(name) => open(&name, &options, &mut desk, &mut view, &mut commands),
            Request::SavePicture(path) => {
                commands
                    .spawn(Screenshot::primary_window())
                    .observe(save_to(path));
            }
            Request::ChooseChanges => desk.path_dialog.ask(Purpose::Changes),
            Request::SaveChanges(path) => {
                if let Some(simulation) = &simulation {
                    desk.notify(said(
                        "The list of changes",
                        &path,
                        save_changes(simulation, &path),
                    ));
                }
            }
            Request::Show(sheet) => desk.show_sheet(sheet),
            Request::Quit => {
                exit.write(AppExit::Success);
            }
        }
    }
}

/// Opens the scene called `name`; one that cannot be opened leaves the present one running.
fn open(
    name: &str,
    options: &OpenWith,
    desk: &mut Desk,
    view: &mut ViewSettings,
    commands: &mut Commands,
) {
    match Scene::open(name) {
        Ok(scene) => {
            // A script belongs to the scene it was given with.
            let options = Options {
                script: Vec::new(),
                ..options.0.clone()
            };
            commands.insert_resource(Simulation::open(scene, options));
            desk.scene_opened(name);
            view.cut = None;
            view.camera_request = Some(crate::view::CameraRequest::Home);
        }
        Err(error) => desk.show_scene_error(error.to_string()),
    }
}

/// Writes the picture that was taken to `path` and says so.
fn save_to(path: PathBuf) -> impl FnMut(On<ScreenshotCaptured>, ResMut<Desk>) {
    move |captured, mut desk| {
        desk.notify(said("The picture", &path, save_png(&captured.image, &path)));
    }
}

/// Writes the changes of the present run to `path`, with what leads to the state shown.
fn save_changes(simulation: &Simulation, path: &Path) -> io::Result<()> {
    let world = simulation.world();
    let world = world.ok_or_else(|| io::Error::other("there is no run yet"))?;
    let scene = simulation.scene();
    Claim::of(&scene.title, scene, simulation.commands(), world).write(path)
}

/// What to tell a person about a file that was to be written.
fn said(what: &str, path: &Path, written: Result<(), impl Display>) -> String {
    let shown = path.display();
    match written {
        Ok(()) => format!("Saved {shown}"),
        Err(reason) => format!("{what} cannot be written to {shown}: {reason}"),
    }
}
