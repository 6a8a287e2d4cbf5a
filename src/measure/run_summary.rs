//! Results of a run, as the papers quote them: of a bed, averages over the last part of it; of a
//! column, what it did and left.
//!
//! In: a [`Series`] and the flow of the same run, its last state, and the time from which the results
//! of a bed count.
//! Out: a [`Summary`].

use super::avalanches::Avalanche;
use super::collapse::Collapse;
use super::column::InitialColumn;
use super::estimate::Estimate;
use super::flow::{FlowHistory, NON_RIGID_TEMPERATURE};
use super::quantity::MeasuredValue;
use super::result_key::{DropThreshold, ResultKey};
use super::run_quantity::RunQuantity;
use super::sampled_quantity::Measure;
use super::series::Series;
use super::summary::{Summary, usual_note};
use super::temperature::rotation_temperature;
use super::wet_bed::{capillary_number, galilei_number};
use super::window::{Window, largest, median};
use crate::world::World;

/// Share of a run, from its start, that its results leave out: Kasper et al. 2021 average over the
/// last 30 of 50 s.
pub const LEFT_OUT: f64 = 0.4;

/// The measures of which a bed's results give the mean.
const MEANS: [Measure; 11] = [
    Measure::SurfaceAngle,
    Measure::GranularTemperature,
    Measure::CorotatingTemperature,
    Measure::PackingFraction,
    Measure::CoordinationNumber,
    Measure::MeanSpeed,
    Measure::SurfaceRoughness,
    Measure::SurfaceCurvature,
    Measure::Bridges,
    Measure::DrumTorque,
    Measure::MixingIndex,
];

/// What the results of a column take from its last sample.
const COLUMN_AT_END: [Measure; 11] = [
    Measure::FrontRadius99,
    Measure::FrontRadius95,
    Measure::ClusterRadius,
    Measure::ApexHeight,
    Measure::FirstPairs,
    Measure::MixedPairs,
    Measure::SecondPairs,
    Measure::CoordinationNumber,
    Measure::MixingIndex,
    Measure::FloorForce,
    Measure::Weight,
];

/// The terms of the energy balance that a residual is compared with.
const TURNOVER: [Measure; 7] = [
    Measure::KineticEnergy,
    Measure::ElasticEnergy,
    Measure::GravityWork,
    Measure::WallWork,
    Measure::DashpotLoss,
    Measure::SlidingLoss,
    Measure::RollingLoss,
];

/// Results of a run of which `series` holds the samples, `flow` how its bed flowed and `world` the last
/// state. A column's begin at its release; a bed's count from `from_time` [s] on, with avalanches of
/// at least `smallest_drop` [rad].
pub fn results(
    series: &Series,
    flow: &FlowHistory,
    world: &World,
    from_time: f64,
    smallest_drop: f64,
) -> Summary {
    let column = InitialColumn::of(world).zip(Collapse::of(series));
    let Some((column, collapse)) = column else {
        let mut summary = summarise(series, from_time, smallest_drop);
        add_layer(&mut summary, flow);
        add_case(&mut summary, world);
        return summary;
    };
    let window = Window::of(series, 0.0);
    let mut summary = window.summary(0.0);
    summary.add_collapse(world, &column, &collapse);
    for measure in COLUMN_AT_END {
        let note = format!("at the end. {}", measure.quantity().explanation());
        summary.add_noted(measure, window.at_end(measure), note);
    }
    add_overlap(&mut summary, &window);
    add_energies(&mut summary, &window);
    summary
}

/// Results of the part of `series` from `from_time` [s] on, with avalanches of at least
/// `smallest_drop` [rad].
pub fn summarise(series: &Series, from_time: f64, smallest_drop: f64) -> Summary {
    let window = Window::of(series, from_time);
    let mut summary = window.summary(from_time);
    let found = window.avalanches(smallest_drop);
    add_means(&mut summary, &window);
    add_flow(&mut summary, &window, &found);
    add_avalanches(&mut summary, &found, ResultKey::OfRun);
    for threshold in DropThreshold::ALL {
        let found = window.avalanches(threshold.angle());
        add_avalanches(&mut summary, &found, |quantity| {
            ResultKey::OfAvalanches(quantity, threshold)
        });
    }
    add_energies(&mut summary, &window);
    summary
}

