//! Opening scenes, lessons, sessions and recordings in the place of what is shown.
//!
//! In: what a person asked for, by way of [`super::dispatch`]. Out: another simulation, seen from its
//! first view or as it was saved. Sessions and recordings are read on a thread of their own; what
//! cannot be opened leaves the present run going.

use crate::simulation::Simulation;
use crate::ui::dock::Dock;
use crate::ui::panels::lesson::show_look;
use crate::ui::playback::first_speed;
use crate::ui::screenshot_orders::ScreenshotOrders;
use crate::ui::session_look::SessionLook;
use crate::view::{CameraRequest, OrbitCamera, Ruler, ViewSettings};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{IoTaskPool, Task};
use grainfall::engines::sound_scene_from;
use grainfall::lab::{Half, Kept, Options};
use grainfall::lesson::Lesson;
use grainfall::run::{Command, ScriptedCommand, opening};
use grainfall::scene::Scene;
use grainfall::sweep::Case;
use std::path::PathBuf;
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
    pub(super) options: Res<'w, OpenWith>,
    pub(super) view: ResMut<'w, ViewSettings>,
    camera: Option<ResMut<'w, OrbitCamera>>,
    pub(super) screenshots: ResMut<'w, ScreenshotOrders>,
    commands: Commands<'w, 's>,
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
    pub(super) fn look(&self, dock: &Dock) -> String {
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
    pub(super) fn trace_selected(&mut self) {
        if let Some(grain) = self.view.selected {
            self.view.trace(grain);
        }
    }

    /// Opens the scene, the lesson, the session or the recording called `name`; one that cannot be
    /// opened leaves the present one running.
    pub(super) fn open(&mut self, name: String, dock: &mut Dock) {
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
    pub(super) fn open_left(&mut self, path: PathBuf, dock: &mut Dock) {
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
    pub(super) fn start_again(
        &mut self,
        scene: Scene,
        simulation: Option<&Simulation>,
        dock: &mut Dock,
    ) {
        let script = simulation.map_or_else(Vec::new, present);
        let original = simulation.map(|simulation| simulation.original().clone());
        let speed = simulation.map_or(1.0, |simulation| simulation.speed());
        self.start(scene, script, original, speed);
        dock.scene_changed();
    }

    /// Starts the run of a `case` of a sweep.
    pub(super) fn open_case(&mut self, case: Case, dock: &mut Dock) {
        let speed = first_speed(case.scene.duration);
        self.start(case.scene, case.script, None, speed);
        dock.scene_changed();
    }

    /// Starts a run with the grains of `recording` as they are at the moment shown, or says why not.
    pub(super) fn run_on(&mut self, recording: &Simulation, dock: &mut Dock) {
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
