//! Which grain of a filling is of which species, at the start and after the mixing ratio was
//! changed.
//!
//! In: a seed and the number of grains of each species. Out: a label for each grain: exact in
//! number, random in place. The grains of one radius stand in a random order that the seed fixes,
//! and the species take successive runs of it. So a larger share only adds grains to a species, and
//! going back takes the same ones away.

use super::{SpeciesId, World};
use crate::geometry::sphere_volume;
use crate::scene::{Scene, SizeClass};
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

/// Makes the share by number of the species `species` of a filling as near `share` as whole grains
/// allow.
///
/// The difference goes to, or comes from, the species that it can change places with (of the same
/// radius, or all species of Voronoi cells) and that follow in the scene's list, the next one first
/// and round: so giving the shares of all but the last one after another reaches any mixture. A
/// species without such others keeps its grains, and so do listed grains.
///
/// A grain that changes its species keeps its place, its shape and its motion and takes the other
/// material's density. What that does to the energies is for the caller to book.
pub fn set_share(world: &mut World, scene: &Scene, species: SpeciesId, share: f64) {
    let members = scene.interchangeable_species(usize::from(species.0));
    let Some(own) = members.iter().position(|&m| m == usize::from(species.0)) else {
        return;
    };
    let mut counts: Vec<usize> = members.iter().map(|&m| count(world, m)).collect();
    let target = (share.max(0.0) * world.grains.len() as f64).round() as usize;
    for step in 1..members.len() {
        let other = (own + step) % members.len();
        let wanted = target.saturating_sub(counts[own]).min(counts[other]);
        let spare = counts[own].saturating_sub(target);
        counts[own] = counts[own] + wanted - spare;
        counts[other] = counts[other] + spare - wanted;
    }
    let wanted: Vec<(usize, usize)> = members.into_iter().zip(counts).collect();
    relabel(world, scene.seed, &wanted);
}

impl World {
    /// Makes grain `i` one of `species`, with the mass that its shape and the species' density
    /// give. It keeps its place and its motion.
    fn relabel(&mut self, i: usize, species: SpeciesId) {
        let material = self.species[usize::from(species.0)].material;
        let density = self.materials.get(material).density;
        let radius = self.grains.radius[i];
        let (volume, gyration) = match &self.polyhedra {
            Some(polyhedra) => {
                let shape = polyhedra.shape_of(i);
                (shape.volume, shape.mean_gyration())
            }
            None => (sphere_volume(radius), 0.4 * radius * radius),
        };
        let mass = volume * density;
        self.grains.species[i] = species;
        self.grains.mass[i] = mass;
        self.grains.inertia[i] = mass * gyration;
        if let Some(polyhedra) = &mut self.polyhedra {
            polyhedra.inertia[i] = mass * polyhedra.shape_of(i).gyration;
            polyhedra.set_spin(i, self.grains.spin[i]);
        }
    }
}

fn count(world: &World, species: usize) -> usize {
    let labels = world.grains.species.iter();
    labels
        .filter(|label| usize::from(label.0) == species)
        .count()
}

/// Labels the grains of the species in `wanted` anew, so that each has its number of grains.
fn relabel(world: &mut World, seed: u64, wanted: &[(usize, usize)]) {
    let members: Vec<usize> = (0..world.grains.len())
        .filter(|&grain| {
            let label = usize::from(world.grains.species[grain].0);
            wanted.iter().any(|&(species, _)| species == label)
        })
        .collect();
    for (grain, species) in labelled(seed, &members, wanted) {
        if world.grains.species[grain] != species {
            world.relabel(grain, species);
        }
    }
}

/// The grains `members` in label order, each with its species: the first run is of the first
/// species, and so on.
pub(super) fn labelled<'a>(
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
