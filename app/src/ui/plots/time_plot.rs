//! One plot over time: the curves of one measure, its value at the moment shown, marks over it.
//!
//! In: the curves and the part of the run in view. Out: the plot, and what the pointer did on it.

use crate::ui::plots::axes::{SPARSE_X, SPARSE_Y, round_marks, tick, tidy};
use crate::ui::plots::run_curves::{Lines, compared_line};
use crate::ui::theme::{Palette, dash};
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Align2, Color32, RichText, Stroke, Vec2b};
use egui_plot::{
    AxisHints, HoverPosition, Line, LineStyle, Plot, PlotBounds, PlotPoint, PlotUi, Text, VLine,
};
use grainfall::measure::Measure;
use std::ops::RangeInclusive;

/// Room for half of the last label of the time axis.
const ROOM_AT_THE_RIGHT: f32 = 14.0;
/// Height of the name of a kept run, as a share of the plot.
const LABEL_HEIGHT: f64 = 0.1;
/// Width of a letter of it, about, in points.
const LETTER_WIDTH: f32 = 5.6;
/// Longest name on a plot, in letters; the pointer tells the rest.
const LONGEST_NAME: usize = 22;
/// Width of the line whose mark in the picture is under the pointer, in points.
const LIT_WIDTH: f32 = 3.4;
/// Room for the value of a run beside the title, in points.
const ROOM_FOR_VALUE: f32 = 92.0;

/// One plot over time.
pub struct TimePlot {
    /// Its identity for egui: no two plots in a panel share it.
    pub id: &'static str,
    /// Its heading: name and unit.
    pub title: &'static str,
    /// The value of each run at the moment shown.
    pub present: Vec<String>,
    /// Its line's colour.
    pub colour: Color32,
    /// Its lines.
    pub lines: Lines,
    /// The range of the vertical axis.
    pub height: RangeInclusive<f64>,
    /// Whether its numbers are powers of ten.
    pub decades: bool,
    /// The unit behind a number of the vertical axis.
    pub unit: &'static str,
    /// What its line shows.
    pub measure: Measure,
}

/// Height of a plot and number of its columns of pixels in `ui`.
pub fn size_of_plots(ui: &egui::Ui) -> (f32, usize) {
    let height = (0.215 * ui.ctx().content_rect().height()).clamp(110.0, 300.0);
    let columns = (ui.available_width().max(100.0) * ui.ctx().pixels_per_point()) as usize;
    (height, columns)
}

impl TimePlot {
    /// Draws the plot with `marks` over its lines, for the part of the run in `window` [s],
    /// `height` points high. The response tells what the pointer did. The picture is told which
    /// measure is under the pointer, and the line of that under the pointer there stands out.
    pub fn ui<'a>(
        self,
        ui: &mut egui::Ui,
        window: &RangeInclusive<f64>,
        height: f32,
        view: &mut ViewSettings,
        marks: impl FnOnce(&mut PlotUi<'a>) + 'a,
    ) -> egui::Response {
        let palette = Palette::of(ui.visuals());
        let colours = [self.colour, palette.compared];
        head_ui(ui, (self.title, self.measure), &self.present, colours);
        let measure = self.measure;
        let is_lit = view.lit_by_picture == Some(measure);
        let bounds = PlotBounds::from_min_max(
            [*window.start(), *self.height.start()],
            [*window.end(), *self.height.end()],
        );
        let room = egui::vec2(ui.available_width() - ROOM_AT_THE_RIGHT, height);
        let plot = self.empty_plot(room, palette);
        let Lines {
            own,
            compared,
            kept,
        } = self.lines;
        let name = if compared.is_some() {
            "left"
        } else {
            self.title
        };
        let width = if is_lit { LIT_WIDTH } else { 1.7 };
        let line = Line::new(name, own).color(self.colour).width(width);
        let compared = compared.map(|points| compared_line("right", points, palette));
        let shown = plot.show(ui, move |plot| {
            plot.set_plot_bounds(bounds);
            let mut labels = Vec::new();
            for (index, (name, points)) in kept.into_iter().enumerate() {
                kept_ui(plot, index, &name, points, palette.kept, &mut labels);
            }
            plot.line(line);
            if let Some(line) = compared {
                plot.line(line);
            }
            marks(plot);
        });
        if shown.response.hovered() {
            view.lit_by_plot = Some(measure);
        }
        shown.response
    }

    /// Axes and grid in a `room` of this size [points]. The pointer does not move them: the time
    /// window does.
    fn empty_plot<'a>(&self, room: egui::Vec2, palette: Palette) -> Plot<'a> {
        let (decades, unit) = (self.decades, self.unit);
        let equation = self.measure.quantity().equation;
        Plot::new(self.id)
            .height(room.y)
            .width(room.x)
            .show_crosshair(false)
            .grid_color(palette.grid)
            .x_grid_spacer(|input| round_marks(input, SPARSE_X, 0.0))
            .y_grid_spacer(move |input| {
                let finest = if decades { 1.0 } else { 0.0 };
                round_marks(input, SPARSE_Y, finest)
            })
            .auto_bounds(false)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_axis_zoom_drag(false)
            .allow_double_click_reset(false)
            .link_cursor("time", Vec2b::new(true, false))
            .custom_x_axes(vec![
                AxisHints::new_x()
                    .label_spacing(SPARSE_X * 6.0..=SPARSE_X * 8.0)
                    .formatter(|mark, _| format!("{} s", tidy(mark.value))),
            ])
            .custom_y_axes(vec![
                AxisHints::new_y()
                    .min_thickness(46.0)
                    .label_spacing(SPARSE_Y * 6.0..=SPARSE_Y * 8.0)
                    .formatter(move |mark, _| tick(mark.value, decades)),
            ])
            .label_formatter(move |hover| Some(hover_label(hover, decades, unit, equation)))
    }
}

