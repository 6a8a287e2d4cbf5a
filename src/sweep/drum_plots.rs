//! The plots of a sweep of drums, as Figs. 2 to 8 of Kasper et al. 2021: results over viscosity for
//! each radius, with the paper's laws and thresholds drawn in; θ(t) and Tg(t) of each case;
//! velocity profiles. A sweep that varies no liquid has its results over what it does vary.

use super::Sweep;
use super::case::CaseResult;
use super::chart::{ChartAxis, Line, Plot};
use crate::measure::{Measure, NON_RIGID_TEMPERATURE, ResultKey, RunQuantity, drop_ratio_law};
use crate::scene::SceneGrains;
use std::collections::BTreeMap;

/// Every plot of these outcomes.
pub fn drum_plots(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<Plot> {
    let over = Over::of(sweep, outcomes);
    let mut plots: Vec<Plot> = RESULTS
        .iter()
        .map(|result| over.plot(result, outcomes))
        .collect();
    plots.extend(drop_ratios(outcomes));
    plots.extend(over_galilei(outcomes));
    plots.extend(profiles(outcomes));
    plots.extend(outcomes.iter().flat_map(courses));
    plots
}

/// A result that has a plot of its own: its file and whether the axis goes by powers of ten.
struct ResultPlot {
    file: &'static str,
    key: ResultKey,
    is_logarithmic: bool,
}

const fn linear(file: &'static str, key: ResultKey) -> ResultPlot {
    ResultPlot {
        file,
        key,
        is_logarithmic: false,
    }
}

const RESULTS: [ResultPlot; 6] = [
    linear(
        "surface-angle.svg",
        ResultKey::OfSamples(Measure::SurfaceAngle),
    ),
    linear("drop.svg", ResultKey::OfRun(RunQuantity::Drop)),
    ResultPlot {
        file: "granular-temperature.svg",
        key: ResultKey::OfSamples(Measure::GranularTemperature),
        is_logarithmic: true,
    },
    linear(
        "flowing-share.svg",
        ResultKey::OfRun(RunQuantity::NonRigidShare),
    ),
    linear(
        "packing-fraction.svg",
        ResultKey::OfSamples(Measure::PackingFraction),
    ),
    linear(
        "surface-roughness.svg",
        ResultKey::OfSamples(Measure::SurfaceRoughness),
    ),
];

/// What results are plotted over.
struct Over {
    axis: ChartAxis,
    value: fn(&CaseResult) -> Option<f64>,
}

impl Over {
    fn of(sweep: &Sweep, outcomes: &[CaseResult]) -> Self {
        if outcomes.iter().any(|outcome| viscosity(outcome).is_some()) {
            return Self {
                axis: ChartAxis::logarithmic("viscosity η [mPa s] (dry at the left edge)"),
                value: |outcome| Some(viscosity(outcome).unwrap_or(DRY)),
            };
        }
        let key = sweep
            .variations
            .first()
            .map_or("", |variation| &variation.key);
        Self {
            axis: ChartAxis::linear(key),
            value: |outcome| leading_number(outcome.case.values.first()?),
        }
    }

    fn plot(&self, result: &ResultPlot, outcomes: &[CaseResult]) -> Plot {
        let label = result.key.quantity().axis();
        Plot {
            file: result.file.to_owned(),
            x: self.axis.clone(),
            y: if result.is_logarithmic {
                ChartAxis::logarithmic(&label)
            } else {
                ChartAxis::linear(&label)
            },
            title: label,
            lines: by_radius(outcomes, |outcome| {
                Some(((self.value)(outcome)?, in_shown_unit(outcome, result.key)?))
            }),
        }
    }
}

/// The result `key` of a case in the unit that people read.
fn in_shown_unit(outcome: &CaseResult, key: ResultKey) -> Option<f64> {
    Some(key.quantity().unit.shown.factor * outcome.result(key)?)
}

/// Where dry drums stand on an axis of viscosities [mPa s].
const DRY: f64 = 0.3;

/// Viscosity of a case's liquid [mPa s].
fn viscosity(outcome: &CaseResult) -> Option<f64> {
    Some(1e3 * outcome.case.scene.liquid.as_ref()?.viscosity)
}

/// Radius of a case's first species, half a lattice cell where it is one of Voronoi cells [mm].
fn radius(outcome: &CaseResult) -> f64 {
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
fn by_radius(
    outcomes: &[CaseResult],
    point: impl Fn(&CaseResult) -> Option<(f64, f64)>,
) -> Vec<Line> {
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
fn drop_ratios(outcomes: &[CaseResult]) -> Option<Plot> {
    let dry = |wet: &CaseResult| {
        let mut dry = outcomes.iter().filter(|o| viscosity(o).is_none());
        dry.find(|o| radius(o) == radius(wet))?
            .result(RunQuantity::Drop)
    };
    let mut lines = by_radius(outcomes, |outcome| {
        Some((
            viscosity(outcome)?,
            outcome.result(RunQuantity::Drop)? / dry(outcome)?,
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
        x: ChartAxis::logarithmic("viscosity η [mPa s]"),
        y: ChartAxis::linear("Δθ wet / Δθ dry"),
        lines,
    };
    plot.has_points().then_some(plot)
}

/// Non-rigid share and drop over √(1/Ga) (Fig. 7).
fn over_galilei(outcomes: &[CaseResult]) -> Vec<Plot> {
    let across = RunQuantity::InverseRootGalilei;
    let plot = |file: &str, quantity: RunQuantity| {
        let mut lines = by_radius(outcomes, |outcome| {
            let value = in_shown_unit(outcome, quantity.into())?;
            Some((outcome.result(across)?, value))
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
        let (label, across) = (quantity.quantity().axis(), across.quantity().axis());
        Plot {
            file: file.into(),
            title: format!("{label} over {across}"),
            x: ChartAxis::logarithmic(&across),
            y: ChartAxis::linear(&label),
            lines,
        }
    };
    vec![
        plot("flowing-share-galilei.svg", RunQuantity::NonRigidShare),
        plot("drop-galilei.svg", RunQuantity::Drop),
    ]
}

/// Velocity over depth for each radius (Fig. 4e).
fn profiles(outcomes: &[CaseResult]) -> Vec<Plot> {
    let mut plots: BTreeMap<u64, Plot> = BTreeMap::new();
    for outcome in outcomes {
        let radius = radius(outcome);
        let plot = plots.entry((1e6 * radius) as u64).or_insert_with(|| Plot {
            file: format!("velocity-profile-r{radius}mm.svg"),
            title: format!("flowing layer, r = {radius} mm"),
            x: ChartAxis::linear("depth d below the surface [mm]"),
            y: ChartAxis::linear("velocity along the surface, downhill [mm/s]"),
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
fn courses(outcome: &CaseResult) -> [Plot; 2] {
    let name = &outcome.case.name;
    let points = |measure: Measure| {
        let factor = measure.quantity().unit.shown.factor;
        let series = &outcome.series;
        let values = series.time().iter().zip(series.column(measure));
        values
            .map(|(time, value)| (*time, factor * value))
            .filter(|(_, value)| value.is_finite())
            .collect::<Vec<_>>()
    };
    let angle = points(Measure::SurfaceAngle);
    let mut temperature = points(Measure::GranularTemperature);
    temperature.retain(|(_, value)| *value > 0.0);
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
            x: ChartAxis::linear("time [s]"),
            y: ChartAxis::linear(&Measure::SurfaceAngle.quantity().axis()),
            lines: vec![curve(angle)],
        },
        Plot {
            file: format!("courses/{name}-temperature.svg"),
            title: format!("granular temperature, {name}"),
            x: ChartAxis::linear("time [s]"),
            y: ChartAxis::logarithmic(&Measure::GranularTemperature.quantity().axis()),
            lines: vec![curve(temperature), threshold],
        },
    ]
}
