//! Histograms of values whose counts, mean and spread are known.

use super::*;
use grainfall::measure::Histogram;

#[test]
fn every_value_is_counted_once_in_its_part() {
    let values = [0.0, 0.1, 0.9, 1.0, 1.0, 3.9, 4.0, f64::NAN, f64::INFINITY];
    let histogram = Histogram::of(&values, 4).unwrap();
    assert_eq!((histogram.low, histogram.high), (0.0, 4.0));
    assert_eq!(histogram.counts, [3, 2, 0, 2]);
    assert_eq!((histogram.total(), histogram.width()), (7, 1.0));
    let middles: Vec<f64> = histogram.parts().map(|(middle, _)| middle).collect();
    assert_eq!(middles, [0.5, 1.5, 2.5, 3.5]);
}

#[test]
fn mean_and_deviation_are_those_of_an_even_spread() {
    // Whole numbers from 0 to n − 1: mean (n − 1)/2, variance (n² − 1)/12.
    let values: Vec<f64> = (0..100).map(f64::from).collect();
    let histogram = Histogram::of(&values, 10).unwrap();
    assert_eq!(histogram.counts, [10; 10]);
    assert_close(histogram.mean, 49.5, 1e-12);
    assert_close(histogram.deviation, (9999.0_f64 / 12.0).sqrt(), 1e-12);
}

#[test]
fn equal_values_are_in_one_part_and_none_make_no_histogram() {
    let histogram = Histogram::of(&[2.5; 6], 20).unwrap();
    assert_eq!(
        (histogram.counts.as_slice(), histogram.width()),
        ([6].as_slice(), 0.0)
    );
    assert_eq!((histogram.mean, histogram.deviation), (2.5, 0.0));
    assert_eq!(Histogram::of(&[f64::NAN], 3), None);
}
