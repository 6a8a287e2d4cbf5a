//! Collapses whose energy and front over time are known, and what samples of a column hold.

use super::*;
use grainfall::measure::{
    Collapse, FlowHistory, Measure, MeasuredValue, RunQuantity, Sample, Series, results, sample,
};

/// Samples every 0.02 s of an energy per grain (two thirds of it translation) and a front, up to
/// `end` [s].
fn course(end: f64, energy: impl Fn(f64) -> f64, front: impl Fn(f64) -> f64) -> Series {
    let mut series = Series::default();
    for step in 0..=(end / 0.02).round() as u64 {
        let time = step as f64 * 0.02;
        let mut values = [f64::NAN; Measure::COUNT];
        values[Measure::TranslationalEnergy as usize] = energy(time) * 2.0 / 3.0;
        values[Measure::RotationalEnergy as usize] = energy(time) / 3.0;
        values[Measure::FrontRadius as usize] = front(time);
        values[Measure::DepositHeight as usize] = 0.03;
        series.push(Sample { step, time, values });
    }
    series
}

/// Rises as t², then falls by a factor of ten each 0.095 s; its peak of 6 µJ is at 0.18 s.
fn energy(time: f64) -> f64 {
    if time < 0.181 {
        6e-6 * (time / 0.18).powi(2)
    } else {
        6e-6 * 10_f64.powf(-(time - 0.18) / 0.095)
    }
}

/// Steady until 0.3 s, then at rest.
fn front(time: f64) -> f64 {
    0.025 + 0.1 * time.min(0.3)
}

#[test]
fn peak_and_rest_are_found_in_a_known_course() {
    let collapse = Collapse::of(&course(1.0, energy, front)).unwrap();
    assert_close(collapse.peak_time, 0.18, 1e-15);
    assert_close(collapse.peak_energy, 6e-6, 1e-20);
    // A hundredth of the peak at 0.37 s; the next sample is the first below it.
    assert_close(collapse.rest_time.unwrap(), 0.38, 1e-15);
    assert_close(collapse.energy_rest_time.unwrap(), 0.38, 1e-15);
    // 0.99 · 0.055 = 0.05445 at 0.2945 s.
    assert_close(collapse.front_rest_time.unwrap(), 0.3, 1e-15);
    assert_close(collapse.front, 0.055, 1e-15);
    assert_eq!(collapse.height, 0.03);
}

#[test]
fn front_that_still_creeps_delays_rest() {
    let creeping = |time: f64| 0.025 + 0.05 * (time / 0.7).min(1.0);
    let collapse = Collapse::of(&course(1.0, energy, creeping)).unwrap();
    // 0.99 · 0.075 = 0.07425 at 0.6895 s.
    assert_close(collapse.rest_time.unwrap(), 0.7, 1e-15);
    assert_close(collapse.front_rest_time.unwrap(), 0.7, 1e-15);
    assert_close(collapse.energy_rest_time.unwrap(), 0.38, 1e-15);
}

#[test]
fn what_still_moves_is_not_at_rest_and_the_slow_start_is_no_rest() {
    let moving = Collapse::of(&course(0.16, energy, front)).unwrap();
    assert_eq!(moving.rest_time, None);
    assert_close(moving.peak_time, 0.16, 1e-15);
    let falling = Collapse::of(&course(0.36, energy, front)).unwrap();
    assert_eq!(falling.rest_time, None);
}

#[test]
fn drums_have_no_collapse() {
    assert_eq!(Collapse::of(&Series::default()), None);
    assert_eq!(Collapse::of(&course(1.0, energy, |_| f64::NAN)), None);
}

/// Two grains of the first species and one of the second in a row on the floor, the first two
/// moving.
fn three_grains() -> World {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    for (i, kind) in [0, 0, 1].into_iter().enumerate() {
        put(
            &mut world,
            DVec3::new(0.002 * i as f64, 1e-3, 0.0),
            1e-3,
            kind,
        );
    }
    touch(&mut world, 0, Partner::Grain(1), DVec3::ZERO);
    touch(&mut world, 0, Partner::Wall(0), DVec3::ZERO);
    touch(&mut world, 1, Partner::Grain(2), DVec3::ZERO);
    world.grains.velocity[0].x = 0.3;
    world.grains.spin[1].z = 50.0;
    world
}

