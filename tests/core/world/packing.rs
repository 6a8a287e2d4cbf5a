//! Columns, boxes and drums of Voronoi cells, and lists of polyhedra: what worlds they become.

use glam::{DQuat, DVec3};
use grainfall::geometry::{Solid, sphere_volume};
use grainfall::scene::{Scene, SceneContainer, SceneGrains, SceneTube, StoredCells};
use grainfall::world::{
    self, Boundary, Packing, Polyhedra, Polyhedron, SpeciesId, Surface, Tessellation, World,
};
use std::fs;

fn world_of(scene: &Scene) -> World {
    scene.check().unwrap_or_else(|error| panic!("{error}"));
    world::build(scene, 1e-6)
}

/// The paper's column of this height with these changes.
fn column(height: &str, changes: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::open("column").unwrap();
    scene.set("height", height).unwrap();
    for (key, value) in changes {
        scene.set(key, value).unwrap();
    }
    scene
}

fn polyhedra(world: &World) -> &Polyhedra {
    world.polyhedra.as_deref().unwrap()
}

/// Corners of the core of grain `i` in the world.
fn corners(world: &World, i: usize) -> Vec<DVec3> {
    let polyhedra = polyhedra(world);
    let vertices = polyhedra.shape_of(i).vertices.iter();
    vertices
        .map(|x| polyhedra.orientation[i] * *x + world.grains.position[i])
        .collect()
}

fn count_of(world: &World, species: u16) -> usize {
    let labels = &world.grains.species;
    labels.iter().filter(|label| label.0 == species).count()
}

#[test]
fn the_papers_columns_have_the_papers_number_of_grains() {
    for (height, count) in [("1cm", 1963), ("30cm", 58_905), ("35cm", 68_722)] {
        assert_eq!(column(height, &[]).grain_count(), count);
    }
    let world = world_of(&column("1cm", &[]));
    assert_eq!(world.grains.len(), 1963);
    assert_eq!((count_of(&world, 0), count_of(&world, 1)), (1767, 196));
    // The cells' mean volume is a lattice cell but for the rough rim; the mass is that of the whole cells.
    let mass: f64 = world.grains.mass.iter().sum();
    let mean = mass / 1963.0 / 2650.0 / 8e-9;
    assert!((mean - 1.0).abs() < 0.02, "{mean}");
    assert_eq!(
        world_of(&column("1cm", &[("solid-fraction", "0.55")]))
            .grains
            .len(),
        1350
    );
}

#[test]
fn a_column_stands_on_the_floor_within_its_radius_and_touches_it() {
    let world = world_of(&column("1cm", &[]));
    let mut lowest = f64::INFINITY;
    for i in 0..world.grains.len() {
        let rounding = polyhedra(&world).shape_of(i).rounding;
        assert_eq!(rounding, 1e-4);
        let x = world.grains.position[i];
        assert!(DVec3::new(x.x, 0.0, x.z).length() <= 0.025 && x.y > 0.0 && x.y < 0.01);
        for corner in corners(&world, i) {
            // Rounding of a few numbers of the size of the column.
            assert!(corner.y >= rounding - 1e-16 && corner.y <= 0.01 - rounding + 1e-16);
            lowest = corner.y.min(lowest);
        }
    }
    assert!((lowest - 1e-4).abs() < 1e-16);
    let walls: Vec<&str> = world
        .container
        .walls
        .iter()
        .map(|w| w.name.as_str())
        .collect();
    assert_eq!(walls, ["floor"]);
}

#[test]
fn neighbours_touch_along_their_faces_and_do_not_overlap() {
    let tessellation =
        Tessellation::new(DVec3::ZERO, DVec3::splat(0.012), 2e-3, Boundary::Walls, 4);
    let rounding = 2e-4;
    let all: Vec<usize> = (0..tessellation.len()).collect();
    let bodies: Vec<(Solid, Solid)> = (tessellation.cells(&all).into_iter())
        .map(|cell| (cell.eroded(rounding).unwrap(), cell))
        .collect();
    let (mut touching, mut faces) = (0, 0);
    for (core, cell) in &bodies {
        for face in 0..cell.faces.len() {
            let plane = cell.plane(face);
            // The body is the core dilated by the rounding: it reaches up to the cell's face, which its neighbour shares,
            // and no farther. So cores are two roundings apart and bodies are at distance zero.
            let reach = core.vertices.iter().map(|x| plane.normal.dot(*x));
            let reach = reach.fold(f64::NEG_INFINITY, f64::max) + rounding;
            assert!(
                reach <= plane.offset + 1e-12 * 2e-3,
                "{}",
                reach - plane.offset
            );
            touching += usize::from(reach >= plane.offset - 1e-9 * 2e-3);
            faces += 1;
        }
        touching -= core.faces.len();
    }
    // Every face that the core still has touches, and a few more that it has lost lie within a billionth.
    assert!(touching * 100 < faces, "{touching} of {faces}");
}

