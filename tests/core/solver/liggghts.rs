//! Ten wet grains that fall into a corner, step by step as in LIGGGHTS 3.8.
//!
//! The deck is `benches/liggghts/ten_grains.in`: bridges form, hold several grains at once, break and
//! form again, grains hit and slide along three walls. All that a step of the wet drum does but for
//! two: rolling friction, which at rest is another one there (that program turns the full torque
//! round at every step), and tangential springs, which do not turn about the normal there.

use super::turning::FollowsNormal;
use super::*;
use glam::DVec3;

/// The deck's grains, with its contact angle of half the product of 67.79° and 67.79° [rad] and
/// films of 7.53 % of their volume.
const SCENE: &str = r#"(
    title: "Ten wet grains",
    materials: {
        "glass": (youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500, restitution: 0.95, friction: 0.10, wet_friction: 0.10, rolling_friction: 0),
        "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
    },
    pairs: [(between: ("glass", "drum"), restitution: 0.72, friction: 0.15, wet_friction: 0.15, rolling_friction: 0)],
    container: Planes([
        (point: (0, 0, 0), normal: (1, 0, 0), material: "drum"),
        (point: (0.02, 0, 0), normal: (-1, 0, 0), material: "drum"),
        (point: (0, 0, 0), normal: (0, 1, 0), material: "drum"),
        (point: (0, 0.02, 0), normal: (0, -1, 0), material: "drum"),
        (point: (0, 0, 0), normal: (0, 0, 1), material: "drum"),
    ]),
    gravity: (0, 0, -9.81),
    grains: List([
        (position: (0.0034, 0.0033, 0.0032), velocity: (0, 0, 0), radius_mm: 3, material: "glass"),
        (position: (0.0099, 0.0035, 0.0033), velocity: (0, 0, -0.1), radius_mm: 3, material: "glass"),
        (position: (0.0164, 0.0032, 0.00325), velocity: (-0.1, 0, 0), radius_mm: 3, material: "glass"),
        (position: (0.0041, 0.0098, 0.0032), velocity: (0.1, -0.1, 0), radius_mm: 3, material: "glass"),
        (position: (0.0103, 0.0101, 0.0033), velocity: (0, 0, 0), radius_mm: 3, material: "glass"),
        (position: (0.0065, 0.0062, 0.009), velocity: (0.05, 0, -0.2), radius_mm: 3, material: "glass"),
        (position: (0.0129, 0.0064, 0.0089), velocity: (0, 0.1, -0.2), radius_mm: 3, material: "glass"),
        (position: (0.0073, 0.0089, 0.0152), velocity: (0, -0.1, -0.4), radius_mm: 3, material: "glass"),
        (position: (0.0136, 0.0087, 0.0156), velocity: (-0.2, 0, -0.5), radius_mm: 3, material: "glass"),
        (position: (0.0102, 0.005, 0.0215), velocity: (0.1, 0.1, -0.8), radius_mm: 3, material: "glass"),
    ]),
    liquid: (surface_tension: 0.064, contact_angle: 0.6999322546064225, viscosity: 0.00101, volume: 8.516229365351212e-08, law: Choices(volume: ShadedCap, angle: Mean, viscous_gap: OfEffectiveRadius(0.04), capillary_gap: Open)),
)"#;

/// The centres after 4000 steps of 20 µs [m], as the deck writes them.
#[allow(
    clippy::unreadable_literal,
    reason = "digits as the program prints them"
)]
const CENTRES: [[f64; 3]; 10] = [
    [3.571168093555e-03, 3.034088599881e-03, 2.992502673653e-03],
    [9.429969596290e-03, 4.330890476697e-03, 2.997647274578e-03],
    [1.646800962289e-02, 3.319453312571e-03, 3.004313852647e-03],
    [3.275979427656e-03, 1.314789164265e-02, 2.997716286977e-03],
    [9.195841988719e-03, 1.631640549184e-02, 3.948507287445e-03],
    [5.030488033488e-03, 5.071034212760e-03, 8.446638456540e-03],
    [1.067721881489e-02, 1.027520453779e-02, 3.316797842764e-03],
    [4.266542386097e-03, 1.606241498960e-02, 9.108623006650e-03],
    [1.511409056733e-02, 1.485780040945e-02, 4.007986305856e-03],
    [1.672410719038e-02, 8.988117798303e-03, 4.951361586510e-03],
];

#[test]
fn ten_wet_grains_go_the_ways_that_liggghts_gives_them() {
    let mut world = world(SCENE, 2e-5);
    Solver::with_law(FollowsNormal, 1)
        .advance(&mut world, 4000)
        .unwrap();
    let held = world.contacts.iter().filter(|c| c.bridge.is_some()).count();
    println!("{held} bridges, {} have broken", world.ledger.ruptures);
    assert!(held > 5 && world.ledger.ruptures > 3);
    let found = world.grains.position.iter();
    let off = found
        .zip(CENTRES)
        .map(|(x, centre)| (*x - DVec3::from_array(centre)).length());
    let worst = off.fold(0.0, f64::max);
    // The last digits of either program grow a million times in these impacts; a thousandth of an
    // overlap is left.
    assert_below("farthest from its place [m]", worst, 2e-9);
}
