//! Rounded polyhedra: free rotation, resting, sliding, tipping, each kind of contact, shared
//! stiffness.

use super::*;
use glam::{DQuat, DVec3};
use grainfall::measure::EnergyLedger;
use grainfall::solver::FaultKind;
use grainfall::world::Feature;

/// Stiffness of the contacts of these tests [N/m].
const STIFFNESS: f64 = 4000.0;

/// The world of listed grains over a floor at y = 0, after `law`'s keys.
fn bodies(material: &str, grains: &str, gravity: &str, rule: &str, dt: f64) -> World {
    let text = format!(
        r#"(
            title: "Bodies",
            materials: {{"m": ({material})}},
            container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")]),
            grains: List([{grains}]),
            gravity: {gravity},
            law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000, features: {rule}),
        )"#
    );
    world(&text, dt)
}

fn momentum(world: &World, i: usize) -> DVec3 {
    world.polyhedra.as_ref().unwrap().angular_momentum[i]
}

fn features(world: &World) -> Vec<Feature> {
    let contacts = world.polyhedra.as_ref().unwrap().features.iter();
    contacts.map(|contact| contact.feature).collect()
}

/// Total contact force on grain `i` where the bodies are, as they move [N].
fn force_at_rest(mut world: World, i: usize) -> (DVec3, World) {
    Solver::new(1).evaluate(&mut world).unwrap();
    (world.grains.force[i], world)
}

#[test]
fn free_asymmetric_body_keeps_its_angular_momentum_and_its_energy() {
    // A box that spins about its middle axis, which is unstable, and tumbles.
    let grain = r#"(position: (0, 1, 0), shape: Box(size: (0.002, 0.004, 0.006)), rounding: 0.0001, material: "m",
        spin: (0.01, 100, 0.01))"#;
    let mut world = bodies("", grain, "(0, 0, 0)", "Full", 1e-5);
    let (energy, spin) = (world.kinetic_energy(), momentum(&world, 0));
    let mut solver = Solver::new(1);
    let in_body = |world: &World| {
        let polyhedra = world.polyhedra.as_ref().unwrap();
        (polyhedra.orientation[0].conjugate() * polyhedra.angular_momentum[0]).to_array()
    };
    let start = in_body(&world);
    let axis = (0..3)
        .find(|&k| start[k].abs() > 0.9 * spin.length())
        .unwrap();
    let (mut worst, mut side, mut tumbles) = (0.0_f64, start[axis].signum(), 0);
    for _ in 0..1000 {
        solver.advance(&mut world, 1000).unwrap();
        worst = worst.max((world.kinetic_energy() / energy - 1.0).abs());
        let now = in_body(&world)[axis].signum();
        tumbles += u32::from(now != side);
        side = now;
    }
    assert!(tumbles > 10, "it turns over again and again: {tumbles}");
    println!("largest change of energy {worst:e} in 10⁶ steps");
    assert_eq!(momentum(&world, 0), spin, "nothing acts on it");
    // The splitting is symplectic and of second order: (spin · dt)² = 1e-6, bounded for ever.
    assert!(worst < 2e-7, "energy is off by {worst:e}");
}

#[test]
fn body_that_spins_about_a_principal_axis_turns_by_spin_times_time() {
    let grain = r#"(position: (0, 1, 0), shape: Box(size: (0.002, 0.004, 0.006)), rounding: 0.0001, material: "m",
        spin: (0, 0, 50))"#;
    let mut world = bodies("", grain, "(0, 0, 0)", "Full", 1e-5);
    let start = world.polyhedra.as_ref().unwrap().orientation[0];
    run(&mut world, 0.02);
    let turned = world.polyhedra.unwrap().orientation[0] * start.conjugate();
    let off = turned.angle_between(DQuat::from_rotation_z(1.0));
    // A step turns by 2 atan(spin dt/2): short of spin dt by its cube over 12, 1e-11 rad, in 2000 steps.
    assert!(off < 5e-8, "off by {off:e} rad");
}

#[test]
fn box_at_rest_sinks_by_its_weight_on_four_springs() {
    let grain = r#"(position: (0, 0.001, 0), shape: Box(size: (0.004, 0.002, 0.004)), rounding: 0.0001, material: "m")"#;
    for (rule, springs) in [("Full", 4.0), ("Shared", 1.0)] {
        let mut world = bodies(
            "density: 2650, restitution: 0.2",
            grain,
            "(0, -9.81, 0)",
            rule,
            1e-6,
        );
        run(&mut world, 0.03);
        let weight = world.grains.mass[0] * 9.81;
        let sunk = 0.001 - world.grains.position[0].y;
        let expected = weight / (springs * STIFFNESS);
        assert!(
            (sunk / expected - 1.0).abs() < 1e-6,
            "{rule}: {sunk:e} {expected:e}"
        );
        assert!(world.kinetic_energy() < 1e-20);
        let corners: Vec<Feature> = features(&world);
        assert_eq!(corners.len(), 4, "{corners:?}");
    }
}

