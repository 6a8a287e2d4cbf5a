//! Impacts: restitution, contact time, largest overlap, sliding impacts.

use super::*;
use glam::DVec3;
use grainfall::measure::EnergyLedger;
use std::f64::consts::PI;

/// What one impact came to.
pub struct Impact {
    /// The world after the contact has opened.
    pub after: World,
    /// From the first to the last step with a contact [s].
    pub time: f64,
    /// Largest overlap [m].
    pub overlap: f64,
    /// Largest contact force [N].
    pub force: f64,
    /// Whether grains attracted each other at some time.
    pub tension: bool,
    /// `∫ |F_n| dt` [N s].
    pub impulse: f64,
}

/// Takes steps until a contact has formed and opened again.
pub fn collide(mut world: World) -> Impact {
    let mut solver = Solver::new(1);
    let (mut touched, mut time, mut largest, mut force) = (false, 0.0, 0.0, 0.0_f64);
    let (mut tension, mut impulse) = (false, 0.0);
    for _ in 0..1_000_000 {
        solver.advance(&mut world, 1).unwrap();
        if let Some(contact) = world.contacts.first() {
            touched = true;
            time += world.clock.time_step;
            largest = f64::max(largest, overlap(&world, 0));
            let i = contact.grain as usize;
            let normal = match contact.partner {
                Partner::Grain(j) => {
                    (world.grains.position[j as usize] - world.grains.position[i]).normalize()
                }
                Partner::Wall(w) => {
                    let surface = &world.container.walls[w as usize].surface;
                    surface.distance(world.grains.position[i]).1
                }
            };
            let repulsion = -contact.force.dot(normal);
            force = force.max(repulsion);
            // Rounding of the normal is no pull.
            tension |= repulsion < -1e-9 * force;
            impulse += repulsion.abs() * world.clock.time_step;
        } else if touched {
            return Impact {
                after: world,
                time,
                overlap: largest,
                force,
                tension,
                impulse,
            };
        }
    }
    panic!("no impact within a million steps");
}

/// A grain flies at another, or at a wall, both of `material`, without gravity.
pub struct Shot {
    pub material: String,
    pub law: &'static str,
    pub radius: f64,
    pub speed: f64,
    pub at_wall: bool,
}

impl Shot {
    fn text(&self) -> String {
        let Self {
            material,
            law,
            radius,
            speed,
            at_wall,
        } = self;
        // A gap that no whole number of steps crosses.
        let x = radius * (1.0 + 1.234_567e-7);
        let (container, grains) = if *at_wall {
            (
                r#"Planes([(point: (0, 0, 0), normal: (1, 0, 0), material: "m")])"#,
                format!(
                    r#"(position: ({x}, 0, 0), velocity: (-{speed}, 0, 0), radius: {radius}, material: "m")"#
                ),
            )
        } else {
            (
                "Nothing",
                format!(
                    r#"(position: (-{x}, 0, 0), velocity: ({h}, 0, 0), radius: {radius}, material: "m"),
        (position: ({x}, 0, 0), velocity: (-{h}, 0, 0), radius: {radius}, material: "m")"#,
                    h = 0.5 * speed
                ),
            )
        };
        format!(
            r#"(
    title: "An impact",
    materials: {{"m": ({material})}},
    container: {container},
    gravity: (0, 0, 0),
    law: {law},
    grains: List([
        {grains},
    ]),
)"#
        )
    }

    pub fn fired(&self, dt: f64) -> Impact {
        collide(world(&self.text(), dt))
    }

    /// Speed of separation over speed of approach.
    fn restitution(&self, dt: f64) -> f64 {
        let grains = self.fired(dt).after.grains;
        let velocity = |i: usize| grains.velocity[i].x;
        let after = if self.at_wall {
            velocity(0)
        } else {
            velocity(1) - velocity(0)
        };
        after / self.speed
    }
}

fn glass(restitution: f64) -> String {
    format!("youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500, restitution: {restitution}")
}

fn steel(restitution: f64) -> String {
    format!("youngs_modulus: 2e11, poisson_ratio: 0.3, density: 7800, restitution: {restitution}")
}

fn sphere_mass(radius: f64, density: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3) * density
}

/// Largest overlap and duration of an elastic Hertz impact: `m* v²/2 = (2/5) k δ^(5/2)` and
/// `t = 2 (δ/v) ∫ dx/√(1 − x^(5/2)) = 2.943275 δ/v`.
fn hertz_impact(stiffness: f64, mass: f64, speed: f64) -> (f64, f64) {
    let overlap = (1.25 * mass * speed * speed / stiffness).powf(0.4);
    (overlap, 2.943_275 * overlap / speed)
}

