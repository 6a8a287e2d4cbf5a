//! One grain on a plane: sliding that turns into rolling, rolling that comes to rest, rest that
//! stays.

use super::*;
use glam::DVec3;
use grainfall::measure::EnergyLedger;

const RADIUS: f64 = 3e-3;
const G: f64 = 9.81;
const STEP: f64 = 2e-5;

/// Overlap at which the floor carries the grain [m].
fn sunk() -> f64 {
    let mass = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * 2500.0;
    let modulus = 63e6 / (2.0 * (1.0 - 0.21 * 0.21));
    (mass * G / (4.0 / 3.0 * modulus * RADIUS.sqrt())).powf(2.0 / 3.0)
}

/// Distance from the centre to the point where the tangential force acts [m].
fn arm() -> f64 {
    RADIUS - 0.5 * sunk()
}

/// A grain that the floor carries, gravity tilted by `slope` [rad] towards +x.
fn on_floor(friction: f64, rolling_friction: f64, slope: f64, (v, spin): (f64, f64)) -> World {
    let (sine, cosine) = slope.sin_cos();
    world(
        &format!(
            r#"(
    title: "A grain on a slope",
    materials: {{"m": (friction: {friction}, rolling_friction: {rolling_friction})}},
    container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")]),
    gravity: ({}, {}, 0),
    grains: List([(position: (0, {}, 0), velocity: ({v}, 0, 0), spin: (0, 0, {spin}), radius: {RADIUS}, material: "m")]),
)"#,
            G * sine,
            -G * cosine,
            RADIUS - sunk(),
        ),
        STEP,
    )
}

#[test]
fn sliding_grain_rolls_on_with_five_sevenths_of_its_speed() {
    for friction in [0.05, 0.2] {
        let speed = 0.5;
        let mut world = on_floor(friction, 0.0, 0.0, (speed, 0.0));
        let sliding_time = 2.0 * speed / (7.0 * friction * G);
        run(&mut world, 0.5 * sliding_time);
        // Steady sliding: exact but for the stretching of the spring in the first steps, μ m g/k_t long.
        let time = world.time();
        let v = speed - friction * G * time;
        assert_relative("sliding speed", world.grains.velocity[0].x, v, 1e-4);
        let spin = -2.5 * friction * G * time / RADIUS;
        assert_relative("spin", world.grains.spin[0].z, spin, 1e-3);

        run(&mut world, sliding_time);
        // Angular momentum about the line of contact points is conserved; the grain starts without forces and bounces by
        // some hundredths of its overlap, the arm with it.
        let share = 2.5 * (arm() / RADIUS).powi(2);
        let expected = speed * (1.0 - 1.0 / (1.0 + share));
        let v = world.grains.velocity[0].x;
        assert_relative("rolling speed", v, expected, 5e-6);
        // The arm is short by half the overlap.
        assert_relative("of 5/7", v / speed, 5.0 / 7.0, sunk() / RADIUS);
        assert_relative("pure rolling", -world.grains.spin[0].z * arm(), v, 5e-6);
    }
}

#[test]
fn sliding_ends_when_the_closed_form_says() {
    let (speed, friction) = (0.5, 0.05);
    let mut world = on_floor(friction, 0.0, 0.0, (speed, 0.0));
    let mut solver = Solver::new(1);
    let lost = |world: &World| world.grains.exchanged[0][1];
    let (mut before, mut end) = (0.0, 0.0);
    while world.time() < 0.5 {
        solver.advance(&mut world, 1).unwrap();
        if lost(&world) > before {
            (before, end) = (lost(&world), world.time());
        }
    }
    // The tangential spring swings about twice as fast as a contact lasts: 4e-4 s.
    let expected = 2.0 * speed / (7.0 * friction * G);
    assert_relative("end of sliding", end, expected, 5e-4 / expected);
    // What slid away is 2/7 of the kinetic energy: m v²/2 before, (7/10) m (5 v/7)² after.
    let mass = world.grains.mass[0];
    assert_relative(
        "energy lost",
        lost(&world),
        0.5 * mass * speed * speed * 2.0 / 7.0,
        1e-3,
    );
    let residual = EnergyLedger::of(&world).relative_residual().abs();
    assert_below("residual of the balance", residual, 1e-3);
}

