//! The terms of a contact's force: they are those that the solver applied.

use super::*;
use glam::DVec3;
use grainfall::physics::BridgeLaw;
use grainfall::solver::{ForceTerms, NormalLaw, advise, force_terms};
use grainfall::world::{Clock, Contact, Surface};

/// The scene `name` after `time`, with settings.
fn scene_after(name: &str, settings: &[(&str, &str)], time: f64) -> World {
    let mut scene = Scene::open(name).unwrap();
    for (key, value) in settings {
        scene.set(key, value).unwrap();
    }
    let mut world = build(&scene, advise(&scene).time_step);
    run(&mut world, time);
    world
}

/// Largest difference between the sum of a contact's terms and the force that the solver applied,
/// relative to the largest term of that contact; and how many contacts there were.
fn worst_difference(world: &World) -> (f64, usize) {
    let difference = |contact: &Contact| {
        let terms = force_terms(world, contact);
        let sum: DVec3 = terms.iter().map(grainfall::solver::ForceTerms::force).sum();
        let size = terms.iter().map(|t| {
            let normal = t.normal_spring.length().max(t.normal_dashpot.length());
            let liquid = t.capillary.length().max(t.viscous_normal.length());
            normal.max(liquid).max(t.tangential_spring.length())
        });
        (sum - contact.force).length() / size.fold(1e-12, f64::max)
    };
    let worst = world.contacts.iter().map(difference).fold(0.0, f64::max);
    (worst, world.contacts.len())
}

#[test]
fn terms_of_spheres_add_up_to_the_force_that_was_applied() {
    let literal = "(surface_tension: 0.064, contact_angle_deg: 39.5, viscosity: 0.367, volume: 2e-6, law: Choices(coulomb: Total))";
    for (name, settings) in [
        ("small-drum", vec![]),
        ("two-sizes-drum", vec![]),
        ("water-drum", vec![]),
        ("honey-drum", vec![("bridge-law", "as-coded")]),
    ] {
        let world = scene_after(name, &settings, 0.15);
        let (worst, contacts) = worst_difference(&world);
        println!("{name}: {contacts} contacts, {worst:.1e}");
        assert!(contacts > 150, "{name}: {contacts}");
        // Velocities of half a step ago are computed back, which rounds them.
        assert!(worst < 1e-13, "{name}: {worst:e}");
    }
    // Read literally, the Coulomb bound takes the liquid's normal force in.
    let text = include_str!("../../../scenes/gallery/water-drum.ron")
        .replace("(case: 1, volume_ml: 4)", literal);
    let mut world = world(&text, 2e-5);
    run(&mut world, 0.15);
    let (worst, contacts) = worst_difference(&world);
    assert!(contacts > 200 && worst < 1e-13, "{contacts} {worst:e}");
}

#[test]
fn terms_of_polyhedra_add_up_to_the_force_that_was_applied() {
    for rule in ["Shared", "Full"] {
        let text = include_str!("../../../scenes/gallery/small-column.ron")
            .replace("features: Shared", &format!("features: {rule}"));
        let scene = Scene::parse("column", &text).unwrap();
        let mut world = build(&scene, advise(&scene).time_step);
        run(&mut world, 0.02);
        let (worst, contacts) = worst_difference(&world);
        println!("{rule}: {contacts} contacts, {worst:.1e}");
        assert!(contacts > 200, "{contacts}");
        // As for spheres.
        assert!(worst < 1e-13, "{rule}: {worst:e}");
        let features = world.polyhedra.as_ref().unwrap().features.len();
        let terms: usize = (world.contacts.iter())
            .map(|contact| force_terms(&world, contact).len())
            .sum();
        assert_eq!(terms, features);
    }
}

#[test]
fn implicit_springs_and_dashpots_of_polyhedra_add_up_too() {
    let world = scene_after("small-column", &[("integrator", "implicit")], 0.02);
    let (worst, contacts) = worst_difference(&world);
    assert!(contacts > 200 && worst < 1e-13, "{contacts} {worst:e}");
    let terms = |contact| force_terms(&world, contact);
    let damped = |terms: &ForceTerms| {
        let springs = terms.normal_spring.length() + terms.tangential_spring.length();
        terms.normal_dashpot.length() > 1e-3 * springs
    };
    let damped = world.contacts.iter().flat_map(terms).filter(damped).count();
    assert!(damped > 20, "{damped}");
}

