//! The plots of a sweep of drums, as Figs. 2 to 8 of Kasper et al. 2021: results over viscosity for
//! each radius, with the paper's laws and thresholds drawn in; θ(t) and Tg(t) of each case;
//! velocity profiles. A sweep that varies no liquid has its results over what it does vary. Points
//! are means over the seeds, or single runs, with bars of one standard error.

use super::Sweep;
use super::case::CaseResult;
use super::chart::{ChartAxis, Line, Plot};
use super::ensemble::{Ensemble, ensembles};
use super::variation::Variation;
use super::varied::{axis, shown};
use crate::measure::{
    Estimate, Measure, NON_RIGID_TEMPERATURE, ResultKey, RunQuantity, drop_ratio_law,
};
use crate::scene::SceneGrains;
use std::collections::BTreeMap;

/// Every plot of these outcomes.
pub fn drum_plots(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<Plot> {
    let over = Over::of(sweep, outcomes);
    let ensembles = ensembles(sweep, outcomes);
    let mut plots: Vec<Plot> = RESULTS
        .iter()
        .map(|result| over.plot(result, &ensembles))
        .collect();
    plots.extend(ratios(&ensembles));
    plots.extend(over_galilei(&ensembles));
    plots.extend(profiles(&ensembles));
    let with_course = outcomes.iter().filter(|own| own.has_course());
    plots.extend(with_course.flat_map(courses));
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

const RESULTS: [ResultPlot; 9] = [
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
        "flowing-share-corotating.svg",
        ResultKey::OfRun(RunQuantity::CorotatingShare),
    ),
    linear("flow-speed.svg", ResultKey::OfRun(RunQuantity::FlowSpeed)),
    linear("flow-depth.svg", ResultKey::OfRun(RunQuantity::FlowDepth)),
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
struct Over<'a> {
    /// What is varied, where it is not the liquid.
    varied: Option<&'a Variation>,
    axis: ChartAxis,
}

impl<'a> Over<'a> {
    fn of(sweep: &'a Sweep, outcomes: &[CaseResult]) -> Self {
        let varied = sweep.variations.first();
        if outcomes.iter().any(|outcome| viscosity(outcome).is_some()) || varied.is_none() {
            return Self {
                varied: None,
                axis: ChartAxis::logarithmic("viscosity η [mPa s] (dry at the left edge)"),
            };
        }
        Self {
            varied,
            axis: varied.map_or(ChartAxis::linear(""), axis),
        }
    }

    fn value(&self, outcome: &CaseResult) -> Option<f64> {
        match self.varied {
            Some(varied) => shown(&varied.key, outcome.case.values.first()?),
            None => Some(viscosity(outcome).unwrap_or(DRY)),
        }
    }

    /// The varied key, where it is not that of the liquid.
    fn key(&self) -> &str {
        self.varied.map_or("", |varied| &varied.key)
    }

    fn plot(&self, result: &ResultPlot, ensembles: &[Ensemble]) -> Plot {
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
            lines: by_radius(ensembles, self.key(), |ensemble| {
                let across = self.value(ensemble.first())?;
                Some((across, in_shown_unit(ensemble, result.key)?))
            }),
        }
    }
}

