//! Containers from STL files: the shipped one, units, places, and what is filled.

use crate::meshes::{drum, lifter_drum, stl};
use glam::DVec3;
use grainfall::scene::{Scene, SceneContainer, SceneMesh};
use grainfall::world::{Shape, Surface, World, build};
use std::fs;
use std::path::Path;

const SHIPPED: &str = "scenes/meshes/drum-with-lifters.ron";

fn shipped() -> Scene {
    Scene::load(Path::new(env!("CARGO_MANIFEST_DIR")).join(SHIPPED)).unwrap()
}

fn mesh_of(scene: &Scene) -> &SceneMesh {
    let SceneContainer::Mesh { surface, .. } = &scene.container else {
        panic!("a mesh");
    };
    surface
}

/// Distance of the nearest wall from each grain's surface [m].
fn gaps(world: &World) -> Vec<f64> {
    let grains = world.grains.position.iter().zip(&world.grains.radius);
    let gap = |(x, r): (&DVec3, &f64)| {
        let walls = world.container.walls.iter();
        let distances = walls.map(|wall| wall.surface.distance(*x).0);
        distances.fold(f64::INFINITY, f64::min) - r
    };
    grains.map(gap).collect()
}

#[test]
fn shipped_mesh_is_that_of_its_formula_and_is_filled_inside() {
    let scene = shipped();
    let (found, wanted) = (mesh_of(&scene).triangles(), lifter_drum());
    assert_eq!(found.len(), wanted.len());
    for (a, b) in found.iter().flatten().zip(wanted.iter().flatten()) {
        // Single precision of 3 cm.
        assert!((*a - *b).length() < 4e-9, "{a} {b}");
    }
    let world = build(&scene, 1e-5);
    assert_eq!(world.grains.len(), 300);
    // Rim, two plates, and the six sides of each lifter.
    assert_eq!(world.container.walls.len(), 3 + 6 * 6);
    assert!(gaps(&world).iter().all(|gap| *gap > 0.0));
    for x in &world.grains.position {
        let angle = f64::atan2(x.y, x.x);
        let from_lifter = (angle.to_degrees() / 60.0 - (angle.to_degrees() / 60.0).round()) * 60.0;
        let rho = x.truncate().length();
        let beside = rho * from_lifter.to_radians().sin();
        assert!(rho < 0.03 && x.z.abs() < 0.0075, "inside: {x}");
        assert!(rho < 0.024 || beside.abs() > 0.00125, "in no lifter: {x}");
    }
    world.check().unwrap();
}

#[test]
fn record_of_a_scene_holds_its_triangles() {
    let scene = shipped();
    let stored = serde_json::to_string(&scene).unwrap();
    assert!(!stored.contains("lifters.stl"));
    assert_eq!(serde_json::from_str::<Scene>(&stored).unwrap(), scene);
    // One that somebody broke is refused.
    let SceneContainer::Mesh { surface, .. } = &scene.container else {
        panic!("a mesh");
    };
    let mut triangles = surface.triangles().to_vec();
    triangles[5][1] = triangles[5][0];
    let broken = serde_json::to_string(&triangles).unwrap();
    let error = serde_json::from_str::<SceneMesh>(&broken).unwrap_err();
    assert!(
        error.to_string().contains("triangle 6 has no area"),
        "{error}"
    );
}

#[test]
fn scale_is_the_unit_of_the_file_and_a_room_bounds_the_filling() {
    let folder = tempfile::tempdir().unwrap();
    let millimetres = drum(30.0, 12.0, 60);
    fs::create_dir(folder.path().join("walls")).unwrap();
    fs::write(folder.path().join("walls/drum.stl"), stl(&millimetres)).unwrap();
    let scene = |more: &str| {
        let text = format!(
            "(title: \"mm\", materials: {{\"glass\": ()}}, container: Mesh(file: \"walls/drum.stl\", scale: 0.001, material: \
             \"glass\"{more}), grains: Fill(count: 40, species: [(radius_mm: 1, material: \"glass\")]))"
        );
        let path = folder.path().join("scene.ron");
        fs::write(&path, text).unwrap();
        Scene::load(&path).unwrap()
    };
    let whole = scene("");
    let half = 0.5 * std::f64::consts::TAU / 60.0;
    let ends = 0.03 * (1.0 + half * half / 3.0);
    let area = 0.5 * 60.0 * ends * ends * (2.0 * half).sin();
    assert!((mesh_of(&whole).volume() / (area * 0.012) - 1.0).abs() < 1e-6);
    let world = build(&whole, 1e-5);
    let Shape::Mesh { min, max } = world.container.shape else {
        panic!("a mesh");
    };
    assert!((max - DVec3::new(ends, ends, 0.006)).length() < 1e-4 && (min + max).length() < 1e-4);
    assert!(matches!(world.container.walls[0].surface, Surface::Mesh(_)));
    let low = world
        .grains
        .position
        .iter()
        .map(|x| x.y)
        .fold(f64::INFINITY, f64::min);
    assert!(low < -0.025, "from below: {low}");
    let world = build(
        &scene(", room: (min: (0, 0, -0.006), max: (0.03, 0.03, 0.006))"),
        1e-5,
    );
    assert!(world.grains.position.iter().all(|x| x.x > 0.0 && x.y > 0.0));
    assert!(gaps(&world).iter().all(|gap| *gap > 0.0));
}
