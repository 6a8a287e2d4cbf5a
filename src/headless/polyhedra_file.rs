//! Polyhedra as a VTK unstructured grid (`.vtu`): one cell of type `VTK_POLYHEDRON` per grain.
//!
//! A cell is the grain's core with its faces moved out by the rounding radius: the solid whose edges the rounding takes off,
//! of a Voronoi grain its whole cell. A core without faces is a single point; *Glyph* with spheres shows it by `radius`, the
//! distance of its farthest point from its centre. All numbers are in SI units, little endian, in 64 bits.

use crate::simulation::Provenance;
use crate::world::{Polyhedra, Polyhedron, World};
use glam::{DMat3, DVec3};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::iter::once;

/// VTK's numbers of the kinds of cell.
const VERTEX: u8 = 1;
const POLYHEDRON: u8 = 42;

/// Writes the grains of `world`, whose shapes are `polyhedra` and which come `from` there, to `file` with `radius` and
/// `rounding` [m], `velocity` [m/s], `spin` [rad/s] and `species`. Number by number: the file is larger than the world, and is
/// never held whole.
///
/// # Errors
/// When the file cannot be written.
pub fn write_polyhedra(
    world: &World,
    polyhedra: &Polyhedra,
    from: &Provenance,
    file: &mut dyn Write,
) -> io::Result<()> {
    let grains = &world.grains;
    let cells = Cells { world, polyhedra };
    let points = cells.shapes().map(|shape| shape.vertices.len()).sum();
    let faces = cells.shapes().map(face_entries).sum();
    let rounding = || cells.shapes().map(|shape| shape.rounding);
    let species = || grains.species.iter().map(|species| i64::from(species.0));
    let elements = [
        (
            "Points",
            vec![Array::vectors("points", points, || cells.points())],
        ),
        (
            "Cells",
            vec![
                Array::integers("connectivity", points, || cells.connectivity()),
                Array::integers("offsets", grains.len(), || cells.offsets()),
                Array::bytes("types", grains.len(), || cells.shapes().map(kind)),
                Array::integers("faces", faces, || cells.faces()),
                Array::integers("faceoffsets", grains.len(), || cells.face_offsets()),
            ],
        ),
        (
            "CellData",
            vec![
                Array::scalars("radius", grains.len(), || grains.radius.iter().copied()),
                Array::scalars("rounding", grains.len(), rounding),
                Array::vectors("velocity", grains.len(), || grains.velocity.iter().copied()),
                Array::vectors("spin", grains.len(), || grains.spin.iter().copied()),
                Array::integers("species", grains.len(), species),
            ],
        ),
    ];
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    );
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{}\">",
        grains.len()
    );
    let mut offset = 0;
    for (element, arrays) in &elements {
        let _ = writeln!(text, "<{element}>");
        for array in arrays {
            let _ = writeln!(text, "{}", array.element(offset));
            offset += size_of::<u64>() + array.size;
        }
        let _ = writeln!(text, "</{element}>");
    }
    text.push_str("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    file.write_all(from.in_xml(&text).as_bytes())?;
    for array in elements.iter().flat_map(|(_, arrays)| arrays) {
        file.write_all(&(array.size as u64).to_le_bytes())?;
        (array.write)(file)?;
    }
    file.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// Bytes that are gathered before they are written.
const PIECE: usize = 1 << 16;

/// Writes the numbers of an array.
type Writing<'a> = dyn Fn(&mut dyn Write) -> io::Result<()> + 'a;

/// One array of numbers, as it stands in the file behind its length.
struct Array<'a> {
    name: &'static str,
    kind: &'static str,
    components: usize,
    /// Bytes that its numbers take.
    size: usize,
    write: Box<Writing<'a>>,
}

impl<'a> Array<'a> {
    /// `count` numbers of `N` bytes each, made anew whenever they are written.
    fn new<const N: usize, I: Iterator<Item = [u8; N]>>(
        name: &'static str,
        kind: &'static str,
        count: usize,
        numbers: impl Fn() -> I + 'a,
    ) -> Self {
        Self {
            name,
            kind,
            components: 1,
            size: N * count,
            write: Box::new(move |file| {
                let mut piece = Vec::with_capacity(PIECE + N);
                for number in numbers() {
                    piece.extend_from_slice(&number);
                    if piece.len() >= PIECE {
                        file.write_all(&piece)?;
                        piece.clear();
                    }
                }
                file.write_all(&piece)
            }),
        }
    }

    fn scalars<I: Iterator<Item = f64>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(f64::to_le_bytes);
        Self::new(name, "Float64", count, numbers)
    }

    fn vectors<I: Iterator<Item = DVec3>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().flat_map(|v| v.to_array());
        Self {
            components: 3,
            ..Self::scalars(name, 3 * count, numbers)
        }
    }

    fn integers<I: Iterator<Item = i64>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(i64::to_le_bytes);
        Self::new(name, "Int64", count, numbers)
    }

    fn bytes<I: Iterator<Item = u8>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(u8::to_le_bytes);
        Self::new(name, "UInt8", count, numbers)
    }

    /// The element that describes it.
    fn element(&self, offset: usize) -> String {
        let Self {
            name,
            kind,
            components,
            ..
        } = self;
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
             offset=\"{offset}\"/>"
        )
    }
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

    /// For each polyhedron its number of faces, then for each of them its number of points and these.
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

/// The corners of `shape` where its faces, moved out by the rounding radius, meet. Exact where three faces meet in a corner;
/// of more, the place that lies nearest to all of them.
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
