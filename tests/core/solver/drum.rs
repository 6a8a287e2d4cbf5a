//! One grain in a turning drum against the same grain in a resting frame.

use super::*;
use glam::{DQuat, DVec3};

const DRUM_RADIUS: f64 = 0.0605;
const RADIUS: f64 = 3e-3;

fn drum(speed: f64, gravity: DVec3, position: DVec3, velocity: DVec3, spin: f64) -> World {
    world(
        &format!(
            r#"(
    title: "A grain in a drum",
    materials: {{"glass": (), "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35)}},
    pairs: [(between: ("glass", "drum"), restitution: 0.72, friction: 0.3)],
    container: Drum(radius: {DRUM_RADIUS}, width_mm: 22, speed: {speed}, material: "drum"),
    gravity: ({}, {}, {}),
    grains: List([(position: ({}, {}, {}), velocity: ({}, {}, {}), spin: (0, 0, {spin}), radius: {RADIUS}, material: "glass")]),
)"#,
            gravity.x,
            gravity.y,
            gravity.z,
            position.x,
            position.y,
            position.z,
            velocity.x,
            velocity.y,
            velocity.z,
        ),
        1e-5,
    )
}

/// Overlap at which the rim carries `force` [m].
fn sunk(force: f64) -> f64 {
    let modulus = 1.0 / ((1.0 - 0.21 * 0.21) / 63e6 + (1.0 - 0.35 * 0.35) / 12e6);
    (force / (4.0 / 3.0 * modulus * RADIUS.sqrt())).powf(2.0 / 3.0)
}

fn mass() -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * 2500.0
}

#[test]
fn grain_turns_with_the_drum_as_if_glued_where_nothing_else_pulls() {
    let speed = 10.0;
    let mut rho = DRUM_RADIUS - RADIUS;
    for _ in 0..50 {
        rho = DRUM_RADIUS - RADIUS + sunk(mass() * speed * speed * rho);
    }
    let start = DVec3::new(rho, 0.0, 0.0);
    let velocity = DVec3::new(0.0, speed * rho, 0.0);
    let mut world = drum(speed, DVec3::ZERO, start, velocity, speed);
    run(&mut world, 1.0);
    let grains = &world.grains;
    let expected = DQuat::from_rotation_z(speed * world.time()) * start;
    // Verlet lags behind on a circle by (Ω dt)²/24 of the angle: 4e-9; the overlap was found to rounding.
    assert_below(
        "off its circle, in radii",
        (grains.position[0] - expected).length() / RADIUS,
        1e-6,
    );
    assert_relative("spin", grains.spin[0].z, speed, 1e-9);
    // Rolling friction acts on the spin relative to the drum, which is none.
    assert_below(
        "rolling torque over μ_R F r",
        grains.rolling_torque[0].length() / (0.01 * mass() * speed * speed * rho * RADIUS),
        1e-4,
    );
    // 100 000 turns are added up, each sum rounded to 1e-16.
    let angle = world.container.angle;
    assert_relative("angle of the drum", angle, speed * world.time(), 1e-11);
}

#[test]
fn grain_on_a_turning_plate_turns_with_it() {
    // The back plate carries the grain, sliding and rolling friction keep it on its circle (Ω² ρ = 0.2 μ_R g), and nothing
    // twists it.
    let speed = 1.0;
    let (rho, z) = (0.02, -0.011 + RADIUS - sunk(mass() * 9.81));
    let start = DVec3::new(rho, 0.0, z);
    let gravity = DVec3::new(0.0, 0.0, -9.81);
    let velocity = DVec3::new(0.0, speed * rho, 0.0);
    let mut world = drum(speed, gravity, start, velocity, speed);
    run(&mut world, 1.0);
    let grains = &world.grains;
    let expected = DQuat::from_rotation_z(speed * world.time()) * start;
    // Friction has to stretch the tangential spring by m Ω² ρ/k_t, and rolling friction to take hold: some nanometres.
    assert_below(
        "off its circle, in radii",
        (grains.position[0] - expected).length() / RADIUS,
        1e-4,
    );
    assert_relative("spin", grains.spin[0].z, speed, 1e-6);
}

#[test]
fn turning_drum_and_turning_gravity_move_a_grain_alike() {
    // Seen from the drum, gravity turns backwards; the centrifugal term left out is 2e-5 g, and the Coriolis term, along
    // the normal, 1e-5 g at the grain's centimetre a second.
    let speed = 0.052_36;
    let gravity = DVec3::new(0.0, -9.81, 0.0);
    let start = DVec3::new(0.0, -(DRUM_RADIUS - RADIUS + sunk(mass() * 9.81)), 0.0);
    let velocity = DVec3::new(-speed * start.y, 0.0, 0.0);
    let mut turning = drum(speed, gravity, start, velocity, speed);
    let mut resting = drum(0.0, gravity, start, DVec3::ZERO, 0.0);
    let mut solver = Solver::new(1);
    let mut way = 0.0_f64;
    let mut apart = 0.0_f64;
    for _ in 0..1000 {
        run(&mut turning, 1e-3);
        for _ in 0..100 {
            // Gravity at the end of the step, where Verlet evaluates forces.
            let time = resting.time() + resting.clock.time_step;
            resting.set_gravity(DQuat::from_rotation_z(-speed * time) * gravity);
            solver.advance(&mut resting, 1).unwrap();
        }
        let seen = DQuat::from_rotation_z(-speed * turning.time()) * turning.grains.position[0];
        way = way.max((seen - start).length());
        apart = apart.max((seen - resting.grains.position[0]).length());
    }
    println!("way in the drum {way:.2e} m");
    assert!(way > RADIUS / 10.0, "the grain has rolled: {way}");
    assert_below("apart over way", apart / way, 1e-3);
}
