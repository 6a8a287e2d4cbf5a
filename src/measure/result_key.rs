//! What a result of a run is known by.
//!
//! In: nothing. Out: [`ResultKey`], by which results are stored and looked up, its row of the
//! registry and its name in files. A result is a measure of the samples taken over a window, or a
//! number that only a run has, or one of these counted over large avalanches alone.

use super::quantity::Quantity;
use super::run_quantity::RunQuantity;
use super::sampled_quantity::Measure;

/// What a result is: each has a name of its own in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResultKey {
    /// A measure of the samples over the window: its mean, its largest or its last value, as the
    /// note beside the result says.
    OfSamples(Measure),
    /// A number of the run.
    OfRun(RunQuantity),
    /// A number of the avalanches, counted over those alone whose drop reaches the threshold.
    OfAvalanches(RunQuantity, DropThreshold),
}

/// The smallest drop of the avalanches that count, where results for several stand side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DropThreshold {
    /// 0.5°.
    HalfDegree,
    /// 1°.
    OneDegree,
    /// 2°.
    TwoDegrees,
    /// 3°.
    ThreeDegrees,
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

impl DropThreshold {
    /// All of them, the smallest first.
    pub const ALL: [Self; 4] = [
        Self::HalfDegree,
        Self::OneDegree,
        Self::TwoDegrees,
        Self::ThreeDegrees,
    ];

    /// The drop [rad].
    pub fn angle(self) -> f64 {
        self.degrees() * DEGREE
    }

    fn degrees(self) -> f64 {
        match self {
            Self::HalfDegree => 0.5,
            Self::OneDegree => 1.0,
            Self::TwoDegrees => 2.0,
            Self::ThreeDegrees => 3.0,
        }
    }
}

impl ResultKey {
    /// The numbers that are given for each threshold of the drop.
    pub const AVALANCHE_QUANTITIES: [RunQuantity; 5] = [
        RunQuantity::Avalanches,
        RunQuantity::MaximumAngle,
        RunQuantity::ReposeAngle,
        RunQuantity::Drop,
        RunQuantity::Period,
    ];

    /// Every key.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_samples = Measure::ALL.into_iter().map(Self::OfSamples);
        let of_run = RunQuantity::ALL.into_iter().map(Self::OfRun);
        let of_avalanches = DropThreshold::ALL.into_iter().flat_map(|threshold| {
            Self::AVALANCHE_QUANTITIES.map(|quantity| Self::OfAvalanches(quantity, threshold))
        });
        of_samples.chain(of_run).chain(of_avalanches)
    }

    /// Its row of the registry; unit and digits do not depend on a threshold.
    pub const fn quantity(self) -> &'static Quantity {
        match self {
            Self::OfSamples(measure) => measure.quantity(),
            Self::OfRun(quantity) | Self::OfAvalanches(quantity, _) => quantity.quantity(),
        }
    }

    /// Its name in files: `surface angle`, `drop Δθ (≥ 0.5°)`.
    pub fn name(self) -> String {
        let key = self.quantity().key;
        match self {
            Self::OfAvalanches(_, threshold) => format!("{key} (≥ {}°)", threshold.degrees()),
            Self::OfSamples(_) | Self::OfRun(_) => key.to_owned(),
        }
    }

    /// The key with this name in files, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|key| key.name() == name)
    }

    /// What people read beside it: `Mean angle ⟨θ⟩`.
    pub fn label(self) -> String {
        match self {
            Self::OfSamples(Measure::SurfaceAngle) => "Mean angle ⟨θ⟩".into(),
            Self::OfSamples(Measure::GranularTemperature) => "Temperature ⟨Tg⟩".into(),
            Self::OfSamples(measure) => measure.quantity().label(),
            Self::OfRun(quantity) => quantity.quantity().label(),
            Self::OfAvalanches(quantity, threshold) => {
                format!(
                    "{} (≥ {}°)",
                    quantity.quantity().label(),
                    threshold.degrees()
                )
            }
        }
    }
}

impl From<Measure> for ResultKey {
    fn from(measure: Measure) -> Self {
        Self::OfSamples(measure)
    }
}

impl From<RunQuantity> for ResultKey {
    fn from(quantity: RunQuantity) -> Self {
        Self::OfRun(quantity)
    }
}
