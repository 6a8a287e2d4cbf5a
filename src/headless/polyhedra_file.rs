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

/// VTK's numbers of the kinds of cell.
const VERTEX: u8 = 1;
const POLYHEDRON: u8 = 42;

/// Writes the grains of `world`, whose shapes are `polyhedra` and which come `from` there, to `file` with `radius` and `rounding` [m], `velocity` [m/s],
/// `spin` [rad/s] and `species`.
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
    let cells = Cells::of(world, polyhedra);
    let rounding = (0..grains.len()).map(|i| polyhedra.shape_of(i).rounding);
    let species = grains.species.iter().map(|species| i64::from(species.0));
    let points = [Array::vectors("points", &cells.points)];
    let topology = [
        Array::integers("connectivity", cells.connectivity),
        Array::integers("offsets", cells.offsets),
        Array::bytes("types", cells.types),
        Array::integers("faces", cells.faces),
        Array::integers("faceoffsets", cells.face_offsets),
    ];
    let data = [
        Array::scalars("radius", grains.radius.iter().copied()),
        Array::scalars("rounding", rounding),
        Array::vectors("velocity", &grains.velocity),
        Array::vectors("spin", &grains.spin),
        Array::integers("species", species),
    ];
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    );
    let counts = (cells.points.len(), grains.len());
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
        counts.0, counts.1
    );
    let mut offset = 0;
    for (element, arrays) in [
        ("Points", points.as_slice()),
        ("Cells", topology.as_slice()),
        ("CellData", data.as_slice()),
    ] {
        let _ = writeln!(text, "<{element}>");
        for array in arrays {
            let _ = writeln!(text, "{}", array.element(offset));
            offset += array.size();
        }
        let _ = writeln!(text, "</{element}>");
    }
    text.push_str("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    file.write_all(from.in_xml(&text).as_bytes())?;
    for array in points.iter().chain(&topology).chain(&data) {
        file.write_all(&(array.bytes.len() as u64).to_le_bytes())?;
        file.write_all(&array.bytes)?;
    }
    file.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// One array of numbers, as it stands in the file behind its length.
struct Array {
    name: &'static str,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl Array {
    fn scalars(name: &'static str, values: impl Iterator<Item = f64>) -> Self {
        Self {
            name,
            kind: "Float64",
            components: 1,
            bytes: values.flat_map(f64::to_le_bytes).collect(),
        }
    }

    fn vectors(name: &'static str, values: &[DVec3]) -> Self {
        Self {
            components: 3,
            ..Self::scalars(name, values.iter().flat_map(DVec3::to_array))
        }
    }

    fn integers(name: &'static str, values: impl IntoIterator<Item = i64>) -> Self {
        Self {
            name,
            kind: "Int64",
            components: 1,
            bytes: values.into_iter().flat_map(i64::to_le_bytes).collect(),
        }
    }

    fn bytes(name: &'static str, bytes: Vec<u8>) -> Self {
        Self {
            name,
            kind: "UInt8",
            components: 1,
            bytes,
        }
    }

    /// Bytes it takes in the file.
    fn size(&self) -> usize {
        size_of::<u64>() + self.bytes.len()
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

/// The grains as VTK numbers them.
#[derive(Default)]
struct Cells {
    points: Vec<DVec3>,
    /// The points of each cell, one cell after another.
    connectivity: Vec<i64>,
    /// Where each cell's points end.
    offsets: Vec<i64>,
    types: Vec<u8>,
    /// For each polyhedron its number of faces, then for each of them its number of points and these.
    faces: Vec<i64>,
    /// Where each cell's faces end; −1 for a cell that is no polyhedron.
    face_offsets: Vec<i64>,
}

impl Cells {
    fn of(world: &World, polyhedra: &Polyhedra) -> Self {
        let solids: Vec<Vec<DVec3>> = polyhedra.shapes.iter().map(solid).collect();
        let mut cells = Self::default();
        for i in 0..world.grains.len() {
            let turn = polyhedra.orientation[i];
            let corners = &solids[polyhedra.shape[i] as usize];
            let placed = corners.iter().map(|x| world.grains.position[i] + turn * *x);
            cells.push(polyhedra.shape_of(i), placed);
        }
        cells
    }

    #[expect(
        clippy::cast_possible_wrap,
        reason = "numbers of points in memory are far below 2⁶³"
    )]
    fn push(&mut self, shape: &Polyhedron, corners: impl Iterator<Item = DVec3>) {
        let first = self.points.len();
        self.points.extend(corners);
        let own = first as i64..self.points.len() as i64;
        self.connectivity.extend(own);
        self.offsets.push(self.connectivity.len() as i64);
        if shape.faces.is_empty() {
            self.types.push(VERTEX);
            self.face_offsets.push(-1);
            return;
        }
        self.types.push(POLYHEDRON);
        self.faces.push(shape.faces.len() as i64);
        for face in &shape.faces {
            self.faces.push(face.len() as i64);
            let corners = face.iter().map(|&k| first as i64 + i64::from(k));
            self.faces.extend(corners);
        }
        self.face_offsets.push(self.faces.len() as i64);
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
