//! Results of a run, as the papers quote them: of a bed, averages over the last part of it; of a column, what it did and left.
//!
//! In: a [`Series`] and the time from which it counts. Out: named values, each with its unit and how it was taken.

use super::{
    Avalanche, Collapse, Column, Measure, SMOOTHING_TIME, Series, avalanches, capillary_number,
    galilei_number,
};
use crate::world::World;
use serde::Serialize;

/// Granular temperature from which a bed counts as flowing [m²/s²] (Kasper et al. 2021).
pub const NON_RIGID_TEMPERATURE: f64 = 2e-9;

/// Smallest drops for which avalanches are quoted [rad]: 0.5°, 1°, 2°, 3°.
pub const SMALLEST_DROPS: [f64; 4] = [0.5 * DEGREE, 1.0 * DEGREE, 2.0 * DEGREE, 3.0 * DEGREE];

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Time over which the slope of a rise is taken [s].
const SLOPE_TIME: f64 = 0.2;

/// What the results of a column take from its last sample.
const COLUMN_AT_END: [Measure; 8] = [
    Measure::FrontRadius99,
    Measure::FrontRadius95,
    Measure::ClusterRadius,
    Measure::ApexHeight,
    Measure::FirstPairs,
    Measure::MixedPairs,
    Measure::SecondPairs,
    Measure::CoordinationNumber,
];

/// One result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SummaryEntry {
    /// What it is.
    pub name: String,
    /// SI unit, `1` for a pure number.
    pub unit: &'static str,
    /// Its value; none where there is nothing to average.
    pub value: Option<f64>,
    /// How it was taken.
    pub note: String,
}

/// Results of a window of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Time of the first sample that counts [s].
    pub from: f64,
    /// Time of the last sample [s].
    pub to: f64,
    /// Number of samples that count.
    pub samples: usize,
    /// The results.
    pub entries: Vec<SummaryEntry>,
}

impl Summary {
    /// The value of the entry called `name`, if there is one and it is defined.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.entries
            .iter()
            .find(|entry| entry.name == name)
            .and_then(|entry| entry.value)
    }

    pub(super) fn add(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        value: f64,
        note: &str,
    ) {
        self.entries.push(SummaryEntry {
            name: name.into(),
            unit,
            value: value.is_finite().then_some(value),
            note: note.into(),
        });
    }
}

impl Summary {
    /// Adds what depends on the drum and its liquid alone, and the regime that the results show.
    fn add_case(&mut self, world: &World) {
        self.add(
            "capillary number Ca",
            "1",
            capillary_number(world).unwrap_or(f64::NAN),
            "η √(4 g r)/(γ cos α), Eq. 1 of Kasper et al. 2021",
        );
        self.add(
            "Galilei number Ga",
            "1",
            galilei_number(world).unwrap_or(f64::NAN),
            "ρ² g r³/η², Eq. 25",
        );
        let regime = self
            .regime()
            .map_or(f64::NAN, |regime| f64::from(regime as u8));
        self.add(
            "regime",
            "1",
            regime,
            "0 avalanching: ta/ts below 0.9; 2 continuous: ta/ts at least 0.99 and drops below 2.5°; 1 between",
        );
    }

    /// How the bed moves, by the shares and drops of the paper.
    pub fn regime(&self) -> Option<Regime> {
        let flowing = self.value("non-rigid share ta/ts")?;
        let drop = self.value("drop Δθ").unwrap_or(0.0);
        Some(if flowing < 0.9 {
            Regime::Avalanching
        } else if flowing >= 0.99 && drop < 2.5 * DEGREE {
            Regime::Continuous
        } else {
            Regime::Transitional
        })
    }
}

/// How a bed moves in a drum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Regime {
    /// It rests between avalanches.
    Avalanching,
    /// It hardly rests.
    Transitional,
    /// It flows all the time, without large drops.
    Continuous,
}

/// Results of a run of which `series` holds the samples and `world` the last state. A column's begin at its release; a bed's
/// count from `from_time` [s] on, with avalanches of at least `smallest_drop` [rad].
pub fn results(series: &Series, world: &World, from_time: f64, smallest_drop: f64) -> Summary {
    let column = Column::of(world).zip(Collapse::of(series));
    let Some((column, collapse)) = column else {
        let mut summary = summarise(series, from_time, smallest_drop);
        summary.add_case(world);
        return summary;
    };
    let window = Window::of(series, 0.0);
    let mut summary = window.summary(0.0);
    summary.add_collapse(world, &column, &collapse);
    add_last(&mut summary, &window, &COLUMN_AT_END);
    add_overlap(&mut summary, &window);
    add_energies(&mut summary, &window);
    summary
}

