//! Marks on the timeline: what happened, of the kinds that are shown, and the part that is played
//! again and again.
//!
//! In: the line's place and the simulation. Out: changes above the line, all else below it. Of
//! marks of a kind that are closer together than can be told apart, one is drawn.

use crate::simulation::Simulation;
use crate::ui::event_kinds::EventKinds;
use crate::ui::repeat::Repeat;
use crate::ui::theme::Palette;
use bevy_egui::egui::{self, Align2, Color32, FontId, Rect, Stroke, pos2};
use grainfall::run::{EventKind, Happening};

/// Of marks of a kind that are closer together than this one is drawn, in points.
const BETWEEN_MARKS: f32 = 3.0;

/// Draws the marks of a run until `end` [s] on its `line`.
pub fn marks_ui(ui: &egui::Ui, line: Rect, simulation: &Simulation, end: f64, repeat: &Repeat) {
    let palette = Palette::of(ui.visuals());
    let inset = line.height() / 2.5;
    let span = line.x_range().shrink(inset);
    let place = |time: f64| egui::lerp(span, (time / end.max(f64::MIN_POSITIVE)).min(1.0) as f32);
    repeat_ui(ui, line, repeat, place);
    let kinds = EventKinds::of(ui.ctx());
    let mut drawn_until = [f32::NEG_INFINITY; EventKind::ALL.len()];
    for event in simulation.events() {
        let kind = event.kind();
        let x = place(event.time);
        let is_marked = !matches!(event.what, Happening::AvalancheEnds(_));
        if !kinds.show(kind) || !is_marked || x < drawn_until[kind as usize] {
            continue;
        }
        drawn_until[kind as usize] = x + BETWEEN_MARKS;
        if kind == EventKind::Change {
            let mark = Stroke::new(2.0, palette.change);
            ui.painter()
                .vline(x, line.top()..=line.center().y - 3.0, mark);
        } else {
            let centre = pos2(x, line.bottom() - 2.0);
            ui.painter()
                .circle_filled(centre, 2.0, colour(kind, palette));
        }
    }
}

/// The colour of the marks of a `kind`.
fn colour(kind: EventKind, palette: Palette) -> Color32 {
    match kind {
        EventKind::Impact => palette.temperature,
        EventKind::Parting => palette.threshold,
        EventKind::Bridge => palette.angle,
        EventKind::Avalanche => palette.maximum,
        EventKind::Front => palette.minimum,
        EventKind::Change => palette.change,
    }
}

/// The part that is played again and again, from A to B.
fn repeat_ui(ui: &egui::Ui, line: Rect, repeat: &Repeat, place: impl Fn(f64) -> f32) {
    let colour = ui.visuals().selection.bg_fill;
    let ends: Vec<f32> = repeat.ends().map(place).collect();
    if let &[from, to] = ends.as_slice() {
        let band = Rect::from_x_y_ranges(from..=to, line.y_range());
        ui.painter()
            .rect_filled(band, 2.0, colour.gamma_multiply(0.35));
    }
    for (x, name) in ends.into_iter().zip(["A", "B"]) {
        ui.painter()
            .vline(x, line.y_range(), Stroke::new(1.5, colour));
        let font = FontId::proportional(10.5);
        let (at, text) = (pos2(x, line.top() - 1.0), ui.visuals().strong_text_color());
        ui.painter()
            .text(at, Align2::CENTER_CENTER, name, font, text);
    }
}
