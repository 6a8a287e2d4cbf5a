//! The same bits for any number of threads, lanes, slices, lists and restores.

use super::*;
use glam::DVec3;
use grainfall::scene::{SceneContainer, SceneGrains};
use grainfall::solver::Processor;
use grainfall::world::{Contact, StateHash};
use std::sync::OnceLock;

/// Two sizes, three materials, a quick drum: some 300 grains that fall, hit and avalanche within
/// the steps tried.
const DRUM: &str = r#"(
    title: "A quick drum of everything",
    materials: {
        "glass": (),
        "steel": (youngs_modulus: 1e8, poisson_ratio: 0.3, density: 7800, restitution: 0.8, friction: 0.2),
        "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
    },
    pairs: [(between: ("glass", "drum"), restitution: 0.72, friction: 0.3)],
    container: Drum(radius_mm: 20, width_mm: 12, speed_rpm: 60, material: "drum"),
    grains: Fill(count: 300, species: [
        (name: "small", radius_mm: 1, material: "glass", share: 0.6),
        (name: "hard", radius_mm: 1, material: "steel", share: 0.2),
        (name: "large", radius_mm: 1.6, material: "glass", share: 0.2),
    ]),
)"#;

const STEP: f64 = 5e-6;

/// Grains of one kind on planes that move, linear springs.
const BELT: &str = r#"(
    title: "A heap between a belt and a wall",
    materials: {"m": (restitution: 0.3), "belt": (friction: 0.8)},
    container: Planes([
        (point: (0, 0, 0), normal: (0, 1, 0), velocity: (0.3, 0, 0), material: "belt"),
        (point: (0.02, 0, 0), normal: (-1, 0.1, 0), material: "m"),
        (point: (-0.01, 0, 0), normal: (1, 0, 0), material: "m"),
    ]),
    law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000),
    grains: List([
        (position: (0, 0.0015, 0), radius_mm: 1.5, material: "m"),
        (position: (0.003, 0.0015, 0.0005), radius_mm: 1.5, material: "m"),
        (position: (0.0062, 0.002, 0), radius_mm: 1.5, material: "m"),
        (position: (0.0015, 0.0043, 0), radius_mm: 1.5, material: "m"),
        (position: (0.0046, 0.0045, 0), radius_mm: 1.5, material: "m"),
        (position: (0.0031, 0.0073, 0), velocity: (0, -0.3, 0), radius_mm: 1.5, material: "m"),
    ]),
)"#;

/// The drum when its bed flows, or the belt as it starts.
fn start(text: &str) -> World {
    static FLOWING: OnceLock<World> = OnceLock::new();
    if text != DRUM {
        return world(text, STEP);
    }
    FLOWING
        .get_or_init(|| {
            let mut world = world(DRUM, STEP);
            Solver::new(1).advance(&mut world, 40_000).unwrap();
            world
        })
        .clone()
}

/// The scene's world, `slices` of steps after its start, by `solver`.
fn after(text: &str, mut solver: Solver, slices: &[u64]) -> World {
    let mut world = start(text);
    for &steps in slices {
        solver.advance(&mut world, steps).unwrap();
    }
    world
}

fn hash(text: &str, solver: Solver, slices: &[u64]) -> StateHash {
    after(text, solver, slices).hash()
}

#[test]
fn drum_of_these_tests_flows() {
    let (begin, end) = (start(DRUM), after(DRUM, Solver::new(1), &[4000]));
    assert!(
        begin.contacts.len() > 400,
        "{} contacts",
        begin.contacts.len()
    );
    let known = |contact: &&Contact| {
        let same =
            |other: &Contact| (other.grain, other.partner) == (contact.grain, contact.partner);
        begin.contacts.iter().any(same)
    };
    let kept = end.contacts.iter().filter(known).count();
    let slid = |world: &World| -> f64 { world.grains.exchanged.iter().map(|terms| terms[1]).sum() };
    println!("{} contacts, {kept} of them old", end.contacts.len());
    assert!(kept < end.contacts.len() * 9 / 10, "contacts come and go");
    assert!(slid(&end) > slid(&begin), "grains slide");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for text in [DRUM, BELT] {
        let alone = hash(text, Solver::new(1), &[1000]);
        for threads in [2, 3, 8] {
            assert_eq!(
                hash(text, Solver::new(threads), &[1000]),
                alone,
                "{threads} threads"
            );
        }
    }
}

/// In beds of thousands of grains workers share what is done between batches: lists, histories, the
/// way from the world and back.
#[test]
fn large_beds_have_the_same_bits_for_any_number_of_threads() {
    let fallen = |text: &str| {
        let mut world = world(text, STEP);
        for velocity in &mut world.grains.velocity {
            *velocity = DVec3::new(0.0, -1.5, 0.0);
        }
        Solver::new(2).advance(&mut world, 4000).unwrap();
        world
    };
    let dry = DRUM
        .replace("radius_mm: 20, width_mm: 12", "radius_mm: 40, width_mm: 40")
        .replace("count: 300", "count: 5000");
    let wet = dry.replace("container:", "liquid: (case: 4, volume_ml: 4), container:");
    for text in [dry, wet] {
        let start = fallen(&text);
        let bridges = start
            .contacts
            .iter()
            .filter(|contact| contact.bridge.is_some());
        println!(
            "{} contacts, {} bridges",
            start.contacts.len(),
            bridges.count()
        );
        assert!(start.contacts.len() > 4000, "grains lie on each other");
        let after = |threads: usize| {
            let (mut world, mut solver) = (start.clone(), Solver::new(threads));
            for _ in 0..5 {
                solver.advance(&mut world, 60).unwrap();
            }
            (world.hash(), solver.take_profile().rebuilds)
        };
        let alone = after(1);
        assert!(alone.1 > 1, "neighbours are searched for: {alone:?}");
        for threads in [2, 3, 8] {
            assert_eq!(after(threads), alone, "{threads} threads");
        }
    }
}

