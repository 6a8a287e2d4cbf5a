//! Where the keyboard's focus is: the ring round it, and scrolling that keeps it in view.
//!
//! In: egui's memory of the last frame. Out: a ring, a wish to scroll.

use crate::ui::theme::Palette;
use bevy_egui::egui::{self, Id};

/// Scrolls the area of `ui` so that a control that has just taken the keyboard's focus is in view.
pub fn follow_focus(ui: &egui::Ui) {
    let focused = ui.memory(egui::Memory::focused);
    let gained = focused.and_then(|id| ui.ctx().read_response(id));
    let is_within = |control: &egui::Response| {
        let is_here = ui.min_rect().intersects(control.rect);
        control.gained_focus() && control.layer_id == ui.layer_id() && is_here
    };
    if let Some(control) = gained.filter(is_within) {
        ui.scroll_to_rect(control.rect.expand(4.0), None);
    }
}

/// A ring round the control that the keyboard works.
pub fn focus_ui(ctx: &egui::Context, palette: Palette) {
    let focused = ctx.memory(egui::Memory::focused);
    let Some(response) = focused.and_then(|id| ctx.read_response(id)) else {
        return;
    };
    let ring = response.rect.intersect(response.interact_rect).expand(2.0);
    if ring.is_positive() {
        let stroke = egui::Stroke::new(2.0, palette.warning);
        ctx.layer_painter(egui::LayerId::new(
            egui::Order::Foreground,
            Id::new("focus"),
        ))
        .rect_stroke(ring, 4.0, stroke, egui::StrokeKind::Outside);
    }
}
