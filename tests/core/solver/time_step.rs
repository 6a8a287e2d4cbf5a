//! The advised time step: its limits, the reasons, the warning.

use super::*;
use grainfall::measure::EnergyLedger;
use grainfall::scene::{TimeStep, built_in};
use grainfall::solver::{Extremes, StepChoice, advise, step_choices};
use grainfall::world::build_packed;

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

/// The steps [s] with which every scene that comes with the program has run so far.
const BUILT_IN_STEPS: [(&str, f64); 18] = [
    ("dry-r3", 2.027_968_459_384_669_3e-5),
    ("dry-r2", 1.351_978_972_923_112_7e-5),
    ("dry-r1.25", 8.449_868_580_769_456e-6),
    ("wet", 2.027_968_459_384_669_3e-5),
    ("column", 1.101_492_479_323_962e-6),
    ("column-7-3", 1.101_492_479_323_962e-6),
    ("column-1-1", 1.101_492_479_323_962e-6),
    ("small-drum", 2.027_968_459_384_669_3e-5),
    ("two-frictions-drum", 2.027_968_459_384_669_3e-5),
    ("water-drum", 2.027_968_459_384_669_3e-5),
    ("honey-drum", 2.027_968_459_384_669_3e-5),
    ("two-sizes-drum", 1.013_984_229_692_334_6e-5),
    ("two-sizes-wet-drum", 1.013_984_229_692_334_6e-5),
    ("bouncing-grain", 2.027_968_459_384_669_3e-5),
    ("small-column", 2.045_656_927_752_522e-5),
    ("two-grains", 2.027_968_459_384_669_3e-5),
    ("grain-chain", 2.027_968_459_384_669_3e-5),
    ("slide-to-roll", 1.993_233_066_362_639e-5),
];

#[test]
fn every_built_in_scene_and_its_world_have_the_step_they_always_had() {
    let names: Vec<&str> = built_in().iter().map(|scene| scene.name).collect();
    assert_eq!(names, BUILT_IN_STEPS.map(|(name, _)| name));
    for (name, expected) in BUILT_IN_STEPS {
        let scene = Scene::open(name).unwrap();
        let planned = advise(&scene);
        assert_eq!(planned.time_step.to_bits(), expected.to_bits(), "{name}");
        // A world without its Voronoi cells has all that the limits depend on.
        let world = build_packed(&scene, planned.time_step, Vec::new());
        assert_eq!(Extremes::of(&scene).advise(&world), planned, "{name}");
    }
}

/// The drum of the paper with its finest grains and one of its liquids.
fn fine_wet_drum(liquid: &str) -> Scene {
    let mut scene = Scene::open("wet").unwrap();
    scene.set("radius", "1.25mm").unwrap();
    scene.set("liquid", liquid).unwrap();
    scene
}

#[test]
fn liquid_poured_into_a_world_limits_the_step_as_one_that_was_there_from_the_start() {
    let (water, glycerol) = (fine_wet_drum("1"), fine_wet_drum("7"));
    let extremes = Extremes::of(&water);
    let mut world = build(&water, advise(&water).time_step);
    assert_eq!(extremes.advise(&world), advise(&water));
    world.liquid = glycerol.liquid;
    let (found, from_the_start) = (extremes.advise(&world), advise(&glycerol));
    assert_eq!(found.limits, from_the_start.limits);
    assert_eq!(
        found.largest().to_bits(),
        from_the_start.time_step.to_bits()
    );
    // 8.45 µs against 6.57 µs.
    assert_relative("excess", found.excess().unwrap(), 0.2867, 1e-3);
    let warning = found.warning.unwrap();
    for part in ["8.450e-6", "6.567e-6", "lubrication by 29 %", "`time-step`"] {
        assert!(warning.contains(part), "`{part}` in: {warning}");
    }
    world.clock.set_time_step(from_the_start.time_step);
    assert_eq!(extremes.advise(&world), from_the_start);
    // No bridges, no films that could limit anything.
    world.set_liquid_volume(0.0);
    assert_eq!(extremes.advise(&world).limits[0].name, "Rayleigh wave");
}

#[test]
fn restitution_of_a_pair_limits_the_step_of_polyhedra_where_it_is_changed() {
    let scene = Scene::open("small-column").unwrap();
    let extremes = Extremes::of(&scene);
    let planned = advise(&scene);
    let mut world = build_packed(&scene, planned.time_step, Vec::new());
    let find = |world: &World, name| world.materials.find(name).unwrap();
    let (smooth, floor) = (find(&world, "smooth"), find(&world, "floor"));
    world.materials.pair_mut(smooth, floor).restitution = 1.0;
    assert_eq!(extremes.advise(&world), planned, "less damping is no limit");
    world.materials.pair_mut(smooth, floor).restitution = 0.01;
    let damped = extremes.advise(&world);
    assert_eq!(damped.limits[0].name, "dashpots of a polyhedron");
    let share = |e: f64| (e.ln().powi(2) / (std::f64::consts::PI.powi(2) + e.ln().powi(2))).sqrt();
    let own = scene.materials[0].restitution;
    let dashpots = planned
        .limits
        .iter()
        .find(|limit| limit.name == damped.limits[0].name);
    let expected = dashpots.unwrap().time_step * share(own) / share(0.01);
    assert_relative("limit", damped.largest(), expected, 1e-12);
}

