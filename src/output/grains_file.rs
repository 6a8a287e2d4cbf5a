//! The grains as VTK files, one per output time. Spheres are points (`.vtp`), polyhedra are cells
//! (`.vtu`, see `polyhedra_file`); `collection_file` lists them.
//!
//! In: a world. Out: a file. `ParaView` opens `grains.pvd` as a series in time; of points, *Glyph*
//! with spheres scaled by `radius` (scale factor 2), or *Point Gaussian* with `radius` as its scale
//! array, shows the grains at their size. Values are in SI units, in 64 bits.

use super::polyhedra_file::write_polyhedra;
use super::vtk::{Array, DataSet};
use crate::run::Provenance;
use crate::world::World;
use std::io::{self, Write};

/// Extension of the files of the grains of `world`.
pub fn extension(world: &World) -> &'static str {
    if world.polyhedra.is_some() {
        "vtu"
    } else {
        "vtp"
    }
}

/// Writes the grains of `world`, which come `from` there, to `file`: one point or cell per grain
/// with `radius` [m], `velocity` [m/s], `spin` [rad/s] and `species`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_grains(world: &World, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    match &world.polyhedra {
        Some(polyhedra) => write_polyhedra(world, polyhedra, from, file),
        None => write_spheres(world, from, file),
    }
}

/// Writes spheres as VTK poly data, one vertex per grain.
fn write_spheres(world: &World, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    let grains = &world.grains;
    let count = grains.len();
    let last = i64::try_from(count).map_err(io::Error::other)?;
    let species = || grains.species.iter().map(|species| i64::from(species.0));
    let points = DataSet {
        kind: "PolyData",
        counts: vec![
            ("NumberOfPoints", count),
            ("NumberOfVerts", count),
            ("NumberOfLines", 0),
            ("NumberOfStrips", 0),
            ("NumberOfPolys", 0),
        ],
        elements: vec![
            (
                "PointData",
                vec![
                    Array::scalars("radius", count, || grains.radius.iter().copied()),
                    Array::vectors("velocity", count, || grains.velocity.iter().copied()),
                    Array::vectors("spin", count, || grains.spin.iter().copied()),
                    Array::integers("species", count, species),
                ],
            ),
            (
                "Points",
                vec![Array::vectors("points", count, || {
                    grains.position.iter().copied()
                })],
            ),
            (
                "Verts",
                vec![
                    Array::integers("connectivity", count, || 0..last),
                    Array::integers("offsets", count, || 1..=last),
                ],
            ),
        ],
    };
    points.write(from, file)
}
