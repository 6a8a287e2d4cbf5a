//! The numbers of one grain: where it is, how it moves, what it weighs and touches.
//!
//! In: a world and a grain's index. Out: rows of a table, in the units that people think in.

use crate::ui::widgets::value_table::TableRow;
use crate::ui::words::number;
use glam::DVec3;
use grainfall::measure::GrainQuantity;
use grainfall::world::{Contact, Partner, World};

const MILLIMETRES: f64 = 1e3;

/// A vector's components and its length, in `unit` after a factor.
fn vector(v: DVec3, factor: f64, unit: &str) -> String {
    let [x, y, z] = (v * factor).to_array().map(number::short);
    format!("({x}, {y}, {z}) {unit}")
}

/// The numbers of one grain with these `contacts`, all that it has.
pub(super) fn numbers(world: &World, i: usize, contacts: &[&Contact]) -> Vec<TableRow> {
    let touched = |is_wall: bool| {
        let is_such = |contact: &&&Contact| {
            contact.touching && matches!(contact.partner, Partner::Wall(_)) == is_wall
        };
        contacts.iter().filter(is_such).count().to_string()
    };
    let grains = &world.grains;
    let species = &world.species[usize::from(grains.species[i].0)];
    let (x, v, spin) = (grains.position[i], grains.velocity[i], grains.spin[i]);
    let mass = grains.mass[i];
    let energy = |joules: f64| number::with_prefix(joules, "J");
    let mut rows = vec![
        TableRow::of("Species", species.name.clone(), ""),
        TableRow::of(
            "Position",
            vector(x, MILLIMETRES, "mm"),
            "Centre: x to the right, y up, z towards the viewer",
        ),
        TableRow::of("Velocity", vector(v, MILLIMETRES, "mm/s"), "Of its centre"),
        TableRow::of("Speed", number::with_prefix(v.length(), "m/s"), ""),
        TableRow::of("Spin", vector(spin, 1.0, "rad/s"), "Angular velocity"),
        TableRow::of(
            "Radius",
            format!("{} mm", number::short(MILLIMETRES * grains.radius[i])),
            "Of a polyhedron: to its farthest point",
        ),
        TableRow::of("Mass", number::with_prefix(1e3 * mass, "g"), ""),
        TableRow::of(
            GrainQuantity::Coordination.name(),
            touched(false),
            GrainQuantity::Coordination.quantity().description,
        ),
        TableRow::of("Walls touched", touched(true), ""),
    ];
    if world.wetting().is_some() {
        rows.push(TableRow::of(
            "Bridges",
            grains.open_bridges[i].to_string(),
            "To grains that it does not touch",
        ));
        rows.push(TableRow::of(
            "Film",
            number::with_prefix(1e3 * grains.film[i], "L"),
            "Liquid on it, its part in bridges included",
        ));
    }
    let kinetic = 0.5 * mass * v.length_squared();
    rows.extend([
        TableRow::of("Kinetic energy", energy(kinetic), "Of translation: ½ m v²"),
        TableRow::of(
            "Rotational energy",
            energy(world.rotational_energy(i)),
            "½ I ω²",
        ),
        TableRow::of(
            "Potential energy",
            energy(-mass * world.gravity.dot(x)),
            "−m g·x, from the origin",
        ),
    ]);
    rows
}
