//! Forces between two grains against LIGGGHTS 3.8
//! (`hertz tangential history rolling_friction cdt`), evaluated by that program with `run 0` for
//! set overlaps and velocities: no step taken, no tangential history.

use super::*;
use glam::DVec3;

/// Two of the paper's grains, r = 3 mm, wet friction.
fn pair(x: &str, vx: &str, vy: &str, spin: &str) -> World {
    world(
        &format!(
            r#"(
    title: "Two grains that overlap",
    materials: {{"glass": (youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500, restitution: 0.95, friction: 0.1, rolling_friction: 0.01)}},
    container: Nothing,
    gravity: (0, 0, 0),
    grains: List([
        (position: (0, 0, 0), radius_mm: 3, material: "glass"),
        (position: ({x}, 0, 0), velocity: ({vx}, {vy}, 0), spin: (0, 0, {spin}), radius_mm: 3, material: "glass"),
    ]),
)"#
        ),
        1e-5,
    )
}

/// Relative to the larger of the expected value and a nothing in its unit.
#[track_caller]
fn assert_vector(what: &str, found: DVec3, expected: DVec3) {
    // The reference has eleven digits; the overlap, a difference of lengths 600 times as large, has thirteen.
    let bound = 1e-9 * expected.length();
    let deviation = (found - expected).length();
    println!("{what}: off by {:.1e}", deviation / expected.length());
    assert!(deviation <= bound, "{what}: {found} instead of {expected}");
}

#[test]
fn forces_and_torques_are_those_of_liggghts() {
    let rows: Vec<Vec<&str>> = include_str!("pair_reference.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 5);
    for row in rows {
        let mut world = pair(row[0], row[1], row[2], row[3]);
        Solver::new(1).evaluate(&mut world).unwrap();
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let grains = &world.grains;
        let torque = |i: usize| grains.torque[i] + grains.rolling_torque[i];
        let force = DVec3::new(number(4), number(5), 0.0);
        assert_vector("force on grain 1", grains.force[0], force);
        assert_vector("force on grain 2", grains.force[1], -force);
        assert_vector("force in the contact", world.contacts[0].force, force);
        for (i, column) in [(0, 6), (1, 7)] {
            let expected = DVec3::Z * number(column);
            if expected == DVec3::ZERO {
                assert_eq!(torque(i), DVec3::ZERO);
            } else {
                assert_vector("torque", torque(i), expected);
            }
        }
    }
}
