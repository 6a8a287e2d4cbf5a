//! Any quantity of the grains: how often which value occurs now, and the chosen grain's over time.
//!
//! In: the state shown. Out: two plots. Nobody keeps what each grain did at each moment, so a grain's
//! curve begins when it is chosen, and holds the moments that were shown since.

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::plots::axes::{fitting_plot, height_of};
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::combo::combo_ui;
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};
use egui_plot::{Bar, BarChart, Line, VLine};
use grainfall::lab::RunView;
use grainfall::measure::{Format, GrainQuantity, Histogram};
use grainfall::world::World;

/// Bars of the histogram.
const BARS: usize = 32;
/// Most points of a grain's curve: at sixty a second, a minute.
const MOST_POINTS: usize = 3600;

/// The panel.
pub struct Grains {
    quantity: GrainQuantity,
    /// The state and the quantity that the values are of.
    made_of: Option<(u64, GrainQuantity)>,
    /// Of each grain.
    values: Vec<f64>,
    course: Course,
}

/// What the chosen grain's quantity was at the moments shown.
#[derive(Default)]
struct Course {
    /// Run, branch, grain and quantity.
    of: Option<(u64, u32, usize, GrainQuantity)>,
    /// Times [s] and values, in order of time.
    points: Vec<[f64; 2]>,
}

impl Default for Grains {
    fn default() -> Self {
        Self {
            quantity: GrainQuantity::Speed,
            made_of: None,
            values: Vec::new(),
            course: Course::default(),
        }
    }
}

impl Panel for Grains {
    fn title(&self) -> &'static str {
        "Grains"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn choices(&self) -> String {
        self.quantity.quantity().key.to_owned()
    }

    fn take_choices(&mut self, choices: &str) {
        let mut all = GrainQuantity::ALL.into_iter();
        let chosen = all.find(|quantity| quantity.quantity().key == choices);
        self.quantity = chosen.unwrap_or(self.quantity);
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let Some(world) = run.world() else {
            ui.weak("There are no grains yet.");
            return;
        };
        self.choice_ui(ui, world);
        self.take(run, world, view.selected);
        let Some(histogram) = Histogram::of(&self.values, BARS) else {
            ui.weak("No grain has it.");
            return;
        };
        let unit = ShownUnit::of(self.quantity, &histogram);
        let own = view.selected.and_then(|grain| self.values.get(grain));
        histogram_ui(ui, &histogram, &unit, own.copied());
        self.course_ui(ui, &unit, view.selected);
    }
}

impl Grains {
    fn choice_ui(&mut self, ui: &mut egui::Ui, world: &World) {
        if !self.quantity.applies_to(world) {
            self.quantity = GrainQuantity::Speed;
        }
        combo_ui(ui, "Of each grain", self.quantity.name(), |ui| {
            for quantity in GrainQuantity::ALL {
                if quantity.applies_to(world) {
                    ui.selectable_value(&mut self.quantity, quantity, quantity.name())
                        .on_hover_text(quantity.quantity().explanation());
                }
            }
        });
    }

    /// Takes the values of the state shown, where it is another one.
    fn take(&mut self, run: &RunView, world: &World, selected: Option<usize>) {
        let made_of = (run.generation(), self.quantity);
        let is_new = self.made_of != Some(made_of);
        if is_new {
            self.values.clear();
            self.quantity.append(world, &mut self.values);
            self.made_of = Some(made_of);
        }
        let of = selected.map(|grain| (run.id(), run.past().number, grain, self.quantity));
        let is_other = self.course.of != of;
        if is_other {
            self.course = Course {
                of,
                points: Vec::new(),
            };
        }
        let value = selected.and_then(|grain| self.values.get(grain));
        if let Some(value) = value.filter(|_| is_new || is_other) {
            self.course.add(world.time(), *value);
        }
    }

