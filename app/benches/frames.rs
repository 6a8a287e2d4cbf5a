//! What a frame of the picture costs the processor when the world in it is another, without a
//! graphics device: colours, shadows and places of all grains, for two drums of spheres and a
//! column of as many polyhedra as the tallest one of Man et al. 2023; and what it costs to make the
//! meshes of those polyhedra, once for a scene. Then the same for the whole window, every panel
//! open, a grain under the microscope, flowing layer, temperatures, forces and ghosts drawn, with
//! what a frame allocates; once also while a parameter sweep computes on every core.
//!
//! `cargo bench -p grainfall --bench frames`, see `benches/README.md`.

#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may be computed with the platform's own functions"
)]

#[path = "../../tests/common/allocator.rs"]
mod allocator;
#[path = "common/laboratory.rs"]
mod laboratory;

use bevy::prelude::*;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{DQuat, DVec3};
use grainfall::lab::{Options, Status};
use grainfall::measure::GrainQuantity;
use grainfall::run::{BedStore, Command};
use grainfall::scene::Scene;
use grainfall::sweep::{BackgroundSweep, Sweep, Variation};
use grainfall::world::{Polyhedra, Polyhedron, World, build};
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::Dock;
use grainfall_app::view::{ColourBy, Meshing, ShownWorlds, ViewPlugin, ViewSettings};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Grains of the column of 35 cm.
const POLYHEDRA: usize = 68_722;

/// The drum of spheres `name`, as placed.
fn drum(name: &str) -> World {
    build(&Scene::open(name).expect("a built-in scene"), 1e-5)
}

/// An upright prism with `sides` sides, as many corners and edges as a Voronoi cell has with 14.
fn prism(sides: u16, radius: f64) -> Polyhedron {
    let ring = |y: f64| {
        (0..sides).map(move |i| {
            let turn =
                DQuat::from_rotation_y(std::f64::consts::TAU * f64::from(i) / f64::from(sides));
            turn * DVec3::new(0.0, y, radius)
        })
    };
    let mut faces = vec![(sides..2 * sides).collect(), (0..sides).rev().collect()];
    let mut edges = Vec::new();
    for i in 0..sides {
        let next = (i + 1) % sides;
        faces.push(vec![i, next, sides + next, sides + i]);
        edges.extend([[i, next], [sides + i, sides + next], [i, sides + i]]);
    }
    Polyhedron {
        vertices: ring(-radius).chain(ring(radius)).collect(),
        edges,
        faces,
        rounding: 0.1 * radius,
        volume: 6.0 * radius.powi(3),
        gyration: DVec3::splat(0.3 * radius * radius),
    }
}

/// Prisms on a lattice, each with a shape of its own.
fn column() -> World {
    let radius = 1e-3;
    let mut world = drum("bouncing-grain");
    let species = world.grains.species[0];
    world.grains = grainfall::world::Grains::default();
    let shape = prism(14, 0.8 * radius);
    let side = (POLYHEDRA as f64).cbrt().ceil() as usize;
    for i in 0..POLYHEDRA {
        let cell = [i % side, i / (side * side), i / side % side].map(|k| k as f64);
        let x = 2.0 * radius * DVec3::from_array(cell);
        world
            .grains
            .push_sphere(x, shape.bounding_radius(), 2500.0, species);
    }
    let shapes = vec![shape; POLYHEDRA];
    let bodies: Vec<_> = (0..)
        .map(|k| (k, DQuat::IDENTITY))
        .take(POLYHEDRA)
        .collect();
    let polyhedra = Polyhedra::of_grains(&world.grains, shapes, &bodies);
    world.polyhedra = Some(Box::new(polyhedra));
    world
}

/// The view alone.
fn view() -> App {
    let mut app = laboratory::app(false);
    app.add_plugins(ViewPlugin);
    app.finish();
    app.cleanup();
    app.update();
    app
}

