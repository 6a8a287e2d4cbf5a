//! A question about a scene as it stands in a window: what comes of other values of one parameter.
//!
//! In: the scene, what was changed about it since, the parameter and its values. Out: the sweep that
//! answers, in a folder of its own: the same question finds the same folder, another one another.

use super::{Sweep, ValueRange, Variation};
use crate::parameters::{Parameter, Value};
use crate::run::{BedStore, fingerprint, method};
use crate::runner::{RunnerError, apply_settings};
use crate::scene::Scene;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Letters of a fingerprint in the name of a folder.
const MARK: usize = 8;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The scene.
    pub scene: Scene,
    /// Live parameters that have other values than the scene's.
    pub changed: Vec<(Parameter, Value)>,
    /// The parameter that takes the values.
    pub parameter: Parameter,
    /// The values.
    pub values: ValueRange,
    /// Every value is run from so many seeds, the scene's and those that follow it.
    pub seeds: u16,
    /// Simulated time of each run [s].
    pub duration: f64,
}

impl Question {
    /// Where sweeps of the user's go where nobody says where; none where the system has no such
    /// place.
    pub fn home() -> Option<PathBuf> {
        let folders = directories::ProjectDirs::from("", "", "grainfall")?;
        Some(folders.data_local_dir().join("sweeps"))
    }

    /// What it varies.
    pub fn variations(&self) -> Vec<Variation> {
        let values = self.values.of(&self.parameter);
        let seeds = (self.seeds > 1).then(|| Variation::of_seeds(self.scene.seed, self.seeds));
        [values].into_iter().chain(seeds).collect()
    }

    /// The sweep that answers it, with its files in a folder of its own below `home` and so many
    /// cases at the same time.
    ///
    /// # Errors
    /// When the scene does not hold together with the duration.
    pub fn sweep(&self, home: &Path, jobs: usize, beds: BedStore) -> Result<Sweep, RunnerError> {
        let mut scene = self.scene.clone();
        apply_settings(&mut scene, &[format!("duration={:?}", self.duration)])?;
        Ok(Sweep {
            name: self.scene.title.clone(),
            scene,
            settings: self.settings(),
            variations: self.variations(),
            out: home.join(self.folder_name()),
            jobs,
            beds,
            restart: false,
        })
    }

    /// What was changed, as `--set` has it, but for what is varied.
    fn settings(&self) -> Vec<String> {
        let others = (self.changed.iter()).filter(|(own, _)| *own != self.parameter);
        others
            .map(|(parameter, value)| format!("{parameter}={value}"))
            .collect()
    }

    /// `small-dry-drum_friction.glass.glass_1a2b3c4d`: the same for the same scene with the same
    /// changes, whatever values are asked for and for how long. So more values and longer runs go
    /// on from what is there.
    fn folder_name(&self) -> String {
        let scene = Scene {
            duration: 0.0,
            ..self.scene.clone()
        };
        let stated = json!({
            "scene": scene,
            "settings": self.settings(),
            "method": method(&self.scene),
        });
        let mark = &fingerprint(&stated)[..MARK];
        let title = plain(&self.scene.title);
        let key = plain(&self.parameter.to_string());
        format!("{title}_{key}_{mark}")
    }
}

/// `text` in small letters, digits, points and strokes, and not long.
fn plain(text: &str) -> String {
    let letter = |own: char| match own {
        own if own.is_alphanumeric() || own == '.' => own.to_ascii_lowercase(),
        _ => '-',
    };
    let text: String = text.chars().map(letter).take(40).collect();
    let parts: Vec<&str> = text.split('-').filter(|part| !part.is_empty()).collect();
    parts.join("-")
}

#[cfg(test)]
mod tests {
    use super::super::{cases, count};
    use super::*;

    fn question() -> Question {
        Question {
            scene: Scene::open("small-drum").unwrap(),
            changed: vec![
                (Parameter::Gravity, 3.7.into()),
                (Parameter::DrumSpeed, 0.3.into()),
            ],
            parameter: Parameter::DrumSpeed,
            values: ValueRange {
                from: 0.1,
                to: 0.4,
                count: 4,
                by_powers: false,
            },
            seeds: 2,
            duration: 0.25,
        }
    }

    fn sweep(question: &Question) -> Sweep {
        let beds = BedStore::none();
        question.sweep(Path::new("home"), 1, beds).unwrap()
    }

    #[test]
    fn a_sweep_starts_from_the_scene_as_it_is_now() {
        let sweep = sweep(&question());
        assert_eq!(count(&sweep).unwrap(), 8);
        assert_eq!(sweep.settings, ["gravity=3.7"], "what is varied is not set");
        let cases = cases(&sweep).unwrap();
        for case in &cases {
            assert_eq!(case.scene.duration, 0.25);
            assert_eq!(case.script.len(), 2, "the speed and the gravity");
        }
        let seed = question().scene.seed;
        assert_eq!([cases[0].scene.seed, cases[1].scene.seed], [seed, seed + 1]);
    }

    #[test]
    fn the_same_question_has_the_same_folder_and_another_one_another() {
        let folder = |change: &dyn Fn(&mut Question)| {
            let mut own = question();
            change(&mut own);
            sweep(&own).out
        };
        let own = folder(&|_| ());
        assert!(own.starts_with("home"), "{}", own.display());
        assert_eq!(folder(&|own| own.duration = 1.0), own);
        assert_eq!(folder(&|own| own.values.count = 6), own);
        assert_ne!(folder(&|own| own.changed[0].1 = 1.6.into()), own);
        assert_ne!(folder(&|own| own.scene.materials[0].density = 1e3), own);
        assert_ne!(folder(&|own| own.parameter = Parameter::Gravity), own);
    }

    #[test]
    fn liquid_that_was_poured_into_a_dry_bed_is_in_every_case() {
        let mut own = question();
        own.changed = vec![
            (Parameter::LiquidVolume, 3e-7.into()),
            (Parameter::SurfaceTension, 0.06.into()),
        ];
        own.parameter = Parameter::Viscosity;
        assert!(own.scene.liquid.is_none());
        for case in cases(&sweep(&own)).unwrap() {
            assert_eq!(case.script.len(), 3, "{}", case.name);
        }
    }
}