/// A box on a plane that seems tilted by `slope`, after `time`, and by what it has turned.
fn on_slope(friction: f64, size: &str, height: f64, slope: f64, time: f64) -> (World, DQuat) {
    let grain = format!(
        r#"(position: (0, {height}, 0), shape: Box(size: {size}), rounding: 0.0001, material: "m")"#
    );
    let gravity = format!("({}, {}, 0)", 9.81 * slope.sin(), -9.81 * slope.cos());
    let material = format!("density: 2650, restitution: 0.2, friction: {friction}");
    let mut world = bodies(&material, &grain, &gravity, "Full", 1e-6);
    let start = world.polyhedra.as_ref().unwrap().orientation[0];
    run(&mut world, time);
    let turned = world.polyhedra.as_ref().unwrap().orientation[0] * start.conjugate();
    (world, turned)
}

#[test]
fn box_slides_down_a_slope_with_g_sin_minus_mu_g_cos() {
    let (friction, slope): (f64, f64) = (0.3, 0.5);
    let (world, _) = on_slope(friction, "(0.006, 0.001, 0.004)", 0.0005, slope, 0.05);
    // The elastic part of the normal force alone bounds the friction: while the box sinks in, its dashpots carry a part of
    // the weight, and the friction lacks μ c g cos/K_n in all.
    let log_squared = f64::ln(0.2).powi(2);
    let damped = log_squared / (std::f64::consts::PI.powi(2) + log_squared);
    let dashpot = 2.0 * (damped * STIFFNESS * world.grains.mass[0]).sqrt();
    let lacking = friction * dashpot * 9.81 * slope.cos() / STIFFNESS;
    let expected = 9.81 * (slope.sin() - friction * slope.cos()) * 0.05 + lacking;
    let speed = world.grains.velocity[0].x;
    assert!(
        (speed / expected - 1.0).abs() < 1e-4,
        "{speed} against {expected}"
    );
}

#[test]
fn box_stays_on_a_slope_below_its_angle_of_friction() {
    let slope: f64 = 0.1;
    let (world, _) = on_slope(0.3, "(0.006, 0.001, 0.004)", 0.0005, slope, 0.1);
    // The law has no tangential dashpot: the box rings on its four springs, about where they hold it, and does not slide.
    let held = world.grains.mass[0] * 9.81 * slope.sin() / (4.0 * 2000.0);
    let gone = world.grains.position[0].x;
    assert!(
        (0.0..2.1 * held).contains(&gone),
        "{gone:e} m, held at {held:e} m"
    );
}

#[test]
fn box_tips_where_its_weight_passes_its_lower_corners() {
    // The corners of the core lie a rounding radius inside: tan = (b − R_s)/h.
    let (half_width, half_height) = (0.001, 0.002);
    let tipping = f64::atan((half_width - 0.0001) / half_height);
    let tilt = |factor: f64| {
        let (_, turned) = on_slope(
            5.0,
            "(0.002, 0.004, 0.002)",
            half_height,
            factor * tipping,
            0.2,
        );
        (turned * DVec3::Y).y
    };
    assert!(tilt(0.98) > 0.9999, "{}", tilt(0.98));
    assert!(tilt(1.02) < 0.5, "{}", tilt(1.02));
}

/// Two bodies, the second moved so that its core is `overlap` nearer than touching.
fn pressed(first: &str, second: &str, rule: &str, overlap: DVec3) -> World {
    let mut world = bodies("", &format!("{first}, {second}"), "(0, 0, 0)", rule, 1e-6);
    world.grains.position[1] += overlap;
    world
}

const PLATE: &str = r#"(position: (0, 1, 0), shape: Box(size: (0.02, 0.004, 0.02)), rounding: 0.0002, material: "m")"#;

