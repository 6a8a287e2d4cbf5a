//! The energy ledger as a stack over time: what is stored, what was lost to what, and the line of
//! what came in. What the stack and the line leave between them is the residual.
//!
//! In: the samples. Out: the plot, its numbers at the moment shown, the moment that is clicked on.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, energy_comes_first};
use crate::ui::playback::{moment_shown, seek};
use crate::ui::plots::axes::{fitting_plot, tick};
use crate::ui::plots::time_plot::moment_ui;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::value_table::{TableRow, table_ui};
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Color32, RichText, Stroke, WidgetInfo, WidgetType};
use egui_plot::{FilledArea, HoverPosition, Line};
use grainfall::lab::RunView;
use grainfall::measure::{Measure, Series};
use grainfall::run::SAMPLE_INTERVAL;

/// Samples drawn at most.
const MOST_SAMPLES: usize = 500;
/// What the stack is made of, from below.
const LAYERS: [Measure; 7] = [
    Measure::KineticEnergy,
    Measure::ElasticEnergy,
    Measure::DashpotLoss,
    Measure::SlidingLoss,
    Measure::RollingLoss,
    Measure::ViscousLoss,
    Measure::CapillaryLoss,
];

/// The panel.
#[derive(Debug, Default, PartialEq)]
pub struct EnergyStack;

/// The ledger over time [J].
#[derive(Debug, PartialEq)]
struct Stack {
    time: Vec<f64>,
    /// The top of each layer, from below.
    tops: Vec<Vec<f64>>,
    /// Energy at the start plus the work done since.
    supplied: Vec<f64>,
}

impl Stack {
    fn of(series: &Series) -> Self {
        let stride = series.len().div_ceil(MOST_SAMPLES).max(1);
        // The newest sample is always drawn.
        let newest = series.len().saturating_sub(1);
        let samples: Vec<usize> = (0..series.len())
            .filter(|i| (newest - i).is_multiple_of(stride))
            .collect();
        // What has no meaning in a scene takes no room.
        let value = |measure: Measure, i: usize| {
            let value = series.column(measure)[i];
            if value.is_finite() { value } else { 0.0 }
        };
        let mut top = vec![0.0; samples.len()];
        let tops = LAYERS.map(|layer| {
            let sums = top.iter().zip(&samples);
            top = sums.map(|(below, i)| below + value(layer, *i)).collect();
            top.clone()
        });
        let supplied = |i: &usize| tops_at(&value, *i) - value(Measure::EnergyResidual, *i);
        Self {
            time: samples.iter().map(|i| series.time()[*i]).collect(),
            supplied: samples.iter().map(supplied).collect(),
            tops: tops.into(),
        }
    }
}

/// The top of the whole stack at sample `i`.
fn tops_at(value: &impl Fn(Measure, usize) -> f64, i: usize) -> f64 {
    LAYERS.into_iter().map(|layer| value(layer, i)).sum()
}

impl Panel for EnergyStack {
    fn title(&self) -> &'static str {
        "Energy"
    }

    fn comes_first(&self, simulation: &Simulation) -> bool {
        energy_comes_first(simulation)
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let series = run.series();
        if series.is_empty() {
            ui.weak("There is nothing measured yet.");
            return;
        }
        let palette = Palette::of(ui.visuals());
        let stack = Stack::of(series);
        let (prefix, factor) = number::prefix_for(largest(&stack));
        let unit = format!("{prefix}J");
        ui.label(RichText::new(format!("Where the energy is and went [{unit}]")).strong());
        let label_unit = unit.clone();
        let end = stack.time.last().copied().unwrap_or(0.0);
        let drawn = fitting_plot(ui, "energy stack")
            .include_x(0.0)
            .include_x(if end > 0.0 { end } else { SAMPLE_INTERVAL })
            .x_axis_formatter(|mark, _| format!("{} s", tick(mark.value, false)))
            .label_formatter(move |hover| Some(cursor(hover, &label_unit)))
            .show(ui, |plot| {
                let mut below = vec![0.0; stack.time.len()];
                for (index, (layer, top)) in LAYERS.iter().zip(&stack.tops).enumerate() {
                    let top: Vec<f64> = top.iter().map(|joules| joules * factor).collect();
                    let fill = colour(index);
                    let area = FilledArea::new(number::title(*layer), &stack.time, &below, &top);
                    plot.add(area.fill_color(fill).stroke(Stroke::new(0.6, fill)));
                    below = top;
                }
                let points = stack.time.iter().zip(&stack.supplied);
                let supplied: Vec<[f64; 2]> = points.map(|(t, e)| [*t, e * factor]).collect();
                let line = Line::new("Start and work", supplied);
                plot.line(line.color(palette.threshold).width(2.0));
                if let Some(time) = moment_shown(run) {
                    moment_ui(plot, time, palette);
                }
            });
        let response = drawn.response;
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Energy over time"));
        let pointer = response.interact_pointer_pos();
        if let Some(pointer) = pointer.filter(|_| response.clicked()) {
            let time = drawn.transform.value_from_position(pointer).x;
            out.extend(seek(run, time));
        }
        numbers_ui(ui, run);
    }
}

