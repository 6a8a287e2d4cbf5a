//! `series.csv`, read back.
//!
//! In: the file. Out: a [`Series`] with what it holds, to the bit; measures that it has no column of
//! are NaN.

use super::RecordingError;
use super::own_files::OwnFile;
use crate::measure::{Measure, Sample, Series};
use crate::run::Column;
use csv::StringRecord;

/// Largest table that is read [bytes]: a day of a drum has a fifth of it.
pub const LARGEST_TABLE: u64 = 1 << 30;

/// The samples in `file`, up to the first row that is none, and what is wrong with that.
///
/// # Errors
/// When it has no columns of samples.
pub fn samples(file: &OwnFile) -> Result<(Series, Option<String>), RecordingError> {
    let refuse = |reason: String| RecordingError::of(&file.path, reason);
    let mut reader = csv::Reader::from_reader(&file.bytes[..]);
    let heads = reader
        .headers()
        .map_err(|error| refuse(error.to_string()))?;
    if heads.get(0) != Some("step [1]") || heads.get(1) != Some("time [s]") {
        return Err(refuse(
            "does not begin with the columns `step [1]` and `time [s]`".into(),
        ));
    }
    let columns: Vec<Option<Measure>> = heads.iter().skip(2).map(measure_of).collect();
    let mut series = Series::default();
    for (index, row) in reader.records().enumerate() {
        let row = row.map_err(|error| error.to_string());
        let sample = row.and_then(|row| {
            let sample = sample(&row, &columns);
            let follows = |sample: &Sample| {
                let last = series.steps().last().zip(series.time().last());
                last.is_none_or(|(step, time)| *step < sample.step && *time <= sample.time)
            };
            sample
                .filter(follows)
                .ok_or_else(|| "is no sample that follows the one before it".into())
        });
        match sample {
            Ok(sample) => series.push(sample),
            Err(reason) => {
                let path = file.path.display();
                let note = format!("{path}: row {} {reason}; samples end before it", index + 2);
                return Ok((series, Some(note)));
            }
        }
    }
    Ok((series, None))
}

/// The measure of the column with this head; none of one that this program does not know.
fn measure_of(head: &str) -> Option<Measure> {
    let mut known = Measure::ALL.into_iter();
    known.find(|measure| Column::of(measure.quantity()).head() == head)
}

fn sample(row: &StringRecord, columns: &[Option<Measure>]) -> Option<Sample> {
    let mut sample = Sample {
        step: row.get(0)?.parse().ok()?,
        time: row
            .get(1)?
            .parse()
            .ok()
            .filter(|time: &f64| time.is_finite())?,
        values: [f64::NAN; Measure::COUNT],
    };
    for (cell, measure) in row.iter().skip(2).zip(columns) {
        if let Some(measure) = measure {
            sample.values[*measure as usize] = cell.parse().ok()?;
        }
    }
    Some(sample)
}
