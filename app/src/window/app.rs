//! The app of the window: Bevy with simulation, view and panels, before a person or for one
//! picture.
//!
//! In: a [`WindowJob`]. Out: the laboratory, until somebody closes it, or a picture.

use crate::headless::heard;
use crate::simulation::{Simulation, SimulationPlugin};
use crate::ui::{
    Dock, RescuePlugin, SessionLook, UiPlugin, UserMemory, first_speed, show_look, title_in_words,
};
use crate::view::{OrbitCamera, ViewPlugin, ViewSettings};
use crate::window::canvas::{CanvasPlugin, offscreen_plugins, renderer};
use crate::window::environment::{Missing, adapters, display};
use crate::window::memory_log::MemoryLogPlugin;
use crate::window::one_by_one::OneByOnePlugin;
use crate::window::opening_comparison::{OpeningComparison, begin_comparison};
use crate::window::screenshot_job::{Failure, ScreenshotJobs, ScreenshotPlugin};
use crate::window::second_set::over_everything;
use crate::window::window_job::{Opened, PictureJob, WindowError, WindowJob};
use bevy::app::{ScheduleRunnerPlugin, TerminalCtrlCHandlerPlugin};
use bevy::log::{Level, LogPlugin};
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use bevy_egui::{EguiGlobalSettings, EguiPlugin, PrimaryEguiContext};
use grainfall::lab::Options;
use grainfall::run::Rescue;
use grainfall::scene::Scene as GranularScene;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::time::Duration;

/// Least time between two updates without a display, so that the solver has the cores.
const FRAME: Duration = Duration::from_millis(16);

/// Opens the laboratory and returns when it is closed.
///
/// # Errors
/// Where display or driver are missing, or a picture that was asked for could not be taken.
pub fn run(job: WindowJob) -> Result<(), WindowError> {
    let offscreen = (job.picture.as_ref()).is_some_and(|picture| picture.offscreen);
    if !offscreen {
        display()?;
    }
    let adapters = adapters();
    if adapters.is_empty() {
        return Err(Missing::Driver.into());
    }
    let software = adapters.iter().all(|adapter| adapter.software);
    let failure = Failure::default();
    let mut app = quietly(|| build(job, software, failure.clone())).map_err(Missing::Libraries)?;
    let exit = app.run();
    failure.result()?;
    exit.is_success().then_some(()).ok_or(WindowError::Ended)
}

/// How what is opened is run. A person begins by looking; a picture is taken of a run that goes to its
/// moment as fast as it can, of two from their common start on.
fn options(job: &WindowJob) -> Options {
    let usual = Options::window();
    let is_played = job.picture.is_some();
    let speed = if is_played {
        f64::INFINITY
    } else {
        first_speed(job.opened.scene().duration)
    };
    Options {
        threads: job.threads.unwrap_or(usual.threads),
        autoplay: is_played && job.compared.is_none(),
        speed,
        script: job.script.clone(),
        ..usual
    }
}

/// The app, not yet running.
fn build(job: WindowJob, software: bool, failure: Failure) -> App {
    let mut app = App::new();
    let is_played = job.picture.is_some();
    let options = options(&job);
    let title = window_title(&job.opened.scene().title);
    match &job.picture {
        Some(picture) if picture.offscreen => app.add_plugins((
            offscreen_plugins().set(log()),
            CanvasPlugin(picture.size),
            ScheduleRunnerPlugin::run_loop(FRAME),
        )),
        picture => app.add_plugins(window_plugins(title, picture.as_ref())),
    };
    // Several samples a pixel are the processor's work where there is no graphics card.
    let smooth_edges = !software || job.picture.is_some();
    app.add_plugins(ScreenshotPlugin);
    add_laboratory(&mut app, false, smooth_edges, options.clone());
    app.add_systems(Update, follow_title);
    let mut dock = app.world_mut().resource_mut::<Dock>();
    if job.picture.is_none() {
        dock.remember(UserMemory::user());
        keep_unsaved_work(&mut app);
        app.add_plugins(MemoryLogPlugin);
    }
    let mut dock = app.world_mut().resource_mut::<Dock>();
    match &job.opened {
        Opened::Scene(_) | Opened::Shipped(_) | Opened::Recording(_) => {
            dock.scene_opened(&job.name);
        }
        Opened::Lesson(lesson, _) => dock.lesson_opened(&job.name, lesson.as_ref().clone()),
        Opened::Session(_) => dock.session_opened(&job.name),
    }
    let look = match &job.opened {
        Opened::Session(session) => SessionLook::read(session.look()),
        _ => None,
    };
    if let Some(look) = look {
        take_up(look, job.opened.scene(), app.world_mut());
    }
    if let Opened::Lesson(lesson, _) = &job.opened {
        show_look(
            &lesson.look,
            &mut app.world_mut().resource_mut::<ViewSettings>(),
        );
    }
    app.insert_resource(job.opened.run(options))
        .insert_resource(OpeningComparison {
            wanted: job.compared,
            is_played,
            refused: None,
        })
        .add_systems(Update, begin_comparison);
    if let Some(picture) = job.picture {
        let mut jobs = app.world_mut().resource_mut::<ScreenshotJobs>();
        jobs.add_for_command_line(&picture, failure);
    }
    app
}