/// The whole window with `scene`, every panel open and a grain under the microscope.
fn window(scene: Scene) -> App {
    let options = Options {
        threads: 1,
        autoplay: false,
        memory: 0,
        ..Options::window()
    };
    let mut app = laboratory::app(false);
    laboratory::add(&mut app, scene, options);
    let mut view = app.world_mut().resource_mut::<ViewSettings>();
    (view.selected, view.traced) = (Some(0), vec![0, 1, 2]);
    (view.colour_by, view.show_forces) = (ColourBy::Quantity(GrainQuantity::Speed), true);
    (view.show_flow, view.show_temperature) = (true, true);
    // With ghosts round them.
    view.grain_size = 0.4;
    laboratory::prepare(&mut app);
    app.world_mut().resource_mut::<Dock>().show_all_panels();
    for _ in 0..10 {
        app.update();
    }
    app
}

/// Lets the run take a step and waits for it, outside of any frame.
fn step(app: &mut App) {
    let mut simulation = app.world_mut().resource_mut::<Simulation>();
    let before = simulation.generation();
    simulation.send(Command::Step(1));
    while simulation.generation() == before || *simulation.status() != Status::Paused {
        simulation.tick(Duration::from_millis(1));
        std::thread::sleep(Duration::from_micros(200));
    }
}

fn show(app: &mut App, world: &Arc<World>) {
    let mut shown = app.world_mut().resource_mut::<ShownWorlds>();
    shown.show(Some(world.clone()));
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    for (name, world) in [
        ("470 spheres", drum("dry-r3")),
        ("6494 spheres", drum("dry-r1.25")),
        ("68722 polyhedra", column()),
    ] {
        let world = Arc::new(world);
        let mut app = view();
        show(&mut app, &world);
        let (began, mut updates) = (Instant::now(), 0);
        while updates == 0 || !app.world().resource::<Meshing>().is_whole() {
            app.update();
            updates += 1;
        }
        let milliseconds = 1e3 * began.elapsed().as_secs_f64();
        println!("{name}: meshes in {updates} frames, {milliseconds:.0} ms");
        group.throughput(Throughput::Elements(world.grains.len() as u64));
        group.sample_size(20);
        group.bench_function(name, |b| {
            b.iter(|| {
                show(&mut app, &world);
                app.update();
            });
        });
    }
    group.finish();
}

/// Prints what a frame with a new state allocates.
fn count_allocations(name: &str, app: &mut App) {
    step(app);
    let before = allocator::allocated();
    app.update();
    let after = allocator::allocated();
    let [times, bytes] = [0, 1].map(|i| after[i] - before[i]);
    println!(
        "{name}: a frame allocates {times} times, {} kB",
        bytes / 1000
    );
}

/// Drums of eight frictions, one on each core, into `folder`: more than a measurement takes.
fn sweep(folder: &Path) -> BackgroundSweep {
    let variation = Variation::parse("friction.glass.glass=0.1..0.8:0.1");
    BackgroundSweep::start(Sweep {
        name: "dry-r3".into(),
        scene: Scene::open("dry-r3").expect("a built-in scene"),
        settings: Vec::new(),
        variations: vec![variation.expect("a variation")],
        out: folder.join("sweep"),
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
        beds: BedStore::user(),
        restart: false,
    })
}

fn windows(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("window");
    let scene = |name: &str| Scene::open(name).expect("a built-in scene");
    let mut column = scene("column");
    column.set("height", "35cm").expect("a height");
    for (name, scene, has_sweep) in [
        ("470 spheres", scene("dry-r3"), false),
        ("6494 spheres", scene("dry-r1.25"), false),
        ("68722 polyhedra", column, false),
        ("6494 spheres beside a sweep", scene("dry-r1.25"), true),
    ] {
        group.sample_size(20);
        let folder = tempfile::tempdir().expect("a folder");
        let mut beside = None;
        // Made when it is asked for: a column takes its time.
        let mut made = None;
        group.bench_function(name, |b| {
            let app = made.get_or_insert_with(|| {
                let mut app = window(scene.clone());
                count_allocations(name, &mut app);
                app
            });
            if has_sweep && beside.is_none() {
                beside = Some(sweep(folder.path()));
            }
            b.iter_custom(|frames| {
                let mut spent = Duration::ZERO;
                for _ in 0..frames {
                    step(app);
                    let began = Instant::now();
                    app.update();
                    spent += began.elapsed();
                }
                spent
            });
        });
        if let Some(sweep) = beside {
            assert!(sweep.is_running(), "the sweep ended before the measurement");
        }
    }
    group.finish();
}

criterion_group!(benches, frames, windows);
criterion_main!(benches);
