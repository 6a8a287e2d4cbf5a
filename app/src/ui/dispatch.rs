//! What each request of the panels does: the only place that changes the run, opens scenes and
//! writes files for them.
//!
//! In: requests in the order in which they were made. Out: the simulation, the dock and the view
//! changed; orders for the screenshot job. What would lose work is asked about first.

use crate::simulation::Simulation;
use crate::ui::dialogs::capture_form::CaptureForm;
use crate::ui::dialogs::path_dialog::Purpose;
use crate::ui::dock::Dock;
use crate::ui::opener::Opener;
use crate::ui::panels::lesson::show_look;
use crate::ui::request::{LessonAct, Request, Requests, SweepAct};
use crate::ui::screenshot_orders::{FilmState, PictureOf, ScreenshotOrder};
use crate::ui::sweep_desk::SweepDesk;
use crate::view::{CameraRequest, ViewSettings};
use bevy::prelude::*;
use grainfall::lab::{Half, Kept, LabCommand, SavedFile};
use grainfall::lesson::Lesson;
use grainfall::parameters::{Parameter, Value};
use grainfall::run::{CommandError, Estimate, RunRecord};
use grainfall::scene::Scene;
use std::fmt::Display;
use std::io;
use std::path::Path;

/// Fulfils every request in the order in which it was made.
pub fn fulfil_requests(
    mut requests: ResMut<Requests>,
    mut simulation: Option<ResMut<Simulation>>,
    mut dock: ResMut<Dock>,
    mut opener: Opener,
    mut exit: MessageWriter<AppExit>,
) {
    let mut asked = std::mem::take(&mut requests.0);
    if let Some(simulation) = &mut simulation {
        asked.extend(tell_saved(simulation, &mut dock));
    }
    let sets = asked.iter().any(Request::sets_a_value);
    if let Some(simulation) = simulation.as_mut().filter(|_| sets && !dock.is_changing) {
        simulation.send(LabCommand::OpenChange);
        dock.is_changing = true;
    }
    for request in asked {
        let simulation = simulation.as_deref_mut();
        let unsaved = (simulation.as_ref()).is_some_and(|simulation| simulation.is_unsaved());
        if let Some(request) = without_loss(request, unsaved, &mut dock) {
            fulfil(request, simulation, &mut dock, &mut opener, &mut exit);
        }
    }
    if dock.is_changing && !dock.is_holding {
        dock.is_changing = false;
        if let Some(simulation) = &mut simulation {
            simulation.send(LabCommand::CloseChange);
        }
    }
    let saving = simulation.is_some_and(|simulation| simulation.is_saving());
    let given_up = !saving && !dock.path_dialog.is_open();
    if given_up && dock.after_saving.take().is_some() {
        dock.notify("The session was not saved, so it stays open. Ctrl+S saves it.");
    }
}

/// Why a request cannot be fulfilled now.
fn refusal(request: &Request, simulation: Option<&Simulation>, opener: &Opener) -> Option<String> {
    let is_recording = simulation.is_some_and(|lab| lab.recording().is_some());
    if is_recording && request.takes_a_run() {
        return Some(CommandError::Recorded.to_string());
    }
    let is_replaying = matches!(opener.screenshots.film, FilmState::Replaying { .. });
    (is_replaying && request.moves_the_run())
        .then(|| "What is recorded is being filmed: cancel the film first".to_owned())
}

/// The request, where nothing speaks against it; else the person is told what does, or asked.
fn admitted(
    request: Request,
    simulation: Option<&Simulation>,
    dock: &mut Dock,
    opener: &Opener,
) -> Option<Request> {
    if let Some(reason) = refusal(&request, simulation, opener) {
        dock.notify(reason);
        return None;
    }
    match request {
        Request::Anyway(request) => Some(*request),
        request => match doubt(&request, &dock.sweeps) {
            Some(reason) => {
                dock.doubt(reason, request);
                None
            }
            None => Some(request),
        },
    }
}

