//! Map of the velocities in the cross-section.

use super::*;
use grainfall::measure::{
    FlowHistory, kernel_reach, mean_velocity, sample_and_surface, velocity_map,
};

const RADIUS: f64 = 0.0605;
const WIDTH: f64 = 0.022;
const GRAIN: f64 = 0.002;
const SPIN: f64 = 0.5;

/// A half full drum, its grains on a square lattice, that turns as a rigid body.
fn turning_bed() -> World {
    let mut world = drum(RADIUS, WIDTH, 0.0);
    for x in lattice_in_drum(RADIUS, WIDTH, 2.0 * GRAIN, 0.0, 0.0) {
        push(&mut world, x, GRAIN);
    }
    for (v, x) in (world.grains.velocity.iter_mut()).zip(&world.grains.position) {
        *v = DVec3::Z.cross(*x) * SPIN;
    }
    world
}

#[test]
fn map_of_a_rigid_rotation_is_that_rotation() {
    let world = turning_bed();
    let map = velocity_map(&world, 0.0).unwrap();
    let reach = kernel_reach(&world);
    let mut compared = 0;
    for (place, velocity) in map.points() {
        let inside = place.length() < RADIUS - 2.0 * GRAIN - reach && place.y < -reach - GRAIN;
        if inside {
            // Summed over this lattice, the cut-off kernel has its middle up to 0.28 mm beside the point.
            let error = velocity - SPIN * place.perp();
            assert!(error.length() < 0.3e-3 * SPIN, "{place}: {error}");
            compared += 1;
        }
    }
    assert!(compared > 80, "{compared}");
}

#[test]
fn map_seen_from_the_turning_drum_shows_rest() {
    let map = velocity_map(&turning_bed(), SPIN).unwrap();
    // Rounding.
    assert!(map.largest_speed() < 1e-15, "{}", map.largest_speed());
}

#[test]
fn map_has_points_where_grains_are_and_none_elsewhere() {
    let world = turning_bed();
    let map = velocity_map(&world, 0.0).unwrap();
    for row in 0..map.rows() {
        for column in 0..map.columns {
            let place = map.point(column, row);
            let near = |x: &DVec3| (x.truncate() - place).length() < GRAIN;
            let covered = world.grains.position.iter().any(near);
            assert_eq!(map.at(column, row).is_some(), covered, "{place}");
        }
    }
    assert_eq!(map.at(map.columns, 0), None);
    assert_eq!(velocity_map(&drum(RADIUS, WIDTH, 0.0), 0.0), None);
}

#[test]
fn map_holds_the_kernel_means_of_its_points() {
    let mut world = turning_bed();
    let mut noise = Noise::new(4);
    for velocity in &mut world.grains.velocity {
        *velocity += noise.vector();
    }
    let map = velocity_map(&world, 0.0).unwrap();
    for (place, velocity) in map.points() {
        let mean = mean_velocity(&world, place, kernel_reach(&world)).unwrap();
        // Rounding of sums of a hundred grains.
        assert!((velocity - mean).length() < 1e-12, "{place}");
    }
}

#[test]
fn grains_strewn_wide_are_mapped_coarsely() {
    let mut world = turning_bed();
    push(&mut world, DVec3::X * 1e6, GRAIN);
    let map = velocity_map(&world, 0.0).unwrap();
    assert!(map.velocity.len() < 1000, "{}", map.velocity.len());
}

#[test]
fn fastest_moment_is_the_hottest_of_those_that_count() {
    let mut world = turning_bed();
    world.clock = Clock::new(0.5);
    let mut history = FlowHistory::default();
    let mut noise = Noise::new(2);
    // One state each half second, with these sizes of fluctuations.
    for (half_seconds, size) in [5.0, 3.0, 2.0, 2.5, 0.0, 1.0, 0.5].into_iter().enumerate() {
        world.clock.step = half_seconds as u64;
        for velocity in &mut world.grains.velocity {
            *velocity = 1e-2 * size * noise.vector();
        }
        let (sample, line) = sample_and_surface(&world);
        history.add(&world, &sample, &line.unwrap());
    }
    let fastest = |from: f64| history.fastest_since(from).map(|map| map.time);
    assert_eq!(fastest(0.0), Some(0.0));
    assert_eq!(fastest(0.7), Some(1.5));
    assert_eq!(fastest(1.0), Some(1.5));
    assert_eq!(fastest(2.0), Some(2.5));
    assert_eq!(fastest(3.0), Some(3.0));
    assert_eq!(fastest(4.0), None);
}
