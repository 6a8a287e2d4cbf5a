//! Elastic energy against closed forms, and the balance of motions whose energy is known.

use super::*;
use grainfall::measure::{EnergyLedger, elastic_energy};
use grainfall::physics::FeatureRule;
use grainfall::solver::Solver;

/// Two grains of radii `r` and `2 r` that overlap by `overlap`, with tangential spring `xi`.
fn pressed_pair(overlap: f64, xi: f64) -> World {
    let r = 0.001;
    let mut world = on_floor();
    push(&mut world, DVec3::new(0.0, 0.01, 0.0), r);
    push(
        &mut world,
        DVec3::new(3.0 * r - overlap, 0.01, 0.0),
        2.0 * r,
    );
    touch(&mut world, 0, Partner::Grain(1), DVec3::Y * xi);
    world
}

#[test]
fn hertz_energy_is_eight_fifteenths_of_the_closed_form() {
    let delta = 1e-5;
    let effective_modulus = 63e6 / (2.0 * (1.0 - 0.21 * 0.21));
    let effective_radius = 0.001 * 0.002 / 0.003_f64;
    let expected =
        8.0 / 15.0 * effective_modulus * effective_radius.sqrt() * delta * delta * delta.sqrt();
    // The overlap is a difference of numbers 300 times as large.
    assert_close(
        elastic_energy(&pressed_pair(delta, 0.0)) / expected,
        1.0,
        1e-11,
    );
}

#[test]
fn hertz_energy_grows_with_the_hertz_force() {
    let (delta, step) = (1e-5, 1e-8);
    let change = elastic_energy(&pressed_pair(delta + step, 0.0))
        - elastic_energy(&pressed_pair(delta - step, 0.0));
    let effective_modulus = 63e6 / (2.0 * (1.0 - 0.21 * 0.21));
    let stiffness = 4.0 / 3.0 * effective_modulus * (0.002 / 3.0 * delta).sqrt();
    // Central difference: (step/delta)²/24 of the third derivative.
    assert_close(change / (2.0 * step) / (stiffness * delta), 1.0, 1e-6);
}

#[test]
fn tangential_spring_stores_half_its_stiffness_times_its_square() {
    let (delta, xi) = (1e-5, 2e-6);
    let stored =
        elastic_energy(&pressed_pair(delta, xi)) - elastic_energy(&pressed_pair(delta, 0.0));
    let shear_modulus = 63e6 / (2.0 * 1.21);
    let effective_modulus = shear_modulus / (2.0 * (2.0 - 0.21));
    let stiffness = 8.0 * effective_modulus * (0.002 / 3.0 * delta).sqrt();
    // A difference of energies ten times as large, with the overlap's own rounding.
    assert_close(stored / (0.5 * stiffness * xi * xi), 1.0, 1e-10);
}

#[test]
fn wall_counts_as_a_partner_without_curvature_of_its_own_material() {
    let delta: f64 = 1e-5;
    let mut world = on_floor();
    push(&mut world, DVec3::Y * (0.003 - delta), 0.003);
    touch(&mut world, 0, Partner::Wall(0), DVec3::ZERO);
    let compliance = (1.0 - 0.21_f64.powi(2)) / 63e6 + (1.0 - 0.35_f64.powi(2)) / 12e6;
    let expected = 8.0 / 15.0 / compliance * 0.003_f64.sqrt() * delta.powf(2.5);
    assert_close(elastic_energy(&world) / expected, 1.0, 1e-11);
}

#[test]
fn hooke_springs_store_half_their_stiffness_times_their_square() {
    let (delta, xi) = (1e-5, 2e-6);
    let mut world = pressed_pair(delta, xi);
    world.law = ContactLaw::Hooke {
        normal_stiffness: 4000.0,
        tangential_stiffness: 2000.0,
        features: FeatureRule::Full,
    };
    let expected = 0.5 * 4000.0 * delta * delta + 0.5 * 2000.0 * xi * xi;
    assert_close(elastic_energy(&world) / expected, 1.0, 1e-11);
}

