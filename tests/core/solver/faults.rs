//! Absurd states stop the solver with a fault that names grain, time and quantity, and leave the
//! world as it was.

use super::*;
use glam::DVec3;
use grainfall::solver::{Fault, FaultKind, Processor};

const STEP: f64 = 1e-5;

/// Three grains in a box; the one at index 1 is what tests tamper with.
fn three_in_a_box() -> World {
    world(
        r#"(
    title: "Three grains in a box",
    materials: {"m": ()},
    container: Box(min: (-0.02, -0.02, -0.02), max: (0.02, 0.02, 0.02), material: "m"),
    grains: List([
        (position: (-0.01, 0, 0), radius_mm: 3, material: "m"),
        (position: (0, 0.001, 0), radius_mm: 3, material: "m"),
        (position: (0.01, 0, 0), radius_mm: 3, material: "m"),
    ]),
)"#,
        STEP,
    )
}

/// The fault of 100 steps, for one thread and two, lanes and the scalar twin alike.
#[track_caller]
fn fault_of(world: &World) -> Fault {
    let fault = |mut solver: Solver| {
        let mut tried = world.clone();
        let fault = solver.advance(&mut tried, 100).unwrap_err();
        assert_eq!(tried.hash(), world.hash(), "the world is as it was");
        assert_eq!(tried.container, world.container);
        assert_eq!(tried.contacts.len(), world.contacts.len());
        fault
    };
    let first = fault(Solver::new(1));
    for solver in [Solver::new(2), Solver::on(Processor::Scalar, 1)] {
        assert_eq!(fault(solver).to_string(), first.to_string());
    }
    println!("{first}");
    first
}

#[test]
fn number_that_is_none_is_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut world = three_in_a_box();
        world.grains.position[1].y = bad;
        let fault = fault_of(&world);
        assert_eq!(
            (fault.grain, fault.kind),
            (1, FaultKind::NotFinite("position"))
        );
        assert_eq!((fault.time, fault.good_time), (0.0, 0.0));

        let mut world = three_in_a_box();
        world.grains.velocity[1].z = bad;
        let fault = fault_of(&world);
        assert_eq!(fault.grain, 1);
        assert!(matches!(fault.kind, FaultKind::NotFinite(_)), "{fault}");

        let mut world = three_in_a_box();
        world.grains.spin[1].x = bad;
        let fault = fault_of(&world);
        assert_eq!((fault.grain, fault.kind), (1, FaultKind::NotFinite("spin")));
    }
}

#[test]
fn force_that_is_no_number_is_a_fault() {
    let mut world = three_in_a_box();
    world.grains.force[1].x = f64::NAN;
    assert_eq!(fault_of(&world).grain, 1);
    let mut world = three_in_a_box();
    world.gravity = DVec3::splat(f64::NAN);
    fault_of(&world);
}

#[test]
fn grain_shot_through_a_wall_is_caught() {
    for speed in [31.0, 1e3, 1e10, 1e100, 1e200] {
        let mut world = three_in_a_box();
        world.grains.velocity[1] = DVec3::new(0.0, speed, 0.0);
        let fault = fault_of(&world);
        assert_eq!(fault.grain, 1);
        assert!(
            matches!(
                fault.kind,
                FaultKind::TooFast(_) | FaultKind::BehindWall(_) | FaultKind::NotFinite(_)
            ),
            "{fault}"
        );
        assert!(fault.time > 0.0 && fault.time <= 100.0 * STEP);
    }
}

#[test]
fn grain_behind_a_wall_is_told_how_far() {
    let mut world = three_in_a_box();
    world.grains.position[1] = DVec3::new(0.0, -0.021, 0.0);
    let fault = fault_of(&world);
    assert_eq!(fault.grain, 1);
    let FaultKind::BehindWall(depth) = fault.kind else {
        panic!("{fault}")
    };
    // It has fallen for one step of 1e-5 s.
    assert_relative("depth", depth, 0.001, 1e-6);
}

#[test]
fn grains_at_one_place_are_a_fault() {
    let mut world = three_in_a_box();
    world.grains.position[1] = world.grains.position[0];
    let fault = fault_of(&world);
    assert!(fault.grain < 2, "{fault}");
}

#[test]
fn far_too_long_step_is_a_fault_that_advises_a_shorter_one() {
    let scene = Scene::open("small-drum").unwrap();
    let mut world = build(&scene, 2e-3);
    world.grains.velocity.fill(DVec3::new(0.3, -0.3, 0.0));
    let mut solver = Solver::new(1);
    let mut before = world.hash();
    let fault = loop {
        match solver.advance(&mut world, 10) {
            Ok(()) => before = world.hash(),
            Err(fault) => break fault,
        }
        assert!(world.clock.step < 10_000, "nothing went wrong");
    };
    assert_eq!(world.hash(), before);
    assert_eq!(fault.good_time, world.time());
    assert!(
        fault.time > fault.good_time && fault.time <= world.clock.time_at(world.clock.step + 10)
    );
    let message = fault.to_string();
    println!("{message}");
    assert!(message.contains(&format!("grain {}", fault.grain)));
    assert!(message.contains("smaller time step"));
}

#[test]
fn solver_goes_on_after_a_fault() {
    let mut solver = Solver::new(2);
    let mut bad = three_in_a_box();
    bad.grains.position[1].y = f64::NAN;
    assert!(solver.advance(&mut bad, 10).is_err());
    let mut good = three_in_a_box();
    solver.advance(&mut good, 100).unwrap();
    let mut expected = three_in_a_box();
    Solver::new(1).advance(&mut expected, 100).unwrap();
    assert_eq!(good.hash(), expected.hash());
}

#[test]
fn nothing_to_do_is_done() {
    let mut world = three_in_a_box();
    let before = world.hash();
    Solver::new(1).advance(&mut world, 0).unwrap();
    assert_eq!(world.hash(), before);
}
