//! Measured numbers of the latest sample, averages over the run, and the energy ledger.

use super::averages::Averages;
use super::table::{Row, table_ui};
use super::{Panel, Request, number};
use crate::measure::{Measure, Sample, Series};
use crate::simulation::Simulation;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};

/// What the latest sample shows, energies apart.
const LATEST: [Measure; 11] = [
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
];

/// What the averages show, by the summary's names, and what they are called here.
const AVERAGES: [(&str, &str); 8] = [
    ("surface angle", "Mean angle ⟨θ⟩"),
    ("maximum angle θ_m", "Maximum angle θ_m"),
    ("repose angle θ_r", "Repose angle θ_r"),
    ("drop Δθ", "Drop ⟨Δθ⟩"),
    ("avalanches", "Avalanches"),
    ("rise rate", "Rise rate"),
    ("granular temperature", "Temperature ⟨Tg⟩"),
    ("non-rigid share ta/ts", "Flowing share ta/ts"),
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
    averages: Averages,
}

impl Panel for Results {
    fn title(&self) -> &'static str {
        "Results"
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let series = simulation.series();
        let Some(sample) = series.last() else {
            ui.weak("Numbers appear with the first sample.");
            return;
        };
        latest_ui(ui, &sample);
        ui.add_space(6.0);
        self.averages_ui(ui, series);
        ui.add_space(6.0);
        energy_ui(ui, &sample);
    }
}

impl Results {
    fn averages_ui(&mut self, ui: &mut egui::Ui, series: &Series) {
        ui.horizontal(|ui| {
            let label = ui.label(RichText::new("Averages from").strong());
            let field = egui::DragValue::new(&mut self.from)
                .range(0.0..=f64::INFINITY)
                .speed(0.1)
                .max_decimals(1)
                .suffix(" s");
            ui.add(field).labelled_by(label.id).on_hover_text(
                "Only samples from this time on count. The paper leaves out the first 20 s.",
            );
        });
        let summary = self.averages.over(series, self.from);
        table_ui(
            ui,
            AVERAGES.iter().map(|&(key, name)| {
                let entry = summary.entries.iter().find(|entry| entry.name == key);
                let value = entry.and_then(|entry| entry.value).unwrap_or(f64::NAN);
                Row {
                    name: name.into(),
                    value: match key {
                        "avalanches" => number::fixed(value, 0),
                        _ => number::with_unit(value, entry.map_or("1", |entry| entry.unit)),
                    },
                    hint: entry.map_or_else(String::new, |entry| entry.note.clone()),
                }
            }),
        );
    }
}

fn latest_ui(ui: &mut egui::Ui, sample: &Sample) {
    ui.label(RichText::new(format!("At {:.2} s", sample.time)).strong());
    table_ui(
        ui,
        LATEST.iter().map(|&measure| Row {
            name: number::title(measure),
            value: number::with_unit(sample.value(measure), measure.quantity().unit),
            hint: measure.quantity().description.into(),
        }),
    );
}

/// The energy ledger with one prefix for all terms, so that they compare.
fn energy_ui(ui: &mut egui::Ui, sample: &Sample) {
    let largest = ENERGIES
        .iter()
        .map(|(measure, _)| sample.value(*measure).abs())
        .fold(0.0, f64::max);
    let (prefix, factor) = number::prefix_for(largest);
    ui.label(RichText::new(format!("Energy since the start [{prefix}J]")).strong());
    let in_prefix = |measure| number::fixed(sample.value(measure) * factor, 3);
    let terms = ENERGIES.iter().map(|&(measure, role)| Row {
        name: format!("{} ({role})", number::title(measure)),
        value: in_prefix(measure),
        hint: measure.quantity().description.into(),
    });
    let residual = sample.value(Measure::EnergyResidual);
    let share = number::fixed(100.0 * residual.abs() / largest, 3);
    let balance = Row {
        name: number::title(Measure::EnergyResidual),
        value: format!("{} · {share} %", in_prefix(Measure::EnergyResidual)),
        hint: format!(
            "{} The share is of the largest term.",
            Measure::EnergyResidual.quantity().description
        ),
    };
    table_ui(ui, terms.chain([balance]));
}
