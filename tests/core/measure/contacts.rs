//! Coordination number and largest overlap of contacts placed by hand.

use super::*;
use grainfall::measure::{coordination_number, largest_overlap};

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
