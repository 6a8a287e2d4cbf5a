//! Standard errors, on series whose true error is known in closed form.

use super::*;
use grainfall::measure::{Difference, Estimate, time_average};

/// Series of each kind that are tried.
const TRIALS: u64 = 2000;
/// Share of a normal distribution within one standard deviation.
const WITHIN_ONE: f64 = 0.6827;
/// How far from it the share of stated intervals that hold the truth may lie. Chance alone makes
/// 0.010 of so many trials.
const ALLOWED: f64 = 0.03;
/// Samples of 30 s at 50 Hz, over which the results of a run are averaged.
const HALF_A_MINUTE: usize = 1500;

/// White noise of variance one.
fn white(noise: &mut Noise, count: usize) -> Vec<f64> {
    (0..count).map(|_| noise.normal()).collect()
}

/// A first-order autoregression of variance one whose correlation falls by e in `time` samples.
fn autoregression(noise: &mut Noise, count: usize, time: f64) -> Vec<f64> {
    let kept = (-1.0 / time).exp();
    let mut value = noise.normal();
    (0..count)
        .map(|_| {
            value = kept * value + (1.0 - kept * kept).sqrt() * noise.normal();
            value
        })
        .collect()
}

/// The true standard error of the mean of so many of its samples.
fn error_of_autoregression(count: usize, time: f64) -> f64 {
    let (kept, n) = ((-1.0 / time).exp(), count as f64);
    let ends = 2.0 * kept * (1.0 - kept.powf(n)) / (n * (1.0 - kept) * (1.0 - kept));
    (((1.0 + kept) / (1.0 - kept) - ends) / n).sqrt()
}

/// Half the height of the sawtooth [°] and its middle.
const HALF_HEIGHT: f64 = 4.25;
const MIDDLE: f64 = 33.75;
/// Its rise from sample to sample [°]: 3 °/s at 50 Hz.
const STEP: f64 = 0.06;

/// θ as a dry drum shows it [°]: it rises steadily to a top and falls at once to a bottom, both
/// normally spread by `scatter`, with noise of 0.2° on each sample.
fn sawtooth(noise: &mut Noise, count: usize, scatter: f64) -> Vec<f64> {
    let mut corner = |side: f64| MIDDLE + side * HALF_HEIGHT + scatter * noise.normal();
    let mut angles = Vec::with_capacity(2 * count);
    let (mut angle, mut top) = (corner(-1.0), corner(1.0));
    // The first half is left out, so that it begins anywhere in a tooth.
    while angles.len() < 2 * count {
        angle += STEP;
        if angle >= top {
            angle = corner(-1.0);
            top = corner(1.0).max(angle + 1.0);
        }
        angles.push(angle);
    }
    let kept = angles.split_off(count);
    kept.into_iter()
        .map(|angle| angle + 0.2 * noise.normal())
        .collect()
}

/// The true standard error of its mean: of a renewal process with tops `h + σ x` and bottoms `−h +
/// σ y` about the middle, one tooth adds `((h + σ x)² − (−h + σ y)²)/(2 rise)` to the integral, of
/// variance `(2 h² σ² + σ⁴)/rise²`, and takes `2 h/rise` in the mean.
fn error_of_sawtooth(count: usize, scatter: f64) -> f64 {
    let (h, s) = (HALF_HEIGHT, scatter * scatter);
    ((2.0 * h * h * s + s * s) / (2.0 * h * STEP * count as f64)).sqrt()
}

/// What many series of one kind came to.
struct Trials {
    /// Share of them for which an error was stated.
    stated: f64,
    /// Share of the stated intervals that hold the truth.
    held: f64,
    /// Root mean square of the stated errors.
    error: f64,
    /// Mean number of independent samples.
    samples: f64,
}

impl Trials {
    fn of(truth: f64, estimate: impl FnMut(&mut Noise) -> Estimate) -> Self {
        Self::many(TRIALS, truth, estimate)
    }

