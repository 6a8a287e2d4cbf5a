//! Measured numbers of the latest sample, averages over the run, and the energy ledger.

use crate::measure::{Measure, Sample, Summary};
use crate::simulation::{RunView, Simulation};
use crate::ui::panel::{Panel, is_column};
use crate::ui::panels::averages::Averages;
use crate::ui::request::Request;
use crate::ui::widgets::field::{Field, slip_ui};
use crate::ui::widgets::value_table::{Row, table_ui};
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};

/// What the latest sample shows where it has a meaning, energies of all grains apart.
const LATEST: [Measure; 22] = [
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

/// What stands in their place of a column.
const COLLAPSE: [(&str, &str); 12] = [
    (
        "effective aspect ratio α_eff",
        "Effective aspect ratio α_eff",
    ),
    ("particle friction μ_p", "Particle friction μ_p"),
    ("solid fraction φ_i", "Solid fraction φ_i"),
    ("run-out ℛ", "Run-out"),
    ("H_∞/R_i", "Height H_∞/R_i"),
    ("V_cone/V_init", "Cone volume V_cone/V_init"),
    ("peak energy", "Peak energy per grain"),
    ("peak time t_max", "Peak time t_max"),
    ("rest time t_f", "Rest time t_f"),
    ("T_max", "T_max"),
    ("T_f", "T_f"),
    ("flat radius", "Flat radius of the top"),
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
        let concerns = |measure: Measure| {
            let world = run.world();
            world.is_none_or(|world| measure.concerns(world))
        };
        latest_ui(ui, &sample, concerns);
        ui.add_space(6.0);
        if is_column(run) {
            ui.label(RichText::new("The collapse so far").strong());
            summary_ui(ui, self.averages.over(run, 0.0), &COLLAPSE);
        } else {
            self.averages_ui(ui, run);
        }
        ui.add_space(6.0);
        energy_ui(ui, &sample, concerns);
    }
}

impl Results {
    fn averages_ui(&mut self, ui: &mut egui::Ui, run: &RunView) {
        let field = Field {
            label: "Averages from",
            range: 0.0..=f64::INFINITY,
            unit: "s",
            decimals: 0..=1,
            is_whole: false,
            speed: 0.1,
            size: None,
        };
        let typed = ui.horizontal(|ui| {
            ui.label(RichText::new(field.label).strong());
            field.ui(ui, &mut self.from)
        });
        let hint = "Only samples from this time on count. The paper leaves out the first 20 s.";
        slip_ui(ui, &typed.inner.on_hover_text(hint));
        summary_ui(ui, self.averages.over(run, self.from), &AVERAGES);
    }
}

/// The entries of `summary` that `shown` lists, under the names it gives them.
fn summary_ui(ui: &mut egui::Ui, summary: &Summary, shown: &[(&str, &str)]) {
    table_ui(
        ui,
        shown.iter().map(|&(key, name)| {
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

fn latest_ui(ui: &mut egui::Ui, sample: &Sample, concerns: impl Fn(Measure) -> bool) {
    ui.label(RichText::new(format!("At {:.2} s", sample.time)).strong());
    table_ui(
        ui,
        LATEST
            .into_iter()
            .filter(|m| concerns(*m))
            .map(|measure| Row {
                name: number::title(measure),
                value: number::with_unit(sample.value(measure), measure.quantity().unit),
                hint: measure.quantity().description.into(),
            }),
    );
}

/// The energy ledger with one prefix for all terms, so that they compare.
fn energy_ui(ui: &mut egui::Ui, sample: &Sample, concerns: impl Fn(Measure) -> bool) {
    let energies = ENERGIES.iter().filter(|(measure, _)| concerns(*measure));
    let largest = energies
        .clone()
        .map(|(measure, _)| sample.value(*measure).abs())
        .fold(0.0, f64::max);
    let (prefix, factor) = number::prefix_for(largest);
    ui.label(RichText::new(format!("Energy since the start [{prefix}J]")).strong());
    let in_prefix = |measure| number::fixed(sample.value(measure) * factor, 3);
    let terms = energies.map(|&(measure, role)| Row {
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
