//! Liquid bridges: forces against LIGGGHTS 3.8 and closed forms, rupture, sharing of films, energy,
//! stability.

use super::*;
use glam::DVec3;
use grainfall::measure::EnergyLedger;
use grainfall::solver::{Processor, advise};
use std::f64::consts::PI;

/// A step that nobody takes: forces are those of the given state.
const ANY_STEP: f64 = 1e-5;

/// Two listed grains and a liquid; `second` is the rest of the second grain's entry.
fn wet_pair(liquid: &str, radii_mm: (f64, f64), first: &str, second: &str, dt: f64) -> World {
    world(
        &format!(
            r#"(
    title: "Two grains on a bridge",
    materials: {{"glass": (friction: 0.4, wet_friction: 0.1)}},
    container: Nothing,
    gravity: (0, 0, 0),
    grains: List([
        (position: (0, 0, 0), {first} radius_mm: {}, material: "glass"),
        (position: ({}, 0, 0), {second} radius_mm: {}, material: "glass"),
    ]),
    liquid: {liquid},
)"#,
            radii_mm.0,
            // 0.1 % deep: a bridge forms in the first step.
            1e-3 * (radii_mm.0 + radii_mm.1) * 0.999,
            radii_mm.1
        ),
        dt,
    )
}

/// Evaluates the forces with the second grain at `x` on the axis and the motion it has.
fn evaluate_at(world: &mut World, x: f64) {
    world.grains.position[1] = DVec3::X * x;
    Solver::new(1).evaluate(world).unwrap();
}

