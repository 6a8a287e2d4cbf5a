//! The flowing layer in two numbers: how fast it flows at the surface, how deep it reaches.
//!
//! In: mean velocities along the surface over the depth below it. Out: a [`FlowingLayer`].

use super::estimate::Estimate;

/// How a bed flows on the mean, over the time in which it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowingLayer {
    /// Speed along the middle of the surface [m/s].
    pub speed: Estimate,
    /// Depth at which the velocity along the surface changes its sign [m], as grains go down the slope
    /// above and up with the drum below; none where it never does.
    pub depth: Option<Estimate>,
}

impl FlowingLayer {
    /// The layer of a `profile` from the surface down, depths [m] with mean velocities [m/s]; none of
    /// an empty one.
    pub fn of(profile: &[(f64, Estimate)]) -> Option<Self> {
        let (_, surface) = profile.first()?;
        let mut neighbours = profile.windows(2);
        let crossing = neighbours.find(|pair| pair[0].1.mean * pair[1].1.mean <= 0.0);
        Some(Self {
            speed: surface.times(if surface.mean < 0.0 { -1.0 } else { 1.0 }),
            depth: crossing.map(|pair| zero_between(pair[0], pair[1])),
        })
    }
}

/// The depth between two depths at which the velocity is zero, its error that of the velocity there
/// over the slope.
fn zero_between(above: (f64, Estimate), below: (f64, Estimate)) -> Estimate {
    let ((from, first), (to, second)) = (above, below);
    let change = first.mean - second.mean;
    // Zero at both is zero at the first.
    let share = if change == 0.0 {
        0.0
    } else {
        first.mean / change
    };
    let error = first.error.zip(second.error).filter(|_| change != 0.0);
    let error = error.map(|(first, second)| {
        let own = first + share * (second - first);
        (own * (to - from) / change).abs()
    });
    Estimate {
        error,
        samples: first.samples.min(second.samples),
        freedom: first.freedom.min(second.freedom),
        mean: from + share * (to - from),
    }
}
