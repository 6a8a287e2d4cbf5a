//! Two runs side by side that differ in one parameter: which one and by how much, what of their
//! results differs by more than scatter, and the end of it.
//!
//! In: the simulation, with one run or two. Out: requests to begin a comparison and to end it.

use crate::simulation::Simulation;
use crate::ui::detail::is_basic;
use crate::ui::panel::{Panel, has_bed};
use crate::ui::panels::averages::Averages;
use crate::ui::request::Request;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::combo::list_ui;
use crate::ui::widgets::value_row::{ValueRow, value_ui};
use crate::ui::words::names::value_in_words;
use crate::ui::words::number;
use crate::ui::words::run_names::half_title;
use crate::ui::words::symbol;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use grainfall::lab::Half;
use grainfall::measure::{LEFT_OUT, Measure, ResultKey, RunQuantity, Summary, difference_in_words};
use grainfall::parameters::{Kind, Parameter, ParameterInfo, Preset, Value};
use grainfall::scene::Scene;

/// The results of two beds that are compared.
const COMPARED: [ResultKey; 6] = [
    ResultKey::OfSamples(Measure::SurfaceAngle),
    ResultKey::OfRun(RunQuantity::Drop),
    ResultKey::OfRun(RunQuantity::Period),
    ResultKey::OfSamples(Measure::GranularTemperature),
    ResultKey::OfRun(RunQuantity::CorotatingShare),
    ResultKey::OfSamples(Measure::PackingFraction),
];

/// The panel.
#[derive(Default)]
pub struct Compare {
    /// The parameter that was chosen, and its other value.
    chosen: Option<(Parameter, Value)>,
    /// The parameter that is to be chosen next.
    wanted: Option<Parameter>,
    /// The results of both runs.
    averages: [Averages; 2],
}

impl Compare {
    /// What stands over it.
    pub const TITLE: &'static str = "Compare two values";
}

impl Panel for Compare {
    fn title(&self) -> &'static str {
        Self::TITLE
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        simulation.recording().is_none()
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
            if has_bed(simulation) {
                self.differences_ui(ui, simulation);
            }
        } else if simulation.parameters().is_empty() {
            ui.weak("There is something to compare when the bed stands.");
        } else {
            self.start_ui(ui, simulation, out);
        }
    }
}

