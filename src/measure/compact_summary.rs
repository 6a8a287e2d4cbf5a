//! Results of a run in little room, as a line of JSON holds them.
//!
//! In: a [`Summary`]. Out: a [`CompactSummary`], and from it an equal summary, to the last bit.
//! Results stand under their names in their order: a number as it is, a count without a point, a
//! word, a mean as `[mean, error, independent samples, degrees of freedom]`, all in SI units. The
//! five numbers of the avalanches, and of those from one threshold on, stand in one list under the
//! name of their count, or are said to be as others before them. A note is written only where it is
//! not the usual one of its quantity.

use super::estimate::Estimate;
use super::quantity::{Format, MeasuredValue};
use super::result_key::ResultKey;
use super::run_quantity::RunQuantity;
use super::summary::{Summary, SummaryEntry, usual_note};
use serde::{Deserialize, Serialize};

/// Stands in a note for the usual one of the quantity.
const USUAL: &str = "{}";

/// The numbers of avalanches, in the order of [`ResultKey::AVALANCHE_QUANTITIES`].
type OfAvalanches = [Option<CompactValue>; ResultKey::AVALANCHE_QUANTITIES.len()];

/// Results of a run in little room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CompactSummary {
    from: f64,
    to: f64,
    samples: usize,
    results: Vec<(String, Cell)>,
    /// Notes, each with the places of the results that it stands at.
    notes: Vec<(String, Vec<usize>)>,
}

/// A result, or the numbers of avalanches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum Cell {
    One(Option<CompactValue>),
    OfAvalanches(OfAvalanches),
    /// The same numbers of avalanches as those of this name, which stand before.
    Same {
        #[serde(rename = "as")]
        name: String,
    },
}

/// A value; the order tells a count from a number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum CompactValue {
    Count(usize),
    Number(f64),
    Mean(f64, Option<f64>, usize, usize),
    Word(String),
}

impl From<MeasuredValue> for CompactValue {
    fn from(value: MeasuredValue) -> Self {
        match value {
            MeasuredValue::Count(count) => Self::Count(count),
            MeasuredValue::Number(number) => Self::Number(number),
            MeasuredValue::Mean(own) => Self::Mean(own.mean, own.error, own.samples, own.freedom),
            MeasuredValue::Choice(word) => Self::Word(word.to_owned()),
        }
    }
}

impl CompactValue {
    /// The value of the result `key`; none where it is a word that this result cannot be.
    fn of(self, key: ResultKey) -> Option<MeasuredValue> {
        Some(match self {
            Self::Count(count) => MeasuredValue::Count(count),
            Self::Number(number) => MeasuredValue::Number(number),
            Self::Mean(mean, error, samples, freedom) => MeasuredValue::Mean(Estimate {
                mean,
                error,
                samples,
                freedom,
            }),
            Self::Word(word) => {
                let Format::Choice(words) = key.quantity().format else {
                    return None;
                };
                MeasuredValue::Choice(words.iter().copied().find(|own| *own == word)?)
            }
        })
    }
}

impl From<&Summary> for CompactSummary {
    fn from(summary: &Summary) -> Self {
        let mut results: Vec<(String, Cell)> = Vec::new();
        let mut rest = &summary.entries[..];
        while let Some(entry) = rest.first() {
            let count = ResultKey::AVALANCHE_QUANTITIES.len();
            let (cell, taken) = match rest.get(..count).and_then(of_avalanches) {
                Some(values) => (Cell::OfAvalanches(values), count),
                None => (Cell::One(entry.value.map(Into::into)), 1),
            };
            let is_same = |(_, known): &&(String, Cell)| taken > 1 && *known == cell;
            let same = results.iter().find(is_same);
            let cell = same
                .map(|(name, _)| Cell::Same { name: name.clone() })
                .unwrap_or(cell);
            results.push((entry.key.name(), cell));
            rest = &rest[taken..];
        }
        Self {
            from: summary.from,
            to: summary.to,
            samples: summary.samples,
            results,
            notes: notes(&summary.entries),
        }
    }
}