fn largest(stack: &Stack) -> f64 {
    let all = stack.tops.iter().flatten().chain(&stack.supplied);
    all.fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// Colours of the layers, told apart by lightness too.
fn colour(index: usize) -> Color32 {
    let palette = colorous::TABLEAU10;
    let colorous::Color { r, g, b } = palette[index % palette.len()];
    Color32::from_rgb(r, g, b).gamma_multiply(0.75)
}

fn cursor(hover: &HoverPosition, unit: &str) -> String {
    match hover {
        HoverPosition::NearDataPoint {
            plot_name,
            position,
            ..
        } => format!(
            "{plot_name}\n{}\n{} {unit}",
            number::moment(position.x),
            number::short(position.y)
        ),
        HoverPosition::Elsewhere { position } => {
            format!(
                "{}\n{} {unit}",
                number::moment(position.x),
                number::short(position.y)
            )
        }
    }
}

/// The ledger at the moment shown, with a swatch for each layer.
fn numbers_ui(ui: &mut egui::Ui, run: &RunView) {
    let Some(sample) = run.sample() else {
        return;
    };
    for (index, layer) in LAYERS.into_iter().enumerate() {
        let value = sample.value(layer);
        if !value.is_finite() {
            continue;
        }
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 14.0), egui::Sense::hover());
            ui.painter().rect_filled(rect, 3.0, colour(index));
            ui.label(format!(
                "{}: {}",
                number::title(layer),
                layer.quantity().text(value)
            ))
            .on_hover_text(layer.quantity().explanation());
        });
    }
    let residual = sample.value(Measure::EnergyResidual);
    let row = |measure: Measure, value: f64| TableRow {
        name: number::title(measure),
        value: measure.quantity().text(value),
        hint: measure.quantity().explanation(),
    };
    let works = [Measure::GravityWork, Measure::WallWork];
    let rows = works.map(|measure| row(measure, sample.value(measure)));
    table_ui(
        ui,
        rows.into_iter()
            .chain([row(Measure::EnergyResidual, residual)]),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::measure::Sample;

    #[test]
    fn stack_and_line_leave_the_residual_between_them() {
        let mut series = Series::default();
        for step in 0..1203_u64 {
            let mut values = [f64::NAN; Measure::COUNT];
            for (k, layer) in LAYERS.into_iter().enumerate() {
                values[layer as usize] = (k + 1) as f64 * step as f64;
            }
            values[Measure::CapillaryLoss as usize] = f64::NAN;
            values[Measure::EnergyResidual as usize] = 0.5;
            series.push(Sample {
                step,
                time: step as f64,
                values,
            });
        }
        let stack = Stack::of(&series);
        assert!(stack.time.len() <= MOST_SAMPLES);
        assert_eq!(stack.time.last(), Some(&1202.0));
        let last = stack.time.len() - 1;
        // 1 + 2 + … + 6 parts of the last step: what is no number takes no room.
        assert_eq!(stack.tops[6][last], 21.0 * 1202.0);
        assert_eq!(stack.tops[6][last] - stack.supplied[last], 0.5);
        assert_eq!(Stack::of(&Series::default()).time.len(), 0);
    }
}
