//! What shorter and longer steps changed in whole beds that were run with them.
//!
//! In: a scene. Out: the bed of its kind that was run, what it came to with each step, and by which
//! results that is more than scatter. The numbers are in `assets/steps.csv`: means over beds from
//! different seeds with their standard errors, in SI units. How they were made is told in
//! `docs/numerics.md`.
//!
//! Not here: what a step makes of a single impact ([`crate::solver::step_choices`]), which steps are
//! stable ([`crate::solver::advise`]).

use crate::measure::{Difference, Estimate, ResultKey};
use crate::physics::Integrator;
use crate::scene::Scene;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};
use std::sync::OnceLock;

/// The runs, a row for each result: the first step of each bed is the one that others are held
/// against.
const RUNS: &str = include_str!("../../assets/steps.csv");

/// The kinds of beds that were run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    DryDrum,
    WetDrum,
    Column,
}

/// A bed that was run with several steps.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredBed {
    /// Which bed, in words.
    pub bed: &'static str,
    /// What it came to, step by step; the first is the one that others are held against.
    pub steps: Vec<MeasuredStep>,
}

/// What a bed came to with a step.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredStep {
    /// How the equations of motion were integrated.
    pub integrator: Integrator,
    /// The step [s].
    pub time_step: f64,
    /// How many beds, from different seeds.
    pub runs: usize,
    /// Its results.
    pub results: Vec<MeasuredResult>,
}

/// A result over the beds.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredResult {
    /// Which one.
    pub result: ResultKey,
    /// Mean over the beds with its standard error, in the SI unit.
    pub mean: Estimate,
}

/// A row of the file.
#[derive(Deserialize)]
struct Row {
    bed: Kind,
    integrator: Integrator,
    #[serde(rename = "time step [s]")]
    time_step: f64,
    runs: usize,
    result: String,
    mean: f64,
    #[serde(rename = "standard error")]
    error: f64,
}

impl Row {
    fn result(&self) -> MeasuredResult {
        MeasuredResult {
            result: ResultKey::named(&self.result).expect("the name of a result"),
            mean: Estimate {
                mean: self.mean,
                error: Some(self.error),
                samples: self.runs,
                freedom: self.runs - 1,
            },
        }
    }
}

impl Kind {
    /// All of them, in their order.
    const ALL: [Self; 3] = [Self::DryDrum, Self::WetDrum, Self::Column];

    /// That of `scene`.
    fn of(scene: &Scene) -> Self {
        if scene.is_polyhedral() {
            Self::Column
        } else if scene.liquid.is_some() {
            Self::WetDrum
        } else {
            Self::DryDrum
        }
    }

    fn in_words(self) -> &'static str {
        match self {
            Self::DryDrum => "dry drum, 470 grains of r = 3 mm (dry-r3), 20 to 50 s",
            Self::WetDrum => {
                "drum with 367 mPa s glycerol, 470 grains of r = 3 mm (wet), 20 to 50 s"
            }
            Self::Column => "column of 452 grains (R 12 mm, H 10 mm, 7:3), to rest",
        }
    }
}

impl MeasuredBed {
    /// The bed of the kind of `scene`, wet or dry, spheres or polyhedra.
    pub fn like(scene: &Scene) -> &'static Self {
        static BEDS: OnceLock<Vec<MeasuredBed>> = OnceLock::new();
        let beds = BEDS.get_or_init(|| Kind::ALL.map(MeasuredBed::read).into());
        &beds[Kind::of(scene) as usize]
    }

    /// That of a kind, out of the file; a test reads all of it.
    fn read(kind: Kind) -> Self {
        let mut steps: Vec<MeasuredStep> = Vec::new();
        for row in rows().filter(|row| row.bed == kind) {
            let result = row.result();
            let same = |step: &&mut MeasuredStep| {
                (step.integrator, step.time_step) == (row.integrator, row.time_step)
            };
            match steps.iter_mut().find(same) {
                Some(step) => step.results.push(result),
                None => steps.push(MeasuredStep {
                    integrator: row.integrator,
                    time_step: row.time_step,
                    runs: row.runs,
                    results: vec![result],
                }),
            }
        }
        Self {
            bed: kind.in_words(),
            steps,
        }
    }

    /// The step that others are held against.
    pub fn standard(&self) -> &MeasuredStep {
        &self.steps[0]
    }

    /// What `result` of a step differs by from that of the standard one; none of the standard one
    /// itself.
    pub fn difference(&self, step: &MeasuredStep, result: ResultKey) -> Option<Difference> {
        if self.is_standard(step) {
            return None;
        }
        Difference::between(step.mean(result)?, self.standard().mean(result)?)
    }

    /// How a step was integrated where that tells steps of the bed apart, else nothing.
    pub fn integrator_of(&self, step: &MeasuredStep) -> &'static str {
        let differs = |other: &MeasuredStep| other.integrator != step.integrator;
        match (self.steps.iter().any(differs), step.integrator) {
            (false, _) => "",
            (true, Integrator::Explicit) => "explicit",
            (true, Integrator::Implicit) => "implicit",
        }
    }

    /// The results of a step that differ from those of the standard one by more than scatter.
    pub fn off(&self, step: &MeasuredStep) -> Vec<(MeasuredResult, Difference)> {
        let results = step.results.iter().filter_map(|own| {
            let difference = self.difference(step, own.result)?;
            difference.is_significant().then_some((*own, difference))
        });
        results.collect()
    }

    /// By how much results of a step differ from those of the standard one where that is more than
    /// scatter: `Tg by (4.2 ± 1.4)·10⁻⁶ m²/s², Z by …`, or `nothing`.
    pub fn off_in_words(&self, step: &MeasuredStep) -> String {
        let differing = self.off(step).into_iter().map(|(own, difference)| {
            let quantity = own.result.quantity();
            let by = quantity.text_with_error(difference.value, difference.error);
            format!("{} by {by}", own.symbol())
        });
        let differing: Vec<String> = differing.collect();
        if differing.is_empty() {
            return "nothing".into();
        }
        differing.join(", ")
    }

    /// Whether `step` is the one that others are held against.
    pub fn is_standard(&self, step: &MeasuredStep) -> bool {
        std::ptr::eq(step, self.standard())
    }
}

