//! Polyhedra as files of Rockable, which exaDEM reads: shapes (`.shp`) and bodies (`.conf`).
//!
//! In: a world of polyhedra, its species. Out: text with every digit, in kg, mm and s. A shape is a
//! core and the radius by which it is rounded, in its principal axes, with the volume and the
//! moments that its mass belongs to. exaDEM knows a density by the number of the shape, so that a
//! shape that occurs in two materials stands there twice; species are its groups.

use super::atom_types::AtomTypes;
use super::mpi_engine::PER_METRE;
use crate::world::{Polyhedra, Polyhedron, World};
use glam::DVec3;
use std::collections::HashMap;
use std::io::{self, Write};

/// The file of shapes.
pub const SHAPES: &str = "grains.shp";
/// The file of bodies.
pub const BODIES: &str = "grains.conf";

/// Shapes of one density each.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyKinds {
    /// Index of each shape, and its density [kg/m³].
    kinds: Vec<(u32, f64)>,
    /// Which each grain is of.
    of_grain: Vec<u32>,
}

impl BodyKinds {
    /// Those of `world`, in the order of its grains.
    pub fn of(world: &World) -> Self {
        let mut known = HashMap::new();
        let mut all = Self {
            kinds: Vec::new(),
            of_grain: Vec::with_capacity(world.grains.len()),
        };
        for i in 0..world.polyhedra.as_ref().map_or(0, |_| world.grains.len()) {
            let shape = world.polyhedra.as_ref().map_or(0, |bodies| bodies.shape[i]);
            let material = world.species[usize::from(world.grains.species[i].0)].material;
            let kind = *known.entry((shape, material.0)).or_insert_with(|| {
                all.kinds
                    .push((shape, world.materials.get(material).density));
                all.kinds.len() as u32 - 1
            });
            all.of_grain.push(kind);
        }
        all
    }

    /// Writes the shapes to `file`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_shapes(
        &self,
        bodies: &Polyhedra,
        title: &str,
        file: &mut dyn Write,
    ) -> io::Result<()> {
        writeln!(file, "# {title}\n# kg, mm, s")?;
        for (kind, (shape, _)) in self.kinds.iter().enumerate() {
            write_shape(kind, &bodies.shapes[*shape as usize], file)?;
        }
        Ok(())
    }

    /// Writes the bodies of `world` to `file`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_bodies(
        &self,
        world: &World,
        types: &AtomTypes,
        time_step: f64,
        title: &str,
        file: &mut dyn Write,
    ) -> io::Result<()> {
        writeln!(file, "Rockable 29-11-2018\n# {title}\n# kg, mm, s")?;
        writeln!(file, "t 0\ndt {time_step:e}\nperiodicity 0 0 0")?;
        for (kind, (_, density)) in self.kinds.iter().enumerate() {
            let of_mm = density / PER_METRE / PER_METRE / PER_METRE;
            writeln!(file, "density {kind} {of_mm:e}")?;
        }
        let count = world.grains.len();
        writeln!(
            file,
            "nDriven 0\nshapeFile {SHAPES}\nprecision 17\nParticles {count}"
        )?;
        writeln!(
            file,
            "#name group cluster homothety pos.x pos.y pos.z vel.x vel.y vel.z acc.x acc.y acc.z Q.w Q.x Q.y Q.z \
             vrot.x vrot.y vrot.z arot.x arot.y arot.z"
        )?;
        let turns = world
            .polyhedra
            .iter()
            .flat_map(|bodies| bodies.orientation.iter());
        for (i, turn) in turns.enumerate() {
            let grains = &world.grains;
            writeln!(
                file,
                "{} {} {i} 1 {} {} 0 0 0 {:e} {:e} {:e} {:e} {} 0 0 0",
                name(self.of_grain[i] as usize),
                types.of_grain(i) - 1,
                words(PER_METRE * grains.position[i]),
                words(PER_METRE * grains.velocity[i]),
                turn.w,
                turn.x,
                turn.y,
                turn.z,
                words(grains.spin[i]),
            )?;
        }
        Ok(())
    }
}

/// A shape's name.
fn name(kind: usize) -> String {
    format!("shape{}", kind + 1)
}

fn write_shape(kind: usize, shape: &Polyhedron, file: &mut dyn Write) -> io::Result<()> {
    let square = PER_METRE * PER_METRE;
    let (low, high) = (shape.vertices.iter())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), x| {
            (low.min(*x), high.max(*x))
        });
    let middle = PER_METRE * 0.5 * (low + high);
    let half = PER_METRE * (0.5 * (high - low) + shape.rounding);
    writeln!(file, "<\nname {}", name(kind))?;
    writeln!(file, "radius {:e}", PER_METRE * shape.rounding)?;
    writeln!(
        file,
        "preCompDone y\nvolume {:e}",
        square * PER_METRE * shape.volume
    )?;
    writeln!(file, "I/m {}", words(square * shape.gyration))?;
    writeln!(
        file,
        "obb.extent {}\nobb.center {}",
        words(half),
        words(middle)
    )?;
    writeln!(
        file,
        "obb.e1 1 0 0\nobb.e2 0 1 0\nobb.e3 0 0 1\nOBBtreeLevel 0"
    )?;
    writeln!(file, "position 0 0 0\norientation 1 0 0 0")?;
    writeln!(file, "nv {}", shape.vertices.len())?;
    for vertex in &shape.vertices {
        writeln!(file, "{}", words(PER_METRE * *vertex))?;
    }
    writeln!(file, "ne {}", shape.edges.len())?;
    for [a, b] in &shape.edges {
        writeln!(file, "{a} {b}")?;
    }
    writeln!(file, "nf {}", shape.faces.len())?;
    for face in &shape.faces {
        let corners: Vec<String> = face.iter().map(u16::to_string).collect();
        writeln!(file, "{} {}", face.len(), corners.join(" "))?;
    }
    writeln!(file, ">")
}

fn words(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(|x| if x == 0.0 { 0.0 } else { x });
    format!("{x:e} {y:e} {z:e}")
}
