//! What each request of the panels does: the only place that changes the run, opens scenes and
//! writes files for them.
//!
//! In: requests in the order in which they were made. Out: the simulation, the dock and the view
//! changed; orders for the screenshot job. What would lose work is asked about first.

use crate::simulation::Simulation;
use crate::ui::dialogs::path_dialog::Purpose;
use crate::ui::dock::Dock;
use crate::ui::panels::lesson::show_look;
use crate::ui::playback::first_speed;
use crate::ui::request::{LessonAct, Request, Requests, SweepAct};
use crate::ui::screenshot_orders::{FilmState, ScreenshotOrders};
use crate::ui::session_look::SessionLook;
use crate::ui::sweep_desk::SweepDesk;
use crate::view::{CameraRequest, OrbitCamera, Ruler, ViewSettings};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{IoTaskPool, Task};
use grainfall::engines::sound_scene_from;
use grainfall::lab::{Half, Kept, LabCommand, Options, SavedFile};
use grainfall::lesson::Lesson;
use grainfall::parameters::{Parameter, Value};
use grainfall::run::{Command, CommandError, Estimate, RunRecord, ScriptedCommand, opening};
use grainfall::scene::Scene;
use grainfall::sweep::Case;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How scenes that a person opens are run.
#[derive(Resource, Clone, Debug)]
pub struct OpenWith(pub(super) Options);

/// What is being read: a session or a recording.
#[derive(Resource, Default)]
pub struct Opening(Option<(String, Task<Result<Kept, String>>)>);

/// What opening a scene or a session changes.
#[derive(SystemParam)]
pub struct Opener<'w, 's> {
    opening: ResMut<'w, Opening>,
    options: Res<'w, OpenWith>,
    view: ResMut<'w, ViewSettings>,
    camera: Option<ResMut<'w, OrbitCamera>>,
    screenshots: ResMut<'w, ScreenshotOrders>,
    commands: Commands<'w, 's>,
}

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

