//! The implicit integrator: springs and dashpots for all bodies together keep momentum, close the
//! energy balance, restitute to the second order of the step, let piles rest, and agree with the
//! explicit integrator as steps become short. Same bits for threads, lanes and slices:
//! [`super::collapse`].

use super::imex::{
    COLLISION, assert_agrees_with_explicit, assert_comes_to_rest, closed_form, momenta,
    restitution, two,
};
use super::*;
use grainfall::measure::EnergyLedger;
use grainfall::solver::advise;

/// A step that explicit springs would not bear where several features touch [s].
const STEP: f64 = 2e-5;

#[test]
fn collision_keeps_momentum_and_angular_momentum() {
    let mut world = two(COLLISION, "(0, 0, 0)", "Implicit", STEP);
    let start = momenta(&world);
    let (mut solver, mut most, energy) = (Solver::new(1), 0, world.kinetic_energy());
    for _ in 0..100 {
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

#[test]
fn restitution_converges_to_the_closed_form_with_the_square_of_the_step() {
    let exact = closed_form();
    let of = |dt| restitution("Implicit", dt) - exact;
    let long = [32e-6, 16e-6, 8e-6].map(of);
    let short = [4e-6, 2e-6, 1e-6].map(of);
    println!("e {exact:.5}; at 32, 16, 8 µs {long:?}; at 4, 2, 1 µs {short:?}");
    assert!(long.iter().all(|error| error.abs() < 1e-3));
    for pair in short.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.6..2.4).contains(&order), "order {order}");
    }
}

/// The deepest overlap while a box falls flat on the floor in steps of `dt` [s], as the mean of
/// sixteen moments of a step in which it may get there [m].
fn deepest_fall(integrator: &str, dt: f64) -> f64 {
    const OFFSETS: usize = 16;
    let deepest = |k: usize| {
        let height = 0.001 + 0.3 * dt * (5.0 + (k as f64 + 0.5) / OFFSETS as f64);
        let grain = format!(
            r#"(position: (0, {height}, 0), shape: Box(size: (0.004, 0.002, 0.004)), rounding: 0.0001,
                material: "m", velocity: (0, -0.3, 0))"#
        );
        let mut world = two(&grain, "(0, 0, 0)", integrator, dt);
        let (mut solver, mut deepest) = (Solver::new(1), 0.0_f64);
        for _ in 0..(2e-3 / dt) as u64 {
            solver.advance(&mut world, 1).unwrap();
            let features = &world.polyhedra.as_ref().unwrap().features;
            deepest = features.iter().map(|f| f.overlap).fold(deepest, f64::max);
        }
        deepest
    };
    (0..OFFSETS).map(deepest).sum::<f64>() / OFFSETS as f64
}

#[test]
fn contacts_that_begin_within_a_step_are_no_deeper_than_their_dashpots_let_them() {
    let exact = deepest_fall("Explicit", 2e-7);
    let long = [64e-6, 32e-6, 16e-6].map(|dt| deepest_fall("Implicit", dt) / exact - 1.0);
    println!("{exact:.3e} m; with 64, 32, 16 µs by {long:.4?} deeper");
    // Seen at the step's end only they would be deeper by half of the way that is closed in it.
    assert!(0.5 * 0.3 * 64e-6 > exact);
    for (error, most) in long.into_iter().zip([0.1, 0.03, 0.01]) {
        assert_below("depth", error.abs(), most);
    }
}

