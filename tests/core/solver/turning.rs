//! What a contact remembers turns with its grains: springs and rolling torques of bodies that turn
//! as one stay the same in the frame that turns with them.

use super::*;
use glam::{DQuat, DVec3};
use grainfall::lanes::{Lanes, Row};
use grainfall::physics::Materials;
use grainfall::physics::law::{
    Circumstances, Coefficients, HertzMindlin, Law, LawFacts, LawSource, LawWords, Pairing,
    SmallestGrain, StepLimit,
};
use grainfall::world::Contact;

const RADIUS: f64 = 3e-3;
const STEP: f64 = 2e-5;
/// Turn that the tests take [rad/s].
const SPIN: f64 = 5.0;
/// A spring along the surfaces of a contact, well below its bound [m].
const SPRING: f64 = 1e-8;
/// A mass that no contact force moves [kg].
const IMMOVABLE: f64 = 1e9;

/// Hertz–Mindlin with contacts whose memory follows their normals without turning about them.
#[derive(Clone, Copy, Debug)]
pub struct FollowsNormal;

impl Law for FollowsNormal {
    const OBJECTIVE: bool = false;

    #[inline(always)]
    fn coefficients<N: Lanes>(self, constants: [N; 4], overlap: N) -> Coefficients<N> {
        HertzMindlin.coefficients(constants, overlap)
    }

    #[inline(always)]
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, zero: N) -> N {
        HertzMindlin.normal_force(elastic, damping, zero)
    }

    #[inline(always)]
    fn coulomb_force<N: Lanes>(self, elastic: N, normal: N, zero: N) -> N {
        HertzMindlin.coulomb_force(elastic, normal, zero)
    }
}

impl LawFacts for FollowsNormal {
    fn constants(&self, pairing: &Pairing, materials: &Materials) -> Row {
        HertzMindlin.constants(pairing, materials)
    }

    fn stored_share(&self) -> f64 {
        HertzMindlin.stored_share()
    }

    fn step_limits(&self, grain: &SmallestGrain, at: &Circumstances) -> Vec<StepLimit> {
        HertzMindlin.step_limits(grain, at)
    }

    fn words(&self) -> LawWords {
        HertzMindlin.words()
    }

    fn uses_elastic_constants(&self) -> bool {
        HertzMindlin.uses_elastic_constants()
    }
}

/// The world of this container and these grains, too heavy for contact forces to move them, after
/// a first step.
fn heavy(container: &str, grains: &str) -> World {
    let mut world = world(
        &format!(
            r#"(
    title: "Grains that turn as one",
    materials: {{"glass": (friction: 0.4, rolling_friction: 0.05)}},
    container: {container},
    gravity: (0, 0, 0),
    grains: List([{grains}]),
)"#
        ),
        STEP,
    );
    world.grains.mass.fill(IMMOVABLE);
    world.grains.inertia.fill(IMMOVABLE);
    Solver::new(1).advance(&mut world, 1).unwrap();
    assert_eq!(world.contacts.len(), 1, "one contact");
    world
}

/// Two spheres that overlap along `normal`, with these spins about it [rad/s].
fn two_grains(normal: DVec3, spins: [f64; 2]) -> World {
    let grain = |position: DVec3, spin: DVec3| {
        let ([x, y, z], [a, b, c]) = (position.to_array(), spin.to_array());
        format!(
            "(position: ({x}, {y}, {z}), spin: ({a}, {b}, {c}), radius: {RADIUS}, material: \"glass\"),"
        )
    };
    let overlap = 1e-3 * RADIUS;
    let grains = grain(DVec3::ZERO, normal * spins[0])
        + &grain(normal * (2.0 * RADIUS - overlap), normal * spins[1]);
    heavy(
        "Planes([(point: (0, -1, 0), normal: (0, 1, 0), material: \"glass\")])",
        &grains,
    )
}

/// Asserts that a spring across `axis` turns about it by `speed` [rad/s].
#[track_caller]
fn assert_spring_turns(mut world: World, axis: DVec3, speed: f64) {
    let spring = SPRING * axis.any_orthonormal_vector();
    world.contacts[0].spring = spring;
    let begin = world.time();
    for _ in 0..8 {
        run(&mut world, 0.05);
        let turn = DQuat::from_axis_angle(axis, speed * (world.time() - begin));
        let off = (world.contacts[0].spring - turn * spring).length() / SPRING;
        // Even these grains give way a little, by ½ (k_t ξ/m) t².
        assert_below("spring off its turn", off, 1e-6);
    }
}

