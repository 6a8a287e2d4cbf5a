//! Hertz–Mindlin, Eqs. 5–9 of Kasper et al. 2021.
//!
//! With `s = √δ`: `k_n = (4/3) E* √r* s`, `η_n = −√5 β √(m* k_n)`, `k_t = 8 G* √r* s`, `η_t = −2 √(5/6) β √(m* k_t)`,
//! `β = ln e / √(ln² e + π²)`. Each is a constant of the pair times `s` or `√s`. The attraction that the dashpot makes at
//! the end of a contact is kept: only then does the restitution come out as e.

use super::{Coefficients, Law, Pairing, natural_log};
use crate::lanes::{Lanes, Row};
use crate::physics::Materials;
use std::f64::consts::PI;

/// The law of Eqs. 5–9.
#[derive(Clone, Copy, Debug)]
pub struct HertzMindlin;

impl HertzMindlin {
    /// `k_n/√δ`, `η_n/√√δ`, `k_t/√δ`, `η_t/√√δ` of a pair.
    pub fn constants(pairing: &Pairing, materials: &Materials) -> Row {
        let (a, b) = (
            materials.get(pairing.materials.0),
            materials.get(pairing.materials.1),
        );
        let pair = materials.pair(pairing.materials.0, pairing.materials.1);
        let compliance = |nu: f64, modulus: f64| (1.0 - nu * nu) / modulus;
        let effective_modulus = 1.0
            / (compliance(a.poisson_ratio, a.youngs_modulus)
                + compliance(b.poisson_ratio, b.youngs_modulus));
        let effective_shear_modulus = 1.0
            / ((2.0 - a.poisson_ratio) / a.shear_modulus()
                + (2.0 - b.poisson_ratio) / b.shear_modulus());
        let beta = damping_exponent(pair.restitution);
        let root = pairing.effective_radius.sqrt();
        let normal = 4.0 / 3.0 * effective_modulus * root;
        let tangential = 8.0 * effective_shear_modulus * root;
        [
            normal,
            -5_f64.sqrt() * beta * (pairing.effective_mass * normal).sqrt(),
            tangential,
            -2.0 * (5.0_f64 / 6.0).sqrt() * beta * (pairing.effective_mass * tangential).sqrt(),
        ]
    }
}

/// `β = ln e / √(ln² e + π²)`, negative.
fn damping_exponent(restitution: f64) -> f64 {
    let log = natural_log(restitution);
    log / (log * log + PI * PI).sqrt()
}

impl Law for HertzMindlin {
    #[inline(always)]
    fn coefficients<N: Lanes>(self, constants: [N; 4], overlap: N) -> Coefficients<N> {
        let root = overlap.sqrt();
        let fourth_root = root.sqrt();
        Coefficients {
            normal_stiffness: constants[0] * root,
            normal_damping: constants[1] * fourth_root,
            tangential_stiffness: constants[2] * root,
            tangential_damping: constants[3] * fourth_root,
        }
    }

    #[inline(always)]
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, _zero: N) -> N {
        elastic + damping
    }

    /// Eq. 20: `μ |F_n|` with the whole normal force.
    #[inline(always)]
    fn coulomb_force<N: Lanes>(self, _elastic: N, normal: N, zero: N) -> N {
        N::choose(zero.exceeds(normal), -normal, normal)
    }
}
