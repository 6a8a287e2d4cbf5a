//! Rolling friction of constant directional torque, Eq. 10 of Kasper et al. 2021, without jitter at rest.
//!
//! `q = −μ_R k_n δ r* ω/|ω|` with ω the spin relative to the partner, a turning wall too. The torque never exceeds what
//! stops that spin within one step: ω is the spin the grain would have after the step without rolling friction, and a
//! torque `J |ω|`, with `J` the inertia per contact over the step, just stops it. So a grain on a slope below tan⁻¹ μ_R
//! stands still instead of trembling.

use crate::solver::lanes::Lanes;

/// The factor `g` in `q = −g ω` [N m s]: `cap/|ω|` for the full torque `cap` [N m], or `stopping` [N m s] where that
/// would overshoot. `speed` is |ω| [rad/s].
#[inline(always)]
pub fn rolling_gain<N: Lanes>(cap: N, stopping: N, speed: N) -> N {
    N::choose((stopping * speed).exceeds(cap), cap / speed, stopping)
}