/// Bodies that touch in several places, under linear springs of 4000 and 2000 N/m.
fn touching_in_places(rule: FeatureRule, features: Vec<FeatureContact>) -> World {
    let mut world = two_rounded_bodies();
    world.law = ContactLaw::Hooke {
        normal_stiffness: 4000.0,
        tangential_stiffness: 2000.0,
        features: rule,
    };
    world.polyhedra.as_mut().unwrap().features = features;
    world
}

#[test]
fn features_of_polyhedra_store_each_its_own_energy() {
    let mut first = feature(0, Partner::Grain(1), 0, 1e-5);
    first.spring = DVec3::new(0.0, 3e-6, 4e-6);
    let features = vec![
        first,
        feature(0, Partner::Grain(1), 1, 2e-5),
        feature(0, Partner::Wall(0), 0, 3e-5),
        feature(1, Partner::Wall(0), 0, -1e-5),
    ];
    let expected = 0.5 * 4000.0 * (1.0 + 4.0 + 9.0) * 1e-10 + 0.5 * 2000.0 * 25e-12;
    let stored = elastic_energy(&touching_in_places(FeatureRule::Full, features));
    assert_close(stored / expected, 1.0, 1e-14);
}

#[test]
fn features_that_share_a_contact_store_one_contacts_energy() {
    // Four equal ones press like one; their springs have a quarter of its stiffness each.
    let equal = |corner| {
        let mut contact = feature(0, Partner::Grain(1), corner, 1e-5);
        (contact.spring, contact.stiffness) = (DVec3::Z * 5e-6, 500.0);
        contact
    };
    let world = touching_in_places(FeatureRule::Shared, (0..4).map(equal).collect());
    let expected = 0.5 * 4000.0 * 1e-10 + 0.5 * 2000.0 * 25e-12;
    assert_close(elastic_energy(&world) / expected, 1.0, 1e-14);
    // Overlaps of 1 and 3: Σδ²/(Σδ)² = 10/16 of the stiffness for each; another pair shares nothing with them.
    let features = vec![
        feature(0, Partner::Grain(1), 0, 1e-5),
        feature(0, Partner::Grain(1), 1, 3e-5),
        feature(0, Partner::Wall(0), 0, 2e-5),
    ];
    let expected = 0.5 * 4000.0 * (10.0 / 16.0 * 10.0 + 4.0) * 1e-10;
    let stored = elastic_energy(&touching_in_places(FeatureRule::Shared, features));
    assert_close(stored / expected, 1.0, 1e-14);
}

#[test]
fn contact_that_has_opened_stores_nothing() {
    assert_eq!(elastic_energy(&pressed_pair(-1e-6, 1e-6)), 0.0);
}

/// One grain of radius 3 mm at a height of 1 m, its ledger opened.
fn raised_grain() -> World {
    let mut world = on_floor();
    push(&mut world, DVec3::Y, 0.003);
    world.restart_clock(0.0);
    world
}

#[test]
fn free_fall_balances() {
    let mut world = raised_grain();
    world.grains.position[0].y = 0.5;
    world.grains.velocity[0].y = -9.81_f64.sqrt();
    let ledger = EnergyLedger::of(&world);
    let work = world.grains.mass[0] * 9.81 * 0.5;
    assert_close(ledger.gravity_work / work, 1.0, 1e-14);
    assert_close(ledger.kinetic / work, 1.0, 1e-14);
    assert_close(ledger.relative_residual(), 0.0, 1e-14);
}

#[test]
fn change_of_gravity_does_no_work_by_itself() {
    let mut world = raised_grain();
    world.grains.position[0].y = 0.5;
    world.set_gravity(DVec3::new(0.0, -1.62, 0.0));
    world.grains.position[0].y = 0.1;
    let work = world.grains.mass[0] * (9.81 * 0.5 + 1.62 * 0.4);
    assert_close(EnergyLedger::of(&world).gravity_work / work, 1.0, 1e-14);
}

