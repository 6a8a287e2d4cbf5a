//! Avalanches: the extrema of θ(t).
//!
//! θ is smoothed by a centred moving average over [`SMOOTHING_TIME`]; then maxima and minima
//! alternate, each confirmed once the curve has turned back by the smallest drop. An avalanche runs
//! from a maximum to the following minimum. One that is still under way at the end, or was already
//! under way at the beginning, is not reported: one of its ends is unknown.

use serde::{Deserialize, Serialize};

/// Time over which θ is averaged before its extrema are sought [s].
pub const SMOOTHING_TIME: f64 = 0.1;

/// Smallest drop of the surface that counts as an avalanche where nothing else is said [rad], 1°.
pub const SMALLEST_DROP: f64 = std::f64::consts::PI / 180.0;

/// A fall of the surface angle from a maximum to a minimum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Avalanche {
    /// Time of the maximum [s].
    pub start: f64,
    /// Time of the minimum [s].
    pub end: f64,
    /// Angle at the maximum, `θ_m` [rad].
    pub theta_m: f64,
    /// Angle at the minimum, `θ_r` [rad].
    pub theta_r: f64,
}

impl Avalanche {
    /// `Δθ = θ_m − θ_r` [rad].
    pub fn drop(&self) -> f64 {
        self.theta_m - self.theta_r
    }
}

/// The avalanches in `theta` [rad] over `time` [s] whose drop is at least `smallest_drop` [rad].
///
/// Samples that are not finite, or that one of the two lacks, are passed over. The work is linear
/// in the number of samples.
pub fn avalanches(time: &[f64], theta: &[f64], smallest_drop: f64) -> Vec<Avalanche> {
    let mut found = Vec::new();
    let mut tracker = Tracker::default();
    let count = time.len().min(theta.len());
    for (at, angle) in smoothed(&time[..count], &theta[..count]) {
        found.extend(tracker.follow(Point { at, angle }, smallest_drop));
    }
    found
}

/// Finite samples of `values` over `time`, each averaged with its neighbours within half of
/// [`SMOOTHING_TIME`].
fn smoothed<'a>(time: &'a [f64], values: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    let half = 0.5 * SMOOTHING_TIME;
    let (mut first, mut end) = (0, 0);
    time.iter().enumerate().filter_map(move |(i, &at)| {
        while time[first] < at - half {
            first += 1;
        }
        while end < time.len() && time[end] <= at + half {
            end += 1;
        }
        let (sum, count) = values[first..end]
            .iter()
            .filter(|value| value.is_finite())
            .fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
        values[i].is_finite().then(|| (at, sum / f64::from(count)))
    })
}

#[derive(Clone, Copy)]
struct Point {
    at: f64,
    angle: f64,
}

/// Where the curve stands between two extrema.
#[derive(Clone, Copy, Default)]
enum Tracker {
    /// Nothing seen.
    #[default]
    Start,
    /// Neither extremum is known yet: the first, the highest and the lowest point so far.
    Undecided {
        first: Point,
        highest: Point,
        lowest: Point,
    },
    /// Since the last minimum the curve has risen by the smallest drop; the highest point so far.
    Rising { highest: Point },
    /// Since `maximum` (none if the curve began by falling) it has fallen by as much; the lowest
    /// point so far.
    Falling {
        maximum: Option<Point>,
        lowest: Point,
    },
}

impl Tracker {
    /// Takes the next point; an avalanche whose minimum it confirms.
    fn follow(&mut self, point: Point, smallest_drop: f64) -> Option<Avalanche> {
        let higher = |a: Point| if point.angle > a.angle { point } else { a };
        let lower = |a: Point| if point.angle < a.angle { point } else { a };
        let mut ended = None;
        *self = match *self {
            Self::Start => Self::Undecided {
                first: point,
                highest: point,
                lowest: point,
            },
            Self::Undecided {
                highest, lowest, ..
            } if point.angle - lowest.angle >= smallest_drop => Self::Rising {
                highest: higher(highest),
            },
            Self::Undecided { first, highest, .. }
                if highest.angle - point.angle >= smallest_drop =>
            {
                Self::Falling {
                    maximum: (highest.at > first.at).then_some(highest),
                    lowest: point,
                }
            }
            Self::Undecided {
                first,
                highest,
                lowest,
            } => Self::Undecided {
                first,
                highest: higher(highest),
                lowest: lower(lowest),
            },
            Self::Rising { highest } if highest.angle - point.angle >= smallest_drop => {
                Self::Falling {
                    maximum: Some(highest),
                    lowest: point,
                }
            }
            Self::Rising { highest } => Self::Rising {
                highest: higher(highest),
            },
            Self::Falling { maximum, lowest } if point.angle - lowest.angle >= smallest_drop => {
                ended = maximum.map(|maximum| Avalanche {
                    start: maximum.at,
                    end: lowest.at,
                    theta_m: maximum.angle,
                    theta_r: lowest.angle,
                });
                Self::Rising { highest: point }
            }
            Self::Falling { maximum, lowest } => Self::Falling {
                maximum,
                lowest: lower(lowest),
            },
        };
        ended
    }
}