/// Hertz' `(4/3) E* √r*` of two equal bodies, or of a body and a wall of its material.
fn hertz_stiffness(modulus: f64, ratio: f64, effective_radius: f64) -> f64 {
    4.0 / 3.0 * modulus / (2.0 * (1.0 - ratio * ratio)) * effective_radius.sqrt()
}

/// Every combination of material, partner, speed and restitution has an error of first order in the
/// step, because the dashpot sees the velocity half a step ago: the error is bounded by `share`
/// steps per contact and halves with the step.
fn check_restitution(
    shots: impl Fn(f64) -> Vec<(Shot, f64)>,
    expected: impl Fn(f64, &Shot) -> f64,
) {
    let mut worst = 0.0_f64;
    for e in [0.2, 0.5, 0.8, 0.95, 1.0] {
        for (shot, contact_time) in shots(e) {
            let expected = expected(e, &shot);
            let error = |steps: f64| (shot.restitution(contact_time / steps) - expected).abs();
            let errors = [100.0, 400.0, 1600.0].map(error);
            println!(
                "e {e} v {} wall {} {}: errors {:.1e} {:.1e} {:.1e}",
                shot.speed, shot.at_wall, shot.law, errors[0], errors[1], errors[2]
            );
            for (error, steps) in errors.into_iter().zip([100.0, 400.0, 1600.0]) {
                worst = worst.max(error * steps);
                assert!(
                    error * steps < 1.5,
                    "error {error} at {steps} steps per contact"
                );
            }
        }
    }
    println!("largest error times steps per contact: {worst:.2}");
}

#[test]
fn hertz_mindlin_impacts_rebound_with_their_restitution_at_any_speed() {
    let shots = |e| {
        let mut shots = Vec::new();
        for (material, modulus, ratio, density) in [
            (glass(e), 63e6, 0.21, 2500.0),
            (steel(e), 2e11, 0.3, 7800.0),
        ] {
            for speed in [0.01, 0.2, 2.0] {
                for at_wall in [false, true] {
                    let radius = 3e-3;
                    let share = if at_wall { 1.0 } else { 0.5 };
                    let stiffness = hertz_stiffness(modulus, ratio, share * radius);
                    let mass = share * sphere_mass(radius, density);
                    let shot = Shot {
                        material: material.clone(),
                        law: "HertzMindlin",
                        radius,
                        speed,
                        at_wall,
                    };
                    shots.push((shot, hertz_impact(stiffness, mass, speed).1));
                }
            }
        }
        shots
    };
    check_restitution(shots, |e, _| e);
}

#[test]
fn hooke_impacts_rebound_as_a_spring_and_dashpot_that_never_pull() {
    let stiffness = 4000.0;
    let mass =
        |shot: &Shot| sphere_mass(shot.radius, 2500.0) * if shot.at_wall { 1.0 } else { 0.5 };
    let shots = |e| {
        let mut shots = Vec::new();
        for speed in [0.01, 1.0] {
            for at_wall in [false, true] {
                let shot = Shot {
                    material: glass(e),
                    law: "Hooke(normal_stiffness: 4000, tangential_stiffness: 2000)",
                    radius: 3e-3,
                    speed,
                    at_wall,
                };
                let time = PI * (mass(&shot) / stiffness).sqrt();
                shots.push((shot, time));
            }
        }
        shots
    };
    // Schwager and Pöschel 2007: the contact ends when the force does, after (π − 2 φ)/ω with tan φ = β/ω, and the
    // speed is then exp(−β t) of what it was. Eq. 3.4 gives β; without the cut the outcome would be e itself.
    let expected = |e: f64, _: &Shot| {
        let ratio = -e.ln() / PI;
        (-ratio * (PI - 2.0 * ratio.atan())).exp()
    };
    check_restitution(shots, expected);
}

#[test]
fn elastic_contact_lasts_as_long_and_goes_as_deep_as_hertz_says() {
    for (speed, at_wall) in [(0.05, false), (0.2, false), (0.2, true), (1.0, true)] {
        let shot = Shot {
            material: glass(1.0),
            law: "HertzMindlin",
            radius: 3e-3,
            speed,
            at_wall,
        };
        let share = if at_wall { 1.0 } else { 0.5 };
        let stiffness = hertz_stiffness(63e6, 0.21, share * 3e-3);
        let mass = share * sphere_mass(3e-3, 2500.0);
        let (overlap, time) = hertz_impact(stiffness, mass, speed);
        let steps = 1000.0;
        let impact = shot.fired(time / steps);
        // Beginning and end are each seen to a step; at the top the overlap is sampled, (π/2 steps)²/2 below its peak at
        // most, and Verlet is of second order.
        assert_relative("contact time", impact.time, time, 2.0 / steps);
        assert_relative("largest overlap", impact.overlap, overlap, 1e-5);
        assert_relative(
            "largest force",
            impact.force,
            stiffness * overlap.powf(1.5),
            2e-5,
        );
    }
}

