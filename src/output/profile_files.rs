//! Profiles: `flow.csv`, that of the flowing layer over depth, averaged over the part of the run
//! that results count, and `profile.csv`, those of a heap's height and of the pressure on the floor
//! under it over the radius at the end.

use crate::measure::{HeightProfile, MeanFlow};
use crate::run::{Cells, Column, Table};
use std::io::{self, Write};

/// The files' names.
pub const FLOW: &str = "flow.csv";
pub const PROFILE: &str = "profile.csv";

/// What stands in [`FLOW`].
pub fn flow_table() -> Table {
    Table::new(
        FLOW,
        [
            Column::numbers("depth", "m").described("below the middle of the surface"),
            Column::numbers("velocity", "m/s").described("along the surface, mean"),
            Column::new("samples", Cells::Counts).described("samples averaged"),
            Column::numbers("error", "m/s").described("standard error of the velocity"),
        ],
    )
}

/// What stands in [`PROFILE`].
pub fn profile_table() -> Table {
    Table::new(
        PROFILE,
        [
            Column::numbers("radius", "m").described("distance from the column's axis"),
            Column::numbers("height", "m").described("mean over the azimuth"),
            Column::numbers("pressure", "Pa").described("mean on the floor under the ring"),
        ],
    )
}

/// Writes `flow` to `file`: depth below the middle of the surface, velocity along it there and its
/// standard error (NaN where the run is too short for one), samples averaged.
///
/// # Errors
/// When the file cannot be written.
pub fn write_flow(flow: &MeanFlow, file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(flow_table().heads())?;
    for row in &flow.depths {
        writer.write_record([
            format!("{:?}", row.depth),
            format!("{:?}", row.velocity),
            row.samples.to_string(),
            format!("{:?}", row.error.unwrap_or(f64::NAN)),
        ])?;
    }
    writer.flush()
}

/// Writes `profile` to `file`: distance from the column's axis, mean height over the azimuth there and
/// `pressure` on the floor.
///
/// # Errors
/// When the file cannot be written.
pub fn write_profile(
    profile: &HeightProfile,
    pressure: &[f64],
    file: &mut dyn Write,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(profile_table().heads())?;
    let rings = profile.radius.iter().zip(&profile.height).zip(pressure);
    for ((radius, height), pressure) in rings {
        writer.write_record([radius, height, pressure].map(|number| format!("{number:?}")))?;
    }
    writer.flush()
}
