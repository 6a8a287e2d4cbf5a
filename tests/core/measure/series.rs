//! Series, avalanches and summaries of curves whose extrema are known.

use super::*;
use grainfall::measure::{
    Avalanche, DropThreshold, Measure, ResultKey, RunQuantity, Sample, Series, avalanches,
    summarise,
};
use std::f64::consts::PI;

const DEGREE: f64 = PI / 180.0;
/// Time between samples [s].
const INTERVAL: f64 = 0.02;
/// 0.5 rpm in degrees [°/s].
const RISE: f64 = 3.0;

/// Angles [rad] that rise at 3 °/s from 22° and fall in 0.3 s, from the first of `tops` [°] to the
/// first of `bottoms` [°] and so on, and end on a last rise.
fn sawtooth(tops: &[f64], bottoms: &[f64]) -> Vec<f64> {
    let mut corners = vec![(0.0, 22.0)];
    let mut at = 0.0;
    let mut from = 22.0;
    for (top, bottom) in tops.iter().zip(bottoms) {
        at += (top - from) / RISE;
        corners.push((at, *top));
        at += 0.3;
        corners.push((at, *bottom));
        from = *bottom;
    }
    corners.push((at + 2.0, from + 2.0 * RISE));
    let samples = ((at + 2.0) / INTERVAL) as usize;
    (0..samples)
        .map(|i| interpolate(&corners, i as f64 * INTERVAL) * DEGREE)
        .collect()
}

fn interpolate(corners: &[(f64, f64)], at: f64) -> f64 {
    let next = corners.partition_point(|corner| corner.0 <= at).max(1);
    let ((t0, y0), (t1, y1)) = (corners[next - 1], corners[next.min(corners.len() - 1)]);
    y0 + (y1 - y0) * (at - t0) / (t1 - t0)
}

fn times(count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64 * INTERVAL).collect()
}

fn find(theta: &[f64], smallest_drop: f64) -> Vec<Avalanche> {
    avalanches(&times(theta.len()), theta, smallest_drop * DEGREE)
}

/// A series with these angles [rad] and granular temperatures.
fn series(theta: &[f64], temperature: impl Fn(usize) -> f64) -> Series {
    let mut series = Series::default();
    for (i, &angle) in theta.iter().enumerate() {
        let mut values = [f64::NAN; Measure::COUNT];
        values[Measure::SurfaceAngle as usize] = angle;
        values[Measure::GranularTemperature as usize] = temperature(i);
        series.push(Sample {
            step: i as u64,
            time: i as f64 * INTERVAL,
            values,
        });
    }
    series
}

const TOPS: [f64; 6] = [27.0, 28.0, 26.5, 29.0, 27.5, 28.0];
const BOTTOMS: [f64; 6] = [23.0, 22.5, 24.0, 22.0, 23.5, 25.0];

#[test]
fn noisy_sawtooth_gives_back_its_teeth() {
    for seed in 0..20 {
        let mut noise = Noise::new(seed);
        let theta: Vec<f64> = sawtooth(&TOPS, &BOTTOMS)
            .into_iter()
            .map(|angle| angle + 0.15 * DEGREE * noise.centred())
            .collect();
        let found = find(&theta, 1.0);
        assert_eq!(found.len(), TOPS.len());
        for ((avalanche, top), bottom) in found.iter().zip(TOPS).zip(BOTTOMS) {
            // Averaging five samples rounds an edge by 0.12° (the rise over 0.04 s); the averaged noise adds at most 0.15°.
            assert_close(avalanche.theta_m / DEGREE, top, 0.27);
            assert_close(avalanche.theta_r / DEGREE, bottom, 0.27);
            assert_close(avalanche.drop() / DEGREE, top - bottom, 0.54);
            // 0.3 s long, and each end can move by the smoothing and by 0.1 s where noise outruns the rise.
            assert_close(avalanche.end - avalanche.start, 0.3, 0.3);
        }
    }
}

#[test]
fn smallest_drop_decides_what_is_an_avalanche() {
    let theta = sawtooth(&[27.0, 24.0, 27.0, 26.0], &[23.0, 23.2, 24.4, 22.0]);
    // Drops of 4, 0.8, 2.6 and 4°. The second interrupts a rise.
    assert_eq!(find(&theta, 0.5).len(), 4);
    assert_eq!(find(&theta, 1.0).len(), 3);
    // At 2° the third is an avalanche, but the rise of 1.6° after it no longer ends it: it runs on into the fourth.
    let coarse = find(&theta, 2.0);
    assert_eq!(coarse.len(), 2);
    assert_close(coarse[1].drop() / DEGREE, 5.0, 0.3);
    assert_eq!(find(&theta, 5.5).len(), 0);
}

#[test]
fn avalanche_under_way_at_either_end_is_not_reported() {
    let falling: Vec<f64> = (0..50)
        .map(|i| (30.0 - 0.2 * f64::from(i)) * DEGREE)
        .collect();
    assert_eq!(find(&falling, 1.0), []);

    let mut fall_then_rise = falling.clone();
    fall_then_rise.extend(falling.iter().rev());
    assert_eq!(find(&fall_then_rise, 1.0), []);

    let mut rise_then_fall: Vec<f64> = falling.iter().rev().copied().collect();
    rise_then_fall.extend(&falling);
    assert_eq!(find(&rise_then_fall, 1.0), []);
}

#[test]
fn samples_without_a_surface_are_passed_over() {
    let mut theta = sawtooth(&TOPS, &BOTTOMS);
    let whole = find(&theta, 1.0).len();
    for i in (0..theta.len()).step_by(7) {
        theta[i] = f64::NAN;
    }
    assert_eq!(find(&theta, 1.0).len(), whole);
    assert_eq!(find(&[f64::NAN; 100], 1.0), []);
    assert_eq!(find(&[], 1.0), []);
}

