//! Whole samples: what they hold, that they are the same each time, and that no state makes them
//! panic or hang.

use super::*;
use grainfall::measure::{Measure, Sample, sample};

fn bits(sample: &Sample) -> Vec<u64> {
    sample.values.iter().map(|value| value.to_bits()).collect()
}

fn turning_bed() -> World {
    let mut world = drum(0.0605, 0.022, 0.05);
    let mut noise = Noise::new(5);
    for x in lattice_in_drum(0.058, 0.022, 0.004, 0.4, -0.02) {
        push(&mut world, x + 0.0003 * noise.vector(), 0.002);
        let n = world.grains.len() - 1;
        world.grains.velocity[n] = 0.01 * noise.vector();
    }
    for i in 0..100 {
        touch(&mut world, i, Partner::Grain(i + 1), DVec3::Y * 1e-6);
    }
    world
}

#[test]
fn bed_in_a_drum_has_every_measure() {
    let world = turning_bed();
    let sample = sample(&world);
    for measure in Measure::of(&world) {
        assert!(sample.value(measure).is_finite(), "{measure:?}");
    }
    assert_eq!((sample.step, sample.time), (0, 0.0));
}

#[test]
fn same_world_gives_the_same_bits() {
    let world = turning_bed();
    assert_eq!(bits(&sample(&world)), bits(&sample(&world.clone())));
}

#[test]
fn world_without_grains_has_no_averages_and_no_energy() {
    for world in [drum(0.06, 0.02, 0.1), open_box(DVec3::ONE), on_floor()] {
        let sample = sample(&world);
        assert!(sample.value(Measure::SurfaceAngle).is_nan());
        assert!(sample.value(Measure::GranularTemperature).is_nan());
        assert!(sample.value(Measure::PackingFraction).is_nan());
        assert!(sample.value(Measure::CoordinationNumber).is_nan());
        assert!(sample.value(Measure::MeanSpeed).is_nan());
        assert_eq!(sample.value(Measure::KineticEnergy), 0.0);
        assert_eq!(sample.value(Measure::EnergyResidual), 0.0);
    }
}

#[test]
fn mean_speed_and_kinetic_energy_of_two_grains() {
    let mut world = on_floor();
    push(&mut world, DVec3::ZERO, 0.001);
    push(&mut world, DVec3::X, 0.001);
    world.grains.velocity[0] = DVec3::new(3.0, 4.0, 0.0);
    world.grains.spin[1] = DVec3::Z * 100.0;
    let sample = sample(&world);
    let mass = world.grains.mass[0];
    assert_eq!(sample.value(Measure::MeanSpeed), 2.5);
    let expected = mass * (12.5 + 0.2 * 0.001 * 0.001 * 1e4);
    assert_close(sample.value(Measure::KineticEnergy) / expected, 1.0, 1e-14);
}

#[test]
fn absurd_positions_neither_panic_nor_hang() {
    for absurd in [f64::NAN, f64::INFINITY, 1e300, -1e30, 1e9] {
        for shape in [turning_bed(), on_floor()] {
            let mut world = shape;
            push(&mut world, DVec3::new(absurd, 0.0, -absurd), 0.002);
            push(&mut world, DVec3::ZERO, 0.002);
            assert_eq!(sample(&world).values.len(), Measure::COUNT);
        }
    }
}