#[test]
fn a_full_box_is_full() {
    let text = r#"(
        title: "A box", materials: {"stone": (), "wall": ()},
        container: Box(min: (0, 0, 0), max: (0.01, 0.02, 0.013), material: "wall"),
        grains: Voronoi(solid_fraction: 1, species: [(material: "stone")]),
    )"#;
    let world = world_of(&Scene::parse("box", text).unwrap());
    assert_eq!(world.grains.len(), 5 * 10 * 7);
    let filled: f64 = world.grains.mass.iter().sum::<f64>() / 2650.0;
    assert!((filled / (0.01 * 0.02 * 0.013) - 1.0).abs() < 1e-9);
    let half = text.replace("solid_fraction: 1", "solid_fraction: 1, bulk_fraction: 0.5");
    let scene = Scene::parse("box", &half).unwrap();
    let world = world_of(&scene);
    assert_eq!(world.grains.len(), scene.grain_count());
    assert!(world.grains.position.iter().all(|x| x.y < 0.012));
}

#[test]
fn a_tube_and_a_drum_hold_whole_bodies() {
    let held = Scene::load("tests/core/scene/good/held-column.ron").unwrap();
    let world = world_of(&held);
    assert_eq!(
        world.container.walls[1].surface,
        Surface::Tube {
            radius: 0.025,
            rim: 0.0
        }
    );
    assert_eq!(world.container.walls[1].motion.velocity, 0.05 * DVec3::Y);
    let drum = r#"(
        title: "A drum", materials: {"stone": (), "wall": ()},
        container: Drum(material: "wall"),
        grains: Voronoi(cell_mm: 6, rounding_mm: 0.5, species: [(material: "stone")]),
    )"#;
    let drum = Scene::parse("drum", drum).unwrap();
    let drum = world_of(&drum);
    assert!((drum.grains.len() as f64 / (0.8 * 0.35 * 1170.7) - 1.0).abs() < 0.02);
    assert!(drum.grains.position.iter().all(|x| x.y < 0.0));
    for world in [world, drum] {
        for i in 0..world.grains.len() {
            let rounding = polyhedra(&world).shape_of(i).rounding;
            for corner in corners(&world, i) {
                for wall in &world.container.walls {
                    let room = wall.surface.distance(corner).0;
                    assert!(room >= rounding - 1e-15, "{}: {room}", wall.name);
                }
            }
        }
    }
}

#[test]
fn no_grain_is_smaller_than_the_time_step_counts_on() {
    let mut held = column("2cm", &[]);
    let free = held.clone();
    let SceneContainer::Column { tube, .. } = &mut held.container else {
        panic!("no column");
    };
    *tube = Some(SceneTube {
        speed: 0.1,
        material: "floor".to_owned(),
        rim: 0.0,
    });
    for scene in [free, held] {
        let SceneGrains::Voronoi(cells) = &scene.grains else {
            panic!("no cells");
        };
        let counted_on = sphere_volume(cells.smallest_radius(&scene.container));
        let world = world_of(&scene);
        let volumes = polyhedra(&world).shapes.iter().map(|shape| shape.volume);
        let smallest = volumes.fold(f64::INFINITY, f64::min);
        assert!(smallest >= counted_on, "{smallest} < {counted_on}");
        assert!(smallest < 3.0 * counted_on, "{smallest} > 3 · {counted_on}");
    }
}

