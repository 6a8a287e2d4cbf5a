//! A collapsing column of polyhedra: the same bits for any threads, lanes and slices, with springs and
//! dashpots that are explicit, and that are implicit.

use super::*;
use grainfall::solver::Processor;
use grainfall::world::StateHash;

/// A small column in the open.
const COLUMN: &str = r#"(
    title: "A few dozen cells",
    materials: {
        "smooth": (density: 2650, restitution: 0.1, friction: 0.1),
        "rough": (density: 2650, restitution: 0.1, friction: 0.4),
        "floor": (restitution: 0.1, friction: 0.4),
    },
    container: Column(radius_mm: 8, height_mm: 16, material: "floor"),
    grains: Voronoi(cell_mm: 3, rounding_mm: 0.3, solid_fraction: 0.8, species: [
        (material: "smooth", share: 0.7), (material: "rough", share: 0.3),
    ]),
    law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000, features: RULE),
    integrator: INTEGRATOR,
)"#;

/// The text of its scene.
pub fn text_of_column(rule: &str, integrator: &str) -> String {
    let text = COLUMN.replace("RULE", rule);
    text.replace("INTEGRATOR", integrator)
}

/// The column as it is released, with steps of `dt` [s].
pub fn column(rule: &str, integrator: &str, dt: f64) -> World {
    world(&text_of_column(rule, integrator), dt)
}

/// The step that each integrator is tried with [s].
const STEPS: [(&str, f64); 2] = [("Explicit", 2e-6), ("Implicit", 2e-5)];

#[test]
fn collapse_has_the_same_bits_for_any_threads_lanes_and_slices() {
    let rules = ["Full", "Shared"].into_iter();
    for (rule, (integrator, dt)) in rules.flat_map(|rule| STEPS.map(|step| (rule, step))) {
        // Workers meet thirty times in an implicit step: eight of them take long on two cores.
        let slices = match integrator {
            "Explicit" => [1, 499, 200, 500],
            _ => [1, 199, 50, 150],
        };
        let all = [slices.iter().sum()];
        let fallen = |mut solver: Solver, slices: &[u64]| -> StateHash {
            let mut world = column(rule, integrator, dt);
            for &steps in slices {
                solver.advance(&mut world, steps).unwrap();
            }
            world.hash()
        };
        let whole = fallen(Solver::new(1), &all);
        for threads in [2, 3, 8] {
            let found = fallen(Solver::new(threads), &all);
            assert_eq!(found, whole, "{integrator}, {rule}, {threads} threads");
        }
        for processor in Processor::all() {
            let found = fallen(Solver::on(processor, 1), &all);
            assert_eq!(found, whole, "{integrator}, {rule}, {processor}");
        }
        let found = fallen(Solver::new(1), &slices);
        assert_eq!(found, whole, "{integrator}, {rule}, in slices");
    }
}

#[test]
fn restored_collapse_goes_on_to_the_same_bits() {
    for (integrator, dt) in STEPS {
        let mut world = column("Full", integrator, dt);
        let mut solver = Solver::new(2);
        solver.advance(&mut world, 1500).unwrap();
        let snapshot = world.clone();
        solver.advance(&mut world, 1000).unwrap();
        let whole = world.hash();
        // Into the solver that has gone on, and into one that knows nothing, from bytes that know
        // no shared memory.
        let mut again = snapshot.clone();
        solver.advance(&mut again, 1000).unwrap();
        assert_eq!(again.hash(), whole, "{integrator}");
        let bytes = postcard::to_stdvec(&snapshot).unwrap();
        let mut fresh: World = postcard::from_bytes(&bytes).unwrap();
        Solver::new(1).advance(&mut fresh, 1000).unwrap();
        assert_eq!(fresh.hash(), whole, "{integrator}");
    }
}
