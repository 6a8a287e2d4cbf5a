//! Many grains that nothing holds: what collisions conserve, and how they cool.

use super::*;
use glam::DVec3;
use grainfall::measure::EnergyLedger;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt::Write;

/// A number from −1 to 1 in each direction.
fn random_vector(rng: &mut ChaCha8Rng) -> DVec3 {
    let [x, y, z] = [(); 3].map(|()| rng.random_range(-1.0..=1.0));
    DVec3::new(x, y, z)
}

fn tuple(v: DVec3) -> String {
    format!("({:e}, {:e}, {:e})", v.x, v.y, v.z)
}

/// Grains of two sizes and materials that fly towards the origin and at random, spinning.
fn converging(law: &str, dt: f64) -> World {
    converging_with(law, dt, "friction: 0.3,", "friction: 0.5,")
}

/// The same with other friction.
fn converging_with(law: &str, dt: f64, a: &str, b: &str) -> World {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut grains = String::new();
    for i in 0..125 {
        let site = DVec3::new(f64::from(i % 5), f64::from(i / 5 % 5), f64::from(i / 25)) - 2.0;
        let position = site * 6.5e-3 + 2e-4 * random_vector(&mut rng);
        let velocity = -6.0 * position + 0.1 * random_vector(&mut rng);
        let spin = 20.0 * random_vector(&mut rng);
        let (radius, material) = if i % 3 == 0 { (3.0, "a") } else { (2.0, "b") };
        let _ = writeln!(
            grains,
            r#"(position: {}, velocity: {}, spin: {}, radius_mm: {radius}, material: "{material}"),"#,
            tuple(position),
            tuple(velocity),
            tuple(spin)
        );
    }
    world(
        &format!(
            r#"(
    title: "A collapsing cloud",
    materials: {{
        "a": (restitution: 0.8, {a} rolling_friction: 0.02),
        "b": (youngs_modulus: 2e8, density: 4000, restitution: 0.6, {b} rolling_friction: 0.01),
    }},
    container: Nothing,
    gravity: (0, 0, 0),
    law: {law},
    grains: List([
{grains}    ]),
)"#
        ),
        dt,
    )
}

const HOOKE: &str = "Hooke(normal_stiffness: 4e4, tangential_stiffness: 2e4)";

fn momentum(world: &World) -> DVec3 {
    let grains = &world.grains;
    (0..grains.len())
        .map(|i| grains.mass[i] * grains.velocity[i])
        .sum()
}

fn angular_momentum(world: &World) -> DVec3 {
    let grains = &world.grains;
    (0..grains.len())
        .map(|i| {
            grains.mass[i] * grains.position[i].cross(grains.velocity[i])
                + grains.inertia[i] * grains.spin[i]
        })
        .sum()
}

/// Sums of magnitudes: what rounding is relative to.
fn scales(world: &World) -> (f64, f64) {
    let grains = &world.grains;
    let momentum = (0..grains.len()).map(|i| grains.mass[i] * grains.velocity[i].length());
    let turning = (0..grains.len()).map(|i| {
        grains.mass[i] * grains.position[i].length() * grains.velocity[i].length()
            + grains.inertia[i] * grains.spin[i].length()
    });
    (momentum.sum(), turning.sum())
}

#[test]
fn cloud_keeps_its_momentum_and_angular_momentum() {
    for law in ["HertzMindlin", HOOKE] {
        let mut world = converging(law, 5e-6);
        let (p, l) = (momentum(&world), angular_momentum(&world));
        let (p_scale, l_scale) = scales(&world);
        let energy = world.kinetic_energy();
        run(&mut world, 0.05);
        let kept = world.kinetic_energy() / energy;
        println!("{law}: {kept:.2} of the energy kept");
        assert!(kept < 0.6, "they have collided: {kept}");
        // 10 000 steps, each rounding every velocity to 1e-16 at random.
        assert_below("momentum", (momentum(&world) - p).length() / p_scale, 1e-14);
        assert_below(
            "angular momentum",
            (angular_momentum(&world) - l).length() / l_scale,
            1e-13,
        );
    }
}

