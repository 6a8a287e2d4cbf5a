//! The IMEX integrator: implicit dashpots keep momentum, close the energy balance, restitute to the
//! second order of the step, and agree with the explicit integrator as steps become short.

use super::*;
use glam::DVec3;
use grainfall::measure::EnergyLedger;
use grainfall::solver::advise;

/// Two grains, `integrator` and a step.
pub fn two(grains: &str, gravity: &str, integrator: &str, dt: f64) -> World {
    let text = format!(
        r#"(
            title: "Two bodies",
            materials: {{"m": (density: 2650, restitution: 0.1, friction: 0.4)}},
            container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")]),
            grains: List([{grains}]),
            gravity: {gravity},
            law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000, features: Full),
            integrator: {integrator},
        )"#
    );
    world(&text, dt)
}

/// Momentum, and angular momentum about the origin.
pub fn momenta(world: &World) -> [DVec3; 2] {
    let (grains, polyhedra) = (&world.grains, world.polyhedra.as_ref().unwrap());
    let mut sums = [DVec3::ZERO; 2];
    for i in 0..grains.len() {
        let momentum = grains.mass[i] * grains.velocity[i];
        sums[0] += momentum;
        sums[1] += grains.position[i].cross(momentum) + polyhedra.angular_momentum[i];
    }
    sums
}

/// Two boxes that hit each other out of centre, face on face and edge on face.
pub const COLLISION: &str = r#"
    (position: (0, 1, 0), shape: Box(size: (0.002, 0.003, 0.004)), rounding: 0.0001, material: "m",
        velocity: (0.4, 0, 0), spin: (3, 20, -5)),
    (position: (0.0022, 1.0008, 0.0005), shape: Box(size: (0.002, 0.002, 0.003)), rounding: 0.0001, material: "m",
        velocity: (-0.3, 0.05, 0.1), spin: (0, -10, 40))"#;

#[test]
fn collision_keeps_momentum_and_angular_momentum() {
    let mut world = two(COLLISION, "(0, 0, 0)", "Imex", 8e-6);
    let start = momenta(&world);
    let (mut solver, mut most, energy) = (Solver::new(1), 0, world.kinetic_energy());
    for _ in 0..200 {
        solver.advance(&mut world, 1).unwrap();
        most = most.max(world.polyhedra.as_ref().unwrap().features.len());
    }
    assert!(most > 4, "many features touch at once: {most}");
    assert!(world.contacts.is_empty(), "they part again");
    let lost = 1.0 - world.kinetic_energy() / energy;
    println!("{most} contacts at once, {lost:.3} of the energy lost");
    assert!(lost > 0.1);
    let end = momenta(&world);
    let sizes = [world.grains.mass[0] * 0.4, world.grains.mass[0] * 0.4 * 1.0];
    for (k, what) in ["momentum", "angular momentum"].into_iter().enumerate() {
        assert_below(what, (end[k] - start[k]).length() / sizes[k], 1e-14);
    }
    let ledger = EnergyLedger::of(&world);
    assert_below("residual", ledger.relative_residual().abs(), 1e-3);
}

/// Restitution of a sphere of polyhedra on the floor with steps of `dt`, mean over where in a step
/// it touches first.
pub fn restitution(integrator: &str, dt: f64) -> f64 {
    const OFFSETS: usize = 16;
    let rebound = |k: usize| {
        let height = 0.001 + 0.3 * dt * (5.0 + (k as f64 + 0.5) / OFFSETS as f64);
        let grain = format!(
            r#"(position: (0, {height}, 0), shape: Sphere, radius: 0.001, material: "m", velocity: (0, -0.3, 0)),
               (position: (1, 1, 0), shape: Box(size: (0.002, 0.002, 0.003)), rounding: 0.0001, material: "m")"#
        );
        let mut world = two(&grain, "(0, 0, 0)", integrator, dt);
        run(&mut world, 2e-3);
        assert!(world.contacts.is_empty());
        world.grains.velocity[0].y / 0.3
    };
    (0..OFFSETS).map(rebound).sum::<f64>() / OFFSETS as f64
}

/// Restitution of a spring and a dashpot that lets go where it would pull, `e^(−γ t)` at the time
/// when spring and dashpot are in balance: of `K δ = −c v`.
pub fn closed_form() -> f64 {
    let log = f64::ln(0.1);
    // The damping ratio that restitutes 0.1 where it may pull.
    let ratio = log.abs() / (std::f64::consts::PI.powi(2) + log * log).sqrt();
    // With ω = 1: δ = exp(−ζt) sin(√(1−ζ²) t)/√(1−ζ²).
    let damped = (1.0 - ratio * ratio).sqrt();
    let state = |t: f64| {
        let (sin, cos) = (damped * t).sin_cos();
        let decay = (-ratio * t).exp();
        (decay * sin / damped, decay * (cos - ratio * sin / damped))
    };
    // Bisection of δ + 2ζ v, which is positive at first.
    let (mut low, mut high) = (0.0, std::f64::consts::PI / damped);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let (overlap, speed) = state(middle);
        if overlap + 2.0 * ratio * speed > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    -state(low).1
}

