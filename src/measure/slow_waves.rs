//! The standard error of a time average, from the series itself.
//!
//! In: samples that lie evenly in time. Out: their mean as an [`Estimate`].
//!
//! Samples that follow one another are alike, so `s/√N` of all of them is far too small. How far a
//! mean strays is the power of the series at frequency zero, and the slowest waves that fit into the
//! run show it: the type II cosines of one half to four periods,
//!
//! `cₖ = √(2/N) Σᵢ (xᵢ − x̄) cos(π k (i + ½)/N)`, `k = 1 … 8`, error² `= Σₖ cₖ²/(8 N)`
//!
//! (equally weighted cosines: E. Lazarus, D. J. Lewis, J. H. Stock and M. W. Watson, J. Bus. Econ.
//! Stat. 36, 541, 2018). For a long series the eight are independent and normal, so the mean over
//! its error follows Student's distribution of eight degrees of freedom. The number is fixed: more
//! waves would know the error better, but see faster changes, which say nothing about the mean. In a
//! drum they are the cycles of rise and fall, of some three seconds: blocks of a few seconds, and
//! waves as short, show the heat of single avalanches, which as a series is far steadier.
//!
//! The series is worth `variance/error²` independent samples, less a quarter, by which the inverse of
//! so uncertain a square is too large in the mean. Below [`FEWEST_SAMPLES`] its own correlation
//! cannot be told from the waves, and no error is stated.
//!
//! No kept Rust crate does this, and how errors are taken is part of the measure.

use super::estimate::{Estimate, variance};

/// The slowest waves, counted in half periods, whose power is taken.
const WAVES: usize = 8;
/// Fewest samples a wave: independence cannot be seen in fewer.
const SAMPLES_A_WAVE: usize = 6;
/// Fewest independent samples for which an error is stated.
const FEWEST_SAMPLES: usize = 10;

/// The mean of the finite ones of `samples`, which lie evenly in time, with its standard error.
pub fn time_average(samples: &[f64]) -> Estimate {
    let finite: Vec<f64> = (samples.iter().copied())
        .filter(|value| value.is_finite())
        .collect();
    let count = finite.len();
    let mean = finite.iter().sum::<f64>() / count as f64;
    if count < WAVES * SAMPLES_A_WAVE {
        return Estimate::too_short(mean, (count / SAMPLES_A_WAVE).max(count.min(1)));
    }
    if finite.iter().all(|value| *value == finite[0]) {
        return Estimate {
            mean: finite[0],
            error: Some(0.0),
            samples: count,
            freedom: count - 1,
        };
    }
    let squared_error = slow_power(&finite, mean) / count as f64;
    let unbiased = (WAVES - 2) as f64 / WAVES as f64;
    let independent = unbiased * variance(&finite, mean) / squared_error;
    let samples = independent.min(count as f64) as usize;
    if samples < FEWEST_SAMPLES {
        return Estimate::too_short(mean, samples);
    }
    Estimate {
        mean,
        error: Some(squared_error.sqrt()),
        samples,
        freedom: WAVES,
    }
}

/// The mean of `cₖ²` over the slowest waves.
fn slow_power(values: &[f64], mean: f64) -> f64 {
    let count = values.len() as f64;
    let power = |wave: usize| {
        let turn = std::f64::consts::PI * wave as f64 / count;
        let projection = projection(values, mean, turn);
        2.0 / count * projection * projection
    };
    (1..=WAVES).map(power).sum::<f64>() / WAVES as f64
}

/// `Σᵢ (xᵢ − x̄) cos(turn (i + ½))`; the angle goes on by turning a unit vector.
fn projection(values: &[f64], mean: f64, turn: f64) -> f64 {
    let (sine, cosine) = libm::sincos(turn);
    let (mut y, mut x) = libm::sincos(0.5 * turn);
    let mut sum = 0.0;
    for value in values {
        sum += (value - mean) * x;
        (x, y) = (x * cosine - y * sine, x * sine + y * cosine);
    }
    sum
}
