//! Whole steps of the three drums of Kasper et al. 2021, dry and wet, per grain and step, on one
//! thread and two; where the time of a step goes; the neighbour search alone; one contact law
//! alone.
//!
//! `cargo bench --bench drums`, see `benches/README.md`. Beds are settled
//! once and kept with the user's own.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use grainfall::run::{BedStore, Preparation, Prepared};
use grainfall::scene::Scene;
use grainfall::solver::{Processor, Solver, Stage, advise};
use grainfall::world::{World, build};
use std::hint::black_box;
use std::sync::Arc;

const DRY: [&str; 3] = ["dry-r3", "dry-r2", "dry-r1.25"];
/// Radii of the wet drums, with the liquid of n = 4.
const WET: [&str; 3] = ["3mm", "2mm", "1.25mm"];

/// The scenes of all drums with their names.
fn drums() -> impl Iterator<Item = (String, Scene)> {
    let open = |name: &str| Scene::open(name).expect("a built-in scene");
    let dry = DRY.map(|name| (name.to_owned(), open(name)));
    let wet = WET.map(|radius| {
        let mut scene = open("wet");
        for (key, value) in [("radius", radius), ("liquid", "4")] {
            scene.set(key, value).expect("a value that suits");
        }
        (format!("wet-r{}", radius.trim_end_matches("mm")), scene)
    });
    dry.into_iter().chain(wet)
}

/// The settled bed of a scene, its drum already turning for a moment.
fn settled(scene: Scene) -> World {
    let step = advise(&scene).time_step;
    let mut preparation = Preparation::new(Arc::new(scene), step, 2, BedStore::user());
    loop {
        match preparation.advance().expect("a bed that settles") {
            Prepared::Ready(run) => {
                let mut world = run.world().clone();
                Solver::new(2)
                    .advance(&mut world, 2000)
                    .expect("a stable step");
                return world;
            }
            Prepared::NotYet => {}
        }
    }
}

/// Whole steps, in calls of 1000, as runs take them between two samples; throughput is in grains
/// times steps.
fn steps(criterion: &mut Criterion) {
    const STEPS: u64 = 1000;
    let mut group = criterion.benchmark_group("step");
    group.sample_size(10);
    for (name, scene) in drums() {
        let bed = settled(scene);
        group.throughput(Throughput::Elements(STEPS * bed.grains.len() as u64));
        for threads in [1, 2] {
            let mut solver = Solver::new(threads);
            let mut world = bed.clone();
            group.bench_function(BenchmarkId::new(&name, format!("{threads} threads")), |b| {
                b.iter(|| solver.advance(&mut world, STEPS).expect("a stable step"));
            });
            let profile = solver.take_profile();
            let share = |stage| profile.time(stage).as_secs_f64() / profile.total.as_secs_f64();
            println!(
                "{name}, {threads} threads: {:.1} ns per grain and step; {}",
                1e9 * profile.per_grain_step(),
                Stage::ALL
                    .map(|stage| format!("{} {:.0} %", stage.name(), 100.0 * share(stage)))
                    .join(", ")
            );
        }
    }
    group.finish();
}

/// Every width of lanes that the processor has: what they gain over the plain twin.
fn steps_in_lanes(criterion: &mut Criterion) {
    let bed = settled(Scene::open("dry-r2").expect("a built-in scene"));
    let mut group = criterion.benchmark_group("step in lanes");
    group.throughput(Throughput::Elements(100 * bed.grains.len() as u64));
    for processor in Processor::all() {
        let mut solver = Solver::on(processor, 1);
        let mut world = bed.clone();
        group.bench_function(format!("dry-r2, {processor}"), |b| {
            b.iter(|| solver.advance(&mut world, 100).expect("a stable step"));
        });
    }
    group.finish();
}

/// A solver that knows nothing takes one step: cell grid and lists, copying in and out, and that
/// step.
fn neighbour_search(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("lists from nothing and one step");
    for (name, scene) in drums() {
        let bed = settled(scene);
        group.throughput(Throughput::Elements(bed.grains.len() as u64));
        group.bench_function(&name, |b| {
            b.iter_batched(
                || (Solver::new(1), bed.clone()),
                |(mut solver, mut world)| {
                    solver.advance(&mut world, 1).expect("a stable step");
                    (solver, world)
                },
                criterion::BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

/// Placing the grains of the finest drum.
fn placing(criterion: &mut Criterion) {
    let scene = Scene::open("dry-r1.25").expect("a built-in scene");
    criterion.bench_function("build dry-r1.25", |b| {
        b.iter(|| build(black_box(&scene), 1e-5));
    });
}

criterion_group!(benches, steps, steps_in_lanes, neighbour_search, placing);
criterion_main!(benches);
