//! The curves of one measure for all runs on a plot: the present one, the one beside it, those that
//! were left for others.
//!
//! In: the simulation with its series. Out: points, no more than a plot shows, and the legend of
//! two runs side by side.

use crate::simulation::Simulation;
use crate::ui::playback::moment_shown;
use crate::ui::plots::decimate::decimate;
use crate::ui::theme::{COMPARED_DASH, Palette};
use crate::ui::words::number;
use crate::ui::words::run_names::{KeptRun, RunNames};
use bevy_egui::egui::{self, Stroke};
use egui_plot::{Line, LineStyle};
use grainfall::lab::{Half, RunView};
use grainfall::measure::{Avalanche, Series};
use std::ops::RangeInclusive;

/// What the plots over time draw.
#[derive(Clone, Copy)]
pub struct Curves<'a> {
    /// The samples of the run.
    pub series: &'a Series,
    /// The samples of the run beside it.
    pub compared: Option<&'a Series>,
    /// Avalanches in order of time.
    pub avalanches: &'a [Avalanche],
    /// When parameters were changed [s], ascending.
    pub changes: &'a [f64],
    /// Branches that are kept beside the present run.
    pub kept: &'a [KeptRun],
    /// The moment shown [s], where it is not the newest.
    pub shown: Option<f64>,
}

/// The lines of one plot.
pub struct Lines {
    /// Of the present run.
    pub own: Vec<[f64; 2]>,
    /// Of the run it is compared with.
    pub compared: Option<Vec<[f64; 2]>>,
    /// Of kept branches, with their names.
    pub kept: Vec<(String, Vec<[f64; 2]>)>,
}

impl<'a> Curves<'a> {
    /// The curves of all runs of `simulation`.
    pub fn of(simulation: &'a Simulation, changes: &'a [f64], kept: &'a [KeptRun]) -> Self {
        Self {
            series: simulation.series(),
            compared: (simulation.comparison()).map(|comparison| comparison.right.series()),
            avalanches: simulation.avalanches(),
            changes,
            kept,
            shown: moment_shown(simulation),
        }
    }

    /// The lines in `window`, where `value` is taken of their samples.
    pub fn lines(
        &self,
        window: &RangeInclusive<f64>,
        columns: usize,
        value: impl Fn(&Series, usize) -> f64,
    ) -> Lines {
        let line = |series: &Series| decimate(series.time(), window, columns, |i| value(series, i));
        let kept = self.kept.iter();
        Lines {
            own: line(self.series),
            compared: self.compared.map(line),
            kept: kept
                .map(|(name, record)| (name.clone(), line(&record.series)))
                .collect(),
        }
    }

    /// The value of each run at the moment shown in words.
    pub fn present(
        &self,
        value: impl Fn(&Series, usize) -> f64,
        in_words: impl Fn(f64) -> String,
    ) -> Vec<String> {
        let present = |series: &Series| {
            let until = |shown| series.time().partition_point(|time| *time <= shown);
            let index = self.shown.map_or(series.len(), until).checked_sub(1);
            in_words(index.map_or(f64::NAN, |index| value(series, index)))
        };
        std::iter::once(self.series)
            .chain(self.compared)
            .map(present)
            .collect()
    }
}

impl Lines {
    /// All their points.
    pub fn points(&self) -> impl Iterator<Item = &[f64; 2]> {
        let kept = self.kept.iter().flat_map(|(_, points)| points);
        (self.own.iter())
            .chain(self.compared.iter().flatten())
            .chain(kept)
    }
}

/// Times at which parameters were changed [s], ascending. One drag of a slider is one change.
pub fn change_times(run: &RunView) -> Vec<f64> {
    let commands = run.commands();
    let times = (run.changes().iter()).filter_map(|first| Some(commands.get(*first)?.time));
    times.collect()
}

/// Which line is which of the two runs, where there are two.
pub fn halves_ui(ui: &mut egui::Ui, simulation: &Simulation) {
    if simulation.comparison().is_none() {
        return;
    }
    let names = RunNames::of(simulation);
    let palette = Palette::of(ui.visuals());
    let lines = [
        (Half::Left, ui.visuals().text_color(), None),
        (Half::Right, palette.compared, Some(COMPARED_DASH)),
    ];
    for (half, colour, dash) in lines {
        ui.horizontal(|ui| {
            line_sample_ui(ui, dash, Stroke::new(1.8, colour));
            let side = number::capitalised(half.label());
            ui.label(format!("{side}: {}", names.present(half)));
        });
    }
}

/// A piece of a line on the plots, with dashes of this length.
pub fn line_sample_ui(ui: &mut egui::Ui, dash: Option<f32>, stroke: Stroke) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(30.0, 14.0), egui::Sense::hover());
    let ends = [rect.left_center(), rect.right_center()];
    match dash {
        None => drop(ui.painter().line_segment(ends, stroke)),
        Some(dash) => {
            let line = egui::Shape::dashed_line(&ends, stroke, dash, 0.6 * dash);
            ui.painter().extend(line);
        }
    }
}

/// The line of the run beside the first.
pub fn compared_line<'a>(name: &str, points: Vec<[f64; 2]>, palette: Palette) -> Line<'a> {
    let style = LineStyle::Dashed {
        length: COMPARED_DASH,
    };
    Line::new(name, points)
        .color(palette.compared)
        .width(2.0)
        .style(style)
}
