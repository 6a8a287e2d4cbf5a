//! Tangential springs: the elastic part of what one grain's surface has slipped over another's, the
//! history of a contact.
//!
//! In: springs of the last step, the slip of this one, the Coulomb bound. Out: springs now and the
//! energy they lost. Used for contacts of spheres and of polyhedra alike. Not here: the tangential
//! dashpot, which is the contact law's.

use super::row::Row;
use crate::lanes::{Lanes, Rows, WIDEST, dot, minus, plus, times};

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

/// Updates the springs `old` (with the stiffness of the last update) by what has `slipped`, turns
/// them into the tangent plane and caps them by Coulomb's law: where the pull would exceed `bound`,
/// the contact slides and the spring is shortened to that pull. `stiffness` is none where grains do
/// not touch; the spring is forgotten there.
#[inline(always)]
pub fn update<N: Lanes>(
    processor: N::Processor,
    old: Rows,
    slipped: [N; 3],
    normal: [N; 3],
    touching: N::Mask,
    stiffness: N,
    bound: N,
) -> Springs<N> {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let [x, y, z, old_stiffness] = N::gather(processor, old);
    let old_spring = [x, y, z];
    let trial = plus(old_spring, slipped);
    let old_work = old_stiffness * dot(old_spring, trial);
    let trial = minus(trial, times(normal, dot(trial, normal)));
    let pull = stiffness * dot(trial, trial).sqrt();
    let slides = pull.exceeds(bound);
    let kept = N::choose(touching, N::choose(slides, bound / pull, one), zero);
    let spring = times(trial, kept);
    // What the mean of the old and the new spring's pull does along the slip, less the change of
    // what they store.
    let new_work = stiffness * dot(spring, minus(slipped, spring));
    Springs {
        spring,
        rows: N::rows([spring[0], spring[1], spring[2], stiffness]),
        slides,
        lost: N::splat(processor, 0.5) * (old_work + new_work),
    }
}
