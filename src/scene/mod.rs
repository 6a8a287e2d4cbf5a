//! What was asked for: a scene read from a RON file, every value checked.
//!
//! In: the text of a scene file. Out: a [`Scene`] in SI units, or an error that names file, line, key, value and what was
//! expected. Nothing here places a grain: [`crate::world::build`] does.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A checked scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Title, one line.
    pub title: String,
    /// What to look for, a sentence or two.
    pub look_for: String,
    /// Where the numbers come from.
    pub source: String,
    /// Materials in the order of their index in a world.
    pub materials: Vec<SceneMaterial>,
    /// Properties of pairs that differ from the mixing rule.
    pub pairs: Vec<PairOverride>,
    /// The walls.
    pub container: SceneContainer,
    /// The grains.
    pub grains: SceneGrains,
    /// Gravitational acceleration [m/s²].
    pub gravity: DVec3,
    /// Which contact law acts.
    pub law: ContactLaw,
    /// How the time step is chosen.
    pub time_step: TimeStep,
    /// Simulated time of a headless run [s].
    pub duration: f64,
    /// Simulated time between two written states [s].
    pub output_interval: f64,
    /// Seed of everything random.
    pub seed: u64,
}

/// How two bodies push each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    },
}

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// The largest stable step, as the solver's advice reasons it.
    Automatic,
    /// This step [s].
    Given(f64),
}

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
    /// Rolling friction of two bodies of this material.
    pub rolling_friction: f64,
}

/// What differs from the mixing rule (the harmonic mean of both materials' values, Eq. 3.7 of Man et al. 2023) when two
/// materials meet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairOverride {
    /// The two materials' names.
    pub between: (String, String),
    /// Restitution, where it differs.
    pub restitution: Option<f64>,
    /// Sliding friction, where it differs.
    pub friction: Option<f64>,
    /// Rolling friction, where it differs.
    pub rolling_friction: Option<f64>,
}

/// The walls of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneContainer {
    /// No walls at all.
    Nothing,
    /// A drum about the z axis, rim and both end plates turning as one body.
    Drum {
        /// Inner radius [m].
        radius: f64,
        /// Inner width [m].
        width: f64,
        /// Angular speed, positive anticlockwise seen from +z [rad/s].
        speed: f64,
        /// Name of its material.
        material: String,
    },
    /// A closed box along the axes.
    Box {
        /// Lower corner [m].
        min: DVec3,
        /// Upper corner [m].
        max: DVec3,
        /// Name of its material.
        material: String,
    },
    /// Unbounded planes.
    Planes(Vec<ScenePlane>),
}

/// An unbounded plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScenePlane {
    /// What people call it.
    pub name: String,
    /// Any point of it [m].
    pub point: DVec3,
    /// Normal towards the grains (made a unit vector when read).
    pub normal: DVec3,
    /// Its velocity [m/s].
    pub velocity: DVec3,
    /// Name of its material.
    pub material: String,
}

/// The grains of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneGrains {
    /// The container is filled from below with `count` grains in all, then settled while it is at rest.
    Fill {
        /// Number of grains (given, or from the bulk fraction of the container's volume at a packing fraction).
        count: usize,
        /// The species and their shares; the shares add up to 1. Labels are exact in number, random in place.
        species: Vec<SceneSpecies>,
    },
    /// Each grain as listed; nothing is settled.
    List(Vec<SceneGrain>),
}

/// A kind of grain in a filling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneSpecies {
    /// What people call it.
    pub name: String,
    /// Radius [m].
    pub radius: f64,
    /// Name of its material.
    pub material: String,
    /// Share by number, 0 … 1.
    pub share: f64,
}

/// One grain of an explicit list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneGrain {
    /// Centre [m].
    pub position: DVec3,
    /// Velocity [m/s].
    pub velocity: DVec3,
    /// Angular velocity [rad/s].
    pub spin: DVec3,
    /// Radius [m].
    pub radius: f64,
    /// Name of its material.
    pub material: String,
}
