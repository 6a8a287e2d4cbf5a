//! Rolling friction of constant directional torque, Eq. 10 of Kasper et al. 2021, without jitter at
//! rest.
//!
//! `q = −μ_R k_n δ r* ω/|ω|` with ω the spin relative to the partner, a turning wall too. The
//! torque never exceeds what stops that spin within one step: ω is the spin the grain would have
//! after the step without rolling friction, and a torque `|ω|/C` just stops it, with `C` the
//! compliance: time step times contact count over inertia, summed over both sides. So a grain on a
//! slope below tan⁻¹ `μ_R` stands still instead of trembling.

use crate::lanes::Lanes;

/// The factor `g` in `q = −g ω` [N m s]: `cap/|ω|` for the full torque `cap` [N m], or
/// `1/compliance` where that would overshoot. `speed` is |ω| [rad/s].
#[inline(always)]
pub fn rolling_gain<N: Lanes>(cap: N, compliance: N, speed: N, zero: N, one: N) -> N {
    let stopped = cap * compliance;
    let slowest = N::choose(speed.exceeds(stopped), speed, stopped);
    cap / N::choose(slowest.exceeds(zero), slowest, one)
}
