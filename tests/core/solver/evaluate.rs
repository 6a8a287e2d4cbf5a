//! Forces without a step: those that a step sees, and nothing else of the state is touched.

use super::*;
use glam::DVec3;
use grainfall::solver::{FaultKind, advise};
use grainfall::world::Clock;
use std::sync::LazyLock;

/// Spheres dry and wet, and polyhedra, in motion: the scene after some steps.
fn moving(name: &str, values: &[(&str, &str)], steps: u64) -> World {
    let mut scene = Scene::open(name).unwrap();
    for (key, value) in values {
        scene.set(key, value).unwrap();
    }
    let mut world = build(&scene, advise(&scene).time_step);
    Solver::new(2).advance(&mut world, steps).unwrap();
    assert!(world.contacts.len() > 40, "{}", world.contacts.len());
    world
}

/// States that all tests here begin with.
static WORLDS: LazyLock<[(&str, World); 3]> = LazyLock::new(|| {
    let as_coded = [("bridge-law", "as-coded")];
    [
        ("dry spheres", moving("two-sizes-drum", &[], 7500)),
        ("wet spheres", moving("honey-drum", &as_coded, 7500)),
        ("polyhedra", moving("small-column", &[], 7500)),
    ]
});

/// The same state in a step of `time` [s]: so short that no position and no velocity changes by a
/// bit.
fn after_no_time(world: &World, time: f64) -> World {
    let mut world = world.clone();
    world.clock = Clock::new(time);
    Solver::new(1).advance(&mut world, 1).unwrap();
    world
}

fn largest_difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (*a - *b).length());
    let size = a.iter().map(|a| a.length()).fold(0.0, f64::max);
    differences.fold(0.0, f64::max) / size.max(f64::MIN_POSITIVE)
}

#[test]
fn forces_without_a_step_are_those_that_a_step_sees() {
    for (name, world) in &*WORLDS {
        let mut evaluated = world.clone();
        Solver::new(2).evaluate(&mut evaluated).unwrap();
        let stepped = after_no_time(world, 1e-20);
        let (a, b) = (&evaluated.grains, &stepped.grains);
        for (what, a, b) in [
            ("force", &a.force, &b.force),
            ("torque", &a.torque, &b.torque),
            ("rolling torque", &a.rolling_torque, &b.rolling_torque),
        ] {
            let difference = largest_difference(a, b);
            println!("{name}: {what} off by {difference:.1e}");
            assert!(difference < 1e-12, "{name}, {what}: {difference:e}");
        }
        assert_eq!(a.contact_count, b.contact_count, "{name}");
        assert_eq!(a.open_bridges, b.open_bridges, "{name}");
        let sides = |world: &World| -> Vec<_> {
            let sides = world.contacts.iter();
            sides
                .map(|contact| (contact.grain, contact.partner))
                .collect()
        };
        assert_eq!(sides(&evaluated), sides(&stepped), "{name}");
        // The step before saw velocities half a step ago: what differs is what dashpots make of it.
        let before = largest_difference(&world.grains.force, &a.force);
        assert!(before > 0.0, "{name}: nothing was computed");
    }
}

#[test]
fn nothing_moves_and_no_energy_is_booked() {
    for (name, world) in &*WORLDS {
        let mut evaluated = world.clone();
        Solver::new(2).evaluate(&mut evaluated).unwrap();
        // All that is no force and no memory of a contact, to the bit.
        let mut rest = evaluated.clone();
        rest.grains.force.clone_from(&world.grains.force);
        rest.grains.torque.clone_from(&world.grains.torque);
        rest.grains
            .rolling_torque
            .clone_from(&world.grains.rolling_torque);
        rest.contacts.clone_from(&world.contacts);
        if let (Some(rest), Some(world)) = (&mut rest.polyhedra, &world.polyhedra) {
            rest.features.clone_from(&world.features);
        }
        assert_eq!(rest.hash(), world.hash(), "{name}");
        assert!(rest == *world, "{name}");
    }
}

#[test]
fn evaluated_forces_depend_neither_on_threads_nor_on_what_the_solver_knows() {
    for (name, world) in &*WORLDS {
        let mut used = Solver::new(1);
        let mut last = world.clone();
        used.advance(&mut last, 20).unwrap();
        let mut fresh = last.clone();
        Solver::new(3).evaluate(&mut fresh).unwrap();
        let mut again = last.clone();
        used.evaluate(&mut again).unwrap();
        assert!(fresh == again, "{name}");
        // And what the solver keeps of it shows in no later step.
        used.advance(&mut again, 20).unwrap();
        Solver::new(1).advance(&mut fresh, 20).unwrap();
        assert_eq!(fresh.hash(), again.hash(), "{name}");
    }
}

#[test]
fn absurd_state_is_a_fault_at_its_own_time() {
    let mut world = moving("small-drum", &[], 3000);
    world.grains.position[7] = DVec3::X;
    let before = world.clone();
    let fault = Solver::new(1).evaluate(&mut world).unwrap_err();
    assert_eq!(fault.grain, 7);
    assert!(matches!(fault.kind, FaultKind::BehindWall(_)), "{fault}");
    assert_eq!(
        (fault.time, fault.good_time),
        (before.time(), before.time())
    );
    assert!(world == before, "the world stays as it was");
}
