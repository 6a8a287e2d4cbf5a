//! A chart of a sweep on the screen: points with their errors, and laws.
//!
//! In: the chart as the sweep's files have it, and where the present run stands. Out: the place on
//! the horizontal axis that was clicked on.

use crate::ui::plots::axes::{fitting_plot, tick};
use crate::ui::theme::Palette;
use crate::ui::words::{number, symbol};
use bevy_egui::egui::{self, Color32, RichText, WidgetInfo, WidgetType};
use egui_plot::{HoverPosition, Line, LineStyle, MarkerShape, PlotUi, Points, VLine};
use grainfall::sweep::chart;

/// Room round what is drawn, as a share of its extent.
const ROOM: f64 = 0.06;
/// Half the width of the ends of an error bar, as a share of the plot's width.
const BAR_END: f64 = 0.01;

/// Where the present run stands, in the units of the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PresentRun {
    /// Across.
    pub x: f64,
    /// Upright, where the run has such a result.
    pub y: Option<f64>,
}

/// Draws `shown`; the place across, in the unit of the chart, that was clicked on.
pub fn chart_ui(
    ui: &mut egui::Ui,
    shown: &chart::Plot,
    present: Option<PresentRun>,
) -> Option<f64> {
    let palette = Palette::of(ui.visuals());
    let drawn = Drawn { shown, palette };
    let [(left, right), (low, high)] = drawn.extent(present);
    ui.label(symbol::text(ui, &shown.title));
    let (by_powers, upright_powers) = (shown.x.is_logarithmic(), shown.y.is_logarithmic());
    let plot = fitting_plot(ui, &shown.title)
        .width(ui.available_width() - 14.0)
        .set_margin_fraction(egui::Vec2::ZERO)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .include_x(left)
        .include_x(right)
        .include_y(low)
        .include_y(high)
        .x_axis_label(RichText::new(shown.x.label()).small())
        .y_axis_label(RichText::new(shown.y.label()).small())
        .x_axis_formatter(move |mark, _| place_text(mark.value, by_powers))
        .y_axis_formatter(move |mark, _| place_text(mark.value, upright_powers))
        .label_formatter(move |hover| Some(under_pointer(hover, [by_powers, upright_powers])));
    let response = plot.show(ui, |plot| {
        drawn.laws_ui(plot);
        drawn.present_ui(plot, present);
        drawn.results_ui(plot, BAR_END * (right - left));
    });
    let words = in_words(shown);
    (response.response).widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, &words));
    drawn.legend_ui(ui, present.is_some());
    let pointer = response.response.interact_pointer_pos();
    let pointer = pointer.filter(|_| response.response.clicked())?;
    let place = response.transform.value_from_position(pointer).x;
    Some(if by_powers { 10_f64.powf(place) } else { place })
}

/// A chart with the colours of its lines.
struct Drawn<'a> {
    shown: &'a chart::Plot,
    palette: Palette,
}

