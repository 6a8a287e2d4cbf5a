//! Materials as a scene states them, and pairs that differ from the mixing rule.

use serde::{Deserialize, Serialize};

/// A material as a scene states it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneMaterial {
    /// What the scene calls it.
    pub name: String,
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Restitution of two bodies of this material.
    pub restitution: f64,
    /// Sliding friction of two bodies of this material.
    pub friction: f64,
    /// Sliding friction where there is liquid, where that differs.
    pub wet_friction: Option<f64>,
    /// Rolling friction of two bodies of this material.
    pub rolling_friction: f64,
}

/// What differs from the mixing rule (the harmonic mean of both materials' values, Eq. 3.7 of Man
/// et al. 2023) when two materials meet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Pair", deny_unknown_fields)]
pub struct PairOverride {
    /// The two materials' names.
    pub between: (String, String),
    /// Restitution, where it differs.
    pub restitution: Option<f64>,
    /// Sliding friction, where it differs.
    pub friction: Option<f64>,
    /// Sliding friction where there is liquid, where that differs from both.
    pub wet_friction: Option<f64>,
    /// Rolling friction, where it differs.
    pub rolling_friction: Option<f64>,
}

impl PairOverride {
    /// Whether it says how `a` and `b`, in either order, meet.
    pub fn is_between(&self, a: &str, b: &str) -> bool {
        let (first, second) = (self.between.0.as_str(), self.between.1.as_str());
        (first, second) == (a, b) || (first, second) == (b, a)
    }
}
