//! `series.csv`: one row per sample, one column per quantity that has a meaning in the scene,
//! headed `key [unit]`, in SI units.

use crate::measure::{Measure, Series};
use std::io::{self, Write};

/// The file's name.
pub const SERIES: &str = "series.csv";

/// Writes the `measures` of `series` to `file`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_series(series: &Series, measures: &[Measure], file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    let head = |measure: &Measure| measure.quantity().column();
    let first = ["step [1]", "time [s]"].map(str::to_owned);
    writer.write_record(first.into_iter().chain(measures.iter().map(head)))?;
    for sample in (0..series.len()).filter_map(|index| series.get(index)) {
        writer.write_field(sample.step.to_string())?;
        writer.write_field(format!("{:?}", sample.time))?;
        // The shortest text that reads back as the same bits.
        let value = |measure: &Measure| format!("{:?}", sample.value(*measure));
        writer.write_record(measures.iter().map(value))?;
    }
    writer.flush()
}
