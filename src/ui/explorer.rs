//! Any measured quantity over time or over another, of this run and of those kept beside it, to look at and to take home.
//!
//! In: the samples. Out: a plot with the numbers under the pointer, the moment that is clicked on, and the plot as a file:
//! SVG, the same as PNG, or all samples as CSV.

use super::compare::half_title;
use super::decimate::decimate;
use super::plots::{fitting_plot, ghosts, halves_ui, near_start, seek, shown, shown_ui, twin_line};
use super::theme::{Palette, dash};
use super::{Panel, Request, has_bed, is_column, number};
use crate::files::write_whole;
use crate::measure::{Measure, Series};
use crate::simulation::{DisplayUnit, Half, Provenance, Simulation};
use crate::sweep::chart;
use crate::view::{ViewSettings, save_drawing};
use bevy_egui::egui::{self, RichText, Stroke, WidgetInfo, WidgetType};
use egui_plot::{HoverPosition, Line, LineStyle, VLine};
use std::ffi::OsStr;
use std::io;
use std::path::Path;

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

/// One of the two axes: what it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown(Option<Measure>);

impl Shown {
    /// All samples [SI unit].
    fn values(self, series: &Series) -> &[f64] {
        match self.0 {
            None => series.time(),
            Some(measure) => series.column(measure),
        }
    }

    fn unit(self) -> DisplayUnit {
        match self.0 {
            None => number::display_unit("s"),
            Some(measure) => number::display_unit(measure.quantity().unit),
        }
    }

    /// Name and unit: `Surface angle θ [°]`.
    fn label(self) -> String {
        let name = self.0.map_or_else(|| "Time t".to_owned(), number::title);
        match self.unit().name {
            "" => name,
            unit => format!("{name} [{unit}]"),
        }
    }

    /// Name and SI unit, as in the files of a run.
    fn column(self) -> String {
        match self.0.map(Measure::quantity) {
            None => "time [s]".to_owned(),
            Some(quantity) => format!("{} [{}]", quantity.name, quantity.unit),
        }
    }
}

/// A plot that is to become a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    x: Shown,
    y: Shown,
    runs: Vec<Run>,
    /// Where it came from.
    from: Provenance,
}

/// All samples of a run [SI units].
#[derive(Clone, Debug, PartialEq)]
struct Run {
    name: String,
    time: Vec<f64>,
    points: Vec<[f64; 2]>,
}

impl Panel for Explorer {
    fn title(&self) -> &'static str {
        "Any quantity"
    }

    fn comes_first(&self, simulation: &Simulation) -> bool {
        !has_bed(simulation) && !is_column(simulation)
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

fn combo_ui(ui: &mut egui::Ui, label: &str, chosen: &str, choices: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        ui.label(label);
        let response = egui::ComboBox::from_id_salt(label)
            .selected_text(chosen)
            .width(ui.available_width() - 8.0)
            .height(360.0)
            .show_ui(ui, choices)
            .response;
        response.widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, label));
    });
}

impl Explorer {
    fn axes(&self) -> (Shown, Shown) {
        (Shown(self.over), Shown(Some(self.quantity)))
    }