    fn many(trials: u64, truth: f64, mut estimate: impl FnMut(&mut Noise) -> Estimate) -> Self {
        let mut noise = Noise::new(19);
        let estimates: Vec<Estimate> = (0..trials).map(|_| estimate(&mut noise)).collect();
        let stated: Vec<Estimate> = (estimates.iter().copied())
            .filter(|own| own.error.is_some())
            .collect();
        let count = stated.len() as f64;
        let squares = stated.iter().filter_map(|own| Some(own.error?.powi(2)));
        // Within one error, as Student's distribution has it for so many degrees of freedom.
        let holds = |own: &&Estimate| {
            let off = Difference::from_number(**own, truth).expect("an error");
            off.probability() >= 1.0 - WITHIN_ONE
        };
        let samples: usize = estimates.iter().map(|own| own.samples).sum();
        Self {
            stated: count / trials as f64,
            held: stated.iter().filter(holds).count() as f64 / count,
            error: (squares.sum::<f64>() / count).sqrt(),
            samples: samples as f64 / trials as f64,
        }
    }

    /// All state an error, within `tolerance` of the `true_error`, and 68 ± 3 % hold the truth.
    fn assert_right(&self, true_error: f64, tolerance: f64, what: &str) {
        assert!(self.stated > 0.95, "{what}: {} state an error", self.stated);
        let ratio = self.error / true_error;
        assert!(
            (ratio - 1.0).abs() < tolerance,
            "{what}: {ratio} of the true error"
        );
        assert!(
            (self.held - WITHIN_ONE).abs() < ALLOWED,
            "{what}: {} hold",
            self.held
        );
    }
}

#[test]
fn slow_waves_find_the_error_of_white_noise() {
    for count in [300, HALF_A_MINUTE] {
        let trials = Trials::of(0.0, |noise| time_average(&white(noise, count)));
        trials.assert_right((1.0 / count as f64).sqrt(), 0.05, "white noise");
        // All its samples are independent, and no more than all are counted.
        assert_close(trials.samples / count as f64, 0.77, 0.05);
    }
}

#[test]
fn slow_waves_find_the_error_of_autoregressions() {
    for (time, count) in [
        (1.0, HALF_A_MINUTE),
        (5.0, HALF_A_MINUTE),
        (20.0, HALF_A_MINUTE),
        (50.0, 4000),
        (50.0, 10_000),
    ] {
        let what = format!("correlation time {time}, {count} samples");
        let trials = Trials::of(0.0, |noise| {
            time_average(&autoregression(noise, count, time))
        });
        let true_error = error_of_autoregression(count, time);
        trials.assert_right(true_error, 0.05, &what);
        let samples = trials.samples * true_error * true_error;
        assert!(
            (0.9..1.05).contains(&samples),
            "{what}: {samples} of the samples"
        );
    }
}

#[test]
fn of_few_independent_samples_slow_waves_see_somewhat_less() {
    // Fifteen correlation times: the shortest wave is not slow any more.
    let trials = Trials::of(0.0, |noise| {
        time_average(&autoregression(noise, HALF_A_MINUTE, 50.0))
    });
    let ratio = trials.error / error_of_autoregression(HALF_A_MINUTE, 50.0);
    assert!((0.8..0.9).contains(&ratio), "{ratio} of the true error");
    assert!((0.59..0.65).contains(&trials.held), "{} hold", trials.held);
}

#[test]
fn slow_waves_find_the_error_of_a_noisy_sawtooth() {
    for (scatter, count) in [(1.5, HALF_A_MINUTE), (2.0, HALF_A_MINUTE), (2.0, 5000)] {
        let what = format!("tops and bottoms spread by {scatter}°, {count} samples");
        let trials = Trials::of(MIDDLE, |noise| {
            time_average(&sawtooth(noise, count, scatter))
        });
        trials.assert_right(error_of_sawtooth(count, scatter), 0.08, &what);
    }
    // Regular teeth cancel over longer times than the shortest of the waves.
    let regular = Trials::of(MIDDLE, |noise| {
        time_average(&sawtooth(noise, HALF_A_MINUTE, 0.5))
    });
    let ratio = regular.error / error_of_sawtooth(HALF_A_MINUTE, 0.5);
    assert!((1.0..1.4).contains(&ratio), "{ratio} of the true error");
}

