//! The laws of Man et al. 2023 as lines in the plots of columns, and slopes to compare with.
//!
//! In: nothing, or the lines of the results. Out: lines. The laws themselves stand with what is
//! measured of columns.

use super::chart::Line;
use crate::measure::{
    CRITICAL_ASPECT_RATIO, PEAK_TIME_LAW, REST_TIME_LAW, TALL_ASPECT_RATIO, TALL_REST_TIME_LAW,
    cone_volume_law, run_out_law,
};

/// Part of the axis of effective aspect ratios in which the laws are drawn.
const LAWS_FROM: f64 = 0.4;
const LAWS_TO: f64 = 25.0;

/// The run-out over the effective aspect ratio.
pub fn run_out_line() -> Line {
    let name = "α_eff^1.35, α_eff^0.5 above 3.5";
    Line::law(name, LAWS_FROM, LAWS_TO, run_out_law)
}

/// The cone's share of the volume over the effective aspect ratio.
pub fn cone_volume_line() -> Line {
    let name = "1.2 α_eff^0.9, 7.5 α_eff^−0.6 above 3.5 (Eq. 4.4)";
    Line::law(name, LAWS_FROM, LAWS_TO, cone_volume_law)
}

/// The time of the largest kinetic energy over the effective aspect ratio.
pub fn peak_time_line() -> Line {
    root("0.92 √α_eff", PEAK_TIME_LAW, LAWS_FROM, LAWS_TO)
}

/// The time of rest over the effective aspect ratio: of low columns, of tall ones.
pub fn rest_time_lines() -> Vec<Line> {
    let (low, tall) = (CRITICAL_ASPECT_RATIO, TALL_ASPECT_RATIO);
    vec![
        root("4.5 √α_eff below 3.5", REST_TIME_LAW, LAWS_FROM, low),
        root("3.0 √α_eff above 13", TALL_REST_TIME_LAW, tall, LAWS_TO),
    ]
}

fn root(name: &str, factor: f64, from: f64, to: f64) -> Line {
    Line::law(name, from, to, move |x| factor * f64::sqrt(x))
}

/// ℛ ∝ α and ∝ α^0.5 (Fig. 8).
pub fn run_out_slopes(lines: &[Line]) -> Vec<Line> {
    slopes(lines, [("∝ α", 1.0), ("∝ α^0.5", 0.5)])
}

/// `H_∞ ∝ α` and `∝ α^−0.25` (Fig. 12).
pub fn height_slopes(lines: &[Line]) -> Vec<Line> {
    slopes(lines, [("∝ α", 1.0), ("∝ α^−0.25", -0.25)])
}

/// A power law through the lowest column's point and one through the highest one's, each over a
/// third of the range between.
fn slopes(lines: &[Line], [low, high]: [(&str, f64); 2]) -> Vec<Line> {
    let points = || lines.iter().flat_map(|line| &line.points);
    let first = points().min_by(|a, b| a.0.total_cmp(&b.0));
    let last = points().max_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(&first), Some(&last)) = (first, last) else {
        return Vec::new();
    };
    if last.0 <= first.0 {
        return Vec::new();
    }
    let third = (last.0 / first.0).cbrt();
    let through = |(name, exponent): (&str, f64), point: (f64, f64), from: f64, to: f64| {
        Line::law(name, from, to, move |x| {
            point.1 * (x / point.0).powf(exponent)
        })
    };
    vec![
        through(low, first, first.0, first.0 * third),
        through(high, last, last.0 / third, last.0),
    ]
}
