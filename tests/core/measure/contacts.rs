//! Coordination number and largest overlap of contacts placed by hand.

use super::*;
use grainfall::measure::{
    GrainQuantity, contact_shares, coordination_number, largest_overlap, walls_touched,
};
use grainfall::scene::Scene;

#[test]
fn chain_of_four_touches_one_and_a_half_on_average() {
    let mut world = on_floor();
    for i in 0..4 {
        push(
            &mut world,
            DVec3::new(0.002 * f64::from(i), 0.001, 0.0),
            0.001,
        );
    }
    for i in 0..3 {
        touch(&mut world, i, Partner::Grain(i + 1), DVec3::ZERO);
        touch(&mut world, i, Partner::Wall(0), DVec3::ZERO);
    }
    // Three contacts between grains, counted from both sides; the floor does not count.
    assert_eq!(coordination_number(&world), 1.5);
}

#[test]
fn largest_overlap_is_relative_to_the_smaller_grain() {
    let mut world = on_floor();
    push(&mut world, DVec3::new(0.0, 0.002, 0.0), 0.002);
    push(&mut world, DVec3::new(0.00297, 0.002, 0.0), 0.001);
    assert_eq!(largest_overlap(&world), 0.0);
    touch(&mut world, 0, Partner::Grain(1), DVec3::ZERO);
    // Rounding of differences of numbers near 3e-3, relative to 3e-5.
    assert_close(largest_overlap(&world), 0.03, 1e-13);
}

#[test]
fn largest_overlap_counts_walls() {
    let mut world = on_floor();
    push(&mut world, DVec3::new(0.0, 0.0019, 0.0), 0.002);
    touch(&mut world, 0, Partner::Wall(0), DVec3::ZERO);
    assert_close(largest_overlap(&world), 0.05, 1e-13);
}

#[test]
fn coordination_of_no_grains_is_undefined() {
    assert!(coordination_number(&on_floor()).is_nan());
}

#[test]
fn pairs_of_two_species_are_counted_by_kind() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    for (i, kind) in [0, 0, 0, 1, 1].into_iter().enumerate() {
        put(&mut world, DVec3::X * 0.002 * i as f64, 1e-3, kind);
    }
    // 11 three times, 12 four times, 22 once; one pair is open and the floor does not count.
    for (a, b) in [
        (0, 1),
        (0, 2),
        (1, 2),
        (0, 3),
        (1, 3),
        (2, 3),
        (2, 4),
        (3, 4),
        (0, 4),
    ] {
        touch(&mut world, a, Partner::Grain(b), DVec3::ZERO);
    }
    world.contacts[8].touching = false;
    touch(&mut world, 4, Partner::Wall(0), DVec3::ZERO);
    assert_eq!(contact_shares(&world), [0.375, 0.5, 0.125]);
    world.species.push(world.species[0].clone());
    assert!(contact_shares(&world).iter().all(|share| share.is_nan()));
}

#[test]
fn overlap_of_polyhedra_is_relative_to_the_smaller_rounding() {
    let mut world = two_rounded_bodies();
    assert_eq!(largest_overlap(&world), 0.0);
    let polyhedra = world.polyhedra.as_mut().unwrap();
    polyhedra.features = vec![
        feature(0, Partner::Grain(1), 0, 2e-6),
        feature(0, Partner::Wall(0), 0, 3e-6),
        feature(1, Partner::Wall(0), 0, 1.5e-6),
    ];
    // 2e-6 of 1e-4, 3e-6 of 2e-4, 1.5e-6 of 1e-4
    assert_close(largest_overlap(&world), 0.02, 1e-16);
}

#[test]
fn the_mean_of_the_grains_coordination_is_that_of_the_bed() {
    let scene = Scene::open("small-drum").unwrap();
    let (run, _) = crate::runs::prepared(&scene, 1, crate::runs::shared_beds());
    let mut counts = Vec::new();
    GrainQuantity::Coordination.append(run.world(), &mut counts);
    let mean = counts.iter().sum::<f64>() / counts.len() as f64;
    assert!((mean - coordination_number(run.world())).abs() < 1e-12 && mean > 2.0);
    // Those at the rim touch it too, which is told apart.
    let walls: usize = (0..counts.len())
        .map(|i| walls_touched(run.world(), i))
        .sum();
    assert!(walls > 10, "{walls}");
}
