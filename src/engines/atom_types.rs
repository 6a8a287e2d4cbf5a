//! Types: what an engine's coefficients belong to.
//!
//! In: a world of spheres. Out: a number from 1 on for every grain and every wall. Grains of a
//! species are one type; where an engine's coefficients depend on the grains' size, those of a
//! species and a radius. Walls of a material are one type, after those of the grains.

use crate::geometry::sphere_volume;
use crate::physics::MaterialId;
use crate::physics::law::{Pairing, reduced};
use crate::world::{SpeciesId, World};
use serde::{Deserialize, Serialize};

/// Most types of grain: the engine's tables have an entry for each pair of them.
const MOST_TYPES: usize = 60;

/// A type of grain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrainType {
    /// Index of its species.
    pub species: SpeciesId,
    /// What it is made of.
    pub material: MaterialId,
    /// Its radius, of several the first [m].
    pub radius: f64,
}

/// The types of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct AtomTypes {
    /// Those of grains: the type `k + 1` stands at `k`.
    pub grains: Vec<GrainType>,
    /// Those of walls, which follow.
    pub walls: Vec<MaterialId>,
    /// The type of each grain, from 0 on.
    of_grain: Vec<u32>,
}

impl AtomTypes {
    /// The types of `world`: one for each species of grain, or for each of its radii.
    ///
    /// # Errors
    /// When there are too many.
    pub fn of(world: &World, by_radius: bool) -> Result<Self, String> {
        let mut grains: Vec<GrainType> = Vec::new();
        let mut of_grain = Vec::with_capacity(world.grains.len());
        for (species, radius) in world.grains.species.iter().zip(world.grains.radius.iter()) {
            let is_it = |kind: &GrainType| {
                kind.species == *species && (!by_radius || kind.radius == *radius)
            };
            let known = grains.iter().position(is_it);
            of_grain.push(known.unwrap_or(grains.len()) as u32);
            if known.is_none() {
                grains.push(GrainType {
                    species: *species,
                    material: world.species[usize::from(species.0)].material,
                    radius: *radius,
                });
            }
            if grains.len() > MOST_TYPES {
                return Err(format!(
                    "grains of more than {MOST_TYPES} species and radii: the engine's coefficients are those of \
                     pairs of types"
                ));
            }
        }
        let mut walls: Vec<MaterialId> = Vec::new();
        for wall in &world.container.walls {
            if !walls.contains(&wall.material) {
                walls.push(wall.material);
            }
        }
        Ok(Self {
            grains,
            walls,
            of_grain,
        })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.grains.len() + self.walls.len()
    }

    /// The type of a grain, from 1 on.
    pub fn of_grain(&self, grain: usize) -> usize {
        self.of_grain[grain] as usize + 1
    }

    /// The type of walls of this material, from 1 on.
    pub fn of_wall(&self, material: MaterialId) -> usize {
        let place = self.walls.iter().position(|known| *known == material);
        self.grains.len() + place.unwrap_or(0) + 1
    }

    /// What each type is made of, in their order.
    pub fn materials(&self) -> impl Iterator<Item = MaterialId> {
        let grains = self.grains.iter().map(|kind| kind.material);
        grains.chain(self.walls.iter().copied())
    }

    /// How two types meet, each given from 0 on. Two walls never meet; they stand there as the first
    /// grains of their materials would.
    pub fn pairing(&self, world: &World, a: usize, b: usize) -> Pairing {
        let materials: Vec<MaterialId> = self.materials().collect();
        let radius = |index: usize| self.grains.get(index).map(|kind| kind.radius);
        let radii = match (radius(a), radius(b)) {
            (None, None) => {
                let first = self.grains.first().map_or(1e-3, |kind| kind.radius);
                [Some(first), None]
            }
            (a, b) => [a, b],
        };
        let mass = |radius: Option<f64>, material| {
            radius.map(|radius| sphere_volume(radius) * world.materials.get(material).density)
        };
        let both = |[a, b]: [Option<f64>; 2]| match (a, b) {
            (Some(a), Some(b)) => reduced(a, b),
            (a, b) => a.or(b).unwrap_or(1.0),
        };
        let masses = [mass(radii[0], materials[a]), mass(radii[1], materials[b])];
        Pairing {
            effective_radius: both(radii),
            effective_mass: both(masses),
            radii: (radii[0].unwrap_or(0.0), radii[1].unwrap_or(0.0)),
            materials: (materials[a], materials[b]),
        }
    }
}
