//! Linear springs and dashpots along and across the normal, for spheres (Cundall & Strack 1979;
//! Schäfer, Dippel & Wolf, J. Phys. I France 6, 1996, Sect. 3).
//!
//! `F_n = K_n δ + c_n v_n`, `F_t = K_t ξ + c_t v_t`, sliding where `K_t ξ` reaches `μ K_n δ`, with
//! `c = 2 ζ √(m K)` and `ζ = −ln e/√(π² + ln² e)`. Normal: `m = m*`. The attraction that the
//! dashpot makes at the end of a contact is kept, so that the restitution is e at any speed and a
//! contact lasts `π/(ω √(1 − ζ²))`, `ω = √(K_n/m*)`. Tangential: `m = 2/7 m*`, what the surfaces of
//! solid spheres resist a force with, so that both motions have one damping ratio; with
//! `K_t = 2/7 K_n` also one period, and the surfaces of a contact that sticks part with `−e` times
//! the velocity they met with.
//!
//! Not here: polyhedra, whose surfaces resist with another mass.

use super::{
    Circumstances, Coefficients, Law, LawFacts, LawMistake, LawWords, Pairing, SmallestGrain,
    StepLimit, mistaken_spring, natural_log,
};
use crate::lanes::{Lanes, Row};
use crate::physics::Materials;
use std::f64::consts::PI;

/// The law, its numbers as [`super::ContactLaw::SpringDashpot`] states them.
#[derive(Clone, Copy, Debug)]
pub struct SpringDashpot {
    /// `K_n` of a contact [N/m].
    pub normal_stiffness: f64,
    /// `K_t` of a contact [N/m].
    pub tangential_stiffness: f64,
}

/// Mass with which the surfaces of two solid spheres resist a force across the normal, over `m*`:
/// `1/(1 + m r²/I)`.
const SURFACE_MASS: f64 = 2.0 / 7.0;

/// Steps that half a period of either spring must last at least.
const STEPS_PER_HALF_PERIOD: f64 = 20.0;

impl LawFacts for SpringDashpot {
    /// `K_n`, `c_n`, `K_t`, `c_t` of a pair.
    fn constants(&self, pairing: &Pairing, materials: &Materials) -> Row {
        let (a, b) = pairing.materials;
        let log = natural_log(materials.pair(a, b).restitution);
        let ratio = -log / (PI * PI + log * log).sqrt();
        let mass = pairing.effective_mass;
        let (normal, tangential) = (self.normal_stiffness, self.tangential_stiffness);
        [
            normal,
            2.0 * ratio * (mass * normal).sqrt(),
            tangential,
            2.0 * ratio * (SURFACE_MASS * mass * tangential).sqrt(),
        ]
    }

    /// `∫ K_n δ dδ = ½ K_n δ²`.
    fn stored_share(&self) -> f64 {
        0.5
    }

    /// Half a period of two equal grains on the quicker of both springs.
    fn step_limits(&self, grain: &SmallestGrain, _at: &Circumstances) -> Vec<StepLimit> {
        let across = self.tangential_stiffness / SURFACE_MASS;
        let stiffness = self.normal_stiffness.max(across);
        let time = PI * (0.5 * grain.mass() / stiffness).sqrt();
        vec![StepLimit {
            name: "linear contact",
            time_step: time / STEPS_PER_HALF_PERIOD,
            reason: format!(
                "1/{STEPS_PER_HALF_PERIOD} of the {time:.3e} s of half a period of two grains of {} on a spring that acts \
                 like {stiffness:.3e} N/m along the normal",
                grain.material.name
            ),
        }]
    }

    fn words(&self) -> LawWords {
        LawWords {
            name: "spring and dashpot",
            friction: "K_t ξ ≤ μ K_n δ, Coulomb's bound",
            restitution: "c = 2 ζ √(m K), ζ = −ln e/√(π² + ln² e), in both dashpots",
        }
    }

    fn uses_elastic_constants(&self) -> bool {
        false
    }

    fn mistake(&self) -> Option<LawMistake> {
        mistaken_spring(self.normal_stiffness, self.tangential_stiffness)
    }
}

impl Law for SpringDashpot {
    #[inline(always)]
    fn coefficients<N: Lanes>(self, constants: [N; 4], _overlap: N) -> Coefficients<N> {
        Coefficients {
            normal_stiffness: constants[0],
            normal_damping: constants[1],
            tangential_stiffness: constants[2],
            tangential_damping: constants[3],
        }
    }

    #[inline(always)]
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, _zero: N) -> N {
        elastic + damping
    }

    /// The spring's part alone: where dashpot and spring cancel, a contact that sticks goes on
    /// doing so.
    #[inline(always)]
    fn coulomb_force<N: Lanes>(self, elastic: N, _normal: N, _zero: N) -> N {
        elastic
    }
}
