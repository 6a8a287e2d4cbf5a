//! The bar over the picture while a film is recorded or written.
//!
//! In: what becomes of the film, and whether the run goes on. Out: requests to end the film or to give it up.

use crate::ui::request::Request;
use crate::ui::screenshot_orders::{FilmState, ScreenshotOrder};
use crate::ui::theme::Palette;
use crate::ui::words::number;
use bevy_egui::egui::{self, RichText};

/// Draws the bar over the picture, which `root` keeps free, while a film is recorded or written; it
/// says where nothing is recorded because the run `stands_still`.
pub fn film_bar_ui(
    root: &mut egui::Ui,
    film: FilmState,
    stands_still: bool,
    out: &mut Vec<Request>,
) {
    let still = if stands_still {
        ". The run stands still: press Play (Space)"
    } else {
        ""
    };
    let text = match film {
        FilmState::Idle => return,
        FilmState::Recording { pictures, time } => {
            format!(
                "Recording: {}, {pictures} pictures{still}",
                number::moment(time)
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
            let recording = matches!(film, FilmState::Recording { .. });
            if recording && ui.button("Stop and save").clicked() {
                out.push(Request::Screenshot(ScreenshotOrder::EndFilm));
            }
            if ui.button("Cancel the film").clicked() {
                out.push(Request::Screenshot(ScreenshotOrder::CancelFilm));
            }
        });
    });
}
