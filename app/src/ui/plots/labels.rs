//! Texts beside points of a plot: none is cut at the plot's edge, none lies over another.
//!
//! In: texts with their points, the most important first. Out: each in its place; one that finds
//! none is left out, as the pointer tells it too.

use bevy_egui::egui::text::{LayoutJob, TextWrapping};
use bevy_egui::egui::{self, Color32, Rect, TextStyle, Vec2, pos2, vec2};
use egui_plot::{PlotPoint, PlotTransform};

/// Longest text, in points; what is longer ends in an ellipsis.
const LONGEST: f32 = 150.0;
/// Between a text and the edge of the plot, or its point, in points.
const MARGIN: f32 = 2.0;
/// Between a text above a mark and the middle of that mark, in points.
const LIFT: f32 = 7.0;
/// Least distance from text to text across, in points.
const APART: f32 = 4.0;

/// A text beside a point of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLabel {
    /// What it says.
    pub text: String,
    /// The point, in the units of the plot.
    pub at: [f64; 2],
    /// Its colour.
    pub colour: Color32,
    /// Where it stands.
    pub side: LabelSide,
}

/// Where a text stands beside its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelSide {
    /// In the middle above a mark, and nowhere else.
    Above,
    /// At the end of a line, over its last part; where that place is taken, as near to it as there
    /// is one.
    End,
}

/// Paints the `labels` of the plot with this `transform`.
pub fn labels_ui(ui: &egui::Ui, transform: &PlotTransform, labels: &[PlotLabel]) {
    let frame = transform.frame().shrink(MARGIN);
    let font = TextStyle::Small.resolve(ui.style());
    let wrap = TextWrapping::truncate_at_width(LONGEST.min(frame.width()));
    let texts = labels.iter().map(|label| {
        let mut job = LayoutJob::single_section(
            label.text.clone(),
            egui::TextFormat::simple(font.clone(), label.colour),
        );
        job.wrap = wrap.clone();
        ui.painter().layout_job(job)
    });
    let texts: Vec<_> = texts.collect();
    let wanted = labels.iter().zip(&texts).map(|(label, text)| Wanted {
        point: transform.position_from_point(&PlotPoint::from(label.at)),
        size: text.size(),
        side: label.side,
    });
    let painter = ui.painter_at(*transform.frame());
    let places = places(frame, wanted);
    for ((label, text), place) in labels.iter().zip(texts).zip(places) {
        if let Some(place) = place {
            painter.galley(place.min, text, label.colour);
        }
    }
}

/// A text that is to stand beside a point of the screen.
struct Wanted {
    point: egui::Pos2,
    size: Vec2,
    side: LabelSide,
}

/// Where each of the `wanted` texts stands within `frame`, if anywhere.
fn places(frame: Rect, wanted: impl Iterator<Item = Wanted>) -> Vec<Option<Rect>> {
    let mut taken: Vec<Rect> = Vec::new();
    let mut place = |wanted: Wanted| {
        let is_free = |place: &Rect| {
            let around = place.expand2(vec2(APART, 0.0)).shrink2(vec2(0.0, 0.5));
            !taken.iter().any(|other| other.intersects(around))
        };
        let fits = |place: &Rect| frame.expand(0.01).contains_rect(*place) && is_free(place);
        let own = candidates(frame, &wanted).into_iter().find(fits);
        taken.extend(own);
        own
    };
    wanted.map(&mut place).collect()
}

/// The places that would do for a text, the best first.
fn candidates(frame: Rect, wanted: &Wanted) -> Vec<Rect> {
    let Wanted { point, size, side } = *wanted;
    let within = |corner: egui::Pos2| {
        let furthest = (frame.max - size).max(frame.min);
        Rect::from_min_size(corner.clamp(frame.min, furthest), size)
    };
    match side {
        LabelSide::Above if !frame.x_range().contains(point.x) => Vec::new(),
        LabelSide::Above => {
            let corner = point - vec2(0.5 * size.x, LIFT + size.y);
            vec![within(corner)]
        }
        LabelSide::End => {
            let first = within(point - vec2(size.x, size.y + MARGIN));
            let rows = (frame.height() / size.y.max(1.0)) as i32;
            let shifts = (0..=rows).flat_map(|row| [row, -row]);
            let shifted = shifts.map(|row| {
                let corner = pos2(first.left(), first.top() + row as f32 * size.y);
                Rect::from_min_size(corner, size)
            });
            shifted.collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect {
        min: pos2(50.0, 10.0),
        max: pos2(350.0, 110.0),
    };
    const SIZE: Vec2 = vec2(80.0, 12.0);

    fn at_ends(points: &[[f32; 2]]) -> Vec<Option<Rect>> {
        let wanted = points.iter().map(|[x, y]| Wanted {
            point: pos2(*x, *y),
            size: SIZE,
            side: LabelSide::End,
        });
        places(FRAME, wanted)
    }

    #[test]
    fn names_of_lines_that_end_together_stand_below_and_above_each_other() {
        let places = at_ends(&[[300.0, 60.0], [300.0, 61.0], [302.0, 58.0], [300.0, 20.0]]);
        let places: Vec<Rect> = places.into_iter().map(Option::unwrap).collect();
        assert_eq!(places[0].right_bottom(), pos2(300.0, 60.0 - MARGIN));
        assert_eq!(places[3].left(), places[0].left(), "its own place is free");
        for (index, place) in places.iter().enumerate() {
            assert!(FRAME.contains_rect(*place), "{place:?}");
            let near = (place.center().y - [60.0, 61.0, 58.0, 20.0][index]).abs();
            assert!(near < 3.0 * SIZE.y, "{place:?}");
            for other in &places[..index] {
                assert!(!other.shrink(0.5).intersects(*place), "{places:?}");
            }
        }
    }

    #[test]
    fn no_text_is_cut_at_an_edge_of_the_plot() {
        let corners = [[50.0, 10.0], [50.0, 110.0], [350.0, 10.0], [350.0, 110.0]];
        for place in at_ends(&corners) {
            assert!(FRAME.contains_rect(place.unwrap()), "{place:?}");
        }
        let beyond = [[-900.0, 60.0], [900.0, 900.0]];
        for place in at_ends(&beyond) {
            assert!(FRAME.contains_rect(place.unwrap()), "{place:?}");
        }
    }

    #[test]
    fn what_finds_no_place_is_left_out() {
        // Eight rows of 12 in 100.
        let places = at_ends(&[[200.0, 60.0]; 20]);
        let found = places.iter().flatten().count();
        assert!((7..=8).contains(&found), "{found}");
        let above = |x: f32| Wanted {
            point: pos2(x, 60.0),
            size: SIZE,
            side: LabelSide::Above,
        };
        let places = super::places(FRAME, [200.0, 230.0, 290.0].map(above).into_iter());
        let found: Vec<bool> = places.iter().map(Option::is_some).collect();
        assert_eq!(found, [true, false, true]);
        // Wider than the plot.
        let wide = Wanted {
            point: pos2(60.0, 60.0),
            size: vec2(400.0, 12.0),
            side: LabelSide::End,
        };
        assert_eq!(super::places(FRAME, [wide].into_iter()), [None]);
    }
}
