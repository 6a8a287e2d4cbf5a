//! The running wet drum beside the laws of Kasper et al. 2021: the drops over viscosity with Eq.
//! 23, the non-rigid share over √(1/Ga).
//!
//! In: the samples since the last change of a parameter. Out: points with their errors that move as
//! the run goes on, and what becomes of the paper's law by the rules of [`Verdict`].

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::panels::averages::Averages;
use crate::ui::plots::axes::{SPARSE_Y, round_marks};
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use egui_plot::{AxisHints, Line, LineStyle, MarkerShape, Plot, PlotUi, Points, VLine};
use grainfall::lab::RunView;
use grainfall::measure::{
    Estimate, RunQuantity, Summary, Verdict, beyond_kasper, drop_ratio_law, dry_drum,
};
use grainfall::run::{Command, Parameter};

/// Height of a plot in points.
const HEIGHT: f32 = 130.0;

/// How far from Eq. 23 the paper's own points lie.
const DROP_RATIO_TOLERANCE: f64 = 0.1;
/// What the two points of the non-rigid share are.
const FRAMES: &str = "Diamond: the paper's ta/ts, in the laboratory frame. Circle: ta/ts′ in the frame that turns with the drum.";

/// The panel.
#[derive(Default)]
pub struct BesidePaper {
    averages: Averages,
}

/// One plot: a law, a threshold, and where the run stands. The horizontal axis is one of powers of
/// ten.
pub struct PaperPlot {
    /// What tells it from the others.
    pub id: &'static str,
    /// What stands over it.
    pub title: &'static str,
    /// The law's line; empty where there is none.
    pub law: Vec<[f64; 2]>,
    /// What the law is called.
    pub law_name: &'static str,
    /// Where a threshold stands.
    pub threshold: Option<f64>,
    /// Where the run stands.
    pub points: Vec<PaperPoint>,
    /// What is in view across.
    pub x: std::ops::RangeInclusive<f64>,
    /// What is in view upright.
    pub y: std::ops::RangeInclusive<f64>,
}

/// Where a run stands on one plot.
pub struct PaperPoint {
    /// What it is, where there are several.
    pub name: &'static str,
    /// Its place on the axes.
    pub at: [f64; 2],
    /// The standard error of its height, if it is known.
    pub error: Option<f64>,
}

impl PaperPoint {
    /// The one point of a plot, without an error.
    pub fn alone(x: f64, y: f64) -> Self {
        Self {
            name: "this run",
            at: [x, y],
            error: None,
        }
    }

    /// A mean with its error.
    fn mean(name: &'static str, x: f64, mean: Estimate) -> Self {
        Self {
            name,
            at: [x, mean.mean],
            error: mean.error,
        }
    }
}

impl Panel for BesidePaper {
    fn title(&self) -> &'static str {
        "Beside the paper"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        let is_wet = simulation.scene().liquid.is_some();
        // A speed that was changed is said where the laws would stand.
        is_wet && simulation.scene().species().len() < 2
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let viscosity = run
            .value(&Parameter::Viscosity)
            .map(|value| 1e3 * value.number());
        let Some(world) = run.world() else {
            ui.weak("The laws appear when the bed stands.");
            return;
        };
        if let Some(reason) = beyond_kasper(world) {
            ui.weak(format!(
                "The laws of the paper say nothing of this drum: {reason}."
            ));
            return;
        }
        let radius = world.grains.radius.first().copied().unwrap_or(0.0);
        let from = last_change(run);
        let summary = self.averages.over(run, from);
        let drop = summary.estimate(RunQuantity::Drop);
        let count = summary.value(RunQuantity::Avalanches).unwrap_or(0.0);
        let dry = dry_drum(radius).map(|drum| drum.drop);
        let ratio = viscosity.zip(drop.zip(dry).map(|(drop, dry)| drop.over(dry)));
        comparison_ui(ui, drop_ratio(ratio));
        if let Some((viscosity, ratio)) = ratio {
            ui.label(RichText::new(beside_the_law(viscosity, ratio)).small());
        }
        comparison_ui(ui, flowing_share(summary));
        ui.label(RichText::new(FRAMES).small().weak());
        if let Some(note) = summary.rotation_note() {
            ui.label(RichText::new(note).small().weak());
        }
        let missing = match (dry, drop) {
            (None, _) => {
                "No stored dry drum has this radius: set a drum of 3, 2 or 1.25 mm beside it. "
            }
            (_, None) => "No avalanche yet. ",
            _ => "",
        };
        let averages = format!(
            "{missing}Averages since {} s, the last change: {} avalanches. The paper takes 30 s.",
            number::fixed(from, 1),
            number::fixed(count, 0)
        );
        ui.label(RichText::new(averages).small().weak());
    }
}

