//! Golden hashes: runs that have the bits they always had, on any machine and for any number of
//! threads, as a step knows nothing but + − × ÷ √, however it is compiled. A commit that changes one
//! says why.

#[path = "../common/hash_table.rs"]
mod hash_table;

use grainfall::scene::{Scene, SceneContainer};
use grainfall::solver::{Solver, advise};
use grainfall::world::build;

/// A scene after it has been given some values, a quickly turning drum where it has one.
fn scene(name: &str, values: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::open(name).unwrap();
    for (key, value) in values {
        scene.set(key, value).unwrap();
    }
    if let SceneContainer::Drum { speed, .. } = &mut scene.container {
        *speed = 3.0;
    }
    scene
}

/// Asserts that `scene`, called `name`, `before` steps after its start by one thread, has the hash `golden` after
/// 300 more by any number of threads.
#[track_caller]
fn assert_golden(name: &str, scene: &Scene, before: u64, golden: &str) {
    let mut start = build(scene, advise(scene).time_step);
    Solver::new(1).advance(&mut start, before).unwrap();
    let held = start.contacts.iter().filter(|c| c.bridge.is_some());
    let [grains, contacts] = [start.grains.len(), start.contacts.len()];
    println!(
        "{grains} grains, {contacts} contacts, {} bridges",
        held.count()
    );
    assert!(contacts > grains, "grains touch");
    for threads in [1, 2, 3, 8] {
        let mut world = start.clone();
        Solver::new(threads).advance(&mut world, 300).unwrap();
        let found = world.hash().to_string();
        hash_table::note(name, &format!("golden, threads: {threads}"), &found);
        assert_eq!(found, golden, "{name}, {threads} threads");
    }
}

#[test]
fn dry_drum_has_the_bits_it_always_had() {
    assert_golden(
        "dry drum",
        &scene("dry-r3", &[]),
        10_000,
        "e303353cbbcd4227b6c487f85be746de",
    );
}

#[test]
fn wet_drum_with_bridges_as_printed_has_the_bits_it_always_had() {
    let values = [
        ("radius", "3mm"),
        ("liquid", "4"),
        ("bridge-law", "as-printed"),
    ];
    assert_golden(
        "wet drum, bridges as printed",
        &scene("wet", &values),
        10_000,
        "ceff0b6a9a3697808bab092190de618d",
    );
}

#[test]
fn wet_drum_with_bridges_as_coded_has_the_bits_it_always_had() {
    let values = [
        ("radius", "3mm"),
        ("liquid", "4"),
        ("bridge-law", "as-coded"),
    ];
    assert_golden(
        "wet drum, bridges as coded",
        &scene("wet", &values),
        10_000,
        "c51d144585f77feb47303ca3e92be48e",
    );
}

#[test]
fn wet_drum_of_two_sizes_has_the_bits_it_always_had() {
    assert_golden(
        "wet drum of two sizes",
        &scene("two-sizes-wet-drum", &[]),
        10_000,
        "cdfb19399c9a0c22ca897c3d3ca7c99f",
    );
}

#[test]
fn polyhedra_whose_features_are_full_contacts_have_the_bits_they_always_had() {
    let scene = polyhedra("Full");
    assert_golden(
        "polyhedra, features in full",
        &scene,
        2000,
        "293bdd870839428e0f82fb9498de6c33",
    );
}

#[test]
fn polyhedra_whose_features_share_their_stiffness_have_the_bits_they_always_had() {
    let scene = polyhedra("Shared");
    assert_golden(
        "polyhedra, features share",
        &scene,
        2000,
        "b2b1927e686c147ffaec63859d284f9d",
    );
}

#[test]
fn polyhedra_whose_springs_are_implicit_have_the_bits_they_always_had() {
    let mut scene = polyhedra("Full");
    scene.set("integrator", "implicit").unwrap();
    assert_golden(
        "polyhedra, implicit springs and dashpots",
        &scene,
        1000,
        "2a45374a84a9e9e972ab037e69ac6dda",
    );
}

/// A drum of cells.
fn polyhedra(rule: &str) -> Scene {
    let text = r#"(
        title: "A drum of cells",
        materials: {"smooth": (friction: 0.1), "rough": (friction: 0.4)},
        container: Drum(radius_mm: 15, width_mm: 15, speed_rpm: 30, material: "rough"),
        grains: Voronoi(cell_mm: 4, rounding_mm: 0.3, solid_fraction: 0.7, bulk_fraction: 0.6, species: [
            (material: "smooth", share: 0.5), (material: "rough", share: 0.5),
        ]),
        law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500, features: RULE),
    )"#;
    Scene::parse("cells", &text.replace("RULE", rule)).unwrap_or_else(|error| panic!("{error}"))
}
