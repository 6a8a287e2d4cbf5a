//! What is asked: a parameter, its values, how many seeds, how long; what that takes of the machine.
//!
//! In: the simulation, whose scene and present values are what the runs start from. Out: the
//! question, as a request to answer it.

use crate::simulation::Simulation;
use crate::ui::detail::is_basic;
use crate::ui::request::{Request, SweepAct};
use crate::ui::sweep_desk::SweepDesk;
use crate::ui::theme::Palette;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::combo::combo_ui;
use crate::ui::widgets::field::{self, Field};
use crate::ui::words::number;
use bevy_egui::egui::{self, RichText};
use grainfall::lab::RunView;
use grainfall::parameters::{Kind, Parameter, ParameterInfo, Value, Values, start_parameters};
use grainfall::run::{BedStore, Estimate};
use grainfall::runner::spare_threads;
use grainfall::sweep::{self, Question, ValueRange};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Most values that a panel asks for; `grainfall sweep` takes any number.
const MOST_VALUES: f64 = 100.0;
/// Most seeds of each.
const MOST_SEEDS: f64 = 100.0;
/// Width of a field [points].
const FIELD: f32 = 92.0;

/// The form.
#[derive(Default)]
pub struct Form {
    /// The parameter that is to be chosen next.
    wanted: Option<Parameter>,
    /// What acts from the start on and can be varied, once it was asked for.
    of_start: Option<Vec<ParameterInfo>>,
    chosen: Option<Chosen>,
    outlook: Option<Outlook>,
}

/// What was chosen.
#[derive(Clone, PartialEq)]
struct Chosen {
    parameter: Parameter,
    values: ValueRange,
    seeds: u16,
    duration: f64,
}

/// A question, what decides it, and what its answer takes.
struct Outlook {
    of: (usize, Vec<(Parameter, Value)>, Chosen, PathBuf),
    question: Question,
    /// The values, and what the runs take; or why they cannot be.
    told: Result<Told, String>,
}

struct Told {
    values: String,
    takes: String,
    folder: PathBuf,
}

impl Form {
    /// Makes it ask about `parameter`.
    pub fn take_up(&mut self, parameter: &Parameter) {
        self.wanted = Some(parameter.clone());
    }