/// The values of `entries` where they are the numbers of avalanches.
fn of_avalanches(entries: &[SummaryEntry]) -> Option<OfAvalanches> {
    let expected = avalanche_keys(entries.first()?.key)?;
    let own = entries.iter().map(|entry| entry.key);
    let values: Vec<_> = (entries.iter())
        .map(|entry| entry.value.map(Into::into))
        .collect();
    own.eq(expected).then_some(values)?.try_into().ok()
}

/// The keys of the numbers of avalanches of which `key` is the count; none where it is no count.
fn avalanche_keys(key: ResultKey) -> Option<[ResultKey; ResultKey::AVALANCHE_QUANTITIES.len()]> {
    let all = ResultKey::AVALANCHE_QUANTITIES;
    match key {
        ResultKey::OfRun(RunQuantity::Avalanches) => Some(all.map(ResultKey::OfRun)),
        ResultKey::OfAvalanches(RunQuantity::Avalanches, threshold) => {
            Some(all.map(|own| ResultKey::OfAvalanches(own, threshold)))
        }
        _ => None,
    }
}

/// The notes that are not the usual ones, each with the places of its entries.
fn notes(entries: &[SummaryEntry]) -> Vec<(String, Vec<usize>)> {
    let mut notes: Vec<(String, Vec<usize>)> = Vec::new();
    for (place, entry) in entries.iter().enumerate() {
        let usual = usual_note(entry.key, entry.value);
        if entry.note == usual {
            continue;
        }
        let note = match &usual[..] {
            "" => entry.note.clone(),
            usual => entry.note.replace(usual, USUAL),
        };
        match notes.iter_mut().find(|(known, _)| *known == note) {
            Some((_, places)) => places.push(place),
            None => notes.push((note, vec![place])),
        }
    }
    notes
}

impl CompactSummary {
    /// The summary that it is of.
    ///
    /// # Errors
    /// What of it this program does not know.
    pub fn summary(self) -> Result<Summary, String> {
        let mut entries = Vec::new();
        for (name, cell) in &self.results {
            let unknown = || format!("no result is called “{name}”");
            let key = ResultKey::named(name).ok_or_else(unknown)?;
            let cell = match cell {
                Cell::Same { name: other } => self.cell(other)?,
                own => own,
            };
            if let Cell::One(value) = cell {
                entries.push(entry(key, value.clone())?);
                continue;
            }
            let (Cell::OfAvalanches(values), Some(keys)) = (cell, avalanche_keys(key)) else {
                return Err(format!("the result “{name}” is no list of several"));
            };
            for (key, value) in keys.into_iter().zip(values) {
                entries.push(entry(key, value.clone())?);
            }
        }
        for (note, places) in self.notes {
            for place in places {
                let entry: &mut SummaryEntry = (entries.get_mut(place)).ok_or_else(|| {
                    format!("a note stands at result {place}, which is not there")
                })?;
                entry.note = note.replace(USUAL, &entry.note);
            }
        }
        Ok(Summary {
            from: self.from,
            to: self.to,
            samples: self.samples,
            entries,
        })
    }

    /// What stands under the result `name`.
    fn cell(&self, name: &str) -> Result<&Cell, String> {
        let mut results = self.results.iter();
        let own = results.find(|(own, _)| own == name);
        let unknown = || format!("no result “{name}” stands there");
        Ok(&own.ok_or_else(unknown)?.1)
    }
}

/// The result `key`, noted as usual.
fn entry(key: ResultKey, value: Option<CompactValue>) -> Result<SummaryEntry, String> {
    let value = match value {
        None => None,
        Some(own) => {
            let unknown = || format!("the result “{}” is a word it cannot be", key.name());
            Some(own.of(key).ok_or_else(unknown)?)
        }
    };
    Ok(SummaryEntry {
        key,
        value,
        note: usual_note(key, value),
    })
}

#[cfg(test)]
mod tests {
    use super::super::result_key::DropThreshold;
    use super::super::sampled_quantity::Measure;
    use super::*;

    /// What comes back of `summary` from a line of JSON.
    fn read_back(summary: &Summary) -> Summary {
        let text = serde_json::to_string(&CompactSummary::from(summary)).unwrap();
        let compact: CompactSummary = serde_json::from_str(&text).unwrap();
        compact.summary().unwrap()
    }

