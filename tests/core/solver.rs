//! The solver: forces and motions with known answers, conservation, determinism, faults, time
//! steps.
//!
//! Every case is a scene's text, so that each can be opened and looked at. Figures are printed:
//! `--nocapture` shows them.

mod bridges;
mod cloud;
mod collapse;
mod determinism;
mod drum;
mod evaluate;
mod faults;
mod impact;
mod implicit;
mod liggghts;
mod mesh;
mod pair_forces;
mod polyhedra;
mod published;
mod random_scenes;
mod resume;
mod resumes;
mod rolling;
mod terms;
mod time_step;
mod turning;

use grainfall::scene::Scene;
use grainfall::solver::Solver;
use grainfall::world::{Partner, World, build};

/// The world of a scene's text, with steps of `dt`.
fn world(text: &str, dt: f64) -> World {
    let scene = Scene::parse("test scene", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    build(&scene, dt)
}

/// Takes the steps that `time` holds.
fn run(world: &mut World, time: f64) {
    let steps = (time / world.clock.time_step).round() as u64;
    Solver::new(1).advance(world, steps).unwrap();
}

/// Overlap of the contact at `index` [m].
fn overlap(world: &World, index: usize) -> f64 {
    let contact = &world.contacts[index];
    let grains = &world.grains;
    let i = contact.grain as usize;
    match contact.partner {
        Partner::Grain(j) => {
            let j = j as usize;
            let distance = (grains.position[j] - grains.position[i]).length();
            grains.radius[i] + grains.radius[j] - distance
        }
        Partner::Wall(w) => {
            let surface = &world.container.walls[w as usize].surface;
            grains.radius[i] - surface.distance(grains.position[i]).0
        }
    }
}

/// Asserts that `found` is within `tolerance` of `expected`, relative to it.
#[track_caller]
fn assert_relative(what: &str, found: f64, expected: f64, tolerance: f64) {
    let deviation = (found / expected - 1.0).abs();
    println!("{what}: {found:.8e}, expected {expected:.8e}: off by {deviation:.1e}");
    assert!(
        deviation <= tolerance,
        "{what}: {found} instead of {expected}, off by {deviation:.2e}, allowed {tolerance:.2e}"
    );
}

/// Asserts that `found` is at most `bound`.
#[track_caller]
fn assert_below(what: &str, found: f64, bound: f64) {
    println!("{what}: {found:.3e}, bound {bound:.1e}");
    assert!(found <= bound, "{what}: {found:e} exceeds {bound:e}");
}
