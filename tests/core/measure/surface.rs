//! θ and h of surfaces whose angle is known.

use super::*;
use glam::DVec2;
use grainfall::measure::{MIDDLE_SHARE, SurfaceLine, surface_line};

const RADIUS: f64 = 0.0605;
const WIDTH: f64 = 0.022;
const GRAIN: f64 = 0.002;

fn line(world: &World) -> SurfaceLine {
    surface_line(world, MIDDLE_SHARE).expect("a surface")
}

fn lattice_bed(angle: f64, top: f64) -> World {
    let mut world = drum(RADIUS, WIDTH, 0.0);
    for x in lattice_in_drum(RADIUS, WIDTH, 2.0 * GRAIN, angle, top) {
        push(&mut world, x, GRAIN);
    }
    world
}

/// Random points below a plane at `angle` through the drum, `top` above its middle.
fn random_bed(angle: f64, top: f64, seed: u64) -> World {
    let mut world = drum(RADIUS, WIDTH, 0.0);
    let mut noise = Noise::new(seed);
    let normal = DVec2::from_angle(angle).perp();
    while world.grains.len() < 1500 {
        let x = noise.vector() * DVec3::new(RADIUS, RADIUS, 0.5 * WIDTH);
        let xy = x.truncate();
        if xy.length() < RADIUS - GRAIN && xy.dot(normal) < top {
            push(&mut world, x, GRAIN);
        }
    }
    world
}

#[test]
fn tilted_plane_of_grains_measures_its_angle() {
    for degrees in [-60.0_f64, -25.0, 0.0, 3.0, 22.0, 40.0, 60.0] {
        for top in [-0.02, 0.0, 0.01] {
            let world = lattice_bed(degrees.to_radians(), top);
            // The fitted grains' centres lie on the line to rounding.
            assert_close(line(&world).angle, degrees.to_radians(), 1e-9);
            assert!(line(&world).roughness < 1e-9);
        }
    }
}

#[test]
fn random_bed_measures_its_angle_on_average() {
    for degrees in [-35.0_f64, 0.0, 40.0, 60.0] {
        let beds = 40;
        let mut sum = 0.0;
        for seed in 0..beds {
            let angle = line(&random_bed(degrees.to_radians(), -0.02, seed)).angle;
            // About 19 tops scatter by some 0.7 mm below the plane over 80 mm: a standard error near 0.4°.
            assert_close(angle.to_degrees(), degrees, 2.0);
            sum += angle.to_degrees();
        }
        // Four standard errors of the mean of 40.
        assert_close(sum / beds as f64, degrees, 0.3);
    }
}

#[test]
fn box_measures_a_slope_from_floor_to_wall() {
    let mut world = open_box(DVec3::new(0.1, 0.1, 0.01));
    let slope = 30.0_f64.to_radians().tan();
    for i in 0..50 {
        for j in 0..50 {
            let (x, y) = (0.002 * f64::from(i) + 0.001, 0.002 * f64::from(j) + 0.001);
            if y < 0.02 + slope * x {
                push(&mut world, DVec3::new(x, y, 0.005), 0.001);
            }
        }
    }
    // The upright lattice stands off the slope by up to a grain's width, evenly along it: some 35 bins over 80 mm.
    assert_close(line(&world).angle.to_degrees(), 30.0, 1.0);
}

#[test]
fn line_runs_through_the_top_grains_and_spans_the_middle_of_the_surface() {
    let (angle, top) = (0.5, -0.02);
    let line = line(&lattice_bed(angle, top));
    let half_chord = (RADIUS * RADIUS - top * top).sqrt();
    let middle = DVec2::from_angle(angle).perp() * top;
    // Positions are exact to the rounding of a few operations on numbers below 0.1.
    assert!(line.midpoint.distance(middle) < 1e-12);
    assert_close(line.half_length, MIDDLE_SHARE * half_chord, 1e-12);
    assert_close(line.normal().dot(DVec2::from_angle(angle)), 0.0, 1e-12);
    assert_close(line.height(DVec2::ZERO), -top, 1e-12);
    assert_eq!(line.bins, 19);
}

#[test]
fn surface_of_a_bed_that_turns_rigidly_turns_with_it() {
    let turn = glam::DQuat::from_rotation_z(0.25);
    for seed in 0..40 {
        let mut world = random_bed(0.3, -0.02, seed);
        let before = line(&world).angle;
        for x in &mut world.grains.position {
            *x = turn * *x;
        }
        // The method has no preferred direction; rounding may move a grain over the edge of a bin where the fits end on
        // one, and then shifts the line by the last step: 0.4° over 256.
        assert_close(line(&world).angle - before, 0.25, 3e-5);
    }
}

#[test]
fn grain_in_flight_does_not_lift_the_surface() {
    let mut world = lattice_bed(0.4, -0.02);
    let before = line(&world);
    push(&mut world, DVec3::new(0.01, 0.04, 0.0), GRAIN);
    if let Some(count) = world.grains.contact_count.last_mut() {
        *count = 0;
    }
    assert_eq!(line(&world), before);
}

#[test]
fn bed_whose_contacts_were_never_counted_still_has_a_surface() {
    let mut world = lattice_bed(0.4, -0.02);
    world.grains.contact_count.fill(0);
    assert_close(line(&world).angle, 0.4, 1e-9);
}

#[test]
fn roughness_is_the_mean_distance_from_the_line() {
    let mut world = open_box(DVec3::new(0.08, 0.08, 0.01));
    let height = 0.0005;
    for i in 0..20 {
        let y = 0.03 + if i % 2 == 0 { height } else { -height };
        push(
            &mut world,
            DVec3::new(0.004 * f64::from(i) + 0.002, y, 0.005),
            GRAIN,
        );
    }
    // The line leans a little with the first and the last grain: 14 tops, slope below 3 h / (14 · 4 mm).
    assert_close(line(&world).roughness, height, 0.02 * height);
}

#[test]
fn highest_grain_of_a_mixture_is_the_one_that_reaches_highest() {
    let mut world = open_box(DVec3::new(0.1, 0.1, 0.02));
    for i in 0..25 {
        let x = 0.004 * f64::from(i) + 0.002;
        push(&mut world, DVec3::new(x, 0.030, 0.015), 0.003);
        push(&mut world, DVec3::new(x, 0.031, 0.005), 0.001);
    }
    // The large grains reach 33 mm, the small ones, whose centres are higher, only 32 mm.
    assert_close(line(&world).midpoint.y, 0.030, 1e-12);
}

#[test]
fn surface_is_undefined_without_container_or_grains_or_with_two_bins() {
    let mut heap = on_floor();
    push(&mut heap, DVec3::Y * GRAIN, GRAIN);
    assert_eq!(surface_line(&heap, MIDDLE_SHARE), None);
    assert_eq!(surface_line(&drum(RADIUS, WIDTH, 0.0), MIDDLE_SHARE), None);

    let mut pair = drum(RADIUS, WIDTH, 0.0);
    push(&mut pair, DVec3::new(-GRAIN, -0.03, 0.0), GRAIN);
    push(&mut pair, DVec3::new(GRAIN, -0.03, 0.0), GRAIN);
    assert_eq!(surface_line(&pair, MIDDLE_SHARE), None);
}
