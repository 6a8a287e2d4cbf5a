//! `velocity.csv`: the velocities in the cross-section at the fastest moment of the part of the run
//! that results count.

use crate::measure::VelocityMap;
use crate::run::{Column, Table};
use std::io::{self, Write};

/// The file's name.
pub const VELOCITY: &str = "velocity.csv";

/// What stands in [`VELOCITY`].
pub fn velocity_table() -> Table {
    let columns = [
        ("time", "s"),
        ("x", "m"),
        ("y", "m"),
        ("velocity x", "m/s"),
        ("velocity y", "m/s"),
    ];
    Table::new(
        VELOCITY,
        columns.map(|(key, unit)| Column::numbers(key, unit)),
    )
}

/// Writes `map` to `file`: the moment, then each point that has a velocity, with it.
///
/// # Errors
/// When the file cannot be written.
pub fn write_velocity(map: &VelocityMap, file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(velocity_table().heads())?;
    for (place, velocity) in map.points() {
        let numbers = [map.time, place.x, place.y, velocity.x, velocity.y];
        writer.write_record(numbers.map(|number| format!("{number:?}")))?;
    }
    writer.flush()
}