/// Asks where to put a picture, and how large it is to be.
fn choose_picture(of: PictureOf, dock: &mut Dock) {
    let form = CaptureForm::picture(of, dock.memory.capture());
    dock.path_dialog.ask_with(Purpose::Picture, form);
}

/// Orders a picture or a film, and remembers what was chosen.
fn take_picture(order: ScreenshotOrder, dock: &mut Dock, opener: &mut Opener) {
    dock.memory.keep_capture(&order);
    opener.screenshots.asked.push(order);
}

/// Asks what a film is to be like; ends the one that is being recorded, if one is.
fn choose_film(simulation: &Simulation, dock: &mut Dock, opener: &mut Opener) {
    match opener.screenshots.film {
        FilmState::Idle => {
            let form = CaptureForm::film(dock.memory.capture(), simulation);
            dock.path_dialog.ask_with(Purpose::Film, form);
        }
        FilmState::Recording { .. } | FilmState::Replaying { .. } => {
            take_picture(ScreenshotOrder::EndFilm, dock, opener);
        }
        FilmState::Writing(_) => dock.notify("The last film is still being written"),
    }
}

/// Fulfils one request that loses nothing.
fn fulfil(
    request: Request,
    simulation: Option<&mut Simulation>,
    dock: &mut Dock,
    opener: &mut Opener,
    exit: &mut MessageWriter<AppExit>,
) {
    let Some(request) = admitted(request, simulation.as_deref(), dock, opener) else {
        return;
    };
    match (request, simulation) {
        (Request::Command(command), Some(simulation)) => simulation.send(command),
        (Request::StartComparison(parameter, value), Some(simulation)) => {
            compare(simulation, parameter, value, dock, &mut opener.view);
        }
        (Request::SetIn(half, parameter, value), Some(simulation)) => {
            simulation.send(LabCommand::SetIn {
                half,
                parameter,
                value,
            });
        }
        (Request::NameRun { half, number, name }, Some(simulation)) => {
            simulation.send(LabCommand::NameBranch { half, number, name });
        }
        (Request::EndComparison(half), Some(simulation)) => {
            end_comparison(simulation, half, dock, &mut opener.view);
        }
        (Request::Lesson(act), Some(simulation)) => {
            go_on_in_lesson(act, simulation, dock, &mut opener.view);
        }
        (Request::SaveSession(path), Some(run)) => {
            let look = opener.look(dock);
            run.send(LabCommand::Save { path, look });
        }
        (Request::SaveChanges(path), Some(run)) => {
            dock.notify(said("The list of changes", &path, save_changes(run, &path)));
        }
        (Request::Save, simulation) => save(simulation, dock, opener),
        (Request::Start(scene), run) => opener.start_again(*scene, run.as_deref(), dock),
        (Request::RunAnew, Some(recording)) => {
            opener.start_again(recording.scene().clone(), Some(recording), dock);
        }
        (Request::RunOn, Some(recording)) => opener.run_on(recording, dock),
        (Request::MeasureFlow, Some(recording)) => recording.send(LabCommand::MeasureFlow),
        (Request::TypeName, Some(simulation)) => dock.ask_name(simulation, opener.view.focus),
        (Request::TypeMoment, Some(simulation)) => dock.ask_moment(simulation),
        (Request::Menus, _) => dock.wants_menus = !dock.is_presenting,
        (Request::Repeat, Some(simulation)) => dock.transport.repeat.mark(simulation),
        (Request::Trail, _) => opener.trace_selected(),
        (Request::Ruler, _) => opener.view.ruler.toggle(),
        (Request::NoTrails, _) => opener.view.traced.clear(),
        (Request::Camera(request), _) => {
            let keeps = matches!(request, CameraRequest::Save(_));
            opener.view.follows_selected &= keeps;
            opener.view.camera_request = Some(request);
        }
        (Request::Compare(parameter), _) => dock.compare(parameter.as_ref()),
        (Request::Sweep(act), _) => act_on_sweep(act, dock, opener),
        (Request::ShowScenes, _) => dock.show_scenes(),
        (Request::Show(sheet), _) => dock.show_sheet(sheet),
        (Request::Arrange(asked), run) => dock.rearrange(asked, run.as_deref()),
        (Request::Present, _) => dock.present(),
        (Request::FullScreen, _) => dock.is_full_screen ^= true,
        (Request::Open(name), _) => opener.open(name, dock),
        (Request::OpenLeft(path), _) => opener.open_left(path, dock),
        (Request::DiscardLeft(path), _) => discard(&path, dock),
        (Request::ChooseFile, _) => dock.path_dialog.ask(Purpose::Open),
        (Request::ChoosePicture(of), _) => choose_picture(of, dock),
        (Request::ChooseSession, _) => dock.path_dialog.ask(Purpose::Session),
        (Request::ChooseChanges, _) => dock.path_dialog.ask(Purpose::Changes),
        (Request::ChooseFilm, Some(simulation)) => choose_film(simulation, dock, opener),
        (Request::ExportPlot(export), _) => dock.export_plot(export),
        (Request::SavePlot(path), _) => save_plot(&path, dock),
        (Request::Screenshot(order), _) => take_picture(order, dock, opener),
        (Request::Quit, _) => {
            dock.sweeps.leave();
            exit.write(AppExit::Success);
        }
        // Without a run there is nothing to change; what leaves a session was taken apart before.
        (
            Request::Command(_)
            | Request::StartComparison(..)
            | Request::SetIn(..)
            | Request::EndComparison(_)
            | Request::NameRun { .. }
            | Request::TypeName
            | Request::TypeMoment
            | Request::RunAnew
            | Request::RunOn
            | Request::MeasureFlow
            | Request::Lesson(_)
            | Request::Repeat
            | Request::ChooseFilm
            | Request::SaveSession(_)
            | Request::SaveChanges(_),
            None,
        )
        | (Request::SaveThen(_) | Request::Leave(_) | Request::Anyway(_), _) => {}
    }
}

