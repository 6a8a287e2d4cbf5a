//! Rolling friction of constant directional torque, Eq. 10 of Kasper et al. 2021, without jitter
//! and without creep at rest.
//!
//! `q = −μ_R k_n δ r* ω/|ω|` with ω the spin relative to the partner, a turning wall too. At rest
//! Eq. 10 leaves the torque open: it is whatever holds the grain, up to that bound. So a contact
//! remembers its torque and changes it by no more than stops, within one step, the spin that the
//! grain would have if the torque stayed: with that spin ω, the torque `q₀` so far and the
//! compliance `C` (time step times contact count over inertia, summed over both sides) the torque
//! is `q₀ − ω/C`, cut to the bound. A contact that rolls has the torque of Eq. 10 after some steps;
//! a grain at rest finds the torque that holds it and neither trembles nor rolls on.
//!
//! Stable for any number of contacts: a step changes spins by `−L ω` with `0 ≤ L ≤ 1`, as
//! `Σ (ω_i − ω_j)²/(n_i/I_i + n_j/I_j) ≤ Σ (I_i ω_i²/n_i + I_j ω_j²/n_j) = Σ I ω²` over the
//! contacts of grains with `n` contacts each.
//!
//! Without the memory, a torque `−ω/C` alone holds a grain that is pulled by a torque T only while
//! it rolls, at up to `Σ n T Δt/I`.

use crate::lanes::Lanes;

/// The factor `g` in `q = −g ω` [N m s]: `cap/|ω|` for the full torque `cap` [N m], or
/// `1/compliance` where that would overshoot. `speed` is |ω| [rad/s].
#[inline(always)]
pub fn rolling_gain<N: Lanes>(cap: N, compliance: N, speed: N, zero: N, one: N) -> N {
    let stopped = cap * compliance;
    let slowest = N::choose(speed.exceeds(stopped), speed, stopped);
    cap / N::choose(slowest.exceeds(zero), slowest, one)
}
