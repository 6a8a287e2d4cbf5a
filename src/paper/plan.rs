//! What a paper is to the program: a scene, the keys that are varied, and its cases in batches, the
//! most telling first.
//!
//! In: a paper's data and which part of it is wanted. Out: a sweep whose varied keys go value by
//! value, a row for each case.

use crate::run::BedStore;
use crate::runner::RunnerError;
use crate::scene::Scene;
use crate::sweep::{CaseResult, READING, Sweep, Variation};
use std::path::PathBuf;

/// A paper: its cases, and how its tables are made.
pub struct Paper {
    /// What it is called on the command line: `kasper2021`.
    pub name: &'static str,
    /// Who states what: `Kasper et al. 2021, …`.
    pub source: &'static str,
    /// The scene that is varied.
    pub scene: &'static str,
    /// What is set in every case, as `--set` has it.
    pub settings: &'static [&'static str],
    /// The varied keys; the last but one is that along which a batch goes. The seed follows them.
    pub keys: &'static [&'static str],
    /// What the values of the key `reading` stand for, where it is one of the keys.
    pub readings: &'static [Reading],
    /// What is set beside values of other keys, unless the paper is made small.
    pub beside: &'static [Beside],
    /// The cases, in the order in which they are run.
    pub batches: &'static [Batch],
    /// What is set beside that where the paper is made small.
    pub small_settings: &'static [&'static str],
    /// The cases of the small paper.
    pub small_batches: &'static [Batch],
    /// Its tables from what its cases came to.
    pub(crate) tables: fn(&Sweep, &[CaseResult]) -> Vec<PaperTable>,
}

/// A reading of what a paper leaves open, or states twice.
pub struct Reading {
    /// What it is called among the values of the key `reading`: `coulomb-total`.
    pub name: &'static str,
    /// What it reads otherwise, in words.
    pub text: &'static str,
    /// What is set for it, as `--set` has it.
    pub settings: &'static [&'static str],
}

/// What is set where a key has one of some values: shorter steps of higher columns.
pub struct Beside {
    /// The key.
    pub key: &'static str,
    /// The values.
    pub values: &'static [&'static str],
    /// What is set, as `--set` has it.
    pub settings: &'static [&'static str],
}

/// Cases that are begun together: every value of a list from every one of some seeds.
pub struct Batch {
    /// The part of the paper that it belongs to: `r3`.
    pub part: &'static str,
    /// The values of the keys but the last.
    pub values: &'static [&'static str],
    /// The values that the last key takes.
    pub list: &'static [&'static str],
    /// The first and the last seed.
    pub seeds: (u64, u64),
}

impl Batch {
    /// Cases of a `part` with these `values`, each of a `list`, from the first to the last of
    /// `seeds`.
    pub(crate) const fn new(
        part: &'static str,
        values: &'static [&'static str],
        list: &'static [&'static str],
        seeds: (u64, u64),
    ) -> Self {
        Self {
            part,
            values,
            list,
            seeds,
        }
    }
}

/// A table of a paper, as `tables.md` and a document's markers hold it.
pub struct PaperTable {
    /// What its marker names, behind the paper: `dry`.
    pub name: &'static str,
    /// What stands over it in `tables.md`.
    pub title: &'static str,
    /// The table in Markdown.
    pub text: String,
}

/// Which cases of a paper are wanted.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// Whether it is the small paper, for a try.
    pub is_small: bool,
    /// So many seeds of each case instead of as many as the paper's data say.
    pub seeds: Option<u64>,
    /// These parts; all where there are none.
    pub parts: Vec<String>,
    /// The cases whose names hold this text.
    pub only: Option<String>,
}

/// A case of a paper: the part that it belongs to, and the values of all keys and the seed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Row {
    pub part: &'static str,
    pub values: Vec<String>,
}

/// The key of the seed.
const SEED: &str = "seed";

