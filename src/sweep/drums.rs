//! The drums of a sweep by grain size and liquid.
//!
//! In: ensembles of cases. Out: drums in order, wet ones with their dry one, series along the
//! liquids and along the radii, as the paper's statements compare them.

use super::ensemble::Ensemble;
use crate::measure::{DropThreshold, Estimate, Measure, ResultKey, RunQuantity};
use crate::scene::SceneGrains;

/// A drum of the paper.
pub struct Drum<'a> {
    /// Radius of its grains [mm].
    pub radius: f64,
    /// Viscosity of its liquid [mPa s]; zero of a dry one.
    pub viscosity: f64,
    /// Its runs.
    pub ensemble: &'a Ensemble<'a>,
    /// By which measures.
    pub measured_by: MeasuredBy,
}

/// Which of several measures stand for the drop, the granular temperature and the non-rigid share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeasuredBy {
    /// Drops from 1° on, velocities in the laboratory.
    #[default]
    Usual,
    /// Drops from this threshold on.
    Drops(DropThreshold),
    /// Velocities in the drum's frame.
    CorotatingFrame,
}

impl MeasuredBy {
    /// The result that stands for `key`.
    fn key(self, key: ResultKey) -> ResultKey {
        match (self, key) {
            (Self::Drops(threshold), ResultKey::OfRun(RunQuantity::Drop)) => {
                ResultKey::OfAvalanches(RunQuantity::Drop, threshold)
            }
            (Self::CorotatingFrame, ResultKey::OfRun(RunQuantity::NonRigidShare)) => {
                ResultKey::OfRun(RunQuantity::CorotatingShare)
            }
            (Self::CorotatingFrame, ResultKey::OfSamples(Measure::GranularTemperature)) => {
                ResultKey::OfSamples(Measure::CorotatingTemperature)
            }
            _ => key,
        }
    }
}

impl Drum<'_> {
    /// The result `key`.
    pub fn get(&self, key: ResultKey) -> Option<Estimate> {
        self.ensemble.estimate(self.measured_by.key(key))
    }

    /// Whether it has no liquid.
    pub fn is_dry(&self) -> bool {
        self.viscosity == 0.0
    }

    /// `dry`, or the viscosity.
    pub fn liquid(&self) -> String {
        if self.is_dry() {
            "dry".to_owned()
        } else {
            format!("{} mPa s", self.viscosity)
        }
    }

    /// `r = 3 mm, 109 mPa s`.
    pub fn place(&self) -> String {
        format!("r = {} mm, {}", self.radius, self.liquid())
    }
}

/// All drums, by radius and then by viscosity.
pub struct Drums<'a>(pub Vec<Drum<'a>>);

impl<'a> Drums<'a> {
    /// Those that are filled with grains.
    pub fn of(ensembles: impl IntoIterator<Item = &'a Ensemble<'a>>) -> Self {
        let drum = |ensemble: &'a Ensemble<'a>| {
            let scene = &ensemble.first().case.scene;
            let SceneGrains::Fill { species, .. } = &scene.grains else {
                return None;
            };
            // Rounded, so that a unit's factor leaves no digits behind.
            let round = |value: f64| (value * 1e6).round() / 1e6;
            Some(Drum {
                radius: round(1e3 * species.first()?.radius),
                viscosity: (scene.liquid.as_ref()).map_or(0.0, |own| round(1e3 * own.viscosity)),
                ensemble,
                measured_by: MeasuredBy::default(),
            })
        };
        let mut drums: Vec<Drum> = ensembles.into_iter().filter_map(drum).collect();
        drums.sort_by(|a, b| {
            let by_viscosity = a.viscosity.total_cmp(&b.viscosity);
            a.radius.total_cmp(&b.radius).then(by_viscosity)
        });
        Self(drums)
    }

    /// Those with a liquid.
    pub fn wet(&self) -> impl Iterator<Item = &Drum<'a>> {
        self.0.iter().filter(|drum| !drum.is_dry())
    }

    /// Each wet drum with the dry one of its radius.
    pub fn pairs(&self) -> impl Iterator<Item = (&Drum<'a>, &Drum<'a>)> {
        self.wet().filter_map(|wet| {
            let mut dry = self.0.iter().filter(|drum| drum.is_dry());
            Some((wet, dry.find(|dry| dry.radius == wet.radius)?))
        })
    }

    /// Wet drums of one radius in the order of their viscosity, two at least.
    pub fn by_viscosity(&self) -> Vec<Vec<&Drum<'a>>> {
        let wet: Vec<&Drum> = self.wet().collect();
        let runs = wet.chunk_by(|a, b| a.radius == b.radius);
        runs.filter(|run| run.len() > 1)
            .map(<[_]>::to_vec)
            .collect()
    }

    /// Drums of one liquid in the order of their radius, two at least.
    pub fn by_radius(&self) -> Vec<Vec<&Drum<'a>>> {
        let mut drums: Vec<&Drum> = self.0.iter().collect();
        drums.sort_by(|a, b| a.viscosity.total_cmp(&b.viscosity));
        let runs = drums.chunk_by(|a, b| a.viscosity == b.viscosity);
        runs.filter(|run| run.len() > 1)
            .map(<[_]>::to_vec)
            .collect()
    }
}
