//! What a frame of the picture costs the processor when the world in it is another, without a graphics device: colours,
//! shadows and places of all grains, for two drums of spheres and a column of as many polyhedra as the tallest one of
//! Man et al. 2023; and what it costs to make the meshes of those polyhedra, once for a scene.
//!
//! `cargo bench --bench frames`, see `benches/README.md`.

use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::settings::WgpuSettings;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{DQuat, DVec3};
use grainfall::scene::Scene;
use grainfall::view::{Meshing, Shown, ViewPlugin};
use grainfall::world::{Polyhedra, Polyhedron, World, build};
use std::sync::Arc;
use std::time::Instant;

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
    world.polyhedra = Some(Box::new(Polyhedra {
        shapes: std::iter::repeat_n(shape, POLYHEDRA).collect(),
        shape: (0..POLYHEDRA as u32).collect(),
        orientation: vec![DQuat::IDENTITY; POLYHEDRA],
        angular_momentum: vec![DVec3::ZERO; POLYHEDRA],
        inertia: vec![DVec3::ONE; POLYHEDRA],
        features: Vec::new(),
    }));
    world
}

/// The view without a window and without a graphics device.
fn view() -> App {
    let mut app = App::new();
    app.add_plugins(
        DefaultPlugins
            .build()
            .disable::<WinitPlugin>()
            .disable::<bevy::log::LogPlugin>()
            .set(WindowPlugin {
                primary_window: None,
                exit_condition: ExitCondition::DontExit,
                ..default()
            })
            .set(RenderPlugin {
                render_creation: WgpuSettings {
                    backends: None,
                    ..default()
                }
                .into(),
                ..default()
            }),
    )
    .add_plugins(ViewPlugin);
    app.finish();
    app.cleanup();
    app.update();
    app
}

fn show(app: &mut App, world: &Arc<World>) {
    let mut shown = app.world_mut().resource_mut::<Shown>();
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

criterion_group!(benches, frames);
criterion_main!(benches);