    /// Draws it.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        desk: &SweepDesk,
        is_running: bool,
        out: &mut Vec<Request>,
    ) {
        if simulation.parameters().is_empty() {
            ui.weak("There is something to vary when the bed stands.");
            return;
        }
        ui.weak("The scene as it is now, from time zero, once for each value: in the background, on cores that the window leaves.");
        let list = self.offered(simulation);
        self.choose(&list, simulation);
        let Some(chosen) = &mut self.chosen else {
            ui.weak("This scene has no number to vary.");
            return;
        };
        parameter_ui(ui, &list, chosen, simulation);
        if let Some(info) = list.iter().find(|info| info.parameter == chosen.parameter) {
            values_ui(ui, info, &mut chosen.values);
        }
        repeats_ui(ui, chosen);
        self.look_ahead(simulation, desk);
        self.start_ui(ui, desk, is_running, out);
    }

    /// What can be varied, what matters most first.
    fn offered(&mut self, simulation: &Simulation) -> Vec<ParameterInfo> {
        let scene = simulation.scene();
        let is_number = |info: &ParameterInfo| {
            matches!(info.values, Values::Range(_)) && info.parameter != Parameter::Seed
        };
        let of_start = self.of_start.get_or_insert_with(|| {
            let mut all = start_parameters(scene);
            all.retain(is_number);
            all
        });
        let live = simulation.parameters().iter();
        let live = live.filter(|info| info.acts && is_number(info));
        let mut list: Vec<ParameterInfo> = live.chain(of_start.iter()).cloned().collect();
        list.sort_by_key(|info| (!is_basic(info, scene), info.row().rank));
        list
    }

    /// Takes up the parameter that is wanted, or the first where none was chosen.
    fn choose(&mut self, list: &[ParameterInfo], simulation: &Simulation) {
        let wanted = self.wanted.take();
        let of = |parameter: &Parameter| list.iter().find(|info| info.parameter == *parameter);
        if let Some(info) = wanted.as_ref().and_then(of) {
            self.chosen = Some(anew(info, simulation, self.chosen.as_ref()));
        }
        let is_there = |chosen: &Chosen| of(&chosen.parameter).is_some();
        if !self.chosen.as_ref().is_some_and(is_there) {
            self.chosen = list.first().map(|info| anew(info, simulation, None));
        }
    }

    /// Works out what the answer takes, where the question is another one than before.
    fn look_ahead(&mut self, simulation: &Simulation, desk: &SweepDesk) {
        let Some(chosen) = &self.chosen else {
            return;
        };
        let scene = std::ptr::from_ref(simulation.scene()).addr();
        let of = (
            scene,
            simulation.changed_values(),
            chosen.clone(),
            desk.home(),
        );
        if self.outlook.as_ref().is_some_and(|known| known.of == of) {
            return;
        }
        let question = Question {
            scene: simulation.scene().clone(),
            changed: of.1.clone(),
            parameter: chosen.parameter.clone(),
            values: chosen.values,
            seeds: chosen.seeds,
            duration: chosen.duration,
        };
        let told = told(&question, desk);
        self.outlook = Some(Outlook { of, question, told });
    }

    fn start_ui(
        &self,
        ui: &mut egui::Ui,
        desk: &SweepDesk,
        is_running: bool,
        out: &mut Vec<Request>,
    ) {
        let Some(outlook) = &self.outlook else {
            return;
        };
        let palette = Palette::of(ui.visuals());
        match &outlook.told {
            Ok(told) => {
                ui.label(RichText::new(&told.values).small().weak());
                ui.label(RichText::new(&told.takes).small());
                ui.horizontal(|ui| {
                    let choose = ui.small_button("Folder…").on_hover_text(
                        "Choose the folder in which each sweep has a folder of its own",
                    );
                    if choose.clicked() {
                        out.push(Request::Sweep(SweepAct::ChooseFolder));
                    }
                    let folder = RichText::new(told.folder.display().to_string());
                    ui.add(egui::Label::new(folder.small().weak()).truncate());
                });
            }
            Err(reason) => {
                ui.colored_label(palette.warning, reason);
            }
        }
        if let Some(refusal) = desk.refusal() {
            ui.colored_label(palette.error, refusal);
        }
        let why_not = match (&outlook.told, is_running) {
            (_, true) => Some("A sweep is running: stop it first"),
            (Err(_), _) => Some("See above why it cannot run"),
            (Ok(_), false) => None,
        };
        let button = egui::Button::new(RichText::new("Start the sweep").strong());
        let button = button_unless_ui(ui, why_not, button)
            .on_hover_text("What the folder holds of it already is kept and gone on with");
        if button.clicked() {
            out.push(Request::Sweep(SweepAct::Start(Box::new(
                outlook.question.clone(),
            ))));
        }
    }
}

/// The present value of the parameter of `info` [SI unit].
fn present(info: &ParameterInfo, simulation: &RunView) -> f64 {
    let value = simulation.value(&info.parameter);
    value.unwrap_or(info.default).number()
}

/// A choice of the parameter of `info` with the values that are proposed, and else as `before`.
fn anew(info: &ParameterInfo, simulation: &RunView, before: Option<&Chosen>) -> Chosen {
    Chosen {
        parameter: info.parameter.clone(),
        values: ValueRange::around(info, present(info, simulation)),
        seeds: before.map_or(1, |own| own.seeds),
        duration: before.map_or(simulation.scene().duration, |own| own.duration),
    }
}

fn parameter_ui(
    ui: &mut egui::Ui,
    list: &[ParameterInfo],
    chosen: &mut Chosen,
    simulation: &Simulation,
) {
    let own = list.iter().find(|info| info.parameter == chosen.parameter);
    let name = own.map_or_else(String::new, |info| number::capitalised(&info.label));
    let mut other = None;
    combo_ui(ui, "Vary", &name, |ui| {
        for info in list {
            let is_own = info.parameter == chosen.parameter;
            let entry = ui.selectable_label(is_own, number::capitalised(&info.label));
            if entry.on_hover_text(info.row().description).clicked() {
                other = Some(anew(info, simulation, Some(chosen)));
            }
        }
    });
    if let Some(other) = other {
        *chosen = other;
    }
}

