//! The implicit integrator: springs and dashpots for all bodies together keep momentum, close the
//! energy balance, restitute to the second order of the step, let piles rest, drag and agree like the
//! explicit integrator as steps become short. Same bits for threads, lanes and slices:
//! [`super::collapse`].

use super::*;
use glam::DVec3;
use grainfall::measure::EnergyLedger;
use grainfall::solver::advise;

/// A step that explicit springs would not bear where several features touch [s].
const STEP: f64 = 2e-5;

/// Two grains, `integrator` and a step.
fn two(grains: &str, gravity: &str, integrator: &str, dt: f64) -> World {
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
fn momenta(world: &World) -> [DVec3; 2] {
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
const COLLISION: &str = r#"
    (position: (0, 1, 0), shape: Box(size: (0.002, 0.003, 0.004)), rounding: 0.0001, material: "m",
        velocity: (0.4, 0, 0), spin: (3, 20, -5)),
    (position: (0.0022, 1.0008, 0.0005), shape: Box(size: (0.002, 0.002, 0.003)), rounding: 0.0001, material: "m",
        velocity: (-0.3, 0.05, 0.1), spin: (0, -10, 40))"#;

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

/// A sphere of polyhedra that hits the floor at 0.3 m/s across and `along` it [m/s]: velocities along
/// and across it afterwards, means over where in a step of `dt` it touches first.
fn impact(integrator: &str, dt: f64, along: f64) -> [f64; 2] {
    const OFFSETS: usize = 16;
    let after = |k: usize| {
        let height = 0.001 + 0.3 * dt * (5.0 + (k as f64 + 0.5) / OFFSETS as f64);
        let grain = format!(
            r#"(position: (0, {height}, 0), shape: Sphere, radius: 0.001, material: "m", velocity: ({along}, -0.3, 0)),
               (position: (1, 1, 0), shape: Box(size: (0.002, 0.002, 0.003)), rounding: 0.0001, material: "m")"#
        );
        let mut world = two(&grain, "(0, 0, 0)", integrator, dt);
        run(&mut world, 2e-3);
        assert!(world.contacts.is_empty());
        let velocity = world.grains.velocity[0];
        [velocity.x, velocity.y]
    };
    let all: Vec<_> = (0..OFFSETS).map(after).collect();
    [0, 1].map(|axis| all.iter().map(|own| own[axis]).sum::<f64>() / OFFSETS as f64)
}

fn restitution(integrator: &str, dt: f64) -> f64 {
    impact(integrator, dt, 0.0)[1] / 0.3
}

/// Damping ratio of a contact that restitutes 0.1 where it may pull.
fn damping_ratio() -> f64 {
    let log = f64::ln(0.1);
    log.abs() / (std::f64::consts::PI.powi(2) + log * log).sqrt()
}

/// Restitution of a spring and a dashpot that lets go where it would pull, `e^(−γ t)` at the time
/// when spring and dashpot are in balance: of `K δ = −c v`.
fn closed_form() -> f64 {
    let ratio = damping_ratio();
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
    let of = |dt| restitution("Implicit", dt) - exact;
    let long = [32e-6, 16e-6, 8e-6].map(of);
    let short = [4e-6, 2e-6, 1e-6].map(of);
    println!("e {exact:.5}; at 32, 16, 8 µs {long:?}; at 4, 2, 1 µs {short:?}");
    assert!(long.iter().all(|error| error.abs() < 1e-3));
    for pair in short.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.6..2.4).contains(&order), "order {order}");
    }
    let explicit = [4e-6, 2e-6].map(|dt| restitution("Explicit", dt) - exact);
    let order = (explicit[0] / explicit[1]).log2();
    assert!((0.8..1.2).contains(&order), "explicit: order {order}");
}

#[test]
fn friction_of_an_impact_is_bounded_by_its_spring_in_closed_form() {
    // Sliding all the time it loses `μ ∫ K δ dt`. With `m δ'' + c δ' + K δ = 0` until the contact lets
    // go at `K δ = −c δ'`, and the way back at the speed of then, this is `μ m v (1 + e (1 − 2 ζ²))`.
    let ratio = damping_ratio();
    let exact = 0.4 * 0.3 * (1.0 + closed_form() * (1.0 - 2.0 * ratio * ratio));
    let off = |integrator: &str, dt: f64| (1.0 - impact(integrator, dt, 1.0)[0]) / exact - 1.0;
    let implicit = [32e-6, 16e-6, 8e-6, 4e-6].map(|dt| off("Implicit", dt));
    let explicit = [1e-6, 0.5e-6].map(|dt| off("Explicit", dt));
    println!("{exact:.5} m/s; implicit {implicit:.5?}, explicit {explicit:.5?} off");
    // By the overlaps at the steps' ends it would be 9 % too large with 32 µs.
    for error in implicit.into_iter().chain(explicit) {
        assert_below("friction", error.abs(), 0.015);
    }
    assert_below("friction", implicit[3].abs(), 0.004);
    assert!((0.8..1.2).contains(&(explicit[0] / explicit[1]).log2()));
}

