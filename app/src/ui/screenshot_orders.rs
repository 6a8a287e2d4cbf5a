//! What is asked of the job that takes pictures, and how far a film has come.
//!
//! In: orders of a person. Out: the state that the bar over the picture shows. Who takes the
//! pictures is the window's screenshot job.

use crate::view::Pace;
use bevy::math::UVec2;
use bevy::prelude::Resource;
use serde::{Deserialize, Serialize};
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PictureOf {
    /// The window with its panels.
    #[default]
    Window,
    /// The picture without panels, with scale bar, clock, legend and what is measured.
    Picture,
    /// The grains alone, without panels, clock and marks.
    Grains,
    /// The same without a background.
    CutOut,
}

impl PictureOf {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Window, Self::Picture, Self::Grains, Self::CutOut];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::Window => "Whole window, with its panels",
            Self::Picture => "Grains with scale bar, clock and marks",
            Self::Grains => "Grains alone",
            Self::CutOut => "Grains alone, without a background",
        }
    }
}

/// One picture that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOrder {
    /// The PNG file.
    pub path: PathBuf,
    /// What it shows.
    pub of: PictureOf,
    /// Width and height [pixels]; as the window's where none are given.
    pub size: Option<UVec2>,
}

/// A film that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmOrder {
    /// The GIF or video, or the folder of pictures.
    pub path: PathBuf,
    /// What it shows.
    pub of: PictureOf,
    /// Width and height [pixels]; as the window's where none are given.
    pub size: Option<UVec2>,
    /// Frames a second, simulated time from frame to frame.
    pub pace: Pace,
    /// Which part of the run it shows.
    pub span: FilmSpan,
}

/// Which part of a run a film shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilmSpan {
    /// From the moment shown until somebody stops it.
    FromNow,
    /// What is recorded between these simulated times [s], both included.
    Recorded {
        /// Of the first picture.
        from: f64,
        /// Of the last one.
        to: f64,
    },
}

/// What a person can ask for.
#[derive(Clone, Debug, PartialEq)]
pub enum ScreenshotOrder {
    /// One picture as it is now.
    Picture(PictureOrder),
    /// A film.
    Film(FilmOrder),
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
    /// Its pictures are taken of a run that goes on.
    Recording {
        /// Number of pictures so far.
        pictures: usize,
        /// Simulated time that they span [s].
        time: f64,
    },
    /// Its pictures are taken of what is recorded.
    Replaying {
        /// Number of pictures so far.
        pictures: usize,
        /// Number of all that there will be.
        all: usize,
    },
    /// Its last pictures are being written; so many are left.
    Writing(usize),
}
