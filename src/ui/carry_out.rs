//! What panels ask for, fulfilled: the only place that changes the run, opens scenes and writes pictures for them.

use super::{Desk, OpenWith, Purpose, Recorder, Request, Requests, first_speed};
use crate::scene::Scene;
use crate::simulation::{
    Claim, Command, Half, Options, Provenance, SavedFile, ScriptedCommand, Session, SessionError,
    Simulation,
};
use crate::view::{CameraRequest, ViewSettings, save_png};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::tasks::{IoTaskPool, Task, futures::check_ready};
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A session that is being read.
#[derive(Resource, Default)]
pub struct Opening(Option<(String, Task<Result<Session, SessionError>>)>);

/// What it takes to open something.
#[derive(SystemParam)]
pub struct Opener<'w, 's> {
    opening: ResMut<'w, Opening>,
    options: Res<'w, OpenWith>,
    view: ResMut<'w, ViewSettings>,
    recorder: ResMut<'w, Recorder>,
    commands: Commands<'w, 's>,
}

/// Fulfils every request in the order in which it was made.
pub fn fulfil_requests(
    mut requests: ResMut<Requests>,
    mut simulation: Option<ResMut<Simulation>>,
    mut desk: ResMut<Desk>,
    mut opener: Opener,
    mut exit: MessageWriter<AppExit>,
) {
    let mut asked = std::mem::take(&mut requests.0);
    if let Some(simulation) = &mut simulation {
        asked.extend(tell_saved(simulation, &mut desk));
    }
    for request in asked {
        let simulation = simulation.as_deref_mut();
        let unsaved = (simulation.as_ref()).is_some_and(|simulation| simulation.is_unsaved());
        let Some(request) = without_loss(request, unsaved, &mut desk) else {
            continue;
        };
        match request {
            Request::Command(command) => {
                if let Some(simulation) = simulation {
                    simulation.send(command);
                }
            }
            Request::Compare(parameter) => desk.compare(parameter.as_ref()),
            Request::StartTwin(parameter, value) => {
                let started = simulation.map(|simulation| simulation.start_twin(&parameter, value));
                if let Some(Err(reason)) = started {
                    desk.notify(reason);
                }
                opener.view.focus = Half::Left;
            }
            Request::TwinValue(value) => {
                if let Some(simulation) = simulation {
                    simulation.set_twin(value);
                }
            }
            Request::EndTwin(half) => {
                if let Some(simulation) = simulation {
                    simulation.end_twin(half);
                    desk.notify(format!(
                        "The {} run goes on; the other one stays on the plots and in the list of runs",
                        half.label()
                    ));
                }
                opener.view.focus = Half::Left;
            }
            Request::Trail => {
                if let Some(grain) = opener.view.selected {
                    opener.view.trace(grain);
                }
            }
            Request::NoTrails => opener.view.traced.clear(),
            Request::Camera(request) => opener.view.camera_request = Some(request),
            Request::ShowScenes => desk.show_scenes(),
            Request::ChooseFile => desk.path_dialog.ask(Purpose::Open),
            Request::ChoosePicture => desk.path_dialog.ask(Purpose::Picture),
            Request::Open(name) => opener.open(name, &mut desk),
            Request::Start(scene) => {
                opener.start_again(*scene, simulation.as_deref());
                desk.scene_changed();
            }
            Request::Save => match (simulation, desk.session.clone()) {
                (Some(simulation), Some(path)) => simulation.save(path),
                _ => desk.path_dialog.ask(Purpose::Session),
            },
            Request::ChooseSession => desk.path_dialog.ask(Purpose::Session),
            Request::SaveSession(path) => {
                if let Some(simulation) = simulation {
                    simulation.save(path);
                }
            }
            Request::SavePicture(path) => {
                // This update's state is the one in the picture that is asked for in it.
                let from = simulation.as_deref().and_then(Simulation::provenance);
                opener
                    .commands
                    .spawn(Screenshot::primary_window())
                    .observe(save_to(path, from));
            }
            Request::ChooseChanges => desk.path_dialog.ask(Purpose::Changes),
            Request::SaveChanges(path) => {
                if let Some(simulation) = simulation {
                    let saved = save_changes(simulation, &path);
                    desk.notify(said("The list of changes", &path, saved));
                }
            }
            Request::ExportPlot(export) => {
                desk.export = Some(export);
                desk.path_dialog.ask(Purpose::Plot);
            }
            Request::SavePlot(path) => save_plot(&path, &mut desk),
            Request::ChooseFilm => desk.path_dialog.ask(Purpose::Film),
            Request::Film(order) => opener.recorder.order = Some(order),
            Request::Show(sheet) => desk.show_sheet(sheet),
            Request::Quit => {
                exit.write(AppExit::Success);
            }
            Request::SaveThen(_) | Request::Leave(_) => {}
        }
    }
    let saving = simulation.is_some_and(|simulation| simulation.is_saving());
    let given_up = !saving && !desk.path_dialog.is_open();
    if given_up && desk.after_saving.take().is_some() {
        desk.notify("The session was not saved, so it stays open. Ctrl+S saves it.");
    }
}

/// What to do for `request`; nothing yet where it leaves `unsaved` work and a person must be asked first. What cannot be
/// opened leaves nothing, and is told at once.
fn without_loss(request: Request, unsaved: bool, desk: &mut Desk) -> Option<Request> {
    match request {
        Request::Open(name) if unsaved && let Some(error) = no_scene(&name) => {
            desk.show_open_error(error);
            None
        }
        Request::Open(_) | Request::Start(_) | Request::Quit if unsaved => {
            desk.ask_to_save(request);
            None
        }
        Request::Leave(request) => Some(*request),
        Request::SaveThen(next) => {
            desk.after_saving = Some(*next);
            Some(Request::Save)
        }
        request => Some(request),
    }
}

