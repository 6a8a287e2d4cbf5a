//! How well the kinds of grains are mixed: the mixing index.
//!
//! With `e_ab` the share of all ends of pairs of neighbours that are on a grain of kind a with a
//! neighbour of kind b, and `a_a = Σ_b e_ab`, the index is
//! `I = (1 − Σ e_aa) / (1 − Σ a_a²)`: how many pairs of neighbours are of unlike grains, over how
//! many would be if neighbours met by chance. It is `1 − r` of Newman's assortativity coefficient
//! (Phys. Rev. E 67, 026126 (2003)): 0 where kinds never meet, 1 where they are mixed at random,
//! above 1 where they alternate.
//!
//! Two grains are neighbours when the gap between their surfaces (of polyhedra: between the spheres
//! round them) is less than a third of the grains' mean radius, which for equal grains are the
//! neighbours of the granular temperature; grains in flight have some, too. Among the indices in use
//! this one suits drums and columns best. That of Lacey (J. Appl. Chem. 4, 257 (1954)) depends on
//! the size of the cells in which a composition is counted, on how a free surface cuts them, and on
//! whether grains of unequal sizes count by number or by volume. Here no cell is chosen, and a kind
//! has the weight of the neighbours that it has. One gap for all pairs is what keeps the index of
//! unequal sizes near 1: in dense random packings of 2000 spheres of two radii, 1 : 1.25, 1 : 2 and
//! 1 : 3, it is 1.00, 1.01 to 1.03 and 1.04; with neighbours within 7/6 of the sum of both radii it
//! would be 1.01, 1.03 to 1.05 and 1.10.
//!
//! What it does not tell is the scale on which kinds are apart: two halves have the index of the
//! layer where they meet, some hundredths, and so have clusters of many grains.

use super::near_pairs::for_each_near_pair;
use crate::world::World;

/// Gap up to which two grains are neighbours, in mean radii.
const GAP: f64 = 1.0 / 3.0;

/// The mixing index of `world`, any number of kinds: a kind is one of [`World::species`]. NaN where
/// all grains that have neighbours are of one kind.
pub fn mixing_index(world: &World) -> f64 {
    if world.species.len() < 2 {
        return f64::NAN;
    }
    let species = &world.grains.species;
    let mut ends = vec![0_u64; world.species.len()];
    let mut unlike = 0_u64;
    for_each_neighbour(world, |i, j| {
        ends[usize::from(species[i].0)] += 1;
        ends[usize::from(species[j].0)] += 1;
        unlike += u64::from(species[i] != species[j]);
    });
    let all: u64 = ends.iter().sum();
    let share = |ends: &u64| *ends as f64 / all as f64;
    let alike: f64 = ends.iter().map(share).map(|share| share * share).sum();
    let by_chance = 1.0 - alike;
    if by_chance > 0.0 {
        2.0 * unlike as f64 / all as f64 / by_chance
    } else {
        f64::NAN
    }
}

/// Calls `visit(i, j)` once for each pair of neighbours.
fn for_each_neighbour(world: &World, mut visit: impl FnMut(usize, usize)) {
    let radius = &world.grains.radius;
    let gap = GAP * radius.iter().sum::<f64>() / radius.len() as f64;
    let largest = radius.iter().copied().fold(0.0, f64::max);
    let position = &world.grains.position;
    for_each_near_pair(position, 2.0 * largest + gap, |i, j, offset| {
        let reach = radius[i] + radius[j] + gap;
        if offset.length_squared() < reach * reach {
            visit(i, j);
        }
    });
}