/// Adds how fast the bed flowed in the time that the results count, and how deep.
fn add_layer(summary: &mut Summary, flow: &FlowHistory) {
    let nothing = Estimate::too_short(f64::NAN, 0);
    let layer = flow.layer_between(summary.from, summary.to);
    let speed = layer.map_or(nothing, |layer| layer.speed);
    let depth = layer.and_then(|layer| layer.depth).unwrap_or(nothing);
    summary.add_mean(RunQuantity::FlowSpeed, speed);
    summary.add_mean(RunQuantity::FlowDepth, depth);
}

/// Adds what depends on the drum and its liquid alone, and the regime that the results show.
fn add_case(summary: &mut Summary, world: &World) {
    let or_nan = |number: Option<f64>| number.unwrap_or(f64::NAN);
    summary.add(
        RunQuantity::CapillaryNumber,
        or_nan(capillary_number(world)),
    );
    summary.add(RunQuantity::GalileiNumber, or_nan(galilei_number(world)));
    let rotation = rotation_temperature(world);
    let key = ResultKey::from(RunQuantity::RotationTemperature);
    summary.add_noted(key, rotation, usual_note(key, Some(rotation.into())));
    let regime = summary.regime();
    let word = regime.map(|regime| MeasuredValue::Choice(regime.word()));
    summary.add_value(RunQuantity::Regime, word);
}

fn add_means(summary: &mut Summary, window: &Window) {
    for measure in MEANS {
        let note = "mean over the samples of the window, its error by slow waves".to_owned();
        summary.add_noted_mean(measure, window.mean(measure), note);
    }
    let ruptures = window.rate(Measure::Ruptures);
    summary.add_mean(RunQuantity::RupturesPerSecond, ruptures);
    summary.add_mean(RunQuantity::DrumPower, window.rate(Measure::WallWork));
    add_overlap(summary, window);
}

fn add_overlap(summary: &mut Summary, window: &Window) {
    let overlap = largest(window.column(Measure::LargestOverlap));
    let note = "largest of the samples of the window".to_owned();
    summary.add_noted(Measure::LargestOverlap, overlap, note);
}

fn add_flow(summary: &mut Summary, window: &Window, found: &[Avalanche]) {
    let falling = window.falling(found);
    let temperature = window.column(Measure::GranularTemperature);
    for (key, measure) in [
        (RunQuantity::NonRigidShare, Measure::GranularTemperature),
        (RunQuantity::CorotatingShare, Measure::CorotatingTemperature),
    ] {
        summary.add_mean(key, window.share_from(measure, NON_RIGID_TEMPERATURE));
    }
    let hot = window.mean_in(found, Measure::GranularTemperature);
    summary.add_mean(RunQuantity::TemperatureInAvalanches, hot);
    let between = temperature
        .iter()
        .zip(&falling)
        .filter(|(_, falls)| !**falls);
    let quiet = median(between.map(|(value, _)| *value).collect());
    summary.add(RunQuantity::TemperatureBetweenAvalanches, quiet);
    let rate = median(window.rise_rates(&falling));
    summary.add(RunQuantity::RiseRate, rate);
}

/// Adds the numbers of the avalanches `found`, under the keys that `key` gives them.
fn add_avalanches(
    summary: &mut Summary,
    found: &[Avalanche],
    key: impl Fn(RunQuantity) -> ResultKey,
) {
    let of = |value: fn(&Avalanche) -> f64| {
        Estimate::of_events(&found.iter().map(value).collect::<Vec<_>>())
    };
    let waits = found.windows(2).map(|pair| pair[1].start - pair[0].start);
    let period = Estimate::of_events(&waits.collect::<Vec<_>>());
    let count = MeasuredValue::Count(found.len());
    summary.add_value(key(RunQuantity::Avalanches), Some(count));
    summary.add_mean(key(RunQuantity::MaximumAngle), of(|a| a.theta_m));
    summary.add_mean(key(RunQuantity::ReposeAngle), of(|a| a.theta_r));
    summary.add_mean(key(RunQuantity::Drop), of(Avalanche::drop));
    summary.add_mean(key(RunQuantity::Period), period);
}

fn add_energies(summary: &mut Summary, window: &Window) {
    for measure in TURNOVER.into_iter().chain([
        Measure::ViscousLoss,
        Measure::CapillaryLoss,
        Measure::EnergyResidual,
    ]) {
        let note = "at the end, since the start of the run".to_owned();
        summary.add_noted(measure, window.at_end(measure), note);
    }
    let turnover = largest(&TURNOVER.map(|term| window.at_end(term).abs()));
    let residual = window.at_end(Measure::EnergyResidual) / turnover;
    summary.add(RunQuantity::RelativeEnergyResidual, residual);
}
