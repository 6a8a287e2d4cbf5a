//! Results of a run, each under its key.
//!
//! In: results one by one, from `run_summary` and `column_summary`. Out: a value by its key, or all
//! of them as `summary.json` lists them. Nothing is computed here but what follows from one result.

use super::estimate::Estimate;
use super::quantity::MeasuredValue;
use super::regime::Regime;
use super::result_key::ResultKey;
use super::rigid_rotation::rotation_note;
use super::run_quantity::RunQuantity;
use serde::{Serialize, Serializer};

/// One result.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryEntry {
    /// What it is.
    pub key: ResultKey,
    /// Its value, a number or a mean with its error, in the SI unit; none where there is nothing to
    /// average.
    pub value: Option<MeasuredValue>,
    /// How it was taken.
    pub note: String,
}

/// Results of a window of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Time of the first sample that counts [s].
    pub from: f64,
    /// Time of the last sample [s].
    pub to: f64,
    /// Number of samples that count.
    pub samples: usize,
    /// The results.
    pub entries: Vec<SummaryEntry>,
}

/// As `summary.json` has it: the name of the key and the SI unit beside value and note; of a mean
/// its standard error, null where too little was seen for one, and the number of independent
/// samples that it is worth.
impl Serialize for SummaryEntry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct InFile<'a> {
            name: String,
            unit: &'static str,
            value: Option<MeasuredValue>,
            #[serde(flatten)]
            scatter: Option<Scatter>,
            note: &'a str,
        }
        #[derive(Serialize)]
        struct Scatter {
            error: Option<f64>,
            independent_samples: usize,
        }
        let scatter = self.estimate().map(|estimate| Scatter {
            error: estimate.error,
            independent_samples: estimate.samples,
        });
        let in_file = InFile {
            name: self.key.name(),
            unit: self.key.quantity().unit.si,
            value: self.value,
            scatter,
            note: &self.note,
        };
        in_file.serialize(serializer)
    }
}

/// What a result is noted with that was taken as its description says: beside the temperature of
/// rigid rotation also what to think of it.
pub(super) fn usual_note(key: ResultKey, value: Option<MeasuredValue>) -> String {
    let note = key.quantity().explanation();
    let is_of_rotation = key == ResultKey::OfRun(RunQuantity::RotationTemperature);
    let number = value.and_then(MeasuredValue::as_number);
    match number.filter(|_| is_of_rotation).and_then(rotation_note) {
        Some(warning) => format!("{note}. {warning}"),
        None => note,
    }
}

impl SummaryEntry {
    /// The mean with its error, where the result is one.
    pub fn estimate(&self) -> Option<Estimate> {
        self.value.and_then(MeasuredValue::as_estimate)
    }
}

#[cfg(test)]
impl Summary {
    /// Numbers that a run came to, without notes.
    pub(crate) fn of_numbers(numbers: &[(ResultKey, f64)]) -> Self {
        let entry = |(key, value): &(ResultKey, f64)| SummaryEntry {
            key: *key,
            value: Some(MeasuredValue::Number(*value)),
            note: String::new(),
        };
        Self {
            from: 20.0,
            to: 50.0,
            samples: 1500,
            entries: numbers.iter().map(entry).collect(),
        }
    }
}

impl Summary {
    /// The entry of `key`, if the run has that result.
    pub fn entry(&self, key: impl Into<ResultKey>) -> Option<&SummaryEntry> {
        let key = key.into();
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// The value of the result `key`, if the run has it and it is defined; √(1/Ga), which is no
    /// entry, from that of Ga.
    pub fn get(&self, key: impl Into<ResultKey>) -> Option<MeasuredValue> {
        let key = key.into();
        if key == ResultKey::OfRun(RunQuantity::InverseRootGalilei) {
            let galilei = self.value(RunQuantity::GalileiNumber)?;
            return Some(MeasuredValue::Number(galilei.powf(-0.5)));
        }
        self.entry(key)?.value
    }

    /// The same as a number in the SI unit; none for a choice.
    pub fn value(&self, key: impl Into<ResultKey>) -> Option<f64> {
        self.get(key)?.as_number()
    }

    /// The result `key` with what is known of its error, if it is a mean.
    pub fn estimate(&self, key: impl Into<ResultKey>) -> Option<Estimate> {
        self.entry(key)?.estimate()
    }

    /// The result `key` with its unit, as people read it; a dash where there is none.
    pub fn text(&self, key: impl Into<ResultKey>) -> String {
        let key = key.into();
        let value = self.get(key).unwrap_or(MeasuredValue::Number(f64::NAN));
        key.quantity().text(value)
    }

    /// The same, and why there is no error where a mean has none: `28.31° ± ? (too short: 3
    /// independent samples)`.
    pub fn text_in_full(&self, key: impl Into<ResultKey>) -> String {
        let key = key.into();
        let reason = self.estimate(key).and_then(|mean| mean.reason());
        let reason = reason.map_or_else(String::new, |reason| format!(" ({reason})"));
        format!("{}{reason}", self.text(key))
    }

    /// What to think of the non-rigid share where rotation alone looks like flow.
    pub fn rotation_note(&self) -> Option<String> {
        rotation_note(self.value(RunQuantity::RotationTemperature)?)
    }

    /// How the bed moves, by the drops and by the share of the time in which it flows as the
    /// turning drum sees it, where rigid rotation is no flow; none where nothing was sampled.
    pub fn regime(&self) -> Option<Regime> {
        let flowing = self.value(RunQuantity::CorotatingShare)?;
        let drop = self.value(RunQuantity::Drop).unwrap_or(0.0);
        Some(Regime::of(flowing, drop))
    }

    /// Adds a number in the SI unit, noted with the quantity's own description; none where it is
    /// not finite.
    pub(super) fn add(&mut self, key: impl Into<ResultKey>, value: f64) {
        let key = key.into();
        self.add_noted(key, value, key.quantity().explanation());
    }

    /// Adds a number that was taken in another way than its description says.
    pub(super) fn add_noted(&mut self, key: impl Into<ResultKey>, value: f64, note: String) {
        let value = value.is_finite().then_some(MeasuredValue::Number(value));
        let key = key.into();
        self.entries.push(SummaryEntry { key, value, note });
    }

    /// Adds a mean with its error, noted with the quantity's own description; none where it is not
    /// finite.
    pub(super) fn add_mean(&mut self, key: impl Into<ResultKey>, mean: Estimate) {
        let key = key.into();
        self.add_noted_mean(key, mean, key.quantity().explanation());
    }

    /// Adds a mean that was taken in another way than its description says.
    pub(super) fn add_noted_mean(
        &mut self,
        key: impl Into<ResultKey>,
        mean: Estimate,
        note: String,
    ) {
        let value = mean.mean.is_finite().then_some(MeasuredValue::Mean(mean));
        let key = key.into();
        self.entries.push(SummaryEntry { key, value, note });
    }

    /// Adds a count or a choice; none where there is nothing to choose by.
    pub(super) fn add_value(&mut self, key: impl Into<ResultKey>, value: Option<MeasuredValue>) {
        let key = key.into();
        self.entries.push(SummaryEntry {
            key,
            value,
            note: key.quantity().explanation(),
        });
    }
}
