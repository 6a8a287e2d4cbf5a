//! What a file or a folder kept of runs, and how it is told from a scene.
//!
//! In: what a person names. Out: a session or a recording. A scene is what is neither.

use crate::recording::Recording;
use crate::run::Session;
use crate::scene::Scene;
use std::path::Path;

/// What a file or a folder kept of runs.
pub enum Kept {
    /// Runs that can be gone on with.
    Session(Box<Session>),
    /// A run that can be looked at.
    Recording(Box<Recording>),
}

impl Kept {
    /// Whether what is called `name` is to be opened as a session or a recording.
    pub fn is_at(name: &str) -> bool {
        Session::is_at(Path::new(name)) || Recording::is_at(name)
    }

    /// The session or the recording at `path`.
    ///
    /// # Errors
    /// In words, why it cannot be opened.
    pub fn read(path: &Path) -> Result<Self, String> {
        if Session::is_at(path) {
            let session = Session::read(path).map_err(|error| error.to_string())?;
            return Ok(Self::Session(Box::new(session)));
        }
        let recording = Recording::open(path).map_err(|error| error.to_string())?;
        Ok(Self::Recording(Box::new(recording)))
    }

    /// Its scene.
    pub fn scene(&self) -> &Scene {
        match self {
            Self::Session(session) => &session.record().scene,
            Self::Recording(recording) => recording.scene(),
        }
    }
}
