//! Where the solver's time goes and why the time step is what it is.

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::value_table::{TableRow, table_ui};
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, Sense, WidgetInfo, WidgetType, vec2};
use grainfall::run::{MeasuredBed, MeasuredStep};
use grainfall::solver::{Profile, Stage, TimeStepAdvice};

/// The panel of the solver's profile.
#[derive(Default)]
pub struct SolverProfile;

impl Panel for SolverProfile {
    fn title(&self) -> &'static str {
        "Solver"
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        simulation.recording().is_none()
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
        profile_ui(ui, run.profile());
        advice_ui(ui, run.advice());
        measured_ui(ui, MeasuredBed::like(run.scene()));
        let warnings = run.warnings();
        if !warnings.is_empty() {
            ui.label(RichText::new("Warnings").strong());
        }
        for warning in warnings {
            ui.colored_label(Palette::of(ui.visuals()).warning, warning);
        }
    }
}

/// Where the time of `profile` went: a bar per stage, and numbers.
fn profile_ui(ui: &mut egui::Ui, profile: &Profile) {
    if profile.steps == 0 {
        ui.weak("The solver rests.");
        return;
    }
    let total = profile.total.as_secs_f64().max(f64::MIN_POSITIVE);
    let palette = Palette::of(ui.visuals());
    for (stage, colour) in Stage::ALL.into_iter().zip(palette.stages) {
        bar_ui(ui, stage.name(), profile.share(stage) as f32, colour);
    }
    let rebuilt_every = match profile.rebuilds {
        0 => "none".into(),
        rebuilds => format!("every {:.0} steps", profile.steps as f64 / rebuilds as f64),
    };
    let rows = [
        (
            "Per grain and step",
            number::short_time(profile.per_grain_step()),
        ),
        (
            "Steps per second",
            number::fixed(profile.steps as f64 / total, 0),
        ),
        ("Neighbour lists rebuilt", rebuilt_every),
        ("Listed pairs", profile.listed.to_string()),
        ("Grains", profile.grains.to_string()),
    ];
    table_ui(
        ui,
        rows.into_iter().map(|(name, value)| TableRow {
            name: name.into(),
            value,
            hint: String::new(),
        }),
    );
}

fn bar_ui(ui: &mut egui::Ui, name: &str, share: f32, colour: egui::Color32) {
    ui.horizontal(|ui| {
        let height = ui.text_style_height(&egui::TextStyle::Body);
        ui.add_sized(
            vec2(92.0, height),
            egui::Label::new(name).halign(egui::Align::LEFT),
        );
        let width = (ui.available_width() - 52.0).max(20.0);
        let (rect, response) = ui.allocate_exact_size(vec2(width, 12.0), Sense::hover());
        let filled = rect.with_max_x(rect.left() + width * share.clamp(0.0, 1.0));
        ui.painter()
            .rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
        ui.painter().rect_filled(filled, 3.0, colour);
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(WidgetType::ProgressIndicator, true, name);
            info.value = Some(f64::from(share));
            info
        });
        ui.label(format!("{:.0} %", 100.0 * share));
    });
}

/// The time step and what limits it.
fn advice_ui(ui: &mut egui::Ui, advice: &TimeStepAdvice) {
    ui.add_space(4.0);
    let step = number::short_time(advice.time_step);
    ui.label(RichText::new(format!("Time step {step}")).strong());
    if let Some(warning) = &advice.warning {
        ui.colored_label(Palette::of(ui.visuals()).warning, warning);
    }
    table_ui(
        ui,
        advice.limits.iter().map(|limit| TableRow {
            name: number::capitalised(limit.name),
            value: format!("≤ {}", number::short_time(limit.time_step)),
            hint: limit.reason.clone(),
        }),
    );
    if let Some(binding) = advice.limits.first() {
        ui.add(egui::Label::new(RichText::new(&binding.reason).weak().small()).wrap());
    }
}

/// In what a bed came out otherwise with other steps.
fn measured_ui(ui: &mut egui::Ui, bed: &MeasuredBed) {
    ui.add_space(4.0);
    ui.label(RichText::new("Other steps change").strong());
    let others = bed.steps.iter().filter(|step| !bed.is_standard(step));
    table_ui(
        ui,
        others.map(|step| TableRow {
            name: name_of(bed, step),
            value: off(bed, step),
            hint: hint(bed, step),
        }),
    );
    let standard = name_of(bed, bed.standard());
    let text = format!(
        "by more than scatter beside {standard}, in a bed that was run: {}",
        bed.bed
    );
    ui.add(egui::Label::new(RichText::new(text).weak().small()).wrap());
}

fn name_of(bed: &MeasuredBed, step: &MeasuredStep) -> String {
    let name = format!(
        "{} {}",
        number::short_time(step.time_step),
        bed.integrator_of(step)
    );
    name.trim_end().to_owned()
}

/// The symbols of what differs.
fn off(bed: &MeasuredBed, step: &MeasuredStep) -> String {
    let off = bed.off(step).into_iter();
    let symbols: Vec<&str> = off.map(|(own, _)| own.symbol()).collect();
    if symbols.is_empty() {
        return "nothing".into();
    }
    symbols.join(", ")
}

/// By how much, and all that the step came to.
fn hint(bed: &MeasuredBed, step: &MeasuredStep) -> String {
    let results = step
        .results
        .iter()
        .map(|own| format!("\n{}: {}", own.head(), own.cell()));
    format!(
        "Off by more than scatter: {}.\nMeans of {} beds:{}",
        bed.off_in_words(step),
        step.runs,
        results.collect::<String>()
    )
}
