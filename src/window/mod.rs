//! The window: Bevy's app with simulation, view and panels.
//!
//! In: a scene and how to run it. Out: the laboratory, until somebody closes it, or a picture of it at a given simulated
//! time, with a window or without a display. What is missing for either is said before anything opens.

mod commission;
pub mod environment;
pub mod picture;
mod recording;

use crate::scene::Scene;
use crate::simulation::{Options, Parameter, Session, Simulation, SimulationPlugin};
use crate::ui::{Desk, Memory, UiPlugin, first_speed};
use crate::view::{ViewPlugin, ViewSettings};
use bevy::app::ScheduleRunnerPlugin;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraOutputMode, ClearColorConfig};
use bevy::log::{Level, LogPlugin};
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::BlendState;
use bevy::window::PrimaryWindow;
use bevy_egui::{EguiGlobalSettings, EguiPlugin, PrimaryEguiContext};
use commission::{Commission, Outcome};
use environment::{Missing, adapters, display};
use picture::{CanvasPlugin, offscreen_plugins};
pub use recording::RecordingPlugin;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::path::PathBuf;
use std::time::Duration;

/// Least time between two updates without a display, so that the solver has the cores.
const FRAME: Duration = Duration::from_millis(16);

/// What to open and how.
#[derive(Clone)]
pub struct Job {
    /// What people call it: a file or a built-in scene's name.
    pub name: String,
    /// The scene or the session.
    pub opened: Opened,
    /// How it is run.
    pub options: Options,
    /// A live parameter and its value [SI unit] in a second run beside the first.
    pub compared: Option<(Parameter, f64)>,
    /// A picture to take before the program ends by itself; without one a person ends it.
    pub picture: Option<PictureJob>,
}

/// What a window opens with.
#[derive(Clone)]
pub enum Opened {
    /// A scene at its start.
    Scene(Box<Scene>),
    /// A session at the moment that was shown.
    Session(Box<Session>),
}

impl Opened {
    fn scene(&self) -> &Scene {
        match self {
            Self::Scene(scene) => scene,
            Self::Session(session) => &session.claim().scene,
        }
    }

    fn run(self, options: Options) -> Simulation {
        match self {
            Self::Scene(scene) => Simulation::open(*scene, options),
            Self::Session(session) => Simulation::resume(*session, options),
        }
    }
}

impl From<Session> for Opened {
    fn from(session: Session) -> Self {
        Self::Session(Box::new(session))
    }
}

impl From<Scene> for Opened {
    fn from(scene: Scene) -> Self {
        Self::Scene(Box::new(scene))
    }
}

/// A picture of the whole laboratory at one moment of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureJob {
    /// The PNG file.
    pub path: PathBuf,
    /// Simulated time at which it is taken [s].
    pub at: f64,
    /// Its size and the window's [pixels].
    pub size: UVec2,
    /// Whether it shows the grains alone, without panels.
    pub plain: bool,
    /// Whether it is taken without a display.
    pub offscreen: bool,
}

/// Why there is no window or no picture.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// The machine lacks something.
    #[error(transparent)]
    Missing(#[from] Missing),
    /// The picture could not be taken.
    #[error("no picture was taken: {0}")]
    Picture(String),
    /// The run met a physical fault before the moment of the picture.
    #[error("no picture was taken: {0}")]
    Fault(String),
    /// The app ended with an error that it has already told.
    #[error("the window ended with an error")]
    Ended,
}

impl WindowError {
    /// What the process ends with: 3 for a physical fault, 1 for the rest.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Fault(_) => 3,
            Self::Missing(_) | Self::Picture(_) | Self::Ended => 1,
        }
    }
}

/// Opens the laboratory and returns when it is closed.
///
/// # Errors
/// Where display or driver are missing, or a picture that was asked for could not be taken.
pub fn run(job: Job) -> Result<(), WindowError> {
    let offscreen = (job.picture.as_ref()).is_some_and(|picture| picture.offscreen);
    if !offscreen {
        display()?;
    }
    let adapters = adapters();
    if adapters.is_empty() {
        return Err(Missing::Driver.into());
    }
    let software = adapters.iter().all(|adapter| adapter.software);
    let outcome = Outcome::default();
    let mut app = quietly(|| build(job, software, outcome.clone())).map_err(Missing::Libraries)?;
    let exit = app.run();
    outcome.result()?;
    exit.is_success().then_some(()).ok_or(WindowError::Ended)
}

