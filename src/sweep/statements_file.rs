//! `statements.md`: what becomes of a paper's statements in a sweep.
//!
//! In: the ensembles of a sweep. Out: the file, where the sweep varies what the paper varies.

use super::Sweep;
use super::ensemble::Ensemble;
use super::kasper_statements::{StatementsOfReading, statements_by_reading};

use super::columns::{ColumnMeasure, Columns};
use super::man_statements::column_statements;
use super::statements::markdown;
use super::variation::READING;
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
    readings.extend(columns_by_reading(ensembles));
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

/// The statements for which `ensembles` has columns, reading by reading where that is varied.
fn columns_by_reading(ensembles: &[Ensemble]) -> Vec<StatementsOfReading> {
    let all: Vec<&Ensemble> = ensembles.iter().collect();
    let mut readings: Vec<Option<&str>> = Vec::new();
    for reading in ensembles.iter().map(|own| own.value_of(READING)) {
        if !readings.contains(&reading) {
            readings.push(reading);
        }
    }
    let of = |reading: Option<&str>| {
        let own = ensembles
            .iter()
            .filter(|own| own.value_of(READING) == reading);
        let columns = Columns::of(own, &all, ColumnMeasure::Usual);
        (reading.map(str::to_owned), column_statements(&columns))
    };
    let found = readings.into_iter().map(of);
    found.filter(|(_, own)| !own.is_empty()).collect()
}
