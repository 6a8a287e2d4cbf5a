//! Two runs side by side that differ in one parameter: which one and by how much, and the end of
//! it.
//!
//! In: the simulation, with one run or two. Out: requests to begin a comparison and to end it.

use crate::physics::LIQUID_CASES;
use crate::simulation::{Half, Parameter, ParameterInfo, Simulation};
use crate::ui::detail::{is_basic, landmarks};
use crate::ui::panel::Panel;
use crate::ui::request::Request;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::value_row::{Landmark, Value, value_ui};
use crate::ui::words::number;
use crate::ui::words::run_names::{half_title, value_in_words};
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};

/// The panel.
#[derive(Debug, Default, PartialEq)]
pub struct Compare {
    /// The parameter that was chosen, and its other value [SI unit].
    chosen: Option<(Parameter, f64)>,
    /// The parameter that is to be chosen next.
    wanted: Option<Parameter>,
}

impl Compare {
    /// What stands over it.
    pub const TITLE: &'static str = "Compare two values";
}

impl Panel for Compare {
    fn title(&self) -> &'static str {
        Self::TITLE
    }

    fn take_up(&mut self, parameter: &Parameter) {
        self.wanted = Some(parameter.clone());
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        if simulation.comparison().is_some() {
            end_ui(ui, simulation, out);
        } else if simulation.parameters().is_empty() {
            ui.weak("There is something to compare when the bed stands.");
        } else {
            self.start_ui(ui, simulation, out);
        }
    }
}

impl Compare {
    fn start_ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        ui.weak("The same scene twice, side by side and in step, with one value changed.");
        let list = ordered(simulation);
        let of = |parameter: &Parameter| list.iter().find(|info| info.parameter == *parameter);
        let chosen_anew =
            |info: &&ParameterInfo| (info.parameter.clone(), telling(info, simulation));
        let wanted = self.wanted.take().as_ref().and_then(of).map(chosen_anew);
        let chosen = self.chosen.take().filter(|(own, _)| of(own).is_some());
        let first = || list.first().map(chosen_anew);
        let Some((mut parameter, mut other)) = wanted.or(chosen).or_else(first) else {
            return;
        };
        if choice_ui(ui, &list, &mut parameter)
            && let Some(info) = of(&parameter)
        {
            other = telling(info, simulation);
        }
        if let Some(info) = of(&parameter) {
            let present = simulation.value(&parameter);
            let left = value_in_words(&parameter, present);
            ui.label(format!("Left: {left}, the present value"));
            other = other_ui(ui, info, other).unwrap_or(other);
            let why_not = why_not(simulation, other == present);
            let button = egui::Button::new(RichText::new("Start side by side").strong());
            let button = button_unless_ui(ui, why_not, button)
                .on_hover_text("Both start afresh at time zero. The run so far is kept.");
            if button.clicked() {
                out.push(Request::StartComparison(parameter.clone(), other));
            }
        }
        self.chosen = Some((parameter, other));
    }
}

/// Why two runs cannot start now.
fn why_not(simulation: &Simulation, is_same: bool) -> Option<&'static str> {
    if !simulation.can_compare() {
        Some("Two runs start side by side only while the run stands or goes on")
    } else if is_same {
        Some("Both values are the same: change the right one")
    } else {
        None
    }
}

/// The parameters, those with the most visible effect first.
fn ordered(simulation: &Simulation) -> Vec<&ParameterInfo> {
    let scene = simulation.scene();
    let mut list: Vec<_> = simulation.parameters().iter().collect();
    list.sort_by_key(|info| match &info.parameter {
        Parameter::Viscosity => 0,
        Parameter::Share(_) if is_basic(info, scene) => 1,
        Parameter::Friction(..) | Parameter::WetFriction(..) if is_basic(info, scene) => 2,
        _ if is_basic(info, scene) => 3,
        _ => 4,
    });
    list
}

/// The choice of the parameter; true where another one was chosen.
fn choice_ui(ui: &mut egui::Ui, list: &[&ParameterInfo], chosen: &mut Parameter) -> bool {
    let before = chosen.clone();
    let label = |info: &ParameterInfo| number::capitalised(&info.label);
    let present = list.iter().find(|info| info.parameter == *chosen);
    let response = egui::ComboBox::from_id_salt("compared")
        .selected_text(present.map_or_else(String::new, |info| label(info)))
        .width(ui.available_width() - 8.0)
        .height(360.0)
        .show_ui(ui, |ui| {
            for info in list {
                ui.selectable_value(chosen, info.parameter.clone(), label(info))
                    .on_hover_text(info.description);
            }
        })
        .response;
    response
        .widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, "Parameter to compare"));
    *chosen != before
}

/// The row of the value on the right; the new value, if the person gave one.
fn other_ui(ui: &mut egui::Ui, info: &ParameterInfo, other: f64) -> Option<f64> {
    let row = Value {
        label: "value on the right",
        name: "Right",
        symbol: info.symbol,
        range: info.range.clone(),
        default: info.default,
        display: info.display,
        is_logarithmic: info.parameter == Parameter::Viscosity,
        is_whole: info.parameter == Parameter::BridgeLaw,
        landmarks: &named_values(&info.parameter),
        caption: None,
    };
    let explain = |ui: &mut egui::Ui| drop(ui.label(info.description));
    value_ui(ui, &row, other, |_| (), explain)
}

/// Values of `parameter` that have a name.
fn named_values(parameter: &Parameter) -> Vec<Landmark> {
    let named = |name, value| Landmark { name, value };
    match parameter {
        Parameter::Viscosity => LIQUID_CASES
            .iter()
            .map(|case| named(case.name, case.viscosity))
            .collect(),
        Parameter::BridgeLaw => vec![named("as printed", 0.0), named("as coded", 1.0)],
        _ => landmarks(parameter).to_vec(),
    }
}

/// A value far from the present one, so that the two runs look unlike: the farthest named one, else
/// the farther end.
fn telling(info: &ParameterInfo, simulation: &Simulation) -> f64 {
    let present = simulation.value(&info.parameter);
    let ends = [*info.range.start(), *info.range.end()];
    let far = |value: &f64| match info.parameter {
        Parameter::Viscosity => (value / present).ln().abs(),
        _ => (value - present).abs(),
    };
    let named = named_values(&info.parameter);
    let values = named.iter().map(|landmark| landmark.value);
    let inside = values.filter(|value| info.range.contains(value));
    let farthest = inside.max_by(|a, b| far(a).total_cmp(&far(b)));
    let farther = ends.into_iter().max_by(|a, b| far(a).total_cmp(&far(b)));
    farthest.or(farther).unwrap_or(present)
}

/// What is compared, and its end.
fn end_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
    for half in Half::ALL {
        let side = number::capitalised(half.label());
        ui.label(format!("{side}: {}", half_title(simulation, half)));
    }
    ui.weak("Every other change acts in both at the same step. A click on a half chooses which one the panels describe.");
    for half in Half::ALL {
        let text = format!("End it, keep the {} run", half.label());
        let hint = "It goes on alone. The other one stays on the plots and in the list of runs.";
        if ui.button(text).on_hover_text(hint).clicked() {
            out.push(Request::EndComparison(half));
        }
    }
}
