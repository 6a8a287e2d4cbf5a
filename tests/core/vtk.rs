//! Grains as VTK points and cells, read back from the bytes of the file.

use glam::{DQuat, DVec3};
use grainfall::output::write_grains;
use grainfall::scene::Scene;
use grainfall::simulation::Provenance;
use grainfall::world::{Polyhedra, Polyhedron, World, build};

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

/// A `.vtp` or `.vtu` file: its header and the bytes that follow the mark `_`.
pub struct File {
    pub header: String,
    data: Vec<u8>,
}

impl File {
    fn of(world: &World) -> Self {
        let mut bytes = Vec::new();
        let scene = Scene::open("bouncing-grain").unwrap();
        let from = Provenance::of(&scene, world);
        write_grains(world, &from, &mut bytes).unwrap();
        Self::parse(&bytes)
    }

    pub fn parse(bytes: &[u8]) -> Self {
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        Self {
            header: String::from_utf8(bytes[..at].to_vec()).unwrap(),
            data: bytes[at..].to_vec(),
        }
    }

    /// The arrays within `<element> … </element>`, by name and in their order.
    pub fn names(&self, element: &str) -> Vec<&str> {
        let start = self.header.find(&format!("<{element}>")).unwrap();
        let end = self.header.find(&format!("</{element}>")).unwrap();
        let arrays = self.header[start..end].split("Name=\"").skip(1);
        arrays.map(|rest| rest.split('"').next().unwrap()).collect()
    }

    /// The eight bytes of each number of the array called `name`.
    fn numbers(&self, name: &str) -> Vec<[u8; 8]> {
        let start = self.header.find(&format!("Name=\"{name}\"")).unwrap();
        let rest = &self.header[start..];
        let offset = rest.split("offset=\"").nth(1).unwrap();
        let offset: usize = offset.split('"').next().unwrap().parse().unwrap();
        let word = |at: usize| self.data[at..at + 8].try_into().unwrap();
        let length = u64::from_le_bytes(word(offset)) as usize;
        (0..length / 8).map(|k| word(offset + 8 + 8 * k)).collect()
    }

    pub fn integers(&self, name: &str) -> Vec<i64> {
        self.numbers(name)
            .into_iter()
            .map(i64::from_le_bytes)
            .collect()
    }

    pub fn floats(&self, name: &str) -> Vec<f64> {
        self.numbers(name)
            .into_iter()
            .map(f64::from_le_bytes)
            .collect()
    }
}

#[test]
fn polyhedra_are_cells_of_their_solids_with_what_each_grain_has() {
    let file = File::of(&cube_and_sphere());
    assert!(
        file.header
            .contains("NumberOfPoints=\"9\" NumberOfCells=\"2\"")
    );
    let points = file.floats("points");
    let placed = points.chunks(3).map(DVec3::from_slice).collect::<Vec<_>>();
    // The faces moved out by 0.2 mm meet at ± 1 mm; a quarter turn about y takes (x, y, z) to (z, y, −x).
    for (k, point) in placed[..8].iter().enumerate() {
        let side = |bit: usize| if k & bit == 0 { -1e-3 } else { 1e-3 };
        let expected = DVec3::new(0.01 + side(4), 0.02 + side(2), 0.03 - side(1));
        assert!((*point - expected).length() < 1e-16, "{point} {expected}");
    }
    assert_eq!(placed[8], DVec3::new(-0.01, 0.0, 0.0));
    assert_eq!(file.integers("connectivity"), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(file.integers("offsets"), [8, 9]);
    let faces = file.integers("faces");
    assert_eq!(faces[..6], [6, 4, 0, 4, 6, 2]);
    assert_eq!(faces.len(), 1 + 6 * 5);
    // The sphere is a point and has none.
    assert_eq!(file.integers("faceoffsets"), [31, -1]);
    assert_eq!(file.floats("radius"), [1e-3, 0.5e-3]);
    assert_eq!(file.floats("rounding"), [0.2e-3, 0.5e-3]);
    assert_eq!(file.floats("velocity"), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    assert_eq!(file.integers("species").len(), 2);
}

#[test]
fn spheres_are_points_with_what_each_grain_has() {
    let mut world = cube_and_sphere();
    world.polyhedra = None;
    let file = File::of(&world);
    assert!(file.header.contains("type=\"PolyData\""), "{}", file.header);
    assert!(
        file.header
            .contains("NumberOfPoints=\"2\" NumberOfVerts=\"2\"")
    );
    assert_eq!(file.floats("points"), [0.01, 0.02, 0.03, -0.01, 0.0, 0.0]);
    assert_eq!(file.integers("connectivity"), [0, 1]);
    assert_eq!(file.integers("offsets"), [1, 2]);
    assert_eq!(file.floats("radius"), [1e-3, 0.5e-3]);
    assert_eq!(file.floats("velocity"), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    assert_eq!(file.integers("species").len(), 2);
}
