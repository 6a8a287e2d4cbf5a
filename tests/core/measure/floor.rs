//! What a floor bears: the weight at rest, nothing in flight, and in between what changes the
//! grains' momentum.

use super::*;
use grainfall::measure::{
    Deposit, Measure, floor_force, floor_pressure, mean_speed, sample, weight,
};
use grainfall::scene::Scene;
use grainfall::solver::Solver;

/// A low column of a few polyhedra, released.
fn low_column() -> World {
    let mut scene = Scene::open("small-column").unwrap();
    for (key, value) in [("radius", "8mm"), ("height", "8mm")] {
        scene.set(key, value).unwrap();
    }
    let (run, _) = crate::runs::prepared(&scene, 1, crate::runs::shared_beds());
    run.world().clone()
}

/// The grains' momentum upwards [kg m/s].
fn momentum(world: &World) -> f64 {
    let grains = &world.grains;
    let all = grains.mass.iter().zip(&grains.velocity);
    all.map(|(mass, velocity)| mass * velocity.y).sum()
}

#[test]
fn a_floor_bears_what_presses_on_it_along_its_normal_and_no_tube_counts() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    world.container.walls.push(Wall {
        name: "tube".into(),
        surface: Surface::Tube {
            radius: 0.025,
            rim: 0.0,
        },
        ..world.container.walls[0].clone()
    });
    for i in 0..3 {
        put(
            &mut world,
            DVec3::new(0.002 * f64::from(i), 1e-3, 0.0),
            1e-3,
            0,
        );
        touch(&mut world, i as u32, Partner::Wall(0), DVec3::ZERO);
    }
    touch(&mut world, 0, Partner::Grain(1), DVec3::ZERO);
    touch(&mut world, 2, Partner::Wall(1), DVec3::ZERO);
    for contact in &mut world.contacts {
        contact.force = DVec3::new(0.3, 2.0, -0.1);
    }
    assert_eq!(floor_force(&world), 6.0);
    let mass: f64 = world.grains.mass.iter().sum();
    assert_close(weight(&world), 9.81 * mass, 1e-15);
    world.set_gravity(DVec3::new(0.0, -1.62, 0.0));
    assert_close(weight(&world), 1.62 * mass, 1e-15);
}

#[test]
fn nothing_in_free_fall_bears_on_the_floor_and_only_columns_have_one() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    put(&mut world, DVec3::Y * 0.02, 1e-3, 0);
    Solver::new(1).advance(&mut world, 100).unwrap();
    assert!(world.grains.velocity[0].y < -5e-3);
    assert_eq!(floor_force(&world).to_bits(), 0.0_f64.to_bits());
    for other in [drum(0.05, 0.02, 0.1), on_floor()] {
        assert!(floor_force(&other).is_nan());
        let values = sample(&other);
        for measure in [Measure::FloorForce, Measure::Weight] {
            assert!(!measure.applies_to(&other) && values.value(measure).is_nan());
        }
    }
}

#[test]
fn the_floor_bears_what_changes_the_momentum_and_at_rest_the_weight() {
    let mut world = low_column();
    let mut solver = Solver::new(1);
    let (weight, step) = (weight(&world), world.clock.time_step);
    // Falling: the force less the weight, summed over the steps, is what the momentum gained.
    let (before, mut impulse, mut largest) = (momentum(&world), 0.0, 0.0_f64);
    for _ in 0..2000 {
        solver.advance(&mut world, 1).unwrap();
        let force = floor_force(&world);
        impulse += (force - weight) * step;
        largest = largest.max((force / weight - 1.0).abs());
    }
    let gained = momentum(&world) - before;
    // The force that a step began with or the one it came to: off by one of them at either end.
    assert_close(impulse, gained, 2.0 * largest * weight * step);
    // At rest, but for the last rattling of grains on the springs of their contacts.
    while mean_speed(&world) > 1e-7 && world.time() < 3.0 {
        solver.advance(&mut world, 500).unwrap();
    }
    assert!(mean_speed(&world) <= 1e-7, "{}", mean_speed(&world));
    let force = sample(&world).value(Measure::FloorForce);
    println!("{} at rest after {} s", force / weight - 1.0, world.time());
    assert_close(force / weight, 1.0, 1e-4);
}

#[test]
fn pressure_on_the_floor_is_that_of_the_grains_over_each_ring() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    // Rings are two cube roots of the mean volume wide; one grain over the third ring, two over the
    // first, another on top of these that only weighs on them.
    let size = (4.0 / 3.0 * std::f64::consts::PI).cbrt() * 1e-3;
    for (i, distance) in [0.2, 0.7, 2.5, 0.3].into_iter().enumerate() {
        let height = if i == 3 { 3e-3 } else { 1e-3 };
        let place = DVec3::new(0.0, height, 2.0 * size * distance);
        put(&mut world, place, 1e-3, 0);
    }
    for (grain, force) in [(0, 3.0), (1, 5.0), (2, 4.0)] {
        touch(&mut world, grain, Partner::Wall(0), DVec3::ZERO);
        world.contacts[grain as usize].force = DVec3::Y * force;
    }
    touch(&mut world, 0, Partner::Grain(3), DVec3::ZERO);
    let rings = Deposit::of(&world).unwrap().height_profile();
    let pressure = floor_pressure(&world, &rings);
    let first = std::f64::consts::PI * (2.0 * size).powi(2);
    assert_eq!(pressure.len(), 3);
    assert_close(pressure[0] * first, 8.0, 1e-12);
    assert_eq!(pressure[1], 0.0);
    assert_close(pressure[2] * 5.0 * first, 4.0, 1e-12);
    // All rings together bear what the floor bears.
    let areas = [1.0, 3.0, 5.0].map(|k| k * first);
    let all: f64 = areas.iter().zip(&pressure).map(|(area, p)| area * p).sum();
    assert_close(all, floor_force(&world), 1e-12);
}