impl Paper {
    /// The names of its parts, in their order.
    pub fn parts(&self) -> Vec<&'static str> {
        let mut parts: Vec<&str> = Vec::new();
        for batch in self.batches.iter().chain(self.small_batches) {
            if !parts.contains(&batch.part) {
                parts.push(batch.part);
            }
        }
        parts
    }

    /// Its cases, in the order in which they are run.
    ///
    /// # Errors
    /// When there is no such part, or no case is left.
    pub(super) fn rows(&self, selection: &Selection) -> Result<Vec<Row>, RunnerError> {
        let known = self.parts();
        let is_unknown = |part: &&String| !known.contains(&part.as_str());
        if let Some(part) = selection.parts.iter().find(is_unknown) {
            return Err(RunnerError::Input(format!(
                "--part {part}: expected one of {}",
                known.join(", ")
            )));
        }
        let batches = if selection.is_small {
            self.small_batches
        } else {
            self.batches
        };
        let mut rows: Vec<Row> = batches.iter().flat_map(rows_of).collect();
        if let Some(seeds) = selection.seeds {
            with_seeds(&mut rows, seeds);
        }
        rows.retain(|row| {
            let is_of_part = || selection.parts.iter().any(|part| part == row.part);
            let name = self.case_name(row);
            (selection.parts.is_empty() || is_of_part())
                && (selection.only.iter()).all(|text| name.contains(text.as_str()))
        });
        if rows.is_empty() {
            return Err(RunnerError::Input(format!(
                "no case of {} is left: --list shows the names of all",
                self.name
            )));
        }
        Ok(rows)
    }

    /// What each of the `values` of a `key` sets, where that is more than the value itself; else
    /// nothing.
    fn settings_of(&self, key: &str, values: &[String], is_small: bool) -> Vec<Vec<String>> {
        if key == READING {
            return values.iter().map(|value| self.reading(value)).collect();
        }
        let beside = || self.beside.iter().filter(|own| own.key == key);
        if is_small || beside().next().is_none() {
            return Vec::new();
        }
        let set = |value: &String| {
            let own = beside().filter(|own| own.values.contains(&value.as_str()));
            let more = own.flat_map(|own| own.settings).map(|&own| own.to_owned());
            [format!("{key}={value}")].into_iter().chain(more).collect()
        };
        values.iter().map(set).collect()
    }

    /// What is set where the reading is the one called `name`.
    fn reading(&self, name: &str) -> Vec<String> {
        let reading = self.readings.iter().find(|own| own.name == name);
        let settings = reading.map_or(&[][..], |own| own.settings);
        settings.iter().map(|&own| own.to_owned()).collect()
    }

    fn case_name(&self, row: &Row) -> String {
        let keys = self.keys.iter().copied().chain([SEED]);
        let values = keys.zip(&row.values);
        let texts: Vec<String> = values
            .map(|(key, value)| format!("{key}={value}"))
            .collect();
        texts.join("_")
    }

    /// The sweep of these `rows`, in the folder `out`, so many `jobs` at a time.
    ///
    /// # Errors
    /// When the scene cannot be read.
    pub(super) fn sweep(
        &self,
        rows: &[Row],
        is_small: bool,
        out: PathBuf,
        jobs: usize,
    ) -> Result<Sweep, RunnerError> {
        let small = if is_small { self.small_settings } else { &[] };
        let settings = self.settings.iter().chain(small);
        let keys = self.keys.iter().copied().chain([SEED]);
        let variations = keys.enumerate().map(|(index, key)| {
            let values: Vec<String> = rows.iter().map(|row| row.values[index].clone()).collect();
            Variation {
                key: key.to_owned(),
                settings: self.settings_of(key, &values, is_small),
                values,
                is_tied: index > 0,
            }
        });
        Ok(Sweep {
            name: self.scene.to_owned(),
            scene: Scene::open(self.scene)?,
            settings: settings.map(|&setting| setting.to_owned()).collect(),
            variations: variations.collect(),
            out,
            jobs,
            beds: BedStore::user(),
            restart: false,
        })
    }
}

/// The cases of a batch, seed by seed.
fn rows_of(batch: &Batch) -> Vec<Row> {
    let (first, last) = batch.seeds;
    let row = |seed: u64, value: &str| Row {
        part: batch.part,
        values: (batch.values.iter().copied())
            .chain([value, &seed.to_string()])
            .map(str::to_owned)
            .collect(),
    };
    (first..=last)
        .flat_map(|seed| batch.list.iter().map(move |value| row(seed, value)))
        .collect()
}

