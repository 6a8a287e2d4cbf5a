//! What a lesson asks to touch: a frame round it, and scrolling that brings it into view once.
//!
//! In: what is to be touched in this frame. Out: frames. Which control is what, its panel knows.

use crate::ui::theme::Palette;
use bevy_egui::egui::{self, Id};
use grainfall::lesson::Touch;

/// What is to be touched, and whether that is new.
#[derive(Clone, Default)]
struct Asked {
    list: Vec<Touch>,
    is_new: bool,
}

fn id() -> Id {
    Id::new("what a lesson asks to touch")
}

/// From now on `list` is to be touched.
pub fn ask(ctx: &egui::Context, list: &[Touch]) {
    ctx.data_mut(|data| {
        let known: &mut Asked = data.get_temp_mut_or_default(id());
        known.is_new = known.list != list;
        if known.is_new {
            known.list = list.to_vec();
        }
    });
}

/// Whether `touch` is to be touched.
pub fn is_asked(ctx: &egui::Context, touch: &Touch) -> bool {
    ctx.data(|data| data.get_temp::<Asked>(id()))
        .is_some_and(|asked| asked.list.iter().any(|own| own.is_same(touch)))
}

/// Marks the control at `place` where it is to be touched.
pub fn mark_ui(ui: &egui::Ui, touch: &Touch, place: egui::Rect) {
    if !is_asked(ui.ctx(), touch) {
        return;
    }
    let colour = Palette::of(ui.visuals()).angle;
    let stroke = egui::Stroke::new(2.0, colour);
    let (frame, outside) = (place.expand(2.0), egui::StrokeKind::Outside);
    ui.painter().rect_stroke(frame, 5.0, stroke, outside);
    let is_new = ui.data(|data| {
        data.get_temp::<Asked>(id())
            .is_some_and(|asked| asked.is_new)
    });
    if is_new && matches!(touch, Touch::Parameter(_)) {
        ui.scroll_to_rect(frame, None);
    }
}