#[test]
fn small_face_on_a_large_one_presses_with_a_spring_at_each_corner() {
    // Half sizes 2 mm and 1 mm: they touch at a height of 1.003.
    let small = r#"(position: (0.001, 1.0031, 0.002), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0002, material: "m")"#;
    let overlap = 2e-5;
    for (rule, springs) in [("Full", 4.0), ("Shared", 1.0)] {
        let world = pressed(PLATE, small, rule, DVec3::new(0.0, -1e-4 - overlap, 0.0));
        let (force, after) = force_at_rest(world, 1);
        let expected = springs * STIFFNESS * overlap;
        assert!(
            (force.y / expected - 1.0).abs() < 1e-9,
            "{rule}: {force} against {expected}"
        );
        assert!(force.x.abs() + force.z.abs() < 1e-9 * expected);
        let features = features(&after);
        let at_faces = features
            .iter()
            .filter(|f| matches!(f, Feature::FaceVertex(..)));
        assert_eq!((features.len(), at_faces.count()), (4, 4), "{features:?}");
        // The springs stand evenly about the centre: no torque on the small one.
        assert!(after.grains.torque[1].length() < 1e-9 * expected * 0.001);
        // The large one is pressed off its centre: r × F about its centroid.
        let turned = DVec3::new(0.001, 0.002, 0.002).cross(-force);
        assert!((after.grains.torque[0] - turned).length() < 1e-6 * turned.length());
    }
}

#[test]
fn crossed_edges_press_each_other_once() {
    // Two square bars turned by 45° about their axes, one along x, one along z: edge over edge.
    let bar = |place: &str, size: &str, axis: &str| {
        format!(
            r#"(position: {place}, shape: Box(size: {size}), rounding: 0.0002, material: "m",
                orientation: Turned(axis: {axis}, angle_deg: 45))"#
        )
    };
    // From the axis of a bar to the edge of its core: √2 (1 mm − R_s), then R_s to the surface.
    let reach = 2.0_f64.sqrt() * 0.0008 + 0.0002;
    let first = bar("(0, 1, 0)", "(0.02, 0.002, 0.002)", "(1, 0, 0)");
    let second = bar(
        &format!("(0, {}, 0)", 1.0 + 2.0 * reach + 1e-4),
        "(0.002, 0.002, 0.02)",
        "(0, 0, 1)",
    );
    let overlap = 3e-5;
    let world = pressed(
        &first,
        &second,
        "Full",
        DVec3::new(0.0, -1e-4 - overlap, 0.0),
    );
    let (force, after) = force_at_rest(world, 1);
    let features = features(&after);
    assert!(
        matches!(features[..], [Feature::EdgeEdge(..)]),
        "{features:?}"
    );
    let expected = STIFFNESS * overlap;
    // The overlap is the difference of places near 1 m: 1e-16 of 3e-5.
    assert!(
        (force.y / expected - 1.0).abs() < 1e-9,
        "{force} against {expected}"
    );
    assert!(after.grains.torque[0].length() + after.grains.torque[1].length() < 1e-9 * expected);
}

#[test]
fn corner_on_a_face_presses_once_at_its_point() {
    // A cube that stands on a corner: (1, 1, 1) turned down.
    let cube = r#"(position: (0.003, 1.01, -0.001), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0002, material: "m",
        orientation: Turned(axis: (1, 0, -1), angle_deg: 125.264389682754654))"#;
    let reach = 3.0_f64.sqrt() * 0.0008 + 0.0002;
    let overlap = 4e-5;
    let down = DVec3::new(0.0, 1.002 + reach - overlap - 1.01, 0.0);
    let (force, after) = force_at_rest(pressed(PLATE, cube, "Full", down), 1);
    let features = features(&after);
    assert!(
        matches!(features[..], [Feature::FaceVertex(..)]),
        "{features:?}"
    );
    let expected = STIFFNESS * overlap;
    assert!(
        (force.y / expected - 1.0).abs() < 1e-6,
        "{force} against {expected}"
    );
    let turned = DVec3::new(0.003, 0.002, -0.001).cross(-force);
    assert!((after.grains.torque[0] - turned).length() < 1e-4 * turned.length());
}

#[test]
fn every_feature_of_equal_cubes_face_to_face_is_a_contact_of_its_own() {
    // Each of the four corners of either face meets three faces; every edge of the faces, and those that leave it at the
    // corners, meet: 4 with their twins, 8 with neighbours in the face, 16 with those that leave, 4 of those with each other.
    let cube = |y: f64| {
        format!(
            r#"(position: (0, {y}, 0), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0002, material: "m")"#
        )
    };
    let overlap = 1e-5;
    let world = pressed(
        &cube(1.0),
        &cube(1.0021),
        "Full",
        DVec3::new(0.0, -1e-4 - overlap, 0.0),
    );
    let (force, after) = force_at_rest(world, 1);
    assert_eq!(features(&after).len(), 24 + 32);
    assert!(
        (force.y / (56.0 * STIFFNESS * overlap) - 1.0).abs() < 1e-9,
        "{force}"
    );
}

