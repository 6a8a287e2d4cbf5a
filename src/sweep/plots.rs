//! The plots of a sweep: of columns those in `column_plots`, of drums results over viscosity for each radius, as in Figs. 2 and 5
//! to 8 of Kasper et al. 2021, with its laws and thresholds drawn in; θ(t) and Tg(t) of each case (Fig. 3); velocity profiles
//! (Fig. 4e). A sweep that varies no liquid has its results over what it does vary.

use super::Sweep;
use super::case::{CaseEnding, Outcome, write};
use super::chart::{Axis, Line, Plot};
use super::column_plots::column_plots;
use crate::headless::HeadlessError;
use crate::measure::{Measure, NON_RIGID_TEMPERATURE, Series, drop_ratio_law};
use crate::scene::SceneGrains;
use crate::simulation::Provenance;
use std::collections::BTreeMap;

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Writes every plot that the outcomes have points for.
///
/// # Errors
/// When a file cannot be written.
pub fn write_plots(sweep: &Sweep, outcomes: &[Outcome]) -> Result<(), HeadlessError> {
    for plot in plots(sweep, outcomes).filter(Plot::has_points) {
        let text = plot.draw().map_err(|reason| {
            HeadlessError::Input(format!("the plot {} cannot be drawn: {reason}", plot.file))
        })?;
        let path = sweep.out.join("plots").join(&plot.file);
        let text = Provenance::of_scene(&sweep.scene).in_svg(&text);
        write(&path, |file| file.write_all(text.as_bytes()))?;
    }
    Ok(())
}

/// Every plot of these outcomes. What a case came to before it met a fault is no result, nor is where one stood that was
/// stopped before it began: they are in no plot.
pub(super) fn plots(sweep: &Sweep, outcomes: &[Outcome]) -> impl Iterator<Item = Plot> {
    let has_begun =
        |outcome: &Outcome| outcome.series.time().last().is_some_and(|time| *time > 0.0);
    let is_sound = |outcome: &&Outcome| outcome.ending != CaseEnding::Faulted && has_begun(outcome);
    let sound: Vec<Outcome> = outcomes.iter().filter(is_sound).cloned().collect();
    let plots = if sound.iter().any(Outcome::is_column) {
        column_plots(sweep, &sound)
    } else {
        drum_plots(sweep, &sound)
    };
    plots.into_iter()
}

fn drum_plots(sweep: &Sweep, outcomes: &[Outcome]) -> Vec<Plot> {
    let over = Over::of(sweep, outcomes);
    let mut plots: Vec<Plot> = RESULTS
        .iter()
        .map(|shown| over.plot(shown, outcomes))
        .collect();
    plots.extend(drop_ratios(outcomes));
    plots.extend(over_galilei(outcomes));
    plots.extend(profiles(outcomes));
    plots.extend(outcomes.iter().flat_map(courses));
    plots
}

/// A result to show: its file, its name among the results, factor to the shown unit, axis label.
struct Shown {
    file: &'static str,
    result: &'static str,
    factor: f64,
    label: &'static str,
    logarithmic: bool,
}

const fn shown(
    file: &'static str,
    result: &'static str,
    factor: f64,
    label: &'static str,
    logarithmic: bool,
) -> Shown {
    Shown {
        file,
        result,
        factor,
        label,
        logarithmic,
    }
}

const RESULTS: &[Shown] = &[
    shown(
        "surface-angle.svg",
        "surface angle",
        DEGREES,
        "surface angle θ [°]",
        false,
    ),
    shown("drop.svg", "drop Δθ", DEGREES, "drop Δθ [°]", false),
    shown(
        "granular-temperature.svg",
        "granular temperature",
        1.0,
        "granular temperature Tg [m²/s²]",
        true,
    ),
    shown(
        "flowing-share.svg",
        "non-rigid share ta/ts",
        1.0,
        "non-rigid share ta/ts",
        false,
    ),
    shown(
        "packing-fraction.svg",
        "packing fraction",
        1.0,
        "packing fraction φ",
        false,
    ),
    shown(
        "surface-roughness.svg",
        "surface roughness",
        1e3,
        "surface roughness h [mm]",
        false,
    ),
];

