//! Man et al. 2023: the column of two frictions, 1 cm high. What holds is asserted here; what does
//! not stands in docs/validation.md.

use super::value;
use grainfall::lab::SMALLEST_DROP;
use grainfall::measure::{Measure, RunQuantity, Summary, results};
use grainfall::run::{BedStore, Preparation, Prepared};
use grainfall::scene::Scene;
use std::sync::Arc;

/// Steps of this length ran to rest with a closed energy balance; the paper's own are longer [s].
const STEP: f64 = 2.8e-6;

/// Results of the column of 1 cm with 30 % of rough grains and these settings, at rest.
fn results_of(settings: &[(&str, &str)]) -> Summary {
    let mut scene = Scene::open("column-7-3").unwrap();
    scene.set("height", "10mm").unwrap();
    for (key, text) in settings {
        scene.set(key, text).unwrap();
    }
    let mut preparation = Preparation::new(Arc::new(scene), STEP, 2, BedStore::shipped());
    let mut run = loop {
        if let Prepared::Ready(run) = preparation.advance().unwrap() {
            break run;
        }
    };
    let end = run.world().clock.step_at(0.38);
    run.advance_to(end).unwrap();
    results(run.series(), run.flow(), run.world(), 0.0, SMALLEST_DROP)
}

#[test]
#[ignore = "takes minutes"]
fn column_of_1_cm_falls_and_stops_as_the_paper_says() {
    let fallen = results_of(&[]);
    // Samples are 0.02 s apart.
    assert!((value(&fallen, RunQuantity::PeakTime) - 0.06).abs() < 0.021);
    let effective = value(&fallen, RunQuantity::EffectiveAspectRatio);
    assert!(value(&fallen, RunQuantity::DimensionlessPeakTime) >= 0.92 * effective.sqrt());
    assert!(
        value(&fallen, RunQuantity::RestTime).is_finite(),
        "it has stopped"
    );
    // The paper's shares, ± 0.04 for 2000 grains.
    let shares = [
        (Measure::FirstPairs, 0.49),
        (Measure::MixedPairs, 0.42),
        (Measure::SecondPairs, 0.09),
    ];
    for (measure, share) in shares {
        assert!(
            (value(&fallen, measure) - share).abs() < 0.04,
            "{measure:?}"
        );
    }
    assert!(value(&fallen, RunQuantity::RelativeEnergyResidual).abs() < 1e-3);
}

#[test]
#[ignore = "takes minutes"]
fn friction_holds_the_front_back() {
    let [slippery, rough] = [("0.1", "0.1"), ("0.4", "0.8")].map(|(first, second)| {
        let fallen = results_of(&[("mu11", first), ("mu22", second)]);
        value(&fallen, RunQuantity::RunOut)
    });
    assert!(slippery > 1.3 * rough, "{slippery} {rough}");
}
