//! Hertz–Mindlin, Eqs. 5–9 of Kasper et al. 2021.
//!
//! With `s = √δ`: `k_n = (4/3) E* √r* s`, `η_n = −√5 β √(m* k_n)`, `k_t = 8 G* √r* s`,
//! `η_t = −2 √(5/6) β √(m* k_t)`, `β = ln e / √(ln² e + π²)`. Each is a constant of the pair times
//! `s` or `√s`. The attraction that the dashpot makes at the end of a contact is kept: only then
//! does the restitution come out as e.

use super::{
    Circumstances, Coefficients, Law, LawFacts, LawWords, Pairing, SmallestGrain, StepLimit,
    natural_log,
};
use crate::lanes::{Lanes, Row};
use crate::physics::Materials;
use std::f64::consts::PI;

/// The law of Eqs. 5–9.
#[derive(Clone, Copy, Debug)]
pub struct HertzMindlin;

/// Share of the Rayleigh time that a step may take (physics of Kasper et al. 2021 as run by its
/// authors: at most 0.2).
const RAYLEIGH_SHARE: f64 = 0.2;

/// Steps that an elastic Hertz contact must last at least.
const STEPS_PER_CONTACT: f64 = 15.0;

impl LawFacts for HertzMindlin {
    /// `k_n/√δ`, `η_n/√√δ`, `k_t/√δ`, `η_t/√√δ` of a pair.
    fn constants(&self, pairing: &Pairing, materials: &Materials) -> Row {
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

    /// `∫ k_n δ dδ = 2/5 k_n δ²`: `k_n` grows as √δ.
    fn stored_share(&self) -> f64 {
        0.4
    }

    fn step_limits(&self, grain: &SmallestGrain, at: &Circumstances) -> Vec<StepLimit> {
        vec![rayleigh_limit(grain), impact_limit(grain, at.impact_speed)]
    }

    fn words(&self) -> LawWords {
        LawWords {
            name: "Hertz–Mindlin",
            friction: "|F_t| ≤ μ |F_n|, Eq. 20 of Kasper et al. 2021",
            restitution: "β = ln e / √(ln² e + π²) in both dashpots, Eqs. 5–9 of Kasper et al. 2021",
        }
    }

    fn uses_elastic_constants(&self) -> bool {
        true
    }
}

/// `T_R = π r √(ρ/G) / (0.1631 ν + 0.8766)`: a Rayleigh wave crosses the grain's half
/// circumference.
fn rayleigh_limit(grain: &SmallestGrain) -> StepLimit {
    let material = grain.material;
    let time = PI * grain.radius * (material.density / material.shear_modulus()).sqrt()
        / (0.1631 * material.poisson_ratio + 0.8766);
    StepLimit {
        name: "Rayleigh wave",
        time_step: RAYLEIGH_SHARE * time,
        reason: format!(
            "{RAYLEIGH_SHARE} of the {time:.3e} s that a surface wave takes round a grain of {} with r = {:.3e} m",
            material.name, grain.radius
        ),
    }
}

/// `T_H = 2.87 (m*² / (r* E*² v))^(1/5)`: an elastic Hertz impact of two equal grains.
#[expect(
    clippy::disallowed_methods,
    reason = "the fifth root is rounded to single precision, which takes a platform's own last bit away"
)]
fn impact_limit(grain: &SmallestGrain, speed: f64) -> StepLimit {
    let material = grain.material;
    let poisson = material.poisson_ratio;
    let mass = grain.mass() / 2.0;
    let modulus = material.youngs_modulus / (2.0 * (1.0 - poisson * poisson));
    let fifth_power = mass * mass / (0.5 * grain.radius * modulus * modulus * speed);
    // Rounded, so that a platform's own last bit of the root does not show in a run.
    let time = f64::from((2.87 * fifth_power.powf(0.2)) as f32);
    StepLimit {
        name: "Hertz contact",
        time_step: time / STEPS_PER_CONTACT,
        reason: format!(
            "1/{STEPS_PER_CONTACT} of the {time:.3e} s that an impact of two grains of {} at {speed:.3} m/s lasts",
            material.name
        ),
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