/// Removes the session that an earlier window left.
fn discard(path: &Path, dock: &mut Dock) {
    if let Err(error) = grainfall::files::remove_file(path) {
        dock.notify(format!("{} cannot be removed: {error}", path.display()));
    }
}

/// Does what is asked of parameter sweeps.
fn act_on_sweep(act: SweepAct, dock: &mut Dock, opener: &mut Opener) {
    match act {
        SweepAct::Ask(parameter) => dock.ask_sweep(parameter.as_ref()),
        SweepAct::Start(question) => dock.sweeps.start(*question, opener.options.0.beds.clone()),
        SweepAct::Stop => dock.sweeps.stop(),
        SweepAct::ChooseFolder => dock.path_dialog.ask(Purpose::SweepFolder),
        SweepAct::Folder(folder) => dock.sweeps.settle_in(folder),
        SweepAct::Open(case) => opener.open_case(*case, dock),
    }
}

/// Saves the session to the file it has, or lets the person choose one.
fn save(simulation: Option<&mut Simulation>, dock: &mut Dock, opener: &Opener) {
    match (simulation, dock.session.clone()) {
        (Some(simulation), Some(path)) => {
            let look = opener.look(dock);
            simulation.send(LabCommand::Save { path, look });
        }
        _ => dock.path_dialog.ask(Purpose::Session),
    }
}

/// Begins a run beside the present one, or says why not.
fn compare(
    simulation: &mut Simulation,
    parameter: Parameter,
    value: Value,
    dock: &mut Dock,
    view: &mut ViewSettings,
) {
    match simulation.check_comparison(&parameter, value) {
        Ok(()) => simulation.send(LabCommand::Compare { parameter, value }),
        Err(reason) => dock.notify(reason),
    }
    view.focus = Half::Left;
}

