//! Surface angle θ(t) and granular temperature Tg(t) over the same time, with avalanches and changes marked.
//!
//! In: columns of samples, of the present run and of those kept beside it. Out: two plots that cost the same however long
//! the run is, and the moment that a person clicks on. Which part of the run is in view is kept here, not in the plots, so
//! both always show the same time and fit their height to what they show.

use super::compare::half_title;
use super::decimate::decimate;
use super::theme::{Palette, TWIN_DASH, dash};
use super::{Panel, Request, has_bed, number};
use crate::measure::{Avalanche, Measure, NON_RIGID_TEMPERATURE, Series};
use crate::simulation::{Command, Half, Record, Simulation};
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Align2, Color32, RichText, Stroke, Vec2b, WidgetInfo, WidgetType};
use egui_plot::{
    AxisHints, GridInput, GridMark, HLine, HoverPosition, Line, LineStyle, MarkerShape, Plot,
    PlotBounds, PlotPoint, PlotUi, Points, Text, VLine,
};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Length of the window that follows the run [s].
const RECENT: f64 = 20.0;
/// Shortest window that one can zoom to [s].
const SHORTEST: f64 = 0.2;
/// Columns of pixels between two labels of avalanches at least.
const BETWEEN_LABELS: f64 = 46.0;
/// A click this near to the start of an avalanche means it, in points.
const NEAR: f64 = 7.0;
/// How far above its avalanche's start a label stands, as a share of the plot's height.
const LABEL_LIFT: f64 = 0.035;
/// Room below and above a curve, as shares of its height; labels stand above.
const BELOW: f64 = 0.08;
const ABOVE: f64 = 0.2;
/// Smallest height of the θ plot [°], so that noise at rest does not fill it.
const SMALLEST_ANGLE_SPAN: f64 = 2.0;
/// Smallest height of the Tg plot with a logarithmic axis, in powers of ten.
const SMALLEST_DECADES: f64 = 2.0;
/// Temperatures are drawn no lower than this [m²/s²]: below lies only rounding.
const COLDEST: f64 = 1e-13;
/// Grid lines stand this many times further apart than the plot would have them at the closest, which is 8 points.
const SPARSE_X: f32 = 5.5;
const SPARSE_Y: f32 = 3.5;
/// Room for half of the last label of the time axis.
const ROOM_AT_THE_RIGHT: f32 = 14.0;
/// Room for the value of a run beside the title, in points.
const ROOM_FOR_VALUE: f32 = 92.0;
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Both plots.
#[derive(Debug, PartialEq)]
pub struct Plots {
    span: Span,
    logarithmic: bool,
}

/// Which part of the run is in view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Span {
    /// The last [`RECENT`] seconds.
    Recent,
    /// All of it.
    All,
    /// What a person dragged and zoomed to [s].
    Chosen(f64, f64),
}

/// What is drawn.
#[derive(Clone, Copy)]
pub struct Curves<'a> {
    /// The samples of the run.
    pub series: &'a Series,
    /// The samples of the run beside it.
    pub twin: Option<&'a Series>,
    /// Avalanches in order of time.
    pub avalanches: &'a [Avalanche],
    /// When parameters were changed [s], ascending.
    pub changes: &'a [f64],
    /// Runs that were left for others.
    pub kept: &'a [Ghost],
    /// The moment shown [s], where it is not the newest.
    pub shown: Option<f64>,
}

/// A run that was left for another, with its name.
pub type Ghost = (String, Arc<Record>);

/// The lines of one plot.
pub(super) struct Lines {
    own: Vec<[f64; 2]>,
    twin: Option<Vec<[f64; 2]>>,
    /// Those of runs kept beside it, with their names.
    kept: Vec<(String, Vec<[f64; 2]>)>,
}

impl<'a> Curves<'a> {
    /// Those of `simulation` and its twin.
    pub(super) fn of(simulation: &'a Simulation, changes: &'a [f64], kept: &'a [Ghost]) -> Self {
        Self {
            series: simulation.series(),
            twin: simulation.twin().map(|twin| twin.run().series()),
            avalanches: simulation.avalanches(),
            changes,
            kept,
            shown: shown(simulation),
        }
    }

