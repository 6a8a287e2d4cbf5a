//! Contact laws, one file each.
//!
//! A law turns the constants of a pair ([`PairConstants`], computed once per kind of pair) and the
//! overlap into stiffnesses and dashpots, and says how the normal force and the Coulomb bound come
//! from them ([`Law`], which the pair loop inlines). All laws share the tangential spring, the
//! rolling friction and the geometry in the solver. A wall is a partner of infinite mass and
//! radius, so no law asks whether there is one.
//!
//! Whatever else depends on the law, the law says too ([`LawFacts`]): the constants of a pair, the
//! limits on the time step with their reasons, what people call it and its equations, which grains
//! it suits. So a new law takes a file with both traits here, and a line each in [`ContactLaw`] and
//! [`ContactLaw::choose`].
//!
//! A law that stands in another program takes the two traits alone: a solver of spheres can be
//! given it instead of the law that a world states ([`LawSource`]; `examples/own_force_law.rs`).

mod bridge;
mod hertz_mindlin;
mod hooke;
mod rolling;
mod spring_dashpot;
mod step_limit;

pub use bridge::{
    BridgeConstants, BridgeKinds, FilmConstants, attraction, contributions, drag,
    lubrication_limit, rupture_gap,
};
pub use hertz_mindlin::HertzMindlin;
pub use hooke::Hooke;
pub use rolling::rolling_gain;
pub use spring_dashpot::SpringDashpot;
pub use step_limit::{Circumstances, SmallestGrain, StepLimit};

use crate::lanes::{Lanes, One, Row};
use crate::physics::{MaterialId, Materials, limits};
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
    /// Linear springs with dashpots along and across the normal, for spheres.
    SpringDashpot {
        /// `K_n` of a contact [N/m].
        normal_stiffness: f64,
        /// `K_t` of a contact [N/m].
        tangential_stiffness: f64,
    },
}

/// What the stiffnesses and the dashpot of two polyhedra belong to. Two features (a vertex and a
/// face, or two edges) that are closer than the sum of their rounding radii are in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FeatureRule {
    /// Each pair of features is a full contact, as in the program of Man et al. 2023.
    #[default]
    Full,
    /// The features of two polyhedra share one contact's stiffness and dashpot, each by its part of
    /// their overlap.
    Shared,
}

impl FeatureRule {
    /// The part of a contact's stiffness that each feature of a pair has, given the sum of their
    /// overlaps [m] and that of its squares [m²]: `Σδ²/(Σδ)²` where they share it.
    pub fn part(self, sum: f64, squares: f64) -> f64 {
        match self {
            Self::Shared if sum > 0.0 => squares / (sum * sum),
            Self::Full | Self::Shared => 1.0,
        }
    }
}

/// What a pair's force depends on beside geometry and motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct PairConstants {
    /// The law's own constants, in the order of its [`Coefficients`].
    pub coefficients: Row,
    /// Coefficient of sliding friction μ; `μ_R r*`, the arm of rolling friction [m]; radii of both,
    /// 0 for a wall [m].
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
pub trait Law: LawFacts + Copy + Send + Sync {
    /// Whether contacts are objective: what they remember turns about the normal with the grains,
    /// and a step's slip is taken in the middle of it, so that grains that turn as one body neither
    /// wind up nor turn back what their contacts hold. A law says no to compute as programs do that
    /// follow the normal alone and take the slip at the end of a step (LAMMPS, LIGGGHTS).
    const OBJECTIVE: bool = true;

    /// Stiffnesses and dashpots at the overlap `δ ≥ 0` [m].
    fn coefficients<N: Lanes>(self, constants: [N; 4], overlap: N) -> Coefficients<N>;

    /// Repulsive normal force [N] from its elastic part and the dashpot's part.
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, zero: N) -> N;

    /// The normal force that bounds the tangential one [N].
    fn coulomb_force<N: Lanes>(self, elastic: N, normal: N, zero: N) -> N;
}

/// What a contact law says of itself outside of the pair loop.
pub trait LawFacts {
    /// Constants of a pair in the order of the law's [`Coefficients`].
    fn constants(&self, pairing: &Pairing, materials: &Materials) -> Row;