#[test]
fn paper_grains_at_a_fifth_of_a_metre_per_second_overlap_by_one_percent() {
    for (radius, time) in [(1.25e-3, 1.718e-4), (2e-3, 2.748e-4), (3e-3, 4.122e-4)] {
        let shot = Shot {
            material: glass(1.0),
            law: "HertzMindlin",
            radius,
            speed: 0.2,
            at_wall: false,
        };
        let impact = shot.fired(time / 5000.0);
        // Half of the last printed digit, and a step at either end.
        assert_relative("largest overlap", impact.overlap / radius, 0.0093, 0.006);
        assert_relative("contact time", impact.time, time, 7e-4);
    }
}

#[test]
fn dashpot_pulls_at_the_end_of_a_hertz_contact_but_not_of_a_hooke_contact() {
    for (law, pulls) in [
        ("HertzMindlin", true),
        (
            "Hooke(normal_stiffness: 4000, tangential_stiffness: 2000)",
            false,
        ),
    ] {
        let shot = Shot {
            material: glass(0.5),
            law,
            radius: 3e-3,
            speed: 0.2,
            at_wall: false,
        };
        assert_eq!(shot.fired(1e-6).tension, pulls, "{law}");
    }
}

/// A grain that hits the floor at an angle, `vn` down and `vt` along, sliding throughout.
fn oblique(e: f64, friction: f64, law: &str, velocity: (f64, f64), dt: f64) -> Impact {
    collide(oblique_world(e, friction, law, velocity, dt))
}

fn oblique_world(e: f64, friction: f64, law: &str, (vn, vt): (f64, f64), dt: f64) -> World {
    world(
        &format!(
            r#"(
    title: "An oblique impact",
    materials: {{"m": (youngs_modulus: 70e9, poisson_ratio: 0.3, density: 2700, restitution: {e}, friction: {friction}, rolling_friction: 0)}},
    container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")]),
    gravity: (0, 0, 0),
    law: {law},
    grains: List([(position: (0, 0.003000001, 0), velocity: ({vt}, -{vn}, 0), radius_mm: 3, material: "m")]),
)"#
        ),
        dt,
    )
}

#[test]
fn grazing_impact_slides_and_leaves_with_the_spin_that_friction_gave_it() {
    let (vn, vt, friction, radius) = (0.1, 1.0, 0.1, 3e-3);
    let dt = 1e-8;
    for law in [
        "HertzMindlin",
        "Hooke(normal_stiffness: 1e7, tangential_stiffness: 5e6)",
    ] {
        let impact = oblique(1.0, friction, law, (vn, vt), dt);
        let grains = &impact.after.grains;
        let expected = 1.0 - 2.0 * friction * vn / vt;
        // Sliding begins once the spring has stretched: μ k_n δ/(k_t v_t) after contact, a share 1e-2 of the impulse's
        // own square; the arm is short by half the overlap.
        let arm = impact.overlap / (2.0 * radius);
        assert_relative(
            "tangential speed",
            grains.velocity[0].x / vt,
            expected,
            1e-5,
        );
        let spin = -2.5 * friction * 2.0 * vn / radius;
        assert_relative("spin", grains.spin[0].z, spin, arm + 5e-4);
    }
}

#[test]
fn damped_grazing_impact_obeys_coulomb() {
    let (vn, vt, friction) = (0.1, 1.0, 0.1);
    let impact = oblique(0.9, friction, "HertzMindlin", (vn, vt), 1e-8);
    let mass = sphere_mass(3e-3, 2700.0);
    let change = vt - impact.after.grains.velocity[0].x;
    // Friction acts against tension too: the bound is μ |F_n|, so the change is that of ∫ |F_n|, little above (1 + e) v_n.
    // At first touch the normal dashpot's share of the bound, as δ^(1/4), is ahead of the spring, as δ^(1/2): until it is
    // reached the tangential dashpot acts untruncated, as in the paper's program.
    assert_relative(
        "tangential impulse",
        mass * change,
        friction * impact.impulse,
        3e-3,
    );
    assert_relative("of the closed form", change, friction * 1.9 * vn, 0.02);
}