#[test]
fn grains_are_well_made() {
    let world = world_of(&column("2cm", &[("rounding", "0.4mm")]));
    let polyhedra = polyhedra(&world);
    for i in 0..world.grains.len() {
        let shape = polyhedra.shape_of(i);
        let euler = shape.vertices.len() + shape.faces.len() - shape.edges.len();
        assert_eq!(euler, 2);
        assert!(shape.rounding <= 4e-4 && shape.rounding >= 1e-4);
        assert!(polyhedra.orientation[i].is_normalized());
        assert_eq!(world.grains.radius[i], shape.bounding_radius());
        assert!(
            shape
                .vertices
                .iter()
                .all(|x| x.length() + shape.rounding <= world.grains.radius[i])
        );
        assert_eq!(world.grains.mass[i], shape.volume * 2650.0);
        // The largest principal moment of a solid is at most the sum of the others.
        let moments = polyhedra.inertia[i];
        assert!(2.0 * moments.max_element() < moments.element_sum());
    }
}

#[test]
fn the_seed_decides_and_the_mix_changes_labels_alone() {
    let scene = column("1cm", &[]);
    let first = world_of(&scene);
    assert_eq!(world_of(&scene), first);
    let other = world_of(&column("1cm", &[("seed", "2")]));
    assert_ne!(other.grains.position, first.grains.position);
    let rougher = world_of(&column("1cm", &[("mix", "0.3")]));
    assert_eq!(rougher.grains.position, first.grains.position);
    assert_eq!(count_of(&rougher, 1), 589);
    let mut changed = first.clone();
    world::set_share(&mut changed, &scene, SpeciesId(1), 0.3);
    assert_eq!(changed.grains, rougher.grains);
    assert_eq!(changed.polyhedra, rougher.polyhedra);
    world::set_share(&mut changed, &scene, SpeciesId(1), 0.1);
    assert_eq!(changed.grains, first.grains);
}

/// Changes only with the geometry's arithmetic or the random numbers, never with the machine or the
/// number of threads.
#[test]
fn a_packing_is_the_same_everywhere() {
    let world = world_of(&Scene::open("small-column").unwrap());
    let bytes = postcard::to_stdvec(&(&world.grains, &world.polyhedra)).unwrap();
    // The last byte says how their motion is integrated, which is no part of a packing.
    let hash = blake3::hash(&bytes[..bytes.len() - 1]).to_hex();
    assert_eq!(&hash[..16], "2deca73b30a07135");
}

#[test]
fn relabelling_a_spinning_polyhedron_keeps_its_spin() {
    let mut scene = column("1cm", &[]);
    scene.materials[1].density = 5300.0;
    let mut world = world_of(&scene);
    let spin = DVec3::new(1.0, 2.0, 3.0);
    for i in 0..world.grains.len() {
        world.grains.spin[i] = spin;
        world.polyhedra.as_mut().unwrap().set_spin(i, spin);
    }
    let energy = world.kinetic_energy();
    world::set_share(&mut world, &scene, SpeciesId(1), 1.0);
    let mass: f64 = world.grains.mass.iter().sum();
    for i in 0..world.grains.len() {
        let shape = polyhedra(&world).shape_of(i);
        assert_eq!(world.grains.mass[i], shape.volume * 5300.0);
        assert!((polyhedra(&world).spin_of(i) - spin).length() < 1e-13);
        let mean = polyhedra(&world).inertia[i].element_sum() / 3.0;
        assert!((world.grains.inertia[i] / mean - 1.0).abs() < 1e-14);
    }
    assert!(mass > 0.0 && world.kinetic_energy() > 1.8 * energy);
}

