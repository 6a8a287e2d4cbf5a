//! Numbers of single grains, of worlds built by hand.

use super::*;
use grainfall::measure::{GrainQuantity, granular_temperatures};

fn values(quantity: GrainQuantity, world: &World) -> Vec<f64> {
    let mut values = Vec::new();
    quantity.append(world, &mut values);
    values
}

/// A grain of 1 mm pressed between the floor and one above it with 3 N.
fn squeezed() -> World {
    let mut world = on_floor();
    push(&mut world, DVec3::new(0.0, 0.001, 0.0), 0.001);
    push(&mut world, DVec3::new(0.0, 0.003, 0.0), 0.001);
    touch(&mut world, 0, Partner::Wall(0), DVec3::ZERO);
    touch(&mut world, 0, Partner::Grain(1), DVec3::ZERO);
    world.contacts[0].force = DVec3::Y * 3.0;
    world.contacts[1].force = DVec3::Y * -3.0;
    world
}

#[test]
fn pressure_is_a_third_of_the_virial_over_the_volume() {
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    let [lower, upper] = values(GrainQuantity::Pressure, &squeezed())[..] else {
        panic!("two grains");
    };
    // The lower one: 3 N at an arm of 1 mm on both sides; the upper one: its half of the pair, 3 N at 1 mm.
    assert_close(lower, 2.0 * 3.0 * 0.001 / (3.0 * volume), 1e-6);
    assert_close(upper, 3.0 * 0.001 / (3.0 * volume), 1e-6);
}

#[test]
fn pull_is_negative_pressure() {
    let mut world = squeezed();
    for contact in &mut world.contacts {
        contact.force = -contact.force;
    }
    assert!(
        values(GrainQuantity::Pressure, &world)
            .iter()
            .all(|p| *p < 0.0)
    );
}

#[test]
fn largest_force_is_that_of_all_contacts_on_both_grains() {
    let mut world = squeezed();
    world.contacts[0].force = DVec3::Y * 4.0;
    assert_eq!(values(GrainQuantity::LargestForce, &world), [4.0, 3.0]);
}

#[test]
fn kinetic_energy_of_grains_adds_up_to_that_of_the_world() {
    let mut world = squeezed();
    world.grains.velocity[0] = DVec3::new(1.0, 2.0, 0.0);
    world.grains.spin[1] = DVec3::Z * 30.0;
    let of_grains = values(GrainQuantity::KineticEnergy, &world);
    let [mass, inertia] = [world.grains.mass[0], world.grains.inertia[1]];
    // Rounding.
    assert_close(of_grains[0], 0.5 * mass * 5.0, 1e-20);
    assert_close(of_grains[1], 0.5 * inertia * 900.0, 1e-20);
}

#[test]
fn liquid_is_counted_in_litres_and_only_where_there_is_any() {
    let mut world = squeezed();
    assert!(!GrainQuantity::Liquid.applies_to(&world));
    assert!(GrainQuantity::Pressure.applies_to(&world));
    world.grains.film[1] = 2e-9;
    assert_close(values(GrainQuantity::Liquid, &world)[1], 2e-6, 1e-20);
}

#[test]
fn a_grain_s_part_of_the_temperature_adds_up_to_that_of_the_bed() {
    let mut world = on_floor();
    for i in 0..30 {
        let place = DVec3::new(f64::from(i % 6), f64::from(i / 6), 0.0) * 0.002;
        push(&mut world, place, 0.001);
        let wobble = f64::from(i * i % 7);
        *world.grains.velocity.last_mut().unwrap() = DVec3::new(wobble, 0.1 * wobble, -0.2);
    }
    let parts = values(GrainQuantity::Fluctuation, &world);
    let mean = parts.iter().sum::<f64>() / 30.0;
    let whole = granular_temperatures(&world).corotating;
    // A part in a million million: another order of the sums.
    assert!((mean / whole - 1.0).abs() < 1e-12, "{mean} {whole}");
    assert!(whole > 0.1, "{whole}");
}

#[test]
fn overlap_is_in_radii_of_the_grain_and_velocities_keep_their_sign() {
    let mut world = on_floor();
    push(&mut world, DVec3::ZERO, 0.001);
    push(&mut world, DVec3::new(0.0029, 0.0, 0.0), 0.002);
    touch(&mut world, 0, Partner::Grain(1), DVec3::ZERO);
    world.grains.velocity[1] = DVec3::new(-1.0, 2.0, -3.0);
    let overlaps = values(GrainQuantity::LargestOverlap, &world);
    assert!((overlaps[0] - 0.1).abs() < 1e-12 && (overlaps[1] - 0.05).abs() < 1e-12);
    let of_second = |quantity| values(quantity, &world)[1];
    assert_eq!(of_second(GrainQuantity::VelocityX), -1.0);
    assert_eq!(of_second(GrainQuantity::VelocityY), 2.0);
    assert_eq!(of_second(GrainQuantity::VelocityZ), -3.0);
    assert_eq!(of_second(GrainQuantity::Radius), 0.002);
    assert_eq!(of_second(GrainQuantity::Number), 1.0);
}

#[test]
fn positions_are_counted_from_the_axis_that_the_container_has() {
    let mut world = drum(0.0605, 0.022, 0.0);
    push(&mut world, DVec3::new(0.03, -0.04, 0.005), 0.001);
    assert_eq!(values(GrainQuantity::PositionX, &world), [0.03]);
    assert_eq!(values(GrainQuantity::PositionY, &world), [-0.04]);
    let [distance] = values(GrainQuantity::AxisDistance, &world)[..] else {
        panic!("one grain");
    };
    assert_close(distance, 0.05, 1e-15);
    world.container.shape = Shape::Column {
        radius: 0.1,
        height: 0.1,
    };
    let [distance] = values(GrainQuantity::AxisDistance, &world)[..] else {
        panic!("one grain");
    };
    assert_close(distance, 0.03_f64.hypot(0.005), 1e-15);
    assert!(!GrainQuantity::AxisDistance.applies_to(&on_floor()));
}
