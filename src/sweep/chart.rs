//! A plot as SVG: points with their errors and laws over two axes, each linear or logarithmic.

use super::legend::{LINE, Legend};
use crate::measure::Estimate;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::ops::Range;

/// Size of a plot in pixels, without a legend beside it.
const SIZE: (u32, u32) = (760, 520);
/// Size of the area between the axes in pixels, about.
const AREA: (f64, f64) = (660.0, 420.0);
/// Places to which a pixel is divided: coordinates are whole numbers, and a curve of whole pixels is
/// a stair.
const FINE: u32 = 10;
/// A logarithmic axis of fewer decades has labels between them.
const FEW_DECADES: f64 = 2.5;

/// How much of its colour a band has.
const BAND: f64 = 0.25;
/// Half the width of the ends of an error bar, as a share of the plot's width.
const BAR_END: f64 = 0.006;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type DrawingResult = Result<(), Box<dyn std::error::Error>>;

/// A set of points or a curve with its name.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// Name in the legend.
    pub name: String,
    /// Its points, in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// One standard error below and above a point: its x, and from where to where on the upright
    /// axis. Bars where points are marked, a band along a curve.
    pub bars: Vec<(f64, f64, f64)>,
    /// A law or threshold: drawn as a grey curve without marks.
    pub is_law: bool,
}

/// A plot: what it shows over what.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Its file below the folder of plots.
    pub file: String,
    /// What stands over it.
    pub title: String,
    /// Across.
    pub x: ChartAxis,
    /// Upright.
    pub y: ChartAxis,
    /// What is drawn.
    pub lines: Vec<Line>,
}

/// An axis of a plot.
#[derive(Clone, Debug)]
pub struct ChartAxis {
    label: String,
    logarithmic: bool,
}

impl ChartAxis {
    /// Values at their places.
    pub fn linear(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            logarithmic: false,
        }
    }

    /// Values at the places of their powers of ten.
    pub fn logarithmic(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            logarithmic: true,
        }
    }

    /// What stands beside it.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Whether values stand at the places of their powers of ten.
    pub fn is_logarithmic(&self) -> bool {
        self.logarithmic
    }

    /// Where a value lies on it.
    pub fn place(&self, value: f64) -> f64 {
        if self.logarithmic {
            value.log10()
        } else {
            value
        }
    }

    /// The text at a place of an axis that spans `span`.
    fn text(&self, place: f64, span: f64) -> String {
        if !self.logarithmic {
            return text(place);
        }
        // Of many decades only whole ones are labelled.
        if span > FEW_DECADES && (place - place.round()).abs() > 1e-6 {
            return String::new();
        }
        let leading = 10_f64.powf(place.floor() - 1.0);
        text((10_f64.powf(place) / leading).round() * leading)
    }
}

fn text(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        0.001..1e4 => format!("{}", (value * 1e5).round() / 1e5),
        _ => format!("{value:.1e}"),
    }
}

impl Line {
    /// Results: marks, joined in the order of x; points that are not finite are left out.
    pub fn results(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        let mut points: Vec<(f64, f64)> = points.into_iter().filter(finite).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            name: name.into(),
            points,
            ..Self::default()
        }
    }

    /// Means with their errors, those of them that are known, in the unit of the axis; joined as
    /// [`results`](Self::results) are.
    pub fn means(
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, Estimate)>,
    ) -> Self {
        let points: Vec<(f64, Estimate)> = points.into_iter().collect();
        let bar = |(x, mean): &(f64, Estimate)| {
            let error = mean.error?;
            Some((*x, mean.mean - error, mean.mean + error))
        };
        Self {
            bars: points.iter().filter_map(bar).collect(),
            ..Self::results(name, points.iter().map(|(x, mean)| (*x, mean.mean)))
        }
    }

    /// The law `value` between two places of a logarithmic axis.
    pub fn law(name: &str, from: f64, to: f64, value: impl Fn(f64) -> f64) -> Self {
        let at = |k: i32| from * (to / from).powf(f64::from(k) / 100.0);
        Self {
            name: name.to_owned(),
            points: (0..=100).map(|k| (at(k), value(at(k)))).collect(),
            is_law: true,
            ..Self::default()
        }
    }
}

impl Plot {
    /// Whether it has more to show than laws.
    pub fn has_points(&self) -> bool {
        let results = self.lines.iter().filter(|line| !line.is_law);
        results.flat_map(|line| self.places(line)).next().is_some()
    }

    /// Where the points of `line` are on the axes; those that have no place, as zero on a
    /// logarithmic axis, are left out.
    fn places<'a>(&'a self, line: &'a Line) -> impl Iterator<Item = (f64, f64)> + 'a {
        let points = line.points.iter();
        let places = points.map(|(x, y)| (self.x.place(*x), self.y.place(*y)));
        places.filter(|(x, y)| x.is_finite() && y.is_finite())
    }

