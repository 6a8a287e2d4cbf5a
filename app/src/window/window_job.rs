//! What a window opens with and how, and why there may be none.
//!
//! In: what the command line asked for. Out: plain data for the app, and its errors with their exit
//! codes.

use crate::simulation::Simulation;
use crate::ui::PictureOf;
use crate::window::environment::Missing;
use bevy::math::UVec2;
use grainfall::lab::{Kept, Options};
use grainfall::lesson::Lesson;
use grainfall::parameters::{Parameter, Value};
use grainfall::recording::Recording;
use grainfall::run::{ScriptedCommand, Session};
use grainfall::scene::Scene;
use std::path::PathBuf;

/// What to open and how.
pub struct WindowJob {
    /// What people call it: a file or a built-in scene's name.
    pub name: String,
    /// The scene, the session or the recording.
    pub opened: Opened,
    /// Threads of the solver; without any, as many as a window leaves.
    pub threads: Option<usize>,
    /// Commands carried out by themselves when their time comes.
    pub script: Vec<ScriptedCommand>,
    /// A live parameter and its value [SI unit] in a second run beside the first.
    pub compared: Option<(Parameter, Value)>,
    /// A picture to take before the program ends by itself; without one a person ends it.
    pub picture: Option<PictureJob>,
}

/// What a window opens with.
pub enum Opened {
    /// A scene at its start.
    Scene(Box<Scene>),
    /// A lesson at its first step, in its scene.
    Lesson(Box<Lesson>, Box<Scene>),
    /// A session at the moment that was shown.
    Session(Box<Session>),
    /// A recording at its start.
    Recording(Box<Recording>),
    /// One that comes with the program: a scene on its way, in no file of the person's.
    Shipped(Box<Session>),
}

impl Opened {
    /// Its scene.
    pub(super) fn scene(&self) -> &Scene {
        match self {
            Self::Scene(scene) | Self::Lesson(_, scene) => scene,
            Self::Session(session) | Self::Shipped(session) => &session.record().scene,
            Self::Recording(recording) => recording.scene(),
        }
    }

    /// The run of it, as `options` say.
    pub(super) fn run(self, options: Options) -> Simulation {
        match self {
            Self::Scene(scene) | Self::Lesson(_, scene) => Simulation::open(*scene, options),
            Self::Session(session) | Self::Shipped(session) => {
                Simulation::resume(*session, options)
            }
            Self::Recording(recording) => Simulation::play_back(*recording, options),
        }
    }
}

impl From<Kept> for Opened {
    fn from(kept: Kept) -> Self {
        match kept {
            Kept::Session(session) => Self::Session(session),
            Kept::Recording(recording) => Self::Recording(recording),
        }
    }
}

impl From<Recording> for Opened {
    fn from(recording: Recording) -> Self {
        Self::Recording(Box::new(recording))
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
    /// What it shows.
    pub of: PictureOf,
    /// Whether it is taken without a display.
    pub offscreen: bool,
}

/// A film that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmJob {
    /// The GIF or video, or the folder of pictures.
    pub path: PathBuf,
    /// Simulated time of its first picture [s]; where there is no state yet by then, the first that
    /// there is.
    pub at: f64,
    /// Simulated seconds for each second of the film; as the window first plays the scene where
    /// none is given.
    pub speed: Option<f64>,
    /// Frames a second.
    pub rate: f64,
    /// Width and height of its pictures [pixels].
    pub size: UVec2,
    /// Whether it shows the grains alone, without clock and scale bar.
    pub plain: bool,
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