    /// A value of every kind, numbers that take all their digits, and notes of every kind.
    fn summary() -> Summary {
        let mut summary = Summary {
            from: 20.0,
            to: 50.0 / 3.0,
            samples: 1500,
            entries: Vec::new(),
        };
        let mean = |mean, error| Estimate {
            mean,
            error,
            samples: 45,
            freedom: 9,
        };
        let note = || "mean over the window".to_owned();
        summary.add_noted_mean(Measure::SurfaceAngle, mean(0.1 + 0.2, Some(1e-300)), note());
        summary.add_noted_mean(Measure::MeanSpeed, mean(-0.0, None), note());
        summary.add_mean(RunQuantity::Drop, Estimate::of_events(&[]));
        summary.add(RunQuantity::RiseRate, 5.0);
        summary.add(RunQuantity::PeakTime, f64::NAN);
        let own = Measure::ApexHeight.quantity().explanation();
        summary.add_noted(Measure::ApexHeight, 2e9, format!("at the end. {own}"));
        summary.add_value(
            RunQuantity::Regime,
            Some(MeasuredValue::Choice("continuous")),
        );
        let rotation = ResultKey::from(RunQuantity::RotationTemperature);
        let warning = usual_note(rotation, Some(MeasuredValue::Number(1.0)));
        assert_ne!(warning, rotation.quantity().explanation());
        summary.add_noted(rotation, 1.0, warning);
        for (place, threshold) in DropThreshold::ALL.into_iter().enumerate() {
            // No drop lies between the first two thresholds, nor between the last two.
            let drop = if place < 2 { 1.0 / 3.0 } else { 1.0 / 7.0 };
            for quantity in ResultKey::AVALANCHE_QUANTITIES {
                let key = ResultKey::OfAvalanches(quantity, threshold);
                match quantity {
                    RunQuantity::Avalanches => {
                        summary.add_value(key, Some(MeasuredValue::Count(11)));
                    }
                    RunQuantity::Period => summary.add_mean(key, Estimate::of_events(&[])),
                    _ => summary.add_mean(key, mean(drop, Some(0.25))),
                }
            }
        }
        // Out of its place.
        summary.add(
            ResultKey::OfAvalanches(RunQuantity::Drop, DropThreshold::OneDegree),
            1.0,
        );
        summary
    }

    #[test]
    fn every_kind_of_result_comes_back_to_the_bit() {
        let summary = summary();
        let back = read_back(&summary);
        assert_eq!(back, summary);
        // Zero has a sign, which equality does not see.
        assert!(back.value(Measure::MeanSpeed).unwrap().is_sign_negative());
        assert!(matches!(
            back.get(RunQuantity::RiseRate),
            Some(MeasuredValue::Number(_))
        ));
    }

    #[test]
    fn numbers_of_avalanches_that_are_as_others_are_written_once() {
        let text = serde_json::to_string(&CompactSummary::from(&summary())).unwrap();
        for same in [
            "[\"avalanches (≥ 1°)\",{\"as\":\"avalanches (≥ 0.5°)\"}]",
            "[\"avalanches (≥ 3°)\",{\"as\":\"avalanches (≥ 2°)\"}]",
        ] {
            assert!(text.contains(same), "{text}");
        }
        assert!(
            !text.contains("rigid body"),
            "a usual note is not written: {text}"
        );
    }

    #[test]
    fn what_the_program_does_not_know_is_named() {
        let text = serde_json::to_string(&CompactSummary::from(&summary())).unwrap();
        let refused = |from: &str, to: &str| {
            assert!(text.contains(from), "{text}");
            let compact: CompactSummary =
                serde_json::from_str(&text.replacen(from, to, 1)).unwrap();
            compact.summary().unwrap_err()
        };
        let message = refused("rise rate", "rising rate");
        assert_eq!(message, "no result is called “rising rate”");
        let message = refused("continuous", "sometimes");
        assert_eq!(message, "the result “regime” is a word it cannot be");
        let message = refused("\"as\":\"avalanches (≥ 2°)\"", "\"as\":\"none\"");
        assert_eq!(message, "no result “none” stands there");
        let message = refused("[0,1]]", "[0,999]]");
        assert_eq!(message, "a note stands at result 999, which is not there");
    }
}
