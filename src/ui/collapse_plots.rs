//! The front and the kinetic energy of a collapsing column over the same time, with its peak and its rest marked.
//!
//! In: columns of samples. Out: two plots that always show the same time.

use super::decimate::decimate;
use super::plots::{Curve, Span, changes, curve_ui, height_of, size_of_plots};
use super::theme::Palette;
use super::{Panel, Request, is_column, number};
use crate::measure::{Collapse, Measure};
use crate::simulation::Simulation;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Stroke};
use egui_plot::{LineStyle, PlotUi, VLine};
use std::ops::RangeInclusive;

const MILLIMETRES: f64 = 1e3;
const MICROJOULES: f64 = 1e6;
/// Smallest height of the plot of the front [mm].
const SMALLEST_FRONT_SPAN: f64 = 5.0;

/// Both plots.
#[derive(Debug, PartialEq)]
pub struct CollapsePlots {
    span: Span,
}

impl Default for CollapsePlots {
    fn default() -> Self {
        Self { span: Span::All }
    }
}

impl Panel for CollapsePlots {
    fn title(&self) -> &'static str {
        "Plots"
    }

    fn concerns(&self, simulation: &Simulation) -> bool {
        is_column(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        ui.horizontal_wrapped(|ui| self.span.choice_ui(ui));
        let (height, columns) = size_of_plots(ui);
        let palette = Palette::of(ui.visuals());
        let window = self.span.window(simulation.series().time());
        let marks = Marks::of(simulation, palette);
        let curves = [
            front(simulation, &window, columns, palette),
            energy(simulation, &window, columns, palette),
        ];
        for curve in curves {
            let response = curve_ui(ui, curve, &window, height, |plot| marks.ui(plot));
            self.span.follow_pointer(&response, &window);
        }
    }
}

fn front(
    simulation: &Simulation,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
) -> Curve {
    let series = simulation.series();
    let values = series.column(Measure::FrontRadius);
    let points = decimate(series.time(), window, columns, |k| MILLIMETRES * values[k]);
    let latest = values.last().copied().unwrap_or(f64::NAN);
    Curve {
        id: "front",
        title: "Front radius R [mm]",
        latest: number::fixed(MILLIMETRES * latest, 2),
        colour: palette.angle,
        height: height_of(&points, SMALLEST_FRONT_SPAN),
        points,
        decades: false,
        unit: "mm",
    }
}

fn energy(
    simulation: &Simulation,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
) -> Curve {
    let series = simulation.series();
    let translation = series.column(Measure::TranslationalEnergy);
    let rotation = series.column(Measure::RotationalEnergy);
    let value = |k: usize| MICROJOULES * (translation[k] + rotation[k]);
    let points = decimate(series.time(), window, columns, value);
    let latest = series.len().checked_sub(1).map_or(f64::NAN, value);
    Curve {
        id: "energy",
        title: "Kinetic energy per grain [µJ]",
        latest: number::short(latest),
        colour: palette.temperature,
        height: height_of(&points, 0.0),
        points,
        decades: false,
        unit: "µJ",
    }
}

/// What is marked on both plots.
struct Marks {
    palette: Palette,
    changes: Vec<f64>,
    collapse: Option<Collapse>,
}

impl Marks {
    fn of(simulation: &Simulation, palette: Palette) -> Self {
        Self {
            palette,
            changes: changes(simulation),
            collapse: Collapse::of(simulation.series()),
        }
    }

    fn ui(&self, plot: &mut PlotUi) {
        let line = |name: &str, time: f64, colour| {
            VLine::new(name, time)
                .stroke(Stroke::new(1.0, colour))
                .allow_hover(false)
        };
        for time in &self.changes {
            plot.vline(line("parameter changed", *time, self.palette.change));
        }
        let Some(collapse) = &self.collapse else {
            return;
        };
        let dashed = LineStyle::dashed_dense();
        plot.vline(line("t_max", collapse.peak_time, self.palette.maximum).style(dashed));
        if let Some(rest) = collapse.rest_time {
            plot.vline(line("t_f", rest, self.palette.minimum).style(dashed));
        }
    }
}
