//! Polyhedra resumed: a solver that knows nothing of a world goes on to the same bits as the one
//! that brought it there.
//!
//! What a solver keeps of pairs of polyhedra (lists of features, how far they may move before
//! anything can touch) is a cache. The beginning of a run tries it hardest: cells that were cut
//! apart touch along whole faces, exactly, and fall together, so that a distance changes by
//! rounding alone. There a pair that was left out for a distance just above zero once made a run
//! differ from its resumed twin.

use super::*;
use grainfall::solver::advise;
use grainfall::world::StateHash;

/// Snapshots are taken after each of so many steps.
const SNAPSHOTS: u64 = 300;
/// Steps that each resumed run takes.
const STEPS: u64 = 8;
/// One in so many is resumed to the end of the run instead.
const WHOLE: u64 = 75;

/// The drum and the box, each filled with cells.
const CELLS: &str = r#"(
    title: "Cells",
    materials: {"smooth": (friction: 0.1), "rough": (friction: 0.4)},
    container: CONTAINER,
    grains: Voronoi(cell_mm: 4, rounding_mm: 0.3, solid_fraction: 0.7, species: [
        (material: "smooth", share: 0.5), (material: "rough", share: 0.5),
    ]),
    law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500, features: RULE),
)"#;
const DRUM: &str = r#"Drum(radius_mm: 12, width_mm: 12, speed_rpm: 30, material: "rough")"#;
const BOX: &str = r#"Box(min: (-0.008, 0, -0.008), max: (0.008, 0.02, 0.008), material: "smooth")"#;

fn cells(container: &str, rule: &str) -> Scene {
    let text = CELLS.replace("CONTAINER", container).replace("RULE", rule);
    Scene::parse("cells", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Steps after which runs of `scene` resumed from a snapshot differ from the uninterrupted one.
fn strays(scene: &Scene) -> Vec<u64> {
    let mut world = build(scene, advise(scene).time_step);
    let mut solver = Solver::new(1);
    let (mut snapshots, mut hashes): (Vec<World>, Vec<StateHash>) = (Vec::new(), Vec::new());
    for step in 0..=SNAPSHOTS + STEPS {
        if step > 0 {
            solver.advance(&mut world, 1).unwrap();
        }
        hashes.push(world.hash());
        if step <= SNAPSHOTS {
            snapshots.push(world.clone());
        }
    }
    let contacts = world.polyhedra.as_ref().unwrap().features.len();
    println!("{} grains, {contacts} contacts", world.grains.len());
    assert!(contacts > world.grains.len(), "they touch");
    let strays = |(begin, mut resumed): (u64, World)| {
        let mut solver = Solver::new(1);
        let end = if begin % WHOLE == 0 {
            SNAPSHOTS + STEPS
        } else {
            begin + STEPS
        };
        solver.advance(&mut resumed, 1).unwrap();
        let first = resumed.hash() == hashes[begin as usize + 1];
        solver.advance(&mut resumed, end - begin - 1).unwrap();
        (!first || resumed.hash() != hashes[end as usize]).then_some(begin)
    };
    (0..).zip(snapshots).filter_map(strays).collect()
}

#[test]
fn resumed_small_column_goes_on_to_the_same_bits_from_each_of_its_first_steps() {
    assert_eq!(
        strays(&Scene::open("small-column").unwrap()),
        Vec::<u64>::new()
    );
}

#[test]
fn resumed_box_of_polyhedra_goes_on_to_the_same_bits_from_each_of_its_first_steps() {
    for rule in ["Full", "Shared"] {
        assert_eq!(strays(&cells(BOX, rule)), Vec::<u64>::new(), "{rule}");
    }
}

#[test]
fn resumed_drum_of_polyhedra_goes_on_to_the_same_bits_from_each_of_its_first_steps() {
    for rule in ["Full", "Shared"] {
        assert_eq!(strays(&cells(DRUM, rule)), Vec::<u64>::new(), "{rule}");
    }
}

#[test]
fn resumed_column_of_implicit_springs_goes_on_to_the_same_bits_from_each_of_its_first_steps() {
    let text = super::collapse::text_of_column("Full", "Implicit");
    let scene = Scene::parse("column", &text).unwrap();
    assert_eq!(strays(&scene), Vec::<u64>::new());
}
