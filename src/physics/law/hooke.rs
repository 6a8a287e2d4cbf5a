//! Linear springs and dashpots, Eqs. 3.3–3.5 of Man et al. 2023.
//!
//! `F_n = K_n δ − m_e γ_n v_n` with `γ_n = 2 √(ln² e (K_n/m_e) / (π² + ln² e))` (Eq. 3.4 solved for
//! it) and `m_e = m_1 m_2/(m_1 + m_2)`; the paper's printed `0.5 (1/m_1 + 1/m_2)` is not a mass. A
//! net attraction is cut to zero, the Coulomb bound uses the elastic part `K_n δ`, and there is no
//! tangential dashpot, as in the paper's program.

use super::bridge::LARGEST_DRAG;
use super::{
    Circumstances, Coefficients, FeatureRule, FeatureSprings, Law, LawFacts, LawMistake, LawWords,
    Pairing, SmallestGrain, StepLimit, mistaken_spring, natural_log,
};
use crate::lanes::{Lanes, Row};
use crate::physics::{Integrator, Materials};
use std::f64::consts::PI;

/// The law of Eqs. 3.3–3.5, its numbers as [`super::ContactLaw::Hooke`] states them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hooke {
    /// `K_n` of a contact [N/m].
    pub normal_stiffness: f64,
    /// `K_t` of a contact [N/m].
    pub tangential_stiffness: f64,
    /// What the stiffnesses belong to where two polyhedra touch in several places.
    pub features: FeatureRule,
}

/// Steps that half a period of a linear contact must last at least.
const STEPS_PER_HALF_PERIOD: f64 = 20.0;

/// Features of a polyhedron in a packed bed that are in contact at once, and those of two of them:
/// each a spring and a dashpot of its own under [`FeatureRule::Full`].
const FEATURES_OF_GRAIN: f64 = 40.0;
const FEATURES_OF_PAIR: f64 = 9.0;

/// Neighbours that touch a polyhedron at once, at most but for a few.
const NEIGHBOURS_OF_GRAIN: f64 = 12.0;

impl LawFacts for Hooke {
    /// `K_n`, `m_e γ_n`, `K_t`, 0 of a pair.
    fn constants(&self, pairing: &Pairing, materials: &Materials) -> Row {
        let restitution = materials
            .pair(pairing.materials.0, pairing.materials.1)
            .restitution;
        let normal_stiffness = self.normal_stiffness;
        let log = natural_log(restitution);
        let log_squared = log * log;
        let mass = pairing.effective_mass;
        let rate = 2.0 * (log_squared * (normal_stiffness / mass) / (PI * PI + log_squared)).sqrt();
        [
            normal_stiffness,
            mass * rate,
            self.tangential_stiffness,
            0.0,
        ]
    }

    /// `∫ K_n δ dδ = ½ K_n δ²`.
    fn stored_share(&self) -> f64 {
        0.5
    }

    fn step_limits(&self, grain: &SmallestGrain, at: &Circumstances) -> Vec<StepLimit> {
        let touching = at.are_polyhedra.then_some(self.features);
        let stiffness = self.normal_stiffness.max(self.tangential_stiffness);
        if touching.is_some() && at.integrator == Integrator::Implicit {
            let impact = std::iter::once(impact_limit(grain, stiffness));
            return impact.chain(way_limit(at)).collect();
        }
        let dashpots = touching.map(|rule| dashpot_limit(grain, self.normal_stiffness, rule));
        std::iter::once(spring_limit(grain, stiffness, touching))
            .chain(dashpots)
            .chain(touching.and_then(|_| way_limit(at)))
            .collect()
    }

    fn words(&self) -> LawWords {
        LawWords {
            name: "Hooke",
            friction: "|F_t| ≤ μ K_n δ, Coulomb's bound in Man et al. 2023",
            restitution: "γ_n = 2 √(ln² e (K_n/m_e) / (π² + ln² e)), from Eq. 3.4 of Man et al. 2023",
        }
    }

    fn uses_elastic_constants(&self) -> bool {
        false
    }

