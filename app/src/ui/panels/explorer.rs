//! Any measured quantity over time or over another, of this run and of those kept beside it, to
//! look at and to take home.
//!
//! In: the samples. Out: a plot with the numbers under the pointer, the moment that is clicked on,
//! and the plot as a request to export it.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, energy_comes_first};
use crate::ui::playback::{moment_shown, seek};
use crate::ui::plot_export::{AxisScale, Export, ExportedRun, PlotAxis};
use crate::ui::plots::axes::{fitting_plot, height_of};
use crate::ui::plots::decimate::decimate;
use crate::ui::plots::run_curves::{compared_line, halves_ui};
use crate::ui::plots::time_plot::moment_ui;
use crate::ui::plots::time_window::near_start;
use crate::ui::request::Request;
use crate::ui::theme::{Palette, dash};
use crate::ui::widgets::combo::combo_ui;
use crate::ui::words::number;
use crate::ui::words::run_names::RunNames;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, Stroke, WidgetInfo, WidgetType};
use egui_plot::{HoverPosition, Line, LineStyle, Plot, PlotItem, VLine};
use grainfall::lab::Half;
use grainfall::measure::{Avalanche, Measure, Series};
use grainfall::run::{Provenance, SAMPLE_INTERVAL};

/// Most points of a curve over another quantity than time.
const MOST_POINTS: usize = 4000;

/// The panel.
#[derive(Debug, PartialEq)]
pub struct Explorer {
    /// Upright.
    quantity: Measure,
    /// Across; none for time.
    over: Option<Measure>,
}

impl Default for Explorer {
    fn default() -> Self {
        Self {
            quantity: Measure::KineticEnergy,
            over: None,
        }
    }
}

impl Explorer {
    /// What stands over it.
    pub const TITLE: &'static str = "Any quantity";
}

impl Panel for Explorer {
    fn title(&self) -> &'static str {
        Self::TITLE
    }

    fn choices(&self) -> String {
        let over = self.over.map_or("", |measure| measure.quantity().key);
        format!("{}, {over}", self.quantity.quantity().key)
    }

    fn take_choices(&mut self, choices: &str) {
        let measure = |key: &str| {
            let mut all = Measure::ALL.into_iter();
            all.find(|measure| measure.quantity().key == key)
        };
        if let Some((quantity, over)) = choices.split_once(", ") {
            self.quantity = measure(quantity).unwrap_or(self.quantity);
            self.over = measure(over);
        }
    }

    fn comes_first(&self, simulation: &Simulation) -> bool {
        energy_comes_first(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let Some(world) = simulation.world() else {
            ui.weak("There is nothing measured yet.");
            return;
        };
        let measures = Measure::of(world);
        measure_ui(ui, "Plot", &mut self.quantity, &measures);
        over_ui(ui, &mut self.over, &measures);
        halves_ui(ui, simulation);
        self.plot_ui(ui, simulation, out);
        let export = ui.button("Export…").on_hover_text(
            "As an SVG or PNG picture, or all samples as CSV: the ending of the file's name decides",
        );
        if export.clicked() {
            let export = self.export(simulation);
            out.push(Request::ExportPlot(Box::new(export)));
        }
    }
}

fn measure_ui(ui: &mut egui::Ui, label: &str, value: &mut Measure, measures: &[Measure]) {
    combo_ui(ui, label, &number::title(*value), |ui| {
        for measure in measures {
            ui.selectable_value(value, *measure, number::title(*measure));
        }
    });
}

fn over_ui(ui: &mut egui::Ui, over: &mut Option<Measure>, measures: &[Measure]) {
    let name = over.map_or_else(|| "Time t".to_owned(), number::title);
    combo_ui(ui, "Over", &name, |ui| {
        ui.selectable_value(over, None, "Time t");
        for measure in measures {
            ui.selectable_value(over, Some(*measure), number::title(*measure));
        }
    });
}

impl Explorer {
    fn axes(&self) -> (PlotAxis, PlotAxis) {
        (PlotAxis(self.over), PlotAxis(Some(self.quantity)))
    }

    /// How the values of all runs are shown, across and upright.
    fn scales(&self, simulation: &Simulation) -> [AxisScale; 2] {
        let compared = simulation.comparison();
        let compared = compared.map(|comparison| comparison.right.series());
        let kept = &simulation.past().kept;
        let series = || {
            let kept = kept.iter().map(|record| &*record.series);
            kept.chain([simulation.series()]).chain(compared)
        };
        let (x, y) = self.axes();
        [x, y].map(|axis| axis.scale(series().flat_map(|series| axis.values(series))))
    }

    /// The curve of `series` in the units of the axes, with no more points than a plot shows.
    fn points(&self, series: &Series, columns: usize, scales: &[AxisScale; 2]) -> Vec<[f64; 2]> {
        let (x, y) = self.axes();
        let [fx, fy] = [scales[0].factor, scales[1].factor];
        let (xs, ys) = (x.values(series), y.values(series));
        if self.over.is_none() {
            let end = series.time().last().copied().unwrap_or(0.0);
            return decimate(series.time(), &(0.0..=end), 4 * columns, |i| ys[i] * fy);
        }
        let stride = series.len().div_ceil(MOST_POINTS).max(1);
        let samples = (0..series.len()).step_by(stride);
        let points = samples.map(|i| [xs[i] * fx, ys[i] * fy]);
        points
            .filter(|[x, y]| x.is_finite() && y.is_finite())
            .collect()
    }

