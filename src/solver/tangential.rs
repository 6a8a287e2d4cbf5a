//! Tangential springs: the elastic part of what one grain's surface has slipped over another's, the
//! history of a contact.
//!
//! In: springs of the last step, the slip of this one, the Coulomb bound. Out: springs now and the
//! energy they lost. Used for contacts of spheres and of polyhedra alike.
//!
//! What a contact remembers lies on its surfaces and turns with them: it is kept in the tangent
//! plane, which turns with the normal, and turned about the normal by the mean of both sides' spins
//! ([`turned`]). So bodies that turn as one keep their forces in the frame that turns with them,
//! whichever way their normals point.
//!
//! Not here: the tangential dashpot, which is the contact law's.

use super::row::Row;
use crate::lanes::{Lanes, Rows, WIDEST, cross, dot, minus, plus, times};

/// A spring that nothing has pulled, as memory holds it.
pub const UNLOADED: Row = [0.0; 4];

/// Tangential springs after a step.
pub struct Springs<N: Lanes> {
    /// The springs [m].
    pub spring: [N; 3],
    /// The springs, and the stiffness with which each was updated [N/m]; the first [`Lanes::COUNT`]
    /// count.
    pub rows: [N::Quad; WIDEST],
    /// Where the contact slides.
    pub slides: N::Mask,
    /// Energy that the springs lost [J].
    pub lost: N,
}

/// The vectors across `normal` that contacts remember, turned about it by the small angle `twist`
/// `φ`: `(1 − φ²/2) ξ + φ n × ξ`, as long as they were but for terms of fourth order.
#[inline(always)]
pub fn turned<N: Lanes>(
    processor: N::Processor,
    remembered: [N; 3],
    normal: [N; 3],
    twist: N,
) -> [N; 3] {
    let (half, one) = (N::splat(processor, 0.5), N::splat(processor, 1.0));
    let across = times(cross(normal, remembered), twist);
    plus(times(remembered, one - half * twist * twist), across)
}

/// What happens to contacts along their surfaces during a step.
pub struct Slip<N> {
    /// Way of the first surfaces over the second [m].
    pub way: [N; 3],
    /// Angle by which the contacts turn about their normals `n`, `½ (ω₁ + ω₂)·n Δt` for the spins
    /// of both sides [rad].
    pub twist: N,
}

/// Updates the springs `old` (with the stiffness of the last update) by a step's `slip`: turns them
/// with the contact and into the tangent plane, adds the way and caps them by Coulomb's law: where
/// the pull would exceed `bound`, the contact slides and the spring is shortened to that pull.
/// `stiffness` is none where grains do not touch; the spring is forgotten there.
#[inline(always)]
pub fn update<N: Lanes>(
    processor: N::Processor,
    old: Rows,
    slip: Slip<N>,
    normal: [N; 3],
    touching: N::Mask,
    stiffness: N,
    bound: N,
) -> Springs<N> {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let [x, y, z, old_stiffness] = N::gather(processor, old);
    let old_spring = turned(processor, [x, y, z], normal, slip.twist);
    let trial = plus(old_spring, slip.way);
    let old_work = old_stiffness * dot(old_spring, trial);
    let trial = minus(trial, times(normal, dot(trial, normal)));
    let pull = stiffness * dot(trial, trial).sqrt();
    let slides = pull.exceeds(bound);
    let kept = N::choose(touching, N::choose(slides, bound / pull, one), zero);
    let spring = times(trial, kept);
    // What the mean of the old and the new spring's pull does along the slip, less the change of
    // what they store.
    let new_work = stiffness * dot(spring, minus(slip.way, spring));
    Springs {
        spring,
        rows: N::rows([spring[0], spring[1], spring[2], stiffness]),
        slides,
        lost: N::splat(processor, 0.5) * (old_work + new_work),
    }
}
