//! Surface angle θ(t) and granular temperature Tg(t) over the same time, with avalanches and
//! changes marked.
//!
//! In: columns of samples, of the present run and of those kept beside it. Out: two plots that cost
//! the same however long the run is, and the moment that a person clicks on. Which part of the run
//! is in view is kept here, not in the plots, so both always show the same time and fit their
//! height to what they show.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, has_bed};
use crate::ui::playback::{Way, seek, to_avalanche};
use crate::ui::plots::axes::height_of;
use crate::ui::plots::labels::{LabelSide, PlotLabel};
use crate::ui::plots::run_curves::{Curves, change_times, halves_ui};
use crate::ui::plots::time_plot::{TimePlot, moment_ui, size_of_plots};
use crate::ui::plots::time_window::{TimeWindow, clicked_time, near_start, per_point};
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use crate::ui::words::run_names::RunNames;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, Stroke, WidgetInfo, WidgetType};
use egui_plot::{HLine, LineStyle, MarkerShape, PlotUi, Points, VLine};
use grainfall::measure::{Avalanche, Measure, NON_RIGID_TEMPERATURE, Series};
use std::ops::RangeInclusive;

/// Least distance between two labels of avalanches, in columns of pixels.
const BETWEEN_LABELS: f64 = 46.0;
/// Smallest height of the θ plot [°], so that noise at rest does not fill it.
const SMALLEST_ANGLE_SPAN: f64 = 2.0;
/// Smallest height of the Tg plot with a logarithmic axis, in powers of ten.
const SMALLEST_DECADES: f64 = 2.0;
/// Temperatures are drawn no lower than this [m²/s²]: below lies only rounding.
const COLDEST: f64 = 1e-13;
/// What the two granular temperatures are.
const FRAMES: &str = "The granular temperature in the frame that turns with the drum, where a bed at rest in the drum has \
                      none. The paper's Tg is that of the laboratory, where rigid rotation alone may come to the line \
                      above which a bed counts as flowing.";
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Both plots.
#[derive(Debug, PartialEq)]
pub struct AvalanchePlots {
    window: TimeWindow,
    logarithmic: bool,
    /// Whether Tg is that in the drum's frame instead of the paper's.
    corotating: bool,
}

/// What is marked in the part in view.
struct AvalancheMarks<'a> {
    palette: Palette,
    avalanches: &'a [Avalanche],
    changes: Vec<f64>,
    shown: Option<f64>,
    /// Time between two labels at least [s].
    between_labels: f64,
}

impl Default for AvalanchePlots {
    fn default() -> Self {
        Self {
            window: TimeWindow::Recent,
            logarithmic: true,
            corotating: false,
        }
    }
}

impl Panel for AvalanchePlots {
    fn title(&self) -> &'static str {
        "Plots"
    }

    fn choices(&self) -> String {
        let axis = if self.logarithmic { "log" } else { "even" };
        let frame = if self.corotating {
            "drum"
        } else {
            "laboratory"
        };
        format!("{axis} {frame}")
    }

    fn take_choices(&mut self, choices: &str) {
        if let Some((axis, frame)) = choices.split_once(' ') {
            (self.logarithmic, self.corotating) = (axis == "log", frame == "drum");
        }
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        has_bed(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let (changes, kept) = (change_times(simulation), RunNames::of(simulation).kept);
        let curves = Curves::of(simulation, &changes, &kept);
        halves_ui(ui, simulation);
        avalanches_ui(ui, simulation, out);
        let clicked = self.curves_ui(ui, &curves, view);
        out.extend(clicked.and_then(|time| seek(simulation, time)));
    }
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

impl AvalanchePlots {
    /// Draws `curves` and the choice of what part of them is in view; returns the time that was
    /// clicked on [s].
    pub fn curves_ui(
        &mut self,
        ui: &mut egui::Ui,
        curves: &Curves,
        view: &mut ViewSettings,
    ) -> Option<f64> {
        self.choice_ui(ui);
        let (height, columns) = size_of_plots(ui);
        let palette = Palette::of(ui.visuals());
        let window = self.window.window(curves.series.time(), curves.shown);
        let marks = AvalancheMarks::within(curves, &window, columns, palette);
        let mut angle = angle_curve(curves, &window, columns, palette);
        angle.labels = marks.drop_labels();
        let first = angle.ui(ui, &window, height, view, |plot| marks.angle_ui(plot));
        let temperature = self.temperature_curve(curves, &window, columns, palette);
        let decades = self.logarithmic;
        let second = temperature.ui(ui, &window, height, view, |plot| {
            marks.temperature_ui(plot, decades);
        });
        let mut clicked = None;
        for response in [first, second] {
            let per_point = per_point(&response, &window);
            let near = |time| near_start(curves.avalanches, time, per_point);
            clicked = clicked.or(clicked_time(&response, &window).map(near));
            self.window.follow_pointer(&response, &window);
        }
        clicked
    }

    fn temperature_curve(
        &self,
        curves: &Curves,
        window: &RangeInclusive<f64>,
        columns: usize,
        palette: Palette,
    ) -> TimePlot {
        let decades = self.logarithmic;
        let (measure, title) = if self.corotating {
            let title = "Granular temperature Tg′ in the drum's frame [m²/s²]";
            (Measure::CorotatingTemperature, title)
        } else {
            (
                Measure::GranularTemperature,
                "Granular temperature Tg [m²/s²]",
            )
        };
        let threshold = on_axis(NON_RIGID_TEMPERATURE, decades);
        let value = |series: &Series, i: usize| series.column(measure)[i];
        let lines = curves.lines(window, columns, |series, i| {
            on_axis(value(series, i), decades)
        });
        // The threshold is always in view, and zero where it has a place.
        let always = [
            [0.0, threshold],
            [0.0, if decades { threshold } else { 0.0 }],
        ];
        let all = lines.points().chain(&always);
        TimePlot {
            id: "temperature",
            title,
            present: curves.present(value, number::short),
            colour: palette.temperature,
            height: height_of(all, if decades { SMALLEST_DECADES } else { 0.0 }),
            lines,
            labels: Vec::new(),
            decades,
            unit: "m²/s²",
            measure,
        }
    }

    fn choice_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            self.window.choice_ui(ui);
            ui.checkbox(&mut self.corotating, "seen from the drum")
                .on_hover_text(FRAMES);
            ui.checkbox(&mut self.logarithmic, "log")
                .on_hover_text("Powers of ten for the granular temperature");
        });
    }
}