#[test]
fn restitution_converges_to_the_closed_form_with_the_square_of_the_step() {
    let exact = closed_form();
    let errors = [32e-6, 16e-6, 8e-6].map(|dt| restitution("Imex", dt) - exact);
    let explicit = [4e-6, 2e-6].map(|dt| restitution("Explicit", dt) - exact);
    println!("e {exact:.5}; IMEX at 32, 16, 8 µs {errors:?}; explicit at 4, 2 µs {explicit:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.7..2.3).contains(&order), "order {order}");
    }
    let order = (explicit[0] / explicit[1]).log2();
    assert!((0.8..1.2).contains(&order), "explicit: order {order}");
}

#[test]
fn box_at_rest_sinks_by_its_weight_and_stays_still() {
    let grain = r#"(position: (0, 0.001, 0), shape: Box(size: (0.004, 0.002, 0.004)), rounding: 0.0001, material: "m")"#;
    let mut world = two(grain, "(0, -9.81, 0)", "Imex", 1e-5);
    run(&mut world, 0.03);
    let sunk = 0.001 - world.grains.position[0].y;
    let expected = world.grains.mass[0] * 9.81 / (4.0 * 4000.0);
    assert_relative("depth", sunk, expected, 1e-6);
    assert_below("energy", world.kinetic_energy(), 1e-20);
}

/// Asserts that `integrator` and the explicit one differ the less the shorter the step.
pub fn assert_agrees_with_explicit(integrator: &str) {
    // The first contacts of a column: before chaos has its say.
    let after = |integrator: &str, dt: f64| {
        let mut world = collapse::column("Full", integrator, dt);
        run(&mut world, 4e-3);
        world
    };
    let apart = |dt: f64| {
        let (a, b) = (after("Explicit", dt), after(integrator, dt));
        let pairs = a.grains.position.iter().zip(&b.grains.position);
        pairs.map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
    };
    let fallen = 0.5 * 9.81 * 4e-3 * 4e-3;
    let [coarse, middle, fine] = [1.6e-6, 0.8e-6, 0.4e-6].map(|dt| apart(dt) / fallen);
    println!("farthest apart, over the way fallen: {coarse:.2e} {middle:.2e} {fine:.2e}");
    assert!(fine < 0.7 * middle && middle < 0.7 * coarse && fine < 0.01);
}

/// Lets a small column collapse by `integrator` in steps of `dt` [s] and asserts that its energy
/// balance closes and that it neither heats up nor creeps at the end.
pub fn assert_comes_to_rest(integrator: &str, dt: f64) {
    let text = collapse::text_of_column("Full", integrator);
    let text = text.replace("radius_mm: 8, height_mm: 16", "radius_mm: 6, height_mm: 12");
    let mut world = world(&text, dt);
    run(&mut world, 0.4);
    let ledger = EnergyLedger::of(&world);
    println!("{ledger:?}");
    assert_below("residual", ledger.relative_residual().abs(), 1e-3);
    let (first, places) = (world.kinetic_energy(), world.grains.position.clone());
    run(&mut world, 0.1);
    let then = world.kinetic_energy();
    println!("kinetic energy {first:e} J, then {then:e} J");
    // What little is left swings in tangential springs, which have no dashpots.
    assert_below("heat", then / ledger.elastic, 1e-4);
    assert_below("heat after 0.1 s", then, first.max(1e-20));
    let pairs = world.grains.position.iter().zip(&places);
    let crept = pairs.map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
    assert_below("creep in 0.1 s [m]", crept, 1e-8);
}

#[test]
fn integrators_agree_as_steps_become_short() {
    assert_agrees_with_explicit("Imex");
}

#[test]
fn collapse_closes_its_energy_balance_and_comes_to_rest() {
    assert_comes_to_rest("Imex", 8e-6);
}

#[test]
fn integrator_of_the_scene_sets_the_limit_of_the_step() {
    let limits = |integrator: &str| {
        let text = collapse::text_of_column("Full", integrator);
        advise(&Scene::parse("column", &text).unwrap())
    };
    let (explicit, imex) = (limits("Explicit"), limits("Imex"));
    println!("{explicit:?}\n{imex:?}");
    let names: Vec<_> = imex.limits.iter().map(|limit| limit.name).collect();
    assert!(!names.contains(&"dashpots of a polyhedron"), "{names:?}");
    assert!(imex.time_step > 4.0 * explicit.time_step);
}