/// Why there is no scene called `name`, where that is no session either.
fn no_scene(name: &str) -> Option<String> {
    let scene = (!Session::is_at(Path::new(name))).then(|| Scene::open(name))?;
    scene.err().map(|error| error.to_string())
}

/// What gives a run the present values of the live parameters at its start.
fn present(simulation: &Simulation) -> Vec<ScriptedCommand> {
    let away = simulation.parameters().iter().filter_map(|info| {
        let value = simulation.value(&info.parameter);
        let parameter = info.parameter.clone();
        (value != info.default).then_some(Command::Set { parameter, value })
    });
    let at_the_start = |command| ScriptedCommand {
        step: Some(0),
        time: None,
        command,
    };
    away.map(at_the_start).collect()
}

/// Says what became of the session's files; what was to follow, if it may now.
fn tell_saved(simulation: &mut Simulation, desk: &mut Desk) -> Option<Request> {
    let mut next = None;
    for SavedFile { path, outcome } in simulation.take_saved() {
        let following = desk.after_saving.take();
        if outcome.is_ok() {
            desk.session = Some(path.clone());
            next = following.map(|next| Request::Leave(Box::new(next)));
        }
        desk.notify(said("The session", &path, outcome));
    }
    next
}

/// Goes on with the session that has been read; one that cannot be leaves the present one running.
pub fn finish_opening(mut desk: ResMut<Desk>, mut opener: Opener) {
    let Some((name, task)) = &mut opener.opening.0 else {
        return;
    };
    let Some(read) = check_ready(task) else {
        return;
    };
    let name = std::mem::take(name);
    opener.opening.0 = None;
    match read {
        Ok(session) => {
            let options = Options {
                speed: first_speed(session.claim().scene.duration),
                ..opener.options.0.clone()
            };
            opener.show(Simulation::resume(session, options));
            desk.session_opened(&name);
        }
        Err(error) => desk.show_open_error(error.to_string()),
    }
}

impl Opener<'_, '_> {
    /// Opens the scene or the session called `name`; one that cannot be opened leaves the present one running.
    fn open(&mut self, name: String, desk: &mut Desk) {
        self.opening.0 = None;
        if Session::is_at(Path::new(&name)) {
            desk.notify(format!("Reading {name}"));
            let path = PathBuf::from(&name);
            let read = IoTaskPool::get().spawn(async move { Session::read(&path) });
            self.opening.0 = Some((name, read));
            return;
        }
        match Scene::open(&name) {
            Ok(scene) => {
                // A script belongs to the scene it was given with.
                let speed = first_speed(scene.duration);
                self.start(scene, Vec::new(), None, speed);
                desk.scene_opened(&name);
            }
            Err(error) => desk.show_open_error(error.to_string()),
        }
    }

    /// Starts a run of `scene`, which came of that of the present `simulation`, with what was changed there.
    fn start_again(&mut self, scene: Scene, simulation: Option<&Simulation>) {
        let script = simulation.map_or_else(Vec::new, present);
        let original = simulation.map(|simulation| simulation.original().clone());
        let speed = simulation.map_or(1.0, Simulation::speed);
        self.start(scene, script, original, speed);
    }

    /// Starts a run of `scene`, which came of the `original`, with `script`, at this `speed`.
    fn start(
        &mut self,
        scene: Scene,
        script: Vec<ScriptedCommand>,
        original: Option<Arc<Scene>>,
        speed: f64,
    ) {
        let options = Options {
            speed,
            script,
            ..self.options.0.clone()
        };
        let simulation = Simulation::open(scene, options);
        self.show(match original {
            Some(original) => simulation.made_of(original),
            None => simulation,
        });
    }

    /// Shows `simulation` as a scene is shown at first.
    fn show(&mut self, simulation: Simulation) {
        self.commands.insert_resource(simulation);
        self.view.cut = None;
        (self.view.selected, self.view.beside) = (None, None);
        self.view.traced.clear();
        self.view.focus = Half::Left;
        self.view.camera_request = Some(CameraRequest::Home);
    }
}

/// Writes the picture that was taken to `path` and says so.
fn save_to(
    path: PathBuf,
    from: Option<Provenance>,
) -> impl FnMut(On<ScreenshotCaptured>, ResMut<Desk>) {
    move |captured, mut desk| {
        let saved = save_png(&captured.image, from.as_ref(), &path);
        desk.notify(said("The picture", &path, saved));
    }
}

/// Writes the plot that was asked for to `path`.
fn save_plot(path: &Path, desk: &mut Desk) {
    let Some(export) = desk.export.take() else {
        return;
    };
    let written = export.write(path);
    desk.notify(said("The plot", path, written));
}

/// Writes the changes of the present run to `path`, with what leads to the state shown.
fn save_changes(simulation: &Simulation, path: &Path) -> io::Result<()> {
    let world = simulation.world();
    let world = world.ok_or_else(|| io::Error::other("there is no run yet"))?;
    let scene = simulation.scene();
    Claim::of(&scene.title, scene, simulation.commands(), world).write(path)
}

/// What to tell a person about a file that was to be written.
pub(crate) fn said(what: &str, path: &Path, written: Result<(), impl Display>) -> String {
    // In full: a person should find it again.
    let whole = std::path::absolute(path).unwrap_or(path.to_owned());
    let shown = whole.display();
    match written {
        Ok(()) => format!("Saved {shown}"),
        Err(reason) => format!("{what} cannot be written to {shown}: {reason}"),
    }
}
