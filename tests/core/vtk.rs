//! Grains, contacts, shapes and walls as VTK files, read back from their bytes.

use crate::vtk_file::File;
use glam::{DQuat, DVec3};
use grainfall::output::{write_contacts, write_container, write_grains, write_shapes};
use grainfall::run::Provenance;
use grainfall::scene::Scene;
use grainfall::solver::{Solver, advise, force_terms};
use grainfall::world::{Contact, Partner, Polyhedra, Polyhedron, World, build};
use std::io;

/// A cube whose half edge is 1 mm when rounded by 0.2 mm, turned by a quarter about y, and a sphere
/// of 0.5 mm.
fn cube_and_sphere() -> World {
    let text = r#"(
        title: "Two",
        materials: {"glass": ()},
        container: Nothing,
        grains: List([
            (position: (0.01, 0.02, 0.03), radius_mm: 1, velocity: (1, 2, 3), material: "glass"),
            (position: (-0.01, 0, 0), radius_mm: 0.5, material: "glass"),
        ]),
    )"#;
    let mut world = build(&Scene::parse("two", text).unwrap(), 1e-6);
    let corner = |k: i32| {
        let side = |bit: i32| if k & bit == 0 { -0.8e-3 } else { 0.8e-3 };
        DVec3::new(side(1), side(2), side(4))
    };
    let cube = Polyhedron {
        vertices: (0..8).map(corner).collect(),
        edges: Vec::new(),
        faces: vec![
            vec![0, 4, 6, 2],
            vec![1, 3, 7, 5],
            vec![0, 1, 5, 4],
            vec![2, 6, 7, 3],
            vec![0, 2, 3, 1],
            vec![4, 5, 7, 6],
        ],
        rounding: 0.2e-3,
        volume: 8e-9,
        gyration: DVec3::splat(1e-6 / 3.0 * 2.0),
    };
    let turn = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    let (shapes, bodies) = (
        [cube, Polyhedron::sphere(0.5e-3)],
        [(0, turn), (1, DQuat::IDENTITY)],
    );
    let polyhedra = Polyhedra::of_grains(&world.grains, shapes, &bodies);
    world.polyhedra = Some(Box::new(polyhedra));
    world
}

/// What writes a file of a world.
type Writing = fn(&World, &Provenance, &mut dyn io::Write) -> io::Result<()>;

fn written(world: &World, write: Writing) -> File {
    let mut bytes = Vec::new();
    let scene = Scene::open("bouncing-grain").unwrap();
    let from = Provenance::of(&scene, world);
    write(world, &from, &mut bytes).unwrap();
    File::parse(&bytes)
}

/// Exact in 32 bits, or as near as these are.
fn near(found: &[DVec3], expected: &[DVec3]) -> bool {
    let close = |(a, b): (&DVec3, &DVec3)| (*a - *b).length() <= 1e-7 * b.length();
    found.len() == expected.len() && found.iter().zip(expected).all(close)
}

