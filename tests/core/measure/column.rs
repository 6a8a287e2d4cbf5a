//! The column and its laws at the values that the paper's own numbers give.

use super::*;
use grainfall::measure::{
    CRITICAL_ASPECT_RATIO, InitialColumn, cone_volume_law, contact_shares_law, run_out_law,
};
use std::f64::consts::PI;

/// A column of the paper's radius, as high as it is wide, of ten grains of which `second` are of
/// the second species.
fn mixture(frictions: [f64; 2], second: u16) -> InitialColumn {
    let mut world = column(0.025, 0.025, frictions);
    for i in 0..10 {
        let kind = u16::from(i < second);
        put(&mut world, DVec3::Y * 0.002 * f64::from(i), 1e-3, kind);
    }
    InitialColumn::of(&world).unwrap()
}

#[test]
fn effective_aspect_ratio_is_that_of_the_papers_mixtures() {
    // α_eff/α at α = 1 for shares of 10, 30 and 50 % of the second species, to three digits.
    for (frictions, expected) in [
        ([0.1, 0.1], [1.291, 1.291, 1.291]),
        ([0.1, 0.4], [1.262, 1.191, 1.111]),
        ([0.1, 0.8], [1.248, 1.124, 0.986]),
        ([0.4, 0.1], [0.950, 1.029, 1.111]),
        ([0.4, 0.4], [0.913, 0.913, 0.913]),
        ([0.4, 0.8], [0.892, 0.850, 0.808]),
        ([0.8, 0.8], [0.707, 0.707, 0.707]),
    ] {
        for (second, expected) in [1, 3, 5].into_iter().zip(expected) {
            let column = mixture(frictions, second);
            assert_close(column.effective_aspect_ratio(), expected, 5e-4);
        }
    }
}

#[test]
fn effective_aspect_ratio_follows_a_change_of_friction_and_of_the_floor() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    put(&mut world, DVec3::Y, 1e-3, 0);
    let effective = |world: &World| InitialColumn::of(world).unwrap().effective_aspect_ratio();
    // 2 √(1/(0.4 + 0.2)), 2 √(1/(0.4 + 0.6)), 2 √(1/(0.2 + 0.6))
    assert_close(effective(&world), 2.0 / 0.6_f64.sqrt(), 1e-15);
    let (first, floor) = (MaterialId(0), MaterialId(2));
    world.materials.pair_mut(first, first).friction = 0.3;
    assert_close(effective(&world), 2.0, 1e-15);
    world.materials.pair_mut(first, floor).friction = 0.2;
    assert_close(effective(&world), 2.0 / 0.8_f64.sqrt(), 1e-15);
}

#[test]
fn column_knows_its_scales() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    world.gravity = DVec3::new(0.0, -9.81, 0.0);
    for i in 0..1000 {
        put(&mut world, DVec3::Y * 0.001 * f64::from(i), 2.5e-3, 0);
    }
    let column = InitialColumn::of(&world).unwrap();
    assert_close(column.time_unit(), 0.05048, 5e-6);
    assert_close(column.aspect_ratio(), 2.0, 1e-15);
    // 1000 · 4/3 · 0.0025³ / (0.025² · 0.05) = 2/3, and the sum of a thousand volumes.
    assert_close(column.solid_fraction, 2.0 / 3.0, 1e-12);
    let packed = (2.0_f64 / 3.0).sqrt() * column.effective_aspect_ratio();
    assert_close(column.packed_aspect_ratio(), packed, 1e-12);
    assert_close(column.run_out(0.1), 3.0, 1e-14);
    // A cone of twice the radius and half the height has 4/6 of the volume.
    assert_close(column.cone_volume_ratio(0.05, 0.025), 2.0 / 3.0, 1e-14);
}

#[test]
fn other_containers_and_empty_columns_have_no_column() {
    let mut bare = on_floor();
    push(&mut bare, DVec3::Y, 1e-3);
    assert_eq!(InitialColumn::of(&bare), None);
    assert_eq!(InitialColumn::of(&column(0.025, 0.05, [0.1, 0.4])), None);
}

#[test]
fn laws_have_their_factors_exponents_and_break() {
    assert_eq!(run_out_law(1.0), 1.0);
    assert_eq!(cone_volume_law(1.0), 1.2);
    let exponent = |law: fn(f64) -> f64, at: f64| (law(1.01 * at) / law(at)).ln() / 1.01_f64.ln();
    assert_close(exponent(run_out_law, 2.0), 1.35, 1e-12);
    assert_close(exponent(run_out_law, 5.0), 0.5, 1e-12);
    assert_close(exponent(cone_volume_law, 2.0), 0.9, 1e-12);
    assert_close(exponent(cone_volume_law, 5.0), -0.6, 1e-12);
    let above = CRITICAL_ASPECT_RATIO * (1.0 + 1e-9);
    assert_close(
        run_out_law(above) / run_out_law(CRITICAL_ASPECT_RATIO),
        1.0,
        1e-8,
    );
    // The paper's two branches miss each other by 5 % at the break: 3.706 and 3.537.
    assert_close(cone_volume_law(CRITICAL_ASPECT_RATIO), 3.706, 1e-3);
    assert_close(cone_volume_law(above), 3.537, 1e-3);
}

#[test]
fn chance_gives_the_papers_contact_shares() {
    for (second, expected) in [
        (0.1, [0.81, 0.18, 0.01]),
        (0.3, [0.49, 0.42, 0.09]),
        (0.5, [0.25, 0.50, 0.25]),
    ] {
        for (share, expected) in contact_shares_law(second).into_iter().zip(expected) {
            assert_close(share, expected, 1e-15);
        }
    }
}

#[test]
fn solid_fraction_of_a_cylinder_of_grains_is_theirs() {
    let mut world = column(0.01, 0.02, [0.1, 0.4]);
    put(&mut world, DVec3::Y * 0.005, 0.005, 1);
    let expected = 4.0 / 3.0 * PI * 0.005_f64.powi(3) / (PI * 0.01 * 0.01 * 0.02);
    assert_close(
        InitialColumn::of(&world).unwrap().solid_fraction,
        expected,
        1e-14,
    );
}