#[test]
fn every_exchange_enters_with_its_sign() {
    let mut world = raised_grain();
    push(&mut world, DVec3::Y * 2.0, 0.003);
    world.restart_clock(0.0);
    world
        .grains
        .exchanged
        .set(vec![[1.0, 2.0, 4.0, 8.0], [16.0, 32.0, 64.0, 128.0]]);
    world.ledger.command_work = 256.0;
    let ledger = EnergyLedger::of(&world);
    assert_eq!(ledger.dashpot_loss, 17.0);
    assert_eq!(ledger.sliding_loss, 34.0);
    assert_eq!(ledger.rolling_loss, 68.0);
    assert_eq!(ledger.wall_work, 136.0);
    // Nothing moved, so all that came in and was not lost is missing.
    assert_eq!(ledger.residual(), 17.0 + 34.0 + 68.0 - 136.0 - 256.0);
    assert_eq!(ledger.relative_residual(), ledger.residual() / 256.0);
}

#[test]
fn balance_of_nothing_has_no_residual() {
    assert_eq!(EnergyLedger::of(&on_floor()).relative_residual(), 0.0);
}

/// Changes the properties of every pair of materials.
fn set_pairs(world: &mut World, properties: PairProperties) {
    for (a, b) in [(GLASS, GLASS), (GLASS, STEEL), (STEEL, STEEL)] {
        *world.materials.pair_mut(a, b) = properties;
    }
}

#[test]
fn belt_does_twice_the_work_that_the_grain_keeps() {
    let (speed, r) = (0.1, 0.003);
    let mut world = on_floor();
    set_pairs(
        &mut world,
        PairProperties {
            restitution: 0.5,
            friction: 0.4,
            wet_friction: 0.4,
            rolling_friction: 0.0,
        },
    );
    push(&mut world, DVec3::Y * r, r);
    let mut solver = Solver::new(1);
    solver.advance(&mut world, 5000).expect("grain settles");
    world.restart_clock(elastic_energy(&world));

    world.container.walls[0].motion.velocity = speed * DVec3::X;
    solver.advance(&mut world, 2000).expect("grain rolls");
    let ledger = EnergyLedger::of(&world);
    let scale = world.grains.mass[0] * speed * speed;
    // Slip turns to rolling at v = 2/7 of the belt's speed after 7.3 ms of the 20. The tangential spring swings a little
    // when slip ends, and sliding is booked with the slip half a step late: 1 % covers both.
    assert_close(ledger.wall_work / scale, 2.0 / 7.0, 0.01 * 2.0 / 7.0);
    assert_close(ledger.kinetic / scale, 1.0 / 7.0, 0.01 / 7.0);
    assert_close(
        (ledger.sliding_loss + ledger.dashpot_loss) / scale,
        1.0 / 7.0,
        0.01 / 7.0,
    );
    assert_close(ledger.relative_residual(), 0.0, 0.005);
}

#[test]
fn damped_impact_loses_what_its_dashpot_is_said_to_take() {
    let restitution = 0.8;
    let mut world = on_floor();
    set_pairs(
        &mut world,
        PairProperties {
            restitution,
            friction: 0.0,
            wet_friction: 0.0,
            rolling_friction: 0.0,
        },
    );
    world.gravity = DVec3::ZERO;
    world.clock = Clock::new(1e-7);
    push(&mut world, DVec3::Y * 0.003_001, 0.003);
    world.grains.velocity[0].y = -0.2;
    world.restart_clock(0.0);
    Solver::new(1)
        .advance(&mut world, 15_000)
        .expect("grain bounces");
    let ledger = EnergyLedger::of(&world);
    // Restitution itself is good to some 1e-4 at this step, the books to the first order of the step: 5e-5.
    let lost = (1.0 - restitution * restitution) * ledger.initial;
    assert_close(ledger.dashpot_loss / lost, 1.0, 2e-3);
    assert_close(ledger.relative_residual(), 0.0, 2e-4);
}
