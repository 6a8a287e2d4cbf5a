//! What panels ask for, fulfilled: the only place that changes the run, opens scenes and writes pictures for them.

use super::{Desk, OpenWith, Purpose, Request, Requests};
use crate::scene::Scene;
use crate::simulation::{Options, Simulation};
use crate::view::{ViewSettings, save_png};
use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use std::path::PathBuf;

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
        let shown = path.display();
        match save_png(&captured.image, &path) {
            Ok(()) => desk.notify(format!("Saved {shown}")),
            Err(reason) => desk.notify(format!(
                "The picture cannot be written to {shown}: {reason}"
            )),
        }
    }
}