    /// The lines in `window`, where `value` is taken of their samples.
    pub(super) fn lines(
        &self,
        window: &RangeInclusive<f64>,
        columns: usize,
        value: impl Fn(&Series, usize) -> f64,
    ) -> Lines {
        let line = |series: &Series| decimate(series.time(), window, columns, |i| value(series, i));
        let kept = self.kept.iter();
        Lines {
            own: line(self.series),
            twin: self.twin.map(line),
            kept: kept
                .map(|(name, record)| (name.clone(), line(&record.series)))
                .collect(),
        }
    }

    /// The value of each run at the moment shown in words.
    pub(super) fn present(
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
            .chain(self.twin)
            .map(present)
            .collect()
    }
}

impl Lines {
    /// All their points.
    pub(super) fn points(&self) -> impl Iterator<Item = &[f64; 2]> {
        let kept = self.kept.iter().flat_map(|(_, points)| points);
        (self.own.iter())
            .chain(self.twin.iter().flatten())
            .chain(kept)
    }
}

/// The runs that were left for others by `simulation` and by its twin.
pub(super) fn ghosts(simulation: &Simulation) -> Vec<Ghost> {
    let of = |run: &Simulation, beside: &str| -> Vec<Ghost> {
        let named =
            |record: &Arc<Record>| (format!("Run {}{beside}", record.number), record.clone());
        run.past().kept.iter().map(named).collect()
    };
    let twin = simulation.twin().map(|twin| of(twin.run(), ", right"));
    let mut ghosts = of(simulation, "");
    ghosts.extend(twin.into_iter().flatten());
    ghosts
}

/// One plot over time.
pub(super) struct Curve {
    /// What tells it from the others.
    pub id: &'static str,
    /// What stands over it.
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
}

/// What is marked in the part in view.
struct Marks<'a> {
    palette: Palette,
    avalanches: &'a [Avalanche],
    changes: Vec<f64>,
    shown: Option<f64>,
    /// Time between two labels at least [s].
    between_labels: f64,
}

impl Default for Plots {
    fn default() -> Self {
        Self {
            span: Span::Recent,
            logarithmic: true,
        }
    }
}

impl Panel for Plots {
    fn title(&self) -> &'static str {
        "Plots"
    }

    fn concerns(&self, simulation: &Simulation) -> bool {
        has_bed(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let (changes, ghosts) = (changes(simulation), ghosts(simulation));
        let curves = Curves::of(simulation, &changes, &ghosts);
        halves_ui(ui, simulation);
        avalanches_ui(ui, simulation, out);
        let clicked = self.curves_ui(ui, &curves);
        out.extend(clicked.and_then(|time| seek(simulation, time)));
    }
}

/// Backwards or on in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// To what was before.
    Back,
    /// To what comes next.
    On,
}

/// Buttons that go from avalanche to avalanche.
fn avalanches_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
    let count = simulation.avalanches().len();
    if count == 0 {
        return;
    }
    ui.horizontal(|ui| {
        ui.label(format!("Avalanches: {count}"));
        for (text, way, keys) in [
            ("Before", Way::Back, "Page up"),
            ("Next", Way::On, "Page down"),
        ] {
            let request = to_avalanche(simulation, way);
            let button = ui.add_enabled(request.is_some(), egui::Button::new(text));
            let name = format!("{text} avalanche");
            button.widget_info(|| {
                WidgetInfo::labeled(WidgetType::Button, request.is_some(), name.as_str())
            });
            if button
                .on_hover_text(format!("Show where it starts ({keys})"))
                .clicked()
            {
                out.extend(request);
            }
        }
    });
}