impl Drawn<'_> {
    /// From where to where it reaches across and upright, as places on the axes.
    fn extent(&self, present: Option<PresentRun>) -> [(f64, f64); 2] {
        let lines = self.shown.lines.iter();
        let points = lines.clone().flat_map(|line| line.points.iter().copied());
        let bars = lines.flat_map(|line| &line.bars);
        let ends = bars.flat_map(|(x, low, high)| [(*x, *low), (*x, *high)]);
        let own = present.map(|own| (own.x, own.y.unwrap_or(f64::NAN)));
        let all: Vec<[f64; 2]> = points
            .chain(ends)
            .chain(own)
            .map(|at| self.place(at))
            .collect();
        [0, 1].map(|axis| {
            let numbers = all.iter().map(|at| at[axis]).filter(|at| at.is_finite());
            let (low, high) = numbers
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
                    (low.min(at), high.max(at))
                });
            if low > high {
                return (0.0, 1.0);
            }
            let span = if high > low {
                high - low
            } else {
                0.2 * high.abs().max(1e-12)
            };
            (low - ROOM * span, high + ROOM * span)
        })
    }

    /// Where a point lies on the axes.
    fn place(&self, (x, y): (f64, f64)) -> [f64; 2] {
        [self.shown.x.place(x), self.shown.y.place(y)]
    }

    fn places(&self, line: &chart::Line) -> Vec<[f64; 2]> {
        let places = line.points.iter().map(|at| self.place(*at));
        places
            .filter(|at| at.iter().all(|own| own.is_finite()))
            .collect()
    }

    /// The lines that are results, or those that are laws, each with its colour.
    fn lines(&self, are_laws: bool) -> impl Iterator<Item = (&chart::Line, Color32)> {
        let colours = self.palette.stages;
        let wanted = self
            .shown
            .lines
            .iter()
            .filter(move |line| line.is_law == are_laws);
        wanted.enumerate().map(move |(index, line)| {
            let colour = if are_laws {
                self.palette.threshold
            } else {
                colours[index % colours.len()]
            };
            (line, colour)
        })
    }

    fn laws_ui<'b>(&'b self, plot: &mut PlotUi<'b>) {
        for (line, colour) in self.lines(true) {
            let places = self.places(line);
            let marks = Points::new(&line.name, places.clone())
                .radius(2.0)
                .color(colour);
            if places.len() == 1 {
                plot.points(marks);
            }
            plot.line(Line::new(&line.name, places).color(colour).width(1.4));
        }
    }

    fn results_ui<'b>(&'b self, plot: &mut PlotUi<'b>, end: f64) {
        for (line, colour) in self.lines(false) {
            for (x, low, high) in &line.bars {
                let ([x, low], [_, high]) = (self.place((*x, *low)), self.place((*x, *high)));
                // One that goes down to zero has no lower end on an axis of powers of ten.
                let low = if low.is_finite() {
                    low
                } else {
                    plot.plot_bounds().min()[1]
                };
                let strokes = [
                    [[x, low], [x, high]],
                    [[x - end, low], [x + end, low]],
                    [[x - end, high], [x + end, high]],
                ];
                for stroke in strokes {
                    let bar = Line::new(&line.name, stroke.to_vec());
                    plot.line(bar.color(colour).width(1.2).allow_hover(false));
                }
            }
            let places = self.places(line);
            let curve = Line::new(&line.name, places.clone()).color(colour);
            plot.line(curve.width(1.2).allow_hover(false));
            plot.points(Points::new(&line.name, places).radius(4.5).color(colour));
        }
    }

    fn present_ui(&self, plot: &mut PlotUi<'_>, present: Option<PresentRun>) {
        let Some(own) = present else {
            return;
        };
        let colour = self.palette.maximum;
        let [x, y] = self.place((own.x, own.y.unwrap_or(f64::NAN)));
        if x.is_finite() {
            let line = VLine::new(PRESENT, x).color(colour);
            plot.vline(line.style(LineStyle::dashed_dense()).allow_hover(false));
        }
        if x.is_finite() && y.is_finite() {
            let mark = Points::new(PRESENT, vec![[x, y]]).shape(MarkerShape::Diamond);
            plot.points(mark.filled(false).radius(6.0).color(colour));
        }
    }

    /// What is what, below the plot.
    fn legend_ui(&self, ui: &mut egui::Ui, has_present: bool) {
        let results = self
            .lines(false)
            .map(|(line, colour)| ("●", line.name.as_str(), colour));
        let laws = self
            .lines(true)
            .map(|(line, colour)| ("—", line.name.as_str(), colour));
        let own = has_present.then_some(("◇", PRESENT, self.palette.maximum));
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            for (sign, name, colour) in results.chain(laws).chain(own) {
                if !name.is_empty() {
                    ui.label(RichText::new(sign).small().color(colour));
                    ui.label(RichText::new(name).small());
                    ui.add_space(8.0);
                }
            }
        });
    }
}

/// What the mark of the run in the window is called.
const PRESENT: &str = "this run";

/// The text at a `place` of an axis.
fn place_text(place: f64, by_powers: bool) -> String {
    if by_powers {
        number::rounded(10_f64.powf(place), 2)
    } else {
        tick(place, false)
    }
}

fn under_pointer(hover: &HoverPosition, by_powers: [bool; 2]) -> String {
    let (name, at) = match hover {
        HoverPosition::NearDataPoint {
            plot_name,
            position,
            ..
        } => (*plot_name, *position),
        HoverPosition::Elsewhere { position } => ("", *position),
    };
    let [x, y] = [(at.x, by_powers[0]), (at.y, by_powers[1])].map(|(place, by_powers)| {
        number::short(if by_powers { 10_f64.powf(place) } else { place })
    });
    format!("{name}\n{x}\n{y}").trim_start().to_owned()
}

/// The chart for those who do not see it.
fn in_words(shown: &chart::Plot) -> String {
    let results = shown.lines.iter().filter(|line| !line.is_law);
    let points = results.flat_map(|line| &line.points);
    let points: Vec<String> = points
        .map(|(x, y)| format!("{} at {}", number::short(*y), number::short(*x)))
        .collect();
    format!("{}: {}", shown.title, points.join(", "))
}