/// The result `key` of an ensemble in the unit that people read.
fn in_shown_unit(ensemble: &Ensemble, key: ResultKey) -> Option<Estimate> {
    Some(
        ensemble
            .estimate(key)?
            .times(key.quantity().unit.shown.factor),
    )
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

/// A line for each radius, and for each value of what else is varied but `across`, through the
/// points of its ensembles in the order of x.
fn by_radius(
    ensembles: &[Ensemble],
    across: &str,
    point: impl Fn(&Ensemble) -> Option<(f64, Estimate)>,
) -> Vec<Line> {
    let [liquid, viscosity, size] = OF_THE_PAPER;
    let mut lines: BTreeMap<(u64, String), Vec<(f64, Estimate)>> = BTreeMap::new();
    for ensemble in ensembles {
        let radius = radius(ensemble.first());
        let apart = ensemble.apart_from(&[liquid, viscosity, size, across]);
        let line = (1e6 * radius) as u64;
        let name = format!("r = {radius} mm{apart}");
        lines
            .entry((line, name))
            .or_default()
            .extend(point(ensemble));
    }
    let lines = lines.into_iter();
    lines
        .map(|((_, name), points)| Line::means(name, points))
        .collect()
}

/// The varied keys that make a line and its points.
const OF_THE_PAPER: [&str; 3] = ["liquid", "viscosity", "radius"];

/// A result of wet drums over that of the dry one with as large grains, over the viscosity.
fn over_dry(ensembles: &[Ensemble], key: ResultKey) -> Vec<Line> {
    let dry = |wet: &CaseResult| {
        let mut dry = ensembles.iter().filter(|e| viscosity(e.first()).is_none());
        dry.find(|e| radius(e.first()) == radius(wet))?
            .estimate(key)
    };
    by_radius(ensembles, "", |ensemble| {
        let viscosity = viscosity(ensemble.first())?;
        let wet = ensemble.estimate(key)?;
        Some((viscosity, wet.over(dry(ensemble.first())?)))
    })
}

/// Wet over dry drop, with Eq. 23 (Fig. 5b), and wet over dry roughness (Fig. 5c).
fn ratios(ensembles: &[Ensemble]) -> Vec<Plot> {
    let plot = |file: &str, title: &str, label: &str, lines| Plot {
        file: file.into(),
        title: title.into(),
        x: ChartAxis::logarithmic("viscosity η [mPa s]"),
        y: ChartAxis::linear(label),
        lines,
    };
    let mut drops = over_dry(ensembles, RunQuantity::Drop.into());
    let law = "0.4 + 0.47 exp(−η/295 mPa s), Eq. 23";
    let law = Line::law(law, 0.5, 2000.0, |eta| drop_ratio_law(1e-3 * eta));
    drops.push(law);
    let roughness = over_dry(ensembles, Measure::SurfaceRoughness.into());
    vec![
        plot(
            "drop-ratio.svg",
            "wet over dry drop",
            "Δθ wet / Δθ dry",
            drops,
        ),
        plot(
            "roughness-ratio.svg",
            "wet over dry roughness of the surface",
            "h wet / h dry",
            roughness,
        ),
    ]
}

/// Non-rigid share and drop over √(1/Ga) (Fig. 7).
fn over_galilei(ensembles: &[Ensemble]) -> Vec<Plot> {
    let across = RunQuantity::InverseRootGalilei;
    let plot = |file: &str, quantity: RunQuantity| {
        let mut lines = by_radius(ensembles, "", |ensemble| {
            let value = in_shown_unit(ensemble, quantity.into())?;
            Some((ensemble.mean(across)?, value))
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
            ..Line::default()
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
        plot(
            "flowing-share-corotating-galilei.svg",
            RunQuantity::CorotatingShare,
        ),
        plot("drop-galilei.svg", RunQuantity::Drop),
    ]
}

/// Velocity over depth for each radius (Fig. 4e).
fn profiles(ensembles: &[Ensemble]) -> Vec<Plot> {
    let mut plots: BTreeMap<u64, Plot> = BTreeMap::new();
    let has_course = |own: &&Ensemble| own.members.iter().any(|member| member.has_course());
    let is_any_wet = ensembles.iter().any(|own| viscosity(own.first()).is_some());
    for ensemble in ensembles.iter().filter(has_course) {
        let outcome = ensemble.first();
        let radius = radius(outcome);
        let plot = plots.entry((1e6 * radius) as u64).or_insert_with(|| Plot {
            file: format!("velocity-profile-r{radius}mm.svg"),
            title: format!("flowing layer, r = {radius} mm"),
            x: ChartAxis::linear("depth d below the surface [mm]"),
            y: ChartAxis::linear("velocity along the surface, downhill [mm/s]"),
            lines: Vec::new(),
        });
        let apart = ensemble.apart_from(&OF_THE_PAPER);
        let name = match viscosity(outcome) {
            Some(eta) => format!("{eta} mPa s{apart}"),
            None if is_any_wet => format!("dry{apart}"),
            None => ensemble.name(),
        };
        plot.lines.push(Line::means(name, profile(ensemble)));
    }
    plots.into_values().collect()
}

/// Velocity downhill [mm/s] over depth [mm], each a mean over the members that flowed there for at
/// least half of the time that they did at the surface.
fn profile(ensemble: &Ensemble) -> Vec<(f64, Estimate)> {
    let members = ensemble.members.iter().map(|member| &member.flow);
    let longest = members.clone().max_by_key(|flow| flow.len());
    let depths = longest.map_or(&[][..], Vec::as_slice);
    let at = |(k, (depth, _)): (usize, &(f64, Estimate))| {
        let means = members.clone().filter_map(|flow| {
            let (own, surface) = (flow.get(k)?.1, flow.first()?.1);
            (2 * own.samples >= surface.samples).then_some(own)
        });
        let finite: Vec<Estimate> = means.filter(|velocity| velocity.mean.is_finite()).collect();
        (1e3 * depth, Estimate::of_seeds(&finite).times(-1e3))
    };
    depths.iter().enumerate().map(at).collect()
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
    let end = outcome.series.time().last().copied().unwrap_or(0.0);
    let curve = |name: &str, points| Line {
        name: name.to_owned(),
        points,
        ..Line::default()
    };
    let temperature = |name: &str, measure| {
        let mut points = points(measure);
        points.retain(|(_, value)| *value > 0.0);
        curve(name, points)
    };
    let threshold = Line {
        name: "2·10⁻⁹ m²/s²".into(),
        points: vec![(0.0, NON_RIGID_TEMPERATURE), (end, NON_RIGID_TEMPERATURE)],
        is_law: true,
        ..Line::default()
    };
    [
        Plot {
            file: format!("courses/{name}-angle.svg"),
            title: format!("surface angle, {name}"),
            x: ChartAxis::linear("time [s]"),
            y: ChartAxis::linear(&Measure::SurfaceAngle.quantity().axis()),
            lines: vec![curve(name, angle)],
        },
        Plot {
            file: format!("courses/{name}-temperature.svg"),
            title: format!("granular temperature, {name}"),
            x: ChartAxis::linear("time [s]"),
            y: ChartAxis::logarithmic(&Measure::GranularTemperature.quantity().axis()),
            lines: vec![
                temperature("Tg, the paper's", Measure::GranularTemperature),
                temperature("Tg′, in the drum's frame", Measure::CorotatingTemperature),
                threshold,
            ],
        },
    ]
}