/// Wet over dry drop, where the run's is a `ratio` at a viscosity [mPa s].
fn drop_ratio(ratio: Option<(f64, Estimate)>) -> PaperPlot {
    let highest = ratio.map_or(0.0, |(_, ratio)| ratio.mean + ratio.error.unwrap_or(0.0));
    let point =
        |(x, ratio): (f64, Estimate)| PaperPoint::mean("this run", x.max(0.1).log10(), ratio);
    PaperPlot {
        id: "drop ratio",
        title: "Wet over dry drop, over viscosity η [mPa s]",
        law: law_over(-0.5..=3.4, |viscosity| drop_ratio_law(1e-3 * viscosity)),
        law_name: "0.4 + 0.47 exp(−η/295 mPa s)",
        threshold: None,
        points: ratio.map(point).into_iter().collect(),
        x: -0.5..=3.4,
        y: 0.0..=highest.max(1.1) * 1.05,
    }
}

/// What becomes of *the ratio of the drops follows Eq. 23 to within 0.1*, in words.
fn beside_the_law(viscosity: f64, ratio: Estimate) -> String {
    let law = drop_ratio_law(1e-3 * viscosity);
    let verdict = Verdict::of_between(
        ratio,
        law - DROP_RATIO_TOLERANCE..law + DROP_RATIO_TOLERANCE,
    );
    let own = match (ratio.error, ratio.reason()) {
        (Some(error), _) => format!(
            "{} ± {}",
            number::fixed(ratio.mean, 2),
            number::fixed(error, 2)
        ),
        (None, reason) => format!(
            "{} ({})",
            number::fixed(ratio.mean, 2),
            reason.unwrap_or_default()
        ),
    };
    let law = number::fixed(law, 2);
    format!("{own} beside Eq. 23's {law} ± 0.1: {}.", verdict.word())
}

/// The non-rigid share over `√(1/Ga)`, that of the paper's frame and that of the drum's.
fn flowing_share(summary: &Summary) -> PaperPlot {
    let across = summary.value(RunQuantity::InverseRootGalilei);
    let shares = [
        ("ta/ts, the paper's", RunQuantity::NonRigidShare),
        ("ta/ts′, in the drum's frame", RunQuantity::CorotatingShare),
    ];
    let point = |(name, quantity): (&'static str, RunQuantity)| {
        Some(PaperPoint::mean(
            name,
            across?.log10(),
            summary.estimate(quantity)?,
        ))
    };
    PaperPlot {
        id: "flowing share",
        title: "Non-rigid share ta/ts, over √(1/Ga)",
        law: Vec::new(),
        law_name: "",
        threshold: Some(0.0),
        points: shares.into_iter().filter_map(point).collect(),
        x: -3.5..=1.2,
        y: 0.0..=1.1,
    }
}

/// When a parameter was last changed [s].
fn last_change(run: &RunView) -> f64 {
    let mut commands = run.commands().iter().rev();
    let change = commands.find(|stamped| matches!(stamped.command, Command::Set { .. }));
    change.map_or(0.0, |stamped| stamped.time)
}

/// The points of a law on an axis of powers of ten.
pub fn law_over(powers: std::ops::RangeInclusive<f64>, law: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let (from, to) = powers.into_inner();
    let at = |k: i32| from + (to - from) * f64::from(k) / 80.0;
    let point = |place: f64| [place, law(10_f64.powf(place))];
    (0..=80).map(at).map(point).collect()
}

/// Draws where a run stands, with one standard error below and above: the paper's own first, filled;
/// beside it a hollow one.
fn points_ui(plot: &mut PlotUi, points: &[PaperPoint], palette: Palette) {
    let marks = [(MarkerShape::Diamond, true), (MarkerShape::Circle, false)];
    for (point, (shape, filled)) in points.iter().zip(marks) {
        let [x, y] = point.at;
        if let Some(error) = point.error {
            let bar = Line::new(point.name, vec![[x, y - error], [x, y + error]]);
            plot.line(bar.color(palette.temperature).width(1.6));
        }
        let mark = Points::new(point.name, vec![point.at]).shape(shape);
        plot.points(mark.filled(filled).radius(7.0).color(palette.temperature));
    }
}

/// Draws one comparison.
pub fn comparison_ui(ui: &mut egui::Ui, shown: PaperPlot) {
    let palette = Palette::of(ui.visuals());
    ui.label(RichText::new(shown.title).strong());
    Plot::new(shown.id)
        .height(HEIGHT)
        .width(ui.available_width() - 14.0)
        .show_crosshair(false)
        .grid_color(palette.grid)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .auto_bounds(false)
        .x_grid_spacer(|input| round_marks(input, 1.0, 1.0))
        .y_grid_spacer(|input| round_marks(input, SPARSE_Y, 0.0))
        .custom_x_axes(vec![
            AxisHints::new_x().formatter(|mark, _| number::power_of_ten(mark.value.round() as i32)),
        ])
        .custom_y_axes(vec![AxisHints::new_y().min_thickness(46.0)])
        .show(ui, |plot| {
            plot.set_plot_bounds(egui_plot::PlotBounds::from_min_max(
                [*shown.x.start(), *shown.y.start()],
                [*shown.x.end(), *shown.y.end()],
            ));
            if !shown.law.is_empty() {
                let law = Line::new(shown.law_name, shown.law).color(palette.threshold);
                plot.line(law.width(1.6));
            }
            if let Some(x) = shown.threshold {
                let line = VLine::new("Ga = 1", x).color(palette.threshold);
                plot.vline(line.style(LineStyle::dashed_dense()));
            }
            points_ui(plot, &shown.points, palette);
        });
}