/// Results of the part of `series` from `from_time` [s] on, with avalanches of at least `smallest_drop` [rad].
pub fn summarise(series: &Series, from_time: f64, smallest_drop: f64) -> Summary {
    let window = Window::of(series, from_time);
    let mut summary = window.summary(from_time);
    let found = window.avalanches(smallest_drop);
    add_means(&mut summary, &window);
    add_flow(&mut summary, &window, &found);
    add_avalanches(&mut summary, &found, "");
    for drop in SMALLEST_DROPS {
        let suffix = format!(" (≥ {}°)", drop / DEGREE);
        add_avalanches(&mut summary, &window.avalanches(drop), &suffix);
    }
    add_energies(&mut summary, &window);
    summary
}

/// The samples that count.
struct Window<'a> {
    series: &'a Series,
    first: usize,
    time: &'a [f64],
}

impl<'a> Window<'a> {
    fn of(series: &'a Series, from_time: f64) -> Self {
        let first = series.first_at(from_time);
        Self {
            series,
            first,
            time: &series.time()[first..],
        }
    }

    /// A summary of these samples without entries.
    fn summary(&self, from_time: f64) -> Summary {
        Summary {
            from: self.time.first().copied().unwrap_or(from_time),
            to: self.time.last().copied().unwrap_or(from_time),
            samples: self.time.len(),
            entries: Vec::new(),
        }
    }

    fn at_end(&self, measure: Measure) -> f64 {
        self.column(measure).last().copied().unwrap_or(f64::NAN)
    }

    fn column(&self, measure: Measure) -> &'a [f64] {
        &self.series.column(measure)[self.first..]
    }

    /// Change of a measure over the window per second; NaN where it has no length.
    fn rate(&self, measure: Measure) -> f64 {
        let values = self.column(measure);
        match (values, self.time) {
            ([first, .., last], [from, .., to]) => (last - first) / (to - from),
            _ => f64::NAN,
        }
    }

    fn avalanches(&self, smallest_drop: f64) -> Vec<Avalanche> {
        avalanches(self.time, self.column(Measure::SurfaceAngle), smallest_drop)
    }

    /// For each sample, whether θ falls there in one of `falls` (widened by the smoothing).
    fn falling(&self, falls: &[Avalanche]) -> Vec<bool> {
        let margin = 0.5 * SMOOTHING_TIME;
        let mut next = falls.iter().peekable();
        self.time
            .iter()
            .map(|&t| {
                while next.next_if(|fall| fall.end + margin < t).is_some() {}
                next.peek().is_some_and(|fall| fall.start - margin <= t)
            })
            .collect()
    }

    /// Slopes of θ over [`SLOPE_TIME`] at each sample that stands, for that time, in one rise [rad/s].
    fn rise_rates(&self, falling: &[bool]) -> Vec<f64> {
        let theta = self.column(Measure::SurfaceAngle);
        let mut rates = Vec::new();
        let mut start = 0;
        let mut rise_start = 0;
        for (end, &t) in self.time.iter().enumerate() {
            if falling[end] {
                rise_start = end + 1;
                continue;
            }
            start = rise_start.max(start);
            while start + 1 < end && t - self.time[start + 1] >= SLOPE_TIME - 1e-9 {
                start += 1;
            }
            let span = t - self.time[start];
            if span >= SLOPE_TIME - 1e-9 {
                rates.push((theta[end] - theta[start]) / span);
            }
        }
        rates
    }
}

fn add_means(summary: &mut Summary, window: &Window) {
    let mut add = |measure: Measure, note: &str| {
        let quantity = measure.quantity();
        summary.add(
            quantity.name,
            quantity.unit,
            mean(window.column(measure)),
            note,
        );
    };
    let note = "mean over the samples of the window";
    add(Measure::SurfaceAngle, note);
    add(Measure::GranularTemperature, note);
    add(Measure::CorotatingTemperature, note);
    add(Measure::PackingFraction, note);
    add(Measure::CoordinationNumber, note);
    add(Measure::MeanSpeed, note);
    add(Measure::SurfaceRoughness, note);
    add(Measure::SurfaceCurvature, note);
    add(Measure::Bridges, note);
    add(Measure::DrumTorque, note);
    summary.add(
        "ruptures per second",
        "1/s",
        window.rate(Measure::Ruptures),
        "liquid bridges that broke over the window, per second",
    );
    summary.add(
        "drum power",
        "W",
        window.rate(Measure::WallWork),
        "work of the moving walls over the window, per second",
    );
    add_overlap(summary, window);
}