#[test]
fn series_shorter_than_their_memory_say_so() {
    // A correlation time and a half: one independent sample.
    let short = Trials::of(0.0, |noise| {
        time_average(&autoregression(noise, 300, 200.0))
    });
    assert!(short.stated < 0.1, "{} state an error", short.stated);
    let drift: Vec<f64> = (0..HALF_A_MINUTE).map(|k| k as f64).collect();
    assert_eq!(time_average(&drift).error, None);
    let few = time_average(&[1.0, 2.0, 3.0]);
    assert_eq!((few.mean, few.error), (2.0, None));
    let reason = few.reason();
    assert_eq!(reason.as_deref(), Some("too short: 1 independent sample"));
    let three = Estimate::too_short(2.0, 3).reason();
    assert_eq!(three.as_deref(), Some("too short: 3 independent samples"));
    let nothing = time_average(&[]);
    assert!(nothing.mean.is_nan() && nothing.reason().is_none());
}

#[test]
fn a_constant_has_no_scatter_and_gaps_are_passed_over() {
    let constant = time_average(&[0.25; 400]);
    assert_eq!((constant.mean, constant.error), (0.25, Some(0.0)));
    assert_eq!(constant.samples, 400);
    let mut noise = Noise::new(5);
    let whole = white(&mut noise, 1000);
    let mut gaps = whole.clone();
    gaps.insert(10, f64::NAN);
    gaps.push(f64::INFINITY);
    assert_eq!(time_average(&gaps), time_average(&whole));
    // Another unit and another zero change nothing but the numbers.
    let shifted: Vec<f64> = whole.iter().map(|value| 4.0 * value + 64.0).collect();
    let [own, other] = [whole, shifted].map(|values| time_average(&values));
    assert_close(other.error.unwrap() / own.error.unwrap(), 4.0, 1e-9);
    assert_eq!(other.samples, own.samples);
}

#[test]
fn the_mean_of_events_is_known_by_their_spread() {
    for count in [12, 30] {
        let what = format!("{count} events");
        let events = |noise: &mut Noise| Estimate::of_events(&white(noise, count));
        let trials = Trials::many(10 * TRIALS, 0.0, events);
        trials.assert_right((1.0 / count as f64).sqrt(), 0.05, &what);
    }
    // Neighbours that are alike tell less.
    let alike = |noise: &mut Noise| {
        let time = -1.0 / 0.5_f64.ln();
        Estimate::of_events(&autoregression(noise, 60, time))
    };
    let trials = Trials::many(10 * TRIALS, 0.0, alike);
    let true_error = error_of_autoregression(60, -1.0 / 0.5_f64.ln());
    trials.assert_right(true_error, 0.12, "correlated events");
    let four = Estimate::of_events(&[8.0, 9.0, 7.0, 8.5]);
    assert_eq!((four.error, four.samples), (None, 4));
    let runs = Estimate::of_runs(&[28.0, 29.0]);
    assert_eq!((runs.mean, runs.error), (28.5, Some(0.5)));
    assert_eq!(Estimate::of_runs(&[28.0]).error, None);
}