impl Compare {
    /// What of the results differs by more than scatter, in words.
    fn differences_ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation) {
        let [left, right] = &mut self.averages;
        let from = |half: Half| {
            let time = simulation.half(half).series().time().last();
            // By the second, so that averages are not remade in every frame.
            LEFT_OUT * time.copied().unwrap_or(0.0).floor()
        };
        let left = left.over(simulation.half(Half::Left), from(Half::Left));
        let right = right.over(simulation.half(Half::Right), from(Half::Right));
        ui.add_space(6.0);
        ui.label(RichText::new("Right less left").strong())
            .on_hover_text(TEST);
        for text in differences(left, right) {
            ui.label(symbol::text(ui, &text));
        }
    }

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
        if let (Some(info), Some(present)) = (of(&parameter), simulation.value(&parameter)) {
            let left = value_in_words(&parameter, present);
            ui.label(format!("Left: {left}, the present value"));
            other = other_ui(ui, info, other, simulation.scene()).unwrap_or(other);
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

/// How differences are tested.
const TEST: &str = "Averages over the last three fifths of both runs, as summaries have them; differences with \
                    their standard error. More than scatter: Welch's test finds less than one chance in twenty \
                    that two equal runs lie so far apart.";

/// How the results of two runs differ, in words.
fn differences(left: &Summary, right: &Summary) -> Vec<String> {
    let compared = |key: &ResultKey| {
        let [left, right] = [left, right].map(|summary| summary.estimate(*key));
        Some(difference_in_words(*key, left?, right?))
    };
    COMPARED.iter().filter_map(compared).collect()
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
    let offered = simulation.parameters().iter().filter(|info| info.acts);
    let mut list: Vec<_> = offered.collect();
    list.sort_by_key(|info| (!is_basic(info, scene), info.row().rank));
    list
}

/// The choice of the parameter; true where another one was chosen.
fn choice_ui(ui: &mut egui::Ui, list: &[&ParameterInfo], chosen: &mut Parameter) -> bool {
    let before = chosen.clone();
    let label = |info: &ParameterInfo| number::capitalised(&info.label);
    let present = list.iter().find(|info| info.parameter == *chosen);
    let parameters = egui::ComboBox::from_id_salt("compared")
        .selected_text(present.map_or_else(String::new, |info| label(info)))
        .width(ui.available_width() - 8.0)
        .height(360.0);
    list_ui(ui, "Parameter to compare", parameters, |ui| {
        for info in list {
            ui.selectable_value(chosen, info.parameter.clone(), label(info))
                .on_hover_text(info.row().description);
        }
    });
    *chosen != before
}

/// The row of the other value; what is wanted instead of it, if anything.
fn other_ui(ui: &mut egui::Ui, info: &ParameterInfo, other: Value, scene: &Scene) -> Option<Value> {
    let (own, range) = (info.row(), info.range());
    let row = ValueRow {
        label: "value on the right",
        name: "Right",
        symbol: own.symbol,
        default: info.default.number(),
        display: own.kind.unit().shown,
        is_logarithmic: own.is_logarithmic(&range),
        is_whole: !matches!(own.kind, Kind::Number(_)),
        presets: &named_values(info, scene),
        caption: None,
        range,
    };
    let explain = |ui: &mut egui::Ui| drop(ui.label(own.description));
    let wanted = value_ui(ui, &row, other.number(), |_| (), explain);
    wanted.map(|wanted| own.value(wanted))
}

/// Values of the parameter of `info` that have a name.
fn named_values<'a>(info: &ParameterInfo, scene: &'a Scene) -> Vec<Preset<'a>> {
    let choices = info.row().kind.choices().iter().map(|choice| Preset {
        name: choice.name,
        value: choice.number,
    });
    choices.chain(info.presets(scene)).collect()
}

/// A value far from the present one, so that the two runs look unlike: the farthest named one, else
/// the farther end.
fn telling(info: &ParameterInfo, simulation: &Simulation) -> Value {
    let present = simulation.value(&info.parameter).unwrap_or(info.default);
    let present = present.number();
    let range = info.range();
    let is_logarithmic = info.row().is_logarithmic(&range);
    let far = |value: &f64| {
        if is_logarithmic {
            (value / present).ln().abs()
        } else {
            (value - present).abs()
        }
    };
    let named = named_values(info, simulation.scene());
    let values = named.iter().map(|preset| preset.value);
    let inside = values.filter(|value| range.contains(value));
    let farthest = inside.max_by(|a, b| far(a).total_cmp(&far(b)));
    let ends = [*range.start(), *range.end()].into_iter();
    let farther = ends.max_by(|a, b| far(a).total_cmp(&far(b)));
    info.row().value(farthest.or(farther).unwrap_or(present))
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

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::measure::{Estimate, MeasuredValue, SummaryEntry};

    #[test]
    fn only_what_differs_by_more_than_scatter_is_called_so() {
        let summary = |angle: f64, share: f64| {
            let mean = |mean, error| {
                MeasuredValue::Mean(Estimate {
                    mean,
                    error: Some(error),
                    samples: 40,
                    freedom: 10,
                })
            };
            let entry = |key: ResultKey, value| SummaryEntry {
                key,
                value: Some(value),
                note: String::new(),
            };
            let angle = mean(angle.to_radians(), 0.3_f64.to_radians());
            Summary {
                from: 20.0,
                to: 50.0,
                samples: 1500,
                entries: vec![
                    entry(Measure::SurfaceAngle.into(), angle),
                    entry(RunQuantity::CorotatingShare.into(), mean(share, 0.02)),
                ],
            }
        };
        let found = differences(&summary(28.3, 0.52), &summary(29.9, 0.54));
        let expected = [
            "θ differs by 1.6° ± 0.4°: more than scatter",
            "ta/ts′ differs by 0.02 ± 0.03: within scatter",
        ];
        assert_eq!(found, expected);
    }
}
