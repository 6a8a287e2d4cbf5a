//! Which grain of a filling is of which species, at the start and after the mixing ratio was changed.
//!
//! In: a seed and the number of grains of each species. Out: a label for each grain: exact in number, random in place.
//! The grains of one radius stand in a random order that the seed fixes, and the species take successive runs of it. So a
//! larger share only adds grains to a species, and going back takes the same ones away.

use super::{SpeciesId, World};
use crate::scene::{Scene, SceneGrains, SceneSpecies, SizeClass, apportion, size_classes};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Random stream of the labels.
const LABELS: u64 = 2;

/// The random numbers that `seed` gives for one purpose.
pub(super) fn random(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}

/// The order in which `count` grains of one radius are labelled: a permutation that `seed` fixes.
pub fn label_order(seed: u64, count: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.shuffle(&mut random(seed, LABELS));
    order
}

/// Species of each grain, given its size class.
pub(super) fn assign_species(
    seed: u64,
    classes: &[SizeClass],
    class_of: &[usize],
) -> Vec<SpeciesId> {
    let mut labels = vec![SpeciesId(0); class_of.len()];
    for (index, class) in classes.iter().enumerate() {
        let members: Vec<usize> = (0..class_of.len())
            .filter(|&grain| class_of[grain] == index)
            .collect();
        for (grain, species) in labelled(seed, &members, &class.species) {
            labels[grain] = species;
        }
    }
    labels
}

/// Gives the species `species` of a filling the share `share` of all grains, by relabelling grains of its radius. The
/// other species of that radius divide the rest in the proportions that the scene states. The share is cut to what the
/// grains of that radius allow; a species that shares its radius with no other, or a listed one, keeps its grains.
///
/// A grain that changes its species keeps its place and its motion and takes the other material's density. The ledger
/// keeps gravity's work; kinetic and elastic energy change by what the caller can measure before and after.
pub fn set_share(world: &mut World, scene: &Scene, species: SpeciesId, share: f64) {
    let SceneGrains::Fill {
        count,
        species: kinds,
    } = &scene.grains
    else {
        return;
    };
    let index = usize::from(species.0);
    let classes = size_classes(*count, kinds);
    let holds = |class: &&SizeClass| class.species.iter().any(|&(member, _)| member == index);
    let Some(class) = classes.iter().find(holds) else {
        return;
    };
    let part = (share * *count as f64 / class.count.max(1) as f64).clamp(0.0, 1.0);
    let counts = apportion(class.count, &shares_beside(part, index, class, kinds));
    let wanted: Vec<(usize, usize)> = class.species.iter().map(|m| m.0).zip(counts).collect();
    relabel(world, scene.seed, &wanted);
}

/// Shares within `class` when the species `index` has the part `part` of it.
fn shares_beside(part: f64, index: usize, class: &SizeClass, kinds: &[SceneSpecies]) -> Vec<f64> {
    let members = || class.species.iter().map(|&(member, _)| member);
    let others: f64 = members()
        .filter(|&member| member != index)
        .map(|member| kinds[member].share)
        .sum();
    members()
        .map(|member| match member {
            _ if member == index => part,
            _ if others > 0.0 => (1.0 - part) * kinds[member].share / others,
            _ => (1.0 - part) / (class.species.len() - 1) as f64,
        })
        .collect()
}

/// Labels the grains of the species in `wanted` anew, so that each has its number of grains.
fn relabel(world: &mut World, seed: u64, wanted: &[(usize, usize)]) {
    let before = world.potential_energy();
    let members: Vec<usize> = (0..world.grains.len())
        .filter(|&grain| {
            let label = usize::from(world.grains.species[grain].0);
            wanted.iter().any(|&(species, _)| species == label)
        })
        .collect();
    for (grain, species) in labelled(seed, &members, wanted) {
        if world.grains.species[grain] != species {
            let material = world.species[usize::from(species.0)].material;
            let density = world.materials.get(material).density;
            world.grains.relabel(grain, species, density);
        }
    }
    let after = world.potential_energy();
    world.ledger.close_gravity_segment(before, after);
}

/// The grains `members` in label order, each with its species: the first run is of the first species, and so on.
fn labelled<'a>(
    seed: u64,
    members: &'a [usize],
    counts: &'a [(usize, usize)],
) -> impl Iterator<Item = (usize, SpeciesId)> + 'a {
    let runs = counts
        .iter()
        .flat_map(|&(species, count)| std::iter::repeat_n(SpeciesId(species as u16), count));
    label_order(seed, members.len())
        .into_iter()
        .map(|place| members[place as usize])
        .zip(runs)
}