/// Four hundred boxes that hit the floor obliquely, each alone, turned in all ways; returns how much
/// of their momentum along the floor and of their energy they lose, the latter to sliding, and what
/// of the energy is not accounted for.
fn drag_of_oblique_impacts(integrator: &str, dt: f64) -> [f64; 3] {
    let grains = (0..400_u32).map(|i| {
        // Numbers that fill 0 … 1 evenly, each in its own way.
        let part = |root: f64| (f64::from(i + 1) * root.sqrt()).fract();
        let (x, z) = (0.01 * f64::from(i % 20), 0.01 * f64::from(i / 20));
        let height = 0.0022 + 0.0001 * part(2.0);
        let speed = 0.1 + 0.2 * part(3.0);
        let along = speed * (0.2 + part(5.0));
        let axis = [7.0, 11.0, 13.0].map(|root| 2.0 * part(root) - 1.0);
        let angle = 360.0 * part(17.0);
        format!(
            r#"(position: ({x}, {height}, {z}), shape: Box(size: (0.0016, 0.0018, 0.002)), rounding: 0.0001,
                material: "m", velocity: ({along}, {}, 0), orientation: Turned(axis: ({}, {}, {}), angle_deg: {angle}))"#,
            -speed, axis[0], axis[1], axis[2]
        )
    });
    let grains = grains.collect::<Vec<_>>().join(", ");
    let mut world = two(&grains, "(0, 0, 0)", integrator, dt);
    let (momentum, energy) = (momenta(&world)[0].x, world.kinetic_energy());
    run(&mut world, 12e-3);
    let ledger = EnergyLedger::of(&world);
    [
        1.0 - momenta(&world)[0].x / momentum,
        ledger.sliding_loss / energy,
        ledger.residual().abs() / energy,
    ]
}

#[test]
fn friction_of_oblique_impacts_is_that_of_short_steps() {
    let [drag, sliding, _] = drag_of_oblique_impacts("Explicit", 0.5e-6);
    println!("of momentum {drag:.4}, of energy {sliding:.4} lost to friction");
    assert!((0.2..0.4).contains(&drag) && (0.2..0.4).contains(&sliding));
    let off = |integrator: &str, dt: f64| {
        let [own, lost, residual] = drag_of_oblique_impacts(integrator, dt);
        let [own, lost] = [own / drag - 1.0, lost / sliding - 1.0];
        println!(
            "{integrator}, {:.1} µs: drag {:+.2} %, lost {:+.2} %, residual {residual:.1e}",
            1e6 * dt,
            1e2 * own,
            1e2 * lost
        );
        assert!(lost.abs() < 0.03);
        assert_below("residual", residual, 5e-4);
        own
    };
    let explicit = off("Explicit", 2.2e-6);
    assert!((-0.06..0.0).contains(&explicit), "{explicit}");
    for dt in [20e-6, 10e-6, 5e-6] {
        assert_below("drag", off("Implicit", dt).abs(), 0.03);
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

#[test]
fn grains_of_which_no_two_are_near_fly_as_with_the_explicit_integrator() {
    let after = |integrator: &str| {
        let grain = |x: f64| {
            format!(
                r#"(position: ({x}, 1, 0), shape: Box(size: (0.002, 0.003, 0.004)), rounding: 0.0001, material: "m",
                    velocity: (0.4, 0, 0), spin: (3, 20, -5))"#
            )
        };
        let grains = format!("{}, {}", grain(0.0), grain(1.0));
        let mut world = two(&grains, "(0, -9.81, 0)", integrator, STEP);
        run(&mut world, 1e-3);
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
    // The first contacts of a column: before chaos has its say.
    let after = |integrator: &str, dt: f64| {
        let mut world = collapse::column("Full", integrator, dt);
        run(&mut world, 4e-3);
        world
    };
    let apart = |dt: f64| {
        let (a, b) = (after("Explicit", dt), after("Implicit", dt));
        let pairs = a.grains.position.iter().zip(&b.grains.position);
        pairs.map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
    };
    let fallen = 0.5 * 9.81 * 4e-3 * 4e-3;
    let [coarse, middle, fine] = [1.6e-6, 0.8e-6, 0.4e-6].map(|dt| apart(dt) / fallen);
    println!("farthest apart, over the way fallen: {coarse:.2e} {middle:.2e} {fine:.2e}");
    assert!(fine < 0.7 * middle && middle < 0.7 * coarse && fine < 0.01);
}

#[test]
fn collapse_closes_its_energy_balance_and_comes_to_rest() {
    let text = collapse::text_of_column("Full", "Implicit");
    let text = text.replace("radius_mm: 8, height_mm: 16", "radius_mm: 6, height_mm: 12");
    let mut world = world(&text, STEP);
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
fn neither_springs_nor_dashpots_of_crowded_grains_limit_the_step() {
    let limits = |integrator: &str| {
        let text = collapse::text_of_column("Full", integrator);
        advise(&Scene::parse("column", &text).unwrap())
    };
    let (explicit, implicit) = (limits("Explicit"), limits("Implicit"));
    println!("{explicit:?}\n{implicit:?}");
    let names: Vec<_> = implicit.limits.iter().map(|limit| limit.name).collect();
    assert_eq!(names, ["linear contact", "way in a step"]);
    assert!(implicit.time_step > 10.0 * explicit.time_step);
    // A tall column falls fast: no grain may move past its rounding in a step.
    let tall =
        collapse::text_of_column("Full", "Implicit").replace("height_mm: 16", "height_mm: 1600");
    let tall = advise(&Scene::parse("column", &tall).unwrap());
    assert_eq!(tall.limits[0].name, "way in a step");
    let way = tall.time_step * (2.0 * 9.81 * 1.6_f64).sqrt();
    assert_relative("way", way, 0.2 * 0.3e-3, 1e-12);
}
