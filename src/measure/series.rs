//! Samples of a run, kept in columns so that a plot or an average can borrow one.

use super::sample::Sample;
use super::sample_column::Column;
use super::sampled_quantity::Measure;
use serde::{Deserialize, Serialize};

/// Samples in order of time, column by column. All of a run are kept, so that any part of it can
/// be plotted and averaged: at most 20 kB for a simulated second of a bed, as a column that never
/// changes takes no room. Those that stand in a file may be forgotten ([`Series::forget`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Samples that were forgotten, before the first that is here.
    #[serde(skip)]
    forgotten: usize,
    steps: Vec<u64>,
    time: Vec<f64>,
    #[serde(with = "columns")]
    columns: [Column; Measure::COUNT],
}

impl Default for Series {
    fn default() -> Self {
        Self {
            forgotten: 0,
            steps: Vec::new(),
            time: Vec::new(),
            columns: std::array::from_fn(|_| Column::default()),
        }
    }
}

impl Series {
    /// Appends a sample.
    pub fn push(&mut self, sample: Sample) {
        self.steps.push(sample.step);
        self.time.push(sample.time);
        for (column, value) in self.columns.iter_mut().zip(sample.values) {
            column.push(value);
        }
    }

    /// Samples that were taken: those that are here and those that were forgotten.
    pub fn taken(&self) -> usize {
        self.forgotten + self.len()
    }

    /// Whether some were forgotten.
    pub fn is_part(&self) -> bool {
        self.forgotten > 0
    }

    /// Forgets the first `samples` of all that were taken, but for the last one.
    pub fn forget(&mut self, samples: usize) {
        let count = samples.min(self.taken().saturating_sub(1));
        let count = count.saturating_sub(self.forgotten);
        self.steps.drain(..count);
        self.time.drain(..count);
        for column in &mut self.columns {
            column.forget(count);
        }
        self.forgotten += count;
    }

    /// All of `earlier`, the first samples of the same run, and what follows them here.
    #[must_use]
    pub fn behind(&self, mut earlier: Self) -> Self {
        let new = self.since(earlier.taken());
        new.for_each(|sample| earlier.push(sample));
        earlier
    }

    /// The samples from this one on, counted from the first that was taken; those that are here.
    pub fn since(&self, taken: usize) -> impl Iterator<Item = Sample> {
        let first = taken.saturating_sub(self.forgotten);
        (first..self.len()).filter_map(|index| self.get(index))
    }

    /// How many of the samples that were taken were so until this `step`.
    pub fn taken_until(&self, step: u64) -> usize {
        self.forgotten + self.steps.partition_point(|taken| *taken <= step)
    }

    /// Memory that its samples take [bytes], without room for more.
    pub fn memory(&self) -> usize {
        let columns = self.columns.iter().map(Column::memory);
        8 * (self.steps.len() + self.time.len()) + columns.sum::<usize>()
    }

    /// Whether its columns are of one length and its samples in order, as a file may not say.
    pub fn is_whole(&self) -> bool {
        let len = self.len();
        self.steps.len() == len
            && self.columns.iter().all(|column| column.len() == len)
            && self.steps.is_sorted()
            && self.time.is_sorted()
            && self.time.iter().all(|time| time.is_finite())
    }

    /// Number of samples that are here.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Steps taken at each sample.
    pub fn steps(&self) -> &[u64] {
        &self.steps
    }

    /// Time of each sample [s].
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// One measure at each sample, in SI units.
    pub fn column(&self, measure: Measure) -> &[f64] {
        self.columns[measure as usize].values()
    }

    /// The sample at `index`, if there is one.
    pub fn get(&self, index: usize) -> Option<Sample> {
        (index < self.len()).then(|| Sample {
            step: self.steps[index],
            time: self.time[index],
            values: std::array::from_fn(|column| self.columns[column].at(index)),
        })
    }

    /// The newest sample.
    pub fn last(&self) -> Option<Sample> {
        self.len().checked_sub(1).and_then(|index| self.get(index))
    }

    /// Index of the first sample at or after `time` [s].
    pub fn first_at(&self, time: f64) -> usize {
        self.time.partition_point(|&t| t < time)
    }

    /// Becomes the first `len` samples of `other`.
    pub fn copy_first(&mut self, other: &Self, len: usize) {
        let len = len.min(other.len());
        self.forgotten = other.forgotten;
        self.steps.clear();
        self.steps.extend_from_slice(&other.steps[..len]);
        self.time.clear();
        self.time.extend_from_slice(&other.time[..len]);
        for (own, other) in self.columns.iter_mut().zip(&other.columns) {
            own.copy_first(other, len);
        }
    }

    /// Keeps the first `len` samples.
    pub fn truncate(&mut self, len: usize) {
        self.steps.truncate(len);
        self.time.truncate(len);
        for column in &mut self.columns {
            column.truncate(len);
        }
    }
}

/// The columns in a file: a list that has one entry per measure. A file of an earlier build lacks
/// the measures that were added since: samples in it have no value of them.
mod columns {
    use super::{Column, Measure};
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    type Columns = [Column; Measure::COUNT];

    /// Columns of the first sessions of this version.
    const FEWEST: usize = Measure::MixingIndex as usize;

    pub fn serialize<S: Serializer>(columns: &Columns, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(columns.iter().map(Column::values))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Columns, D::Error> {
        let mut columns: Vec<Vec<f64>> = Vec::deserialize(deserializer)?;
        if (FEWEST..Measure::COUNT).contains(&columns.len()) {
            let unknown = vec![f64::NAN; columns[0].len()];
            columns.resize(Measure::COUNT, unknown);
        }
        let columns: Vec<Column> = columns.into_iter().map(Column::from).collect();
        let count = columns.len();
        let expected = format!("{FEWEST} to {} columns", Measure::COUNT);
        (columns.try_into()).map_err(|_| D::Error::invalid_length(count, &expected.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_an_earlier_build_have_no_value_of_what_was_added_since() {
        let of = |columns: usize| {
            let columns = vec![vec![1.0, 2.0]; columns];
            let series = (vec![0_u64, 5], vec![0.0, 0.1], columns);
            let bytes = postcard::to_stdvec(&series).unwrap();
            postcard::from_bytes::<Series>(&bytes)
        };
        let earlier = of(Measure::MixingIndex as usize).unwrap();
        assert!(earlier.is_whole());
        assert_eq!(earlier.column(Measure::SecondPairs), [1.0, 2.0]);
        let added = earlier.column(Measure::MixingIndex);
        assert!(added.len() == 2 && added.iter().all(|value| value.is_nan()));
        for wrong in [0, Measure::MixingIndex as usize - 1, Measure::COUNT + 1] {
            assert!(of(wrong).is_err(), "{wrong} columns");
        }
    }
}