#[test]
fn rolling_grain_slows_down_by_five_sevenths_of_rolling_friction_times_gravity() {
    for rolling_friction in [0.01, 0.05] {
        let speed = 0.1;
        let mut world = on_floor(0.4, rolling_friction, 0.0, (speed, -speed / arm()));
        run(&mut world, 0.05);
        let begin = world.grains.velocity[0].x;
        run(&mut world, 0.05);
        let deceleration = (begin - world.grains.velocity[0].x) / 0.05;
        // The arm differs from the radius by 2e-4 of it.
        let expected = 5.0 / 7.0 * rolling_friction * G;
        assert_relative("deceleration", deceleration, expected, 5e-4);
    }
}

#[test]
fn rolling_grain_comes_to_rest_and_stays() {
    let speed = 0.01;
    let mut world = on_floor(0.4, 0.05, 0.0, (speed, -speed / arm()));
    run(&mut world, 0.1);
    let x = world.grains.position[0].x;
    // v²/(2 a), and the last swing of the tangential spring, m a/k_t, a nanometre.
    let expected = speed * speed / (2.0 * 5.0 / 7.0 * 0.05 * G);
    assert_relative("way", x, expected, 2e-3);
    run(&mut world, 1.0);
    let crept = (world.grains.position[0].x - x).abs();
    assert_below("creep in 1 s, in radii", crept / RADIUS, 1e-6);
    let speed = world.grains.velocity[0].length();
    assert_below("speed at rest", speed, 1e-9);
}

#[test]
fn grain_stays_on_a_slope_below_its_rolling_friction() {
    for share in [0.5, 0.9, 0.99] {
        let slope = f64::atan(share * 0.01);
        let mut world = on_floor(0.4, 0.01, slope, (0.0, 0.0));
        run(&mut world, 0.2);
        let begin = world.grains.position[0].x;
        run(&mut world, 1.0);
        let grains = &world.grains;
        // A grain that rolled would be 0.07 m away at a slope of 0.01.
        assert_below(
            "creep in 1 s, in radii",
            (grains.position[0].x - begin).abs() / RADIUS,
            1e-6,
        );
        assert_below("speed", grains.velocity[0].length(), 1e-9);
        assert_below("surface speed", grains.spin[0].length() * RADIUS, 1e-9);
    }
}

/// Radii of a grain in a tight pit and of one on top of it [m].
const PIT: f64 = 3e-3;
const TOP: f64 = 2e-3;
/// Rolling friction of both.
const ROLLING: f64 = 0.1;

/// A grain that lies on another one, `slope` [rad] beside its top. Four walls hold the lower one:
/// with six contacts it yields to no torque, as a grain in a bed does.
fn on_another_grain(slope: f64) -> World {
    let (sine, cosine) = slope.sin_cos();
    let apart = PIT + TOP - 1e-6;
    let side = PIT - 2e-5;
    world(
        &format!(
            r#"(
    title: "A grain on a grain",
    materials: {{"m": (friction: 0.8, rolling_friction: {ROLLING})}},
    container: Planes([
        (point: (0, 0, 0), normal: (0, 1, 0), material: "m"),
        (point: (-{side}, 0, 0), normal: (1, 0, 0), material: "m"),
        (point: ({side}, 0, 0), normal: (-1, 0, 0), material: "m"),
        (point: (0, 0, -{side}), normal: (0, 0, 1), material: "m"),
        (point: (0, 0, {side}), normal: (0, 0, -1), material: "m"),
    ]),
    grains: List([
        (position: (0, {PIT}, 0), radius: {PIT}, material: "m"),
        (position: ({}, {}, 0), radius: {TOP}, material: "m"),
    ]),
)"#,
            apart * sine,
            PIT + apart * cosine,
        ),
        STEP,
    )
}