/// The balance's residual after an oblique Hertz–Mindlin impact, relative to the energy it began
/// with.
fn residual(dt: f64) -> f64 {
    let mut world = oblique_world(0.8, 0.3, "HertzMindlin", (0.5, 0.4), dt);
    let initial = world.kinetic_energy();
    let mut solver = Solver::new(1);
    let mut touched = false;
    while !(touched && world.contacts.is_empty()) {
        solver.advance(&mut world, 1).unwrap();
        touched |= !world.contacts.is_empty();
    }
    (EnergyLedger::of(&world).residual() / initial).abs()
}

#[test]
fn energy_balance_of_an_oblique_impact_closes_with_the_step() {
    let [coarse, fine] = [4e-7, 4e-8].map(residual);
    println!("residual {coarse:.2e} at 4e-7 s, {fine:.2e} at 4e-8 s");
    assert_below("residual at 4e-7 s", coarse, 2e-3);
    assert_below("residual at 4e-8 s", fine, 0.2 * coarse);
}

#[test]
fn heavier_grain_keeps_going() {
    let text = r#"(
    title: "Unequal grains",
    materials: {"a": (density: 2500, restitution: 1), "b": (density: 8000, youngs_modulus: 1e8, poisson_ratio: 0.3, restitution: 0.8)},
    pairs: [(between: ("a", "b"), restitution: 0.7)],
    container: Nothing,
    gravity: (0, 0, 0),
    grains: List([
        (position: (0, 0, 0), velocity: (0.3, 0, 0), radius_mm: 3, material: "b"),
        (position: (0.0050001, 0, 0), radius_mm: 2, material: "a"),
    ]),
)"#;
    let grains = collide(world(text, 1e-7)).after.grains;
    let (m1, m2) = (sphere_mass(3e-3, 8000.0), sphere_mass(2e-3, 2500.0));
    let centre = m1 * 0.3 / (m1 + m2);
    // About 3000 steps per contact, see `check_restitution`.
    let expected = [
        centre + 0.7 * m2 / (m1 + m2) * -0.3,
        centre + 0.7 * m1 / (m1 + m2) * 0.3,
    ];
    for (found, expected) in grains.velocity.iter().zip(expected) {
        assert_relative("speed", found.x, expected, 5e-4);
        assert_eq!((found.y, found.z), (0.0, 0.0));
    }
    assert_eq!(*grains.spin, [DVec3::ZERO; 2]);
}

/// Springs whose tangential one swings as fast as the normal one.
const SPRING_DASHPOT: &str =
    "SpringDashpot(normal_stiffness: 1e7, tangential_stiffness: 2857142.857142857)";

#[test]
fn spring_dashpot_impacts_rebound_with_their_restitution_after_half_a_damped_period() {
    let mass =
        |shot: &Shot| sphere_mass(shot.radius, 2500.0) * if shot.at_wall { 1.0 } else { 0.5 };
    let period = |shot: &Shot, e: f64| {
        let ratio = -e.ln() / (PI * PI + e.ln() * e.ln()).sqrt();
        PI * (mass(shot) / 1e7).sqrt() / (1.0 - ratio * ratio).sqrt()
    };
    let shots = |e| {
        [(0.01, false), (0.01, true), (1.0, false), (1.0, true)]
            .map(|(speed, at_wall)| {
                let shot = Shot {
                    material: glass(e),
                    law: SPRING_DASHPOT,
                    radius: 3e-3,
                    speed,
                    at_wall,
                };
                let time = period(&shot, e);
                (shot, time)
            })
            .into()
    };
    check_restitution(shots, |e, _| e);
    for e in [0.2, 0.8] {
        for (shot, time) in shots(e) {
            let impact = shot.fired(time / 1000.0);
            // The first and the last step of a contact are whole ones.
            assert_relative("contact time", impact.time, time, 2e-3);
            assert!(impact.tension, "the dashpot pulls at the end");
        }
    }
}

#[test]
fn surfaces_that_stick_part_with_the_restitution_times_the_velocity_they_met_with() {
    for e in [0.3, 0.8, 1.0] {
        let (vn, vt) = (0.1, 0.1);
        let impact = oblique(e, 1.0, SPRING_DASHPOT, (vn, vt), 1e-8);
        let grains = &impact.after.grains;
        let surface = grains.velocity[0].x + grains.spin[0].z * grains.radius[0];
        // A dashpot that sees the velocity half a step ago, in a contact of some 1700 steps; the arm is short by half of an
        // overlap of 2e-4 radii.
        assert_relative("surface", surface, -e * vt, 2e-3);
        assert_relative("normal", grains.velocity[0].y, e * vn, 2e-3);
    }
}