/// The heading and the value of each run at the moment shown, in one line where there is room.
fn head_ui(
    ui: &mut egui::Ui,
    (title, measure): (&str, Measure),
    values: &[String],
    colours: [Color32; 2],
) {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let words = ui
        .painter()
        .layout_no_wrap(title.to_owned(), font, Color32::WHITE);
    let needed = words.size().x + ROOM_FOR_VALUE * values.len() as f32;
    let title_ui = |ui: &mut egui::Ui| {
        let quantity = measure.quantity();
        let text = format!("{}\n{}", quantity.explanation(), quantity.equation);
        ui.label(RichText::new(title).strong())
            .on_hover_text(text.trim_end())
    };
    let values_ui = |ui: &mut egui::Ui| {
        // From right to left.
        for (index, (text, colour)) in values.iter().zip(colours).enumerate().rev() {
            ui.label(RichText::new(text).color(colour).strong());
            if index > 0 {
                ui.weak("|");
            }
        }
    };
    if needed < ui.available_width() {
        egui::Sides::new().show(ui, title_ui, values_ui);
    } else {
        title_ui(ui);
        egui::Sides::new().show(ui, |_| (), values_ui);
    }
}

/// A kept run as a dashed line with its name at the end, below the `labels` that stand there already.
fn kept_ui(
    plot: &mut PlotUi,
    index: usize,
    name: &str,
    points: Vec<[f64; 2]>,
    colour: Color32,
    labels: &mut Vec<[f64; 3]>,
) {
    let Some([time, value]) = points.last().copied() else {
        return;
    };
    plot.line(
        Line::new(name, points)
            .color(colour)
            .width(1.2)
            .style(LineStyle::Dashed {
                length: dash(index),
            }),
    );
    let shown = shortened(name);
    let bounds = plot.plot_bounds();
    let share = LETTER_WIDTH * shown.chars().count() as f32 / plot.transform().frame().width();
    let width = f64::from(share) * bounds.width();
    // Right-aligned at the end of its line, where it is not cut off on the left.
    let end = time.max(bounds.min()[0] + width).min(bounds.max()[0]);
    let place = free_place([end, value, width], LABEL_HEIGHT * bounds.height(), labels);
    labels.push(place);
    let at = PlotPoint::new(place[0], place[1]);
    let label = RichText::new(shown).small().color(colour);
    plot.text(Text::new(name, at, label).anchor(Align2::RIGHT_BOTTOM));
}

/// `name` as far as a plot has room for it.
fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    let kept: String = name.chars().take(LONGEST_NAME - 1).collect();
    format!("{}…", kept.trim_end())
}

/// Where a label that belongs at `wanted` (its right end, its height, its width) stands without lying
/// over others, each label so `high`.
fn free_place(wanted: [f64; 3], high: f64, others: &[[f64; 3]]) -> [f64; 3] {
    let is_taken = |place: &[f64; 3]| {
        let covers = |other: &[f64; 3]| {
            let beside = place[0] - place[2] < other[0] && other[0] - other[2] < place[0];
            beside && (other[1] - place[1]).abs() < 0.99 * high
        };
        others.iter().any(covers)
    };
    let below = |rows: usize| [wanted[0], wanted[1] - rows as f64 * high, wanted[2]];
    // Each of them may cover two rows.
    let mut places = (0..=2 * others.len()).map(below);
    places.find(|place| !is_taken(place)).unwrap_or(wanted)
}

/// A mark at the moment shown.
pub fn moment_ui(plot: &mut PlotUi, time: f64, palette: Palette) {
    plot.vline(
        VLine::new("shown", time)
            .stroke(Stroke::new(2.0, palette.warning))
            .allow_hover(false),
    );
}

fn hover_label(hover: &HoverPosition, decades: bool, unit: &str, equation: &str) -> String {
    let (name, position) = match hover {
        HoverPosition::NearDataPoint {
            plot_name,
            position,
            ..
        } => (*plot_name, *position),
        HoverPosition::Elsewhere { position } => ("", *position),
    };
    let value = if decades {
        10_f64.powf(position.y)
    } else {
        position.y
    };
    let place = format!(
        "{}\n{} {unit}",
        number::moment(position.x),
        number::short(value)
    );
    if name.is_empty() {
        place
    } else {
        format!("{name}\n{place}\n{equation}").trim_end().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_runs_that_end_together_stand_below_each_other() {
        // A tenth of a plot that is 10 high, and names of 3.
        let (high, width) = (1.0, 3.0);
        let mut labels = Vec::new();
        for value in [5.0, 5.1, 4.9, 9.0] {
            let place = free_place([18.0, value, width], high, &labels);
            let is_free = |other: &[f64; 3]| (place[1] - other[1]).abs() >= 0.99;
            assert!(labels.iter().all(is_free), "{place:?} {labels:?}");
            labels.push(place);
        }
        let kept = (labels[0], labels[3]);
        assert_eq!(kept, ([18.0, 5.0, width], [18.0, 9.0, width]));
        for free in [[14.9, 5.0, width], [2.0, 5.0, 1.0]] {
            assert_eq!(free_place(free, high, &labels), free);
        }
        // A long name reaches over to the others.
        assert!(free_place([21.0, 5.0, 4.0], high, &labels)[1] < 5.0);
    }

    #[test]
    fn long_names_are_cut_on_a_plot() {
        assert_eq!(shortened("μ 0.8 from 3.20 s"), "μ 0.8 from 3.20 s");
        let long = shortened("glycerol from 3.20 s, N 470");
        assert_eq!(long, "glycerol from 3.20 s,…");
    }
}
