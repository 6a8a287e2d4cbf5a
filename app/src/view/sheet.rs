//! The picture while something is drawn over it: lines and labels in space, and what of them can be
//! pointed at.
//!
//! In: points of the world, the camera. Out: egui shapes over the picture, and which of the marks a
//! point of it lies on.

use crate::view::camera::OrbitCamera;
use crate::view::ink::Ink;
use bevy::math::Vec3;
use bevy_egui::egui::{Align2, Color32, FontId, Pos2, Rect, Shape as Drawn, Stroke, Vec2, vec2};
use grainfall::measure::Measure;

/// How near to a mark the pointer lies on it, in points.
const NEAR: f32 = 9.0;
/// Widths of lines, in points: usually, and while their curve is under the pointer.
pub(super) const WIDTHS: [f32; 2] = [2.2, 4.5];
/// Length of an arrow's head, in points.
const HEAD: f32 = 9.0;
/// Between two labels, in points.
const BETWEEN_LABELS: f32 = 2.0;
/// Length of dashes and of the gaps between them, in points.
const DASHES: [f32; 2] = [6.0, 5.0];

/// What a mark in the picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MarkKind {
    /// Something that has a curve.
    Measure(Measure),
    /// The flowing layer.
    Layer,
    /// The mark on a drum.
    DrumMark,
}

impl MarkKind {
    /// What is told of it to somebody who points at it.
    pub(super) fn in_words(self) -> String {
        let lines = match self {
            Self::Measure(measure) => {
                let quantity = measure.quantity();
                let (label, equation) = (quantity.label(), quantity.equation.into());
                [label, quantity.explanation(), equation]
            }
            Self::Layer => [
                "Flowing layer".to_owned(),
                "The mean velocity along the surface over the depth below its middle, and the depth \
                 at which it changes its sign: grains above go down the slope, those below up with \
                 the drum. Averaged over the samples in which the bed flows, as in the panel Flow over \
                 depth."
                    .to_owned(),
                String::new(),
            ],
            Self::DrumMark => [
                "Mark on the drum".to_owned(),
                "A line painted on plates, rim and hoops, which turns with the drum: by it one sees \
                 how fast the drum turns, and in which direction."
                    .to_owned(),
                String::new(),
            ],
        };
        let lines = lines.into_iter().filter(|line| !line.is_empty());
        lines.collect::<Vec<String>>().join("\n")
    }
}

/// A mark in the picture: what it shows, and where it is.
pub(super) struct Mark {
    kind: MarkKind,
    points: Vec<Pos2>,
}

impl Mark {
    pub(super) fn new(kind: MarkKind, points: Vec<Pos2>) -> Self {
        Self { kind, points }
    }
}

/// What the mark at `pointer` shows, where there is one.
pub(super) fn under(marks: &[Mark], pointer: Pos2) -> Option<MarkKind> {
    let distance = |mark: &Mark| {
        let pieces = mark.points.windows(2);
        let away = pieces.map(|ends| distance_to_piece(pointer, [ends[0], ends[1]]));
        away.fold(f32::INFINITY, f32::min)
    };
    let near = marks.iter().map(|mark| (mark.kind, distance(mark)));
    let near = near.filter(|(_, distance)| *distance < NEAR);
    near.min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(kind, _)| kind)
}

fn distance_to_piece(point: Pos2, [from, to]: [Pos2; 2]) -> f32 {
    let (way, away) = (to - from, point - from);
    let share = (away.dot(way) / way.length_sq().max(1e-9)).clamp(0.0, 1.0);
    (away - share * way).length()
}

/// The picture while it is drawn on.
pub(super) struct Sheet<'a> {
    pub(super) ink: &'a Ink<'a>,
    pub(super) rect: Rect,
    pub(super) camera: &'a OrbitCamera,
    /// The measure whose mark stands out.
    pub(super) lit: Option<Measure>,
    /// What can be pointed at.
    pub(super) marks: Vec<Mark>,
    /// Where labels stand already.
    pub(super) labels: Vec<Rect>,
}

impl Sheet<'_> {
    /// Where the point `x` [m] is in the window.
    pub(super) fn place(&self, x: Vec3) -> Option<Pos2> {
        let (place, _) = self.camera.project(x)?;
        Some(self.rect.min + vec2(place.x, place.y))
    }

    pub(super) fn places(&self, points: &[Vec3]) -> Vec<Pos2> {
        points.iter().filter_map(|x| self.place(*x)).collect()
    }

    pub(super) fn width(&self, measure: Measure) -> f32 {
        WIDTHS[usize::from(self.lit == Some(measure))]
    }

    /// A line that shows `measure`.
    pub(super) fn line(&mut self, measure: Measure, points: &[Vec3], width: f32) {
        let points = self.places(points);
        (self.ink).bold_line(points.clone(), width, self.ink.measured);
        let kind = MarkKind::Measure(measure);
        self.marks.push(Mark::new(kind, points));
    }

    pub(super) fn dashed(&self, points: &[Vec3], width: f32, colour: Color32) {
        let stroke = Stroke::new(width, colour);
        let points = self.places(points);
        let dashes = Drawn::dashed_line(&points, stroke, DASHES[0], DASHES[1]);
        self.ink.painter.extend(dashes);
    }

    /// An arrow from the first of `ends` to the second.
    pub(super) fn arrow(&self, ends: &[Vec3; 2], width: f32, colour: Color32) {
        let [Some(from), Some(to)] = ends.map(|end| self.place(end)) else {
            return;
        };
        let way = to - from;
        self.ink.bold_line(vec![from, to], width, colour);
        if way.length() > HEAD {
            let back = to - HEAD * way.normalized();
            let aside = 0.5 * HEAD * way.normalized().rot90();
            let head = vec![to, back + aside, back - aside];
            (self.ink.painter).add(Drawn::convex_polygon(head, colour, Stroke::NONE));
        }
    }

    /// Text at the `anchor` of the point `at`, raised by `lift` points; where other labels stand
    /// there, above or below them.
    pub(super) fn label(
        &mut self,
        at: Vec3,
        (anchor, lift): (Align2, f32),
        text: &str,
        colour: Color32,
    ) {
        let Some(place) = self.place(at) else { return };
        let (font, place) = (FontId::proportional(16.0), place - vec2(0.0, lift));
        let ground = self.ink.ground_of(place, anchor, text, font.clone());
        let line = vec2(0.0, ground.height() + BETWEEN_LABELS);
        let shifts = [0.0, -1.0, 1.0, -2.0, 2.0].map(|lines| lines * line);
        let is_free = |shift: &Vec2| {
            let wanted = ground.translate(*shift);
            !self.labels.iter().any(|other| other.intersects(wanted))
        };
        let shift = shifts.into_iter().find(is_free).unwrap_or(Vec2::ZERO);
        let ground = (self.ink).grounded(place + shift, anchor, text, font, colour, self.ink.veil);
        self.labels.push(ground);
    }
}