    fn all_places(&self) -> impl Iterator<Item = (f64, f64)> {
        self.lines.iter().flat_map(|line| self.places(line))
    }

    /// Where the ends of the error bars are that have a place.
    fn bar_ends(&self) -> impl Iterator<Item = (f64, f64)> {
        let bars = self.lines.iter().flat_map(|line| &line.bars);
        let ends = bars.flat_map(|(x, low, high)| [(*x, *low), (*x, *high)]);
        let places = ends.map(|(x, y)| (self.x.place(x), self.y.place(y)));
        places.filter(|(x, y)| x.is_finite() && y.is_finite())
    }

    /// The range of all `along` one axis, with a margin; any range where there are no points.
    fn range(&self, along: impl Fn((f64, f64)) -> f64) -> Range<f64> {
        let places = self.all_places().chain(self.bar_ends()).map(along);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        if low > high {
            return 0.0..1.0;
        }
        let margin = (0.05 * (high - low)).max(1e-3 * high.abs()).max(1e-9);
        low - margin..high + margin
    }

    /// The legend, and the corner in which it hides nothing that is marked, where there is one.
    fn legend(&self, x: &Range<f64>, y: &Range<f64>) -> (Legend, Option<SeriesLabelPosition>) {
        let share = |(across, upright): (f64, f64)| {
            let share =
                |place: f64, range: &Range<f64>| (place - range.start) / (range.end - range.start);
            (share(across, x), share(upright, y))
        };
        let marks = self.lines.iter().filter(|line| self.is_marked(line));
        let marks = marks.flat_map(|line| self.places(line));
        let marks: Vec<_> = marks.chain(self.bar_ends()).map(share).collect();
        let curves: Vec<_> = self.along_lines().map(share).collect();
        let legend = Legend::of(self.named().map(|(_, line)| line.name.as_str()), AREA);
        (legend, legend.corner(&marks, &curves))
    }

    /// The lines that the legend lists, each with its number: those that have a name, and a place.
    fn named(&self) -> impl Iterator<Item = (usize, &Line)> {
        let lines = self.lines.iter().enumerate();
        lines.filter(|(_, line)| self.is_listed(line))
    }

    fn is_listed(&self, line: &Line) -> bool {
        !line.name.is_empty() && self.places(line).next().is_some()
    }

    /// Places on the lines between all points.
    fn along_lines(&self) -> impl Iterator<Item = (f64, f64)> {
        self.lines.iter().flat_map(|line| {
            let places: Vec<(f64, f64)> = self.places(line).collect();
            let between = |pair: &[(f64, f64)]| {
                let [from, to] = [pair[0], pair[1]];
                let at = |from: f64, to: f64, k: u32| from + f64::from(k) / 16.0 * (to - from);
                (0..16).map(move |k| (at(from.0, to.0, k), at(from.1, to.1, k)))
            };
            places.windows(2).flat_map(between).collect::<Vec<_>>()
        })
    }

    /// Marks stand on results, none on curves.
    fn is_marked(&self, line: &Line) -> bool {
        !line.is_law && self.places(line).count() <= 16
    }

    /// As the text of an SVG file.
    ///
    /// # Errors
    /// When it cannot be drawn.
    pub fn draw(&self) -> Result<String, Box<dyn std::error::Error>> {
        let mut text = String::new();
        let (x, y) = (self.range(|(x, _)| x), self.range(|(_, y)| y));
        let (legend, corner) = self.legend(&x, &y);
        let beside = if corner.is_some() {
            0
        } else {
            legend.width.ceil() as u32
        };
        let size = (SIZE.0 + beside, SIZE.1);
        {
            let fine = (size.0 * FINE, size.1 * FINE);
            let whole = SVGBackend::with_string(&mut text, fine).into_drawing_area();
            whole.fill(&WHITE)?;
            let (area, side) = whole.split_horizontally(SIZE.0 * FINE);
            let mut chart = ChartBuilder::on(&area)
                .caption(&self.title, ("sans-serif", 20 * FINE))
                .margin(14 * FINE)
                .x_label_area_size(44 * FINE)
                .y_label_area_size(72 * FINE)
                .build_cartesian_2d(x.clone(), y.clone())?;
            chart
                .configure_mesh()
                .x_desc(&self.x.label)
                .y_desc(&self.y.label)
                .x_label_formatter(&|place| self.x.text(*place, x.end - x.start))
                .y_label_formatter(&|place| self.y.text(*place, y.end - y.start))
                .label_style(("sans-serif", 14 * FINE))
                .light_line_style(RGBColor(244, 244, 244).stroke_width(FINE))
                .bold_line_style(RGBColor(224, 224, 224).stroke_width(FINE))
                .axis_style(BLACK.stroke_width(FINE))
                .set_all_tick_mark_size(5 * FINE)
                .draw()?;
            for (index, line) in self.lines.iter().enumerate() {
                let colour = colour(index, line.is_law);
                let points: Vec<(f64, f64)> = self.places(line).collect();
                let curve = LineSeries::new(points.clone(), colour.stroke_width(2 * FINE));
                let drawn = chart.draw_series(curve)?;
                if self.is_listed(line) {
                    drawn.label(&line.name).legend(move |(x, y)| {
                        let end = x + 18 * FINE.cast_signed();
                        PathElement::new([(x, y), (end, y)], colour.stroke_width(2 * FINE))
                    });
                }
                if self.is_marked(line) {
                    chart.draw_series(
                        points
                            .iter()
                            .map(|point| Circle::new(*point, 4 * FINE, colour.filled())),
                    )?;
                }
                if self.is_marked(line) {
                    self.draw_bars(&mut chart, line, colour, [x.clone(), y.clone()])?;
                } else {
                    self.draw_band(&mut chart, line, colour, y.start)?;
                }
            }
            match corner {
                Some(corner) => chart
                    .configure_series_labels()
                    .label_font(("sans-serif", 14 * FINE))
                    .background_style(WHITE.mix(0.85))
                    .legend_area_size(30 * FINE)
                    .margin(10 * FINE)
                    .position(corner)
                    .draw()?,
                None => self.list_beside(&side)?,
            }
            whole.present()?;
        }
        Ok(at_its_size(&text, size))
    }
}

