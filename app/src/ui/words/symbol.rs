//! Names with the paper's symbols, whose indices stand low: `μ_R`.
//!
//! In: text in which an underscore begins an index. Out: a layout for egui.

use bevy_egui::egui::text::{LayoutJob, TextFormat};
use bevy_egui::egui::{Align, Color32, FontId, TextStyle, Ui};

/// `name` followed by `symbol` in a weaker colour. What follows an underscore, up to the next
/// character that is neither letter nor digit, stands low.
pub fn named(ui: &Ui, name: &str, symbol: &str) -> LayoutJob {
    let mut job = LayoutJob::default();
    append(&mut job, ui, name, ui.visuals().text_color());
    append(&mut job, ui, "  ", ui.visuals().text_color());
    append(&mut job, ui, symbol, ui.visuals().weak_text_color());
    job
}

/// `text` with its indices low.
pub fn text(ui: &Ui, text: &str) -> LayoutJob {
    let mut job = LayoutJob::default();
    append(&mut job, ui, text, ui.visuals().text_color());
    job
}

fn append(job: &mut LayoutJob, ui: &Ui, text: &str, colour: Color32) {
    let font = TextStyle::Body.resolve(ui.style());
    let low = FontId::new(0.75 * font.size, font.family.clone());
    for (index, part) in text.split('_').enumerate() {
        let end = match index {
            0 => 0,
            _ => part
                .find(|c: char| !c.is_alphanumeric())
                .unwrap_or(part.len()),
        };
        let (lowered, rest) = part.split_at(end);
        for (piece, font, valign) in [(lowered, &low, Align::BOTTOM), (rest, &font, Align::Center)]
        {
            let format = TextFormat {
                valign,
                ..TextFormat::simple(font.clone(), colour)
            };
            if !piece.is_empty() {
                job.append(piece, 0.0, format);
            }
        }
    }
}