/// Two and three runs of the same true mean, each of which states its own error: two means alone
/// would be known to one degree of freedom.
#[test]
fn few_runs_are_known_by_their_own_errors_too() {
    for count in [2, 3] {
        let run = |noise: &mut Noise| time_average(&autoregression(noise, HALF_A_MINUTE, 10.0));
        let seeds = |noise: &mut Noise| {
            let runs: Vec<Estimate> = (0..count).map(|_| run(noise)).collect();
            let mean = Estimate::of_seeds(&runs);
            assert_eq!(mean.freedom, 8 * count + count - 1);
            mean
        };
        let truth = error_of_autoregression(HALF_A_MINUTE, 10.0) / (count as f64).sqrt();
        let trials = Trials::many(TRIALS, 0.0, seeds);
        trials.assert_right(truth, 0.05, &format!("{count} runs"));
    }
    let of = |mean, error, freedom| Estimate {
        mean,
        error,
        samples: 30,
        freedom,
    };
    // s² is 0.5, to one degree of freedom; the runs' own 0.04 and 0.16, to eight each.
    let two = Estimate::of_seeds(&[of(28.0, Some(0.2), 8), of(29.0, Some(0.4), 8)]);
    let variance = (0.5 + 8.0 * 0.04 + 8.0 * 0.16) / 17.0;
    assert_close(two.error.unwrap(), (variance / 2.0_f64).sqrt(), 1e-12);
    assert_eq!((two.mean, two.samples, two.freedom), (28.5, 2, 17));
    // Where none says how well it is known, their spread does; one run is left as it is.
    let silent = [of(28.0, None, 0), of(29.0, None, 0)];
    assert_eq!(
        Estimate::of_seeds(&silent),
        Estimate::of_runs(&[28.0, 29.0])
    );
    assert_eq!(Estimate::of_seeds(&silent[..1]), silent[0]);
    // Four are known by their spread alone.
    let four = [1.0, 2.0, 3.0, 4.0].map(|mean| of(mean, Some(9.0), 8));
    let spread = Estimate::of_runs(&[1.0, 2.0, 3.0, 4.0]);
    assert_eq!(Estimate::of_seeds(&four), spread);
}

/// One run of a case beside ten other cases of three runs each, all of which scatter by 2 %.
#[test]
fn a_single_run_is_given_the_scatter_of_cases_of_several() {
    let run = |noise: &mut Noise, truth: f64| truth * (1.0 + 0.02 * noise.normal());
    let alone = |noise: &mut Noise| {
        let others = (1..=10).map(|case| {
            let runs = [0; 3].map(|_| run(noise, f64::from(case)));
            Estimate::of_runs(&runs)
        });
        let others: Vec<Estimate> = others.collect();
        Estimate::too_short(run(noise, 5.0), 1).scattering_as(others)
    };
    let trials = Trials::many(10 * TRIALS, 5.0, alone);
    trials.assert_right(0.1, 0.02, "one run");
    // s²/mean² of 0.02 once and of 0.0001 twice.
    let others = [&[9.0, 11.0][..], &[99.0, 101.0, 100.0], &[7.0]].map(Estimate::of_runs);
    let one = Estimate::too_short(50.0, 1).scattering_as(others);
    let expected = 50.0 * (0.0202_f64 / 3.0).sqrt();
    assert_close(one.error.unwrap(), expected, 1e-12);
    assert_eq!((one.mean, one.samples, one.freedom), (50.0, 1, 3));
    let none = Estimate::too_short(50.0, 1);
    assert_eq!(none.scattering_as([Estimate::of_runs(&[7.0])]), none);
}

#[test]
fn a_ratio_has_the_relative_errors_of_both() {
    let of = |mean, error| Estimate {
        mean,
        error: Some(error),
        samples: 10,
        freedom: 9,
    };
    let ratio = of(4.0, 0.4).over(of(8.0, 0.0));
    assert_eq!((ratio.mean, ratio.error), (0.5, Some(0.05)));
    let both = of(4.0, 0.3 * 4.0).over(of(8.0, 0.4 * 8.0));
    assert_close(both.error.unwrap(), 0.25, 1e-12);
    assert_eq!(of(1.0, 0.1).times(-2.0).error, Some(0.2));
}