/// The request to show the start of the avalanche before or after the moment shown, where there is one.
pub(super) fn to_avalanche(simulation: &Simulation, way: Way) -> Option<Request> {
    let time_step = simulation.world()?.clock.time_step;
    let now = simulation.step() as f64 * time_step;
    // A start that is shown already is neither before nor after.
    let mut starts = simulation
        .avalanches()
        .iter()
        .map(|avalanche| avalanche.start);
    let start = match way {
        Way::Back => starts.rfind(|start| *start < now - time_step),
        Way::On => starts.find(|start| *start > now + time_step),
    };
    seek(simulation, start?)
}

/// When parameters were changed [s], ascending: once for each change, however many values it took.
pub(super) fn changes(simulation: &Simulation) -> Vec<f64> {
    let (past, commands) = (simulation.past(), simulation.commands());
    let times = past
        .changes
        .iter()
        .filter_map(|first| Some(commands.get(*first)?.time));
    times.collect()
}

/// The moment shown [s], where it is not the newest.
pub(super) fn shown(simulation: &Simulation) -> Option<f64> {
    let time_step = simulation.world()?.clock.time_step;
    simulation
        .looks_back()
        .then(|| simulation.step() as f64 * time_step)
}

/// The request to show the moment at `time` [s].
pub(super) fn seek(simulation: &Simulation, time: f64) -> Option<Request> {
    let time_step = simulation.world()?.clock.time_step;
    let step = (time.max(0.0) / time_step).round() as u64;
    Some(Request::Command(Command::Seek(step)))
}

/// A mark at the moment shown.
pub(super) fn shown_ui(plot: &mut PlotUi, time: f64, palette: Palette) {
    plot.vline(
        VLine::new("shown", time)
            .stroke(Stroke::new(2.0, palette.warning))
            .allow_hover(false),
    );
}

/// Height of a plot and number of its columns of pixels in `ui`.
pub(super) fn size_of_plots(ui: &egui::Ui) -> (f32, usize) {
    let height = (0.215 * ui.ctx().content_rect().height()).clamp(110.0, 300.0);
    let columns = (ui.available_width().max(100.0) * ui.ctx().pixels_per_point()) as usize;
    (height, columns)
}

impl Plots {
    /// Draws `curves` and the choice of what part of them is in view; returns the time that was clicked on [s].
    pub fn curves_ui(&mut self, ui: &mut egui::Ui, curves: &Curves) -> Option<f64> {
        self.choice_ui(ui);
        let (height, columns) = size_of_plots(ui);
        let palette = Palette::of(ui.visuals());
        let window = self.span.window(curves.series.time(), curves.shown);
        let marks = Marks::within(curves, &window, columns, palette);
        let angle = angle_curve(curves, &window, columns, palette);
        let first = curve_ui(ui, angle, &window, height, |plot| marks.angle_ui(plot));
        let temperature = temperature_curve(curves, &window, columns, palette, self.logarithmic);
        let decades = self.logarithmic;
        let second = curve_ui(ui, temperature, &window, height, |plot| {
            marks.temperature_ui(plot, decades);
        });
        let mut clicked = None;
        for response in [first, second] {
            let per_point = per_point(&response, &window);
            let near = |time| near_start(curves.avalanches, time, per_point);
            clicked = clicked.or(clicked_time(&response, &window).map(near));
            self.span.follow_pointer(&response, &window);
        }
        clicked
    }

    fn choice_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            self.span.choice_ui(ui);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.checkbox(&mut self.logarithmic, "log Tg")
                    .on_hover_text("Powers of ten for the granular temperature");
            });
        });
    }
}

impl Span {
    /// The buttons that choose it.
    pub fn choice_ui(&mut self, ui: &mut egui::Ui) {
        ui.selectable_value(self, Self::Recent, "Last 20 s")
            .on_hover_text("Follow the run");
        ui.selectable_value(self, Self::All, "All")
            .on_hover_text("From the start on");
        if matches!(self, Self::Chosen(..)) {
            ui.weak("double click to follow");
        }
    }

