//! Bytes per grain of a world and its solver, counted by the allocator. A binary of its own:
//! nothing else allocates in it.

#[path = "../common/allocator.rs"]
mod allocator;

use allocator::{in_use, with_peak};
use grainfall::output::write_grains;
use grainfall::run::Provenance;
use grainfall::scene::Scene;
use grainfall::solver::{Solver, advise};
use grainfall::world::build;
use std::sync::{Mutex, PoisonError};

/// Tests take turns: every one counts what all allocate.
static TURN: Mutex<()> = Mutex::new(());

#[test]
fn column_of_polyhedra_takes_less_than_twenty_kilobytes_a_grain_with_its_output() {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut scene = Scene::open("column").unwrap();
    scene.set("height", "10mm").unwrap();
    let dt = advise(&scene).time_step;
    let before = in_use();
    let mut world = build(&scene, dt);
    let count = world.grains.len();
    assert_eq!(count, 1963);
    let per_grain = |bytes: usize| (bytes - before) as f64 / count as f64;
    let built = per_grain(in_use());
    // All faces of the packing lie on each other: nowhere do more features touch than soon after
    // the release.
    let mut solver = Solver::new(2);
    let ((), stepped) = with_peak(|| (0..6).for_each(|_| solver.advance(&mut world, 100).unwrap()));
    let from = Provenance::of(&scene, &world);
    let (result, written) = with_peak(|| write_grains(&world, &from, &mut std::io::sink()));
    result.unwrap();
    let [stepped, written] = [stepped, stepped.max(written)].map(per_grain);
    println!("built {built:.0}, peak of steps {stepped:.0}, with output {written:.0} B per grain");
    assert!(written < 20e3, "{written} bytes per grain");
}

#[test]
fn paper_drum_takes_some_kilobytes_a_grain_and_no_more_with_time() {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let scene = Scene::open("dry-r1.25").unwrap();
    let dt = advise(&scene).time_step;
    let before = in_use();
    let mut world = build(&scene, dt);
    let mut solver = Solver::new(2);
    let count = world.grains.len();
    assert_eq!(count, 6494);
    let per_grain = |bytes: usize| (bytes - before) as f64 / count as f64;
    // The bed falls together: contacts appear until it lies.
    let mut slices = |number: u32| {
        let steps = || (0..number).for_each(|_| solver.advance(&mut world, 500).unwrap());
        let peak = per_grain(with_peak(steps).1);
        println!(
            "{} contacts: peak {peak:.0} B, in use {:.0} B per grain",
            world.contacts.len(),
            per_grain(in_use())
        );
        peak
    };
    slices(12);
    let early = slices(4);
    let late = slices(8);
    assert!(late < 2400.0, "{late} bytes per grain");
    // Vectors may grow once more by doubling their capacity as the bed moves, but not step after
    // step.
    assert!(late < 1.1 * early, "{early} bytes per grain, later {late}");
}
