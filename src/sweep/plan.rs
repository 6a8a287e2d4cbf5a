//! What a sweep varies, and the cases that it consists of.

use crate::parameters::Parameter;
use crate::run::{BedStore, ScriptedCommand};
use crate::runner::{RunnerError, apply_settings};
use crate::scene::Scene;
use crate::solver::advise;
use std::collections::HashSet;
use std::path::PathBuf;

/// The varied key whose values repeat one experiment.
pub const SEED: &str = "seed";
/// Cases a sweep may have.
const MOST_CASES: usize = 10_000;

/// What to run.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What the scene was called.
    pub name: String,
    /// The scene that is varied.
    pub scene: Scene,
    /// What is changed in every case, as `--set` has it.
    pub settings: Vec<String>,
    /// What is varied.
    pub variations: Vec<Variation>,
    /// The output folder.
    pub out: PathBuf,
    /// Cases that run at the same time.
    pub jobs: usize,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
    /// Whether cases that are in the output folder are replaced instead of gone on with.
    pub restart: bool,
}

/// A key and the values it takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variation {
    /// A key of `--set`.
    pub key: String,
    /// Its values as text.
    pub values: Vec<String>,
}

/// One case: a scene with its commands.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its folder's name: `liquid=3_radius=2mm`.
    pub name: String,
    /// The varied values, in the order of the variations.
    pub values: Vec<String>,
    /// The scene.
    pub scene: Scene,
    /// What is set at its first step.
    pub script: Vec<ScriptedCommand>,
    /// Length of its steps [s].
    pub time_step: f64,
}

impl Variation {
    /// Reads `key=a,b,c`, or `key=0..7` for whole numbers from the first to the last.
    ///
    /// # Errors
    /// When the text has no such form.
    pub fn parse(text: &str) -> Result<Self, RunnerError> {
        let refuse = || {
            RunnerError::Input(format!(
                "--vary {text}: expected KEY=VALUES, such as liquid=0..7 or radius=3mm,2mm,1.25mm"
            ))
        };
        let (key, list) = text.split_once('=').ok_or_else(refuse)?;
        let values: Vec<String> = match list.split_once("..") {
            Some((first, last)) => {
                let number = |text: &str| text.trim().parse::<i64>().map_err(|_| refuse());
                let (first, last) = (number(first)?, number(last)?);
                let count = (i128::from(last) - i128::from(first)).saturating_add(1);
                if last < first {
                    return Err(refuse());
                }
                if count > MOST_CASES as i128 {
                    return Err(RunnerError::Input(format!(
                        "--vary {text}: expected KEY=VALUES with at most {MOST_CASES} values, not {count}"
                    )));
                }
                (first..=last).map(|n| n.to_string()).collect()
            }
            None => list
                .split(',')
                .map(|value| value.trim().to_owned())
                .collect(),
        };
        if key.is_empty() || values.iter().any(String::is_empty) {
            return Err(refuse());
        }
        Ok(Self {
            key: key.to_owned(),
            values,
        })
    }

    /// So many seeds from `first` on: the same experiment, repeated.
    pub fn of_seeds(first: u64, count: u16) -> Self {
        let seeds = (0..u64::from(count)).map(|k| first.wrapping_add(k).to_string());
        Self {
            key: SEED.to_owned(),
            values: seeds.collect(),
        }
    }
}

impl Case {
    /// What it costs to run, in grains times steps.
    pub fn cost(&self) -> f64 {
        self.scene.grain_count() as f64 * self.scene.duration / self.time_step
    }
}

/// Every combination of the variations, the last one changing fastest.
///
/// # Errors
/// When a key or value does not suit the scene, there are too many cases, or two of them would have
/// the same folder.
pub fn cases(sweep: &Sweep) -> Result<Vec<Case>, RunnerError> {
    let counts = sweep.variations.iter().map(|v| v.values.len() as u128);
    let number = counts.fold(1_u128, u128::saturating_mul);
    if number > MOST_CASES as u128 {
        return Err(RunnerError::Input(format!(
            "the sweep has {number} cases; expected at most {MOST_CASES}: vary less, or in several sweeps"
        )));
    }
    refuse_what_undoes(sweep)?;
    let cases: Vec<Case> = (0..number as usize)
        .map(|index| case(sweep, index))
        .collect::<Result<_, _>>()?;
    let mut names = HashSet::new();
    match cases.iter().find(|case| !names.insert(&case.name)) {
        None => Ok(cases),
        Some(twice) => Err(RunnerError::Input(format!(
            "two cases are called {}: give each value once",
            twice.name
        ))),
    }
}

/// Refuses a key that is varied twice, or varied and set: the later would undo the earlier.
fn refuse_what_undoes(sweep: &Sweep) -> Result<(), RunnerError> {
    let mut varied = HashSet::new();
    for variation in &sweep.variations {
        let is_set = |setting: &&String| key_of(setting) == variation.key;
        if let Some(setting) = sweep.settings.iter().find(is_set) {
            return Err(RunnerError::Input(format!(
                "--set {setting} undoes the variation of {}: leave one of them out",
                variation.key
            )));
        }
        if !varied.insert(&variation.key) {
            return Err(RunnerError::Input(format!(
                "{} is varied twice: give all its values once",
                variation.key
            )));
        }
    }
    Ok(())
}

/// The key of a setting `KEY=VALUE`.
fn key_of(setting: &str) -> &str {
    setting.split_once('=').map_or(setting, |(key, _)| key)
}

fn case(sweep: &Sweep, index: usize) -> Result<Case, RunnerError> {
    let mut rest = index;
    let mut values: Vec<String> = Vec::new();
    for variation in sweep.variations.iter().rev() {
        let count = variation.values.len();
        values.insert(0, variation.values[rest % count].clone());
        rest /= count;
    }
    let mut scene = sweep.scene.clone();
    let varied: Vec<String> = sweep
        .variations
        .iter()
        .zip(&values)
        .map(|(variation, value)| format!("{}={value}", variation.key))
        .collect();
    let settings: Vec<&String> = varied.iter().chain(&sweep.settings).collect();
    let (of_wet, of_all): (Vec<&String>, Vec<&String>) = settings
        .iter()
        .partition(|setting| is_for_wet_cases(setting));
    let mut dry_or_wet = scene.clone();
    apply_settings(&mut dry_or_wet, &of_all)?;
    let skipped = if dry_or_wet.liquid.is_none() {
        of_wet
    } else {
        Vec::new()
    };
    let settings: Vec<&String> = settings
        .into_iter()
        .filter(|setting| !skipped.contains(setting))
        .collect();
    let script = apply_settings(&mut scene, &settings)?;
    Ok(Case {
        name: varied.join("_").replace(['/', '\\'], "-"),
        values,
        time_step: advise(&scene).time_step,
        scene,
        script,
    })
}

/// Whether a setting says nothing about a dry scene: a sweep from dry to wet sets it where it has a
/// meaning.
fn is_for_wet_cases(setting: &str) -> bool {
    let mut known = Parameter::of_key(key_of(setting)).into_iter();
    known.any(|parameter| parameter.row().is_of_liquid)
}
