//! What a sweep varies, and the cases that it consists of.

use crate::parameters::Parameter;
use crate::run::{BedStore, ScriptedCommand};
use crate::runner::{RunnerError, apply_setting};
use crate::scene::Scene;
use crate::solver::advise;
use std::path::PathBuf;

/// Cases a sweep may have.
const MOST_CASES: u16 = 10_000;

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
                if last < first || last - first >= i64::from(MOST_CASES) {
                    return Err(refuse());
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
/// When a key or value does not suit the scene, or there are too many cases.
pub fn cases(sweep: &Sweep) -> Result<Vec<Case>, RunnerError> {
    let number: usize = sweep.variations.iter().map(|v| v.values.len()).product();
    if number > usize::from(MOST_CASES) {
        return Err(RunnerError::Input(format!(
            "the sweep has {number} cases; expected at most {MOST_CASES}"
        )));
    }
    (0..number).map(|index| case(sweep, index)).collect()
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
    let mut script = Vec::new();
    let varied: Vec<String> = sweep
        .variations
        .iter()
        .zip(&values)
        .map(|(variation, value)| format!("{}={value}", variation.key))
        .collect();
    for setting in varied.iter().chain(&sweep.settings) {
        if is_for_wet_cases(setting) && scene.liquid.is_none() {
            continue;
        }
        script.extend(apply_setting(&mut scene, setting)?);
    }
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
    let key = setting.split_once('=').map_or(setting, |(key, _)| key);
    let mut known = Parameter::of_key(key).into_iter();
    known.any(|parameter| parameter.row().is_of_liquid)
}
