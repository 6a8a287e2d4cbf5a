//! `series.csv`: one row per sample, one column per quantity that has a meaning in the scene,
//! headed `key [unit]`, in SI units.
//!
//! In: a run so far, again and again. Out: the file, which grows by the rows that are new.

use super::{OutputError, OutputFolder, RunSoFar};
use crate::files::GrowingFile;
use crate::measure::{Measure, Series};
use crate::run::{Cells, Column, Table};
use std::io::{self, Write};

/// The file's name.
pub const SERIES: &str = "series.csv";

/// The file of a run.
pub struct SeriesFile {
    file: GrowingFile,
    measures: Vec<Measure>,
    /// Samples that are in it.
    rows: usize,
    digest: blake3::Hasher,
}

impl SeriesFile {
    /// Writes the file with what there is of `run`; of none, its head alone.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn begin(folder: &OutputFolder, run: Option<RunSoFar>) -> Result<Self, OutputError> {
        let measures = run.map_or_else(Vec::new, |run| Measure::of(run.world));
        let rows = run.map_or(0, |run| run.series.taken());
        let mut text = Vec::new();
        let written = write_head(&measures, &mut text).and_then(|()| match run {
            Some(run) => write_rows(run.series, 0, &measures, &mut text),
            None => Ok(()),
        });
        folder.named(SERIES, written)?;
        let mut digest = blake3::Hasher::new();
        digest.update(&text);
        Ok(Self {
            file: folder.begin(SERIES, &text, b"")?,
            measures,
            rows,
            digest,
        })
    }

    /// Adds what is new of `run`. Where other quantities have got a meaning since, the file is
    /// written anew.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn go_on(&mut self, folder: &OutputFolder, run: RunSoFar) -> Result<(), OutputError> {
        if run.series.taken() == self.rows {
            return Ok(());
        }
        if self.begins_anew(run) {
            *self = Self::begin(folder, Some(run))?;
            return Ok(());
        }
        let mut text = Vec::new();
        let added = write_rows(run.series, self.rows, &self.measures, &mut text)
            .and_then(|()| self.file.add(&text));
        folder.named(SERIES, added)?;
        self.digest.update(&text);
        self.rows = run.series.taken();
        Ok(())
    }

    /// Whether the next samples need other columns: then it takes all samples to go on.
    pub fn begins_anew(&self, run: RunSoFar) -> bool {
        run.series.taken() != self.rows && Measure::of(run.world) != self.measures
    }

    /// Makes it durable.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&self, folder: &OutputFolder) -> Result<(), OutputError> {
        folder.named(SERIES, self.file.sync())
    }

    /// What stands in it.
    pub fn table(&self) -> Table {
        table(&self.measures)
    }

    /// The digest of its bytes.
    pub fn digest(&self) -> String {
        self.digest.finalize().to_hex().to_string()
    }
}

fn table(measures: &[Measure]) -> Table {
    let clock = [
        Column::new("step", Cells::Counts),
        Column::numbers("time", "s"),
    ];
    let measured = measures
        .iter()
        .map(|measure| Column::of(measure.quantity()));
    Table::new(SERIES, clock.into_iter().chain(measured))
}

fn write_head(measures: &[Measure], file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(table(measures).heads())?;
    writer.flush()
}

/// Writes a row for each sample from the `first` on.
fn write_rows(
    series: &Series,
    first: usize,
    measures: &[Measure],
    file: &mut dyn Write,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    for sample in series.since(first) {
        writer.write_field(sample.step.to_string())?;
        writer.write_field(format!("{:?}", sample.time))?;
        // The shortest text that reads back as the same bits.
        let value = |measure: &Measure| format!("{:?}", sample.value(*measure));
        writer.write_record(measures.iter().map(value))?;
    }
    writer.flush()
}