#[test]
fn gap_that_another_contact_holds_open_does_not_pull() {
    // A small sphere flies between two larger ones, 40° off to either side. It meets one in the step
    // after the next, and would reach the other within the same step were it not stopped.
    const LONG: f64 = 2e-4;
    let (sin, cos) = 40_f64.to_radians().sin_cos();
    let larger = |gap: f64, side: f64| {
        let distance = 0.0027 + (cos + gap) * 0.3 * LONG;
        let (x, z) = (distance * cos, side * distance * sin);
        format!(r#"(position: ({x}, 1, {z}), shape: Sphere, radius: 0.0017, material: "m"),"#)
    };
    let grains = format!(
        r#"(position: (0, 1, 0), shape: Sphere, radius: 0.001, material: "m", velocity: (0.3, 0, 0)), {} {}
           (position: (1, 1, 0), shape: Box(size: (0.002, 0.002, 0.003)), rounding: 0.0001, material: "m")"#,
        larger(0.1, 1.0),
        larger(0.72, -1.0),
    );
    let mut world = two(&grains, "(0, 0, 0)", "Implicit", LONG);
    Solver::new(1).advance(&mut world, 1).unwrap();
    let [small, first, second] = [0, 1, 2].map(|i| world.grains.velocity[i].length());
    println!("{small} m/s; {first:e} and {second:e} m/s");
    assert!(world.contacts.is_empty(), "nothing touches yet");
    assert!(small < 0.29 && first > 1e-3, "one is met");
    assert_eq!(second, 0.0, "the other is not");
}

#[test]
fn free_flight_is_that_of_the_explicit_integrator_to_the_bit() {
    let after = |integrator: &str| {
        let mut world = two(COLLISION, "(0, -9.81, 0)", integrator, STEP);
        run(&mut world, 1e-4);
        assert!(world.contacts.is_empty());
        (
            world.grains.position.clone(),
            world.polyhedra.unwrap().orientation,
        )
    };
    assert_eq!(after("Implicit"), after("Explicit"));
}

/// A box on the floor, and one far away.
fn resting(velocity: &str) -> World {
    let grain = format!(
        r#"(position: (0, 0.001, 0), shape: Box(size: (0.004, 0.002, 0.004)), rounding: 0.0001, material: "m",
            velocity: {velocity})"#
    );
    two(&grain, "(0, -9.81, 0)", "Implicit", STEP)
}

#[test]
fn box_at_rest_sinks_by_its_weight_and_stays_still() {
    let mut world = resting("(0, 0, 0)");
    run(&mut world, 0.03);
    let sunk = 0.001 - world.grains.position[0].y;
    let expected = world.grains.mass[0] * 9.81 / (4.0 * 4000.0);
    assert_relative("depth", sunk, expected, 1e-6);
    assert_below("energy", world.kinetic_energy(), 1e-20);
}

#[test]
fn sliding_box_slows_down_by_its_friction() {
    let mut world = resting("(0.2, 0, 0)");
    // It sinks into the floor at first.
    run(&mut world, 0.005);
    let (start, fast) = (world.grains.position[0].x, world.grains.velocity[0].x);
    run(&mut world, 0.02);
    let slowed = (fast - world.grains.velocity[0].x) / 0.02;
    assert_relative("deceleration", slowed, 0.4 * 9.81, 1e-3);
    run(&mut world, 0.055);
    assert_below("speed at rest", world.grains.velocity[0].length(), 1e-6);
    let way = fast * fast / (2.0 * 0.4 * 9.81);
    assert_relative("way", world.grains.position[0].x - start, way, 2e-3);
}

#[test]
fn integrators_agree_as_steps_become_short() {
    assert_agrees_with_explicit("Implicit");
}

#[test]
fn collapse_closes_its_energy_balance_and_comes_to_rest() {
    assert_comes_to_rest("Implicit", STEP);
}

#[test]
fn neither_springs_nor_dashpots_of_crowded_grains_limit_the_step() {
    let limits = |integrator: &str| {
        let text = collapse::text_of_column("Full", integrator);
        advise(&Scene::parse("column", &text).unwrap())
    };
    let (imex, implicit) = (limits("Imex"), limits("Implicit"));
    println!("{imex:?}\n{implicit:?}");
    let names: Vec<_> = implicit.limits.iter().map(|limit| limit.name).collect();
    assert_eq!(names, ["linear contact", "way in a step"]);
    assert!(implicit.time_step > 2.0 * imex.time_step);
    // A tall column falls fast: no grain may move past its rounding in a step.
    let tall =
        collapse::text_of_column("Full", "Implicit").replace("height_mm: 16", "height_mm: 1600");
    let tall = advise(&Scene::parse("column", &tall).unwrap());
    assert_eq!(tall.limits[0].name, "way in a step");
    let way = tall.time_step * (2.0 * 9.81 * 1.6_f64).sqrt();
    assert_relative("way", way, 0.2 * 0.3e-3, 1e-12);
}
