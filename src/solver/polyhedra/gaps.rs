//! Gaps of pairs that close within a step, in the joint solution of springs and dashpots.
//!
//! In: nearest points that do not touch but will at the pace of half a step ago. Out: what they add
//! to the matrices of their pairs; and which of them stay open after all.
//!
//! A contact that begins within a step and is seen at its end only is too deep by then: its dashpot
//! has missed the way from the surface, spring and friction have to make up for it. So a gap, of
//! overlap `δ < 0`, that closes by more than `−δ` within the step presses already in this step by the
//! overlap that it comes to,
//!
//! ```text
//! [(2θ − 1) c/Δt + σ K_n] (δ + Δt w·u⁺).
//! ```
//!
//! With the next step, which takes the dashpot by `(1 − θ) u⁻ + θ u⁺`, this is, on the mean of all
//! moments of a step in which it may begin, the impulse of a dashpot on the way from the surface:
//! `(2θ − 1) c δ'` now and `2 (1 − θ) c δ'` then, of the overlap `δ'` at the end of this step. Soft
//! dashpots, `θ = ½`, need nothing of this, and it is of second order in the step.
//!
//! Other contacts may hold the bodies back, so that a gap stays open: it must not pull. Those
//! that do when all are solved together are let go, and what is left is solved again.
//!
//! Not here: which features are measured ([`super::workspace`]), the solution ([`super::joint`]).

use super::implicit_contact::ImplicitContact;
use super::matrix::{Packed, ROWS, entry};
use crate::lanes::Row;

/// A gap that closes within a step at the pace of half a step ago.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// Unit normal; overlap, which is negative [m].
    normal: Row,
    /// The arm across the normal [m]; the spring, none where the gap stays open [N/m].
    moment: Row,
}

impl Gap {
    /// That of a `contact`, if it is one.
    #[inline(always)]
    pub fn of(contact: &ImplicitContact) -> Option<Self> {
        let ([nx, ny, nz, _], [tx, ty, tz, _]) = (contact.normal, contact.moment);
        let [spring, overlap, ..] = contact.closing;
        (spring > 0.0).then_some(Self {
            normal: [nx, ny, nz, overlap],
            moment: [tx, ty, tz, spring],
        })
    }

    /// Lets it stay open where the pair's relative `[velocity, spin]` does not close it within `dt`;
    /// true where that is new.
    #[inline(always)]
    pub fn let_open(&mut self, [velocity, spin]: &[Row; 2], dt: f64) -> bool {
        let ([nx, ny, nz, overlap], [tx, ty, tz, spring]) = (self.normal, self.moment);
        let approach = (nx * velocity[0] + ny * velocity[1] + nz * velocity[2])
            + (tx * spin[0] + ty * spin[1] + tz * spin[2]);
        let opens = spring > 0.0 && overlap + dt * approach < 0.0;
        if opens {
            self.moment[3] = 0.0;
        }
        opens
    }
}

/// The gaps of a pair that close within a step, together.
#[derive(Clone, Copy, Debug)]
pub struct ClosingGaps {
    /// `Σ K_n w wᵀ` [N/m, N, N m].
    pub springs: [Row; ROWS],
    /// `Σ K_n δ w` [N, N m].
    pub push: [Row; 2],
}

impl ClosingGaps {
    /// Those of these `gaps`.
    #[inline(always)]
    pub fn of(gaps: &[Gap]) -> Self {
        let mut springs: Packed = [0.0; 4 * ROWS];
        let mut push = [[0.0; 4]; 2];
        for gap in gaps {
            let ([nx, ny, nz, overlap], [tx, ty, tz, spring]) = (gap.normal, gap.moment);
            let along = [nx, ny, nz, tx, ty, tz];
            for i in 0..6 {
                let scaled = spring * along[i];
                push[i / 3][i % 3] += overlap * scaled;
                for j in 0..=i {
                    springs[entry(i, j)] += scaled * along[j];
                }
            }
        }
        Self {
            springs: std::array::from_fn(|k| [0, 1, 2, 3].map(|i| springs[4 * k + i])),
            push,
        }
    }
}
