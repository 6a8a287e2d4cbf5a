//! What polyhedra look like: a VTK unstructured grid (`.vtu`) with one cell of type
//! `VTK_POLYHEDRON` per grain, along the axes of its body and about its centroid.
//!
//! In: a world of polyhedra. Out: the file, which holds for the whole run. A cell is the grain's
//! core with its faces moved out by the rounding radius: the solid whose edges the rounding takes
//! off, of a Voronoi grain its whole cell; a corner sharper than a needle is blunt. A core without
//! faces is a single point. What the grain is computed with stands beside it: corners of its core,
//! volume, moments. A point `p` of grain `id` is at `x + p₁ e₁ + p₂ e₂ + p₃ e₃`, where `x` is the point and `e` are the rows of
//! `tensor` of that grain in `grains_file`; `docs/analysis.md` does it for `ParaView` and pyvista.

use super::vtk::{Array, DataSet};
use crate::run::Provenance;
use crate::world::{Polyhedra, Polyhedron, World};
use glam::{DMat3, DVec3};
use std::io::{self, Write};
use std::iter::{once, repeat_n};

/// The file.
pub const SHAPES: &str = "shapes.vtu";
/// VTK's numbers of the kinds of cell.
const VERTEX: u8 = 1;
const POLYHEDRON: u8 = 42;
/// Farthest that a corner of the solid is drawn from that of the core, in rounding radii: five for
/// one as sharp as 23°. Where faces hardly differ in direction the place where they meet can be
/// anywhere.
const SHARPEST: f64 = 10.0;

/// Writes the shapes of the grains of `world`, which are `polyhedra` and come `from` there, to
/// `file`: each point with the corner of the `core` \[m\] that it belongs to, and the `id`, `rounding`
/// radius \[m\], `volume` \[m³\] and principal `gyration` (`inertia / mass`) \[m²\] of its grain. Cells
/// have no data of their own: meshio mixes up those of polyhedra.
///
/// # Errors
/// When the file cannot be written.
pub fn write_shapes(
    world: &World,
    polyhedra: &Polyhedra,
    from: &Provenance,
    file: &mut dyn Write,
) -> io::Result<()> {
    let count = world.grains.len();
    let cells = Cells { count, polyhedra };
    let points = cells.shapes().map(|shape| shape.vertices.len()).sum();
    // Everything in it is numbered in 32 bits.
    i32::try_from(cells.shapes().map(face_entries).sum::<usize>()).map_err(io::Error::other)?;
    let grid = DataSet {
        kind: "UnstructuredGrid",
        counts: vec![("NumberOfPoints", points), ("NumberOfCells", count)],
        elements: vec![
            (
                "PointData",
                vec![
                    Array::integers("id", points, move || cells.owners()).appended(),
                    Array::vectors("core", points, move || cells.cores()).appended(),
                    cells.scalars("rounding", points, |shape| shape.rounding),
                    cells.scalars("volume", points, |shape| shape.volume),
                    cells.vectors("gyration", points, |shape| shape.gyration),
                ],
            ),
            (
                "Points",
                vec![Array::vectors("Points", points, move || cells.points()).appended()],
            ),
            ("Cells", cells.topology(points)),
        ],
    };
    grid.write(from, file)
}

/// The grains as VTK numbers them: each cell has points of its own, one cell's after another's.
#[derive(Clone, Copy)]
struct Cells<'a> {
    count: usize,
    polyhedra: &'a Polyhedra,
}

