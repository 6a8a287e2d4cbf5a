//! The grains as VTK files: one per output time and a `.pvd` that lists them. Spheres are points (`.vtp`), polyhedra are cells
//! (`.vtu`, see `polyhedra_file`).
//!
//! `ParaView` opens `grains.pvd` as a series in time; of points, *Glyph* with spheres scaled by `radius` (scale factor 2), or *Point
//! Gaussian* with `radius` as its scale array, shows the grains at their size. Values are in SI units, in 64 bits.

use super::polyhedra_file::write_polyhedra;
use crate::simulation::Provenance;
use crate::world::World;
use glam::DVec3;
use std::fmt::Write as _;
use std::io::{self, Write};
use vtkio::IOBuffer;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, DataSet, PolyDataPiece, Version, VertexNumbers, Vtk,
};

/// Name of the list of the grains' files.
pub const COLLECTION: &str = "grains.pvd";

/// Extension of the files of the grains of `world`.
pub fn extension(world: &World) -> &'static str {
    if world.polyhedra.is_some() {
        "vtu"
    } else {
        "vtp"
    }
}

/// Writes the grains of `world`, which come `from` there, to `file`: one point or cell per grain with `radius` [m],
/// `velocity` [m/s], `spin` [rad/s] and `species`.
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
    let count = grains.len() as u64;
    let species: Vec<u32> = grains.species.iter().map(|s| u32::from(s.0)).collect();
    let piece = PolyDataPiece {
        points: components(&grains.position),
        verts: Some(VertexNumbers::XML {
            connectivity: (0..count).collect(),
            offsets: (1..=count).collect(),
        }),
        data: Attributes {
            point: vec![
                Attribute::scalars("radius", 1).with_data(grains.radius.clone()),
                Attribute::vectors("velocity").with_data(components(&grains.velocity)),
                Attribute::vectors("spin").with_data(components(&grains.spin)),
                Attribute::scalars("species", 1).with_data(species),
            ],
            cell: Vec::new(),
        },
        ..PolyDataPiece::default()
    };
    let vtk = Vtk {
        version: Version::new((1, 0)),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(piece),
        file_path: None,
    };
    let mut xml = Vec::new();
    vtk.write_xml(&mut xml).map_err(io::Error::other)?;
    let xml = String::from_utf8(xml).map_err(io::Error::other)?;
    file.write_all(from.in_xml(&xml).as_bytes())
}

fn components(vectors: &[DVec3]) -> IOBuffer {
    let flat: Vec<f64> = vectors.iter().flat_map(DVec3::to_array).collect();
    flat.into()
}

/// Writes the list of grains' files, each with its time [s], all `from` one run, to `file`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_collection(
    frames: &[(f64, String)],
    from: &Provenance,
    file: &mut dyn Write,
) -> io::Result<()> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n",
    );
    for (time, name) in frames {
        writeln!(
            text,
            "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>"
        )
        .map_err(io::Error::other)?;
    }
    text.push_str("  </Collection>\n</VTKFile>\n");
    file.write_all(from.in_xml(&text).as_bytes())
}
