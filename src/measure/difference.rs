//! Whether two means differ by more than their scatter.
//!
//! In: two means with their errors, or one and a number. Out: their difference with its error, its
//! probability by chance, in words. The test is Welch's (B. L. Welch, Biometrika 34, 28, 1947):
//! `t = (a − b)/√(e_a² + e_b²)`, with `ν = (e_a² + e_b²)²/(e_a⁴/ν_a + e_b⁴/ν_b)` degrees of freedom
//! on Student's distribution. Of several runs the errors are those over the seeds, of single runs
//! their own.

use super::estimate::Estimate;
use super::result_key::ResultKey;

/// A difference that chance alone makes less often than this counts as more than scatter.
const SIGNIFICANCE: f64 = 0.05;

/// The difference of two means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// First less second, in the SI unit.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
    /// Degrees of freedom of the error.
    pub freedom: f64,
}

impl Difference {
    /// `first` less `second`; none where the error of either is not known.
    pub fn between(first: Estimate, second: Estimate) -> Option<Self> {
        let [a, b] = [first.error?, second.error?].map(|error| error * error);
        let part = |square: f64, mean: Estimate| square * square / mean.freedom.max(1) as f64;
        Some(Self {
            value: first.mean - second.mean,
            error: (a + b).sqrt(),
            freedom: if a + b > 0.0 {
                (a + b) * (a + b) / (part(a, first) + part(b, second))
            } else {
                1.0
            },
        })
    }

    /// `mean` less a number that has no error, such as a law's.
    pub fn from_number(mean: Estimate, number: f64) -> Option<Self> {
        Some(Self {
            value: mean.mean - number,
            error: mean.error?,
            freedom: mean.freedom.max(1) as f64,
        })
    }

    /// How often two equal means come to lie this far apart by chance, 0 … 1.
    pub fn probability(&self) -> f64 {
        match (self.value == 0.0, self.error > 0.0) {
            (true, _) => 1.0,
            (false, false) => 0.0,
            (false, true) => both_tails((self.value / self.error).abs(), self.freedom),
        }
    }

    /// Whether it is more than scatter: chance makes it in less than one case of twenty.
    pub fn is_significant(&self) -> bool {
        self.probability() < SIGNIFICANCE
    }

    /// From where to where the true difference lies in 95 of 100 cases.
    pub fn interval(&self) -> (f64, f64) {
        let half = quantile(SIGNIFICANCE, self.freedom) * self.error;
        (self.value - half, self.value + half)
    }
}

/// What `right` less `left` comes to, in words: `θ differs by 1.3° ± 0.5°: more than scatter`.
pub fn difference_in_words(key: ResultKey, left: Estimate, right: Estimate) -> String {
    let quantity = key.quantity();
    let name = if quantity.symbol.is_empty() {
        key.label()
    } else {
        quantity.symbol.to_owned()
    };
    let Some(difference) = Difference::between(right, left) else {
        let shorter = if left.error.is_none() { left } else { right };
        let reason = shorter.reason().unwrap_or_else(|| "no value".to_owned());
        return format!("{name}: not decided ({reason})");
    };
    let text = quantity.text_with_error(difference.value, difference.error);
    let word = if difference.is_significant() {
        "more than scatter"
    } else {
        "within scatter"
    };
    format!("{name} differs by {text}: {word}")
}

/// Probability of Student's distribution with `freedom` degrees of freedom beyond `t` on both
/// sides.
fn both_tails(t: f64, freedom: f64) -> f64 {
    incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t))
}

/// The `t` beyond which, on both sides, that distribution has this `probability`.
fn quantile(probability: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1e6);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if both_tails(middle, freedom) > probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The regularised incomplete beta function `I_x(a, b)`.
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    // The fraction converges fast below the mean; above it the other tail does.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta_below(b, a, 1.0 - x);
    }
    incomplete_beta_below(a, b, x)
}

/// The same by its continued fraction (DLMF 8.17.22), from the last term to the first.
fn incomplete_beta_below(a: f64, b: f64, x: f64) -> f64 {
    const TERMS: i32 = 200;
    let term = |k: i32| {
        let m = f64::from(k / 2);
        if k % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        }
    };
    let fraction = (1..=TERMS).rev().fold(1.0, |rest, k| 1.0 + term(k) / rest);
    let beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    (a * x.ln() + b * (1.0 - x).ln() - beta).exp() / (a * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Measure;

    fn mean(mean: f64, error: f64, freedom: usize) -> Estimate {
        Estimate {
            mean,
            error: Some(error),
            samples: freedom + 1,
            freedom,
        }
    }

    /// Tables of Student's distribution: the bounds of 95 %.
    #[test]
    fn students_distribution_has_its_known_bounds() {
        for (freedom, bound) in [
            (1.0, 12.706),
            (2.0, 4.303),
            (5.0, 2.571),
            (10.0, 2.228),
            (30.0, 2.042),
            (1e6, 1.960),
        ] {
            assert!((quantile(0.05, freedom) - bound).abs() < 6e-4, "{freedom}");
        }
        // One degree of freedom is Cauchy's distribution: 1 − (2/π) atan t.
        for t in [0.1_f64, 1.0, 7.0] {
            let cauchy = 1.0 - t.atan() * std::f64::consts::FRAC_2_PI;
            assert!((both_tails(t, 1.0) - cauchy).abs() < 1e-12);
        }
    }

    /// The data of B. L. Welch's problem as R's `t.test` takes them: t = −4.0312, ν = 14.497, p =
    /// 0.00116.
    #[test]
    fn welchs_test_gives_what_r_gives() {
        let a = [5.1, 4.9, 6.2, 5.5, 5.8, 6.0, 4.7, 5.3];
        let b = [6.1, 5.9, 7.0, 6.5, 6.8, 7.2, 5.7, 6.3, 6.6];
        let difference = Difference::between(Estimate::of_runs(&a), Estimate::of_runs(&b));
        let difference = difference.unwrap();
        assert!((difference.value / difference.error + 4.031_203_5).abs() < 1e-6);
        assert!((difference.freedom - 14.496_687).abs() < 1e-5);
        assert!((difference.probability() - 0.001_159_450).abs() < 1e-8);
        let (low, high) = difference.interval();
        assert!((low + 1.557_972_3).abs() < 1e-6 && (high + 0.478_138_8).abs() < 1e-6);
    }

    #[test]
    fn a_difference_is_told_in_words() {
        let key = ResultKey::OfSamples(Measure::SurfaceAngle);
        let degrees = |value: f64, error: f64| mean(value.to_radians(), error.to_radians(), 9);
        let say = |left, right| difference_in_words(key, left, right);
        let (a, b) = (degrees(28.3, 0.3), degrees(29.6, 0.4));
        assert_eq!(say(a, b), "θ differs by 1.3° ± 0.5°: more than scatter");
        let near = degrees(28.6, 0.4);
        assert_eq!(say(a, near), "θ differs by 0.3° ± 0.5°: within scatter");
        let short = Estimate::too_short(0.5, 3);
        assert_eq!(
            say(a, short),
            "θ: not decided (too short: 3 independent samples)"
        );
    }

    #[test]
    fn exact_means_differ_or_do_not() {
        let exact = |value| mean(value, 0.0, 99);
        let same = Difference::between(exact(1.0), exact(1.0)).unwrap();
        assert!(!same.is_significant());
        let other = Difference::between(exact(1.0), exact(0.9)).unwrap();
        assert!(other.is_significant());
    }
}
