//! Axes of plots: round marks, the text at them, the height that shows a curve.
//!
//! In: ranges of numbers. Out: grid marks and labels for the plots.

use crate::ui::theme::Palette;
use crate::ui::words::number;
use bevy_egui::egui;
use egui_plot::{GridInput, GridMark, Plot};
use std::ops::RangeInclusive;

/// Room below a curve, as a share of its height.
const BELOW: f64 = 0.08;
/// Room above a curve, where labels stand, as a share of its height.
const ABOVE: f64 = 0.2;
/// Upright grid lines stand this many times further apart than the plot would have them at the
/// closest, 8 points.
pub const SPARSE_X: f32 = 5.5;
/// The same of level grid lines.
pub const SPARSE_Y: f32 = 3.5;
/// Smallest height of a plot, in its unit: marks must differ.
const LEAST_SPAN: f64 = 1e-30;

/// The largest whole number of steps that a float holds with those around it: 2⁵³.
const MOST_EXACT: f64 = 9_007_199_254_740_992.0;
/// More marks than an axis of any screen has.
const MOST_MARKS: f64 = 10_000.0;

/// Share of a number below which two are the same but for rounding.
const ROUNDING: f64 = 1e-9;
/// Height of the plot of a constant, as a share of it.
const SPAN_OF_CONSTANT: f64 = 0.2;

/// The range that shows all `points` with a little room, at least `smallest` high.
pub fn height_of<'a>(
    points: impl Iterator<Item = &'a [f64; 2]>,
    smallest: f64,
) -> RangeInclusive<f64> {
    let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
        (low.min(point[1]), high.max(point[1]))
    });
    if low > high {
        return 0.0..=smallest.max(1.0);
    }
    if low == 0.0 && high == 0.0 {
        // What has not begun yet: zero lies below, whatever may come.
        let span = smallest.max(1.0);
        return -BELOW * span..=span;
    }
    let middle = 0.5 * (low + high);
    let apart = if high - low > ROUNDING * middle.abs() {
        high - low
    } else {
        // A constant: its number stands at a mark, and zero is out of sight.
        SPAN_OF_CONSTANT * middle.abs()
    };
    let span = apart.max(smallest).max(LEAST_SPAN);
    middle - (0.5 + BELOW) * span..=middle + (0.5 + ABOVE) * span
}

/// A plot that fits its curves, a quarter of the window high, with a few round marks.
pub fn fitting_plot<'a>(ui: &egui::Ui, id: &str) -> Plot<'a> {
    Plot::new(id)
        .height((0.25 * ui.ctx().content_rect().height()).clamp(130.0, 330.0))
        .show_crosshair(false)
        .allow_scroll(false)
        .grid_color(Palette::of(ui.visuals()).grid)
        .x_grid_spacer(|input| round_marks(input, 10.0, 0.0))
        .y_grid_spacer(|input| round_marks(input, SPARSE_Y, 0.0))
        .x_axis_formatter(|mark, _| tick(mark.value, false))
        .y_axis_formatter(|mark, _| tick(mark.value, false))
}

/// Grid lines at round numbers at least `finest` apart, `sparse` times as far apart as the plot
/// would have them at the closest. None where no number of digits tells the marks apart.
pub fn round_marks(input: GridInput, sparse: f32, finest: f64) -> Vec<GridMark> {
    let step = round_step((input.base_step_size * f64::from(sparse)).max(finest));
    let (first, last) = (
        (input.bounds.0 / step).ceil(),
        (input.bounds.1 / step).floor(),
    );
    let exact = -MOST_EXACT..=MOST_EXACT;
    if !exact.contains(&first) || !exact.contains(&last) || last - first > MOST_MARKS {
        return Vec::new();
    }
    (first as i64..=last as i64)
        .map(|index| GridMark {
            value: index as f64 * step,
            step_size: step,
        })
        .collect()
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `least`.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let fits = |factor: &f64| factor * power >= least * (1.0 - 1e-9);
    [1.0, 2.0, 5.0, 10.0].into_iter().find(fits).unwrap_or(10.0) * power
}

/// The text at a mark of an axis, whose `value` is a power of ten where its numbers are `decades`.
pub fn tick(value: f64, decades: bool) -> String {
    if decades {
        number::power_of_ten(value.round() as i32)
    } else if value != 0.0 && value.abs() < 1e-3 {
        number::short(value)
    } else {
        tidy(value)
    }
}

/// `value` rounded to a millionth, without trailing zeros.
pub fn tidy(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", rounded + 0.0).replacen('-', "−", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_is_seen_where_it_is() {
        let energy = 5.655e-6;
        let height = height_of([[0.0, energy], [1.0, energy * (1.0 + 1e-12)]].iter(), 0.0);
        assert!(height.contains(&energy) && !height.contains(&0.0));
        assert!(height.end() - height.start() < 0.5 * energy, "{height:?}");
    }

    #[test]
    fn a_curve_of_zeros_has_a_few_marks() {
        // Grains that have not moved yet: no energy at all.
        let height = height_of([[0.0, 0.0], [1.0, 0.0]].iter(), 0.0);
        let bounds = (*height.start(), *height.end());
        let input = GridInput {
            bounds,
            base_step_size: (bounds.1 - bounds.0) / 50.0,
        };
        let marks = round_marks(input, 1.0, 0.0);
        assert!((10..=60).contains(&marks.len()), "{}", marks.len());
        assert!(marks.iter().any(|mark| mark.value == 0.0));
        // Zero lies at the foot: nothing suggests an energy below it.
        assert!(-0.2 * bounds.1 < bounds.0 && bounds.0 < 0.0, "{bounds:?}");
    }

    #[test]
    fn ranges_that_numbers_cannot_divide_have_no_marks() {
        let no_marks = |bounds: (f64, f64), base_step_size: f64| {
            let input = GridInput {
                bounds,
                base_step_size,
            };
            round_marks(input, 10.0, 0.0).is_empty()
        };
        assert!(no_marks((-2e-310, 2e-310), 5e-324));
        assert!(no_marks((0.0, 1.0), 0.0));
        assert!(no_marks((0.0, 1.0), f64::NAN));
        assert!(no_marks((3.0, 3.0 + 1e-15), 1e-17));
        assert!(no_marks((f64::NEG_INFINITY, f64::INFINITY), f64::INFINITY));
        assert!(no_marks((f64::NAN, 1.0), 0.1));
        assert!(!no_marks((3.0, 4.0), 0.01));
    }
}