/// Adds simulation, view and panels to an `app` that draws: `plain` without what is written into the
/// picture, with smooth edges or without, scenes opened as `options` say.
pub(super) fn add_laboratory(app: &mut App, is_plain: bool, smooth_edges: bool, options: Options) {
    app.add_plugins(EguiPlugin::default())
        .insert_resource(EguiGlobalSettings {
            auto_create_primary_context: false,
            ..default()
        })
        .insert_resource(ViewSettings {
            show_overlay: !is_plain,
            show_measured: !is_plain,
            smooth_edges,
            ..default()
        })
        .add_plugins((
            SimulationPlugin,
            ViewPlugin,
            UiPlugin { options },
            OneByOnePlugin,
        ))
        .add_systems(Startup, spawn_panel_camera);
}

/// Has work that is in no file kept for the case that the program ends unasked, where the system
/// has a place for that.
fn keep_unsaved_work(app: &mut App) {
    if let (Some(home), Ok(stop)) = (Rescue::home(), heard(|| {})) {
        app.add_plugins(RescuePlugin { home, stop });
    }
}

fn window_plugins(title: String, picture: Option<&PictureJob>) -> impl PluginGroup {
    let size = picture.map_or(UVec2::new(1440, 860), |picture| picture.size);
    DefaultPlugins
        .set(WindowPlugin {
            primary_window: Some(Window {
                title,
                name: Some("grainfall".to_owned()),
                resolution: size.into(),
                ..default()
            }),
            // Work that is in no file is asked about first.
            close_when_requested: false,
            ..default()
        })
        .set(renderer(picture.is_some()))
        .set(log())
        // Ours keeps what is in no file first.
        .disable::<TerminalCtrlCHandlerPlugin>()
}

/// Only what a person can act on; `RUST_LOG` shows more.
pub(super) fn log() -> LogPlugin {
    LogPlugin {
        level: Level::WARN,
        filter: "wgpu=error,naga=error,bevy_render::renderer=error,winit=error,bevy_egui=error"
            .to_owned(),
        ..default()
    }
}

/// What stands over the window of a scene that is called `scene`.
fn window_title(scene: &str) -> String {
    format!("{scene} – Grainfall")
}

/// Keeps the window's title that of the scene and of its liquid.
fn follow_title(
    simulation: Option<Res<Simulation>>,
    window: Option<Single<&mut Window, With<PrimaryWindow>>>,
) {
    if let (Some(simulation), Some(mut window)) = (simulation, window) {
        let title = window_title(&title_in_words(&simulation));
        if window.title != title {
            window.title = title;
        }
    }
}

/// The camera that draws the panels over everything.
fn spawn_panel_camera(mut commands: Commands) {
    commands.spawn((PrimaryEguiContext, over_everything()));
}

/// Does `work`; if it panics, says what the panic said instead of printing it.
pub(super) fn quietly<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    let hook = take_hook();
    set_hook(Box::new(|_| {}));
    let result = catch_unwind(AssertUnwindSafe(work));
    set_hook(hook);
    result.map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
        text.unwrap_or_else(|| "the window system's libraries failed".to_owned())
    })
}

/// Looks as a session did.
fn take_up(look: SessionLook, scene: &GranularScene, world: &mut World) {
    world.resource_scope(|world, mut dock: Mut<Dock>| {
        world.resource_scope(|world, mut view: Mut<ViewSettings>| {
            let mut camera = world.get_resource_mut::<OrbitCamera>();
            look.restore(&mut view, camera.as_deref_mut(), &mut dock, scene);
        });
    });
}
