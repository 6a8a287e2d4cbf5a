//! Claims about when a run is measured: samples follow what happens, and nothing else.

use crate::runs::{prepared, shared_beds};
use grainfall::lab::{DriverKind, Lab, LabCommand, Options};
use grainfall::measure::{Measure, Sample, Series};
use grainfall::run::{BedStore, Command, Parameter, Run, Stored};
use grainfall::scene::{SAMPLE_INTERVAL, Scene};
use grainfall::solver::{Solver, advise};
use grainfall::world;
use std::ops::Range;
use std::time::Duration;

/// Fewest samples of an impact.
const OF_IMPACT: usize = 20;

fn scene(name: &str) -> Scene {
    Scene::open(name).unwrap()
}

fn run_of(scene: &Scene) -> Run {
    prepared(scene, 1, shared_beds()).0
}

/// The run of `scene` over its whole duration.
fn whole_run(scene: &Scene) -> Run {
    let mut run = run_of(scene);
    let end = run.world().clock.step_at(scene.duration);
    run.advance_to(end).unwrap();
    run
}

/// The steps from the last one before each impact of `scene` to the first one after it, found step
/// by step.
fn impacts(scene: &Scene) -> Vec<Range<u64>> {
    let mut world = world::build(scene, advise(scene).time_step);
    let mut solver = Solver::new(1);
    let (mut list, mut begun) = (Vec::new(), None);
    while world.time() < scene.duration {
        solver.advance(&mut world, 1).unwrap();
        let touch = world.contacts.iter().any(|contact| contact.touching);
        let step = world.clock.step;
        match begun {
            None if touch => begun = Some(step - 1),
            Some(begin) if !touch => {
                list.push(begin..step);
                begun = None;
            }
            _ => {}
        }
    }
    list
}

fn at(series: &Series, step: u64) -> Sample {
    let index = series.steps().binary_search(&step);
    series.get(index.expect("a sample at that step")).unwrap()
}

fn bits(series: &Series) -> Vec<u64> {
    let samples = (0..series.len()).filter_map(|index| series.get(index));
    let numbers = samples.flat_map(|sample| {
        let values = sample.values.map(f64::to_bits);
        [sample.step, sample.time.to_bits()]
            .into_iter()
            .chain(values)
    });
    numbers.collect()
}

#[test]
fn every_impact_of_few_grains_is_sampled_twenty_times() {
    for name in ["bouncing-grain", "two-grains", "grain-chain"] {
        let scene = scene(name);
        let impacts = impacts(&scene);
        let run = whole_run(&scene);
        let steps = run.series().steps();
        assert!(!impacts.is_empty(), "{name}");
        for impact in &impacts {
            // Its steps may be fewer than that: then those after it are sampled too.
            let end = impact.end.max(impact.start + OF_IMPACT as u64 + 1);
            let sampled = steps
                .iter()
                .filter(|step| (impact.start..end).contains(step));
            let sampled = sampled.count();
            assert!(sampled >= OF_IMPACT, "{name}: {sampled} of {impact:?}");
        }
        println!("{name}: {} impacts, {} samples", impacts.len(), steps.len());
    }
}

#[test]
fn bounces_keep_the_share_of_energy_that_the_restitution_says() {
    let mut scene = scene("bouncing-grain");
    // An impact in some seventy steps: in the seventeen of the scene's own time step it keeps a
    // hundredth more or less, and the samples show that, too.
    scene.set("time-step", "5us").unwrap();
    let run = whole_run(&scene);
    let energy = |step| at(run.series(), step).value(Measure::KineticEnergy);
    let impacts = impacts(&scene);
    // Slower ones last so long that the weight of the grain counts.
    for impact in &impacts[..5] {
        let share = energy(impact.end) / energy(impact.start);
        assert!((share / 0.64 - 1.0).abs() < 0.005, "{share} at {impact:?}");
    }
    // So do the heights that are seen on a plot.
    let heights = impacts.windows(2).map(|pair| {
        let steps = run.series().steps();
        let flight = steps.partition_point(|step| *step < pair[0].end)
            ..steps.partition_point(|step| *step <= pair[1].start);
        let fallen = &run.series().column(Measure::GravityWork)[flight];
        fallen[0] - fallen.iter().copied().fold(f64::INFINITY, f64::min)
    });
    let heights: Vec<f64> = heights.collect();
    for pair in heights[..5].windows(2) {
        let share = pair[1] / pair[0];
        assert!((share / 0.64 - 1.0).abs() < 0.005, "{share} of {heights:?}");
    }
}

