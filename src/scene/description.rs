//! A scene, checked or not: what was asked for, in SI units.

use super::container::SceneContainer;
use super::grains::SceneGrains;
use super::materials::{PairOverride, SceneMaterial};
use super::stored_cells::StoredCells;
use crate::physics::{ContactLaw, Integrator, Liquid};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Simulated time between two samples of a bed, and the longest between those of another scene that
/// does not state one [s].
pub const SAMPLE_INTERVAL: f64 = 0.02;

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
    /// The liquid between them, if any.
    pub liquid: Option<Liquid>,
    /// Gravitational acceleration [m/s²].
    pub gravity: DVec3,
    /// Which contact law acts.
    pub law: ContactLaw,
    /// How the equations of motion are integrated; a record says nothing of the explicit one.
    #[serde(default, skip_serializing_if = "Integrator::is_explicit")]
    pub integrator: Integrator,
    /// How the time step is chosen.
    pub time_step: TimeStep,
    /// Simulated time of a headless run [s].
    pub duration: f64,
    /// What ends a headless run; a record says nothing of its duration alone.
    #[serde(default, skip_serializing_if = "Until::is_duration")]
    pub until: Until,
    /// Simulated time between two written states [s].
    pub output_interval: f64,
    /// Simulated time between two samples [s]; none where samples follow what happens.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample_interval: Option<f64>,
    /// Seed of everything random.
    pub seed: u64,
}

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// The largest stable step at the start. It stays as it is; a change that makes it too long is
    /// told.
    #[default]
    Automatic,
    /// This step [s].
    Given(f64),
    /// The largest stable step at any time: a change that moves the limit changes the step too, as
    /// a command of its own.
    Following,
    /// A quarter of the largest stable step at the start: what results are held against.
    Reference,
    /// Half as much again as the largest stable step at the start: for a look, not for a result.
    Fast,
}

impl TimeStep {
    /// The step over the largest stable one at the start; of one that is given, one.
    pub fn share_of_limit(self) -> f64 {
        match self {
            Self::Automatic | Self::Given(_) | Self::Following => 1.0,
            Self::Reference => 0.25,
            Self::Fast => 1.5,
        }
    }
}

/// What ends a run without a window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Until {
    /// Its duration.
    #[default]
    Duration,
    /// That its column is at rest, or its duration, whatever comes first.
    Rest,
}

impl Until {
    /// Whether it is the duration alone.
    pub fn is_duration(&self) -> bool {
        *self == Self::Duration
    }
}

impl Scene {
    /// The grains that come from a file in place of being cut.
    pub fn stored_cells(&self) -> Option<&StoredCells> {
        match &self.grains {
            SceneGrains::Voronoi(cells) => cells.packing.as_ref(),
            _ => None,
        }
    }

    /// The material called `name`, with its index in a world.
    pub fn material(&self, name: &str) -> Option<(usize, &SceneMaterial)> {
        let mut materials = self.materials.iter().enumerate();
        materials.find(|(_, material)| material.name == name)
    }

    /// Whether its grains are rounded polyhedra. Spheres among them are polyhedra of one corner.
    pub fn is_polyhedral(&self) -> bool {
        match &self.grains {
            SceneGrains::Fill { .. } => false,
            SceneGrains::Voronoi(_) => true,
            SceneGrains::List(list) => list.iter().any(|grain| !grain.shape.is_sphere()),
        }
    }

    /// Number of its grains. Voronoi cells that are all to be grains can be a few more or less:
    /// which cells have their centroid in a column is known when they are made.
    pub fn grain_count(&self) -> usize {
        match &self.grains {
            SceneGrains::Fill { count, .. } => *count,
            SceneGrains::Voronoi(cells) => cells.grain_count(&self.container),
            SceneGrains::List(list) => list.len(),
        }
    }

    /// Name and material of each species of a filling in its order; none for listed grains.
    pub fn species(&self) -> Vec<(&str, &str)> {
        match &self.grains {
            SceneGrains::Fill { species, .. } => {
                let names = species
                    .iter()
                    .map(|s| (s.name.as_str(), s.material.as_str()));
                names.collect()
            }
            SceneGrains::Voronoi(cells) => {
                let names = cells.species.iter();
                names
                    .map(|s| (s.name.as_str(), s.material.as_str()))
                    .collect()
            }
            SceneGrains::List(_) => Vec::new(),
        }
    }

    /// Share by number of the species at `index` of a filling; zero for listed grains.
    pub fn share(&self, index: usize) -> f64 {
        let share = match &self.grains {
            SceneGrains::Fill { species, .. } => species.get(index).map(|s| s.share),
            SceneGrains::Voronoi(cells) => cells.species.get(index).map(|s| s.share),
            SceneGrains::List(_) => None,
        };
        share.unwrap_or(0.0)
    }

    /// Whether any of its grains is made of the material called `name`.
    pub fn has_grains_of(&self, name: &str) -> bool {
        match &self.grains {
            SceneGrains::List(list) => list.iter().any(|grain| grain.material == name),
            _ => self.species().iter().any(|species| species.1 == name),
        }
    }

    /// Whether walls are made of the material called `name`.
    pub fn has_walls_of(&self, name: &str) -> bool {
        match &self.container {
            SceneContainer::Nothing => false,
            SceneContainer::Drum { material, .. }
            | SceneContainer::Box { material, .. }
            | SceneContainer::Mesh { material, .. } => material == name,
            SceneContainer::Column { material, tube, .. } => {
                material == name || tube.as_ref().is_some_and(|tube| tube.material == name)
            }
            SceneContainer::Planes(planes) => planes.iter().any(|plane| plane.material == name),
        }
    }

    /// Indices of the species whose grains the one at `index` can change places with while a run
    /// goes on, itself included: those of its radius, or all species of Voronoi cells. Empty for
    /// listed grains.
    pub fn interchangeable_species(&self, index: usize) -> Vec<usize> {
        match &self.grains {
            SceneGrains::Fill { species, .. } => {
                let radius = species.get(index).map(|kind| kind.radius);
                let alike = |other: &usize| Some(species[*other].radius) == radius;
                (0..species.len()).filter(alike).collect()
            }
            SceneGrains::Voronoi(cells) if index < cells.species.len() => {
                (0..cells.species.len()).collect()
            }
            SceneGrains::Voronoi(_) | SceneGrains::List(_) => Vec::new(),
        }
    }
}
