//! What becomes of a statement when it is set beside means with errors: the rules, in one place.
//!
//! In: means with their errors. Out: a [`Verdict`]. Nothing is judged by eye.
//!
//! | statement | holds | does not hold |
//! |---|---|---|
//! | *a is larger than b* | it is, by more than scatter | it is smaller, by more than scatter |
//! | *a lies between two bounds* | the 95 % interval of a lies between them | it lies wholly outside |
//! | *a series rises* | its end lies above its beginning, and no step falls, by more than scatter | its end lies below its beginning, by more than scatter |
//! | *a series stays level to within a tolerance* | the 95 % interval of each difference from its mean lies within | one lies wholly outside |
//! | *all of several* | each holds | none holds, and one does not |
//!
//! *In part* is a series that rises as a whole and falls by more than scatter on the way, and
//! several statements of which some hold and some do not. Whatever the rules leave open is *not
//! decided*: it takes more seeds or longer runs. *More than scatter* is Welch's test at 5 %
//! ([`Difference`]); where an error is not known, nothing is decided.

use super::difference::Difference;
use super::estimate::Estimate;
use std::ops::Range;

/// What becomes of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// It is so.
    Holds,
    /// Some of it is so, and some is not.
    InPart,
    /// It is not so.
    DoesNot,
    /// Scatter is too large to say.
    NotDecided,
}

impl Verdict {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::InPart => "in part",
            Self::DoesNot => "does not hold",
            Self::NotDecided => "not decided",
        }
    }

    /// *`first` is larger than `second`.*
    pub fn of_larger(first: Estimate, second: Estimate) -> Self {
        Self::of_positive(Difference::between(first, second))
    }

    /// *`mean` lies within `bounds`.*
    pub fn of_between(mean: Estimate, bounds: Range<f64>) -> Self {
        let Some(difference) = Difference::from_number(mean, 0.0) else {
            return Self::NotDecided;
        };
        let (low, high) = difference.interval();
        if low >= bounds.start && high <= bounds.end {
            Self::Holds
        } else if high < bounds.start || low > bounds.end {
            Self::DoesNot
        } else {
            Self::NotDecided
        }
    }

    /// *The `series` rises.* Of fewer than two means nothing is decided.
    pub fn of_rising(series: &[Estimate]) -> Self {
        let [first, .., last] = series else {
            return Self::NotDecided;
        };
        let step = |pair: &[Estimate]| Self::of_larger(pair[1], pair[0]);
        let falls = series.windows(2).any(|pair| step(pair) == Self::DoesNot);
        match Self::of_larger(*last, *first) {
            Self::Holds if falls => Self::InPart,
            whole => whole,
        }
    }

    /// *The `series` falls.*
    pub fn of_falling(series: &[Estimate]) -> Self {
        let reversed: Vec<Estimate> = series.iter().rev().copied().collect();
        Self::of_rising(&reversed)
    }

    /// *The `series` stays level to within `tolerance`*, to either side of its mean.
    pub fn of_level(series: &[Estimate], tolerance: f64) -> Self {
        if series.len() < 2 {
            return Self::NotDecided;
        }
        let mean = series.iter().map(|own| own.mean).sum::<f64>() / series.len() as f64;
        let bounds = mean - tolerance..mean + tolerance;
        let each: Vec<Self> = (series.iter())
            .map(|own| Self::of_between(*own, bounds.clone()))
            .collect();
        match Self::of_all(&each) {
            Self::InPart => Self::DoesNot,
            verdict => verdict,
        }
    }

    /// *All of these.* Of none nothing is decided.
    pub fn of_all(parts: &[Self]) -> Self {
        let some = |verdict: Self| parts.contains(&verdict);
        let holds = some(Self::Holds) || some(Self::InPart);
        let fails = some(Self::DoesNot) || some(Self::InPart);
        if holds && fails {
            Self::InPart
        } else if some(Self::DoesNot) {
            Self::DoesNot
        } else if some(Self::NotDecided) || parts.is_empty() {
            Self::NotDecided
        } else {
            Self::Holds
        }
    }

    fn of_positive(difference: Option<Difference>) -> Self {
        match difference {
            Some(difference) if difference.is_significant() => {
                if difference.value > 0.0 {
                    Self::Holds
                } else {
                    Self::DoesNot
                }
            }
            _ => Self::NotDecided,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Verdict::{self, DoesNot, Holds, InPart, NotDecided};
    use super::*;

    /// A mean of ten runs.
    fn mean(mean: f64, error: f64) -> Estimate {
        Estimate {
            mean,
            error: Some(error),
            samples: 10,
            freedom: 9,
        }
    }

    #[test]
    fn larger_is_decided_by_more_than_scatter() {
        let larger = |a, b| Verdict::of_larger(mean(a, 0.3), mean(b, 0.4));
        assert_eq!(larger(29.6, 28.3), Holds);
        assert_eq!(larger(28.3, 29.6), DoesNot);
        assert_eq!(larger(28.6, 28.3), NotDecided);
        let unknown = Estimate::too_short(40.0, 3);
        assert_eq!(Verdict::of_larger(unknown, mean(1.0, 0.1)), NotDecided);
    }

    #[test]
    fn bounds_hold_the_whole_interval_or_none_of_it() {
        // 95 % of ten runs are 2.26 errors.
        let between = |value, error| Verdict::of_between(mean(value, error), 0.5..0.7);
        assert_eq!(between(0.6, 0.04), Holds);
        assert_eq!(between(0.6, 0.05), NotDecided);
        assert_eq!(between(0.8, 0.04), DoesNot);
        assert_eq!(between(0.78, 0.04), NotDecided);
    }

    #[test]
    fn a_series_rises_as_a_whole_and_step_by_step() {
        let series = |values: &[f64]| -> Vec<Estimate> {
            values.iter().map(|value| mean(*value, 0.1)).collect()
        };
        assert_eq!(Verdict::of_rising(&series(&[1.0, 2.0, 1.95, 3.0])), Holds);
        assert_eq!(Verdict::of_rising(&series(&[1.0, 4.0, 2.0])), InPart);
        assert_eq!(Verdict::of_rising(&series(&[3.0, 1.0])), DoesNot);
        assert_eq!(Verdict::of_falling(&series(&[3.0, 1.0])), Holds);
        assert_eq!(Verdict::of_rising(&series(&[1.0, 1.1])), NotDecided);
        assert_eq!(Verdict::of_rising(&series(&[1.0])), NotDecided);
        assert_eq!(Verdict::of_level(&series(&[1.0, 1.2, 1.1]), 0.5), Holds);
        assert_eq!(Verdict::of_level(&series(&[1.0, 3.0]), 0.5), DoesNot);
        assert_eq!(Verdict::of_level(&series(&[1.0, 1.2]), 0.2), NotDecided);
    }

    #[test]
    fn several_hold_together_or_in_part() {
        assert_eq!(Verdict::of_all(&[Holds, Holds]), Holds);
        assert_eq!(Verdict::of_all(&[Holds, NotDecided]), NotDecided);
        assert_eq!(Verdict::of_all(&[Holds, NotDecided, DoesNot]), InPart);
        assert_eq!(Verdict::of_all(&[DoesNot, NotDecided]), DoesNot);
        assert_eq!(Verdict::of_all(&[InPart]), InPart);
        assert_eq!(Verdict::of_all(&[]), NotDecided);
    }
}
