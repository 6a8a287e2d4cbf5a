//! Mixing ratios: grains change their species while they stay where they are.
//!
//! Only species that share one radius can exchange grains. Which grains change is drawn from the scene's seed and depends
//! on nothing else than the labels at that moment.

use crate::scene::{Scene, SceneGrains};
use crate::world::{SpeciesId, World};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Share by number of the species called `name`.
pub fn share(world: &World, name: &str) -> Option<f64> {
    let species = find(world, name)?;
    let total = world.grains.len();
    (total > 0).then(|| count(world, species) as f64 / total as f64)
}

/// Makes the share of the species called `name` as near `value` as whole grains allow.
///
/// The difference is given by, or goes to, the species of the same radius that follow in the scene's list, the next one
/// first. So giving the shares of all but the last species one after another reaches any mixture.
pub fn set_share(scene: &Scene, world: &mut World, name: &str, value: f64) {
    let Some(species) = find(world, name) else {
        return;
    };
    let target = (value * world.grains.len() as f64).round() as usize;
    for other in followers(scene, species) {
        let present = count(world, species);
        if present < target {
            convert(world, other, species, target - present, scene.seed);
        } else {
            convert(world, species, other, present - target, scene.seed);
        }
    }
}

fn find(world: &World, name: &str) -> Option<SpeciesId> {
    let index = world.species.iter().position(|s| s.name == name)?;
    Some(SpeciesId(index as u16))
}

fn count(world: &World, species: SpeciesId) -> usize {
    let labels = world.grains.species.iter();
    labels.filter(|label| **label == species).count()
}

/// The other species of the same radius, in the list's order from `species` on and round.
fn followers(scene: &Scene, species: SpeciesId) -> Vec<SpeciesId> {
    let SceneGrains::Fill { species: list, .. } = &scene.grains else {
        return Vec::new();
    };
    let own = usize::from(species.0);
    (1..list.len())
        .map(|offset| (own + offset) % list.len())
        .filter(|&other| list[other].radius == list[own].radius)
        .map(|other| SpeciesId(other as u16))
        .collect()
}

/// Makes up to `number` grains of `from`, drawn at random, grains of `to`.
fn convert(world: &mut World, from: SpeciesId, to: SpeciesId, number: usize, seed: u64) {
    let density = world
        .materials
        .get(world.species[usize::from(to.0)].material)
        .density;
    let labels = &world.grains.species;
    let mut candidates: Vec<usize> = (0..labels.len()).filter(|&i| labels[i] == from).collect();
    candidates.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    for &i in candidates.iter().take(number) {
        world.grains.relabel(i, to, density);
    }
}
