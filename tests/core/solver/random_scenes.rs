//! Hundreds of random scenes: whatever is asked for is computed or refused, never a panic.

use super::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt::Write;

/// Digits at random over `decades` decades from `low`.
fn over_decades(rng: &mut ChaCha8Rng, low: f64, decades: f64) -> f64 {
    low * 10_f64.powf(rng.random_range(0.0..decades))
}

fn material(rng: &mut ChaCha8Rng) -> String {
    format!(
        "youngs_modulus: {:e}, poisson_ratio: {}, density: {:e}, restitution: {}, friction: {}, rolling_friction: {}",
        over_decades(rng, 1e6, 5.0),
        rng.random_range(0.0..0.45),
        over_decades(rng, 100.0, 2.0),
        rng.random_range(0.01..=1.0),
        rng.random_range(0.0..2.0),
        rng.random_range(0.0..0.5),
    )
}

fn container(rng: &mut ChaCha8Rng) -> String {
    match rng.random_range(0..4) {
        0 => format!(
            r#"Drum(radius_mm: {}, width_mm: {}, speed: {}, material: "b")"#,
            rng.random_range(8.0..30.0),
            rng.random_range(8.0..30.0),
            rng.random_range(-50.0..50.0)
        ),
        1 => format!(
            r#"Box(min: (-0.02, -0.02, -0.02), max: ({}, 0.02, {}), material: "a")"#,
            rng.random_range(0.0..0.1),
            rng.random_range(0.0..0.1)
        ),
        2 => "Nothing".to_owned(),
        _ => format!(
            r#"Planes([
        (point: (0, -0.03, 0), normal: ({}, 1, {}), velocity: (0, 0, 0), material: "b"),
        (point: (-0.05, 0, 0), normal: (1, 0, 0), material: "a"),
    ])"#,
            rng.random_range(-0.3..0.3),
            rng.random_range(-0.3..0.3)
        ),
    }
}

fn listed(rng: &mut ChaCha8Rng) -> String {
    let mut list = "List([\n".to_owned();
    let place = |rng: &mut ChaCha8Rng| rng.random_range(-0.015..0.015);
    for _ in 0..rng.random_range(1..8) {
        let _ = writeln!(
            list,
            r#"(position: ({}, {}, {}), velocity: ({}, {}, 0), spin: (0, {}, 0), radius_mm: {}, material: "a"),"#,
            place(rng),
            place(rng),
            place(rng),
            100.0 * place(rng),
            100.0 * place(rng),
            1e4 * place(rng),
            over_decades(rng, 0.3, 1.0)
        );
    }
    list + "])"
}

fn filled(rng: &mut ChaCha8Rng) -> String {
    format!(
        r#"Fill(count: {}, species: [
        (name: "x", radius_mm: {}, material: "a", share: 0.5),
        (name: "y", radius_mm: {}, material: "b", share: 0.5),
    ])"#,
        rng.random_range(1..60),
        over_decades(rng, 0.3, 0.8),
        over_decades(rng, 0.3, 0.8)
    )
}

fn random_scene(rng: &mut ChaCha8Rng) -> String {
    let law = if rng.random_bool(0.5) {
        "HertzMindlin".to_owned()
    } else {
        format!(
            "Hooke(normal_stiffness: {:e}, tangential_stiffness: {:e})",
            over_decades(rng, 10.0, 5.0),
            over_decades(rng, 10.0, 5.0)
        )
    };
    let grains = if rng.random_bool(0.5) {
        listed(rng)
    } else {
        filled(rng)
    };
    let gravity = rng.random_range(-20.0..20.0);
    format!(
        r#"(
    title: "A random scene",
    materials: {{"a": ({}), "b": ({})}},
    container: {},
    gravity: ({gravity}, -9.81, 0),
    law: {law},
    grains: {grains},
)"#,
        material(rng),
        material(rng),
        container(rng),
    )
}

#[test]
fn random_scenes_run_or_are_refused_but_never_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(2024);
    let mut solver = Solver::new(2);
    let (mut ran, mut stopped, mut refused) = (0, 0, 0);
    for _ in 0..800 {
        let text = random_scene(&mut rng);
        let Ok(scene) = Scene::parse("random", &text) else {
            refused += 1;
            continue;
        };
        // Some steps are far too long.
        let factor = if rng.random_bool(0.2) { 30.0 } else { 1.0 };
        let advice = grainfall::solver::advise(&scene).time_step;
        let mut world = build(&scene, factor * advice);
        for _ in 0..3 {
            let before = world.hash();
            match solver.advance(&mut world, 100) {
                Ok(()) => assert!(world.grains.position.iter().all(|x| x.is_finite())),
                Err(fault) => {
                    assert_eq!(world.hash(), before, "{fault}\n{text}");
                    assert!(factor > 1.0, "the advised step is stable: {fault}\n{text}");
                    stopped += 1;
                    break;
                }
            }
        }
        ran += 1;
    }
    println!("{ran} ran, {stopped} of them stopped by a fault, {refused} refused");
    assert!(ran >= 300, "only {ran} of the scenes are valid");
}
