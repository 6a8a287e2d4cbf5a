//! Contact laws, one file each.
//!
//! A law turns the constants of a pair ([`PairConstants`], computed once per kind of pair) and the overlap into
//! stiffnesses and dashpots, and says how the normal force and the Coulomb bound come from them. All laws share the
//! tangential spring, the rolling friction and the geometry in the solver. A wall is a partner of infinite mass
//! and radius, so no law asks whether there is one.

mod bridge;
mod hertz_mindlin;
mod hooke;
mod rolling;

pub use bridge::{
    BridgeConstants, BridgeKinds, FilmConstants, LARGEST_DRAG, attraction, contributions, drag,
    rupture_gap, smallest_viscous_gap,
};
pub use hertz_mindlin::HertzMindlin;
pub use hooke::Hooke;
pub use rolling::rolling_gain;

use crate::lanes::{Lanes, One, Row};
use crate::physics::{MaterialId, Materials};
use serde::{Deserialize, Serialize};

/// How two bodies push each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ContactLaw {
    /// Hertz–Mindlin from the materials' elastic constants, Eqs. 5–10 of Kasper et al. 2021.
    #[default]
    HertzMindlin,
    /// Linear springs, Eqs. 3.3–3.5 of Man et al. 2023.
    Hooke {
        /// `K_n` of a contact [N/m].
        normal_stiffness: f64,
        /// `K_t` of a contact [N/m].
        tangential_stiffness: f64,
        /// What the stiffnesses belong to where two polyhedra touch in several places.
        #[serde(default)]
        features: FeatureRule,
    },
}

/// What the stiffnesses and the dashpot of two polyhedra belong to. Two features (a vertex and a face, or two edges) that
/// are closer than the sum of their rounding radii are in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FeatureRule {
    /// Each pair of features is a full contact, as in the program of Man et al. 2023.
    #[default]
    Full,
    /// The features of two polyhedra share one contact's stiffness and dashpot, each by its part of their overlap.
    Shared,
}

/// What a pair's force depends on beside geometry and motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct PairConstants {
    /// The law's own constants, in the order of its [`Coefficients`].
    pub coefficients: Row,
    /// Coefficient of sliding friction μ; `μ_R r*`, the arm of rolling friction [m]; radii of both, 0 for a wall [m].
    pub contact: Row,
}

/// Stiffnesses and dashpots of contacts at some overlap, side by side.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients<N> {
    /// `k_n`, normal force over overlap [N/m].
    pub normal_stiffness: N,
    /// `η_n` [N s/m].
    pub normal_damping: N,
    /// `k_t` [N/m].
    pub tangential_stiffness: N,
    /// `η_t` [N s/m].
    pub tangential_damping: N,
}

/// A contact law: a plain value whose functions the pair loop inlines.
pub trait Law: Copy + Send + Sync {
    /// Stiffnesses and dashpots at the overlap `δ ≥ 0` [m].
    fn coefficients<N: Lanes>(self, constants: [N; 4], overlap: N) -> Coefficients<N>;

    /// Repulsive normal force [N] from its elastic part and the dashpot's part.
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, zero: N) -> N;

    /// The normal force that bounds the tangential one [N].
    fn coulomb_force<N: Lanes>(self, elastic: N, normal: N, zero: N) -> N;
}

/// Effective (reduced) quantities of two partners, which an infinite partner leaves at the other's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pairing {
    /// `r* = r_i r_j / (r_i + r_j)` [m].
    pub effective_radius: f64,
    /// `m* = m_i m_j / (m_i + m_j)` [kg].
    pub effective_mass: f64,
    /// Radii of both, 0 for a wall [m].
    pub radii: (f64, f64),
    /// Materials of both sides.
    pub materials: (MaterialId, MaterialId),
}

impl Pairing {
    /// Constants of the pair under the world's contact law, `wet` or dry.
    pub fn constants(&self, law: ContactLaw, materials: &Materials, wet: bool) -> PairConstants {
        let pair = materials.pair(self.materials.0, self.materials.1);
        let coefficients = match law {
            ContactLaw::HertzMindlin => HertzMindlin::constants(self, materials),
            ContactLaw::Hooke {
                normal_stiffness,
                tangential_stiffness,
                ..
            } => Hooke::constants(
                self,
                normal_stiffness,
                tangential_stiffness,
                pair.restitution,
            ),
        };
        PairConstants {
            coefficients,
            contact: [
                if wet {
                    pair.wet_friction
                } else {
                    pair.friction
                },
                pair.rolling_friction * self.effective_radius,
                self.radii.0,
                self.radii.1,
            ],
        }
    }

    /// Elastic energy stored at the overlap [m] with a tangential spring of the given length [m], in J.
    pub fn elastic_energy(
        &self,
        law: ContactLaw,
        materials: &Materials,
        overlap: f64,
        spring: f64,
    ) -> f64 {
        let constants = self
            .constants(law, materials, false)
            .coefficients
            .map(|x| One::splat((), x));
        let at = One::splat((), overlap);
        // ∫ k_n δ dδ: k_n grows as √δ under Hertz' law and is constant under Hooke's.
        let (share, k) = match law {
            ContactLaw::HertzMindlin => (0.4, HertzMindlin.coefficients(constants, at)),
            ContactLaw::Hooke { .. } => (0.5, Hooke.coefficients(constants, at)),
        };
        share * k.normal_stiffness.get() * overlap * overlap
            + 0.5 * k.tangential_stiffness.get() * spring * spring
    }
}

/// `a b / (a + b)`.
pub fn reduced(a: f64, b: f64) -> f64 {
    a * b / (a + b)
}

/// `ln x` for `x > 0` by sums and products alone: a platform's own may differ in the last bit.
///
/// `x = 2^k m` with `m` near 1 and `ln m = 2 (s + s³/3 + s⁵/5 + …)`, `s = (m − 1)/(m + 1)`, |s| ≤ 1/5.
pub fn natural_log(x: f64) -> f64 {
    const TERMS: u8 = 13;
    let (mut m, mut k) = (x, 0.0);
    while m < 0.75 && m > 0.0 {
        (m, k) = (2.0 * m, k - 1.0);
    }
    while m > 1.5 && m.is_finite() {
        (m, k) = (0.5 * m, k + 1.0);
    }
    let s = (m - 1.0) / (m + 1.0);
    let series = (0..TERMS)
        .rev()
        .fold(0.0, |sum, n| sum * s * s + 1.0 / f64::from(2 * n + 1));
    k * std::f64::consts::LN_2 + 2.0 * s * series
}

#[cfg(test)]
mod tests {
    use super::natural_log;

    #[test]
    fn logarithm_is_that_of_the_platform_to_a_few_last_bits() {
        assert_eq!(natural_log(1.0), 0.0);
        for x in [
            1e-300, 1e-3, 0.01, 0.2, 0.7499, 0.75, 0.9, 0.95, 0.999_999, 1.4, 3.0, 1e9,
        ] {
            let error = (natural_log(x) / f64::ln(x) - 1.0).abs();
            assert!(error < 1e-15, "ln {x}: off by {error:e}");
        }
    }
}