/// The app, not yet running.
fn build(mut job: Job, software: bool, outcome: Outcome) -> App {
    let mut app = App::new();
    // A person begins by looking; a picture is taken of a run that goes to its moment as fast as it can.
    job.options.autoplay = job.picture.is_some();
    job.options.speed = match job.picture {
        Some(_) => f64::INFINITY,
        None => first_speed(job.opened.scene().duration),
    };
    let title = title(job.opened.scene());
    match &job.picture {
        Some(picture) if picture.offscreen => app.add_plugins((
            offscreen_plugins().set(log()),
            CanvasPlugin(picture.size),
            ScheduleRunnerPlugin::run_loop(FRAME),
        )),
        picture => app.add_plugins(window_plugins(title, picture.as_ref())),
    };
    app.add_plugins(EguiPlugin::default())
        .insert_resource(EguiGlobalSettings {
            auto_create_primary_context: false,
            ..default()
        })
        .insert_resource(ViewSettings {
            show_overlay: !job.picture.as_ref().is_some_and(|picture| picture.plain),
            // Several samples a pixel are the processor's work where there is no graphics card.
            smooth_edges: !software || job.picture.is_some(),
            ..default()
        })
        .add_plugins((
            SimulationPlugin,
            ViewPlugin,
            RecordingPlugin,
            UiPlugin {
                options: job.options.clone(),
            },
        ))
        .add_systems(Startup, spawn_panel_camera)
        .add_systems(Update, follow_title);
    let mut desk = app.world_mut().resource_mut::<Desk>();
    if job.picture.is_none() {
        desk.remember(Memory::user());
    }
    match &job.opened {
        Opened::Scene(_) => desk.scene_opened(&job.name),
        Opened::Session(_) => desk.session_opened(&job.name),
    }
    desk.is_hidden = job.picture.as_ref().is_some_and(|picture| picture.plain);
    app.insert_resource(job.opened.run(job.options))
        .insert_resource(Comparison {
            wanted: job.compared,
            refused: None,
        })
        .add_systems(Update, begin_comparison);
    if let Some(picture) = job.picture {
        app.insert_resource(Commission::new(picture, outcome))
            .add_systems(Update, commission::carry_out.after(begin_comparison));
    }
    app
}

/// A second run that the window opens with.
#[derive(Resource)]
struct Comparison {
    wanted: Option<(Parameter, f64)>,
    /// Why there is none.
    refused: Option<String>,
}

/// Begins the second run as soon as the first one stands.
fn begin_comparison(
    mut comparison: ResMut<Comparison>,
    simulation: Option<ResMut<Simulation>>,
    mut desk: ResMut<Desk>,
) {
    let Some(mut simulation) = simulation.filter(|simulation| simulation.can_start_twin()) else {
        return;
    };
    if let Some((parameter, value)) = comparison.bypass_change_detection().wanted.take()
        && let Err(reason) = simulation.start_twin(&parameter, value)
    {
        desk.notify(reason.as_str());
        comparison.refused = Some(reason);
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
        .set(RenderPlugin {
            // A picture must not be taken while a pipeline is still missing.
            synchronous_pipeline_compilation: picture.is_some(),
            ..default()
        })
        .set(log())
}

/// Only what a person can act on; `RUST_LOG` shows more.
fn log() -> LogPlugin {
    LogPlugin {
        level: Level::WARN,
        filter: "wgpu=error,naga=error,bevy_render::renderer=error,winit=error,bevy_egui=error"
            .to_owned(),
        ..default()
    }
}

fn title(scene: &Scene) -> String {
    format!("{} – Grainfall", scene.title)
}

/// Keeps the window's title that of the scene.
fn follow_title(
    simulation: Option<Res<Simulation>>,
    window: Option<Single<&mut Window, With<PrimaryWindow>>>,
) {
    if let (Some(simulation), Some(mut window)) = (simulation, window) {
        let title = title(simulation.scene());
        if window.title != title {
            window.title = title;
        }
    }
}

/// The camera that draws the panels over everything.
fn spawn_panel_camera(mut commands: Commands) {
    commands.spawn((
        PrimaryEguiContext,
        Camera2d,
        RenderLayers::none(),
        Msaa::Off,
        Camera {
            // After those of both halves of the picture.
            order: 2,
            output_mode: CameraOutputMode::Write {
                blend_state: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    ));
}

/// Does `work`; if it panics, says what the panic said instead of printing it.
fn quietly<T>(work: impl FnOnce() -> T) -> Result<T, String> {
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