/// What results are plotted over.
struct Over {
    axis: Axis,
    value: fn(&Outcome) -> Option<f64>,
}

impl Over {
    fn of(sweep: &Sweep, outcomes: &[Outcome]) -> Self {
        if outcomes.iter().any(|outcome| viscosity(outcome).is_some()) {
            return Self {
                axis: Axis::logarithmic("viscosity η [mPa s] (dry at the left edge)"),
                value: |outcome| Some(viscosity(outcome).unwrap_or(DRY)),
            };
        }
        let key = sweep
            .variations
            .first()
            .map_or("", |variation| &variation.key);
        Self {
            axis: Axis::linear(key),
            value: |outcome| leading_number(outcome.case.values.first()?),
        }
    }

    fn plot(&self, shown: &Shown, outcomes: &[Outcome]) -> Plot {
        let point = |outcome: &Outcome| {
            Some((
                (self.value)(outcome)?,
                shown.factor * outcome.result(shown.result)?,
            ))
        };
        Plot {
            file: shown.file.to_owned(),
            title: shown.label.to_owned(),
            x: self.axis.clone(),
            y: if shown.logarithmic {
                Axis::logarithmic(shown.label)
            } else {
                Axis::linear(shown.label)
            },
            lines: by_radius(outcomes, point),
        }
    }
}

/// Where dry drums stand on an axis of viscosities [mPa s].
const DRY: f64 = 0.3;

/// Viscosity of a case's liquid [mPa s].
fn viscosity(outcome: &Outcome) -> Option<f64> {
    Some(1e3 * outcome.case.scene.liquid.as_ref()?.viscosity)
}

/// Radius of a case's first species, half a lattice cell where it is one of Voronoi cells [mm].
fn radius(outcome: &Outcome) -> f64 {
    match &outcome.case.scene.grains {
        SceneGrains::Fill { species, .. } => species.first().map_or(0.0, |kind| 1e3 * kind.radius),
        SceneGrains::Voronoi(cells) => 0.5e3 * cells.cell,
        SceneGrains::List(list) => list.first().map_or(0.0, |grain| 1e3 * grain.radius),
    }
}

fn leading_number(text: &str) -> Option<f64> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)));
    text[..end.unwrap_or(text.len())].parse().ok()
}