    /// The part of the run in view [s]: where it follows the run, the moment `shown` is in it.
    pub fn window(self, time: &[f64], shown: Option<f64>) -> RangeInclusive<f64> {
        let start = time.first().copied().unwrap_or(0.0);
        let end = time.last().copied().unwrap_or(0.0);
        let in_view = |shown: f64| end.min(shown + 0.5 * RECENT);
        let recent = shown.map_or(end, in_view);
        match self {
            Self::Recent => (recent - RECENT).max(start)..=recent.max(start + RECENT),
            Self::All => start..=end.max(start + 1.0),
            Self::Chosen(from, to) => from..=to,
        }
    }

    /// Lets the pointer move what is in view: drag to shift, Ctrl and scroll or pinch to zoom, double click to follow
    /// the run again.
    pub fn follow_pointer(&mut self, response: &egui::Response, window: &RangeInclusive<f64>) {
        let (from, to) = (*window.start(), *window.end());
        let per_point = (to - from) / f64::from(response.rect.width().max(1.0));
        if response.double_clicked() {
            *self = Self::Recent;
        } else if response.dragged() && response.drag_delta().x != 0.0 {
            let shift = -f64::from(response.drag_delta().x) * per_point;
            *self = Self::Chosen(from + shift, to + shift);
        }
        let zoom = f64::from(response.ctx.input(egui::InputState::zoom_delta));
        if let Some(pointer) = response.hover_pos().filter(|_| zoom != 1.0) {
            let at = from + f64::from(pointer.x - response.rect.left()) * per_point;
            let zoom = zoom.min((to - from) / SHORTEST);
            *self = Self::Chosen(at - (at - from) / zoom, at + (to - at) / zoom);
        }
    }
}

/// The time that was clicked on [s].
pub(super) fn clicked_time(response: &egui::Response, window: &RangeInclusive<f64>) -> Option<f64> {
    let pointer = response
        .interact_pointer_pos()
        .filter(|_| response.clicked())?;
    let from_left = f64::from(pointer.x - response.rect.left());
    Some(window.start() + from_left * per_point(response, window))
}

/// Time that a point of the width of a plot stands for [s].
fn per_point(response: &egui::Response, window: &RangeInclusive<f64>) -> f64 {
    (window.end() - window.start()) / f64::from(response.rect.width().max(1.0))
}

/// The start of the avalanche within [`NEAR`] points of `time` [s], where a point stands for `per_point` [s]; else that
/// time.
pub(super) fn near_start(avalanches: &[Avalanche], time: f64, per_point: f64) -> f64 {
    let reach = NEAR * per_point;
    let starts = avalanches.iter().map(|avalanche| avalanche.start);
    let near = starts.filter(|start| (start - time).abs() < reach);
    let nearest = near.min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()));
    nearest.unwrap_or(time)
}

fn angle_curve(
    curves: &Curves,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
) -> Curve {
    let value = |series: &Series, i: usize| series.column(Measure::SurfaceAngle)[i] * DEGREES;
    let lines = curves.lines(window, columns, value);
    Curve {
        id: "angle",
        title: "Surface angle θ [°]",
        present: curves.present(value, |angle| number::fixed(angle, 2)),
        colour: palette.angle,
        height: height_of(lines.points(), SMALLEST_ANGLE_SPAN),
        lines,
        decades: false,
        unit: "°",
    }
}

fn temperature_curve(
    curves: &Curves,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
    decades: bool,
) -> Curve {
    let threshold = on_axis(NON_RIGID_TEMPERATURE, decades);
    let value = |series: &Series, i: usize| series.column(Measure::GranularTemperature)[i];
    let lines = curves.lines(window, columns, |series, i| {
        on_axis(value(series, i), decades)
    });
    // The threshold is always in view, and zero where it has a place.
    let always = [
        [0.0, threshold],
        [0.0, if decades { threshold } else { 0.0 }],
    ];
    let all = lines.points().chain(&always);
    Curve {
        id: "temperature",
        title: "Granular temperature Tg [m²/s²]",
        present: curves.present(value, number::short),
        colour: palette.temperature,
        height: height_of(all, if decades { SMALLEST_DECADES } else { 0.0 }),
        lines,
        decades,
        unit: "m²/s²",
    }
}