#[expect(
    clippy::cast_possible_wrap,
    reason = "all that is numbered is counted before"
)]
impl<'a> Cells<'a> {
    /// Which of the `points` make up each cell, and how.
    fn topology(self, points: usize) -> Vec<Array<'a>> {
        let count = self.count;
        let faces = self.shapes().map(face_entries).sum();
        vec![
            Array::integers("connectivity", points, move || self.connectivity()).appended(),
            Array::integers("offsets", count, move || self.offsets()).appended(),
            Array::bytes("types", count, move || self.shapes().map(kind)),
            Array::integers("faces", faces, move || self.faces()).appended(),
            Array::integers("faceoffsets", count, move || self.face_offsets()).appended(),
        ]
    }

    /// The shape of each cell.
    fn shapes(self) -> impl Iterator<Item = &'a Polyhedron> {
        (0..self.count).map(move |i| self.polyhedra.shape_of(i))
    }

    /// A number of each point's grain.
    fn scalars(self, name: &'static str, points: usize, of: fn(&Polyhedron) -> f64) -> Array<'a> {
        let of_points = move |shape: &'a Polyhedron| repeat_n(of(shape), shape.vertices.len());
        Array::scalars(name, points, move || self.shapes().flat_map(of_points)).appended()
    }

    /// A vector of each point's grain.
    fn vectors(self, name: &'static str, points: usize, of: fn(&Polyhedron) -> DVec3) -> Array<'a> {
        let of_points = move |shape: &'a Polyhedron| repeat_n(of(shape), shape.vertices.len());
        Array::vectors(name, points, move || self.shapes().flat_map(of_points)).appended()
    }

    /// The corner of the core of each point [m].
    fn cores(self) -> impl Iterator<Item = DVec3> {
        self.shapes()
            .flat_map(|shape| shape.vertices.iter().copied())
    }

    /// The points of each cell along the axes of its body [m].
    fn points(self) -> impl Iterator<Item = DVec3> {
        self.shapes().flat_map(solid)
    }

    /// The grain of each point.
    fn owners(self) -> impl Iterator<Item = i32> {
        let shapes = self.shapes().enumerate();
        shapes.flat_map(|(i, shape)| shape.vertices.iter().map(move |_| i as i32))
    }

    /// The points of each cell.
    fn connectivity(self) -> impl Iterator<Item = i32> {
        0..self.offsets().last().unwrap_or(0)
    }

    /// Where each cell's points end.
    fn offsets(self) -> impl Iterator<Item = i32> {
        self.shapes().scan(0, |end, shape| {
            *end += shape.vertices.len() as i32;
            Some(*end)
        })
    }

    /// For each polyhedron its number of faces, then for each of them its number of points and
    /// these.
    fn faces(self) -> impl Iterator<Item = i32> {
        let shapes = self.shapes().zip(self.offsets());
        let polyhedra = shapes.filter(|(shape, _)| !shape.faces.is_empty());
        polyhedra.flat_map(|(shape, end)| {
            let first = end - shape.vertices.len() as i32;
            let faces = shape.faces.iter().flat_map(move |face| {
                let corners = face.iter().map(move |&corner| first + i32::from(corner));
                once(face.len() as i32).chain(corners)
            });
            once(shape.faces.len() as i32).chain(faces)
        })
    }

    /// Where each cell's faces end; −1 for a cell that is no polyhedron.
    fn face_offsets(self) -> impl Iterator<Item = i32> {
        self.shapes().scan(0, |end, shape| {
            let entries = face_entries(shape) as i32;
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

/// The corners of `shape` where its faces, moved out by the rounding radius, meet. Exact where three
/// faces meet in a corner; of more, the place that lies nearest to all of them.
fn solid(shape: &Polyhedron) -> Vec<DVec3> {
    let corners = &shape.vertices;
    let mut sums = vec![(DMat3::ZERO, DVec3::ZERO); corners.len()];
    for face in &shape.faces {
        let normal = outward(corners, face);
        for &corner in face {
            let (squares, sum) = &mut sums[usize::from(corner)];
            *squares += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
            *sum += normal;
        }
    }
    let moved = |(corner, (squares, sum)): (&DVec3, (DMat3, DVec3))| {
        let out = squares.inverse() * sum;
        let out = if out.is_finite() { out } else { DVec3::ZERO };
        *corner + shape.rounding * out.clamp_length_max(SHARPEST)
    };
    corners.iter().zip(sums).map(moved).collect()
}

/// Unit normal of a face, outwards.
fn outward(corners: &[DVec3], face: &[u16]) -> DVec3 {
    let corner = |k: usize| corners[usize::from(face[k % face.len()])];
    let around = (0..face.len()).map(|k| corner(k).cross(corner(k + 1)));
    around.sum::<DVec3>().normalize_or_zero()
}
