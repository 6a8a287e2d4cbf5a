//! The frame of every dialog: a window over everything else, in the middle.
//!
//! In: a name, a width, what stands in it. Out: whether somebody leaves it.

use bevy_egui::egui::{self, Id, Modal};

/// Share of the window's width that a dialog takes at most.
const WIDEST: f32 = 0.9;

/// Draws `content` in a dialog of this `width` [points] that blocks everything else until it is
/// closed; what `content` says, and whether somebody leaves the dialog: by Esc, or by a click
/// beside it.
pub fn dialog_ui<R>(
    ctx: &egui::Context,
    name: &str,
    width: f32,
    content: impl FnOnce(&mut egui::Ui) -> R,
) -> (R, bool) {
    let frame = egui::Frame::window(&ctx.style_of(ctx.theme()));
    let dialog = Modal::new(Id::new(name)).frame(frame).show(ctx, |ui| {
        ui.set_width(width.min(WIDEST * ui.ctx().content_rect().width()));
        content(ui)
    });
    let is_left = dialog.should_close();
    (dialog.inner, is_left)
}
