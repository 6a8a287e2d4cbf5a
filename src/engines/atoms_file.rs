//! A state as a data file of LIGGGHTS and LAMMPS: `read_data` takes it up.
//!
//! In: a world of spheres, its types, a box round it. Out: text with every digit, in SI units:
//! number (from 1 on), type, diameter, density and centre of each grain, then its velocity and
//! angular velocity. Both engines read the same columns.

use super::atom_types::AtomTypes;
use crate::geometry::sphere_volume;
use crate::world::World;
use glam::DVec3;
use std::io::{self, Write};

/// The box that the engine divides among its processes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DomainBox {
    /// Lower corner [m].
    pub min: DVec3,
    /// Upper corner [m].
    pub max: DVec3,
}

/// Writes the grains of `world` to `file`; `title`, of one line, is its first. Of `types`, so many
/// are stated as there are coefficients for.
///
/// # Errors
/// When the file cannot be written.
pub fn write_atoms(
    world: &World,
    types: (&AtomTypes, usize),
    domain: &DomainBox,
    title: &str,
    file: &mut dyn Write,
) -> io::Result<()> {
    let (grains, (types, stated)) = (&world.grains, types);
    writeln!(file, "{title}\n")?;
    writeln!(file, "{} atoms\n{} atom types\n", grains.len(), stated)?;
    for (axis, (low, high)) in ["x", "y", "z"]
        .iter()
        .zip(domain.min.to_array().into_iter().zip(domain.max.to_array()))
    {
        writeln!(file, "{low:e} {high:e} {axis}lo {axis}hi")?;
    }
    writeln!(file, "\nAtoms\n")?;
    for i in 0..grains.len() {
        let (kind, radius, x) = (types.of_grain(i), grains.radius[i], grains.position[i]);
        let density = grains.mass[i] / sphere_volume(radius);
        writeln!(
            file,
            "{} {kind} {:e} {density:e} {:e} {:e} {:e}",
            i + 1,
            2.0 * radius,
            x.x,
            x.y,
            x.z
        )?;
    }
    writeln!(file, "\nVelocities\n")?;
    for i in 0..grains.len() {
        let (v, w) = (grains.velocity[i], grains.spin[i]);
        writeln!(
            file,
            "{} {:e} {:e} {:e} {:e} {:e} {:e}",
            i + 1,
            v.x,
            v.y,
            v.z,
            w.x,
            w.y,
            w.z
        )?;
    }
    Ok(())
}