/// The fields of the values of the parameter of `info`.
fn values_ui(ui: &mut egui::Ui, info: &ParameterInfo, values: &mut ValueRange) {
    let unit = info.row().kind.unit().shown;
    let range = info.range();
    let shown = range.start() * unit.factor..=range.end() * unit.factor;
    let is_whole = info.row().kind == Kind::Count;
    ui.horizontal_wrapped(|ui| {
        for (name, label, end) in [
            ("From", "first value", &mut values.from),
            ("to", "last value", &mut values.to),
        ] {
            ui.label(name);
            let mut number = *end * unit.factor;
            let before = number;
            number_ui(ui, label, shown.clone(), unit.name, is_whole, &mut number);
            if number != before {
                *end = number / unit.factor;
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Values");
        let mut count = values.count as f64;
        number_ui(
            ui,
            "number of values",
            2.0..=MOST_VALUES,
            "",
            true,
            &mut count,
        );
        values.count = count as usize;
        let can = values.from > 0.0 && values.to > 0.0;
        values.by_powers &= can;
        ui.add_enabled(
            can,
            egui::Checkbox::new(&mut values.by_powers, "by factors"),
        )
        .on_hover_text("Each value is the one before times a factor, instead of plus a distance")
        .on_disabled_hover_text("Only where both ends are above zero");
    });
}

fn repeats_ui(ui: &mut egui::Ui, chosen: &mut Chosen) {
    ui.horizontal(|ui| {
        let seeds = ui.label("Seeds");
        seeds.on_hover_text(
            "Each value is run from so many seeds; error bars are then those of the mean over them",
        );
        let mut seeds = f64::from(chosen.seeds);
        number_ui(
            ui,
            "seeds of each value",
            1.0..=MOST_SEEDS,
            "",
            true,
            &mut seeds,
        );
        chosen.seeds = seeds as u16;
    });
    ui.horizontal(|ui| {
        ui.label("Each for");
        let lasting = f64::MIN_POSITIVE..=f64::INFINITY;
        number_ui(
            ui,
            "duration of each run",
            lasting,
            "s",
            false,
            &mut chosen.duration,
        );
    });
}

/// A field for a number in the unit that is shown.
fn number_ui(
    ui: &mut egui::Ui,
    label: &str,
    range: RangeInclusive<f64>,
    unit: &str,
    is_whole: bool,
    shown: &mut f64,
) {
    let width = range.end() - range.start();
    let speed = if width.is_finite() {
        width / 400.0
    } else {
        0.01 * shown.abs()
    };
    let drawn = Field {
        label,
        range,
        unit,
        decimals: 0..=if is_whole { 0 } else { 6 },
        is_whole,
        speed,
        size: Some(egui::vec2(FIELD, 22.0)),
    };
    let response = drawn.ui(ui, shown);
    field::slip_ui(ui, &response);
}

/// The values of `question` and what its runs take, or why they cannot be.
fn told(question: &Question, desk: &SweepDesk) -> Result<Told, String> {
    let jobs = spare_threads();
    let sweep = question.sweep(&desk.home(), jobs, BedStore::none());
    let sweep = sweep.map_err(|error| error.to_string())?;
    let cases = sweep::cases(&sweep).map_err(|error| error.to_string())?;
    let at_once = jobs.min(cases.len());
    let takes = Estimate::of_cases(cases.iter().map(|case| &case.scene), at_once);
    let fits = takes.fits_into_memory();
    fits.and_then(|()| takes.fits_onto_disk(&sweep.out))
        .map_err(|beyond| beyond.in_a_window())?;
    Ok(Told {
        values: sweep.variations[0].values.join(", "),
        takes: format!("{} runs, {at_once} at a time: {takes}", cases.len()),
        folder: sweep.out,
    })
}