fn sphere(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// What the tangential drag of a row lacks because that program has 0.5333333 for 8/15 [N].
fn rounded_digits(row: &[f64]) -> f64 {
    if row[7] == 0.0 {
        return 0.0;
    }
    let (radius, gap) = (1.5e-3, row[2] - 6e-3);
    let slip = row[4] - row[5] * (0.5 * row[2]).min(3e-3);
    let log = (radius / gap.max(row[0] * radius)).ln();
    6.0 * PI * 1.41 * radius * slip * (8.0 / 15.0 - 0.533_333_3) * log
}

#[test]
fn forces_are_those_of_liggghts() {
    // Its film is 7.53 % of a grain's volume. It goes through the rows in this order: a bridge that broke stays broken.
    let film = 0.0753 * sphere(3e-3);
    let text = include_str!("wet_pair_reference.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 43);
    let mut tested = 0;
    for of_case in rows.chunk_by(|a, b| a[..2] == b[..2]) {
        let (gap, angle) = (of_case[0][0], of_case[0][1]);
        let liquid = format!(
            "(surface_tension: 0.064, contact_angle_deg: {angle}, viscosity: 1.41, volume: {:e}, law: Choices(\
             volume: ShadedCap, angle: HalfProduct, viscous_gap: OfEffectiveRadius({gap}), capillary_gap: Open))",
            2.0 * film
        );
        let mut world = wet_pair(&liquid, (3.0, 3.0), "", "", ANY_STEP);
        for row in of_case {
            world.grains.velocity[1] = DVec3::new(row[3], row[4], 0.0);
            world.grains.spin[1] = DVec3::Z * row[5];
            evaluate_at(&mut world, row[2]);
            let grains = &world.grains;
            let force = DVec3::new(row[6], row[7] + rounded_digits(row), 0.0);
            let off = (grains.force[0] - force).length();
            // Ten digits stand in the reference; the gap, a difference of lengths, has twelve.
            assert!(
                off <= 1e-9 * force.length(),
                "{row:?}: {} instead of {force}",
                grains.force[0]
            );
            for i in 0..2 {
                let torque = (grains.torque[i] + grains.rolling_torque[i]).z;
                let arm = (0.5 * row[2]).min(3e-3);
                let expected = row[8 + i] + arm * rounded_digits(row);
                assert!(
                    (torque - expected).abs() <= 1e-8 * expected.abs() + 1e-20,
                    "{row:?}: torque {torque:e} instead of {expected:e}"
                );
            }
            tested += usize::from(force.length() > 0.0);
        }
    }
    assert!(tested > 25, "most rows have a force: {tested}");
}

#[test]
fn drag_of_unequal_grains_is_that_of_eqs_16_and_17() {
    let (a, b) = (2e-3, 3e-3);
    let liquid = "(case: 5, volume: 1e-8)";
    let mut world = wet_pair(liquid, (2.0, 3.0), "", "", ANY_STEP);
    evaluate_at(&mut world, 0.999 * (a + b));
    let (radius, gap, speed) = (a * b / (a + b), 2.5e-4, 0.03);
    let drag = 6.0 * PI * 0.523 * radius;
    // At rest, moving apart, moving sideways: what differs is viscous.
    evaluate_at(&mut world, a + b + gap);
    let still = world.grains.force[0];
    world.grains.velocity[1] = DVec3::X * speed;
    evaluate_at(&mut world, a + b + gap);
    let apart = world.grains.force[0] - still;
    assert_relative(
        "along the normal",
        apart.x,
        drag * radius * speed / gap,
        1e-9,
    );
    world.grains.velocity[1] = DVec3::Y * speed;
    evaluate_at(&mut world, a + b + gap);
    let sideways = world.grains.force[0] - still;
    let bracket = 8.0 / 15.0 * (radius / gap).ln() + 0.9588;
    assert_relative("across it", sideways.y, drag * bracket * speed, 1e-9);
    // The arm of a gap is the radius.
    assert_relative(
        "torque on 1",
        world.grains.torque[0].z,
        a * sideways.y,
        1e-9,
    );
    assert_relative(
        "torque on 2",
        world.grains.torque[1].z,
        b * sideways.y,
        1e-9,
    );
    // Closer than 0.01 of the radii's sum the gap counts as that.
    world.grains.velocity[1] = DVec3::X * speed;
    evaluate_at(&mut world, a + b + 1e-6);
    let close = world.grains.force[0];
    world.grains.velocity[1] = DVec3::ZERO;
    evaluate_at(&mut world, a + b + 1e-6);
    let resisted = (close - world.grains.force[0]).x;
    assert_relative(
        "at the smallest gap",
        resisted,
        drag * radius * speed / (0.01 * (a + b)),
        1e-9,
    );
}

#[test]
fn bridge_breaks_at_its_rupture_gap() {
    // Volumes of all liquid [m³], radii [mm], contact angles [°]: the first is capped at 0.1 of the radii's sum.
    for (volume, radii, angle, law) in [
        (2e-8, (3.0_f64, 3.0_f64), 39.5_f64, "AsPrinted"),
        (1e-10, (3.0, 3.0), 39.5, "AsPrinted"),
        (1e-10, (3.0, 3.0), 0.0, "AsPrinted"),
        (3e-11, (1.0, 3.0), 20.0, "AsPrinted"),
        (2e-8, (3.0, 3.0), 39.5, "Choices(rupture: AtRuptureGap)"),
        (2e-8, (1.0, 3.0), 60.0, "Choices(rupture: AtRuptureGap)"),
        (1e-10, (2.0, 3.0), 40.0, "AsCoded"),
    ] {
        let liquid =
            format!("(case: 3, contact_angle_deg: {angle}, volume: {volume:e}, law: {law})");
        let sum = 1e-3 * (radii.0 + radii.1);
        let bridge_volume = if law == "AsCoded" {
            let cap = |r: f64, other: f64| {
                let film = volume * r.powi(3) / (radii.0.powi(3) + radii.1.powi(3));
                0.5 * film * (1.0 - (1.0 - (1e-3 * other / sum).powi(2)).sqrt())
            };
            cap(radii.0, radii.1) + cap(radii.1, radii.0)
        } else {
            0.05 * volume
        };
        let angle = angle.to_radians();
        let angle = if law == "AsCoded" {
            0.5 * angle * angle
        } else {
            angle
        };
        let d0 = (1.0 + 0.5 * angle) * bridge_volume.cbrt();
        let gap = if law.contains("AtRuptureGap") {
            d0
        } else {
            d0.min(0.1 * sum)
        };
        let mut world = wet_pair(&liquid, radii, "", "", ANY_STEP);
        evaluate_at(&mut world, 0.999 * sum);
        let bridge = world.contacts[0]
            .bridge
            .as_ref()
            .expect("a bridge forms at contact");
        assert_relative("volume", bridge.volume, bridge_volume, 1e-12);
        evaluate_at(&mut world, sum + gap * (1.0 - 1e-9));
        assert_eq!(world.contacts.len(), 1, "{law}: the bridge holds");
        assert!(!world.contacts[0].touching);
        assert_eq!(*world.grains.open_bridges, [1, 1]);
        evaluate_at(&mut world, sum + gap * (1.0 + 1e-9));
        assert_eq!(world.contacts.len(), 0, "{law}: it breaks at {gap}");
        assert_eq!(world.ledger.ruptures, 1);
        assert_eq!(world.grains.force[0], DVec3::ZERO);
        // And forms again only where they touch.
        evaluate_at(&mut world, sum + 0.5 * gap);
        assert_eq!(world.contacts.len(), 0);
    }
}

#[test]
fn unequal_films_share_their_bridge_evenly_and_lose_nothing() {
    let mut world = wet_pair(
        "(case: 2, volume: 1)",
        (3.0, 3.0),
        "film: 8e-9,",
        "film: 2e-9,",
        ANY_STEP,
    );
    assert_eq!(*world.grains.film, [8e-9, 2e-9]);
    evaluate_at(&mut world, 5.999e-3);
    assert_relative(
        "volume",
        world.contacts[0].bridge.as_ref().unwrap().volume,
        5e-10,
        1e-12,
    );
    assert_eq!(
        *world.grains.film,
        [8e-9, 2e-9],
        "a film counts its part in bridges"
    );
    evaluate_at(&mut world, 7.5e-3);
    // 4e-10 came from the first, 1e-10 from the second; each takes 2.5e-10 home.
    assert_relative("first", world.grains.film[0], 8e-9 - 1.5e-10, 1e-12);
    assert_relative("second", world.grains.film[1], 2e-9 + 1.5e-10, 1e-12);
}

#[test]
fn dry_grains_make_no_bridge() {
    let mut world = wet_pair(
        "(case: 2, volume: 1)",
        (3.0, 3.0),
        "film: 0,",
        "film: 0,",
        ANY_STEP,
    );
    evaluate_at(&mut world, 5.999e-3);
    assert!(world.contacts[0].bridge.is_none());
}

/// Two grains that hit each other head-on and part, with the balance's residual over the energy
/// before.
fn collide(viscosity: f64, dt: f64) -> (World, f64) {
    let liquid = format!("(case: 3, viscosity: {viscosity}, volume: 1.7e-8)");
    let mut world = wet_pair(
        &liquid,
        (3.0, 3.0),
        "velocity: (0.15, 0, 0),",
        "velocity: (-0.15, 0.02, 0),",
        dt,
    );
    world.grains.position[1].x = 6.0001e-3;
    world.restart_clock(0.0);
    let before = world.kinetic_energy();
    run(&mut world, 0.03);
    let residual = EnergyLedger::of(&world).residual() / before;
    (world, residual.abs())
}

#[test]
fn energy_of_a_wet_impact_goes_where_the_ledger_says() {
    for viscosity in [0.0, 0.1] {
        let [(_, coarse), (world, fine)] = [1e-5, 1e-6].map(|dt| collide(viscosity, dt));
        println!("η {viscosity}: residual {coarse:.1e} at 1e-5 s, {fine:.1e} at 1e-6 s");
        assert_eq!(world.contacts.len(), 0, "they part");
        assert!(coarse < 2e-2 && fine < 0.3 * coarse, "{coarse} {fine}");
        let [viscous, capillary] = world.grains.liquid_loss[0];
        assert!(capillary > 0.0, "breaking a bridge costs energy");
        if viscosity == 0.0 {
            assert_eq!(viscous, 0.0);
        } else {
            assert!(viscous > capillary);
        }
    }
}

#[test]
fn breaking_a_bridge_costs_the_integral_of_its_attraction() {
    // It forms at contact and not before: the way in is free up to there, and the way out costs all of Eq. 13.
    let (world, _) = collide(0.0, 1e-7);
    let (radius, gamma, angle) = (3e-3_f64, 0.063_4 + 0.0094 * 0.09, 39.5_f64.to_radians());
    let volume = 0.05 * 1.7e-8 / radius.powi(3);
    let a = -1.1 * volume.powf(-0.53) / radius;
    let b = (-0.037 * volume.ln() - 0.24) * 4.0 * angle * angle - 0.0082 * volume.ln() + 0.48;
    let c = 0.0018 * volume.ln() + 0.078;
    let (low, high) = (0.02 * radius, 0.2 * radius);
    let force = |gap: f64| PI * gamma * radius * (c + (a * gap + b).exp());
    let decaying = ((a * high + b).exp() - (a * low + b).exp()) / a;
    let expected = low * force(low) + PI * gamma * radius * (c * (high - low) + decaying);
    assert_relative(
        "capillary loss",
        world.grains.liquid_loss[0][1],
        expected,
        2e-3,
    );
}

#[test]
fn bridge_keeps_its_state_when_lists_are_made_anew() {
    // The pair flies 30 radii, far beyond any skin, and turns: lists are made anew many times on the way.
    let speed = "velocity: (0, 3, 0),";
    let flight = |fresh: bool| {
        let mut world = wet_pair("(case: 4, volume: 1.7e-8)", (3.0, 3.0), speed, speed, 1e-5);
        run(&mut world, 1e-5);
        let volume = world.contacts[0].bridge.as_ref().unwrap().volume;
        let mut solver = Solver::new(1);
        for _ in 0..30 {
            if fresh {
                solver = Solver::new(1);
            }
            solver.advance(&mut world, 100).unwrap();
            assert_eq!(world.contacts[0].bridge.as_ref().unwrap().volume, volume);
        }
        assert!(world.grains.position[0].y > 0.08);
        world.hash()
    };
    assert_eq!(flight(false), flight(true));
}

const WET_DRUM: &str = r#"(
    title: "Small wet drum",
    materials: {"glass": (friction: 0.4, wet_friction: 0.1), "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35)},
    container: Drum(radius_mm: 24, width_mm: 22, speed_rpm: 20, material: "drum"),
    grains: Fill(count: 50, species: [(radius_mm: 2, material: "glass", share: 0.5), (name: "big", radius_mm: 3, material: "glass", share: 0.5)]),
    liquid: (case: 4, volume_ml: 0.5),
    seed: 7,
)"#;

/// A small wet drum that has tumbled for a while.
fn tumbling() -> World {
    let mut world = world(WET_DRUM, 1e-5);
    Solver::new(1).advance(&mut world, 8000).unwrap();
    assert!(world.ledger.ruptures > 0, "bridges have broken");
    assert!(
        world
            .contacts
            .iter()
            .any(|c| c.bridge.is_some() && !c.touching)
    );
    world
}

#[test]
fn wet_drum_has_the_same_bits_for_every_width_thread_count_and_slicing() {
    let start = tumbling();
    let go = |mut solver: Solver, slices: &[u64]| {
        let mut world = start.clone();
        for &steps in slices {
            solver.advance(&mut world, steps).unwrap();
        }
        world.hash()
    };
    let plain = go(Solver::on(Processor::Scalar, 1), &[2000]);
    for processor in Processor::all() {
        assert_eq!(go(Solver::on(processor, 1), &[2000]), plain, "{processor}");
    }
    for threads in [2, 3, 8] {
        assert_eq!(
            go(Solver::new(threads), &[2000]),
            plain,
            "{threads} threads"
        );
    }
    assert_eq!(go(Solver::new(1), &[1, 7, 492, 1500]), plain);
}

#[test]
fn liquid_is_neither_made_nor_lost() {
    let mut world = tumbling();
    run(&mut world, 0.1);
    let all: f64 = world.grains.film.iter().sum();
    assert_relative("all films", all, 0.5e-6, 1e-12);
}

#[test]
fn no_viscosity_makes_the_step_unstable() {
    // A thousand times as viscous as glycerol: the drag is bounded by what the step can bear, and energy falls.
    let mut world = tumbling();
    world.gravity = DVec3::ZERO;
    world.container.set_drum_speed(0.0);
    if let Some(liquid) = &mut world.liquid {
        liquid.viscosity = 1e3;
    }
    let mut last = world.kinetic_energy();
    for _ in 0..20 {
        Solver::new(1).advance(&mut world, 50).unwrap();
        let now = world.kinetic_energy();
        assert!(now < 1.05 * last, "{now:e} after {last:e}");
        last = now;
    }
}

#[test]
fn viscosity_limits_the_advised_step_where_it_must() {
    let step = |case: u8, radius: f64| {
        let text = WET_DRUM.replace("case: 4", &format!("case: {case}")).replace(
            "(radius_mm: 2, material: \"glass\", share: 0.5), (name: \"big\", radius_mm: 3, material: \"glass\", share: 0.5)",
            &format!("(radius_mm: {radius}, material: \"glass\")"),
        );
        let advice = advise(&Scene::parse("test", &text).unwrap());
        println!(
            "n = {case}, r = {radius} mm: {:.3e} s, {}",
            advice.time_step, advice.limits[0].reason
        );
        advice
    };
    assert_ne!(step(1, 1.25).limits[0].name, "lubrication");
    assert_ne!(step(7, 3.0).limits[0].name, "lubrication");
    let finest = step(7, 1.25);
    assert_eq!(finest.limits[0].name, "lubrication");
    // 1.6 m / (12 · 6π η r*² / 0.01 (r + r))
    let (r, mass) = (1.25e-3_f64, 2500.0 * sphere(1.25e-3));
    let drag = 6.0 * PI * 1.41 * (0.5 * r).powi(2) / (0.02 * r);
    assert_relative("step", finest.time_step, 1.6 * mass / (12.0 * drag), 1e-6);
}
