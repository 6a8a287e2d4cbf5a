//! Recording a film: what a person asks for, how far it has come, the bar over the picture while it goes on.
//!
//! In: the recorder's state. Out: requests. Who takes the pictures is the window's recording.

use super::theme::Palette;
use super::{Request, number};
use bevy::prelude::Resource;
use bevy_egui::egui::{self, RichText};
use std::path::PathBuf;

/// A film that is being recorded, if one is.
#[derive(Resource, Default)]
pub struct Recorder {
    /// What was asked for and is still to be done.
    pub order: Option<FilmOrder>,
    /// What it does.
    pub state: FilmState,
}

/// What a person can ask of the recorder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilmOrder {
    /// Record into this file or folder from now on.
    Begin(PathBuf),
    /// That is all; write it.
    End,
    /// Forget it.
    Cancel,
}

/// What the recorder does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FilmState {
    /// Nothing.
    #[default]
    Idle,
    /// It takes pictures.
    Recording {
        /// So many so far.
        pictures: usize,
        /// Simulated time that they span [s].
        time: f64,
    },
    /// It writes the last pictures, so many of them.
    Writing(usize),
}

/// Draws the bar over the picture, which `root` keeps free, while a film is recorded or written.
pub fn recording_ui(root: &mut egui::Ui, recorder: &Recorder, out: &mut Vec<Request>) {
    let text = match recorder.state {
        FilmState::Idle => return,
        FilmState::Recording { pictures, time } => {
            format!(
                "Recording: {} s, {pictures} pictures",
                number::fixed(time, 2)
            )
        }
        FilmState::Writing(left) => format!("Writing the film: {left} pictures left"),
    };
    // A strip of its own: what lies over the picture would be in the film.
    egui::Panel::top("recording").show(root, |ui| {
        ui.horizontal_wrapped(|ui| {
            let red = Palette::of(ui.visuals()).error;
            ui.label(RichText::new("●").color(red));
            ui.label(text);
            let recording = matches!(recorder.state, FilmState::Recording { .. });
            if recording && ui.button("Stop and save").clicked() {
                out.push(Request::Film(FilmOrder::End));
            }
            if ui.button("Cancel the film").clicked() {
                out.push(Request::Film(FilmOrder::Cancel));
            }
        });
    });
}
