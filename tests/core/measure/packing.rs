//! Packing fraction of beds whose φ is known.

use super::*;
use grainfall::measure::{MIDDLE_SHARE, packing_fraction, surface_line};
use std::f64::consts::PI;

fn phi(world: &World) -> f64 {
    let line = surface_line(world, MIDDLE_SHARE).expect("a surface");
    packing_fraction(world, &line)
}

/// A box of `cells` cells of `edge`, each with grains of radius `r` at the places of `basis` (in
/// edges).
fn crystal(cells: [i32; 3], edge: f64, basis: &[[f64; 3]], r: f64) -> World {
    let [nx, ny, nz] = cells;
    let mut world = open_box(edge * DVec3::new(f64::from(nx), f64::from(ny + 3), f64::from(nz)));
    for i in 0..nx {
        for j in 0..ny {
            for k in 0..nz {
                let corner = DVec3::new(f64::from(i), f64::from(j), f64::from(k));
                for place in basis {
                    push(&mut world, edge * (corner + DVec3::from(*place)), r);
                }
            }
        }
    }
    world
}

#[test]
fn simple_cubic_lattice_packs_to_pi_over_six() {
    let r = 0.002;
    let world = crystal([10, 8, 5], 2.0 * r, &[[0.5; 3]], r);
    // The cut goes through the middle of the second layer, so the answer is exact to rounding.
    assert_close(phi(&world), PI / 6.0, 1e-12);
}

#[test]
fn face_centred_cubic_lattice_packs_to_0_74() {
    let r = 0.001;
    let edge = 8.0_f64.sqrt() * r;
    let basis = [
        [0.25, 0.25, 0.25],
        [0.75, 0.75, 0.25],
        [0.75, 0.25, 0.75],
        [0.25, 0.75, 0.75],
    ];
    let world = crystal([12, 20, 6], edge, &basis, r);
    // The cut does not meet the middle of a layer: off by less than a quarter of one layer in 38.
    assert_close(phi(&world), PI / 18.0_f64.sqrt(), 0.74 * 0.25 / 38.0);
}

#[test]
fn tilted_bed_in_a_drum_packs_to_the_volume_of_its_grains() {
    let (radius, width, r) = (0.06, 0.02, 0.0005);
    let spacing = 4.0 * r;
    for (angle, top) in [(0.0, -0.02), (0.6, -0.02), (-0.3, 0.01)] {
        let mut world = drum(radius, width, 0.0);
        for x in lattice_in_drum(radius, width, spacing, angle, top) {
            push(&mut world, x, r);
        }
        let expected = 4.0 / 3.0 * PI * (r / spacing).powi(3);
        // The cut runs between two layers. What is left is how many lattice points a circle segment of 30 spacings holds.
        assert_close(phi(&world) / expected, 1.0, 0.02);
    }
}

#[test]
fn grain_above_the_surface_does_not_count() {
    let r = 0.002;
    let mut world = crystal([10, 8, 5], 2.0 * r, &[[0.5; 3]], r);
    push(&mut world, DVec3::new(0.02, 0.04, 0.01), r);
    if let Some(count) = world.grains.contact_count.last_mut() {
        *count = 0;
    }
    assert_close(phi(&world), PI / 6.0, 1e-12);
}

#[test]
fn layer_too_thin_to_cut_has_no_packing_fraction() {
    let r = 0.002;
    let world = crystal([10, 1, 5], 2.0 * r, &[[0.5; 3]], r);
    assert!(phi(&world).is_nan());
}