    /// The curve of `series` in the units of the axes, with no more points than a plot shows.
    fn points(&self, series: &Series, columns: usize) -> Vec<[f64; 2]> {
        let (x, y) = self.axes();
        let (fx, fy) = (x.unit().factor, y.unit().factor);
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

    /// Draws the plot.
    fn plot_ui(&self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let palette = Palette::of(ui.visuals());
        let columns = (ui.available_width() * ui.ctx().pixels_per_point()) as usize;
        let (x, y) = self.axes();
        let own = self.points(simulation.series(), columns);
        let twin = simulation.twin().map(|twin| {
            let points = self.points(twin.run().series(), columns);
            twin_line("right", points, palette)
        });
        let kept = ghosts(simulation).into_iter();
        let kept: Vec<_> = kept
            .map(|(name, record)| (name, self.points(&record.series, columns)))
            .collect();
        let over_time = self.over.is_none();
        let avalanches = if over_time {
            simulation.avalanches()
        } else {
            &[]
        };
        let shown = shown(simulation).filter(|_| over_time);
        let units = [x.unit().name, y.unit().name];
        // Another pair of quantities begins with bounds of its own.
        let name = format!("{} over {}", y.label(), x.label());
        ui.label(RichText::new(&name).strong());
        let plot = fitting_plot(ui, &name)
            .show_crosshair(true)
            .label_formatter(move |hover| Some(cursor(hover, units)));
        let drawn = plot.show(ui, |plot| {
            for avalanche in avalanches {
                plot.vline(
                    VLine::new("avalanche", avalanche.start)
                        .stroke(Stroke::new(1.0, palette.maximum))
                        .style(LineStyle::dotted_dense())
                        .allow_hover(false),
                );
            }
            for (index, (name, points)) in kept.into_iter().enumerate() {
                let style = LineStyle::Dashed {
                    length: dash(index),
                };
                plot.line(Line::new(name, points).color(palette.kept).style(style));
            }
            let name = if twin.is_some() { "left" } else { "this run" };
            plot.line(Line::new(name, own).color(palette.angle).width(1.7));
            if let Some(line) = twin {
                plot.line(line);
            }
            if let Some(time) = shown {
                shown_ui(plot, time, palette);
            }
        });
        let response = drawn.response;
        let latest = (y.values(simulation.series()).last())
            .copied()
            .unwrap_or(f64::NAN);
        response.widget_info(|| {
            let value = number::short(latest * y.unit().factor);
            let text = format!("{name}, now {value}");
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
        let run = |name: String, series: &Series| Run {
            name,
            time: series.time().to_vec(),
            points: (x.values(series).iter().zip(y.values(series)))
                .map(|(x, y)| [*x, *y])
                .collect(),
        };
        let mut runs = match simulation.twin() {
            None => vec![run("this run".to_owned(), simulation.series())],
            Some(_) => Half::ALL
                .map(|half| {
                    let name = format!("{}: {}", half.label(), half_title(simulation, half));
                    run(name, simulation.half(half).series())
                })
                .into(),
        };
        let kept = ghosts(simulation).into_iter();
        runs.extend(kept.map(|(name, record)| run(name.to_lowercase(), &record.series)));
        let from = simulation
            .provenance()
            .unwrap_or_else(|| Provenance::of_scene(simulation.scene()));
        Export { x, y, runs, from }
    }
}

/// The numbers under the pointer.
fn cursor(hover: &HoverPosition, [x, y]: [&str; 2]) -> String {
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

impl Export {
    /// Writes it as SVG, PNG or CSV, as the ending of `path` says; a table's origin stands in a file beside it.
    ///
    /// # Errors
    /// Where it cannot be drawn or written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        match path.extension().and_then(OsStr::to_str) {
            Some("csv") => self.write_table(path),
            Some("png") => save_drawing(&self.svg()?, &self.from, path),
            _ => {
                let svg = self.from.in_svg(&self.svg()?);
                write_whole(path, |file| file.write_all(svg.as_bytes()))
            }
        }
    }

    fn write_table(&self, path: &Path) -> io::Result<()> {
        let text = self.csv()?;
        write_whole(path, |file| file.write_all(text.as_bytes()))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let beside = path.with_file_name(format!("{name}-metadata.json"));
        write_whole(&beside, |file| self.from.write_tables(&[&name], file))
    }

    fn svg(&self) -> io::Result<String> {
        let (fx, fy) = (self.x.unit().factor, self.y.unit().factor);
        let line = |run: &Run| {
            let points = run.points.iter().map(|[x, y]| (x * fx, y * fy));
            let finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
            chart::Line {
                name: run.name.clone(),
                points: points.filter(finite).collect(),
                is_law: false,
            }
        };
        let plot = chart::Plot {
            file: String::new(),
            title: format!("{} over {}", self.y.label(), self.x.label()),
            x: chart::Axis::linear(&self.x.label()),
            y: chart::Axis::linear(&self.y.label()),
            lines: self.runs.iter().map(line).collect(),
        };
        if !plot.has_points() {
            return Err(io::Error::other("there is nothing to draw yet"));
        }
        plot.draw()
            .map_err(|reason| io::Error::other(reason.to_string()))
    }

    fn csv(&self) -> io::Result<String> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let mut header = vec!["run".to_owned(), "time [s]".to_owned()];
        header.extend([self.x, self.y].map(Shown::column));
        if self.x.0.is_none() {
            header.remove(2);
        }
        table.write_record(&header)?;
        for run in &self.runs {
            for (time, [x, y]) in run.time.iter().zip(&run.points) {
                let mut row = vec![run.name.clone(), time.to_string()];
                if self.x.0.is_some() {
                    row.push(x.to_string());
                }
                row.push(y.to_string());
                table.write_record(&row)?;
            }
        }
        let bytes = table
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)?;
        String::from_utf8(bytes).map_err(io::Error::other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn export(over: Option<Measure>) -> Export {
        Export {
            x: Shown(over),
            y: Shown(Some(Measure::SurfaceAngle)),
            runs: vec![Run {
                name: "this run".to_owned(),
                time: vec![0.0, 0.5],
                points: vec![[0.0, 0.25], [0.5, f64::NAN]],
            }],
            from: Provenance::of_scene(&crate::scene::Scene::open("small-drum").unwrap()),
        }
    }

    #[test]
    fn table_holds_every_sample_in_si_units() {
        let text = export(None).csv().unwrap();
        let expected = "run,time [s],surface angle [rad]\nthis run,0,0.25\nthis run,0.5,NaN\n";
        assert_eq!(text, expected);
        let over = export(Some(Measure::MeanSpeed)).csv().unwrap();
        assert!(over.starts_with("run,time [s],mean speed [m/s],surface angle [rad]\n"));
        assert!(over.contains("this run,0.5,0.5,NaN"));
    }

    #[test]
    fn drawing_shows_units_of_the_panel_and_leaves_out_what_is_no_number() {
        let svg = export(None).svg().unwrap();
        assert!(svg.contains("Surface angle θ [°]") && svg.contains("Time t [s]"));
        assert!(!svg.contains("NaN"));
        let mut empty = export(None);
        empty.runs[0].points.clear();
        assert!(empty.svg().is_err());
    }

    #[test]
    fn picture_is_the_drawing_in_large_with_its_text_and_its_origin() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plot.png");
        let mut export = export(None);
        export.runs[0].points = vec![[0.0, 0.25], [0.5, 0.5]];
        export.write(&path).unwrap();
        let picture = image::open(&path).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (3 * 760, 3 * 520));
        let dark = |rows: std::ops::Range<u32>| {
            let inked = |(_, y, pixel): &(u32, u32, &image::Rgb<u8>)| {
                rows.contains(y) && pixel.0.iter().all(|&part| part < 128)
            };
            picture.enumerate_pixels().filter(inked).count()
        };
        assert_eq!(dark(0..30), 0, "a margin");
        assert!(dark(30..110) > 1000, "the title: {}", dark(30..110));
        let first = colorous::TABLEAU10[0];
        let curve = image::Rgb([first.r, first.g, first.b]);
        assert!(picture.pixels().filter(|&pixel| *pixel == curve).count() > 2000);
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let reader = png::Decoder::new(file).read_info().unwrap();
        let texts = &reader.info().utf8_text;
        assert!(texts.iter().any(|text| text.keyword == "Software"));
    }
}