fn angle_curve(
    curves: &Curves,
    window: &RangeInclusive<f64>,
    columns: usize,
    palette: Palette,
) -> TimePlot {
    let value = |series: &Series, i: usize| series.column(Measure::SurfaceAngle)[i] * DEGREES;
    let lines = curves.lines(window, columns, value);
    TimePlot {
        id: "angle",
        title: "Surface angle θ [°]",
        present: curves.present(value, |angle| number::fixed(angle, 2)),
        colour: palette.angle,
        height: height_of(lines.points(), SMALLEST_ANGLE_SPAN),
        lines,
        labels: Vec::new(),
        decades: false,
        unit: "°",
        measure: Measure::SurfaceAngle,
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

impl<'a> AvalancheMarks<'a> {
    /// The marks of `curves` in `window`: its avalanches, and its changes, of which one is drawn
    /// per column of pixels.
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
    }

    /// How far the surface fell in each avalanche, the largest first.
    fn drop_labels(&self) -> Vec<PlotLabel> {
        let label = |avalanche: &Avalanche| PlotLabel {
            text: format!("{:.1}°", avalanche.drop() * DEGREES),
            at: [avalanche.start, avalanche.theta_m * DEGREES],
            colour: self.palette.maximum,
            side: LabelSide::Above,
        };
        let labelled = labelled(self.avalanches, self.between_labels).into_iter();
        labelled.map(label).collect()
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
            moment_ui(plot, time, self.palette);
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

/// The avalanches whose drop is written at their start: the largest first, each at least `apart`
/// [s] from the others.
fn labelled(avalanches: &[Avalanche], apart: f64) -> Vec<&Avalanche> {
    let mut by_drop: Vec<&Avalanche> = avalanches.iter().collect();
    by_drop.sort_by(|a, b| b.drop().total_cmp(&a.drop()));
    let mut chosen: Vec<&Avalanche> = Vec::new();
    for avalanche in by_drop {
        let is_free = |other: &&Avalanche| (other.start - avalanche.start).abs() >= apart;
        if chosen.iter().all(is_free) {
            chosen.push(avalanche);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_avalanche_has_its_label_and_no_two_overlap() {
        let fall = |start: f64, drop: f64| Avalanche {
            start,
            end: start + 0.2,
            theta_m: 0.6,
            theta_r: 0.6 - drop,
        };
        let avalanches = [
            fall(1.0, 0.08),
            fall(1.5, 0.52),
            fall(2.2, 0.09),
            fall(4.0, 0.07),
        ];
        let starts: Vec<f64> = labelled(&avalanches, 1.0)
            .into_iter()
            .map(|avalanche| avalanche.start)
            .collect();
        assert_eq!(starts, [1.5, 4.0]);
    }

    #[test]
    fn changes_of_one_drag_share_a_line() {
        let changes = [1.0, 1.001, 1.002, 5.0];
        let series = Series::default();
        let curves = Curves {
            series: &series,
            compared: None,
            avalanches: &[],
            changes: &changes,
            kept: &[],
            shown: None,
        };
        let palette = Palette::of(&egui::Visuals::dark());
        let marks = AvalancheMarks::within(&curves, &(0.0..=20.0), 400, palette);
        assert_eq!(marks.changes, [1.0, 5.0]);
    }
}