    fn feature_springs(&self) -> Option<FeatureSprings> {
        Some(FeatureSprings {
            normal_stiffness: self.normal_stiffness,
            rule: self.features,
        })
    }

    fn mistake(&self) -> Option<LawMistake> {
        mistaken_spring(self.normal_stiffness, self.tangential_stiffness)
    }
}

/// What an impact on one spring must last at least where springs are taken implicitly, in steps: half
/// a period of two equal grains. In columns of 1 cm of the paper energy and front are then within one
/// per cent of those of short steps, or two; narrow ones of 5 cm run out 2 % less far.
const STEPS_PER_IMPACT: f64 = 3.6;

/// Where nothing else limits the step, the way of the fastest grain does.
fn way_limit(at: &Circumstances) -> Option<StepLimit> {
    let share = at.integrator.advised_move();
    at.rounding.is_finite().then(|| StepLimit {
        name: "way in a step",
        time_step: share * at.rounding / at.fastest,
        reason: format!(
            "{share} of the smallest sphero-radius of {:.3e} m at {:.3e} m/s, the fastest that a grain falls or hits another",
            at.rounding, at.fastest
        ),
    })
}

fn impact_limit(grain: &SmallestGrain, stiffness: f64) -> StepLimit {
    let time = PI * (0.5 * grain.mass() / stiffness).sqrt();
    StepLimit {
        name: "linear contact",
        time_step: time / STEPS_PER_IMPACT,
        reason: format!(
            "1/{STEPS_PER_IMPACT} of the {time:.3e} s that two grains of {} touch on one spring of {stiffness:.3e} N/m",
            grain.material.name
        ),
    }
}

/// Contacts that a polyhedron in a packed bed has at once, as its stiffness counts them.
fn contacts_of_grain(rule: FeatureRule) -> f64 {
    match rule {
        FeatureRule::Full => FEATURES_OF_GRAIN,
        FeatureRule::Shared => NEIGHBOURS_OF_GRAIN,
    }
}

/// Half a period of two equal grains on a spring, `π √(m*/K)`; on several, where polyhedra touch in
/// several places.
fn spring_limit(grain: &SmallestGrain, stiffness: f64, touching: Option<FeatureRule>) -> StepLimit {
    let springs = match touching {
        Some(FeatureRule::Full) => FEATURES_OF_PAIR,
        Some(FeatureRule::Shared) | None => 1.0,
    };
    let time = PI * (0.5 * grain.mass() / (springs * stiffness)).sqrt();
    StepLimit {
        name: "linear contact",
        time_step: time / STEPS_PER_HALF_PERIOD,
        reason: format!(
            "1/{STEPS_PER_HALF_PERIOD} of the {time:.3e} s that two grains of {} touch on {springs} springs of {stiffness:.3e} N/m",
            grain.material.name
        ),
    }
}

/// `1.6 m/(M c)` with the dashpot `c = 2 √(ln² e K_n m/(π² + ln² e))` of a grain against a heavy
/// one: up to that step the dashpots of `M` contacts take no more than all of its speed.
fn dashpot_limit(grain: &SmallestGrain, normal_stiffness: f64, rule: FeatureRule) -> StepLimit {
    let contacts = contacts_of_grain(rule);
    let log = natural_log(grain.restitution);
    let log_squared = log * log;
    let damped = log_squared / (PI * PI + log_squared);
    let dashpot = 2.0 * (damped * normal_stiffness * grain.mass()).sqrt();
    StepLimit {
        name: "dashpots of a polyhedron",
        time_step: LARGEST_DRAG * grain.mass() / (contacts * dashpot),
        reason: format!(
            "{LARGEST_DRAG}/{contacts} of the {:.3e} s in which one dashpot stops the smallest grain of {}, which {contacts} of \
             them act on at once",
            grain.mass() / dashpot,
            grain.material.name
        ),
    }
}

impl Law for Hooke {
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
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, zero: N) -> N {
        let force = elastic + damping;
        N::choose(force.exceeds(zero), force, zero)
    }

    #[inline(always)]
    fn coulomb_force<N: Lanes>(self, elastic: N, _normal: N, _zero: N) -> N {
        elastic
    }
}