/// Fulfils one request that loses nothing.
fn fulfil(
    request: Request,
    simulation: Option<&mut Simulation>,
    dock: &mut Dock,
    opener: &mut Opener,
    exit: &mut MessageWriter<AppExit>,
) {
    let is_recording = (simulation.as_ref()).is_some_and(|lab| lab.recording().is_some());
    if is_recording && request.takes_a_run() {
        return dock.notify(CommandError::Recorded.to_string());
    }
    let request = match request {
        Request::Anyway(request) => *request,
        request => match doubt(&request, &dock.sweeps) {
            Some(reason) => return dock.doubt(reason, request),
            None => request,
        },
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
        (Request::DiscardLeft(path), _) => {
            if let Err(error) = grainfall::files::remove_file(&path) {
                dock.notify(format!("{} cannot be removed: {error}", path.display()));
            }
        }
        (Request::ChooseFile, _) => dock.path_dialog.ask(Purpose::Open),
        (Request::ChoosePicture, _) => dock.path_dialog.ask(Purpose::Picture),
        (Request::ChooseSession, _) => dock.path_dialog.ask(Purpose::Session),
        (Request::ChooseChanges, _) => dock.path_dialog.ask(Purpose::Changes),
        (Request::ChooseFilm, _) if opener.screenshots.film != FilmState::Idle => {
            dock.notify("A film is being recorded already: stop it first");
        }
        (Request::ChooseFilm, _) => dock.path_dialog.ask(Purpose::Film),
        (Request::ExportPlot(export), _) => dock.export_plot(export),
        (Request::SavePlot(path), _) => save_plot(&path, dock),
        (Request::Screenshot(order), _) => opener.screenshots.asked.push(order),
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
            | Request::RunAnew
            | Request::RunOn
            | Request::MeasureFlow
            | Request::Lesson(_)
            | Request::Repeat
            | Request::SaveSession(_)
            | Request::SaveChanges(_),
            None,
        )
        | (Request::SaveThen(_) | Request::Leave(_) | Request::Anyway(_), _) => {}
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

/// The script that gives a new run the present values of the live parameters at its start.
fn present(simulation: &Simulation) -> Vec<ScriptedCommand> {
    let at_the_start = |(parameter, value)| ScriptedCommand {
        step: Some(0),
        time: None,
        command: Command::Set { parameter, value },
    };
    let changed = simulation.changed_values().into_iter();
    changed.map(at_the_start).collect()
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

/// Opens what has been read. Where it cannot be read the present run goes on.
pub fn finish_opening(mut dock: ResMut<Dock>, mut opener: Opener) {
    let Some((name, task)) = &mut opener.opening.0 else {
        return;
    };
    let Some(read) = check_ready(task) else {
        return;
    };
    let name = std::mem::take(name);
    opener.opening.0 = None;
    let duration = read.as_ref().map_or(1.0, |kept| kept.scene().duration);
    let options = opener.options_for(duration);
    match read {
        Ok(Kept::Session(session)) => {
            let (look, scene) = (session.look().to_owned(), session.record().scene.clone());
            opener.show(Simulation::resume(*session, options));
            dock.session_opened(&name);
            opener.take_up(&look, &scene, &mut dock);
        }
        Ok(Kept::Recording(recording)) => {
            opener.show(Simulation::play_back(*recording, options));
            dock.scene_opened(&name);
        }
        Err(error) => dock.show_open_error(error),
    }
}

impl Opener<'_, '_> {
    /// How the window looks, in its own words.
    fn look(&self, dock: &Dock) -> String {
        SessionLook::of(&self.view, self.camera.as_deref(), dock).in_words()
    }

    /// Looks as the session did whose `look` this is; one that is not known changes nothing.
    fn take_up(&mut self, look: &str, scene: &Scene, dock: &mut Dock) {
        if let Some(look) = SessionLook::read(look) {
            look.restore(&mut self.view, self.camera.as_deref_mut(), dock, scene);
        }
    }

    /// How something of this `duration` [s] is run or played.
    fn options_for(&self, duration: f64) -> Options {
        Options {
            speed: first_speed(duration),
            ..self.options.0.clone()
        }
    }

    /// Draws the trail of the selected grain, or no longer.
    fn trace_selected(&mut self) {
        if let Some(grain) = self.view.selected {
            self.view.trace(grain);
        }
    }

    /// Opens the scene, the lesson, the session or the recording called `name`; one that cannot be
    /// opened leaves the present one running.
    fn open(&mut self, name: String, dock: &mut Dock) {
        self.opening.0 = None;
        if Kept::is_at(&name) {
            dock.notify(format!("Reading {name}"));
            let path = PathBuf::from(&name);
            let read = IoTaskPool::get().spawn(async move { Kept::read(&path) });
            self.opening.0 = Some((name, read));
            return;
        }
        if Lesson::is_at(&name) {
            return self.open_lesson(&name, dock);
        }
        if let Some(session) = opening(&name) {
            let options = self.options_for(session.record().scene.duration);
            self.show(Simulation::resume(session, options));
            return dock.scene_opened(&name);
        }
        match Scene::open(&name) {
            Ok(scene) => {
                // A script belongs to the scene it was given with.
                let speed = first_speed(scene.duration);
                self.start(scene, Vec::new(), None, speed);
                dock.scene_opened(&name);
            }
            Err(error) => dock.show_open_error(error.to_string()),
        }
    }

    /// Opens the session that an earlier window left at `path`, as work that is in no file.
    fn open_left(&mut self, path: PathBuf, dock: &mut Dock) {
        match Kept::read(&path) {
            Ok(Kept::Session(session)) => {
                let (look, scene) = (session.look().to_owned(), session.record().scene.clone());
                let options = self.options_for(scene.duration);
                self.show(Simulation::resume(*session, options).unsaved());
                dock.scene_changed();
                self.take_up(&look, &scene, dock);
                dock.taken_up = Some(path);
            }
            Ok(Kept::Recording(_)) => {}
            Err(error) => dock.show_open_error(error),
        }
    }

    /// Opens the lesson called `name` at its first step.
    fn open_lesson(&mut self, name: &str, dock: &mut Dock) {
        match Lesson::open(name) {
            Ok((lesson, scene)) => {
                let speed = first_speed(scene.duration);
                self.start(scene, Vec::new(), None, speed);
                show_look(&lesson.look, &mut self.view);
                dock.lesson_opened(name, lesson);
            }
            Err(error) => dock.show_open_error(error.to_string()),
        }
    }

    /// Starts a run of `scene`, made from that of `simulation`, with the values that were changed
    /// there.
    fn start_again(&mut self, scene: Scene, simulation: Option<&Simulation>, dock: &mut Dock) {
        let script = simulation.map_or_else(Vec::new, present);
        let original = simulation.map(|simulation| simulation.original().clone());
        let speed = simulation.map_or(1.0, |simulation| simulation.speed());
        self.start(scene, script, original, speed);
        dock.scene_changed();
    }

    /// Starts the run of a `case` of a sweep.
    fn open_case(&mut self, case: Case, dock: &mut Dock) {
        let speed = first_speed(case.scene.duration);
        self.start(case.scene, case.script, None, speed);
        dock.scene_changed();
    }

    /// Starts a run with the grains of `recording` as they are at the moment shown, or says why not.
    fn run_on(&mut self, recording: &Simulation, dock: &mut Dock) {
        let Some(world) = recording.world() else {
            return;
        };
        match sound_scene_from(recording.scene(), world) {
            Ok(scene) => {
                let (script, speed) = (present(recording), recording.speed());
                self.start(scene, script, None, speed);
                dock.scene_changed();
            }
            Err(reason) => dock.notify(reason),
        }
    }

    /// Starts a run of `scene`, made from the `original`, with `script`, at this `speed`.
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

    /// Shows `simulation` with nothing cut, selected or traced, from the scene's first view.
    fn show(&mut self, simulation: Simulation) {
        self.commands.insert_resource(simulation);
        self.view.cut = None;
        (self.view.selected, self.view.beside) = (None, None);
        self.view.follows_selected = false;
        self.view.traced.clear();
        self.view.ruler = Ruler::default();
        self.view.focus = Half::Left;
        self.view.camera_request = Some(CameraRequest::Home);
    }
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
