//! A text that is too long for its place: its beginning and its end, in which names differ.
//!
//! In: the text, the room in a panel. Out: what fits.

use bevy_egui::egui::{self, Color32, TextStyle};

/// Width of `text` as it is written in `ui` [points].
pub fn width(ui: &egui::Ui, text: &str) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    let words = (ui.painter()).layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    words.size().x
}

/// `text` where `ui` has room for it, else as much of its beginning and of its end as there is room
/// for.
pub fn elided(ui: &egui::Ui, text: &str) -> String {
    let room = ui.available_width();
    if width(ui, text) <= room {
        return text.to_owned();
    }
    let letters: Vec<char> = text.chars().collect();
    let with = |kept: usize| -> String {
        let (head, tail) = (kept.div_ceil(2), kept / 2);
        let end = &letters[letters.len() - tail..];
        letters[..head].iter().chain(&['…']).chain(end).collect()
    };
    // It is wider the more letters it keeps.
    let fits = |kept: &usize| width(ui, &with(*kept)) <= room;
    let most = (1..letters.len()).take_while(fits).last();
    with(most.unwrap_or(0))
}