#[test]
fn energy_balance_of_a_cloud_closes_with_the_step() {
    for law in ["HertzMindlin", HOOKE] {
        let residual = |dt: f64| {
            let mut world = converging(law, dt);
            run(&mut world, 0.02);
            EnergyLedger::of(&world).relative_residual().abs()
        };
        // Dashpots and rolling are booked with the velocity half a step ago: an error of first order in the step.
        let [coarse, fine] = [4e-6, 5e-7].map(residual);
        println!("{law}: residual {coarse:.1e} at 4e-6 s, {fine:.1e} at 5e-7 s");
        assert!(
            coarse < 5e-3 && fine < 0.25 * coarse,
            "{law}: {coarse} {fine}"
        );
    }
}

/// A gas of smooth spheres of restitution 0.8 in a box of perfectly reflecting walls.
fn gas() -> World {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut grains = String::new();
    for i in 0..512 {
        let site = DVec3::new(f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64)) - 3.5;
        let position = 5e-3 * site + 1e-3 * random_vector(&mut rng);
        let velocity = random_vector(&mut rng);
        let _ = writeln!(
            grains,
            r#"(position: {}, velocity: {}, radius_mm: 1, material: "grain"),"#,
            tuple(position),
            tuple(velocity)
        );
    }
    world(
        &format!(
            r#"(
    title: "A cooling gas",
    materials: {{
        "grain": (restitution: 0.8, friction: 0, rolling_friction: 0),
        "wall": (restitution: 1, friction: 0, rolling_friction: 0),
    }},
    pairs: [(between: ("grain", "wall"), restitution: 1)],
    container: Box(min: (-0.02, -0.02, -0.02), max: (0.02, 0.02, 0.02), material: "wall"),
    gravity: (0, 0, 0),
    law: Hooke(normal_stiffness: 1e4, tangential_stiffness: 0),
    grains: List([
{grains}    ]),
)"#
        ),
        4e-6,
    )
}

#[test]
fn gas_of_constant_restitution_cools_by_haffs_law() {
    let mut world = gas();
    let mut solver = Solver::new(2);
    let count = world.grains.len() as f64;
    // 1/√T: 1/√(mean square speed / 3).
    let slowness = |world: &World| {
        let squares = world.grains.velocity.iter().map(|v| v.length_squared());
        (3.0 * count / squares.sum::<f64>()).sqrt()
    };
    // The first collisions make the distribution of speeds a Maxwellian.
    let mut seen = Vec::new();
    for _ in 0..11 {
        solver.advance(&mut world, 5000).unwrap();
        seen.push(slowness(&world));
    }
    let rises: Vec<f64> = seen.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let whole = seen[10] - seen[0];
    let halves = (seen[5] - seen[0]) / (seen[10] - seen[5]);
    // The restitution that the law without pull makes of 0.8, as in the impacts' tests.
    let ratio = -0.8_f64.ln() / std::f64::consts::PI;
    let e = (-ratio * (std::f64::consts::PI - 2.0 * ratio.atan())).exp();
    // Enskog: dT/dt = −(1 − e²)/3 ω T with ω = 4 n d² χ √(π T), so 1/√T grows by (1 − e²)/6 · 4 n d² χ √π a second.
    let free_volume = (0.04_f64 - 0.002).powi(3);
    let fraction = count * 4.0 / 3.0 * std::f64::consts::PI * 1e-9 / free_volume;
    let chi = (1.0 - 0.5 * fraction) / (1.0 - fraction).powi(3);
    // A pair of centres d apart has to fit between the walls: of its orientations 1 − (3/2) d/L do.
    let fits = 1.0 - 1.5 * 0.002 / 0.038;
    let rate = fits * (1.0 - e * e) / 6.0 * 4.0 * count / free_volume
        * 4e-6
        * chi
        * std::f64::consts::PI.sqrt();
    println!("rises of 1/√T {rises:.3?}, halves {halves:.3}");
    // Some 5000 collisions: 2 % of noise; a contact lasts 1 % of the time between two; e changes the shape of the
    // distribution, 1 %.
    assert_relative("rise of 1/√T", whole / (50_000.0 * 4e-6), rate, 0.06);
    assert_relative("first half over second", halves, 1.0, 0.15);
}
