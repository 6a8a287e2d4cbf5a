//! Sheets over the window: the shortcuts, what the program is, a scene that could not be opened.

use super::Sheet;
use super::shortcuts::{MOUSE, SHORTCUTS};
use super::theme::Palette;
use bevy_egui::egui::{self, Id, Modal, RichText, ScrollArea};

/// Draws `sheet`; false once it is closed.
pub fn sheet_ui(ctx: &egui::Context, sheet: Sheet) -> bool {
    match sheet {
        Sheet::Shortcuts => modal_ui(ctx, "Shortcuts", 500.0, shortcuts_ui),
        Sheet::About => modal_ui(ctx, "Grainfall", 460.0, about_ui),
    }
}

/// Draws the reason why a scene could not be opened; false once it is closed.
pub fn scene_error_ui(ctx: &egui::Context, reason: &str) -> bool {
    modal_ui(ctx, "This scene cannot be opened", 720.0, |ui| {
        let palette = Palette::of(ui.visuals());
        egui::Frame::new()
            .fill(palette.error_fill)
            .corner_radius(6)
            .inner_margin(10)
            .show(ui, |ui| {
                let height = 0.5 * ui.ctx().content_rect().height();
                ScrollArea::both().max_height(height).show(ui, |ui| {
                    let text = RichText::new(reason).monospace();
                    ui.add(egui::Label::new(text).selectable(true).extend());
                });
            });
        ui.label("What was open goes on. Correct the file and open it again.");
    })
}

/// A window that must be closed before anything else; false once it is.
fn modal_ui(
    ctx: &egui::Context,
    title: &str,
    width: f32,
    content: impl FnOnce(&mut egui::Ui),
) -> bool {
    let frame = egui::Frame::window(&ctx.style_of(ctx.theme()));
    let modal = Modal::new(Id::new(title)).frame(frame).show(ctx, |ui| {
        ui.set_width(width.min(0.9 * ui.ctx().content_rect().width()));
        ui.heading(title);
        ui.add_space(4.0);
        content(ui);
        ui.add_space(4.0);
        ui.button("Close").clicked()
    });
    !(modal.inner || modal.should_close())
}

fn shortcuts_ui(ui: &mut egui::Ui) {
    egui::Grid::new("shortcuts")
        .num_columns(2)
        .spacing([24.0, 5.0])
        .show(ui, |ui| {
            for shortcut in SHORTCUTS {
                ui.monospace(shortcut.keys(ui.ctx()));
                ui.label(shortcut.name);
                ui.end_row();
            }
            for (gesture, name) in MOUSE {
                ui.monospace(gesture);
                ui.label(name);
                ui.end_row();
            }
        });
}

fn about_ui(ui: &mut egui::Ui) {
    ui.label(format!("Version {}", env!("CARGO_PKG_VERSION")));
    ui.label(
        "A laboratory for granular matter: every grain is computed, with the contact laws of the papers that the scenes \
         come from. What is drawn is what is computed; the same scene, seed and commands give the same numbers, with and \
         without a window.",
    );
    ui.label("Kasper, Magnanimo, de Jong, Beek, Jarray: Effect of viscosity on the avalanche dynamics and flow transition of wet granular matter, Particuology (2021).");
    ui.weak("MIT or Apache-2.0");
}
