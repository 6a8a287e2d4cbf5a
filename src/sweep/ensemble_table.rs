//! The means over the seeds that people compare, one row for each ensemble of cases:
//! `ensembles.md`.
//!
//! In: the ensembles of a sweep. Out: a table in Markdown with the columns of the table of cases,
//! each a mean with its standard error, and the number of seeds that it is of.

use super::Sweep;
use super::ensemble::Ensemble;
use super::results_table::{TableColumn, columns};
use super::variation::SEED;
use crate::output::{OutputError, write_file};

/// The file's name.
const FILE: &str = "ensembles.md";

/// Writes the table in Markdown; returns its name.
///
/// # Errors
/// When the file cannot be written.
pub fn write_markdown(sweep: &Sweep, ensembles: &[Ensemble]) -> Result<String, OutputError> {
    let text = markdown(sweep, ensembles);
    write_file(&sweep.out.join(FILE), |file| {
        file.write_all(text.as_bytes())
    })?;
    Ok(FILE.to_owned())
}

/// The table in Markdown.
pub fn markdown(sweep: &Sweep, ensembles: &[Ensemble]) -> String {
    let columns = own_columns(ensembles);
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let heads = columns.iter().map(TableColumn::head);
    let heads = row(common_keys(sweep), "seeds".into(), heads);
    let rule = line(&vec!["---".to_owned(); heads.len()]);
    let rows = ensembles.iter().map(|ensemble| {
        let results = ensemble.results();
        let cells = columns
            .iter()
            .map(|column| column.cell_for_people(&results));
        line(&row(ensemble.values.clone(), seeds(ensemble), cells))
    });
    [line(&heads), rule].into_iter().chain(rows).collect()
}

/// The columns of the table of cases.
fn own_columns(ensembles: &[Ensemble]) -> &'static [TableColumn] {
    columns(ensembles.iter().any(|own| own.first().is_column()))
}

fn row(varied: Vec<String>, seeds: String, results: impl Iterator<Item = String>) -> Vec<String> {
    varied.into_iter().chain([seeds]).chain(results).collect()
}

fn common_keys(sweep: &Sweep) -> Vec<String> {
    let keys = sweep.variations.iter().map(|variation| &variation.key);
    keys.filter(|key| *key != SEED).cloned().collect()
}

fn seeds(ensemble: &Ensemble) -> String {
    ensemble.members.len().to_string()
}