/// A line for each radius, through the points of its outcomes in the order of x.
fn by_radius(outcomes: &[Outcome], point: impl Fn(&Outcome) -> Option<(f64, f64)>) -> Vec<Line> {
    let mut lines: BTreeMap<u64, Line> = BTreeMap::new();
    for outcome in outcomes {
        let radius = radius(outcome);
        let line = lines.entry((1e6 * radius) as u64).or_insert_with(|| Line {
            name: format!("r = {radius} mm"),
            points: Vec::new(),
            is_law: false,
        });
        line.points
            .extend(point(outcome).filter(|(x, y)| x.is_finite() && y.is_finite()));
    }
    let mut lines: Vec<Line> = lines.into_values().collect();
    for line in &mut lines {
        line.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    lines
}

/// Wet over dry drop, with Eq. 23 (Fig. 5b).
fn drop_ratios(outcomes: &[Outcome]) -> Option<Plot> {
    let dry = |wet: &Outcome| {
        let mut dry = outcomes.iter().filter(|o| viscosity(o).is_none());
        dry.find(|o| radius(o) == radius(wet))?.result("drop Δθ")
    };
    let mut lines = by_radius(outcomes, |outcome| {
        Some((
            viscosity(outcome)?,
            outcome.result("drop Δθ")? / dry(outcome)?,
        ))
    });
    lines.push(Line::law(
        "0.4 + 0.47 exp(−η/295 mPa s), Eq. 23",
        0.5,
        2000.0,
        |eta| drop_ratio_law(1e-3 * eta),
    ));
    let plot = Plot {
        file: "drop-ratio.svg".into(),
        title: "wet over dry drop".into(),
        x: Axis::logarithmic("viscosity η [mPa s]"),
        y: Axis::linear("Δθ wet / Δθ dry"),
        lines,
    };
    plot.has_points().then_some(plot)
}

/// Non-rigid share and drop over √(1/Ga) (Fig. 7).
fn over_galilei(outcomes: &[Outcome]) -> Vec<Plot> {
    let number = |outcome: &Outcome| outcome.result("√(1/Ga)");
    let plot = |file: &str, label: &str, factor: f64, result: &str| {
        let mut lines = by_radius(outcomes, |outcome| {
            Some((number(outcome)?, factor * outcome.result(result)?))
        });
        let highest = lines
            .iter()
            .flat_map(|l| &l.points)
            .map(|p| p.1)
            .fold(0.0, f64::max);
        lines.push(Line {
            name: "Ga = 1".into(),
            points: vec![(1.0, 0.0), (1.0, highest)],
            is_law: true,
        });
        Plot {
            file: file.into(),
            title: format!("{label} over √(1/Ga)"),
            x: Axis::logarithmic("√(1/Ga)"),
            y: Axis::linear(label),
            lines,
        }
    };
    vec![
        plot(
            "flowing-share-galilei.svg",
            "non-rigid share ta/ts",
            1.0,
            "non-rigid share ta/ts",
        ),
        plot("drop-galilei.svg", "drop Δθ [°]", DEGREES, "drop Δθ"),
    ]
}

/// Velocity over depth for each radius (Fig. 4e).
fn profiles(outcomes: &[Outcome]) -> Vec<Plot> {
    let mut plots: BTreeMap<u64, Plot> = BTreeMap::new();
    for outcome in outcomes {
        let radius = radius(outcome);
        let plot = plots.entry((1e6 * radius) as u64).or_insert_with(|| Plot {
            file: format!("velocity-profile-r{radius}mm.svg"),
            title: format!("flowing layer, r = {radius} mm"),
            x: Axis::linear("depth d below the surface [mm]"),
            y: Axis::linear("velocity along the surface, downhill [mm/s]"),
            lines: Vec::new(),
        });
        let profile = &outcome.flow;
        let points = profile.depth.iter().zip(profile.velocity());
        plot.lines.push(Line {
            name: viscosity(outcome)
                .map_or_else(|| outcome.case.name.clone(), |eta| format!("{eta} mPa s")),
            points: points
                .map(|(depth, velocity)| (1e3 * depth, -1e3 * velocity))
                .filter(|(_, velocity)| velocity.is_finite())
                .collect(),
            is_law: false,
        });
    }
    plots.into_values().collect()
}

/// θ(t) and Tg(t) of a case (Fig. 3).
fn courses(outcome: &Outcome) -> [Plot; 2] {
    let name = &outcome.case.name;
    let points = |series: &Series, measure: Measure, factor: f64| {
        let values = series.time().iter().zip(series.column(measure));
        let points = values.map(|(time, value)| (*time, factor * value));
        points
            .filter(|(_, value)| value.is_finite())
            .collect::<Vec<_>>()
    };
    let angle = points(&outcome.series, Measure::SurfaceAngle, DEGREES);
    let temperature: Vec<_> = points(&outcome.series, Measure::GranularTemperature, 1.0)
        .into_iter()
        .filter(|(_, value)| *value > 0.0)
        .collect();
    let end = outcome.series.time().last().copied().unwrap_or(0.0);
    let curve = |points| Line {
        name: name.clone(),
        points,
        is_law: false,
    };
    let threshold = Line {
        name: "2·10⁻⁹ m²/s²".into(),
        points: vec![(0.0, NON_RIGID_TEMPERATURE), (end, NON_RIGID_TEMPERATURE)],
        is_law: true,
    };
    [
        Plot {
            file: format!("courses/{name}-angle.svg"),
            title: format!("surface angle, {name}"),
            x: Axis::linear("time [s]"),
            y: Axis::linear("surface angle θ [°]"),
            lines: vec![curve(angle)],
        },
        Plot {
            file: format!("courses/{name}-temperature.svg"),
            title: format!("granular temperature, {name}"),
            x: Axis::linear("time [s]"),
            y: Axis::logarithmic("granular temperature Tg [m²/s²]"),
            lines: vec![curve(temperature), threshold],
        },
    ]
}
