//! Whole steps of columns of rounded polyhedra just released, per grain and step, on one thread and
//! two.
//!
//! `cargo bench --bench columns`, see `benches/README.md`. The case is the
//! one whose figures for the program of Man et al. 2023 are known: spacing 2 mm, rounding 0.2 mm,
//! contacts of 100 N/m, every pair of features a full contact.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use grainfall::physics::ContactLaw;
use grainfall::scene::{Scene, SceneGrains};
use grainfall::solver::{Solver, Stage};
use grainfall::world::{World, build};

/// A step short enough to be stable [s].
const STEP: f64 = 5e-6;

/// The column of this `height` a millisecond after it was released.
fn released(height: &str) -> World {
    let mut scene = Scene::open("column").expect("a built-in scene");
    scene.set("height", height).expect("a height");
    if let SceneGrains::Voronoi(cells) = &mut scene.grains {
        cells.rounding = 2e-4;
    }
    if let ContactLaw::Hooke {
        normal_stiffness,
        tangential_stiffness,
        ..
    } = &mut scene.law
    {
        (*normal_stiffness, *tangential_stiffness) = (100.0, 50.0);
    }
    let mut world = build(&scene, STEP);
    Solver::new(2)
        .advance(&mut world, 200)
        .expect("a stable step");
    world
}

/// Whole steps, in calls of 50; throughput is in grains times steps.
fn steps(criterion: &mut Criterion) {
    const STEPS: u64 = 50;
    let mut group = criterion.benchmark_group("column step");
    group.sample_size(10);
    for height in ["10mm", "50mm"] {
        let column = released(height);
        group.throughput(Throughput::Elements(STEPS * column.grains.len() as u64));
        for threads in [1, 2] {
            let mut solver = Solver::new(threads);
            let mut world = column.clone();
            group.bench_function(
                BenchmarkId::new(height, format!("{threads} threads")),
                |b| {
                    b.iter(|| solver.advance(&mut world, STEPS).expect("a stable step"));
                },
            );
            let profile = solver.take_profile();
            let share = |stage| profile.share(stage);
            let grains = world.grains.len() as f64;
            println!(
                "{height}, {threads} threads: {:.0} ns per grain and step; {:.0} features listed a grain, {:.3} lists made a \
                 grain and step; {}",
                1e9 * profile.per_grain_step(),
                profile.listed as f64 / grains,
                profile.relisted as f64 / profile.steps.max(1) as f64 / grains,
                Stage::ALL
                    .map(|stage| format!("{} {:.0} %", stage.name(), 100.0 * share(stage)))
                    .join(", ")
            );
        }
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