/// Does what was asked of the lesson that is followed.
fn go_on_in_lesson(
    act: LessonAct,
    simulation: &mut Simulation,
    dock: &mut Dock,
    view: &mut ViewSettings,
) {
    let look = |dock: &Dock| dock.lesson.under_way().map(|lesson| lesson.look().clone());
    let before = look(dock);
    for command in dock.lesson.act(act, simulation) {
        simulation.send(command);
    }
    let now = look(dock).filter(|now| before.as_ref() != Some(now));
    if let Some(look) = now {
        show_look(&look, view);
    }
}

/// Goes on with the run in `half` alone.
fn end_comparison(
    simulation: &mut Simulation,
    half: Half,
    dock: &mut Dock,
    view: &mut ViewSettings,
) {
    simulation.send(LabCommand::EndComparison { keep: half });
    dock.notify(format!(
        "The {} run goes on; the other one stays on the plots and in the list of runs",
        half.label()
    ));
    view.focus = Half::Left;
}

/// The request to fulfil now. None where `request` would lose `unsaved` work: then the person is
/// asked first. A scene that cannot be opened loses nothing; its error is shown at once.
fn without_loss(request: Request, unsaved: bool, dock: &mut Dock) -> Option<Request> {
    match request {
        Request::Open(name) if unsaved && let Some(error) = no_scene(&name) => {
            dock.show_open_error(error);
            None
        }
        Request::Open(_)
        | Request::OpenLeft(_)
        | Request::Start(_)
        | Request::Sweep(SweepAct::Open(_))
        | Request::Quit
            if unsaved =>
        {
            dock.ask_to_save(request);
            None
        }
        Request::Leave(request) => Some(*request),
        Request::SaveThen(next) => {
            dock.after_saving = Some(*next);
            Some(Request::Save)
        }
        request => Some(request),
    }
}

/// What speaks against what `request` asks for: memory or time that this machine has not for a
/// scene, or a sweep that is running.
fn doubt(request: &Request, sweeps: &SweepDesk) -> Option<String> {
    match request {
        Request::Quit => sweeps.progress().map(|progress| leaving(&progress)),
        Request::Open(name) if !Kept::is_at(name) => {
            Estimate::of_start(&Scene::open(name).ok()?).question()
        }
        Request::Start(scene) => Estimate::of_start(scene).question(),
        _ => None,
    }
}

/// What is asked before a window is left in which a sweep has come to this `progress`.
fn leaving(progress: &str) -> String {
    format!(
        "A parameter sweep is running: {progress}. What is done is kept, and the same question goes on from there the next time."
    )
}

/// The error of opening the scene called `name`; none where it opens or is no scene but a session or
/// a recording.
fn no_scene(name: &str) -> Option<String> {
    if Kept::is_at(name) {
        return None;
    }
    if Lesson::is_at(name) {
        return Lesson::open(name).err().map(|error| error.to_string());
    }
    let scene = Scene::open(name);
    scene.err().map(|error| error.to_string())
}

/// Reports whether the session was saved; returns the request that waited for it, where it was.
fn tell_saved(simulation: &mut Simulation, dock: &mut Dock) -> Option<Request> {
    let mut next = None;
    for SavedFile { path, outcome } in simulation.take_saved() {
        let following = dock.after_saving.take();
        if outcome.is_ok() {
            dock.session = Some(path.clone());
            next = following.map(|next| Request::Leave(Box::new(next)));
        }
        dock.notify(said("The session", &path, outcome));
    }
    next
}

/// Writes the plot that was asked for to `path`.
fn save_plot(path: &Path, dock: &mut Dock) {
    let Some(export) = dock.export.take() else {
        return;
    };
    let written = export.write(path);
    dock.notify(said("The plot", path, written));
}

/// Writes the changes of the present run to `path`, with all that leads to the state shown.
fn save_changes(simulation: &Simulation, path: &Path) -> io::Result<()> {
    let world = simulation.world();
    let world = world.ok_or_else(|| io::Error::other("there is no run yet"))?;
    let scene = simulation.scene();
    RunRecord::of(&scene.title, scene, simulation.commands(), world).write(path)
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
