//! Fewer points for the same picture: of all samples that fall on one column of pixels only the
//! lowest and the highest are drawn, so that a long series costs no more than a short one and no
//! peak is lost.
//!
//! In: times and values of samples, the part in view, columns of pixels. Out: points of a line.

use std::ops::{Range, RangeInclusive};

/// Points of `value` over `time` (ascending) within `window`, about two for each of `columns` at
/// most, in order of time.
///
/// One sample before and one after the window are kept, so that a line reaches the edges; values
/// that are not finite are passed over.
pub fn decimate(
    time: &[f64],
    window: &RangeInclusive<f64>,
    columns: usize,
    value: impl Fn(usize) -> f64,
) -> Vec<[f64; 2]> {
    let range = around(time, window);
    let point = |index: usize| [time[index], value(index)];
    let finite = |point: &[f64; 2]| point[1].is_finite();
    if range.len() <= 2 * columns.max(1) {
        return range.map(point).filter(finite).collect();
    }
    // Bins at multiples of their own length: a window that slides over the series does not shimmer.
    let stride = range.len().div_ceil(columns.max(1));
    let mut points = Vec::with_capacity(2 * columns + 2);
    let mut first = range.start;
    while first < range.end {
        let end = ((first / stride + 1) * stride).min(range.end);
        points.extend(extremes((first..end).map(point).filter(finite)));
        first = end;
    }
    points
}

/// Indices of the samples within `window`, with one more on each side.
fn around(time: &[f64], window: &RangeInclusive<f64>) -> Range<usize> {
    let first = time.partition_point(|t| t < window.start());
    let end = time.partition_point(|t| t <= window.end());
    first.saturating_sub(1)..(end + 1).min(time.len())
}

/// The lowest and the highest of `points`, in order of time.
fn extremes(points: impl Iterator<Item = [f64; 2]>) -> impl Iterator<Item = [f64; 2]> {
    let both = points.fold(None, |both: Option<[[f64; 2]; 2]>, point| {
        let [low, high] = both.unwrap_or([point; 2]);
        let lower = if point[1] < low[1] { point } else { low };
        let higher = if point[1] > high[1] { point } else { high };
        Some([lower, higher])
    });
    both.into_iter()
        .flat_map(|[low, high]| {
            let (first, second) = if low[0] <= high[0] {
                (low, high)
            } else {
                (high, low)
            };
            [Some(first), (first != second).then_some(second)]
        })
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(count: usize) -> Vec<f64> {
        (0..count).map(|i| i as f64 * 0.02).collect()
    }

    #[test]
    fn a_single_peak_among_ten_thousand_samples_is_kept() {
        let time = times(10_000);
        let points = decimate(&time, &(0.0..=200.0), 300, |i| {
            if i == 7_777 { 5.0 } else { 0.0 }
        });
        assert!(points.contains(&[time[7_777], 5.0]));
        assert!(
            points.len() <= 602,
            "{} points for 300 columns",
            points.len()
        );
        assert!(points.is_sorted_by(|a, b| a[0] <= b[0]));
    }

    #[test]
    fn a_short_series_is_drawn_as_it_is_without_what_is_no_number() {
        let time = times(5);
        let points = decimate(&time, &(0.0..=1.0), 300, |i| {
            if i == 2 { f64::NAN } else { 1.0 }
        });
        assert_eq!(points.len(), 4);
    }

    #[test]
    fn only_the_window_and_one_sample_on_each_side_are_drawn() {
        let time = times(100);
        let points = decimate(&time, &(0.991..=1.009), 300, |_| 0.0);
        assert_eq!(points.len(), 3);
        assert!(points[0][0] < 0.991 && points[2][0] > 1.009);
    }

    #[test]
    fn an_empty_series_has_no_points() {
        assert!(decimate(&[], &(0.0..=1.0), 300, |_| 0.0).is_empty());
    }
}
