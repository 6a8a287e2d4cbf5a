//! The container as a VTK file of polygons (`.vtp`), as it stood at the start.
//!
//! In: a world. Out: a file with the faces of each wall, which look towards the grains and bear its
//! number as `wall`. A circle is a polygon of [`SIDES`] sides; a plane without bounds ends about one
//! size of the bed beyond it, the floor of a column where the grains may come to. Walls that only
//! move in themselves, as a drum does, stay where they are; a tube that is lifted, or a mesh, is
//! shown where it began. The triangles of a mesh look where their file has them look.

use super::vtk::{Array, DataSet};
use crate::run::Provenance;
use crate::world::{Container, Shape, Surface, World};
use glam::DVec3;
use std::f64::consts::TAU;
use std::io::{self, Write};

/// Sides of the polygon that stands for a circle.
const SIDES: u32 = 180;
/// The floor of a column reaches so many times its radius and height together from its axis.
const FLOOR: f64 = 2.0;

/// Writes the container of `world`, which comes `from` there, to `file`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_container(world: &World, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    let mesh = Mesh::of(world);
    let (points, faces) = (mesh.points.len(), mesh.ends.len());
    let parts = DataSet {
        kind: "PolyData",
        counts: vec![
            ("NumberOfPoints", points),
            ("NumberOfVerts", 0),
            ("NumberOfLines", 0),
            ("NumberOfStrips", 0),
            ("NumberOfPolys", faces),
        ],
        elements: vec![
            (
                "CellData",
                vec![Array::integers("wall", faces, || {
                    mesh.walls.iter().copied()
                })],
            ),
            (
                "Points",
                vec![Array::vectors("Points", points, || {
                    mesh.points.iter().copied()
                })],
            ),
            (
                "Polys",
                vec![
                    // Each face has points of its own.
                    Array::integers("connectivity", points, || 0..mesh.end()),
                    Array::integers("offsets", faces, || mesh.ends.iter().copied()),
                ],
            ),
        ],
    };
    parts.write(from, file)
}

/// The faces of all walls.
#[derive(Default)]
struct Mesh {
    /// The corners of one face after another's [m].
    points: Vec<DVec3>,
    /// Where the corners of each face end.
    ends: Vec<i32>,
    /// The wall of each face.
    walls: Vec<i32>,
}

impl Mesh {
    fn of(world: &World) -> Self {
        let mut mesh = Self::default();
        let bed = Bed::of(world);
        for (number, wall) in (0..).zip(&world.container.walls) {
            match &wall.surface {
                Surface::Mesh(part) => {
                    part.triangles()
                        .for_each(|triangle| mesh.face(number, triangle));
                }
                &Surface::Plane { point, normal } => {
                    mesh.face(number, plane(&world.container, &bed, point, normal));
                }
                &Surface::Cylinder { radius } => {
                    let half = match world.container.shape {
                        Shape::Drum { width, .. } => 0.5 * width,
                        _ => bed.reach,
                    };
                    mesh.band(number, |turn, end| {
                        let (sin, cos) = turn.sin_cos();
                        DVec3::new(radius * cos, radius * sin, half * end)
                    });
                }
                &Surface::Tube { radius, rim } => {
                    let height = match world.container.shape {
                        Shape::Column { height, .. } => height,
                        _ => bed.reach,
                    };
                    mesh.band(number, |turn, end| {
                        let (sin, cos) = turn.sin_cos();
                        DVec3::new(radius * cos, rim + 0.5 * height * (1.0 - end), radius * sin)
                    });
                }
            }
        }
        mesh
    }

