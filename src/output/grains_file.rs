//! The grains at one instant as a VTK file of points (`.vtp`); `collection_file` lists them.
//!
//! In: a world. Out: a file that `ParaView`, VTK's readers and OVITO open. Values are in SI units,
//! in 32 bits, so about seven digits; arrays have the names that LIGGGHTS gives them in its own VTK
//! files, which OVITO knows:
//!
//! | array | what it is | in OVITO |
//! |---|---|---|
//! | `Points` | centre \[m\] | Position |
//! | `id` | number of the grain, from 0 on | Particle Identifier |
//! | `shapetype` | number of its species, from 0 on | Particle Type |
//! | `radius` | of a polyhedron the distance of its farthest point \[m\] | Radius |
//! | `v` | velocity \[m/s\] | Velocity |
//! | `omega` | angular velocity \[rad/s\] | Angular Velocity |
//! | `f` | sum of the forces at its contacts, without weight \[N\] | Force |
//! | `coordination` | partners that it touches, walls too | `coordination` |
//! | `film` | where there is liquid: its volume on the grain, with its part in bridges \[m³\] | `film` |
//! | `tensor` | of polyhedra: the axes of its body, one a row | Orientation |
//!
//! What a polyhedron looks like stands once, in `shapes_file`.

use super::vtk::{Array, DataSet};
use crate::measure::coordinations;
use crate::run::Provenance;
use crate::world::{Polyhedra, World};
use glam::DMat3;
use std::io::{self, Write};

/// Writes the grains of `world`, which come `from` there, to `file`: one point per grain.
///
/// # Errors
/// When the file cannot be written.
pub fn write_grains(world: &World, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    let grains = &world.grains;
    let count = grains.len();
    let last = i32::try_from(count).map_err(io::Error::other)?;
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
            ("PointData", data(world, last)),
            (
                "Points",
                vec![Array::vectors("Points", count, || {
                    grains.position.iter().copied()
                })],
            ),
            (
                "Verts",
                vec![
                    Array::integers("connectivity", count, move || 0..last),
                    Array::integers("offsets", count, move || 1..=last),
                ],
            ),
        ],
    };
    points.write(from, file)
}

/// What each of the `last` grains has beside its place.
fn data(world: &World, last: i32) -> Vec<Array<'_>> {
    let grains = &world.grains;
    let count = grains.len();
    let species = || grains.species.iter().map(|species| i32::from(species.0));
    let counts = coordinations(world);
    let touching = move || counts.clone().into_iter().map(u32::cast_signed);
    let mut data = vec![
        Array::integers("id", count, move || 0..last),
        Array::small_integers("shapetype", count, species),
        Array::scalars("radius", count, || grains.radius.iter().copied()),
        Array::vectors("v", count, || grains.velocity.iter().copied()),
        Array::vectors("omega", count, || grains.spin.iter().copied()),
        Array::vectors("f", count, || grains.force.iter().copied()),
        Array::small_integers("coordination", count, touching),
    ];
    if world.wetting().is_some() {
        data.push(Array::scalars("film", count, || {
            grains.film.iter().copied()
        }));
    }
    if let Some(polyhedra) = &world.polyhedra {
        data.push(Array::tensors("tensor", count, || axes(polyhedra)));
    }
    data
}

/// The axes of each body along those of the world.
fn axes(polyhedra: &Polyhedra) -> impl Iterator<Item = [glam::DVec3; 3]> {
    polyhedra.orientation.iter().map(|turn| {
        let turn = DMat3::from_quat(*turn);
        [turn.x_axis, turn.y_axis, turn.z_axis]
    })
}