/// Which line is which of the two runs, where there are two.
pub(super) fn halves_ui(ui: &mut egui::Ui, simulation: &Simulation) {
    if simulation.twin().is_none() {
        return;
    }
    let palette = Palette::of(ui.visuals());
    let lines = [
        (Half::Left, ui.visuals().text_color(), None),
        (Half::Right, palette.twin, Some(TWIN_DASH)),
    ];
    for (half, colour, dash) in lines {
        ui.horizontal(|ui| {
            sample_ui(ui, dash, Stroke::new(1.8, colour));
            let title = number::capitalised(&half_title(simulation, half));
            ui.label(format!("{}: {title}", number::capitalised(half.label())));
        });
    }
}

/// A piece of a line on the plots, with dashes of this length.
pub(super) fn sample_ui(ui: &mut egui::Ui, dash: Option<f32>, stroke: Stroke) {
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

/// Where a temperature [m²/s²] stands on its axis.
fn on_axis(temperature: f64, decades: bool) -> f64 {
    if decades {
        // Zero has no logarithm and is passed over.
        if temperature > 0.0 {
            temperature.max(COLDEST).log10()
        } else {
            f64::NAN
        }
    } else {
        temperature
    }
}

/// Height of a plot of nothing but zeros, in its unit: less than any measure, and enough to be divided by marks.
const LEAST_SPAN: f64 = 1e-30;

/// The range that shows all `points` with a little room, at least `smallest` high.
pub(super) fn height_of<'a>(
    points: impl Iterator<Item = &'a [f64; 2]>,
    smallest: f64,
) -> RangeInclusive<f64> {
    let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
        (low.min(point[1]), high.max(point[1]))
    });
    if low > high {
        return 0.0..=smallest.max(1.0);
    }
    let span = (high - low).max(smallest).max(LEAST_SPAN);
    let middle = 0.5 * (low + high);
    middle - (0.5 + BELOW) * span..=middle + (0.5 + ABOVE) * span
}

/// Draws one plot with `marks` over its line; what the pointer does on it is in the answer.
pub(super) fn curve_ui<'a>(
    ui: &mut egui::Ui,
    curve: Curve,
    window: &RangeInclusive<f64>,
    height: f32,
    marks: impl FnOnce(&mut PlotUi<'a>) + 'a,
) -> egui::Response {
    let palette = Palette::of(ui.visuals());
    let Lines { own, twin, kept } = curve.lines;
    head_ui(
        ui,
        curve.title,
        &curve.present,
        [curve.colour, palette.twin],
    );
    let bounds = PlotBounds::from_min_max(
        [*window.start(), *curve.height.start()],
        [*window.end(), *curve.height.end()],
    );
    let name = if twin.is_some() { "left" } else { curve.title };
    let line = Line::new(name, own).color(curve.colour).width(1.7);
    let twin = twin.map(|points| twin_line("right", points, palette));
    let (decades, unit) = (curve.decades, curve.unit);
    let plot = Plot::new(curve.id)
        .height(height)
        .width(ui.available_width() - ROOM_AT_THE_RIGHT)
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
        .label_formatter(move |hover| Some(hover_label(hover, decades, unit)));
    let shown = plot.show(ui, move |plot| {
        plot.set_plot_bounds(bounds);
        for (index, (name, points)) in kept.into_iter().enumerate() {
            kept_ui(plot, index, &name, points, palette.kept);
        }
        plot.line(line);
        if let Some(line) = twin {
            plot.line(line);
        }
        marks(plot);
    });
    shown.response
}

