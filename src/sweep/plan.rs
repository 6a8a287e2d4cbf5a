//! The cases that a sweep consists of.
//!
//! In: a scene, what is set in every case, and what is varied. Out: the cases in their order, by
//! which they are numbered from 1 on.

use super::variation::{MOST_CASES, Variation, check_lengths};
use crate::parameters::Parameter;
use crate::run::{BedStore, ScriptedCommand};
use crate::runner::{RunnerError, apply_settings};
use crate::scene::Scene;
use crate::solver::advise;
use std::collections::HashSet;
use std::path::PathBuf;

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
    /// Cases that run at the same time, each on one thread; fewer cases share the threads.
    pub jobs: usize,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
    /// Whether cases that are in the output folder are replaced instead of gone on with.
    pub restart: bool,
}

/// One case: a scene with its commands.
#[derive(Clone, Debug, PartialEq)]
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

impl Case {
    /// What it costs to run, in grains times steps.
    pub fn cost(&self) -> f64 {
        self.scene.grain_count() as f64 * self.scene.duration / self.time_step
    }
}

/// How many cases there are: every combination of the variations, tied ones counting as one.
///
/// # Errors
/// When tied ones are not equally long, or there are too many cases.
pub fn count(sweep: &Sweep) -> Result<usize, RunnerError> {
    tied(sweep).try_for_each(check_lengths)?;
    let counts = tied(sweep).map(|variations| variations[0].values.len() as u128);
    let number = counts.fold(1_u128, u128::saturating_mul);
    if number > MOST_CASES as u128 {
        return Err(RunnerError::Input(format!(
            "the sweep has {number} cases; expected at most {MOST_CASES}: vary less, or in several sweeps"
        )));
    }
    Ok(number as usize)
}

/// The variations that go value by value, in their order.
fn tied(sweep: &Sweep) -> impl DoubleEndedIterator<Item = &[Variation]> {
    sweep.variations.chunk_by(|_, next| next.is_tied)
}

/// Every case, the last variation changing fastest.
///
/// # Errors
/// When a key or value does not suit the scene, there are too many cases, or two of them would have
/// the same folder.
pub fn cases(sweep: &Sweep) -> Result<Vec<Case>, RunnerError> {
    let number = count(sweep)?;
    refuse_what_undoes(sweep)?;
    let cases: Vec<Case> = (0..number)
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
        let varies = |key: &str| {
            let mut named = variation.settings.iter().flatten();
            variation.key == key || named.any(|own| key_of(own) == key)
        };
        let is_set = |setting: &&String| varies(key_of(setting));
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
    for variations in tied(sweep).rev() {
        let count = variations[0].values.len();
        let own = variations.iter().map(|v| v.values[rest % count].clone());
        values.splice(0..0, own);
        rest /= count;
    }
    let mut scene = sweep.scene.clone();
    let varied = || sweep.variations.iter().zip(&values);
    let names = varied().map(|(variation, value)| format!("{}={value}", variation.key));
    let name = names.collect::<Vec<_>>().join("_");
    let set: Vec<String> = varied()
        .flat_map(|(variation, value)| variation.settings_of(value))
        .collect();
    let settings: Vec<&String> = set.iter().chain(&sweep.settings).collect();
    let (of_wet, of_all): (Vec<&String>, Vec<&String>) = settings
        .iter()
        .partition(|setting| is_for_wet_cases(setting));
    let mut dry_or_wet = scene.clone();
    apply_settings(&mut dry_or_wet, &of_all)?;
    // Where no liquid is asked for by its case a volume pours one; a case that is dry stays so.
    let is_chosen = |setting: &&String| key_of(setting) == Parameter::Liquid.row().key;
    let is_poured = of_wet.iter().any(|setting| pours(setting)) && !settings.iter().any(is_chosen);
    let stays_dry = dry_or_wet.liquid.is_none() && !is_poured;
    let skipped = if stays_dry { of_wet } else { Vec::new() };
    let settings: Vec<&String> = settings
        .into_iter()
        .filter(|setting| !skipped.contains(setting))
        .collect();
    let script = apply_settings(&mut scene, &settings)?;
    Ok(Case {
        name: name.replace(['/', '\\'], "-"),
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

/// Whether a setting pours liquid into a bed, at the first step.
fn pours(setting: &str) -> bool {
    let row = Parameter::LiquidVolume.row();
    let stated = setting.split_once('=').filter(|(key, _)| *key == row.key);
    let volume = stated.and_then(|(_, text)| row.parse(text));
    volume.is_some_and(|volume| volume.number() > 0.0)
}
