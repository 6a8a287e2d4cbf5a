//! `statements.md`: what becomes of a paper's statements in a sweep.
//!
//! In: the ensembles of a sweep. Out: the file, where the sweep varies what the paper varies.

use super::Sweep;
use super::ensemble::Ensemble;
use super::kasper_statements::statements_by_reading;
use super::man_statements::column_statements;
use super::statements::markdown;
use crate::output::write_file;
use crate::runner::RunnerError;

/// The file's name.
const FILE: &str = "statements.md";

/// Writes the file where there is something to compare; returns its name.
///
/// # Errors
/// When it cannot be written.
pub fn write_statements(
    sweep: &Sweep,
    ensembles: &[Ensemble],
) -> Result<Option<String>, RunnerError> {
    let mut readings = statements_by_reading(sweep, ensembles);
    let columns = column_statements(ensembles);
    if !columns.is_empty() {
        readings.push((None, columns));
    }
    if readings.is_empty() {
        return Ok(None);
    }
    let pages = readings.iter().map(|(reading, statements)| {
        let title = reading
            .as_ref()
            .map_or_else(String::new, |own| format!(", {own}"));
        markdown(&title, statements)
    });
    let text = pages.collect::<Vec<_>>().join("\n");
    write_file(&sweep.out.join(FILE), |file| {
        file.write_all(text.as_bytes())
    })?;
    Ok(Some(FILE.to_owned()))
}