fn add_overlap(summary: &mut Summary, window: &Window) {
    let overlap = window.column(Measure::LargestOverlap);
    summary.add(
        Measure::LargestOverlap.quantity().name,
        "1",
        largest(overlap),
        "largest of the samples of the window",
    );
}

/// What the last sample holds.
fn add_last(summary: &mut Summary, window: &Window, measures: &[Measure]) {
    for measure in measures {
        let quantity = measure.quantity();
        let note = format!("at the end. {}", quantity.description);
        summary.add(quantity.name, quantity.unit, window.at_end(*measure), &note);
    }
}

fn add_flow(summary: &mut Summary, window: &Window, found: &[Avalanche]) {
    let falling = window.falling(found);
    let temperature = window.column(Measure::GranularTemperature);
    let during = |state: bool| -> Vec<f64> {
        let chosen = temperature.iter().zip(&falling);
        chosen
            .filter(|(_, falls)| **falls == state)
            .map(|(value, _)| *value)
            .collect()
    };
    summary.add(
        "non-rigid share ta/ts",
        "1",
        share_from(temperature, NON_RIGID_TEMPERATURE),
        "share of the samples whose granular temperature (laboratory frame) is at least 2e-9 m²/s²",
    );
    summary.add(
        "granular temperature in avalanches",
        "m²/s²",
        mean(&during(true)),
        "mean over the samples in which the surface angle falls",
    );
    summary.add(
        "granular temperature between avalanches",
        "m²/s²",
        median(during(false)),
        "median of the other samples",
    );
    summary.add(
        "rise rate",
        "rad/s",
        median(window.rise_rates(&falling)),
        "median slope of the surface angle over 0.2 s between avalanches; the drum speed where the bed turns rigidly",
    );
}

fn add_avalanches(summary: &mut Summary, found: &[Avalanche], suffix: &str) {
    let mut add = |name: &str, unit, value, note| {
        summary.add(format!("{name}{suffix}"), unit, value, note);
    };
    let of = |value: fn(&Avalanche) -> f64| mean(&found.iter().map(value).collect::<Vec<_>>());
    let note = "mean over the avalanches, surface angle smoothed over 0.1 s";
    add(
        "avalanches",
        "1",
        found.len() as f64,
        "number of complete avalanches in the window",
    );
    add("maximum angle θ_m", "rad", of(|a| a.theta_m), note);
    add("repose angle θ_r", "rad", of(|a| a.theta_r), note);
    add("drop Δθ", "rad", of(Avalanche::drop), note);
}

fn add_energies(summary: &mut Summary, window: &Window) {
    let terms = [
        Measure::KineticEnergy,
        Measure::ElasticEnergy,
        Measure::GravityWork,
        Measure::WallWork,
        Measure::DashpotLoss,
        Measure::SlidingLoss,
        Measure::RollingLoss,
    ];
    for measure in terms.into_iter().chain([
        Measure::ViscousLoss,
        Measure::CapillaryLoss,
        Measure::EnergyResidual,
    ]) {
        let quantity = measure.quantity();
        let note = "at the end, since the start of the run";
        summary.add(quantity.name, quantity.unit, window.at_end(measure), note);
    }
    let turnover = largest(&terms.map(|term| window.at_end(term).abs()));
    summary.add(
        "relative energy residual",
        "1",
        window.at_end(Measure::EnergyResidual) / turnover,
        "energy residual at the end relative to the largest term of the balance",
    );
}

/// Mean of the finite values; NaN without any.
fn mean(values: &[f64]) -> f64 {
    let (sum, count) = values
        .iter()
        .filter(|value| value.is_finite())
        .fold((0.0, 0_u32), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count)
}

/// Median of the finite values; NaN without any.
fn median(mut values: Vec<f64>) -> f64 {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

/// Largest of the finite values; NaN without any.
fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NAN, f64::max)
}

/// Share of the finite values that are at least `threshold`; NaN without any.
fn share_from(values: &[f64], threshold: f64) -> f64 {
    let finite = values.iter().filter(|value| value.is_finite());
    let above = finite.clone().filter(|value| **value >= threshold).count();
    above as f64 / finite.count() as f64
}