    /// Draws what the chosen grain's value was.
    fn course_ui(&self, ui: &mut egui::Ui, unit: &ShownUnit, selected: Option<usize>) {
        let Some(grain) = selected.filter(|grain| *grain < self.values.len()) else {
            ui.weak("Click a grain in the picture to plot it over time.");
            return;
        };
        let colour = Palette::of(ui.visuals()).temperature;
        let title = format!("Grain {grain} over time [s], {}", unit.axis);
        ui.label(RichText::new(&title).strong())
            .on_hover_text("From when it was chosen, at the moments that were shown since");
        let points = self.course.points.iter();
        let points: Vec<[f64; 2]> = points.map(|[time, y]| [*time, y * unit.factor]).collect();
        let height = height_of(points.iter(), 0.0);
        let last = points.last().map_or(f64::NAN, |point| point[1]);
        let plot = fitting_plot(ui, "grain over time")
            .set_margin_fraction(egui::Vec2::ZERO)
            .include_y(*height.start())
            .include_y(*height.end());
        let drawn = plot.show(ui, |plot| {
            let line = Line::new(format!("grain {grain}"), points);
            plot.line(line.color(colour).width(1.7));
        });
        drawn.response.widget_info(|| {
            let text = format!("{title}, now {}", number::short(last));
            WidgetInfo::labeled(WidgetType::Image, true, text)
        });
    }
}

impl Course {
    /// Adds the `value` at `time` [s], in the place of one that is known.
    fn add(&mut self, time: f64, value: f64) {
        let index = self.points.partition_point(|point| point[0] < time);
        match self.points.get_mut(index) {
            Some(point) if point[0] == time => point[1] = value,
            _ => self.points.insert(index, [time, value]),
        }
        if self.points.len() > MOST_POINTS {
            self.points.remove(0);
        }
    }
}

/// The unit of the plots, with a prefix that suits the values.
struct ShownUnit {
    factor: f64,
    /// Name and unit.
    axis: String,
    unit: String,
}

impl ShownUnit {
    fn of(quantity: GrainQuantity, histogram: &Histogram) -> Self {
        let row = quantity.quantity();
        let largest = histogram.low.abs().max(histogram.high.abs());
        let (prefix, factor) = if row.format == Format::Prefixed && largest > 0.0 {
            number::prefix_for(largest)
        } else {
            ("", 1.0)
        };
        let unit = format!("{prefix}{}", quantity.unit());
        let axis = match unit.as_str() {
            "" => quantity.name().to_owned(),
            unit => format!("{} [{unit}]", quantity.name()),
        };
        Self { factor, axis, unit }
    }

    /// `value` with the unit.
    fn text(&self, value: f64) -> String {
        let text = format!("{} {}", number::short(value * self.factor), self.unit);
        text.trim_end().to_owned()
    }
}

/// How wide the bars of a histogram are: a single value has a bar, too, and where that is zero one
/// of width 1.
fn bar_width(histogram: &Histogram) -> f64 {
    match histogram.high.abs() {
        0.0 if histogram.width() == 0.0 => 1.0,
        largest => histogram.width().max(0.02 * largest),
    }
}

/// Draws how many grains have which value, and where the chosen one stands.
fn histogram_ui(ui: &mut egui::Ui, histogram: &Histogram, unit: &ShownUnit, own: Option<f64>) {
    let palette = Palette::of(ui.visuals());
    let (mean, deviation) = (unit.text(histogram.mean), unit.text(histogram.deviation));
    let title = format!("Grains over {}", unit.axis);
    ui.label(RichText::new(&title).strong());
    let text = format!(
        "{} grains, mean {mean}, spread {deviation}",
        histogram.total()
    );
    ui.label(&text)
        .on_hover_text("Of the state shown; the spread is the standard deviation");
    let width = unit.factor * bar_width(histogram);
    let bars = histogram.parts().filter(|(_, count)| *count > 0);
    let bars =
        bars.map(|(middle, count)| Bar::new(unit.factor * middle, count as f64).width(width));
    let chart = BarChart::new("grains", bars.collect()).color(palette.angle.gamma_multiply(0.8));
    let plot = fitting_plot(ui, "grains over a quantity").include_y(0.0);
    let drawn = plot.show(ui, |plot| {
        plot.bar_chart(chart);
        plot.vline(VLine::new("mean", unit.factor * histogram.mean).color(palette.threshold));
        if let Some(own) = own {
            let line = VLine::new("the chosen grain", unit.factor * own);
            plot.vline(line.color(palette.warning).width(2.0));
        }
    });
    drawn
        .response
        .widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, format!("{title}: {text}")));
}
