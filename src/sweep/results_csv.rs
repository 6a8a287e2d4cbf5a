//! `table.csv` and `ensembles.csv`: results for programs, a row for each case, and one for each
//! ensemble of cases that differ in their seed alone.
//!
//! In: what became of the cases of a sweep, and their ensembles. Out: the tables, and what their
//! columns hold. Numbers are in SI units and read back as the same bits; where there is no value, the
//! cell is empty. The columns are the varied values and every result that one of the rows has, a mean
//! with its standard error and the independent samples that it is worth; of a case also how it
//! ended, with the whole hash of its last state, of an ensemble the number of its seeds.

use super::case::CaseResult;
use super::ensemble::Ensemble;
use super::variation::SEED;
use super::varied::{parameter, value};
use super::{Sweep, Variation};
use crate::measure::{Format, MeasuredValue, ResultKey, Summary};
use crate::output::{OutputError, write_file};
use crate::parameters::{Kind, Value};
use crate::run::{Cells, Column, Provenance, TABLES_METADATA, Table, write_metadata};

/// The tables' names.
const TABLE: &str = "table.csv";
const ENSEMBLES: &str = "ensembles.csv";

/// Writes the table of `outcomes`, that of their `ensembles` where there are any, and
/// `csv-metadata.json` beside them; returns the files' names.
///
/// # Errors
/// When a file cannot be written.
pub fn write_csv(
    sweep: &Sweep,
    outcomes: &[CaseResult],
    ensembles: &[Ensemble],
) -> Result<Vec<String>, OutputError> {
    let mut tables = vec![write_cases(sweep, outcomes)?];
    if !ensembles.is_empty() {
        tables.push(write_ensembles(sweep, ensembles)?);
    }
    let from = Provenance::of_scene(&sweep.scene);
    write_file(&sweep.out.join(TABLES_METADATA), |file| {
        write_metadata(&tables, &from, file)
    })?;
    let names = tables.into_iter().map(|table| table.name);
    Ok(names.chain([TABLES_METADATA.to_owned()]).collect())
}

fn write_cases(sweep: &Sweep, outcomes: &[CaseResult]) -> Result<Table, OutputError> {
    let results: Vec<ResultColumns> =
        ResultColumns::of(outcomes.iter().map(|outcome| &outcome.results));
    let ending = [
        Column::numbers("time", "s").described("simulated time that the case came to"),
        Column::new("ended", Cells::Words).described("done, interrupted or fault"),
        Column::new("state", Cells::Words).described("hash of the last state"),
    ];
    let varied = sweep.variations.iter().map(varied_column);
    let columns = results.iter().flat_map(ResultColumns::columns);
    let table = Table::new(TABLE, varied.chain(columns).chain(ending));
    let rows = outcomes.iter().map(|outcome| {
        let varied = sweep.variations.iter().zip(&outcome.case.values);
        let varied = varied.map(|(variation, text)| varied_cell(variation, text));
        let ending = [
            number(outcome.results.to),
            outcome.ending.status().to_owned(),
            outcome.hash.clone(),
        ];
        let results = results.iter().flat_map(|own| own.cells(&outcome.results));
        varied.chain(results).chain(ending).collect()
    });
    write_table(sweep, &table, rows)?;
    Ok(table)
}

fn write_ensembles(sweep: &Sweep, ensembles: &[Ensemble]) -> Result<Table, OutputError> {
    let summaries: Vec<Summary> = ensembles.iter().map(Ensemble::results).collect();
    let results = ResultColumns::of(summaries.iter());
    let common: Vec<&Variation> = (sweep.variations.iter())
        .filter(|variation| variation.key != SEED)
        .collect();
    let seeds = Column::new("seeds", Cells::Counts).described("cases that the means are of");
    let varied = common.iter().map(|variation| varied_column(variation));
    let columns = results.iter().flat_map(ResultColumns::columns);
    let table = Table::new(ENSEMBLES, varied.chain([seeds]).chain(columns));
    let rows = ensembles.iter().zip(&summaries).map(|(ensemble, summary)| {
        let varied = common.iter().zip(&ensemble.values);
        let varied = varied.map(|(variation, text)| varied_cell(variation, text));
        let results = results.iter().flat_map(|own| own.cells(summary));
        let seeds = ensemble.members.len().to_string();
        varied.chain([seeds]).chain(results).collect()
    });
    write_table(sweep, &table, rows)?;
    Ok(table)
}

