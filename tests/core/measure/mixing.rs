//! The mixing index of grains that are apart, mixed at random, alternate, and of unequal sizes.

use super::*;
use grainfall::measure::{Measure, mixing_index, sample};
use grainfall::scene::Scene;

/// Radius of the small grains [m].
const RADIUS: f64 = 1e-3;

/// Touching spheres on a cubic lattice, so many along each axis, of the kinds that `kind` gives.
fn lattice(count: i32, mut kind: impl FnMut([i32; 3]) -> u16) -> World {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    for (i, j, k) in
        (0..count).flat_map(|i| (0..count).flat_map(move |j| (0..count).map(move |k| (i, j, k))))
    {
        let place = 2.0 * RADIUS * DVec3::new(f64::from(i), f64::from(j), f64::from(k));
        put(&mut world, place, RADIUS, kind([i, j, k]));
    }
    world
}

#[test]
fn two_halves_have_the_index_of_the_layer_where_they_meet() {
    // On a cubic lattice each of 3 n² (n − 1) pairs touches; n² of them join two halves, whose ends
    // are as many: unlike pairs are half of all by chance.
    for count in [4, 8, 16] {
        let world = lattice(count, |[i, ..]| u16::from(2 * i >= count));
        let expected = 2.0 / (3.0 * f64::from(count - 1));
        assert_close(mixing_index(&world), expected, 1e-12);
    }
    // Far apart they never meet.
    let mut world = lattice(4, |_| 0);
    for i in 0..world.grains.len() {
        let place = world.grains.position[i] + DVec3::X;
        put(&mut world, place, RADIUS, 1);
    }
    assert_eq!(mixing_index(&world), 0.0);
}

#[test]
fn alternate_kinds_meet_twice_as_often_as_by_chance() {
    let world = lattice(8, |[i, j, k]| ((i + j + k) % 2) as u16);
    assert_close(mixing_index(&world), 2.0, 1e-12);
}

#[test]
fn kinds_at_random_have_one_within_their_scatter() {
    // A share p of one kind: the index of n pairs has a variance of about 1/n, by the pairs' own
    // labels; those that share a grain are independent, too, but for the share itself.
    let (count, cases) = (12, 40);
    let pairs = f64::from(3 * count * count * (count - 1));
    for share in [0.5, 0.2] {
        let indices: Vec<f64> = (0..cases)
            .map(|seed| {
                let mut noise = Noise::new(seed);
                mixing_index(&lattice(count, |_| u16::from(noise.unit() < share)))
            })
            .collect();
        let mean = indices.iter().sum::<f64>() / indices.len() as f64;
        let deviation =
            (indices.iter().map(|x| (x - 1.0).powi(2)).sum::<f64>() / indices.len() as f64).sqrt();
        let expected = pairs.sqrt().recip();
        assert!(
            (0.6..1.6).contains(&(deviation / expected)),
            "{deviation} beside {expected}"
        );
        // Four standard errors of the mean of the cases.
        assert_close(mean, 1.0, 4.0 * expected / f64::from(cases as u32).sqrt());
    }
}

#[test]
fn unequal_sizes_are_mixed_in_a_settled_bed_and_apart_when_they_are_told_apart_by_place() {
    let scene = Scene::open("two-sizes-drum").unwrap();
    let (run, _) = crate::runs::prepared(&scene, 1, crate::runs::shared_beds());
    let mut world = run.world().clone();
    // Placed at random and settled: 1.01 to 1.03 in a packing without walls, and the scatter of some
    // thousand pairs.
    assert_close(mixing_index(&world), 1.02, 0.06);
    // The same grains, one kind on the left and one on the right, as many of each.
    let mut places: Vec<f64> = world.grains.position.iter().map(|x| x.x).collect();
    places.sort_by(f64::total_cmp);
    let middle = places[places.len() / 2];
    for i in 0..world.grains.len() {
        let is_right = world.grains.position[i].x > middle;
        world.grains.species[i] = SpeciesId(u16::from(is_right));
    }
    let apart = mixing_index(&world);
    assert!((0.02..0.3).contains(&apart), "{apart}");
}

#[test]
fn three_kinds_are_mixed_too() {
    let mut noise = Noise::new(11);
    let mut world = lattice(12, |_| (3.0 * noise.unit()) as u16);
    world.species.push(world.species[0].clone());
    let pairs: f64 = 3.0 * 144.0 * 11.0;
    assert_close(mixing_index(&world), 1.0, 4.0 / pairs.sqrt());
}

#[test]
fn one_kind_has_no_mixing_index() {
    let mut alone = on_floor();
    push(&mut alone, DVec3::ZERO, RADIUS);
    push(&mut alone, DVec3::X * 2.0 * RADIUS, RADIUS);
    assert!(!Measure::MixingIndex.applies_to(&alone));
    assert!(sample(&alone).value(Measure::MixingIndex).is_nan());
    // Two that a scene names, of which one is there.
    let world = lattice(3, |_| 1);
    assert!(Measure::MixingIndex.applies_to(&world));
    assert!(sample(&world).value(Measure::MixingIndex).is_nan());
    // Grains without neighbours.
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    put(&mut world, DVec3::ZERO, RADIUS, 0);
    put(&mut world, DVec3::X, RADIUS, 1);
    assert!(mixing_index(&world).is_nan());
}
