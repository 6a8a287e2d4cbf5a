//! Polyhedra as a VTK unstructured grid (`.vtu`): one cell of type `VTK_POLYHEDRON` per grain.
//!
//! In: a world of polyhedra. Out: the file. A cell is the grain's core with its faces moved out by
//! the rounding radius: the solid whose edges the rounding takes off, of a Voronoi grain its whole
//! cell. A core without faces is a single point; *Glyph* with spheres shows it by `radius`, the
//! distance of its farthest point from its centre.

use super::vtk::{Array, DataSet};
use crate::run::Provenance;
use crate::world::{Polyhedra, Polyhedron, World};
use glam::{DMat3, DVec3};
use std::io::{self, Write};
use std::iter::once;

/// VTK's numbers of the kinds of cell.
const VERTEX: u8 = 1;
const POLYHEDRON: u8 = 42;

/// Writes the grains of `world`, whose shapes are `polyhedra` and which come `from` there, to
/// `file` with `radius` and `rounding` [m], `velocity` [m/s], `spin` [rad/s] and `species`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_polyhedra(
    world: &World,
    polyhedra: &Polyhedra,
    from: &Provenance,
    file: &mut dyn Write,
) -> io::Result<()> {
    let cells = Cells { world, polyhedra };
    let points = cells.shapes().map(|shape| shape.vertices.len()).sum();
    let grid = DataSet {
        kind: "UnstructuredGrid",
        counts: vec![
            ("NumberOfPoints", points),
            ("NumberOfCells", world.grains.len()),
        ],
        elements: vec![
            (
                "Points",
                vec![Array::vectors("points", points, move || cells.points())],
            ),
            ("Cells", cells.topology(points)),
            ("CellData", cells.data()),
        ],
    };
    grid.write(from, file)
}

/// The grains as VTK numbers them: each cell has points of its own, one cell's after another's.
#[derive(Clone, Copy)]
struct Cells<'a> {
    world: &'a World,
    polyhedra: &'a Polyhedra,
}

#[expect(
    clippy::cast_possible_wrap,
    reason = "numbers of points in memory are far below 2⁶³"
)]
impl<'a> Cells<'a> {
    /// Which of the `points` make up each cell, and how.
    fn topology(self, points: usize) -> Vec<Array<'a>> {
        let count = self.world.grains.len();
        let faces = self.shapes().map(face_entries).sum();
        vec![
            Array::integers("connectivity", points, move || self.connectivity()),
            Array::integers("offsets", count, move || self.offsets()),
            Array::bytes("types", count, move || self.shapes().map(kind)),
            Array::integers("faces", faces, move || self.faces()),
            Array::integers("faceoffsets", count, move || self.face_offsets()),
        ]
    }

    /// What each cell has beside its shape.
    fn data(self) -> Vec<Array<'a>> {
        let grains = &self.world.grains;
        let count = grains.len();
        let rounding = move || self.shapes().map(|shape| shape.rounding);
        let species = || grains.species.iter().map(|species| i64::from(species.0));
        vec![
            Array::scalars("radius", count, || grains.radius.iter().copied()),
            Array::scalars("rounding", count, rounding),
            Array::vectors("velocity", count, || grains.velocity.iter().copied()),
            Array::vectors("spin", count, || grains.spin.iter().copied()),
            Array::integers("species", count, species),
        ]
    }

    /// The shape of each cell.
    fn shapes(self) -> impl Iterator<Item = &'a Polyhedron> {
        (0..self.world.grains.len()).map(move |i| self.polyhedra.shape_of(i))
    }

    /// The points of each cell [m].
    fn points(self) -> impl Iterator<Item = DVec3> {
        self.shapes().enumerate().flat_map(move |(i, shape)| {
            let turn = self.polyhedra.orientation[i];
            let centre = self.world.grains.position[i];
            solid(shape).into_iter().map(move |x| centre + turn * x)
        })
    }

    /// The points of each cell.
    fn connectivity(self) -> impl Iterator<Item = i64> {
        0..self.offsets().last().unwrap_or(0)
    }

    /// Where each cell's points end.
    fn offsets(self) -> impl Iterator<Item = i64> {
        self.shapes().scan(0, |end, shape| {
            *end += shape.vertices.len() as i64;
            Some(*end)
        })
    }

    /// For each polyhedron its number of faces, then for each of them its number of points and
    /// these.
    fn faces(self) -> impl Iterator<Item = i64> {
        let shapes = self.shapes().zip(self.offsets());
        let polyhedra = shapes.filter(|(shape, _)| !shape.faces.is_empty());
        polyhedra.flat_map(|(shape, end)| {
            let first = end - shape.vertices.len() as i64;
            let faces = shape.faces.iter().flat_map(move |face| {
                let corners = face.iter().map(move |&corner| first + i64::from(corner));
                once(face.len() as i64).chain(corners)
            });
            once(shape.faces.len() as i64).chain(faces)
        })
    }

    /// Where each cell's faces end; −1 for a cell that is no polyhedron.
    fn face_offsets(self) -> impl Iterator<Item = i64> {
        self.shapes().scan(0, |end, shape| {
            let entries = face_entries(shape) as i64;
            *end += entries;
            Some(if entries == 0 { -1 } else { *end })
        })
    }
}

/// Numbers that tell the faces of a cell of this shape.
fn face_entries(shape: &Polyhedron) -> usize {
    let faces = shape.faces.iter();
    let entries: usize = faces.map(|face| 1 + face.len()).sum();
    if entries == 0 { 0 } else { 1 + entries }
}

/// The kind of a cell of this shape.
fn kind(shape: &Polyhedron) -> u8 {
    if shape.faces.is_empty() {
        VERTEX
    } else {
        POLYHEDRON
    }
}

/// The corners of `shape` where its faces, moved out by the rounding radius, meet. Exact where
/// three faces meet in a corner; of more, the place that lies nearest to all of them.
fn solid(shape: &Polyhedron) -> Vec<DVec3> {
    let mut sums = vec![(DMat3::ZERO, DVec3::ZERO); shape.vertices.len()];
    for face in &shape.faces {
        let normal = outward(shape, face);
        for &corner in face {
            let (squares, sum) = &mut sums[usize::from(corner)];
            *squares += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
            *sum += normal;
        }
    }
    let moved = |(corner, (squares, sum)): (&DVec3, (DMat3, DVec3))| {
        let out = *corner + shape.rounding * (squares.inverse() * sum);
        if out.is_finite() { out } else { *corner }
    };
    shape.vertices.iter().zip(sums).map(moved).collect()
}

/// Unit normal of a face, outwards.
fn outward(shape: &Polyhedron, face: &[u16]) -> DVec3 {
    let corner = |k: usize| shape.vertices[usize::from(face[k % face.len()])];
    let around = (0..face.len()).map(|k| corner(k).cross(corner(k + 1)));
    around.sum::<DVec3>().normalize_or_zero()
}