#[test]
fn spring_of_two_grains_turns_with_them_about_their_normal() {
    for normal in [
        DVec3::X,
        DVec3::new(0.6, 0.0, -0.8),
        DVec3::new(2.0, 3.0, 6.0) / 7.0,
    ] {
        assert_spring_turns(two_grains(normal, [SPIN; 2]), normal, SPIN);
    }
}

#[test]
fn spring_turns_by_the_mean_of_both_spins() {
    let normal = DVec3::new(0.6, 0.0, -0.8);
    assert_spring_turns(two_grains(normal, [SPIN, 0.0]), normal, 0.5 * SPIN);
    assert_spring_turns(two_grains(normal, [SPIN, -SPIN]), normal, 0.0);
}

#[test]
fn spring_of_a_grain_at_a_plate_turns_with_the_drum() {
    let z = -0.011 + (1.0 - 1e-3) * RADIUS;
    let world = heavy(
        &format!("Drum(radius: 0.0605, width_mm: 22, speed: {SPIN}, material: \"glass\")"),
        &format!(
            "(position: (0, 0, {z}), spin: (0, 0, {SPIN}), radius: {RADIUS}, material: \"glass\")"
        ),
    );
    assert_spring_turns(world, DVec3::Z, SPIN);
}

/// A drum that lies on its back plate and turns with its grains, as a turntable does.
const TURNTABLE: &str = r#"(
    title: "A turntable",
    materials: {"glass": (friction: 0.4, rolling_friction: 0.05)},
    container: Drum(radius: 0.02, width_mm: 30, speed: 0.2, material: "glass"),
    gravity: (0, 0, -9.81),
    grains: Fill(count: 120, species: [(radius_mm: 2, material: "glass")]),
)"#;

/// By how much forces and rolling torques of the turntable's bed change in a quarter turn of it,
/// seen from the turntable, in relation to themselves.
fn changes<S: LawSource>(law: S) -> [f64; 2] {
    let mut world = world(TURNTABLE, STEP);
    let speed = world.container.drum_speed();
    let mut solver = Solver::with_law(law, 1);
    let mut advance = |world: &mut World, time: f64| {
        let steps = (time / STEP).round() as u64;
        solver.advance(world, steps).unwrap();
    };
    advance(&mut world, 3.0);
    let (before, begin) = (world.clone(), world.time());
    advance(&mut world, std::f64::consts::TAU / 4.0 / speed);
    let turn = DQuat::from_rotation_z(speed * (world.time() - begin));
    let mut changes = [Change::default(); 2];
    for contact in &world.contacts {
        let same = |old: &&Contact| (old.grain, old.partner) == (contact.grain, contact.partner);
        let Some(old) = before.contacts.iter().find(same) else {
            continue;
        };
        changes[0].add(contact.force, turn * old.force);
        changes[1].add(contact.rolling, turn * old.rolling);
    }
    println!("{} contacts", changes[0].count);
    assert!(changes[0].count > 200);
    changes.map(Change::relative)
}

#[test]
fn bed_that_turns_as_one_keeps_its_forces_in_its_own_frame() {
    // What is left is of second order in the angle of a step, and the last of the settling.
    let [force, torque] = changes(HertzMindlin);
    assert_below("change of forces", force, 1e-4);
    assert_below("change of rolling torques", torque, 1e-3);
    let [without, torque_without] = changes(FollowsNormal);
    println!("following the normal alone: {without:.3} and {torque_without:.3}");
    assert!(without > 0.01 && torque_without > 0.3, "both rules matter");
}

/// How much vectors have changed.
#[derive(Clone, Copy, Default)]
struct Change {
    count: usize,
    difference: f64,
    all: f64,
}

impl Change {
    fn add(&mut self, now: DVec3, before: DVec3) {
        self.count += 1;
        self.difference += (now - before).length_squared();
        self.all += before.length_squared();
    }

    fn relative(self) -> f64 {
        (self.difference / self.all).sqrt()
    }
}
