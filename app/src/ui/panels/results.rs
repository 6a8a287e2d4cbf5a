//! Measured numbers of the latest sample, averages over the run, and the energy ledger.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, is_column};
use crate::ui::panels::averages::Averages;
use crate::ui::request::Request;
use crate::ui::widgets::field::{Field, slip_ui};
use crate::ui::widgets::value_table::{TableRow, table_ui};
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use grainfall::lab::RunView;
use grainfall::measure::{Measure, ResultKey, RunQuantity, Sample, Summary, SummaryEntry};

/// What the latest sample shows where it has a meaning, energies of all grains apart.
const LATEST: [Measure; 25] = [
    Measure::SurfaceAngle,
    Measure::GranularTemperature,
    Measure::CorotatingTemperature,
    Measure::PackingFraction,
    Measure::CoordinationNumber,
    Measure::MeanSpeed,
    Measure::LargestOverlap,
    Measure::SurfaceRoughness,
    Measure::SurfaceCurvature,
    Measure::Bridges,
    Measure::DrumTorque,
    Measure::FrontRadius,
    Measure::FrontRadius99,
    Measure::FrontRadius95,
    Measure::ClusterRadius,
    Measure::DepositHeight,
    Measure::ApexHeight,
    Measure::TranslationalEnergy,
    Measure::RotationalEnergy,
    Measure::FirstPairs,
    Measure::MixedPairs,
    Measure::SecondPairs,
    Measure::MixingIndex,
    Measure::FloorForce,
    Measure::Weight,
];

/// The averages of a bed.
const AVERAGES: [ResultKey; 12] = [
    ResultKey::OfSamples(Measure::SurfaceAngle),
    ResultKey::OfRun(RunQuantity::MaximumAngle),
    ResultKey::OfRun(RunQuantity::ReposeAngle),
    ResultKey::OfRun(RunQuantity::Drop),
    ResultKey::OfRun(RunQuantity::Avalanches),
    ResultKey::OfRun(RunQuantity::Period),
    ResultKey::OfRun(RunQuantity::RiseRate),
    ResultKey::OfSamples(Measure::GranularTemperature),
    ResultKey::OfRun(RunQuantity::NonRigidShare),
    ResultKey::OfRun(RunQuantity::CorotatingShare),
    ResultKey::OfRun(RunQuantity::FlowSpeed),
    ResultKey::OfRun(RunQuantity::FlowDepth),
];

/// What stands in their place of a column.
const COLLAPSE: [ResultKey; 12] = [
    ResultKey::OfRun(RunQuantity::EffectiveAspectRatio),
    ResultKey::OfRun(RunQuantity::ParticleFriction),
    ResultKey::OfRun(RunQuantity::SolidFraction),
    ResultKey::OfRun(RunQuantity::RunOut),
    ResultKey::OfRun(RunQuantity::RelativeHeight),
    ResultKey::OfRun(RunQuantity::RelativeConeVolume),
    ResultKey::OfRun(RunQuantity::PeakEnergy),
    ResultKey::OfRun(RunQuantity::PeakTime),
    ResultKey::OfRun(RunQuantity::RestTime),
    ResultKey::OfRun(RunQuantity::DimensionlessPeakTime),
    ResultKey::OfRun(RunQuantity::DimensionlessRestTime),
    ResultKey::OfRun(RunQuantity::FlatRadius),
];

/// Terms of the energy balance, and whether each is put in, kept or lost.
const ENERGIES: [(Measure, &str); 9] = [
    (Measure::GravityWork, "in"),
    (Measure::WallWork, "in"),
    (Measure::KineticEnergy, "kept"),
    (Measure::ElasticEnergy, "kept"),
    (Measure::DashpotLoss, "lost"),
    (Measure::SlidingLoss, "lost"),
    (Measure::RollingLoss, "lost"),
    (Measure::ViscousLoss, "lost"),
    (Measure::CapillaryLoss, "lost"),
];

/// The panel of results.
#[derive(Default)]
pub struct Results {
    /// Averages begin at this time [s].
    from: f64,
    /// They end at this one [s]; with the newest sample where nobody chose an end.
    until: Option<f64>,
    averages: Averages,
}

impl Panel for Results {
    fn title(&self) -> &'static str {
        "Results"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let Some(sample) = run.sample() else {
            ui.weak("Numbers appear with the first sample.");
            return;
        };
        let applies = |measure: Measure| {
            let world = run.world();
            world.is_none_or(|world| measure.applies_to(world))
        };
        latest_ui(ui, &sample, applies);
        ui.add_space(6.0);
        if is_column(run) {
            ui.label(RichText::new("The collapse so far").strong());
            summary_ui(ui, self.averages.over(run, 0.0), &COLLAPSE);
        } else {
            self.averages_ui(ui, run);
        }
        ui.add_space(6.0);
        energy_ui(ui, &sample, applies);
    }
}