/// Speed after the impact of a flat box on the floor over that before.
fn rebound(rule: &str, restitution: f64) -> f64 {
    let grain = r#"(position: (0, 0.00105, 0), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0001, material: "m",
        velocity: (0, -0.2, 0))"#;
    let material = format!("density: 2650, restitution: {restitution}");
    let mut world = bodies(&material, grain, "(0, 0, 0)", rule, 1e-8);
    run(&mut world, 1.5e-3);
    assert!(world.contacts.is_empty());
    world.grains.velocity[0].y / 0.2
}

#[test]
fn shared_contacts_rebound_with_their_restitution_and_full_ones_do_not() {
    // A net pull is cut off, as the law says, which gives a little more than e back.
    for restitution in [0.8, 0.9, 1.0] {
        let shared = rebound("Shared", restitution);
        let full = rebound("Full", restitution);
        println!("e {restitution}: shared {shared:.4}, each a full contact {full:.4}");
        assert!(
            (0.0..0.02).contains(&(shared - restitution + 1e-3)),
            "{restitution}: {shared}"
        );
        if restitution < 1.0 {
            assert!(full < restitution - 0.05, "{restitution}: {full}");
        }
    }
}

#[test]
fn polyhedron_of_one_vertex_is_a_sphere() {
    let spheres = r#"
        (position: (0, 0.0029, 0), radius_mm: 3, material: "m", velocity: (0.2, 0, 0), spin: (0, 0, -20)),
        (position: (0.0068, 0.0045, 0.001), radius_mm: 2, material: "m", velocity: (-0.3, 0, 0.05))"#
        .replace("radius_mm", "SHAPE radius_mm");
    let law = "density: 2650, restitution: 0.5, friction: 0.3, rolling_friction: 0";
    let far = r#", (position: (1, 1, 0), shape: Box(size: (0.01, 0.01, 0.01)), rounding: 0.001, material: "m")"#;
    let as_spheres = spheres.replace("SHAPE ", "");
    let as_polyhedra = spheres.replace("SHAPE", "shape: Sphere,") + far;
    let gravity = "(0, -9.81, 0)";
    // How far they are apart after 20 ms: ways, velocities, speeds of the surfaces.
    let apart = |dt: f64| {
        let in_place = |grains: &str| grains.replace("0.0029", "0.003");
        let mut plain = bodies(law, &in_place(&as_spheres), gravity, "Full", dt);
        let mut rounded = bodies(law, &in_place(&as_polyhedra), gravity, "Full", dt);
        for world in [&mut plain, &mut rounded] {
            run(world, 0.02);
        }
        assert!(plain.polyhedra.is_none() && rounded.polyhedra.is_some());
        assert!(plain.grains.velocity[1].x > 0.0, "they hit each other");
        let (a, b) = (&plain.grains, &rounded.grains);
        let off = |i: usize| {
            let way = (a.position[i] - b.position[i]).length();
            let surface = (a.spin[i] - b.spin[i]).length() * a.radius[i];
            [way, (a.velocity[i] - b.velocity[i]).length(), surface]
        };
        [0, 1, 2].map(|k| off(0)[k].max(off(1)[k]))
    };
    // A sphere's slip is taken with the normal of the middle of a step, a polyhedron's with that of
    // its end: the difference is of first order.
    let (coarse, fine) = (apart(1e-6), apart(2.5e-7));
    println!("{coarse:?} m and m/s, {fine:?} with a quarter of the step");
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(coarse < 5e-6 && fine < 0.35 * coarse, "{coarse:e} {fine:e}");
    }
}

/// A handful of grains on softer springs, which comes to rest soon.
fn small_column(rule: &str) -> World {
    let text = collapse::text_of_column(rule, "Explicit")
        .replace("radius_mm: 8, height_mm: 16", "radius_mm: 6, height_mm: 12")
        .replace(
            "normal_stiffness: 4000, tangential_stiffness: 2000",
            "normal_stiffness: 1000, tangential_stiffness: 500",
        );
    world(&text, 4e-6)
}

#[test]
fn collapse_closes_its_energy_balance_and_comes_to_rest() {
    for rule in ["Full", "Shared"] {
        let mut world = small_column(rule);
        let mut solver = Solver::new(2);
        let mut fastest = 0.0_f64;
        for _ in 0..25 {
            solver.advance(&mut world, 2000).unwrap();
            fastest = fastest.max(world.kinetic_energy());
        }
        let ledger = EnergyLedger::of(&world);
        println!(
            "{rule}: {} grains, kinetic {:e} of at most {fastest:e}, residual {:e}, {ledger:?}",
            world.grains.len(),
            world.kinetic_energy(),
            ledger.relative_residual(),
        );
        assert!(
            world.kinetic_energy() < 0.02 * fastest,
            "{rule}: it has come to rest"
        );
        assert!(
            ledger.relative_residual().abs() < 1e-3,
            "{rule}: {}",
            ledger.relative_residual()
        );
    }
}

