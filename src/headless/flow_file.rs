//! `flow.csv`: the profile of the flowing layer over depth, averaged over the part of the run that results count.

use crate::measure::FlowProfile;
use std::io::{self, Write};

/// The file's name.
pub const FLOW: &str = "flow.csv";

/// Writes `profile` to `file`: depth below the middle of the surface, velocity along it there, samples averaged.
///
/// # Errors
/// When the file cannot be written.
pub fn write_flow(profile: &FlowProfile, file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(["depth [m]", "velocity [m/s]", "samples [1]"])?;
    let rows = profile.depth.iter().zip(profile.velocity());
    for ((depth, velocity), samples) in rows.zip(&profile.samples) {
        writer.write_record([
            format!("{depth:?}"),
            format!("{velocity:?}"),
            samples.to_string(),
        ])?;
    }
    writer.flush()
}