impl Results {
    fn averages_ui(&mut self, ui: &mut egui::Ui, run: &RunView) {
        let newest = run.series().time().last().copied().unwrap_or(0.0);
        let mut until = self.until.unwrap_or(newest);
        let ends = [
            (
                "Averages from",
                "Only samples from this time on count. The paper leaves out the first 20 s.",
                &mut self.from,
            ),
            (
                "until",
                "Only samples until this time count; until the newest one, as long as none is chosen or a later one is.",
                &mut until,
            ),
        ];
        ui.horizontal_wrapped(|ui| {
            for (label, hint, time) in ends {
                let field = Field {
                    label,
                    range: 0.0..=f64::INFINITY,
                    unit: "s",
                    decimals: 0..=1,
                    is_whole: false,
                    speed: 0.1,
                    size: None,
                };
                ui.label(RichText::new(label).strong());
                let typed = field.ui(ui, time);
                slip_ui(ui, &typed.on_hover_text(hint));
            }
        });
        if until != self.until.unwrap_or(newest) {
            self.until = Some(until).filter(|until| *until < newest);
        }
        let until = self.until.unwrap_or(f64::INFINITY);
        let summary = self.averages.between(run, self.from, until);
        summary_ui(ui, summary, &AVERAGES);
        let lacks_error = |key: &ResultKey| {
            let mean = summary.estimate(*key);
            mean.is_some_and(|mean| mean.reason().is_some())
        };
        let too_short = "± ?: too short to say. Rest the pointer on it to see how many samples are independent.";
        let short = AVERAGES
            .iter()
            .any(lacks_error)
            .then(|| too_short.to_owned());
        for note in short.into_iter().chain(summary.rotation_note()) {
            ui.label(RichText::new(note).small().weak());
        }
    }
}

/// The entries of `summary` under these keys.
fn summary_ui(ui: &mut egui::Ui, summary: &Summary, keys: &[ResultKey]) {
    table_ui(
        ui,
        keys.iter().map(|&key| TableRow {
            name: key.label(),
            value: summary.text(key),
            hint: summary.entry(key).map_or_else(String::new, hint_of),
        }),
    );
}

/// How a result was taken, and what its error rests on.
fn hint_of(entry: &SummaryEntry) -> String {
    match entry.estimate() {
        Some(mean) => format!("{}\n{}", entry.note, number::capitalised(&mean.basis())),
        None => entry.note.clone(),
    }
}

fn latest_ui(ui: &mut egui::Ui, sample: &Sample, applies: impl Fn(Measure) -> bool) {
    ui.label(RichText::new(format!("At {}", number::moment(sample.time))).strong());
    table_ui(
        ui,
        LATEST
            .into_iter()
            .filter(|m| applies(*m))
            .map(|measure| TableRow {
                name: number::title(measure),
                value: measure.quantity().text(sample.value(measure)),
                hint: measure.quantity().explanation(),
            }),
    );
}

/// The energy ledger with one prefix for all terms, so that they compare.
fn energy_ui(ui: &mut egui::Ui, sample: &Sample, applies: impl Fn(Measure) -> bool) {
    let energies = ENERGIES.iter().filter(|(measure, _)| applies(*measure));
    let largest = energies
        .clone()
        .map(|(measure, _)| sample.value(*measure).abs())
        .fold(0.0, f64::max);
    let (prefix, factor) = number::prefix_for(largest);
    ui.label(RichText::new(format!("Energy since the start [{prefix}J]")).strong());
    let in_prefix = |measure| number::fixed(sample.value(measure) * factor, 3);
    let terms = energies.map(|&(measure, role)| TableRow {
        name: format!("{} ({role})", number::title(measure)),
        value: in_prefix(measure),
        hint: measure.quantity().explanation(),
    });
    let residual = sample.value(Measure::EnergyResidual);
    let share = number::fixed(100.0 * residual.abs() / largest, 3);
    let balance = TableRow {
        name: number::title(Measure::EnergyResidual),
        value: format!("{} · {share} %", in_prefix(Measure::EnergyResidual)),
        hint: format!(
            "{} The share is of the largest term.",
            Measure::EnergyResidual.quantity().description
        ),
    };
    table_ui(ui, terms.chain([balance]));
}
