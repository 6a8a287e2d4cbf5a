//! The front and the kinetic energy of a collapsing column over the same time, with its peak and
//! its rest marked.
//!
//! In: columns of samples. Out: two plots that always show the same time, and the moment that a
//! person clicks on.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, is_column};
use crate::ui::playback::seek;
use crate::ui::plots::axes::height_of;
use crate::ui::plots::run_curves::{Curves, change_times, halves_ui};
use crate::ui::plots::time_plot::{TimePlot, moment_ui, size_of_plots};
use crate::ui::plots::time_window::{TimeWindow, clicked_time};
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use crate::ui::words::run_names::RunNames;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Stroke};
use egui_plot::{LineStyle, PlotUi, VLine};
use grainfall::measure::{Collapse, Measure, Series};
use std::ops::RangeInclusive;

const MILLIMETRES: f64 = 1e3;
const MICROJOULES: f64 = 1e6;
/// Smallest height of the plot of the front [mm].
const SMALLEST_FRONT_SPAN: f64 = 5.0;
/// Smallest height of the plot of the energy [µJ]: a grain of a millimetre that falls by its own
/// size has more.
const SMALLEST_ENERGY_SPAN: f64 = 1e-3;

/// Both plots.
#[derive(Debug, PartialEq)]
pub struct CollapsePlots {
    window: TimeWindow,
}

impl Default for CollapsePlots {
    fn default() -> Self {
        Self {
            window: TimeWindow::All,
        }
    }
}

impl Panel for CollapsePlots {
    fn title(&self) -> &'static str {
        "Plots"
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        is_column(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let (changes, kept) = (change_times(simulation), RunNames::of(simulation).kept);
        let all = Curves::of(simulation, &changes, &kept);
        halves_ui(ui, simulation);
        ui.horizontal_wrapped(|ui| self.window.choice_ui(ui));
        let (height, columns) = size_of_plots(ui);
        let palette = Palette::of(ui.visuals());
        let window = self.window.window(all.series.time(), all.shown);
        let marks = CollapseMarks::of(all, palette);
        let plots = [
            front(&all, &window, columns, palette),
            energy(&all, &window, columns, palette),
        ];
        for plot in plots {
            let response = plot.ui(ui, &window, height, view, |plot| marks.ui(plot));
            let clicked = clicked_time(&response, &window);
            out.extend(clicked.and_then(|time| seek(simulation, time)));
            self.window.follow_pointer(&response, &window);
        }
    }
}

fn front(
    curves: &Curves,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
) -> TimePlot {
    let value = |series: &Series, k: usize| MILLIMETRES * series.column(Measure::FrontRadius)[k];
    let lines = curves.lines(window, columns, value);
    TimePlot {
        id: "front",
        title: "Front radius R [mm]",
        present: curves.present(value, |radius| number::fixed(radius, 2)),
        colour: palette.angle,
        height: height_of(lines.points(), SMALLEST_FRONT_SPAN),
        lines,
        labels: Vec::new(),
        decades: false,
        unit: "mm",
        measure: Measure::FrontRadius,
    }
}

fn energy(
    curves: &Curves,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
) -> TimePlot {
    let value = |series: &Series, k: usize| {
        let translation = series.column(Measure::TranslationalEnergy)[k];
        MICROJOULES * (translation + series.column(Measure::RotationalEnergy)[k])
    };
    let lines = curves.lines(window, columns, value);
    TimePlot {
        id: "energy",
        title: "Kinetic energy per grain [µJ]",
        present: curves.present(value, number::short),
        colour: palette.temperature,
        height: height_of(lines.points(), SMALLEST_ENERGY_SPAN),
        lines,
        labels: Vec::new(),
        decades: false,
        unit: "µJ",
        measure: Measure::TranslationalEnergy,
    }
}

/// What is marked on both plots.
struct CollapseMarks<'a> {
    palette: Palette,
    changes: &'a [f64],
    shown: Option<f64>,
    collapse: Option<Collapse>,
}

impl<'a> CollapseMarks<'a> {
    /// Those of the left run.
    fn of(curves: Curves<'a>, palette: Palette) -> Self {
        Self {
            palette,
            changes: curves.changes,
            shown: curves.shown,
            collapse: Collapse::of(curves.series),
        }
    }

    fn ui(&self, plot: &mut PlotUi) {
        let line = |name: &str, time: f64, colour| {
            VLine::new(name, time)
                .stroke(Stroke::new(1.0, colour))
                .allow_hover(false)
        };
        for time in self.changes {
            plot.vline(line("parameter changed", *time, self.palette.change));
        }
        if let Some(time) = self.shown {
            moment_ui(plot, time, self.palette);
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