/// The same state with its forces at the velocities of now, half a step ago being now: what the
/// terms are made from is to the bit what the loop saw.
fn evaluated(mut world: World) -> World {
    Solver::new(1).evaluate(&mut world).unwrap();
    world.clock = Clock::new(0.0);
    world
}

#[test]
fn terms_from_what_the_loop_saw_differ_by_the_order_of_a_sum_alone() {
    for (name, settings) in [
        ("two-sizes-drum", vec![]),
        ("honey-drum", vec![("bridge-law", "as-coded")]),
    ] {
        let world = evaluated(scene_after(name, &settings, 0.1));
        let (worst, contacts) = worst_difference(&world);
        println!("{name}: {contacts} contacts, {worst:.1e}");
        assert!(contacts > 200, "{name}: {contacts}");
        // A few last bits: seven terms are added in another order.
        assert!(worst < 8.0 * f64::EPSILON, "{name}: {worst:e}");
    }
}

#[test]
fn the_moving_dot_lies_on_its_law() {
    for (settings, law) in [
        (vec![], BridgeLaw::AS_PRINTED),
        (vec![("bridge-law", "as-coded")], BridgeLaw::AS_CODED),
    ] {
        let world = scene_after("honey-drum", &settings, 0.15);
        let (mut touching, mut open) = (0, 0);
        for contact in &world.contacts {
            let terms = force_terms(&world, contact)[0];
            let curve = NormalLaw::of(&world, contact, law);
            let expected = -contact.force.dot(terms.normal);
            let found = curve.force(-terms.overlap, terms.approach);
            let size = terms.normal_spring.length() + terms.capillary.length();
            // The mobility is that of now, not of a step ago: it only matters where the drag is bounded, hence nearly never.
            assert!(
                (found - expected).abs() <= 1e-8 * size.max(1e-9),
                "{found:e} {expected:e}"
            );
            if terms.overlap > 0.0 {
                touching += 1;
            } else {
                open += 1;
                assert!(-terms.overlap <= curve.rupture_gap().unwrap());
            }
        }
        assert!(touching > 200 && open > 5, "{touching} {open}");
    }
}

#[test]
fn beyond_its_rupture_gap_a_bridge_does_nothing() {
    let world = scene_after("water-drum", &[], 0.1);
    let between = |contact: &&Contact| matches!(contact.partner, Partner::Grain(_));
    let contact = world.contacts.iter().find(between).unwrap();
    for law in [BridgeLaw::AS_PRINTED, BridgeLaw::AS_CODED] {
        let curve = NormalLaw::of(&world, contact, law);
        let rupture = curve.rupture_gap().unwrap();
        assert!(curve.force(0.999 * rupture, 0.0) < 0.0);
        assert_eq!(curve.force(1.001 * rupture, 0.0), 0.0);
        // Pressed together, the spring wins.
        assert!(curve.force(-1e-4, 0.0) > 0.0);
    }
}

#[test]
fn rolling_torque_is_that_of_eq_10() {
    let text = r#"(
        title: "A grain rolls",
        materials: {"glass": (youngs_modulus: 63e6, restitution: 0.5, friction: 0.4, rolling_friction: 0.01)},
        container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "glass")]),
        grains: List([(position: (0, 0.00299, 0), velocity: (0.3, 0, 0), spin: (0, 0, -100), radius_mm: 3, material: "glass")]),
    )"#;
    let mut world = world(text, 1e-5);
    run(&mut world, 0.2);
    assert!(matches!(
        world.container.walls[0].surface,
        Surface::Plane { .. }
    ));
    let terms = force_terms(&world, &world.contacts[0])[0];
    // It rolls steadily: μ_R k_n δ r, and what the loop applied but for the change of one step.
    let expected = 0.01 * terms.normal_spring.length() * 3e-3;
    assert!((terms.rolling.length() / expected - 1.0).abs() < 1e-9);
    let applied = world.grains.rolling_torque[0];
    assert!((terms.rolling - applied).length() < 1e-6 * expected);
}
