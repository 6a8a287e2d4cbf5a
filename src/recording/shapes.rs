//! `shapes.vtu`, read back: what each polyhedron of a run looks like.
//!
//! In: the file. Out: the grains' shapes, in the axes of their bodies, in the file's 24 bits.

use super::RecordingError;
use super::vtk_arrays::VtkArrays;
use crate::geometry::Solid;
use crate::physics::limits::MOST_POLYHEDRA;
use crate::world::Polyhedron;
use glam::DVec3;
use std::sync::Arc;

/// Its arrays.
pub const WANTED: [&str; 7] = [
    "core",
    "rounding",
    "volume",
    "gyration",
    "offsets",
    "faces",
    "faceoffsets",
];
/// Features of one kind that a shape may have.
const MOST_FEATURES: usize = 1 << 12;

/// The shapes in `file`, one for each grain.
///
/// # Errors
/// When they are none.
pub fn shapes(file: &VtkArrays) -> Result<Arc<[Polyhedron]>, RecordingError> {
    let points = file.count("NumberOfPoints")?;
    let cells = file.count("NumberOfCells")?;
    if cells > MOST_POLYHEDRA {
        return Err(file.refuse(format!(
            "has {cells} shapes; expected up to {MOST_POLYHEDRA}"
        )));
    }
    let cells = Cells {
        corners: file.vectors("PointData", "core", points)?,
        rounding: file.numbers("PointData", "rounding", 1, Some(points))?,
        volume: file.numbers("PointData", "volume", 1, Some(points))?,
        gyration: file.vectors("PointData", "gyration", points)?,
        offsets: file.numbers("Cells", "offsets", 1, Some(cells))?,
        faces: file.numbers("Cells", "faces", 1, None)?,
        face_offsets: file.numbers("Cells", "faceoffsets", 1, Some(cells))?,
    };
    let shapes = (0..cells.offsets.len()).map(|cell| {
        let shape = cells.shape(cell);
        shape.ok_or_else(|| file.refuse(format!("cell {cell} is no polyhedron")))
    });
    shapes.collect()
}

/// What the file holds.
struct Cells<'a> {
    /// Of each point: the corner of the core [m], and its grain's rounding radius [m], volume [m³]
    /// and principal moments of inertia over the mass [m²].
    corners: Vec<DVec3>,
    rounding: &'a [f64],
    volume: &'a [f64],
    gyration: Vec<DVec3>,
    offsets: &'a [f64],
    faces: &'a [f64],
    face_offsets: &'a [f64],
}

impl Cells<'_> {
    /// The shape of a cell; none where it is none.
    fn shape(&self, cell: usize) -> Option<Polyhedron> {
        let first = match cell.checked_sub(1) {
            Some(before) => index(self.offsets[before])?,
            None => 0,
        };
        let end = index(self.offsets[cell])?;
        let corners = self.corners.get(first..end)?;
        let rounding = *self.rounding.get(first)?;
        if corners.len() == 1 {
            return Some(Polyhedron::sphere(rounding)).filter(Polyhedron::is_sound_sphere);
        }
        let faces = self.faces_of(cell, first, corners.len())?;
        let core = Solid::new(corners.to_vec(), faces);
        let shape = Polyhedron::of_core(core, rounding, self.volume[first], self.gyration[first]);
        Some(shape).filter(Polyhedron::is_sound_core)
    }

    /// The faces of a cell of so many `corners`, the first of which is the point `first`.
    fn faces_of(&self, cell: usize, first: usize, corners: usize) -> Option<Vec<Vec<u16>>> {
        // A cell that is no polyhedron has no end, and no entries.
        let before = self.face_offsets[..cell].iter().rev();
        let start = before.copied().find_map(index).unwrap_or(0);
        let entries = self.faces.get(start..index(self.face_offsets[cell])?)?;
        let (count, mut entries) = entries.split_first()?;
        let count = index(*count).filter(|count| *count <= MOST_FEATURES)?;
        let mut faces = Vec::with_capacity(count);
        for _ in 0..count {
            let (length, rest) = entries.split_first()?;
            let length = index(*length).filter(|length| *length >= 3)?;
            let corner = |&point: &f64| {
                let corner = index(point)?.checked_sub(first)?;
                (corner < corners.min(MOST_FEATURES)).then_some(corner as u16)
            };
            let face = rest.get(..length)?.iter().map(corner);
            faces.push(face.collect::<Option<Vec<u16>>>()?);
            entries = &rest[length..];
        }
        entries.is_empty().then_some(faces)
    }
}

/// `number` as an index; none where it is none.
fn index(number: f64) -> Option<usize> {
    (0.0..=f64::from(u32::MAX))
        .contains(&number)
        .then_some(number as usize)
}
