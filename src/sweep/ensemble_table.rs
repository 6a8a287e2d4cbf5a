//! The table of means over the seeds, one row for each ensemble of cases.
//!
//! In: the ensembles of a sweep. Out: `ensembles.csv` and `ensembles.md`, with the columns of the
//! table of cases, each a mean with its standard error and the number of seeds that it is of.

use super::Sweep;
use super::ensemble::Ensemble;
use super::plan::SEED;
use super::results_table::{TableColumn, columns};
use crate::measure::Format;
use crate::output::write_file;
use crate::runner::RunnerError;

/// The names of both files.
const FILES: [&str; 2] = ["ensembles.csv", "ensembles.md"];

/// Writes both files; returns their names.
///
/// # Errors
/// When a file cannot be written.
pub fn write_tables(sweep: &Sweep, ensembles: &[Ensemble]) -> Result<Vec<String>, RunnerError> {
    let columns = own_columns(ensembles);
    write_file(&sweep.out.join(FILES[0]), |file| {
        let mut writer = csv::Writer::from_writer(file);
        let heads = columns.iter().flat_map(TableColumn::heads);
        writer.write_record(row(common_keys(sweep), "seeds".into(), heads))?;
        for ensemble in ensembles {
            let results = ensemble.results();
            let cells = columns.iter().flat_map(|column| column.cells(&results));
            writer.write_record(row(ensemble.values.clone(), seeds(ensemble), cells))?;
        }
        writer.flush()
    })?;
    let text = markdown(sweep, ensembles);
    write_file(&sweep.out.join(FILES[1]), |file| {
        file.write_all(text.as_bytes())
    })?;
    Ok(FILES.map(str::to_owned).into())
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

/// The columns of the table of cases; over seeds every number has an error.
fn own_columns(ensembles: &[Ensemble]) -> Vec<TableColumn> {
    let is_of_columns = ensembles
        .iter()
        .any(|ensemble| ensemble.first().is_column());
    let own = |column: &TableColumn| match column.format {
        Format::Choice(_) => column.clone(),
        _ => column.clone().with_error(),
    };
    columns(is_of_columns).iter().map(own).collect()
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