/// Found by mutated packings: an automatic step of minutes, which no run can have.
#[test]
fn step_is_one_that_a_run_can_have_however_soft_or_stiff_its_grains() {
    let grain = |material: &str, radius: f64| {
        let text = format!(
            "(title: \"A grain\", materials: {{\"m\": ({material})}}, container: Nothing, grains: \
             List([(position: (0, 0, 0), radius: {radius:?}, material: \"m\")]))"
        );
        let scene = Scene::parse("test", &text).unwrap();
        let advice = advise(&scene);
        build(&scene, advice.time_step).check().unwrap();
        advice
    };
    let soft = grain("youngs_modulus: 1e3, density: 1e6", 10.0);
    assert!(soft.limits[0].time_step > 1.0, "{soft:?}");
    assert_eq!((soft.time_step, soft.largest()), (1.0, 1.0));
    assert_eq!(soft.warning, None);
    let stiff = grain("youngs_modulus: 1e13, density: 0.1", 1e-6);
    assert!(stiff.limits[0].time_step < 1e-12, "{stiff:?}");
    assert_eq!(stiff.time_step, 1e-12);
    assert!(stiff.warning.unwrap().contains("exceeds the limit"));
}

#[test]
fn named_steps_are_parts_of_the_advised_one_and_are_written_as_they_are_read() {
    let mut scene = scene("HertzMindlin", 0.0, "Automatic");
    let standard = advise(&scene).time_step;
    for (name, stated, share) in [
        ("reference", TimeStep::Reference, 0.25),
        ("fast", TimeStep::Fast, 1.5),
        ("automatic-at-start", TimeStep::Automatic, 1.0),
        ("automatic", TimeStep::Following, 1.0),
    ] {
        scene.set("time-step", name).unwrap();
        assert_eq!(scene.time_step, stated);
        let advice = advise(&scene);
        assert_eq!(advice.time_step, share * standard, "{name}");
        assert_eq!(advice.warning.is_some(), share > 1.0, "{name}");
        let again = Scene::parse("again", &scene.to_text().unwrap()).unwrap();
        assert_eq!(again.time_step, stated);
    }
}

fn impacts(scene: &Scene) -> Vec<(StepChoice, f64, [f64; 2])> {
    let choices = step_choices(scene).into_iter();
    let known = choices.map(|choice| {
        let impact = choice.impact.expect("grains that part");
        (choice, impact.restitution, impact.range)
    });
    known.collect()
}

#[test]
fn impacts_give_back_what_they_do_in_closed_form_the_nearer_the_shorter_the_step() {
    // Hertz contacts of the drum give back what their material states. Linear dashpots that never
    // pull give back more than the restitution 0.1 that they are made from: with their damping
    // ratio ζ and s = √(1 − ζ²), e^(−ζ/s (π − arctan(2 ζ s/(1 − 2 ζ²)))).
    let zeta = 0.1_f64.ln().abs() / std::f64::consts::PI.hypot(0.1_f64.ln());
    let s = (1.0 - zeta * zeta).sqrt();
    let angle = std::f64::consts::PI - (2.0 * zeta * s / (1.0 - 2.0 * zeta * zeta)).atan();
    let never_pulling = (-zeta / s * angle).exp();
    assert_relative("restitution of such dashpots", never_pulling, 0.2527, 2e-4);
    for (name, integrator, exact, tolerance) in [
        ("dry-r3", None, 0.95, 3e-4),
        ("column", Some("explicit"), never_pulling, 3e-3),
        ("column", Some("implicit"), never_pulling, 3e-2),
    ] {
        let mut scene = Scene::open(name).unwrap();
        if let Some(integrator) = integrator {
            scene.set("integrator", integrator).unwrap();
        }
        let impacts = impacts(&scene);
        let names: Vec<&str> = impacts.iter().map(|(choice, ..)| choice.name).collect();
        assert_eq!(names, ["reference", "standard", "fast"]);
        let error = (impacts[0].1 - exact).abs();
        assert!(error < tolerance, "{name} {integrator:?}: off by {error}");
        let spreads: Vec<f64> = impacts.iter().map(|(_, _, [a, b])| b - a).collect();
        assert!(
            spreads.is_sorted() && spreads[0] < 0.5 * spreads[1],
            "{spreads:?}"
        );
        assert!(
            impacts
                .iter()
                .all(|(_, mean, [a, b])| a <= mean && mean <= b)
        );
    }
}

#[test]
fn impacts_are_told_with_the_step_that_a_scene_gives_and_not_where_there_are_no_grains() {
    let given = scene("HertzMindlin", 0.0, "Given(1e-5)");
    let choices = step_choices(&given);
    let last = choices.last().unwrap();
    assert_eq!((last.name, last.time_step), ("given", 1e-5));
    let none = Scene {
        grains: grainfall::scene::SceneGrains::List(Vec::new()),
        ..given
    };
    assert!(
        step_choices(&none)
            .iter()
            .all(|choice| choice.impact.is_none())
    );
}

#[test]
fn polyhedra_that_fall_far_onto_a_plane_are_given_steps_that_they_bear() {
    for (integrator, share) in [("Explicit", 0.1), ("Implicit", 0.2)] {
        let text = format!(
            r#"(
                title: "A die falls",
                materials: {{"m": (density: 2650, restitution: 0.1, friction: 0.4)}},
                container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")]),
                grains: List([(position: (0, 0.5, 0), shape: Box(size: (0.02, 0.03, 0.04)), rounding: 0.0005, material: "m")]),
                law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000, features: Full),
                integrator: {integrator},
            )"#
        );
        let scene = Scene::parse("die", &text).unwrap();
        let advice = advise(&scene);
        assert_eq!(advice.limits[0].name, "way in a step");
        let fastest = (2.0 * 9.81 * 0.5_f64).sqrt();
        assert_relative("way", advice.time_step * fastest, share * 0.0005, 1e-9);
        let mut world = build(&scene, advice.time_step);
        run(&mut world, 0.4);
        assert!(
            EnergyLedger::of(&world).dashpot_loss > 0.0,
            "it hits the plane"
        );
    }
}