#[test]
fn samples_of_a_column_hold_what_concerns_it() {
    let world = three_grains();
    let sample = sample(&world);
    for measure in Measure::ALL {
        let name = measure.quantity().key;
        let is_common = matches!(
            measure,
            Measure::Bridges | Measure::Ruptures | Measure::ViscousLoss | Measure::CapillaryLoss
        );
        if measure.applies_to(&world) || is_common {
            assert!(sample.value(measure).is_finite(), "{name}");
        } else {
            assert!(sample.value(measure).is_nan(), "{name}");
        }
    }
    let mass = world.grains.mass[0];
    let close = |measure: Measure, expected: f64| {
        assert_close(sample.value(measure) / expected, 1.0, 1e-12);
    };
    close(Measure::TranslationalEnergy, 0.5 * mass * 0.09 / 3.0);
    close(Measure::RotationalEnergy, 0.2 * mass * 1e-6 * 2500.0 / 3.0);
    close(Measure::FirstPairs, 0.5);
    close(Measure::MixedPairs, 0.5);
    assert_eq!(sample.value(Measure::SecondPairs), 0.0);
    close(Measure::DepositHeight, 2e-3);
}

#[test]
fn drums_hold_what_they_held_and_nothing_of_columns() {
    let mut world = drum(0.05, 0.02, 0.1);
    push(&mut world, DVec3::new(0.0, -0.049, 0.0), 1e-3);
    let held = Measure::of(&world);
    assert_eq!(held[..], Measure::ALL[..22]);
    assert_eq!(held.last(), Some(&Measure::CapillaryLoss));
    let sample = sample(&world);
    for measure in Measure::ALL.into_iter().filter(|m| !m.applies_to(&world)) {
        assert!(sample.value(measure).is_nan(), "{}", measure.quantity().key);
    }
}

#[test]
fn results_of_a_column_are_those_of_its_collapse() {
    let world = three_grains();
    let series = course(1.0, energy, front);
    let summary = results(&series, &FlowHistory::default(), &world, 0.4, 1.0);
    let value = |quantity: RunQuantity| {
        let value = summary.value(quantity);
        value.unwrap_or_else(|| panic!("{quantity:?}"))
    };
    assert_eq!((summary.from, summary.samples), (0.0, 51));
    assert_close(value(RunQuantity::PeakTime), 0.18, 1e-15);
    assert_close(value(RunQuantity::RestTime), 0.38, 1e-15);
    assert_close(value(RunQuantity::EnergyRestTime), 0.38, 1e-15);
    assert_close(value(RunQuantity::FrontRestTime), 0.3, 1e-15);
    let unit = (0.025_f64 / 9.81).sqrt();
    assert_close(
        value(RunQuantity::DimensionlessPeakTime) * unit,
        0.18,
        1e-15,
    );
    assert_close(
        value(RunQuantity::DimensionlessRestTime) * unit,
        0.38,
        1e-15,
    );
    assert_close(value(RunQuantity::RunOut), 0.03 / 0.025, 1e-14);
    assert_close(value(RunQuantity::RelativeHeight), 1.2, 1e-14);
    assert_close(value(RunQuantity::AspectRatio), 2.0, 1e-15);
    // 0.055² · 0.03 / 3 over 0.025² · 0.05
    assert_close(value(RunQuantity::RelativeConeVolume), 0.968, 1e-12);
    // Two of three grains: 4/9 · 0.1 + 1/9 · 0.4 + 4/9 · 0.16
    assert_close(value(RunQuantity::ParticleFriction), 1.44 / 9.0, 1e-15);
    assert_eq!(summary.value(Measure::SurfaceAngle), None);
    assert_eq!(summary.value(RunQuantity::Avalanches), None);
    let names: std::collections::HashSet<_> =
        summary.entries.iter().map(|e| e.key.name()).collect();
    assert_eq!(names.len(), summary.entries.len());
    assert!(summary.entries.iter().all(|entry| !entry.note.is_empty()));
    // A heap of three grains in a row has no flat top.
    let shape = summary.get(RunQuantity::Shape);
    assert_eq!(shape, Some(MeasuredValue::Choice("cone")));
    assert_eq!(summary.value(RunQuantity::Shape), None);
    assert_eq!(summary.text(RunQuantity::Shape), "cone");
    let text = serde_json::to_string(&summary).unwrap();
    assert!(text.contains(r#""name":"deposit shape","unit":"1","value":"cone""#));
    assert!(text.contains(r#""name":"front radius R_∞","unit":"m","value":0.05"#));
    // While it moves there is no rest time.
    let no_flow = FlowHistory::default();
    let moving = results(&course(0.16, energy, front), &no_flow, &world, 0.0, 1.0);
    assert_eq!(moving.value(RunQuantity::RestTime), None);
    assert_eq!(moving.value(RunQuantity::DimensionlessRestTime), None);
}
