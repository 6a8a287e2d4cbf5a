//! The advised time step: its limits, the reasons, the warning.

use super::*;
use grainfall::scene::TimeStep;
use grainfall::solver::advise;

#[test]
fn paper_drums_step_at_a_fifth_of_their_rayleigh_time() {
    for (name, rayleigh) in [
        ("dry-r1.25", 4.2e-5),
        ("dry-r2", 6.8e-5),
        ("dry-r3", 1.01e-4),
    ] {
        let advice = advise(&Scene::open(name).unwrap());
        // Half of the last printed digit.
        assert_relative("Rayleigh time", advice.time_step / 0.2, rayleigh, 0.013);
        let binding = &advice.limits[0];
        assert_eq!(binding.name, "Rayleigh wave");
        assert_eq!(binding.time_step, advice.time_step);
        assert!(binding.reason.contains("glass"), "{}", binding.reason);
        assert_eq!(advice.warning, None);
    }
}

/// One grain with a speed and a step.
fn scene(law: &str, speed: f64, step: &str) -> Scene {
    Scene::parse(
        "test",
        &format!(
            r#"(
    title: "A grain",
    materials: {{"glass": ()}},
    container: Nothing,
    law: {law},
    time_step: {step},
    grains: List([(position: (0, 0, 0), velocity: ({speed}, 0, 0), radius_mm: 3, material: "glass")]),
)"#
        ),
    )
    .unwrap()
}

#[test]
fn fast_impact_is_given_steps_enough() {
    let advice = advise(&scene("HertzMindlin", 20.0, "Automatic"));
    let binding = &advice.limits[0];
    assert_eq!(binding.name, "Hertz contact");
    // An elastic impact of two such grains at 40 m/s: 4.122e-4 s at 0.2 m/s, shorter as v^(−1/5); fifteen steps or more.
    let contact = 4.122e-4 * (0.2_f64 / 40.0).powf(0.2);
    assert_relative("steps per contact", contact / advice.time_step, 15.0, 0.03);
    let names: Vec<&str> = advice.limits.iter().map(|limit| limit.name).collect();
    assert_eq!(names, ["Hertz contact", "Rayleigh wave"]);
}

#[test]
fn linear_contact_is_given_twenty_steps() {
    let law = "Hooke(normal_stiffness: 4000, tangential_stiffness: 2000)";
    let advice = advise(&scene(law, 0.0, "Automatic"));
    let mass = 4.0 / 3.0 * std::f64::consts::PI * 3e-3_f64.powi(3) * 2500.0;
    let contact = std::f64::consts::PI * (0.5 * mass / 4000.0).sqrt();
    assert_relative("steps per contact", contact / advice.time_step, 20.0, 1e-12);
    assert_eq!(advice.limits[0].name, "linear contact");
}

#[test]
fn too_long_a_step_is_taken_with_a_warning() {
    let advice = advise(&scene("HertzMindlin", 0.0, "Given(1e-4)"));
    assert_eq!(advice.time_step, 1e-4);
    let warning = advice.warning.unwrap();
    for part in ["1.000e-4 s", "Rayleigh wave", "2.0", "Automatic"] {
        assert!(warning.contains(part), "`{part}` in: {warning}");
    }
    let short = advise(&scene("HertzMindlin", 0.0, "Given(1e-6)"));
    assert_eq!((short.time_step, short.warning), (1e-6, None));
}

#[test]
fn smallest_and_stiffest_grain_limits_the_step() {
    let mut scene = scene("HertzMindlin", 0.0, "Automatic");
    let alone = advise(&scene).time_step;
    let grainfall::scene::SceneGrains::List(grains) = &mut scene.grains else {
        unreachable!("a list")
    };
    let mut small = grains[0].clone();
    small.radius *= 0.25;
    small.position.x = 1.0;
    grains.push(small);
    // Both limits grow with the radius, a Hertz contact as r, a Rayleigh wave as r.
    assert_relative("step", advise(&scene).time_step, 0.25 * alone, 1e-12);
    scene.time_step = TimeStep::Given(alone);
    assert!(advise(&scene).warning.is_some());
}