    /// How many points there are.
    fn end(&self) -> i32 {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Adds a face of the wall `number`.
    fn face(&mut self, number: i32, corners: impl IntoIterator<Item = DVec3>) {
        let end = (self.end()..).zip(corners).map(|(index, corner)| {
            self.points.push(corner);
            index + 1
        });
        if let Some(end) = end.last() {
            self.ends.push(end);
            self.walls.push(number);
        }
    }

    /// Adds a closed band of the wall `number`; `corner` gives its places by the angle and by the
    /// end, −1 or 1.
    fn band(&mut self, number: i32, corner: impl Fn(f64, f64) -> DVec3) {
        for side in 0..SIDES {
            let [this, next] = [side, side + 1].map(angle);
            let corners = [(this, -1.0), (this, 1.0), (next, 1.0), (next, -1.0)];
            self.face(number, corners.map(|(turn, end)| corner(turn, end)));
        }
    }
}

/// Where corner number `side` of a circle is [rad].
fn angle(side: u32) -> f64 {
    TAU * f64::from(side % SIDES) / f64::from(SIDES)
}

/// Where the grains are.
struct Bed {
    middle: DVec3,
    /// As far from the middle planes without bounds are shown [m].
    reach: f64,
}

impl Bed {
    fn of(world: &World) -> Self {
        let grains = &world.grains;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (centre, radius) in grains.position.iter().zip(&grains.radius) {
            (low, high) = (low.min(centre - radius), high.max(centre + radius));
        }
        if grains.is_empty() {
            (low, high) = (DVec3::ZERO, DVec3::ONE);
        }
        Self {
            middle: 0.5 * (low + high),
            reach: (high - low).length(),
        }
    }
}

/// The part of a plane of `container` that is shown, round its outline as seen from the grains.
fn plane(container: &Container, bed: &Bed, point: DVec3, normal: DVec3) -> Vec<DVec3> {
    let (across, up) = normal.any_orthonormal_pair();
    match container.shape {
        Shape::Drum { radius, .. } if normal.z != 0.0 => {
            let turns = (0..SIDES).map(|side| angle(side).sin_cos());
            turns
                .map(|(sin, cos)| DVec3::Z * point.z + radius * (cos * across + sin * up))
                .collect()
        }
        Shape::Box { min, max } => {
            let (middle, half) = (0.5 * (min + max), 0.5 * (max - min));
            let on_it = middle - normal * normal.dot(middle - point);
            let reach = |axis: DVec3| axis * half.dot(axis.abs());
            square(on_it, reach(across), reach(up))
        }
        Shape::Column { radius, height } => {
            let reach = FLOOR * (radius + height);
            square(point, reach * across, reach * up)
        }
        Shape::Drum { .. } | Shape::Planes | Shape::Mesh { .. } => {
            let on_it = bed.middle - normal * normal.dot(bed.middle - point);
            square(on_it, bed.reach * across, bed.reach * up)
        }
    }
}

fn square(middle: DVec3, across: DVec3, up: DVec3) -> Vec<DVec3> {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    corners.map(|(a, b)| middle + a * across + b * up).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::world::build;

    /// Volume that the faces of a closed mesh hold, and their walls' normals looked at from inside.
    fn volume(mesh: &Mesh) -> f64 {
        let mut start = 0;
        let mut sum = 0.0;
        for &end in &mesh.ends {
            let corners = &mesh.points[start..end as usize];
            for pair in corners[1..].windows(2) {
                sum -= corners[0].dot(pair[0].cross(pair[1])) / 6.0;
            }
            start = end as usize;
        }
        sum
    }

    fn mesh_of(container: &str, grains: &str) -> Mesh {
        let text = format!(
            "(title: \"Walls\", materials: {{\"glass\": ()}}, container: {container}, grains: {grains})"
        );
        Mesh::of(&build(&Scene::parse("walls", &text).unwrap(), 1e-6))
    }

    #[test]
    fn faces_of_a_drum_and_of_a_box_close_and_look_inwards() {
        let scene = Scene::open("small-drum").unwrap();
        let world = build(&scene, 1e-6);
        let Shape::Drum { radius, width } = world.container.shape else {
            panic!("a drum");
        };
        let mesh = Mesh::of(&world);
        let sides = f64::from(SIDES);
        let area = 0.5 * sides * radius * radius * (TAU / sides).sin();
        assert!((volume(&mesh) / (area * width) - 1.0).abs() < 1e-12);
        assert_eq!(mesh.ends.len(), 180 + 2);
        let grain = "List([(position: (0.01, 0.01, 0.01), radius_mm: 1, material: \"glass\")])";
        let closed = "Box(min: (0, 0, 0), max: (0.02, 0.03, 0.05), material: \"glass\")";
        let mesh = mesh_of(closed, grain);
        assert_eq!(mesh.walls, [0, 1, 2, 3, 4, 5]);
        assert!((volume(&mesh) / (0.02 * 0.03 * 0.05) - 1.0).abs() < 1e-12);
    }
}
