//! `flow.csv`, read back.
//!
//! In: the file. Out: the mean flow that it holds, to the bit. What cannot be one is refused.

use super::RecordingError;
use super::own_files::OwnFile;
use crate::measure::{FlowDepth, MeanFlow};
use crate::output::flow_table;
use csv::StringRecord;

/// Largest table that is read [bytes]: one has forty-nine short lines.
pub const LARGEST_FLOW: u64 = 1 << 20;
/// Deepest place below a surface [m].
const DEEPEST: f64 = 1e3;
/// Fastest that anything flows [m/s].
const FASTEST: f64 = 1e4;

/// The mean flow in `file`.
///
/// # Errors
/// When it has other columns, or a row that is none of them.
pub fn mean_flow(file: &OwnFile) -> Result<MeanFlow, RecordingError> {
    let refuse = |reason: String| RecordingError::of(&file.path, reason);
    let mut reader = csv::Reader::from_reader(&file.bytes[..]);
    let heads = reader
        .headers()
        .map_err(|error| refuse(error.to_string()))?;
    let expected: Vec<String> = flow_table().heads();
    if !heads.iter().eq(expected.iter()) {
        let expected = expected.join("`, `");
        return Err(refuse(format!("does not have the columns `{expected}`")));
    }
    let mut flow = MeanFlow::default();
    for (index, row) in reader.records().enumerate() {
        let row = row.map_err(|error| refuse(error.to_string()))?;
        let last = flow.depths.last().map_or(-1.0, |last| last.depth);
        let depth = flow_depth(&row).filter(|row| row.depth > last);
        flow.depths.push(depth.ok_or_else(|| {
            refuse(format!(
                "row {} is not a velocity, its samples and its error at a greater depth than the row before",
                index + 2
            ))
        })?);
    }
    Ok(flow)
}

/// What stands in `row`, where that can be.
fn flow_depth(row: &StringRecord) -> Option<FlowDepth> {
    let number = |index: usize| row.get(index)?.parse::<f64>().ok();
    let samples = row.get(2)?.parse().ok()?;
    let [depth, velocity, error] = [number(0)?, number(1)?, number(3)?];
    let is_sound = (0.0..=DEEPEST).contains(&depth)
        && (velocity.abs() <= FASTEST || samples == 0 && velocity.is_nan())
        && (error.is_nan() || (0.0..=FASTEST).contains(&error));
    is_sound.then_some(FlowDepth {
        depth,
        velocity,
        error: Some(error).filter(|error| !error.is_nan()),
        samples,
    })
}