    /// Energy of the normal spring over `k_n δ²`: ½ where `k_n` is constant.
    fn stored_share(&self) -> f64;

    /// The limits that the contacts of the smallest grains of a material set on the time step.
    fn step_limits(&self, grain: &SmallestGrain, at: &Circumstances) -> Vec<StepLimit>;

    /// What people call it, and its equations.
    fn words(&self) -> LawWords;

    /// Whether its stiffness follows from the materials' elastic constants.
    fn uses_elastic_constants(&self) -> bool;

    /// Its springs between the features of polyhedra; none where it is for spheres alone.
    fn feature_springs(&self) -> Option<FeatureSprings> {
        None
    }

    /// What is wrong with its own numbers, if anything is.
    fn mistake(&self) -> Option<LawMistake> {
        None
    }
}

/// What people read about a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawWords {
    /// Its name.
    pub name: &'static str,
    /// How friction bounds the tangential force, with the source.
    pub friction: &'static str,
    /// How the dashpots follow from the restitution, with the source.
    pub restitution: &'static str,
}

/// Springs between the features of two polyhedra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureSprings {
    /// `K_n` [N/m].
    pub normal_stiffness: f64,
    /// What it belongs to.
    pub rule: FeatureRule,
}

/// A number of a law that cannot be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawMistake {
    /// Its key in scene files.
    pub key: &'static str,
    /// What it is.
    pub value: f64,
    /// What it can be.
    pub expected: &'static str,
}

/// The stiffness [N/m] of linear springs that cannot be, if one cannot. Without a tangential spring
/// there is no friction at rest, which may be wanted.
fn mistaken_spring(normal: f64, tangential: f64) -> Option<LawMistake> {
    let springs = [
        ("normal_stiffness", normal, false),
        ("tangential_stiffness", tangential, tangential == 0.0),
    ];
    let is_one =
        |(_, value, absent): &(&str, f64, bool)| *absent || limits::STIFFNESS.accept(*value);
    let (key, value, _) = springs.into_iter().find(|spring| !is_one(spring))?;
    Some(LawMistake {
        key,
        value,
        expected: limits::STIFFNESS.expected,
    })
}

/// What a contact does along the normal.
#[derive(Clone, Copy, Debug)]
pub struct NormalContact<N> {
    /// Stiffnesses and dashpots at the overlap.
    pub coefficients: Coefficients<N>,
    /// Repulsion of the spring [N].
    pub elastic: N,
    /// Repulsion of spring and dashpot [N].
    pub repulsion: N,
    /// The normal force that bounds the tangential one [N].
    pub bounding: N,
}

/// What `law` makes of contacts with these `constants` at this `overlap` [m], none of those that do
/// not touch, whose sides approach each other at this speed [m/s]. The pair loop runs it, and what
/// explains a force term by term.
#[inline(always)]
pub fn normal_contact<N: Lanes, L: Law>(
    law: L,
    constants: [N; 4],
    (touching, overlap): (N::Mask, N),
    approach: N,
    zero: N,
) -> NormalContact<N> {
    let coefficients = law.coefficients(constants, overlap);
    let damping = N::choose(touching, coefficients.normal_damping, zero);
    let elastic = coefficients.normal_stiffness * overlap;
    let repulsion = law.normal_force(elastic, damping * approach, zero);
    NormalContact {
        coefficients,
        elastic,
        repulsion,
        bounding: law.coulomb_force(elastic, repulsion, zero),
    }
}

/// What is to be done with a law, once it is known which: so that a loop is compiled for each law
/// and none asks for it again.
pub trait LawUser {
    /// What comes of it.
    type Output;

    /// Does it with `law`.
    fn with<L: Law>(self, law: L) -> Self::Output;
}

/// Where a solver gets the contact law of spheres from: from the world ([`StatedLaw`]), or it has
/// one of its own, which is any [`Law`].
pub trait LawSource: Copy + Send + Sync {
    /// Whether it is the law that worlds state.
    const STATED: bool;

