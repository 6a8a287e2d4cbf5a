//! The bar over the picture while a film is recorded or written.
//!
//! In: what becomes of the film, and whether the run goes on. Out: requests to end the film or to give it up.

use crate::ui::request::Request;
use crate::ui::screenshot_orders::{FilmState, ScreenshotOrder};
use crate::ui::shortcuts::keys_for;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};

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
        FilmState::Replaying { pictures, all } => {
            format!("Filming what is recorded: {pictures} of {all} pictures")
        }
        FilmState::Writing(left) => format!("Writing the film: {left} pictures left"),
    };
    egui::Panel::top("recording").show(root, |ui| {
        ui.horizontal_wrapped(|ui| {
            let red = Palette::of(ui.visuals()).error;
            ui.label(RichText::new("●").color(red));
            ui.label(text);
            if let FilmState::Replaying { pictures, all } = film {
                progress_ui(ui, pictures as f32 / all as f32);
            }
            let ends = matches!(
                film,
                FilmState::Recording { .. } | FilmState::Replaying { .. }
            );
            if ends {
                let stop = ui
                    .button("Stop and save")
                    .on_hover_text(keys_for(ui.ctx(), &Request::ChooseFilm));
                if stop.clicked() {
                    out.push(Request::Screenshot(ScreenshotOrder::EndFilm));
                }
            }
            if ui.button("Cancel the film").clicked() {
                out.push(Request::Screenshot(ScreenshotOrder::CancelFilm));
            }
        });
    });
}

/// How much of a film with an end is done, 0 … 1.
fn progress_ui(ui: &mut egui::Ui, progress: f32) {
    let bar = egui::ProgressBar::new(progress).desired_width(160.0);
    let response = ui.add(bar.text(format!("{:.0} %", 100.0 * progress)));
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::ProgressIndicator, true, "Film");
        info.value = Some(f64::from(progress));
        info
    });
}