#[test]
fn shapes_and_axes_together_are_the_solids_where_they_are() {
    let world = cube_and_sphere();
    let shapes = written(&world, |world, from, file| {
        write_shapes(world, world.polyhedra.as_ref().unwrap(), from, file)
    });
    let counts = "NumberOfPoints=\"9\" NumberOfCells=\"2\"";
    assert!(shapes.header.contains(counts), "{}", shapes.header);
    let grains = written(&world, write_grains);
    let (points, centres) = (shapes.vectors("Points"), grains.vectors("Points"));
    let axes = grains.vectors("tensor");
    let placed = points.iter().zip(shapes.integers("id")).map(|(p, id)| {
        let id = id as usize;
        let [a, b, c] = [0, 1, 2].map(|k| axes[3 * id + k]);
        centres[id] + p.x * a + p.y * b + p.z * c
    });
    let placed: Vec<DVec3> = placed.collect();
    // The faces moved out by 0.2 mm meet at ± 1 mm; a quarter turn about y takes (x, y, z) to (z, y, −x).
    for (k, point) in placed[..8].iter().enumerate() {
        let side = |bit: usize| if k & bit == 0 { -1e-3 } else { 1e-3 };
        let expected = DVec3::new(0.01 + side(4), 0.02 + side(2), 0.03 - side(1));
        assert!((*point - expected).length() < 4e-9, "{point} {expected}");
    }
    assert!(near(&placed[8..], &[DVec3::new(-0.01, 0.0, 0.0)]));
    let all: Vec<i32> = (0..9).collect();
    assert_eq!(shapes.integers("connectivity"), all);
    assert_eq!(shapes.integers("offsets"), [8, 9]);
    assert_eq!(shapes.bytes("types"), [42, 1]);
    let faces = shapes.integers("faces");
    assert_eq!(faces[..6], [6, 4, 0, 4, 6, 2]);
    assert_eq!(faces.len(), 1 + 6 * 5);
    // The sphere is a point and has none.
    assert_eq!(shapes.integers("faceoffsets"), [31, -1]);
    let rounding = shapes.floats("rounding");
    assert_eq!(
        [rounding[0], rounding[7], rounding[8]],
        [0.2e-3, 0.2e-3, 0.5e-3]
    );
    assert_eq!(grains.floats("radius"), [1e-3, 0.5e-3]);
    assert_eq!(grains.floats("v"), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
}

#[test]
fn grains_are_points_with_what_each_has() {
    let mut world = cube_and_sphere();
    world.polyhedra = None;
    world.grains.spin[1] = DVec3::new(4.0, 5.0, 6.0);
    world.grains.force[0] = DVec3::new(0.5, 0.25, -0.125);
    world.contacts.push(Contact {
        grain: 0,
        partner: Partner::Grain(1),
        spring: DVec3::ZERO,
        stiffness: 0.0,
        rolling: DVec3::ZERO,
        force: DVec3::ZERO,
        touching: true,
        bridge: None,
    });
    let file = written(&world, write_grains);
    let first = file.header.find("<VTKFile type=\"PolyData\"").unwrap();
    assert_eq!(&file.header[..first], "<?xml version=\"1.0\"?>\n");
    let counts = "NumberOfPoints=\"2\" NumberOfVerts=\"2\"";
    assert!(file.header.contains(counts), "{}", file.header);
    let names = [
        "id",
        "shapetype",
        "radius",
        "v",
        "omega",
        "f",
        "coordination",
    ];
    assert_eq!(file.names("PointData"), names);
    assert_eq!(file.floats("Points"), [0.01, 0.02, 0.03, -0.01, 0.0, 0.0]);
    assert_eq!(file.integers("connectivity"), [0, 1]);
    assert_eq!(file.integers("offsets"), [1, 2]);
    assert_eq!(file.integers("id"), [0, 1]);
    assert_eq!(file.integers("shapetype"), [0, 0]);
    assert_eq!(file.floats("radius"), [1e-3, 0.5e-3]);
    assert_eq!(file.floats("v"), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    assert_eq!(file.floats("omega"), [0.0, 0.0, 0.0, 4.0, 5.0, 6.0]);
    assert_eq!(file.floats("f"), [0.5, 0.25, -0.125, 0.0, 0.0, 0.0]);
    assert_eq!(file.integers("coordination"), [1, 1]);
    assert!(file.header.contains("Name=\"TimeValue\""));
}

/// A wet drum after a while.
fn wet_drum() -> World {
    let mut scene = Scene::open("small-drum").unwrap();
    scene.set("liquid", "1").unwrap();
    let mut world = build(&scene, advise(&scene).time_step);
    Solver::new(1).advance(&mut world, 3000).unwrap();
    world
}

#[test]
fn contacts_add_up_to_the_force_on_each_grain() {
    let world = wet_drum();
    let file = written(&world, write_contacts);
    let (first, second) = (file.integers("id1"), file.integers("id2"));
    let (along, across) = (
        file.vectors("force_normal"),
        file.vectors("force_tangential"),
    );
    let mut sums = vec![DVec3::ZERO; world.grains.len()];
    let mut walls = 0;
    for (k, contact) in world.contacts.iter().enumerate() {
        assert_eq!(first[k] as u32, contact.grain);
        let force = along[k] + across[k];
        assert!((force - contact.force).length() <= 1e-6 * contact.force.length());
        sums[contact.grain as usize] += force;
        match contact.partner {
            Partner::Grain(j) => {
                assert_eq!(second[k] as u32, j);
                sums[j as usize] -= force;
            }
            Partner::Wall(w) => {
                walls += 1;
                assert_eq!(second[k], -1 - w.cast_signed());
            }
        }
    }
    assert!(walls > 0 && walls < first.len());
    for (sum, force) in sums.iter().zip(&world.grains.force) {
        assert!((*sum - *force).length() <= 1e-6 * (force.length() + 1e-3));
    }
}

#[test]
fn contacts_are_lines_with_the_gap_and_the_bridge_of_each() {
    let world = wet_drum();
    let file = written(&world, write_contacts);
    let (points, ends) = (file.vectors("point"), file.vectors("Points"));
    let (normals, along) = (file.vectors("normal"), file.vectors("force_normal"));
    let (overlap, bridges) = (file.floats("overlap"), file.floats("bridge_volume"));
    assert!(
        file.header
            .contains(&format!("NumberOfLines=\"{}\"", points.len()))
    );
    assert_eq!(file.integers("offsets").len(), points.len());
    for (k, contact) in world.contacts.iter().enumerate() {
        let term = force_terms(&world, contact)[0];
        assert!(near(&points[k..=k], &[term.point]));
        assert!((normals[k] - term.normal).length() < 1e-6);
        assert!(along[k].cross(normals[k]).length() <= 1e-6 * along[k].length());
        assert!((f64::from(overlap[k]) - term.overlap).abs() <= 1e-7 * term.overlap.abs());
        let volume = contact.bridge.as_ref().map_or(0.0, |bridge| bridge.volume);
        assert_eq!(bridges[k], volume as f32);
        assert!(near(
            &ends[2 * k..=2 * k],
            &[world.grains.position[contact.grain as usize]]
        ));
    }
    assert!(
        overlap.iter().any(|overlap| *overlap < 0.0),
        "bridges over gaps"
    );
    let dry = cube_and_sphere();
    let none = written(
        &World {
            polyhedra: None,
            ..dry
        },
        write_contacts,
    );
    assert!(!none.header.contains("bridge_volume") && none.integers("id1").is_empty());
}

#[test]
fn walls_are_polygons_with_their_numbers() {
    let file = written(&wet_drum(), write_container);
    let walls = file.integers("wall");
    let count = |wall| walls.iter().filter(|number| **number == wall).count();
    assert_eq!([0, 1, 2].map(count), [180, 1, 1], "rim and two plates");
    let radius = file
        .vectors("Points")
        .iter()
        .map(|p| p.truncate().length())
        .fold(0.0, f64::max);
    let rim = match wet_drum().container.shape {
        grainfall::world::Shape::Drum { radius, .. } => radius,
        other => panic!("{other:?}"),
    };
    assert!((radius / rim - 1.0).abs() < 1e-6);
    assert_eq!(file.integers("offsets").last(), Some(&(4 * 180 + 2 * 180)));
}