/// Leaves so many seeds of each case, or adds what is missing of them at the end.
fn with_seeds(rows: &mut Vec<Row>, seeds: u64) {
    let seed_of = |row: &Row| row.values.last().and_then(|seed| seed.parse::<u64>().ok());
    rows.retain(|row| seed_of(row).is_some_and(|seed| seed <= seeds));
    let firsts: Vec<Row> = (rows.iter())
        .filter(|row| seed_of(row) == Some(1))
        .cloned()
        .collect();
    for seed in 1..=seeds {
        for first in &firsts {
            let mut row = first.clone();
            row.values.pop();
            row.values.push(seed.to_string());
            let is_there = rows.iter().any(|own| own.values == row.values);
            if !is_there {
                rows.push(row);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::registry::{PAPERS, paper};
    use super::*;
    use crate::scene::TimeStep;
    use std::collections::HashSet;

    fn rows(selection: &Selection) -> Vec<Row> {
        paper("kasper2021").unwrap().rows(selection).unwrap()
    }

    #[test]
    fn no_case_of_a_paper_stands_twice_and_every_value_suits_its_scene() {
        for paper in PAPERS {
            for is_small in [false, true] {
                let selection = Selection {
                    is_small,
                    ..Selection::default()
                };
                let rows = paper.rows(&selection).unwrap();
                let different: HashSet<_> = rows.iter().map(|row| &row.values).collect();
                assert_eq!(different.len(), rows.len(), "{}", paper.name);
                let sweep = paper.sweep(&rows, is_small, "nowhere".into(), 1).unwrap();
                let cases = crate::sweep::cases(&sweep).unwrap();
                assert_eq!(cases.len(), rows.len());
                for (case, row) in cases.iter().zip(&rows) {
                    assert_eq!(case.name, paper.case_name(row));
                    crate::runner::look(&crate::sweep::job(&sweep, case)).unwrap();
                }
            }
        }
    }

    #[test]
    fn higher_columns_take_shorter_steps_and_small_papers_their_own() {
        let paper = paper("man2023").unwrap();
        let steps = |is_small: bool, only: &str| -> Vec<TimeStep> {
            let selection = Selection {
                is_small,
                only: Some(only.to_owned()),
                ..Selection::default()
            };
            let rows = paper.rows(&selection).unwrap();
            let sweep = paper.sweep(&rows, is_small, "nowhere".into(), 1).unwrap();
            let cases = crate::sweep::cases(&sweep).unwrap();
            cases.iter().map(|case| case.scene.time_step).collect()
        };
        let given = |step| TimeStep::Given(step);
        assert!(
            steps(false, "height=50mm")
                .iter()
                .all(|own| *own == given(20e-6))
        );
        assert_eq!(steps(false, "height=200mm"), [given(15e-6)]);
        assert_eq!(steps(false, "height=350mm"), [given(11e-6)]);
        assert!(
            steps(true, "height=10mm")
                .iter()
                .all(|own| *own == TimeStep::Following)
        );
    }

    #[test]
    fn seeds_are_cut_and_added_and_parts_and_names_select() {
        let all = rows(&Selection::default());
        let seeds = |rows: &[Row]| {
            let seeds: HashSet<String> = rows.iter().map(|row| row.values[3].clone()).collect();
            seeds.len()
        };
        assert_eq!((all[0].part, seeds(&all)), ("r3", 8));
        let one = rows(&Selection {
            seeds: Some(1),
            ..Selection::default()
        });
        assert_eq!(seeds(&one), 1);
        let many = rows(&Selection {
            seeds: Some(9),
            parts: vec!["r1.25".into()],
            ..Selection::default()
        });
        assert!(many.iter().all(|row| row.part == "r1.25"));
        assert_eq!((many.len(), seeds(&many)), (4 * 9, 9));
        let water = rows(&Selection {
            only: Some("liquid=1_seed=2".into()),
            ..Selection::default()
        });
        assert!(!water.is_empty() && water.iter().all(|row| row.values[2..] == ["1", "2"]));
        let selection = Selection {
            parts: vec!["r4".into()],
            ..Selection::default()
        };
        let message = paper("kasper2021").unwrap().rows(&selection).unwrap_err();
        assert!(message.to_string().contains("expected one of r3, "));
    }
}
