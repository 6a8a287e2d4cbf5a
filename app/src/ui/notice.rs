//! What is told for a few seconds, and tooltips that have outlived what they tell of.
//!
//! In: a text, egui's layers. Out: an area over the picture; tooltips left out of a frame. Neither
//! reacts to the pointer.

use bevy_egui::egui::{self, Align2, Id, LayerId, Order};
use std::time::{Duration, Instant};

/// How long a notice stays.
const NOTICE_TIME: Duration = Duration::from_secs(6);

/// A text that is told for a few seconds.
#[derive(Default)]
pub struct Notice(Option<(String, Instant)>);

impl Notice {
    /// Says `text` from now on.
    pub fn say(&mut self, text: String) {
        self.0 = Some((text, Instant::now()));
    }

    /// What is told now, if anything.
    pub fn text(&self) -> Option<&str> {
        self.0.as_ref().map(|(text, _)| text.as_str())
    }

    /// Draws it, or what is told `otherwise`.
    pub fn ui(&mut self, ctx: &egui::Context, otherwise: Option<&str>) {
        self.0 = (self.0.take()).filter(|(_, since)| since.elapsed() < NOTICE_TIME);
        let Some(text) = self.text().or(otherwise) else {
            return;
        };
        // Each text is laid out by itself, however long the last one was.
        egui::Area::new(Id::new("notice").with(text))
            .anchor(Align2::CENTER_TOP, [0.0, 44.0])
            .interactable(false)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style())
                    .inner_margin(10)
                    .show(ui, |ui| {
                        ui.set_max_width(0.6 * ui.ctx().content_rect().width());
                        ui.label(text);
                    });
            });
        ctx.request_repaint_after(NOTICE_TIME);
    }
}

/// Tooltips that there were when a dialog came over the panels, while it is there.
#[derive(Default)]
pub struct StaleTooltips(Option<Vec<LayerId>>);

impl StaleTooltips {
    /// Leaves out of this frame what tells of a place under the pointer that a dialog lies over now,
    /// and in a picture every such thing: egui lets it stand until the pointer leaves that place.
    pub fn hide(&mut self, ctx: &egui::Context, has_dialog: bool, is_photographed: bool) {
        let is_tooltip = |layer: &LayerId| layer.order == Order::Tooltip;
        let layers: Vec<_> = ctx.memory(|memory| memory.layer_ids().filter(is_tooltip).collect());
        self.0 = match (has_dialog, self.0.take()) {
            (false, _) => None,
            (true, known) => Some(known.unwrap_or_else(|| layers.clone())),
        };
        let stale = self.0.clone().unwrap_or_default();
        let hidden = if is_photographed { layers } else { stale };
        ctx.graphics_mut(|graphics| {
            for layer in hidden {
                *graphics.entry(layer) = egui::layers::PaintList::default();
            }
        });
    }
}