impl MeasuredResult {
    /// Its symbol, or its name where it has none.
    pub fn symbol(&self) -> &'static str {
        match self.result.quantity() {
            quantity if quantity.symbol.is_empty() => quantity.key,
            quantity => quantity.symbol,
        }
    }

    /// Its head in a table: `θ [°]`.
    pub fn head(&self) -> String {
        self.result.quantity().unit.beside(self.symbol())
    }

    /// The mean with its error, in the unit of the head: `33.0 ± 0.2`.
    pub fn cell(&self) -> String {
        let quantity = self.result.quantity();
        quantity.number_with_error_as(self.mean, quantity.unit, quantity.format)
    }
}

impl MeasuredStep {
    /// Mean of a result.
    pub fn mean(&self, result: ResultKey) -> Option<Estimate> {
        let found = self.results.iter().find(|own| own.result == result);
        found.map(|own| own.mean)
    }
}

fn rows() -> impl Iterator<Item = Row> {
    let rows = csv::Reader::from_reader(RUNS.as_bytes()).into_deserialize();
    rows.map(|row| row.expect("a row of the file"))
}

/// As its name, mean and standard error.
impl Serialize for MeasuredResult {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut fields = to.serialize_struct("MeasuredResult", 3)?;
        fields.serialize_field("result", &self.result.name())?;
        fields.serialize_field("mean", &self.mean.mean)?;
        fields.serialize_field("error", &self.mean.error)?;
        fields.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Measure;
    use crate::solver::advise;

    fn bed(name: &str) -> &'static MeasuredBed {
        MeasuredBed::like(&Scene::open(name).unwrap())
    }

    #[test]
    fn every_kind_of_bed_has_its_steps_from_shorter_to_longer_than_the_standard_one() {
        for (scene, standard) in [("dry-r3", 2.028e-5), ("wet", 2.028e-5), ("column", 1.1e-6)] {
            let bed = bed(scene);
            let first = bed.standard();
            assert!((first.time_step / standard - 1.0).abs() < 0.01, "{scene}");
            let advised = advise(&Scene::open(scene).unwrap()).time_step;
            assert!((first.time_step / advised - 1.0).abs() < 0.01, "{scene}");
            assert!(bed.steps.len() >= 4, "{scene}");
            for step in &bed.steps {
                assert!(step.runs >= 3, "{scene}");
                let names = |step: &MeasuredStep| -> Vec<String> {
                    step.results.iter().map(|own| own.result.name()).collect()
                };
                assert_eq!(names(step), names(first), "{scene}");
                assert!(step.results.iter().all(|own| own.mean.mean.is_finite()));
            }
        }
    }

    #[test]
    fn steps_are_held_against_the_standard_one_by_welchs_test() {
        let dry = bed("dry-r3");
        let angle = ResultKey::from(Measure::SurfaceAngle);
        assert!(dry.difference(dry.standard(), angle).is_none());
        let tenth = dry.steps.iter().find(|step| step.time_step < 2.5e-6);
        let difference = dry.difference(tenth.unwrap(), angle).unwrap();
        // 33.2° ± 0.2° of 4 beds beside 33.0° ± 0.2° of 16.
        assert!((difference.value.to_degrees() - 0.2).abs() < 0.11);
        assert!(!difference.is_significant());
    }
}
