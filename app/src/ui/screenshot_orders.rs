//! What is asked of the job that takes pictures, and how far a film has come.
//!
//! In: orders of a person. Out: the state that the bar over the picture shows. Who takes the
//! pictures is the window's screenshot job.

use bevy::prelude::Resource;
use std::path::PathBuf;

/// What was asked for and is still to be begun, and the film that is being recorded, if one is.
#[derive(Resource, Default)]
pub struct ScreenshotOrders {
    /// What was asked for, in order.
    pub asked: Vec<ScreenshotOrder>,
    /// Whether a single picture is being taken: nothing lies over the window then that would not
    /// stay.
    pub is_taking: bool,
    /// What becomes of the film.
    pub film: FilmState,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureOf {
    /// The window with its panels.
    #[default]
    Window,
    /// The grains alone, without panels, clock and marks, over all of the window.
    Grains,
    /// The same without a background.
    CutOut,
}

/// What a person can ask for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScreenshotOrder {
    /// One picture as it is now, into this PNG file.
    Picture(PathBuf, PictureOf),
    /// A film of the picture without panels from now on, into this file or folder.
    Film(PathBuf),
    /// End the film and write it.
    EndFilm,
    /// Give up the film; no file is left.
    CancelFilm,
}

/// What becomes of a film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FilmState {
    /// There is none.
    #[default]
    Idle,
    /// Its pictures are taken.
    Recording {
        /// Number of pictures so far.
        pictures: usize,
        /// Simulated time that they span [s].
        time: f64,
    },
    /// Its last pictures are being written; so many are left.
    Writing(usize),
}