/// What the ledger leaves unexplained of the impact of a tilted box on the floor, over its energy
/// before: the root of the mean square over eight heights, so that it does not matter where in a
/// step the box arrives.
fn unexplained_of_impact(rule: &str, dt: f64) -> f64 {
    let heights = 8;
    let square = |k: u32| {
        let height = 0.0018 + 1e-6 * f64::from(k) / f64::from(heights);
        let grain = format!(
            r#"(position: (0, {height}, 0), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0001, material: "m",
                velocity: (0.05, -0.2, 0), orientation: Turned(axis: (0, 0, 1), angle_deg: 20))"#
        );
        let material = "density: 2650, restitution: 0.4, friction: 0.3";
        let mut world = bodies(material, &grain, "(0, 0, 0)", rule, dt);
        let before = world.kinetic_energy();
        run(&mut world, 0.004);
        assert!(
            world.kinetic_energy() < 0.9 * before,
            "it has met the floor"
        );
        (EnergyLedger::of(&world).residual() / before).powi(2)
    };
    ((0..heights).map(square).sum::<f64>() / f64::from(heights)).sqrt()
}

#[test]
fn ledger_of_an_impact_leaves_an_error_of_second_order() {
    for rule in ["Full", "Shared"] {
        let [coarse, fine, finest] = [4e-6, 2e-6, 1e-6].map(|dt| unexplained_of_impact(rule, dt));
        println!("{rule}: {coarse:.2e} at 4 µs, {fine:.2e} at 2 µs, {finest:.2e} at 1 µs");
        // A quarter for half the step; a first-order error would leave a half.
        assert_below("residual at 2 µs", fine, 0.35 * coarse);
        assert_below("residual at 1 µs", finest, 0.35 * fine);
    }
}

#[test]
fn cores_that_would_pass_through_each_other_are_caught() {
    let grain = |x: f64, v: f64| {
        format!(
            r#"(position: ({x}, 1, 0), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0001, material: "m",
                velocity: ({v}, 0, 0), orientation: Turned(axis: (1, 2, 3), angle_deg: 40))"#
        )
    };
    let text = format!("{}, {}", grain(-0.002, 20.0), grain(0.002, -20.0));
    let mut world = bodies("restitution: 0.9", &text, "(0, 0, 0)", "Full", 1e-6);
    let fault = Solver::new(1).advance(&mut world, 5000).unwrap_err();
    assert!(
        matches!(fault.kind, FaultKind::TooDeep(share) if share > 0.8),
        "{fault}"
    );
    assert_eq!(world.time(), 0.0, "the last good state is kept");
}

#[test]
fn body_too_fast_for_its_rounding_is_caught() {
    let grain = r#"(position: (0, 1, 0), shape: Box(size: (0.002, 0.002, 0.002)), rounding: 0.0001, material: "m",
        velocity: (30, 0, 0))"#;
    let mut world = bodies("", grain, "(0, 0, 0)", "Full", 1e-6);
    let fault = Solver::new(1).advance(&mut world, 10).unwrap_err();
    assert!(
        matches!(fault.kind, FaultKind::TooFastForRounding(_)),
        "{fault}"
    );
}

#[test]
fn box_on_a_belt_is_carried_along() {
    let text = r#"(
        title: "A box on a belt",
        materials: {"m": (density: 2650, restitution: 0.2, friction: 0.5)},
        container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), velocity: (0.1, 0, 0), material: "m")]),
        grains: List([(position: (0, 0.001, 0), shape: Box(size: (0.006, 0.002, 0.004)), rounding: 0.0002, material: "m")]),
        law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000),
    )"#;
    let mut world = world(text, 1e-6);
    run(&mut world, 0.08);
    let speed = world.grains.velocity[0];
    assert!(
        (speed - DVec3::new(0.1, 0.0, 0.0)).length() < 1e-5,
        "{speed}"
    );
    // Slipping up to speed takes as much from the belt again as the box gains.
    let gained = 0.5 * world.grains.mass[0] * 0.01;
    let ledger = EnergyLedger::of(&world);
    assert!(
        (ledger.wall_work / (2.0 * gained) - 1.0).abs() < 0.02,
        "{ledger:?} {gained:e}"
    );
    assert!(
        (ledger.sliding_loss / gained - 1.0).abs() < 0.02,
        "{ledger:?} {gained:e}"
    );
}
