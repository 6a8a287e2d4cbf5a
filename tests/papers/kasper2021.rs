//! Kasper et al. 2021: the drum, dry and wet. What holds is asserted here; what does not stands in
//! docs/validation.md.

use super::value;
use grainfall::lab::SMALLEST_DROP;
use grainfall::measure::{Measure, ResultKey, RunQuantity, Summary, summarise};
use grainfall::run::{BedStore, Preparation, Prepared};
use grainfall::scene::Scene;
use grainfall::solver::advise;
use std::sync::Arc;

/// Results of the last 30 of 50 s.
fn results(settings: &[(&str, &str)]) -> Summary {
    let mut scene = Scene::open("wet").unwrap();
    for (key, text) in settings {
        scene.set(key, text).unwrap();
    }
    let step = advise(&scene).time_step;
    let mut preparation = Preparation::new(Arc::new(scene), step, 2, BedStore::shipped());
    let mut run = loop {
        if let Prepared::Ready(run) = preparation.advance().unwrap() {
            break run;
        }
    };
    let end = run.world().clock.step_at(50.0);
    run.advance_to(end).unwrap();
    summarise(run.series(), 20.0, SMALLEST_DROP)
}

#[test]
#[ignore = "takes minutes"]
fn dry_drum_of_3_mm_is_a_sawtooth_that_rises_with_the_drum() {
    let dry = results(&[("liquid", "dry")]);
    // 3.0 °/s; θ is read to about 0.1° over 0.2 s.
    assert!((value(&dry, RunQuantity::RiseRate).to_degrees() - 3.0).abs() < 0.1);
    assert!(value(&dry, RunQuantity::Avalanches) >= 5.0);
    let (quiet, loud) = (
        value(&dry, RunQuantity::TemperatureBetweenAvalanches),
        value(&dry, RunQuantity::TemperatureInAvalanches),
    );
    // Rigid rotation alone gives 1.8e-9 m²/s² in the laboratory frame.
    assert!(quiet < 4e-9 && loud > 1e4 * quiet);
    assert!(value(&dry, RunQuantity::RelativeEnergyResidual).abs() < 2e-3);
}

#[test]
#[ignore = "takes minutes"]
fn dry_angle_and_drop_grow_with_the_radius() {
    let [small, large] = ["2mm", "3mm"].map(|r| results(&[("liquid", "dry"), ("radius", r)]));
    assert!(value(&small, Measure::SurfaceAngle) < value(&large, Measure::SurfaceAngle));
    assert!(value(&small, RunQuantity::Drop) < value(&large, RunQuantity::Drop));
}

#[test]
#[ignore = "takes minutes"]
fn viscosity_lowers_drops_and_temperature_and_the_bed_no_longer_rests() {
    let [dry, water, glycerol] = ["dry", "1", "7"].map(|n| results(&[("liquid", n)]));
    let keys: [ResultKey; 2] = [
        RunQuantity::Drop.into(),
        Measure::GranularTemperature.into(),
    ];
    for key in keys {
        let [dry, water, glycerol] = [&dry, &water, &glycerol].map(|s| value(s, key));
        assert!(
            dry > water && water > glycerol,
            "{}: {dry} {water} {glycerol}",
            key.name()
        );
    }
    let share = RunQuantity::NonRigidShare;
    assert!(value(&glycerol, share) > value(&water, share));
}
