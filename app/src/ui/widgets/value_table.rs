//! Two-column tables: a name on the left, a value on the right.
//!
//! In: rows of text. Out: the table over the whole width. Numbers become text elsewhere.

use crate::ui::words::symbol;
use bevy_egui::egui::{self, Color32, Frame, Margin, RichText, Sides};

/// A line of a table.
pub struct TableRow {
    /// What it is.
    pub name: String,
    /// Its value with its unit.
    pub value: String,
    /// More about it, shown when the pointer rests on it; may be empty.
    pub hint: String,
}

impl TableRow {
    /// The row of `name` with its `value`, and more about it in `hint`.
    pub fn of(name: &str, value: String, hint: &str) -> Self {
        Self {
            name: name.to_owned(),
            value,
            hint: hint.to_owned(),
        }
    }
}

/// Draws `rows` over the whole width, striped.
pub fn table_ui(ui: &mut egui::Ui, rows: impl Iterator<Item = TableRow>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    for (index, row) in rows.enumerate() {
        let stripe = ui.visuals().faint_bg_color;
        let fill = if index % 2 == 0 {
            stripe
        } else {
            Color32::TRANSPARENT
        };
        let line = Frame::new()
            .fill(fill)
            .corner_radius(3)
            .inner_margin(Margin::symmetric(5, 2));
        let response = line
            .show(ui, |ui| {
                Sides::new().shrink_left().truncate().show(
                    ui,
                    |ui| ui.label(symbol::text(ui, &row.name)),
                    |ui| ui.label(RichText::new(row.value).strong()),
                )
            })
            .response;
        if !row.hint.is_empty() {
            response.on_hover_text(row.hint);
        }
    }
    ui.spacing_mut().item_spacing.y = 6.0;
}