impl Plot {
    /// Lists the named lines on the area beside the plot.
    fn list_beside(&self, side: &DrawingArea<SVGBackend, Shift>) -> DrawingResult {
        let fine = |pixels: f64| (pixels * f64::from(FINE)) as i32;
        for (row, (index, line)) in self.named().enumerate() {
            let y = fine(56.0 + LINE * row as f64);
            let stroke = colour(index, line.is_law).stroke_width(2 * FINE);
            let ends = vec![(fine(4.0), y), (fine(22.0), y)];
            side.draw(&PathElement::new(ends, stroke))?;
            let place = (fine(30.0), y - fine(7.0));
            let style = ("sans-serif", 14 * FINE).into_font().color(&BLACK);
            side.draw(&Text::new(line.name.clone(), place, style))?;
        }
        Ok(())
    }

    /// Draws the error bars of `line` in `colour` on a chart that shows these ranges. A bar that
    /// has no lower end, as zero on a logarithmic axis, goes down to the edge.
    fn draw_bars(
        &self,
        chart: &mut Chart,
        line: &Line,
        colour: RGBColor,
        [across, upright]: [Range<f64>; 2],
    ) -> DrawingResult {
        let half = BAR_END * (across.end - across.start);
        for (x, low, high) in &line.bars {
            let (at, top) = (self.x.place(*x), self.y.place(*high));
            let bottom = Some(self.y.place(*low)).filter(|place| place.is_finite());
            let foot = bottom.unwrap_or(upright.start);
            if !(at.is_finite() && top.is_finite()) {
                continue;
            }
            let end = |y: f64| vec![(at - half, y), (at + half, y)];
            let strokes = [vec![(at, foot), (at, top)], end(top), end(foot)];
            let drawn = strokes
                .into_iter()
                .take(if bottom.is_some() { 3 } else { 2 });
            chart.draw_series(
                drawn.map(|stroke| PathElement::new(stroke, colour.stroke_width(FINE))),
            )?;
        }
        Ok(())
    }

    /// Draws the errors of `line` as a band in `colour`; what has no lower end, as zero on a
    /// logarithmic axis, goes down to the edge at `floor`.
    fn draw_band(
        &self,
        chart: &mut Chart,
        line: &Line,
        colour: RGBColor,
        floor: f64,
    ) -> DrawingResult {
        let edges = line.bars.iter().map(|(x, low, high)| {
            let low = Some(self.y.place(*low)).filter(|place| place.is_finite());
            (self.x.place(*x), low.unwrap_or(floor), self.y.place(*high))
        });
        let edges: Vec<_> = edges
            .filter(|(x, _, high)| x.is_finite() && high.is_finite())
            .collect();
        let above = edges.iter().map(|(x, _, high)| (*x, *high));
        let below = edges.iter().rev().map(|(x, low, _)| (*x, *low));
        let outline: Vec<(f64, f64)> = above.chain(below).collect();
        if !outline.is_empty() {
            chart.draw_series([Polygon::new(outline, colour.mix(BAND).filled())])?;
        }
        Ok(())
    }
}

