//! Mixing ratios by the species' names; [`crate::world::set_share`] is the rule.

use crate::scene::Scene;
use crate::world::{self, SpeciesId, World};

/// Share by number of the species called `name`.
pub fn share(world: &World, name: &str) -> Option<f64> {
    let species = find(world, name)?;
    let labels = &world.grains.species;
    let count = labels.iter().filter(|label| **label == species).count();
    (!labels.is_empty()).then(|| count as f64 / labels.len() as f64)
}

/// Makes the share of the species called `name` as near `value` as whole grains allow.
pub fn set_share(scene: &Scene, world: &mut World, name: &str, value: f64) {
    if let Some(species) = find(world, name) {
        world::set_share(world, scene, species, value);
    }
}

fn find(world: &World, name: &str) -> Option<SpeciesId> {
    let index = world.species.iter().position(|s| s.name == name)?;
    Some(SpeciesId(index as u16))
}