#[test]
fn every_width_of_lanes_gives_the_same_bits() {
    for text in [DRUM, BELT] {
        let plain = hash(text, Solver::on(Processor::Scalar, 1), &[3000]);
        for processor in Processor::all() {
            let wide = hash(text, Solver::on(processor, 2), &[3000]);
            assert_eq!(wide, plain, "{processor:?}");
        }
    }
}

#[test]
fn any_slicing_of_the_steps_gives_the_same_bits() {
    for text in [DRUM, BELT] {
        let whole = hash(text, Solver::new(1), &[1000]);
        for slices in [&[1][..], &[0, 500, 0], &[7; 142], &[300, 1, 1, 1, 297]] {
            let rest = 1000 - slices.iter().sum::<u64>();
            let slices = [slices, &[rest]].concat();
            assert_eq!(hash(text, Solver::new(1), &slices), whole, "{slices:?}");
        }
        assert_eq!(hash(text, Solver::new(2), &[1; 1000]), whole);
    }
}

#[test]
fn restored_snapshot_goes_on_as_if_nothing_had_happened() {
    for text in [DRUM, BELT] {
        let mut world = after(text, Solver::new(1), &[500]);
        let snapshot = world.clone();
        let mut solver = Solver::new(2);
        solver.advance(&mut world, 1500).unwrap();
        let expected = world.hash();
        // The same solver, its lists now of a later state; and one that knows nothing.
        world = snapshot.clone();
        solver.advance(&mut world, 1500).unwrap();
        assert_eq!(world.hash(), expected);
        world = snapshot;
        Solver::new(1).advance(&mut world, 1500).unwrap();
        assert_eq!(world.hash(), expected);
    }
}

#[test]
fn solver_that_moves_two_worlds_in_turn_mixes_nothing_up() {
    let mut solver = Solver::new(1);
    let (mut drum, mut belt) = (start(DRUM), start(BELT));
    for _ in 0..20 {
        solver.advance(&mut drum, 100).unwrap();
        solver.advance(&mut belt, 100).unwrap();
    }
    assert_eq!(drum.hash(), hash(DRUM, Solver::new(1), &[2000]));
    assert_eq!(belt.hash(), hash(BELT, Solver::new(1), &[2000]));
}

#[test]
fn fresh_lists_at_every_slice_give_the_same_bits_as_old_ones() {
    // Lists have skins that grow and shrink with use; a new solver starts with the first ones.
    let mut world = start(DRUM);
    for _ in 0..30 {
        Solver::new(1).advance(&mut world, 100).unwrap();
    }
    assert_eq!(world.hash(), hash(DRUM, Solver::new(1), &[3000]));
}

#[test]
fn changed_friction_acts_at_once_and_alike_for_old_and_new_solvers() {
    let mut world = start(DRUM);
    let mut old = Solver::new(1);
    old.advance(&mut world, 100).unwrap();
    let glass = world.materials.find("glass").unwrap();
    world.materials.pair_mut(glass, glass).friction = 0.05;
    let mut twin = world.clone();
    let mut unchanged = world.clone();
    unchanged.materials.pair_mut(glass, glass).friction = 0.4;
    old.advance(&mut world, 500).unwrap();
    Solver::new(1).advance(&mut twin, 500).unwrap();
    old.advance(&mut unchanged, 500).unwrap();
    assert_eq!(world.hash(), twin.hash());
    assert_ne!(world.hash(), unchanged.hash());
}

#[test]
fn run_has_the_bits_it_always_had() {
    // A golden hash: the same on every machine, as the step knows nothing but + − × ÷ √. A commit that changes it says why.
    let found = [DRUM, BELT].map(|text| hash(text, Solver::new(1), &[1000]).to_string());
    assert_eq!(
        found,
        [
            "9df21efa0c4955c13d651e1f8a30fef9",
            "3e1c87226e22dcc80eb2cc7592327062"
        ]
    );
}

#[test]
fn seed_decides_the_run() {
    let other = DRUM.replace("title:", "seed: 2, title:");
    assert_ne!(world(&other, STEP).hash(), world(DRUM, STEP).hash());
}

#[test]
fn paper_drum_gives_the_same_bits_on_two_threads() {
    let mut scene = Scene::open("dry-r3").unwrap();
    if let SceneContainer::Drum { speed, .. } = &mut scene.container {
        *speed = 2.0;
    }
    assert!(matches!(scene.grains, SceneGrains::Fill { count: 470, .. }));
    let after = |threads: usize| {
        let mut world = build(&scene, 2e-5);
        Solver::new(threads).advance(&mut world, 5000).unwrap();
        world.hash()
    };
    assert_eq!(after(1), after(2));
}
