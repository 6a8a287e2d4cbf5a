//! What is drawn into the picture with: a painter and the colours of the background.
//!
//! In: egui's painter, the background. Out: text and lines that stand out from any grain.

use crate::view::colour::Scheme;
use crate::view::view_settings::Background;
use bevy::color::{Color, ColorToPacked};
use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, vec2,
};

/// Behind what must stand out from any grain.
const SHADE: Color32 = Color32::from_black_alpha(190);

/// A painter with its colours.
pub(super) struct Ink<'a> {
    pub(super) painter: &'a Painter,
    pub(super) text: Color32,
    pub(super) faint: Color32,
    pub(super) veil: Color32,
    /// What is measured, in the colour of its curve.
    pub(super) measured: Color32,
    /// The mark on the container.
    pub(super) mark: Color32,
}

impl<'a> Ink<'a> {
    pub(super) fn new(painter: &'a Painter, background: Background) -> Self {
        let scheme = Scheme::of(background);
        Self {
            painter,
            text: rgb(scheme.text),
            faint: rgb(scheme.faint_text),
            veil: rgb(srgb(scheme.background)).gamma_multiply(0.75),
            measured: rgb(scheme.measured),
            mark: rgb(srgb(scheme.mark)),
        }
    }

    pub(super) fn write(
        &self,
        at: Pos2,
        anchor: Align2,
        text: impl ToString,
        size: f32,
        colour: Color32,
    ) {
        self.painter
            .text(at, anchor, text, FontId::proportional(size), colour);
    }

    /// Light text over its `at` that stands out from any grain: on a dark ground.
    pub(super) fn outlined(&self, at: Pos2, text: &str, colour: Color32) {
        let font = FontId::proportional(13.0);
        self.grounded(at, Align2::CENTER_BOTTOM, text, font, colour, SHADE);
    }

    /// Where text at the `anchor` of `at` has its ground.
    pub(super) fn ground_of(&self, at: Pos2, anchor: Align2, text: &str, font: FontId) -> Rect {
        let text = (self.painter).layout_no_wrap(text.to_owned(), font, self.text);
        ground_behind(anchor.anchor_size(at, text.size()))
    }

    /// Text at the `anchor` of `at` on a ground of this colour; returns where it stands.
    pub(super) fn grounded(
        &self,
        at: Pos2,
        anchor: Align2,
        text: &str,
        font: FontId,
        colour: Color32,
        ground: Color32,
    ) -> Rect {
        let text = (self.painter).layout_no_wrap(text.to_owned(), font, colour);
        let place = anchor.anchor_size(at, text.size());
        let covered = ground_behind(place);
        self.painter
            .rect_filled(covered, CornerRadius::same(4), ground);
        self.painter.galley(place.min, text, colour);
        covered
    }

    /// A line through `points` that stands out from any grain: on the veil.
    pub(super) fn bold_line(&self, points: Vec<Pos2>, width: f32, colour: Color32) {
        let ground = Stroke::new(width + 2.5, self.veil);
        self.painter.add(Shape::line(points.clone(), ground));
        self.painter
            .add(Shape::line(points, Stroke::new(width, colour)));
    }
}

/// The ground of a text that stands at `place`.
fn ground_behind(place: Rect) -> Rect {
    place.expand2(vec2(4.0, 0.0))
}

pub(super) fn srgb(colour: Color) -> [u8; 3] {
    let [r, g, b, _] = colour.to_srgba().to_u8_array();
    [r, g, b]
}

pub(super) fn rgb([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}