/// The drawing `text`, shown in so many pixels.
fn at_its_size(text: &str, (across, upright): (u32, u32)) -> String {
    let size = |across: u32, upright: u32| format!(r#"width="{across}" height="{upright}""#);
    let fine = size(across * FINE, upright * FINE);
    text.replacen(&fine, &size(across, upright), 1)
}

fn colour(index: usize, is_law: bool) -> RGBColor {
    if is_law {
        return RGBColor(120, 120, 120);
    }
    let palette = colorous::TABLEAU10;
    let colorous::Color { r, g, b } = palette[index % palette.len()];
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: &[(f64, f64)]) -> Plot {
        Plot {
            file: "any.svg".into(),
            title: "Any".into(),
            x: ChartAxis::linear("t"),
            y: ChartAxis::logarithmic("Tg"),
            lines: vec![Line::results("a", points.iter().copied())],
        }
    }

    /// The ends of the upright strokes of a drawn plot are one error from their point.
    #[test]
    fn errors_are_bars_and_none_is_cut_off() {
        let mean = |mean, error| Estimate {
            mean,
            error,
            samples: 4,
            freedom: 3,
        };
        let points = [
            (0.0, mean(1e-8, Some(5e-9))),
            (1.0, mean(2e-8, None)),
            (2.0, mean(1e-8, Some(2e-8))),
        ];
        let plot = Plot {
            lines: vec![Line::means("a", points)],
            ..plot(&[])
        };
        assert_eq!(plot.lines[0].bars.len(), 2);
        let range = plot.range(|(_, y)| y);
        assert!(range.start < 5e-9_f64.log10() && range.end > 3e-8_f64.log10());
        // Three strokes for the first, two for the one whose lower end has no place; the curve is
        // thicker.
        let text = plot.draw().unwrap();
        let RGBColor(r, g, b) = colour(0, false);
        let own = format!("stroke=\"#{r:02X}{g:02X}{b:02X}\" stroke-width=\"{FINE}\"");
        assert_eq!(text.matches(&own).count(), 3 + 2);
    }

    /// The outline of a band runs one error above the points and back one below them.
    #[test]
    fn errors_along_a_curve_are_a_band() {
        let point = |k: u32| {
            let mean = Estimate::of_runs(&[1e-8, 3e-8]);
            (f64::from(k), mean)
        };
        let plot = Plot {
            lines: vec![Line::means("a", (0..20).map(point))],
            ..plot(&[])
        };
        let text = plot.draw().unwrap();
        let band = text.split("<polygon ").nth(1).unwrap();
        assert!(band.contains("opacity=\"0.25\""), "{band}");
        let corners = band.split("points=\"").nth(1).unwrap();
        let corners: Vec<&str> = corners.split('"').next().unwrap().split(' ').collect();
        let y: Vec<&str> = corners
            .iter()
            .filter_map(|at| at.split(',').nth(1))
            .collect();
        assert_eq!(y.len(), 40, "{corners:?}");
        assert!(y[..20].iter().all(|own| *own == y[0]));
        assert!(y[20..].iter().all(|own| *own == y[39]));
        let height = |at: &str| at.parse::<f64>().unwrap();
        assert!(height(y[0]) < height(y[39]), "one above, one below");
        let RGBColor(r, g, b) = colour(0, false);
        let bars = format!("stroke=\"#{r:02X}{g:02X}{b:02X}\" stroke-width=\"{FINE}\"");
        assert!(!text.contains(&bars));
    }

    #[test]
    fn a_legend_without_a_free_corner_stands_beside_the_plot() {
        let corners = [(0.0, 1e-9), (0.0, 1e-7), (2.0, 1e-9), (2.0, 1e-7)];
        let text = plot(&corners).draw().unwrap();
        assert!(
            text.starts_with("<svg width=\"823\" height=\"520\""),
            "{}",
            &text[..80]
        );
        let name = text.find("\na\n").unwrap();
        let label = &text[text[..name].rfind("<text").unwrap()..name];
        let x: u32 = label.split('"').nth(1).unwrap().parse().unwrap();
        assert!(x > SIZE.0 * FINE, "{label}");
        let text = plot(&corners[..2]).draw().unwrap();
        assert!(text.starts_with("<svg width=\"760\""));
    }

    #[test]
    fn zero_has_no_place_on_a_logarithmic_axis() {
        let some = plot(&[(0.0, 0.0), (1.0, 1e-9), (2.0, 1e-7)]);
        assert_eq!(some.all_places().count(), 2);
        assert!(some.has_points());
        let none = plot(&[(0.0, 0.0), (1.0, -1.0)]);
        assert!(!none.has_points());
        assert_eq!(none.named().count(), 0, "no legend names what is not there");
        // Axes without an end would be divided for ever.
        for plot in [some, none] {
            let text = plot.draw().unwrap();
            assert!(text.starts_with("<svg") && !text.contains("NaN"));
        }
    }
}
