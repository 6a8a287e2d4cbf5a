//! Which solver and measures computed a run: a hash of what they make of small reference runs.
//!
//! In: a scene. Out: sixteen hexadecimal digits, the same on every machine and for any number of
//! threads, and others whenever a change of the program reaches a trajectory or a sample: such runs
//! are not gone on with, nor set beside each other in silence. The version alone does not say it.
//! One reference run is a small wet drum, one a low column of polyhedra. A scene whose springs are
//! implicit has a third one, the same column moved so: a change of this integrator reaches no
//! other scene.

use crate::measure::sample;
use crate::physics::Integrator;
use crate::scene::{Scene, SceneGrains};
use crate::solver::{Solver, advise};
use crate::world::{Packing, World, build, build_packed};
use std::sync::OnceLock;

/// The reference runs and how many steps they take: until grains touch grains and walls.
const REFERENCES: [(&str, u64); 2] = [(DRUM, 6000), (COLUMN, 200)];
const DRUM: &str = r#"(
    title: "Reference drum",
    materials: {
        "glass": (friction: 0.4, wet_friction: 0.1, rolling_friction: 0.01),
        "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
    },
    container: Drum(radius_mm: 24, width_mm: 16, speed_rpm: 10, material: "drum"),
    grains: Fill(count: 30, species: [(radius_mm: 3, material: "glass")]),
    liquid: (case: 2, volume_ml: 0.3),
)"#;
const COLUMN: &str = r#"(
    title: "Reference column",
    materials: {"smooth": (friction: 0.1), "rough": (friction: 0.4), "floor": (friction: 0.4)},
    container: Column(radius_mm: 8, height_mm: 8, material: "floor"),
    grains: Voronoi(
        cell_mm: 4,
        rounding_mm: 0.4,
        solid_fraction: 0.8,
        species: [(material: "smooth", share: 0.7), (material: "rough", share: 0.3)],
    ),
    law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500, features: Shared),
)"#;

/// The column moved implicitly, each of its features a contact of its own.
fn implicit_column() -> String {
    COLUMN.replace(
        "features: Shared),",
        "features: Full), integrator: Implicit,",
    )
}

/// The hash for `scene`, computed once for all that are moved like it.
pub fn method(scene: &Scene) -> &'static str {
    static EXPLICIT: OnceLock<String> = OnceLock::new();
    static IMPLICIT: OnceLock<String> = OnceLock::new();
    if scene.integrator == Integrator::Implicit {
        IMPLICIT.get_or_init(|| {
            let column = implicit_column();
            let [drum, own] = REFERENCES;
            hash_of(&[drum, own, (&column, own.1)])
        })
    } else {
        EXPLICIT.get_or_init(|| hash_of(&REFERENCES))
    }
}

fn hash_of(references: &[(&str, u64)]) -> String {
    let mut hasher = blake3::Hasher::new();
    for (scene, steps) in references {
        hasher.update(account(scene, *steps).as_bytes());
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

/// The state that a reference run comes to, and what is measured of it. A run that cannot be made
/// is told by why, so that no program without it passes for one with it.
fn account(scene: &str, steps: u64) -> String {
    let scene = match Scene::parse("reference", scene) {
        Ok(scene) => scene,
        Err(error) => return error.to_string(),
    };
    let mut world = start(&scene);
    if let Err(fault) = Solver::new(1).advance(&mut world, steps) {
        return fault.to_string();
    }
    // Measures may use the platform's own functions, which differ in last bits.
    let values = sample(&world).values.map(|value| format!("{value:.6e}"));
    format!("{} {}", world.hash(), values.join(" "))
}

fn start(scene: &Scene) -> World {
    let time_step = advise(scene).time_step;
    match (&scene.grains, Packing::new(scene)) {
        (SceneGrains::Voronoi(_), Some(mut packing)) => {
            while !packing.advance() {}
            build_packed(scene, time_step, packing.finish())
        }
        _ => build(scene, time_step),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_of_all_references_touch_and_another_law_gives_another_account() {
        let column = implicit_column();
        let [drum, own] = REFERENCES;
        for (text, steps) in [drum, own, (&column, own.1)] {
            let mut world = start(&Scene::parse("reference", text).unwrap());
            Solver::new(1).advance(&mut world, steps).unwrap();
            assert!(
                world.contacts.len() > 10,
                "{} contacts",
                world.contacts.len()
            );
            assert_eq!(account(text, steps), account(text, steps));
        }
        let coded = DRUM.replace("volume_ml: 0.3", "volume_ml: 0.3, law: AsCoded");
        assert_ne!(coded, DRUM);
        let accounts = [DRUM, &coded].map(|text| account(text, 6000));
        assert_ne!(accounts[0], accounts[1]);
        assert!(accounts[0].len() > 100, "{}", accounts[0]);
    }

    #[test]
    fn implicit_springs_have_a_method_of_their_own() {
        let scenes = [COLUMN.to_owned(), implicit_column()];
        let scenes = scenes.map(|text| Scene::parse("reference", &text).unwrap());
        assert_eq!(scenes[1].integrator, Integrator::Implicit);
        let [explicit, implicit] = scenes.each_ref().map(method);
        assert_ne!(explicit, implicit);
        assert_eq!([explicit.len(), implicit.len()], [16, 16]);
    }
}