#[test]
fn grain_stays_on_another_below_the_rolling_friction_and_its_torque_is_what_holds_it() {
    // The torque about the contact is `m g r sin φ`, the bound `μ_R m g cos φ r*` with r* = 0.6 r.
    let bound = f64::atan(ROLLING * PIT / (PIT + TOP));
    for share in [0.3, 0.6, 0.9] {
        let mut world = on_another_grain(share * bound);
        run(&mut world, 0.3);
        let begin = world.grains.position[1].x;
        run(&mut world, 1.0);
        let grains = &world.grains;
        let crept = (grains.position[1].x - begin).abs();
        assert_below("creep in 1 s, in radii", crept / TOP, 1e-9);
        assert_below("surface speed", grains.spin[1].length() * TOP, 1e-12);
        let contact = world
            .contacts
            .iter()
            .find(|c| c.partner == Partner::Grain(1));
        let held = contact.expect("they touch").rolling.z.abs();
        let slope = (grains.position[1] - grains.position[0]).normalize().x;
        // The arm is short by half the overlap.
        let torque = grains.mass[1] * G * slope * TOP;
        assert_relative("torque that holds it", held, torque, 5e-3);
    }
}

#[test]
fn grain_rolls_off_another_above_the_rolling_friction() {
    let bound = f64::atan(ROLLING * PIT / (PIT + TOP));
    let mut world = on_another_grain(1.3 * bound);
    let begin = world.grains.position[1].x;
    run(&mut world, 0.3);
    let way = world.grains.position[1].x - begin;
    assert!(way > 0.1 * TOP, "it rolls: {way:e} m");
}

#[test]
fn grain_rolls_down_a_slope_above_its_rolling_friction() {
    for share in [1.1, 2.0, 10.0] {
        let slope = f64::atan(share * 0.01);
        let mut world = on_floor(0.4, 0.01, slope, (0.0, 0.0));
        run(&mut world, 0.1);
        let begin = world.grains.velocity[0].x;
        run(&mut world, 0.2);
        let acceleration = (world.grains.velocity[0].x - begin) / 0.2;
        let expected = 5.0 / 7.0 * G * (slope.sin() - 0.01 * slope.cos());
        // The drive is the difference of two terms `1/(share - 1)` times as large, of which the friction's has an arm
        // that is off by 2e-4.
        assert_relative(
            "acceleration",
            acceleration,
            expected,
            5e-4 * (1.0 + 1.0 / (share - 1.0)),
        );
    }
}

#[test]
fn spinning_top_keeps_its_spin() {
    // Rolling friction has no part along the normal, and a contact point no arm about it.
    let mut world = on_floor(0.4, 0.05, 0.0, (0.0, 0.0));
    world.grains.spin[0] = DVec3::Y * 50.0;
    run(&mut world, 0.1);
    assert_eq!(world.grains.spin[0], DVec3::Y * 50.0);
}

#[test]
fn grain_on_a_belt_takes_the_speed_of_the_belt() {
    let text = r#"(
    title: "A grain on a belt",
    materials: {"m": (friction: 0.3, rolling_friction: 0.02)},
    container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), velocity: (0.2, 0, 0), material: "m")]),
    grains: List([(position: (0, 0.002999, 0), radius_mm: 3, material: "m")]),
)"#;
    let mut world = world(text, STEP);
    // It slips until 2/7 of the belt's speed are its own and rolls back over the belt, slowed by rolling friction, at
    // rest on it after (5/7)(0.2)/(5/7 · 0.02 g) = 1.02 s.
    run(&mut world, 1.5);
    assert_relative("speed", world.grains.velocity[0].x, 0.2, 1e-9);
    assert_below("spin", world.grains.spin[0].length(), 1e-6);
    let residual = EnergyLedger::of(&world).relative_residual().abs();
    assert_below("residual of the balance", residual, 1e-3);
}
