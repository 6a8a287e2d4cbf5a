//! The samples of a series from some time on, and what is averaged over them.
//!
//! In: a [`Series`]. Out: means, medians and rates; NaN where no sample has a value.

use super::avalanches::{Avalanche, SMOOTHING_TIME, avalanches};
use super::estimate::Estimate;
use super::sampled_quantity::Measure;
use super::series::Series;
use super::slow_waves::time_average;
use super::summary::Summary;
use std::ops::Range;

/// Time over which the slope of a rise is taken [s].
const SLOPE_TIME: f64 = 0.2;

/// The samples that count.
pub struct Window<'a> {
    series: &'a Series,
    range: Range<usize>,
    time: &'a [f64],
    /// Of unevenly spaced samples, those that are about as far apart as the farthest.
    even: Option<Vec<usize>>,
}

impl<'a> Window<'a> {
    /// Those from `from_time` [s] on.
    pub fn of(series: &'a Series, from_time: f64) -> Self {
        Self::in_range(series, series.first_at(from_time)..series.len())
    }

    /// Those from one time to another [s], both included.
    pub fn between(series: &'a Series, from_time: f64, to_time: f64) -> Self {
        let end = series.time().partition_point(|time| *time <= to_time);
        Self::in_range(series, series.first_at(from_time).min(end)..end)
    }

    fn in_range(series: &'a Series, range: Range<usize>) -> Self {
        let time = &series.time()[range.clone()];
        Self {
            series,
            range,
            time,
            even: evenly_spaced(time),
        }
    }

    /// A summary of these samples without entries.
    pub fn summary(&self, from_time: f64) -> Summary {
        Summary {
            from: self.time.first().copied().unwrap_or(from_time),
            to: self.time.last().copied().unwrap_or(from_time),
            samples: self.time.len(),
            entries: Vec::new(),
        }
    }

    /// The values of a measure [SI].
    pub fn column(&self, measure: Measure) -> &'a [f64] {
        &self.series.column(measure)[self.range.clone()]
    }

    /// The last of them.
    pub fn at_end(&self, measure: Measure) -> f64 {
        self.column(measure).last().copied().unwrap_or(f64::NAN)
    }

    /// The largest of them; NaN where none has a value.
    pub fn largest(&self, measure: Measure) -> f64 {
        largest(self.column(measure))
    }

    /// Mean of a measure over the window; NaN where no sample has a value.
    pub fn mean(&self, measure: Measure) -> Estimate {
        let values = self.column(measure);
        let Some(even) = &self.even else {
            return time_average(values);
        };
        let values: Vec<f64> = even.iter().map(|index| values[*index]).collect();
        time_average(&values)
    }

    /// Change of a measure over the window per second: the mean of its changes from sample to
    /// sample; NaN where it has no length.
    pub fn rate(&self, measure: Measure) -> Estimate {
        let values = self.column(measure);
        let span = match self.time {
            [from, .., to] => to - from,
            _ => f64::NAN,
        };
        let per_second = (values.len() as f64 - 1.0) / span;
        let changes = values
            .windows(2)
            .map(|pair| (pair[1] - pair[0]) * per_second);
        time_average(&changes.collect::<Vec<_>>())
    }

    /// Share of the samples in which a measure is at least `threshold`; NaN where none has a value.
    pub fn share_from(&self, measure: Measure, threshold: f64) -> Estimate {
        let finite = (self.column(measure).iter()).filter(|value| value.is_finite());
        let is_above = |value: &f64| f64::from(u8::from(*value >= threshold));
        time_average(&finite.map(is_above).collect::<Vec<_>>())
    }

    /// Mean of a measure over the samples in one of `falls` (widened by the smoothing), each of
    /// which is one event.
    pub fn mean_in(&self, falls: &[Avalanche], measure: Measure) -> Estimate {
        let (values, margin) = (self.column(measure), 0.5 * SMOOTHING_TIME);
        let burst = |fall: &Avalanche| {
            let first = self.time.partition_point(|t| *t < fall.start - margin);
            let end = self.time.partition_point(|t| *t <= fall.end + margin);
            let finite = values[first..end].iter().filter(|value| value.is_finite());
            finite.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0))
        };
        Estimate::of_bursts(&falls.iter().map(burst).collect::<Vec<_>>())
    }

    /// The avalanches whose drop is at least `smallest_drop` [rad].
    pub fn avalanches(&self, smallest_drop: f64) -> Vec<Avalanche> {
        avalanches(self.time, self.column(Measure::SurfaceAngle), smallest_drop)
    }

    /// For each sample, whether θ falls there in one of `falls` (widened by the smoothing).
    pub fn falling(&self, falls: &[Avalanche]) -> Vec<bool> {
        let margin = 0.5 * SMOOTHING_TIME;
        let mut next = falls.iter().peekable();
        self.time
            .iter()
            .map(|&t| {
                while next.next_if(|fall| fall.end + margin < t).is_some() {}
                next.peek().is_some_and(|fall| fall.start - margin <= t)
            })
            .collect()
    }

    /// Slopes of θ over [`SLOPE_TIME`] at each sample that stands, for that time, in one rise
    /// [rad/s].
    pub fn rise_rates(&self, falling: &[bool]) -> Vec<f64> {
        let theta = self.column(Measure::SurfaceAngle);
        let mut rates = Vec::new();
        let mut start = 0;
        let mut rise_start = 0;
        for (end, &t) in self.time.iter().enumerate() {
            if falling[end] {
                rise_start = end + 1;
                continue;
            }
            start = rise_start.max(start);
            while start + 1 < end && t - self.time[start + 1] >= SLOPE_TIME - 1e-9 {
                start += 1;
            }
            let span = t - self.time[start];
            if span >= SLOPE_TIME - 1e-9 {
                rates.push((theta[end] - theta[start]) / span);
            }
        }
        rates
    }
}

/// Median of the finite values; NaN without any.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

/// Largest of the finite values; NaN without any.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NAN, f64::max)
}

/// Of samples at such `time`s [s], those by which an average counts all times alike; none where all
/// of them do. Samples that follow what happens are far closer at some times than at others.
fn evenly_spaced(time: &[f64]) -> Option<Vec<usize>> {
    let apart = || time.windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = (
        apart().fold(f64::INFINITY, f64::min),
        apart().fold(0.0, f64::max),
    );
    if least > 0.5 * most || most <= 0.0 {
        return None;
    }
    let begin = time[0];
    let cell = |time: f64| ((time - begin) / most) as u64;
    let is_next = |index: &usize| *index == 0 || cell(time[*index]) > cell(time[*index - 1]);
    Some((0..time.len()).filter(is_next).collect())
}
