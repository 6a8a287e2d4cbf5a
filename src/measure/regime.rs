//! How a bed in a drum moves, in the three words of Kasper et al. 2021.
//!
//! In: the non-rigid share, as the turning drum sees it, and the mean drop of a window of a run.
//! Out: a [`Regime`].

/// A bed that flows for a smaller share of the time than this avalanches.
const AVALANCHING_BELOW: f64 = 0.9;
/// A bed that flows for at least this share of the time may be continuous …
const CONTINUOUS_FROM: f64 = 0.99;
/// … if its drops are smaller than this [rad].
const CONTINUOUS_DROP: f64 = 2.5 * std::f64::consts::PI / 180.0;

/// How a bed moves in a drum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Regime {
    /// It rests between avalanches.
    Avalanching,
    /// It hardly rests.
    Transitional,
    /// It flows all the time, without large drops.
    Continuous,
}

impl Regime {
    /// The words for them, in order.
    pub const WORDS: [&'static str; 3] = ["avalanching", "transitional", "continuous"];

    /// The regime of a bed that flows for this share of the time (0 … 1), with avalanches of this
    /// mean drop [rad], 0 where there are none.
    pub fn of(non_rigid_share: f64, drop: f64) -> Self {
        if non_rigid_share < AVALANCHING_BELOW {
            Self::Avalanching
        } else if non_rigid_share >= CONTINUOUS_FROM && drop < CONTINUOUS_DROP {
            Self::Continuous
        } else {
            Self::Transitional
        }
    }

    /// The word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::Regime;

    #[test]
    fn a_bed_is_continuous_only_with_small_drops() {
        let degrees = |angle: f64| angle.to_radians();
        assert_eq!(Regime::of(0.5, degrees(8.0)).word(), "avalanching");
        assert_eq!(Regime::of(0.95, 0.0).word(), "transitional");
        assert_eq!(Regime::of(1.0, degrees(3.0)).word(), "transitional");
        assert_eq!(Regime::of(1.0, degrees(2.0)).word(), "continuous");
    }
}
