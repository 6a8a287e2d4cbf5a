//! A plot on its way to a file: SVG, the same as PNG, or all samples as CSV.
//!
//! In: what two axes show, all samples of the runs. Out: the file, whole or not at all.

use crate::ui::words::number;
use crate::view::save_drawing;
use grainfall::files::write_whole;
use grainfall::measure::{Measure, Series};
use grainfall::physics::{DisplayUnit, units};
use grainfall::run::Provenance;
use grainfall::run::{Cells, Column, Table, write_metadata};
use grainfall::sweep::chart;
use std::ffi::OsStr;
use std::io;
use std::path::Path;

/// What one of the two axes shows: a measure, or time where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotAxis(pub Option<Measure>);

impl PlotAxis {
    /// All samples [SI unit].
    pub fn values(self, series: &Series) -> &[f64] {
        match self.0 {
            None => series.time(),
            Some(measure) => series.column(measure),
        }
    }

    /// How `values` [SI unit] are shown on it.
    pub fn scale<'a>(self, values: impl IntoIterator<Item = &'a f64>) -> AxisScale {
        let magnitudes = values.into_iter().map(|value| value.abs());
        let largest = magnitudes
            .filter(|value| value.is_finite())
            .fold(0.0, f64::max);
        let Some(measure) = self.0 else {
            let DisplayUnit { name, factor } = units::TIME.shown;
            return AxisScale::new("Time t", name.to_owned(), factor);
        };
        let (unit, factor) = measure.quantity().unit_up_to(largest);
        AxisScale::new(&number::title(measure), unit, factor)
    }

    /// Its column, as in the files of a run.
    fn column(self) -> Column {
        let time = || Column::numbers("time", "s");
        (self.0).map_or_else(time, |measure| Column::of(measure.quantity()))
    }
}

/// How the values on an axis are shown.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisScale {
    /// Name and unit: `Kinetic energy Ekin [µJ]`.
    pub label: String,
    /// The unit, with its prefix.
    pub unit: String,
    /// Shown value per SI value.
    pub factor: f64,
}

impl AxisScale {
    fn new(name: &str, unit: String, factor: f64) -> Self {
        let label = match unit.as_str() {
            "" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        };
        Self {
            label,
            unit,
            factor,
        }
    }
}

/// A plot that is to become a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    /// Across.
    pub x: PlotAxis,
    /// Upright.
    pub y: PlotAxis,
    /// What is drawn.
    pub runs: Vec<ExportedRun>,
    /// The run it was made of.
    pub from: Provenance,
}

/// All samples of a run [SI units].
#[derive(Clone, Debug, PartialEq)]
pub struct ExportedRun {
    /// What it is called in a legend and in a table.
    pub name: String,
    /// Times of its samples [s].
    pub time: Vec<f64>,
    /// What the two axes show at each.
    pub points: Vec<[f64; 2]>,
}

impl Export {
    /// Writes it as SVG, PNG or CSV, as the ending of `path` says; a table's origin stands in a
    /// file beside it.
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
        // A path without a file's name could not have been written to.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let beside = path.with_file_name(format!("{name}-metadata.json"));
        write_whole(&beside, |file| {
            write_metadata(&[self.table(&name)], &self.from, file)
        })
    }

    fn svg(&self) -> io::Result<String> {
        let [x, y] = [(self.x, 0), (self.y, 1)].map(|(axis, index)| {
            let points = self.runs.iter().flat_map(|run| &run.points);
            axis.scale(points.map(|point| &point[index]))
        });
        let (fx, fy) = (x.factor, y.factor);
        let line = |run: &ExportedRun| {
            let points = run.points.iter().map(|[x, y]| (x * fx, y * fy));
            let finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
            chart::Line {
                name: run.name.clone(),
                points: points.filter(finite).collect(),
                ..chart::Line::default()
            }
        };
        // A run that was left where it began has no curve, and the legend names curves.
        let is_curve = |line: &chart::Line| line.points.len() > 1;
        let plot = chart::Plot {
            file: String::new(),
            title: format!("{} over {}", y.label, x.label),
            x: chart::ChartAxis::linear(&x.label),
            y: chart::ChartAxis::linear(&y.label),
            lines: self.runs.iter().map(line).filter(is_curve).collect(),
        };
        if !plot.has_points() {
            return Err(io::Error::other("there is nothing to draw yet"));
        }
        plot.draw()
            .map_err(|reason| io::Error::other(reason.to_string()))
    }

    /// What stands in the table called `name`.
    fn table(&self, name: &str) -> Table {
        let time = PlotAxis(None);
        let axes = [time, self.x, self.y].into_iter();
        let axes = axes.skip(usize::from(self.x == time));
        let run = Column::new("run", Cells::Words);
        Table::new(name, [run].into_iter().chain(axes.map(PlotAxis::column)))
    }

    fn csv(&self) -> io::Result<String> {
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record(self.table("").heads())?;
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
            x: PlotAxis(over),
            y: PlotAxis(Some(Measure::SurfaceAngle)),
            runs: vec![ExportedRun {
                name: "this run".to_owned(),
                time: vec![0.0, 0.5],
                points: vec![[0.0, 0.25], [0.5, f64::NAN]],
            }],
            from: Provenance::of_scene(&grainfall::scene::Scene::open("small-drum").unwrap()),
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
        let mut export = export(None);
        export.runs[0].points.push([1.0, 0.5]);
        let svg = export.svg().unwrap();
        assert!(svg.contains("Surface angle θ [°]") && svg.contains("Time t [s]"));
        assert!(!svg.contains("NaN"));
        export.runs[0].points.clear();
        assert!(export.svg().is_err());
    }

    #[test]
    fn energies_stand_in_the_unit_in_which_results_write_them() {
        let mut export = export(None);
        export.y = PlotAxis(Some(Measure::KineticEnergy));
        export.runs[0].points = vec![[0.0, 0.0], [0.5, 2.5e-4]];
        let svg = export.svg().unwrap();
        assert!(svg.contains("[µJ] over Time t [s]"), "{svg}");
        let mut lines = svg.lines().map(str::trim);
        assert!(lines.any(|line| ["200", "250"].contains(&line)), "{svg}");
        let written = Measure::KineticEnergy.quantity().text(2.5e-4);
        assert!(written.ends_with("µJ"), "{written}");
    }

    #[test]
    fn legend_names_the_runs_that_have_a_curve_and_no_others() {
        let mut export = export(None);
        export.runs[0].points = vec![[0.0, 0.25], [0.5, 0.5]];
        let left = |name: &str, points: Vec<[f64; 2]>| ExportedRun {
            name: name.to_owned(),
            time: points.iter().map(|[time, _]| *time).collect(),
            points,
        };
        export.runs.extend([
            left("of no length", vec![[0.0, 0.25]]),
            left("of nothing", Vec::new()),
            left("of no numbers", vec![[0.0, f64::NAN], [0.5, f64::NAN]]),
            left("of another", vec![[0.0, 0.25], [0.2, 0.3]]),
        ]);
        let svg = export.svg().unwrap();
        assert!(svg.contains("this run") && svg.contains("of another"));
        for name in ["of no length", "of nothing", "of no numbers"] {
            assert!(!svg.contains(name), "{name}");
        }
        // The table has every sample.
        assert!(export.csv().unwrap().contains("of no length,0,0.25"));
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