#[test]
fn listed_polyhedra_stand_as_listed() {
    let scene = Scene::load("tests/core/scene/good/every-shape.ron").unwrap();
    let world = world_of(&scene);
    let polyhedra = polyhedra(&world);
    // The first and the last are the same box.
    assert_eq!(polyhedra.shapes.len(), 5);
    assert_eq!(*polyhedra.shape, [0, 1, 2, 3, 4, 0]);
    assert_eq!(polyhedra.shape_of(4), &Polyhedron::sphere(0.003));
    let volumes = [
        2e-6,
        1e-6 / 72.0_f64.sqrt(),
        1.5 * 3.0_f64.sqrt() * 25e-6 * 0.01,
    ];
    for (i, volume) in volumes.into_iter().enumerate() {
        assert!(
            (polyhedra.shape_of(i).volume / volume - 1.0).abs() < 1e-12,
            "{i}"
        );
        assert!((world.grains.mass[i] / (2650.0 * volume) - 1.0).abs() < 1e-12);
    }
    assert_eq!(polyhedra.orientation[0], DQuat::IDENTITY);
    // A quaternion (0, 0, 3, 4) / 5 takes x to 0.28 x + 0.96 y.
    let SceneGrains::List(list) = &scene.grains else {
        panic!("no list");
    };
    let turned = list[2].orientation * DVec3::X;
    assert!((turned - DVec3::new(0.28, 0.96, 0.0)).length() < 1e-15);
    let axis = DVec3::new(1.0, 1.0, 0.0).normalize();
    let turn = list[1].orientation;
    assert!((turn * axis - axis).length() < 1e-15);
    assert!((turn.w - 15.0_f64.to_radians().cos()).abs() < 1e-15);
    let spin = polyhedra.spin_of(1);
    assert!((spin - DVec3::new(0.0, 2.0, 0.0)).length() < 1e-14);
    assert_eq!(world.grains.position[3], DVec3::new(0.15, 0.02, 0.0));
    // The lowest corners of the box stand a rounding above the floor.
    let lowest = corners(&world, 0)
        .iter()
        .map(|x| x.y)
        .fold(f64::INFINITY, f64::min);
    assert!((lowest - 1e-4).abs() < 1e-17);
}

#[test]
fn columns_take_the_papers_values_where_a_scene_leaves_them_out() {
    let scene = Scene::load("tests/core/scene/good/held-column.ron").unwrap();
    let paper = Scene::open("column").unwrap();
    assert_eq!(scene.law, paper.law);
    assert_eq!(scene.gravity, paper.gravity);
    assert_eq!(
        (scene.materials[0].density, scene.materials[0].restitution),
        (2650.0, 0.1)
    );
    let (SceneGrains::Voronoi(cells), SceneGrains::Voronoi(of_paper)) =
        (&scene.grains, &paper.grains)
    else {
        panic!("no cells");
    };
    assert_eq!(
        (cells.rounding, cells.solid_fraction),
        (of_paper.rounding, of_paper.solid_fraction)
    );
    assert!(matches!(
        scene.container,
        SceneContainer::Column { radius: 0.025, .. }
    ));
}

#[test]
fn every_case_of_the_paper_can_be_set() {
    let scene = column(
        "30cm",
        &[
            ("mu11", "0.2"),
            ("mu22", "0.8"),
            ("mu-wall", "0.3"),
            ("mix", "0.5"),
            ("normal-stiffness", "400"),
            ("features", "shared"),
        ],
    );
    let world = world::build_packed(&scene, 1e-6, Vec::new());
    let [smooth, rough, floor] =
        ["smooth", "rough", "floor"].map(|name| world.materials.find(name).unwrap());
    let friction = |a, b| world.materials.pair(a, b).friction;
    assert_eq!(
        (friction(smooth, smooth), friction(rough, rough)),
        (0.2, 0.8)
    );
    assert!((friction(smooth, rough) - 0.32).abs() < 1e-15);
    assert_eq!(
        (friction(smooth, floor), friction(rough, floor)),
        (0.3, 0.3)
    );
    let mut drum = Scene::open("dry-r3").unwrap();
    for (key, value) in [
        ("height", "1cm"),
        ("mix", "0.5"),
        ("mu22", "0.5"),
        ("solid-fraction", "0.5"),
        ("features", "full"),
        ("normal-stiffness", "1"),
    ] {
        assert!(drum.set(key, value).is_err(), "{key}");
    }
}

/// A scene of the grains in the file of this name, in a column of 1 cm.
fn of_file(name: &str, more: &str) -> String {
    format!(
        r#"(
            title: "From a file", materials: {{"smooth": (friction: 0.1), "rough": (), "floor": ()}},
            container: Column(height_mm: 10, material: "floor"),
            grains: Voronoi(
                packing: "{name}", {more}
                species: [(material: "smooth", share: 0.9), (material: "rough", share: 0.1)],
            ),
        )"#
    )
}