    /// Does with the law what `user` does; `stated` is the world's.
    fn choose<U: LawUser>(self, stated: ContactLaw, user: U) -> U::Output;
}

/// The law that the world states.
#[derive(Clone, Copy, Debug, Default)]
pub struct StatedLaw;

impl LawSource for StatedLaw {
    const STATED: bool = true;

    #[inline(always)]
    fn choose<U: LawUser>(self, stated: ContactLaw, user: U) -> U::Output {
        stated.choose(user)
    }
}

impl<L: Law> LawSource for L {
    const STATED: bool = false;

    #[inline(always)]
    fn choose<U: LawUser>(self, _stated: ContactLaw, user: U) -> U::Output {
        user.with(self)
    }
}

impl ContactLaw {
    /// What a scene file can state.
    pub const FORMS: &'static str = "`HertzMindlin`, `Hooke(…)` or `SpringDashpot(…)`";

    /// Does with the law what `user` does.
    pub fn choose<U: LawUser>(self, user: U) -> U::Output {
        match self {
            Self::HertzMindlin => user.with(HertzMindlin),
            Self::Hooke {
                normal_stiffness,
                tangential_stiffness,
                features,
            } => user.with(Hooke {
                normal_stiffness,
                tangential_stiffness,
                features,
            }),
            Self::SpringDashpot {
                normal_stiffness,
                tangential_stiffness,
            } => user.with(SpringDashpot {
                normal_stiffness,
                tangential_stiffness,
            }),
        }
    }

    /// What `ask` hears from the law.
    pub fn told<T>(self, ask: impl FnOnce(&dyn LawFacts) -> T) -> T {
        self.choose(Asking(ask))
    }

    /// What people call it, and its equations.
    pub fn words(self) -> LawWords {
        self.told(|law| law.words())
    }

    /// Its springs between the features of polyhedra; none where it is for spheres alone.
    pub fn feature_springs(self) -> Option<FeatureSprings> {
        self.told(|law| law.feature_springs())
    }
}

struct Asking<F>(F);

impl<T, F: FnOnce(&dyn LawFacts) -> T> LawUser for Asking<F> {
    type Output = T;

    fn with<L: Law>(self, law: L) -> T {
        self.0(&law)
    }
}

/// The elastic energy of a contact [J].
struct ElasticEnergy {
    constants: Row,
    overlap: f64,
    spring: f64,
}

impl LawUser for ElasticEnergy {
    type Output = f64;

    fn with<L: Law>(self, law: L) -> f64 {
        let Self {
            constants,
            overlap,
            spring,
        } = self;
        let k = law.coefficients(One::spread((), &constants), One::splat((), overlap));
        law.stored_share() * k.normal_stiffness.get() * overlap * overlap
            + 0.5 * k.tangential_stiffness.get() * spring * spring
    }
}

/// Effective (reduced) quantities of two partners, which an infinite partner leaves at the other's
/// value.
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
        law.told(|law| self.constants_by(law, materials, wet))
    }

    /// Constants of the pair under this law, `wet` or dry.
    pub fn constants_by(
        &self,
        law: &dyn LawFacts,
        materials: &Materials,
        wet: bool,
    ) -> PairConstants {
        let pair = materials.pair(self.materials.0, self.materials.1);
        PairConstants {
            coefficients: law.constants(self, materials),
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

    /// Elastic energy stored at the overlap [m] with a tangential spring of the given length [m],
    /// in J.
    pub fn elastic_energy(
        &self,
        law: ContactLaw,
        materials: &Materials,
        overlap: f64,
        spring: f64,
    ) -> f64 {
        law.choose(ElasticEnergy {
            constants: self.constants(law, materials, false).coefficients,
            overlap,
            spring,
        })
    }
}

/// `a b / (a + b)`.
pub fn reduced(a: f64, b: f64) -> f64 {
    a * b / (a + b)
}

/// `ln x` for `x > 0` by sums and products alone: a platform's own may differ in the last bit.
///
/// `x = 2^k m` with `m` near 1 and `ln m = 2 (s + s³/3 + s⁵/5 + …)`, `s = (m − 1)/(m + 1)`, |s| ≤
/// 1/5.
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