/// The title of a plot and the value of each run at the moment shown: in one line where there is room for all of it.
fn head_ui(ui: &mut egui::Ui, title: &str, values: &[String], colours: [Color32; 2]) {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let words = ui
        .painter()
        .layout_no_wrap(title.to_owned(), font, Color32::WHITE);
    let needed = words.size().x + ROOM_FOR_VALUE * values.len() as f32;
    let title_ui = |ui: &mut egui::Ui| ui.label(RichText::new(title).strong());
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

/// The line of the run beside the first.
pub(super) fn twin_line<'a>(name: &str, points: Vec<[f64; 2]>, palette: Palette) -> Line<'a> {
    let style = LineStyle::Dashed { length: TWIN_DASH };
    Line::new(name, points)
        .color(palette.twin)
        .width(2.0)
        .style(style)
}

/// A kept run as a dashed line with its name at the end.
fn kept_ui(plot: &mut PlotUi, index: usize, name: &str, points: Vec<[f64; 2]>, colour: Color32) {
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
    let label = RichText::new(name).small().color(colour);
    let end = time.min(plot.plot_bounds().max()[0]);
    plot.text(Text::new(name, PlotPoint::new(end, value), label).anchor(Align2::RIGHT_BOTTOM));
}

/// A plot whose curves decide what of them is in view: a quarter of the window high, with a few round marks.
pub(super) fn fitting_plot<'a>(ui: &egui::Ui, id: &str) -> Plot<'a> {
    Plot::new(id)
        .height((0.25 * ui.ctx().content_rect().height()).clamp(130.0, 330.0))
        .show_crosshair(false)
        .allow_scroll(false)
        .grid_color(Palette::of(ui.visuals()).grid)
        .x_grid_spacer(|input| round_marks(input, 10.0, 0.0))
        .y_grid_spacer(|input| round_marks(input, SPARSE_Y, 0.0))
        .x_axis_formatter(|mark, _| tick(mark.value, false))
        .y_axis_formatter(|mark, _| tick(mark.value, false))
}

/// Grid lines at round numbers at least `finest` apart, `sparse` times as far apart as the plot would have them at the
/// closest.
pub(super) fn round_marks(input: GridInput, sparse: f32, finest: f64) -> Vec<GridMark> {
    let step = round_step((input.base_step_size * f64::from(sparse)).max(finest));
    let (first, last) = (
        (input.bounds.0 / step).ceil(),
        (input.bounds.1 / step).floor(),
    );
    (first as i64..=last as i64)
        .map(|index| GridMark {
            value: index as f64 * step,
            step_size: step,
        })
        .collect()
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `least`.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let fits = |factor: &f64| factor * power >= least * (1.0 - 1e-9);
    [1.0, 2.0, 5.0, 10.0].into_iter().find(fits).unwrap_or(10.0) * power
}

pub(super) fn tick(value: f64, decades: bool) -> String {
    if decades {
        number::power_of_ten(value.round() as i32)
    } else if value != 0.0 && value.abs() < 1e-3 {
        number::short(value)
    } else {
        tidy(value)
    }
}

/// `value` without digits that say nothing.
fn tidy(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", rounded + 0.0).replacen('-', "−", 1)
}

fn hover_label(hover: &HoverPosition, decades: bool, unit: &str) -> String {
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
    let place = format!("{:.2} s\n{} {unit}", position.x, number::short(value));
    if name.is_empty() {
        place
    } else {
        format!("{name}\n{place}")
    }
}

impl<'a> Marks<'a> {
    /// The marks of `curves` in `window`: its avalanches, and its changes, of which one is drawn per column of pixels.
    fn within(
        curves: &Curves<'a>,
        window: &RangeInclusive<f64>,
        columns: usize,
        palette: Palette,
    ) -> Self {
        let first =
            (curves.avalanches).partition_point(|avalanche| avalanche.end < *window.start());
        let end = (curves.avalanches).partition_point(|avalanche| avalanche.start <= *window.end());
        let apart = (window.end() - window.start()) / columns.max(1) as f64;
        let mut changes: Vec<f64> = (curves.changes.iter().copied())
            .filter(|time| window.contains(time))
            .collect();
        changes.dedup_by(|later, earlier| *later - *earlier < apart);
        Self {
            palette,
            avalanches: &curves.avalanches[first.min(end)..end],
            changes,
            shown: curves.shown,
            between_labels: BETWEEN_LABELS * apart,
        }
    }

    fn angle_ui(&self, plot: &mut PlotUi) {
        self.moments_ui(plot);
        let points = |ends: fn(&Avalanche) -> [f64; 2]| -> Vec<[f64; 2]> {
            self.avalanches.iter().map(ends).collect()
        };
        let starts = points(|avalanche| [avalanche.start, avalanche.theta_m * DEGREES]);
        let ends = points(|avalanche| [avalanche.end, avalanche.theta_r * DEGREES]);
        plot.points(
            Points::new("avalanche starts", starts)
                .shape(MarkerShape::Up)
                .radius(4.5)
                .color(self.palette.maximum),
        );
        plot.points(
            Points::new("avalanche ends", ends)
                .shape(MarkerShape::Down)
                .radius(4.5)
                .color(self.palette.minimum),
        );
        let lift = LABEL_LIFT * plot.plot_bounds().height();
        let mut free_from = f64::NEG_INFINITY;
        for avalanche in self.avalanches {
            if avalanche.start >= free_from {
                plot.text(self.drop_label(avalanche, lift));
                free_from = avalanche.start + self.between_labels;
            }
        }
    }

    fn drop_label(&self, avalanche: &Avalanche, lift: f64) -> Text {
        let at = PlotPoint::new(avalanche.start, avalanche.theta_m * DEGREES + lift);
        let drop = RichText::new(format!("{:.1}°", avalanche.drop() * DEGREES)).small();
        Text::new("Δθ", at, drop.color(self.palette.maximum)).anchor(Align2::CENTER_BOTTOM)
    }

    fn temperature_ui(&self, plot: &mut PlotUi, decades: bool) {
        self.moments_ui(plot);
        plot.hline(
            HLine::new("flowing above", on_axis(NON_RIGID_TEMPERATURE, decades))
                .stroke(Stroke::new(1.2, self.palette.threshold))
                .style(LineStyle::dashed_dense()),
        );
    }

    /// When something was changed, and the moment shown.
    fn moments_ui(&self, plot: &mut PlotUi) {
        if let Some(time) = self.shown {
            shown_ui(plot, time, self.palette);
        }
        for time in &self.changes {
            plot.vline(
                VLine::new("parameter changed", *time)
                    .stroke(Stroke::new(1.0, self.palette.change))
                    .allow_hover(false),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recent_window_follows_the_run_and_starts_with_full_length() {
        assert_eq!(Span::Recent.window(&[0.0, 3.0], None), 0.0..=20.0);
        assert_eq!(Span::Recent.window(&[0.0, 50.0], None), 30.0..=50.0);
        assert_eq!(Span::Recent.window(&[0.0, 50.0], Some(25.0)), 15.0..=35.0);
    }

    #[test]
    fn a_curve_of_zeros_has_a_few_marks() {
        // Grains that have not moved yet: no energy at all.
        let height = height_of([[0.0, 0.0], [1.0, 0.0]].iter(), 0.0);
        let bounds = (*height.start(), *height.end());
        let input = GridInput {
            bounds,
            base_step_size: (bounds.1 - bounds.0) / 50.0,
        };
        let marks = round_marks(input, 1.0, 0.0);
        assert!((10..=60).contains(&marks.len()), "{}", marks.len());
        assert!(marks.iter().any(|mark| mark.value == 0.0));
    }

    #[test]
    fn changes_of_one_drag_share_a_line() {
        let changes = [1.0, 1.001, 1.002, 5.0];
        let series = Series::default();
        let curves = Curves {
            series: &series,
            twin: None,
            avalanches: &[],
            changes: &changes,
            kept: &[],
            shown: None,
        };
        let palette = Palette::of(&egui::Visuals::dark());
        let marks = Marks::within(&curves, &(0.0..=20.0), 400, palette);
        assert_eq!(marks.changes, [1.0, 5.0]);
    }
}
