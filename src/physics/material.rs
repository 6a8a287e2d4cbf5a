//! Materials and how two of them meet.

use serde::{Deserialize, Serialize};

/// Index of a [`Material`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct MaterialId(pub u16);

/// What a body is made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// What the scene calls it.
    pub name: String,
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
}

impl Material {
    /// Shear modulus `G = E / (2 (1 + ν))` [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }
}

/// How two materials meet, or two bodies of one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairProperties {
    /// Coefficient of restitution e, in (0, 1].
    pub restitution: f64,
    /// Coefficient of sliding friction μ of dry bodies.
    pub friction: f64,
    /// Coefficient of sliding friction μ where there is liquid.
    pub wet_friction: f64,
    /// Coefficient of rolling friction `μ_R`.
    pub rolling_friction: f64,
}

impl PairProperties {
    /// How two materials meet whose bodies meet their own kind like `a` and `b`: the harmonic mean
    /// of each value, Eq. 3.7 of Man et al. 2023.
    pub fn mixed(a: &Self, b: &Self) -> Self {
        Self {
            restitution: harmonic_mean(a.restitution, b.restitution),
            friction: harmonic_mean(a.friction, b.friction),
            wet_friction: harmonic_mean(a.wet_friction, b.wet_friction),
            rolling_friction: harmonic_mean(a.rolling_friction, b.rolling_friction),
        }
    }
}

/// `2 a b / (a + b)`, exactly `a` for equal values, zero where both are zero.
fn harmonic_mean(a: f64, b: f64) -> f64 {
    if a == b { a } else { 2.0 * a * b / (a + b) }
}

/// All materials of a world and the properties of each pair.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Materials {
    list: Vec<Material>,
    /// Lower triangle with diagonal, row by row: the pair (a, b) with a ≥ b stands at
    /// `a (a + 1) / 2 + b`.
    pairs: Vec<PairProperties>,
}

impl Materials {
    /// Materials whose pair properties `pair(a, b)` gives, asked once for every a ≥ b.
    pub fn new(
        list: Vec<Material>,
        mut pair: impl FnMut(MaterialId, MaterialId) -> PairProperties,
    ) -> Self {
        let mut pairs = Vec::new();
        for a in 0..list.len() {
            for b in 0..=a {
                pairs.push(pair(MaterialId(a as u16), MaterialId(b as u16)));
            }
        }
        Self { list, pairs }
    }

    /// Whether there are materials, and properties for each pair of them, as a file may not say.
    pub fn is_whole(&self) -> bool {
        let count = self.list.len();
        (1..=usize::from(u16::MAX)).contains(&count) && self.pairs.len() == count * (count + 1) / 2
    }

    /// How all pairs meet.
    pub fn pairs(&self) -> impl Iterator<Item = &PairProperties> {
        self.pairs.iter()
    }

    /// The materials in order of their index.
    pub fn list(&self) -> &[Material] {
        &self.list
    }

    /// One material.
    pub fn get(&self, id: MaterialId) -> &Material {
        &self.list[usize::from(id.0)]
    }

    /// Index of the material called `name`.
    pub fn find(&self, name: &str) -> Option<MaterialId> {
        self.list
            .iter()
            .position(|material| material.name == name)
            .map(|index| MaterialId(index as u16))
    }

    /// How `a` and `b` meet; the order does not matter.
    pub fn pair(&self, a: MaterialId, b: MaterialId) -> PairProperties {
        self.pairs[slot(a, b)]
    }

    /// How all pairs meet, to change it.
    pub fn pairs_mut(&mut self) -> impl Iterator<Item = &mut PairProperties> {
        self.pairs.iter_mut()
    }

    /// Changes how `a` and `b` meet; the order does not matter.
    pub fn pair_mut(&mut self, a: MaterialId, b: MaterialId) -> &mut PairProperties {
        &mut self.pairs[slot(a, b)]
    }
}

fn slot(a: MaterialId, b: MaterialId) -> usize {
    let (high, low) = (usize::from(a.0.max(b.0)), usize::from(a.0.min(b.0)));
    high * (high + 1) / 2 + low
}
