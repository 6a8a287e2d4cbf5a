//! Tangential springs: the history of a contact.

use super::lanes::{Lanes, Row, Rows, WIDEST, dot, minus, plus, times};

/// Tangential springs after a step.
pub struct Springs<N: Lanes> {
    /// The springs [m].
    pub spring: [N; 3],
    /// The springs, and the stiffness with which each was stretched [N/m]; the first [`Lanes::COUNT`] count.
    pub rows: [N::Quad; WIDEST],
    /// Where the contact slides.
    pub slides: N::Mask,
    /// Energy that the springs lost [J].
    pub lost: N,
}

/// Stretches the springs `old` (with the stiffness of the last stretch) by what has `slipped`, turns them into the tangent
/// plane and lets those slide whose pull would exceed `bound`; `stiffness` is none where grains do not touch.
#[inline(always)]
pub fn stretch<N: Lanes>(
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
    let stretched = plus(old_spring, slipped);
    let old_work = old_stiffness * dot(old_spring, stretched);
    let stretched = minus(stretched, times(normal, dot(stretched, normal)));
    let trial = stiffness * dot(stretched, stretched).sqrt();
    let slides = trial.exceeds(bound);
    let [x, y, z] = times(stretched, N::choose(slides, bound / trial, one));
    // Chosen, not multiplied: a zero's sign would tell where the spring has been.
    let spring = [
        N::choose(touching, x, zero),
        N::choose(touching, y, zero),
        N::choose(touching, z, zero),
    ];
    // What the mean of the old and the new spring's pull does along the slip, less the change of what they store.
    let new_work = stiffness * dot(spring, minus(slipped, spring));
    Springs {
        spring,
        rows: N::rows([spring[0], spring[1], spring[2], stiffness]),
        slides,
        lost: N::splat(processor, 0.5) * (old_work + new_work),
    }
}

/// A spring as memory holds it.
pub const UNLOADED: Row = [0.0; 4];