fn write_table(
    sweep: &Sweep,
    table: &Table,
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<(), OutputError> {
    write_file(&sweep.out.join(&table.name), |file| {
        let mut writer = csv::Writer::from_writer(file);
        writer.write_record(table.heads())?;
        for row in rows {
            writer.write_record(row)?;
        }
        writer.flush()
    })
}

/// A result that one of the rows has, or would have if there were something to take it of.
struct ResultColumns {
    key: ResultKey,
    /// Whether it is a mean in one of them, beside which its error stands.
    is_mean: bool,
}

impl ResultColumns {
    /// Those of all `rows`.
    fn of<'a>(rows: impl Iterator<Item = &'a Summary>) -> Vec<Self> {
        let rows: Vec<&Summary> = rows.collect();
        let is_there = |key: &ResultKey| {
            let has = |row: &&Summary| row.entry(*key).is_some() || row.get(*key).is_some();
            rows.iter().any(has)
        };
        let found = ResultKey::all().filter(is_there);
        found
            .map(|key| Self {
                key,
                is_mean: rows.iter().any(|row| row.estimate(key).is_some()),
            })
            .collect()
    }

    fn columns(&self) -> Vec<Column> {
        let (quantity, name) = (self.key.quantity(), self.key.name());
        let cells = match quantity.format {
            Format::Choice(_) => Cells::Words,
            _ => Cells::Numbers(quantity.unit.si),
        };
        let mut columns = vec![Column::new(&name, cells).described(quantity.explanation())];
        if self.is_mean {
            let error = Column::new(format!("{name} error"), cells);
            columns
                .push(error.described("standard error; empty where too little was seen for one"));
            let samples = Column::new(format!("{name} samples"), Cells::Counts);
            columns.push(samples.described("independent samples that the mean is worth"));
        }
        columns
    }

    fn cells(&self, row: &Summary) -> Vec<String> {
        let mut cells = vec![cell(row.get(self.key))];
        if self.is_mean {
            let mean = row.estimate(self.key);
            let error = mean.and_then(|mean| mean.error);
            cells.push(error.map_or_else(String::new, number));
            cells.push(mean.map_or_else(String::new, |mean| mean.samples.to_string()));
        }
        cells
    }
}

/// The column of what is varied.
fn varied_column(variation: &Variation) -> Column {
    let values = || {
        let values = variation.values.iter();
        values.filter_map(|text| value(&variation.key, text))
    };
    let kind = parameter(&variation.key).map(|parameter| &parameter.row().kind);
    let cells = match kind {
        Some(Kind::Count) => Cells::Counts,
        Some(Kind::Number(unit)) => Cells::Numbers(unit.si),
        Some(Kind::NumberOr(unit, _))
            if values().all(|value| matches!(value, Value::Number(_))) =>
        {
            Cells::Numbers(unit.si)
        }
        Some(Kind::NumberOr(..) | Kind::Choice(_)) | None => Cells::Words,
    };
    Column::new(&variation.key, cells).described("varied")
}

/// What `text` says of what is varied, in the SI unit.
fn varied_cell(variation: &Variation, text: &str) -> String {
    value(&variation.key, text).map_or_else(|| text.to_owned(), |value| value.to_string())
}

fn cell(value: Option<MeasuredValue>) -> String {
    match value {
        Some(MeasuredValue::Number(value)) => number(value),
        Some(MeasuredValue::Mean(mean)) => number(mean.mean),
        Some(MeasuredValue::Count(count)) => count.to_string(),
        Some(MeasuredValue::Choice(word)) => word.to_owned(),
        None => String::new(),
    }
}

/// The shortest text that reads back as the same bits; of what is no number none.
fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:?}")
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn varied_values_are_in_si_units_whatever_they_were_typed_in() {
        let radius = Variation::parse("radius=3mm,2.5e-3").unwrap();
        assert_eq!(varied_column(&radius).head(), "radius [m]");
        assert_eq!(value("radius", "3mm").unwrap().to_string(), "0.003");
        let liquid = Variation::parse("liquid=0..7").unwrap();
        assert_eq!(varied_column(&liquid).head(), "liquid");
        assert_eq!(value("liquid", "0").unwrap().to_string(), "dry");
        let seeds = Variation::parse("seed=1..3").unwrap();
        assert_eq!(varied_column(&seeds).head(), "seed [1]");
    }

    #[test]
    fn what_is_missing_is_empty_and_numbers_keep_every_digit() {
        assert_eq!(cell(None), "");
        assert_eq!(cell(Some(f64::NAN.into())), "");
        assert_eq!(cell(Some((0.1_f64 + 0.2).into())), "0.30000000000000004");
        assert_eq!(cell(Some(MeasuredValue::Count(7))), "7");
        assert_eq!(cell(Some(MeasuredValue::Choice("cone"))), "cone");
    }
}
