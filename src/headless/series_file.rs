//! `series.csv`: one row per sample, one column per quantity, headed `name [unit]`, in SI units.

use crate::measure::{Measure, Series};
use std::io::{self, Write};

/// The file's name.
pub const SERIES: &str = "series.csv";

/// Writes all of `series` to `file`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_series(series: &Series, file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    let heads = Measure::ALL.map(|measure| {
        let quantity = measure.quantity();
        format!("{} [{}]", quantity.name, quantity.unit)
    });
    writer.write_record(
        ["step [1]", "time [s]"]
            .into_iter()
            .chain(heads.iter().map(String::as_str)),
    )?;
    for sample in (0..series.len()).filter_map(|index| series.get(index)) {
        writer.write_field(sample.step.to_string())?;
        writer.write_field(format!("{:?}", sample.time))?;
        // The shortest text that reads back as the same bits.
        writer.write_record(sample.values.map(|value| format!("{value:?}")))?;
    }
    writer.flush()
}
