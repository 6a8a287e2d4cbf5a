//! One plot over time: the curves of one measure, its value at the moment shown, marks over it.
//!
//! In: the curves and the part of the run in view. Out: the plot, and what the pointer did on it.

use crate::ui::plots::axes::{SPARSE_X, SPARSE_Y, round_marks, tick, tidy};
use crate::ui::plots::labels::{LabelSide, PlotLabel, labels_ui};
use crate::ui::plots::run_curves::{Lines, compared_line};
use crate::ui::theme::{Palette, dash};
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Color32, RichText, Stroke, Vec2b};
use egui_plot::{AxisHints, HoverPosition, Line, LineStyle, Plot, PlotBounds, PlotUi, VLine};
use grainfall::measure::Measure;
use std::ops::RangeInclusive;

/// Room for half of the last label of the time axis.
const ROOM_AT_THE_RIGHT: f32 = 14.0;
/// A curve of a kept run that is shorter than this has no name: there is nothing to be named, in
/// points across.
const SHORTEST_NAMED: f64 = 6.0;
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
    /// Texts beside its marks, the most important first.
    pub labels: Vec<PlotLabel>,
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
        let mut labels = self.labels;
        let shortest = SHORTEST_NAMED * (window.end() - window.start()) / f64::from(room.x);
        labels.extend(names(&kept, window, shortest, palette.kept));
        let shown = plot.show(ui, move |plot| {
            plot.set_plot_bounds(bounds);
            for (index, (name, points)) in kept.into_iter().enumerate() {
                plot.line(kept_line(index, name, points, palette.kept));
            }
            plot.line(line);
            if let Some(line) = compared {
                plot.line(line);
            }
            marks(plot);
        });
        labels_ui(ui, &shown.transform, &labels);
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

/// A kept run as a dashed line.
fn kept_line<'a>(index: usize, name: String, points: Vec<[f64; 2]>, colour: Color32) -> Line<'a> {
    let length = dash(index);
    let line = Line::new(name, points).color(colour).width(1.2);
    line.style(LineStyle::Dashed { length })
}

/// The names of kept runs where their lines end in `window` [s]; of lines that are seen of less than
/// `shortest` [s], none.
fn names(
    kept: &[(String, Vec<[f64; 2]>)],
    window: &RangeInclusive<f64>,
    shortest: f64,
    colour: Color32,
) -> Vec<PlotLabel> {
    let name = |(name, points): &(String, Vec<[f64; 2]>)| {
        let begin = points.first()?[0].max(*window.start());
        // One sample beyond the window is there to lead the line to its edge.
        let end = points.last()?[0].min(*window.end());
        let [_, value] = points.iter().rfind(|[time, _]| *time <= end)?;
        (end - begin >= shortest).then(|| PlotLabel {
            text: name.clone(),
            at: [end, *value],
            colour,
            side: LabelSide::End,
        })
    };
    kept.iter().filter_map(name).collect()
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
    fn a_run_of_which_no_curve_is_seen_has_no_name() {
        let line = |name: &str, times: &[f64]| {
            let points = times.iter().map(|time| [*time, 0.4]).collect();
            (name.to_owned(), points)
        };
        let kept = [
            line("not begun", &[]),
            line("a sample", &[0.0]),
            line("a step", &[0.0, 2e-5]),
            line("before it", &[0.0, 4.0, 9.9]),
            line("in it", &[0.0, 12.0, 15.0]),
            line("beyond it", &[12.0, 29.0, 31.0]),
        ];
        let named = |window: RangeInclusive<f64>| -> Vec<(String, f64)> {
            let labels = names(&kept, &window, 0.2, Color32::WHITE).into_iter();
            labels.map(|label| (label.text, label.at[0])).collect()
        };
        let expected = [("in it", 15.0), ("beyond it", 30.0)];
        assert_eq!(
            named(10.0..=30.0),
            expected.map(|(name, time)| (name.to_owned(), time))
        );
        let expected = [("before it", 1.0), ("in it", 1.0)];
        assert_eq!(
            named(0.0..=1.0),
            expected.map(|(name, time)| (name.to_owned(), time))
        );
    }
}