#[test]
fn series_gives_back_what_was_pushed() {
    let mut series = series(&[0.1, 0.2, 0.3], |i| i as f64);
    assert_eq!(series.len(), 3);
    assert_eq!(series.column(Measure::SurfaceAngle), [0.1, 0.2, 0.3]);
    assert_eq!(series.time(), [0.0, 0.02, 0.04]);
    assert_eq!(series.steps(), [0, 1, 2]);
    assert_eq!(series.first_at(0.02), 1);
    let last = series.last().expect("a sample");
    assert_eq!(
        (last.step, last.value(Measure::GranularTemperature)),
        (2, 2.0)
    );
    assert_eq!(series.get(3), None);

    series.truncate(1);
    assert_eq!(series.column(Measure::SurfaceAngle), [0.1]);
    series.truncate(0);
    assert!(series.is_empty() && series.last().is_none());
}

#[test]
fn rigid_rotation_rises_at_the_drum_speed_between_avalanches() {
    let mut noise = Noise::new(9);
    let theta: Vec<f64> = sawtooth(&TOPS, &BOTTOMS)
        .into_iter()
        .map(|angle| angle + 0.05 * DEGREE * noise.centred())
        .collect();
    let summary = summarise(&series(&theta, |_| 0.0), 0.0, DEGREE);
    let rate = summary.value(RunQuantity::RiseRate).expect("rises") / DEGREE;
    // Noise of 0.03° (r.m.s.) at both ends of 0.2 s: 0.2 °/s a slope, of which some 200 overlap in groups of ten.
    assert_close(rate, RISE, 0.15);
}

#[test]
fn summary_averages_the_window_and_nothing_before_it() {
    let theta = [vec![0.9; 50], vec![0.4; 100]].concat();
    let series = series(&theta, |i| if i % 4 == 0 { 8e-9 } else { 1e-9 });
    let summary = summarise(&series, 1.0, DEGREE);
    assert_eq!(summary.samples, 100);
    assert_eq!((summary.from, summary.to), (1.0, 149.0 * INTERVAL));
    // Rounding of 100 additions.
    assert_close(summary.value(Measure::SurfaceAngle).expect("θ"), 0.4, 1e-14);
    assert_close(
        summary.value(Measure::GranularTemperature).expect("Tg"),
        2.75e-9,
        1e-22,
    );
    assert_eq!(summary.value(RunQuantity::NonRigidShare), Some(0.25));
    assert_eq!(summary.value(RunQuantity::Avalanches), Some(0.0));
    assert_eq!(summary.value(RunQuantity::Drop), None);
    assert_eq!(summary.value(Measure::PackingFraction), None);
}

#[test]
fn summary_quotes_avalanches_for_each_smallest_drop() {
    let theta = sawtooth(&[27.0, 24.0, 27.0, 26.0], &[23.0, 23.2, 24.4, 22.0]);
    let summary = summarise(&series(&theta, |_| 0.0), 0.0, 2.0 * DEGREE);
    assert_eq!(summary.value(RunQuantity::Avalanches), Some(2.0));
    for (threshold, count) in [
        (DropThreshold::HalfDegree, 4.0),
        (DropThreshold::OneDegree, 3.0),
        (DropThreshold::TwoDegrees, 2.0),
        (DropThreshold::ThreeDegrees, 2.0),
    ] {
        let key = ResultKey::OfAvalanches(RunQuantity::Avalanches, threshold);
        assert_eq!(summary.value(key), Some(count), "{}", key.name());
    }
    // Tops of 27° twice, each rounded by the smoothing.
    let top = summary.value(RunQuantity::MaximumAngle).expect("θ_m") / DEGREE;
    assert_close(top, 27.0, 0.15);
}

#[test]
fn temperature_peaks_are_told_apart_from_the_quiet_between() {
    let theta = sawtooth(&TOPS, &BOTTOMS);
    let falls = |i: usize| i > 0 && theta[i] < theta[i - 1];
    let summary = summarise(
        &series(&theta, |i| if falls(i) { 1e-6 } else { 1e-10 }),
        0.0,
        DEGREE,
    );
    let value = |quantity: RunQuantity| summary.value(quantity).expect("a temperature");
    // The falls last 0.3 s; the margin of the smoothing adds up to 0.1 s of quiet on either side.
    assert_close(value(RunQuantity::TemperatureInAvalanches), 1e-6, 0.45e-6);
    assert_eq!(value(RunQuantity::TemperatureBetweenAvalanches), 1e-10);
}

#[test]
fn summary_of_nothing_has_entries_without_values() {
    let summary = summarise(&Series::default(), 0.0, DEGREE);
    assert_eq!(summary.samples, 0);
    assert_eq!(summary.value(Measure::SurfaceAngle), None);
    assert_eq!(summary.value(RunQuantity::Avalanches), Some(0.0));
}

#[test]
fn summary_names_are_its_own_and_it_can_be_written() {
    let summary = summarise(
        &series(&sawtooth(&TOPS, &BOTTOMS), |_| f64::NAN),
        0.0,
        DEGREE,
    );
    let names: std::collections::HashSet<_> = summary
        .entries
        .iter()
        .map(|entry| entry.key.name())
        .collect();
    assert_eq!(names.len(), summary.entries.len());
    let text = serde_json::to_string(&summary).expect("JSON");
    assert!(
        text.contains(r#""name":"surface angle","unit":"rad","value":0."#),
        "{text}"
    );
}