    /// The lines of all runs, in the order in which they are drawn.
    fn lines(
        &self,
        simulation: &Simulation,
        columns: usize,
        scales: &[AxisScale; 2],
        palette: Palette,
    ) -> Vec<Line<'_>> {
        let names = RunNames::of(simulation);
        let own = Line::new(
            names.present(Half::Left),
            self.points(simulation.series(), columns, scales),
        );
        let compared = simulation.comparison().map(|comparison| {
            let points = self.points(comparison.right.series(), columns, scales);
            compared_line(names.present(Half::Right), points, palette)
        });
        let kept = names.kept.into_iter().enumerate();
        let kept = kept.map(|(index, (name, record))| {
            let length = dash(index);
            Line::new(name, self.points(&record.series, columns, scales))
                .color(palette.kept)
                .style(LineStyle::Dashed { length })
        });
        kept.chain([own.color(palette.angle).width(1.7)])
            .chain(compared)
            .collect()
    }

    /// Draws the plot.
    fn plot_ui(&self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let palette = Palette::of(ui.visuals());
        let columns = (ui.available_width() * ui.ctx().pixels_per_point()) as usize;
        let scales = self.scales(simulation);
        let lines = self.lines(simulation, columns, &scales, palette);
        let [x, y] = scales;
        let over_time = self.over.is_none();
        let avalanches = if over_time {
            simulation.avalanches()
        } else {
            &[]
        };
        let shown = moment_shown(simulation).filter(|_| over_time);
        let units = [x.unit, y.unit];
        // Another pair of quantities begins with bounds of its own.
        let name = format!("{} over {}", y.label, x.label);
        ui.label(RichText::new(&name).strong());
        let plot = fitting_plot(ui, &name);
        let plot = within(plot, &points_of(&lines), over_time)
            .show_crosshair(true)
            .label_formatter(move |hover| Some(cursor(hover, &units)));
        let drawn = plot.show(ui, |plot| {
            for avalanche in avalanches {
                plot.vline(avalanche_line(avalanche, palette));
            }
            for line in lines {
                plot.line(line);
            }
            if let Some(time) = shown {
                moment_ui(plot, time, palette);
            }
        });
        let response = drawn.response;
        let latest = simulation.series().column(self.quantity).last().copied();
        let latest = latest.unwrap_or(f64::NAN) * y.factor;
        response.widget_info(|| {
            let text = format!("{name}, now {}", number::short(latest));
            WidgetInfo::labeled(WidgetType::Image, true, text)
        });
        let pointer = response.interact_pointer_pos();
        if let Some(pointer) = pointer.filter(|_| over_time && response.clicked()) {
            let time = drawn.transform.value_from_position(pointer).x;
            let per_point = 1.0 / drawn.transform.dpos_dvalue_x().abs();
            out.extend(seek(simulation, near_start(avalanches, time, per_point)));
        }
    }

    fn export(&self, simulation: &Simulation) -> Export {
        let (x, y) = self.axes();
        let run = |name: String, series: &Series| ExportedRun {
            name,
            time: series.time().to_vec(),
            points: (x.values(series).iter().zip(y.values(series)))
                .map(|(x, y)| [*x, *y])
                .collect(),
        };
        let names = RunNames::of(simulation);
        let own = |half| {
            run(
                names.present(half).to_owned(),
                simulation.half(half).series(),
            )
        };
        let mut runs = match simulation.comparison() {
            None => vec![own(Half::Left)],
            Some(_) => Half::ALL.map(own).into(),
        };
        let kept = names.kept.into_iter();
        runs.extend(kept.map(|(name, record)| run(name, &record.series)));
        let from = simulation
            .provenance()
            .unwrap_or_else(|| Provenance::of_scene(simulation.scene()));
        Export { x, y, runs, from }
    }
}

/// The points of all lines.
fn points_of(lines: &[Line<'_>]) -> Vec<[f64; 2]> {
    let points = lines.iter().flat_map(|line| match line.geometry() {
        egui_plot::PlotGeometry::Points(points) => points,
        _ => &[],
    });
    points.map(|point| [point.x, point.y]).collect()
}

/// `plot` with all `points` in view, a constant too; time begins at zero.
fn within<'a>(plot: Plot<'a>, points: &[[f64; 2]], over_time: bool) -> Plot<'a> {
    let height = height_of(points.iter(), 0.0);
    let turned: Vec<[f64; 2]> = points.iter().map(|[x, y]| [*y, *x]).collect();
    let width = height_of(turned.iter(), 0.0);
    let (from, to) = if over_time {
        let end = points.iter().map(|[time, _]| *time).fold(0.0, f64::max);
        (0.0, if end > 0.0 { end } else { SAMPLE_INTERVAL })
    } else {
        width.into_inner()
    };
    plot.set_margin_fraction(egui::Vec2::ZERO)
        .include_x(from)
        .include_x(to)
        .include_y(*height.start())
        .include_y(*height.end())
}

/// Where an avalanche starts.
fn avalanche_line(avalanche: &Avalanche, palette: Palette) -> VLine {
    VLine::new("avalanche", avalanche.start)
        .stroke(Stroke::new(1.0, palette.maximum))
        .style(LineStyle::dotted_dense())
        .allow_hover(false)
}

/// The numbers under the pointer.
fn cursor(hover: &HoverPosition, [x, y]: &[String; 2]) -> String {
    let (name, at) = match hover {
        HoverPosition::NearDataPoint {
            plot_name,
            position,
            ..
        } => (*plot_name, *position),
        HoverPosition::Elsewhere { position } => ("", *position),
    };
    let numbers = format!("{} {x}\n{} {y}", number::short(at.x), number::short(at.y));
    if name.is_empty() {
        numbers
    } else {
        format!("{name}\n{numbers}")
    }
}