#[test]
fn the_trace_of_few_grains_takes_at_most_twice_the_memory_of_the_grid() {
    let row = 8 * (Measure::COUNT + 2);
    for name in [
        "bouncing-grain",
        "two-grains",
        "slide-to-roll",
        "grain-chain",
    ] {
        let scene = scene(name);
        let series = whole_run(&scene).series().clone();
        let on_grid = row * ((scene.duration / SAMPLE_INTERVAL).round() as usize + 1);
        let memory = series.memory();
        println!(
            "{name}: {} samples, {memory} bytes, {on_grid} on the grid",
            series.len()
        );
        assert!(memory <= 2 * on_grid, "{name}: {memory} of {on_grid} bytes");
    }
}

#[test]
fn a_short_fall_of_a_column_has_rows_enough() {
    let mut scene = scene("small-column");
    scene.set("duration", "50ms").unwrap();
    let run = whole_run(&scene);
    let time = run.series().time();
    assert!(time.len() >= 20, "{} rows", time.len());
    let apart = time.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(apart.fold(0.0, f64::max) < 0.004);
}

#[test]
fn samples_depend_on_no_slice_no_snapshot_and_no_change_of_mind() {
    let scene = scene("bouncing-grain");
    let gravity = || Command::Set {
        parameter: Parameter::Gravity,
        value: 20.0.into(),
    };
    let mut whole = run_of(&scene);
    whole.advance_to(7_000).unwrap();
    whole.apply(gravity()).unwrap();
    whole.advance_to(20_000).unwrap();

    let mut sliced = run_of(&scene);
    let mut snapshots = Vec::new();
    for step in (1..=7_000).step_by(333).chain([7_000]) {
        sliced.advance_to(step).unwrap();
        snapshots.push(sliced.snapshot());
    }
    // There, and back again from a moment in flight.
    sliced.advance_to(12_345).unwrap();
    sliced.restore(&snapshots[snapshots.len() - 3]);
    sliced.advance_to(7_000).unwrap();
    sliced.apply(gravity()).unwrap();
    for step in (7_000..=20_000).step_by(477).chain([20_000]) {
        sliced.advance_to(step).unwrap();
    }
    assert_eq!(bits(sliced.series()), bits(whole.series()));
    assert_eq!(sliced.world().hash(), whole.world().hash());
}

#[test]
fn a_stated_interval_is_kept_and_moves_no_grain() {
    let free = whole_run(&scene("two-grains"));
    let mut stated = scene("two-grains");
    stated.set("sample-interval", "1ms").unwrap();
    let run = whole_run(&stated);
    let clock = run_of(&stated).world().clock;
    let expected: Vec<u64> = (0..=300)
        .map(|sample| clock.step_at(f64::from(sample) * 1e-3))
        .collect();
    assert_eq!(run.series().steps(), expected);
    assert_eq!(run.world().hash(), free.world().hash());
    stated.set("sample-interval", "automatic").unwrap();
    assert_eq!(stated, scene("two-grains"));
    let refused = stated
        .set("sample-interval", "0.1us")
        .unwrap_err()
        .to_string();
    assert!(refused.contains("at most a million samples"), "{refused}");
}

/// A run without a window whose samples stand in files keeps only the last ones.
#[test]
fn a_lab_forgets_what_it_is_told_to_and_samples_on_as_before() {
    let mut scene = scene("small-drum");
    scene.set("count", "20").unwrap();
    let come = |forgets: bool| {
        let options = Options {
            driver: DriverKind::Inline,
            threads: 1,
            beds: BedStore::none(),
            ..Options::headless()
        };
        let mut lab = Lab::open(scene.clone(), options);
        for step in [2000, 4000, 6000] {
            lab.send(LabCommand::Hold(Some(step)));
            while lab.world().is_none_or(|world| world.clock.step < step) {
                lab.tick(Duration::from_millis(1));
            }
            if forgets {
                let (samples, seconds) = (lab.series().taken(), 0);
                lab.send(LabCommand::ForgetMeasured(Stored { samples, seconds }));
            }
        }
        lab.tick(Duration::ZERO);
        lab
    };
    let [all, part] = [false, true].map(come);
    assert_eq!(all.world().unwrap().hash(), part.world().unwrap().hash());
    assert_eq!((all.series().is_part(), part.series().len()), (false, 1));
    assert_eq!(part.series().taken(), all.series().len());
    assert_eq!(part.sampling(), all.sampling());
    let last = |lab: &Lab| lab.sample().map(|sample| sample.values.map(f64::to_bits));
    assert_eq!(last(&part), last(&all));
}
