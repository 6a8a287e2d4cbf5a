//! Cases that differ in nothing but their seed: one experiment, repeated.
//!
//! In: what became of the cases. Out: their ensembles, and each result of one as a mean with its
//! standard error, [`Estimate::of_seeds`].

use super::Sweep;
use super::case::CaseResult;
use super::variation::SEED;
use crate::measure::{Estimate, MeasuredValue, ResultKey, Summary, SummaryEntry};

/// Cases that differ in their seed alone, of which there is at least one.
pub struct Ensemble<'a> {
    /// What they have in common of what is varied, in the order of the variations.
    pub values: Vec<String>,
    /// Of these, with their keys, the ones in which it differs from another ensemble.
    pub different: Vec<(String, String)>,
    /// The cases, in their own order.
    pub members: Vec<&'a CaseResult>,
}

impl<'a> Ensemble<'a> {
    /// The first member, for what all have in common.
    pub fn first(&self) -> &'a CaseResult {
        self.members[0]
    }

    /// What it is called: its case's name, of several cases the values that they share.
    pub fn name(&self) -> String {
        match self.members[..] {
            [only] => only.case.name.clone(),
            _ => self.values.join(" "),
        }
    }

    /// The value of the varied `key` that sets it apart from others.
    pub fn value_of(&self, key: &str) -> Option<&str> {
        let own = self.different.iter().find(|(own, _)| own == key);
        own.map(|(_, value)| value.as_str())
    }

    /// What sets it apart from others beside the keys `without`: `, bridge-law=as-coded`.
    pub fn apart_from(&self, without: &[&str]) -> String {
        let mut text = String::new();
        for (key, value) in &self.different {
            if !without.contains(&key.as_str()) {
                text = text + ", " + key + "=" + value;
            }
        }
        text
    }

    /// The result `key` of the members that have it, as a mean over them; of one alone as it stands
    /// there. None for words, and where no member has it.
    pub fn estimate(&self, key: impl Into<ResultKey>) -> Option<Estimate> {
        let key = key.into();
        let members = self.members.iter();
        let values = members.filter_map(|member| member.results.get(key));
        let runs: Option<Vec<Estimate>> = values
            .map(|value| {
                let alone = || Some(Estimate::too_short(value.as_number()?, 1));
                value.as_estimate().or_else(alone)
            })
            .collect();
        runs.filter(|runs| !runs.is_empty())
            .map(|runs| Estimate::of_seeds(&runs))
    }

    /// Its results as those of one run, each a mean over the seeds; what no seed changes, and words
    /// on which all agree, as they are.
    pub fn results(&self) -> Summary {
        let first = &self.first().results;
        let entries = self
            .most_results()
            .entries
            .iter()
            .map(|entry| SummaryEntry {
                key: entry.key,
                value: self.mean_value(entry.key),
                note: format!("mean over {} seeds: {}", self.members.len(), entry.note),
            });
        Summary {
            from: first.from,
            to: first.to,
            samples: first.samples,
            entries: entries.collect(),
        }
    }

    /// Those of the member that has most of them: kept from earlier they may lack some.
    fn most_results(&self) -> &Summary {
        let all = self.members.iter().map(|member| &member.results);
        let most = all.rev().max_by_key(|results| results.entries.len());
        most.unwrap_or(&self.first().results)
    }

    fn mean_value(&self, key: ResultKey) -> Option<MeasuredValue> {
        let all = || self.members.iter().map(|member| member.results.get(key));
        let own = all().next().flatten();
        let is_fixed = own.is_none_or(|own| own.as_estimate().is_none()) && all().all(|v| v == own);
        if is_fixed {
            own
        } else {
            self.estimate(key).map(MeasuredValue::Mean)
        }
    }

    /// The mean of the result `key` over the members that have it.
    pub fn mean(&self, key: impl Into<ResultKey>) -> Option<f64> {
        Some(self.estimate(key)?.mean)
    }
}

/// The ensembles of these outcomes, in the order of their first members.
pub fn ensembles<'a>(
    sweep: &Sweep,
    outcomes: impl IntoIterator<Item = &'a CaseResult>,
) -> Vec<Ensemble<'a>> {
    let mut ensembles: Vec<Ensemble> = Vec::new();
    for outcome in outcomes {
        let varied = sweep.variations.iter().zip(&outcome.case.values);
        let common = varied.filter(|(variation, _)| variation.key != SEED);
        let values: Vec<String> = common.map(|(_, value)| value.clone()).collect();
        match ensembles.iter_mut().find(|known| known.values == values) {
            Some(known) => known.members.push(outcome),
            None => ensembles.push(Ensemble {
                values,
                different: Vec::new(),
                members: vec![outcome],
            }),
        }
    }
    let keys = sweep.variations.iter().map(|variation| &variation.key);
    for (index, key) in keys.filter(|key| *key != SEED).enumerate() {
        let first = ensembles.first().map(|own| own.values[index].clone());
        if ensembles
            .iter()
            .any(|own| Some(&own.values[index]) != first.as_ref())
        {
            for own in &mut ensembles {
                own.different.push((key.clone(), own.values[index].clone()));
            }
        }
    }
    ensembles
}