#[test]
fn grains_from_a_file_are_those_that_were_cut() {
    let folder = tempfile::tempdir().unwrap();
    let scene = column("1cm", &[]);
    let grains = Packing::new(&scene).unwrap().finish();
    fs::write(
        folder.path().join("h1.pack"),
        StoredCells::encode(&grains).unwrap(),
    )
    .unwrap();
    let file = folder.path().join("scene.ron");
    fs::write(&file, of_file("h1.pack", "")).unwrap();
    let read = Scene::load(&file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read.grain_count(), 1963);
    assert!(Packing::new(&read).is_none());
    let (cut, stored) = (world_of(&scene), world_of(&read));
    assert_eq!(cut.grains, stored.grains);
    assert_eq!(cut.polyhedra, stored.polyhedra);
    let summary = serde_json::to_string(&read).unwrap();
    assert!(
        summary.len() < 3000 && summary.contains("h1.pack"),
        "{summary}"
    );
    assert_eq!(serde_json::from_str::<Scene>(&summary).unwrap(), read);
    let mut smaller = read.clone();
    let message = smaller.set("radius", "2cm").unwrap_err().to_string();
    assert!(message.contains("not inside"), "{message}");
    let message = smaller.set("cell", "2mm").unwrap_err().to_string();
    assert!(message.contains("cuts Voronoi cells"), "{message}");
}

#[test]
fn a_scene_that_was_kept_says_which_file_its_grains_are_missing_from() {
    let folder = tempfile::tempdir().unwrap();
    let grains = Packing::new(&Scene::open("small-column").unwrap())
        .unwrap()
        .finish();
    let cells = folder.path().join("cells.pack");
    fs::write(&cells, StoredCells::encode(&grains).unwrap()).unwrap();
    let file = folder.path().join("scene.ron");
    let wide = of_file("cells.pack", "").replace("height_mm: 10", "radius_mm: 20, height_mm: 25");
    fs::write(&file, wide).unwrap();
    let kept = serde_json::to_string(&Scene::load(&file).unwrap()).unwrap();
    fs::write(&cells, StoredCells::encode(&grains[1..]).unwrap()).unwrap();
    let changed = serde_json::from_str::<Scene>(&kept)
        .unwrap_err()
        .to_string();
    fs::remove_file(&cells).unwrap();
    let gone = serde_json::from_str::<Scene>(&kept)
        .unwrap_err()
        .to_string();
    for (message, reason) in [(changed, "other grains"), (gone, "cannot be read")] {
        let named = format!("{}, which", cells.display());
        assert!(
            message.contains(&named) && message.contains(reason),
            "{message}"
        );
    }
}

#[test]
fn files_that_hold_no_grains_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let grains = Packing::new(&Scene::open("small-column").unwrap())
        .unwrap()
        .finish();
    let whole = StoredCells::encode(&grains).unwrap();
    let mut flipped = whole.clone();
    flipped[100] ^= 1;
    let mut older = whole.clone();
    older[12] += 1;
    let mut absurd = grains.clone();
    absurd[0].shape.faces[0][0] = 9999;
    let cases = [
        ("short", whole[..50].to_vec(), "", "is damaged"),
        ("empty", Vec::new(), "", "is no packing of this version"),
        ("flipped", flipped, "", "is damaged"),
        ("older", older, "", "is no packing of this version"),
        (
            "absurd",
            StoredCells::encode(&absurd).unwrap(),
            "",
            "is damaged",
        ),
        ("none", StoredCells::encode(&[]).unwrap(), "", "is damaged"),
        (
            "whole",
            whole.clone(),
            "cell_mm: 2,",
            "contradicts `packing`",
        ),
        ("high", whole, "", "not inside of the container"),
    ];
    for (name, bytes, more, expected) in cases {
        fs::write(folder.path().join(name), bytes).unwrap();
        let text = of_file(name, more).replace(
            "height_mm: 10",
            "radius_mm: 10, height_mm: 10, tube: (speed: 1)",
        );
        let file = folder.path().join("scene.ron");
        fs::write(&file, text).unwrap();
        let message = Scene::load(&file).unwrap_err().to_string();
        assert!(message.contains(expected), "{name}: {message}");
        assert!(message.contains("grains"), "{name}: {message}");
    }
}
