//! A collapse as a whole: when it was fastest, when it came to rest, what it left.
//!
//! In: the samples of a column. Out: times, energies and lengths, exact to the time between two
//! samples. What the papers make of them stands in `column_summary`.

use super::sampled_quantity::Measure;
use super::series::Series;

/// A column is at rest when the kinetic energy per grain is below this share of its peak and the
/// front no farther from its last place than [`STILL`] of it.
const AT_REST: f64 = 0.01;
const STILL: f64 = 0.01;
/// For how long, as a share of `t_f`, a column has been at rest when that is believed: a front that
/// creeps on moves its last place, and with it the time at which it was near it.
const BELIEVED: f64 = 0.25;

/// What the samples of a collapse show so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collapse {
    /// Time of the largest kinetic energy, `t_max` [s].
    pub peak_time: f64,
    /// Largest kinetic energy per grain, translation and rotation [J].
    pub peak_energy: f64,
    /// First time after that with a kinetic energy per grain below 1 % of the peak and the front
    /// within 1 % of `R_∞`, `t_f` [s]; none while it moves.
    pub rest_time: Option<f64>,
    /// The same by the energy alone [s].
    pub energy_rest_time: Option<f64>,
    /// The same by the front alone [s].
    pub front_rest_time: Option<f64>,
    /// Radius of the front in the last sample, `R_∞` of a column at rest [m].
    pub front: f64,
    /// Height in the last sample, `H_∞` of a column at rest [m].
    pub height: f64,
}

impl Collapse {
    /// The collapse whose samples `series` holds; none where they are no column's.
    pub fn of(series: &Series) -> Option<Self> {
        let last = series.last()?;
        let front = last.value(Measure::FrontRadius);
        if front.is_nan() {
            return None;
        }
        let energy = energies(series);
        let peak =
            (0..energy.len()).reduce(|best, k| if energy[k] > energy[best] { k } else { best })?;
        let fronts = series.column(Measure::FrontRadius);
        let is_slow = |k: &usize| energy[*k] < AT_REST * energy[peak];
        let is_there = |k: &usize| (fronts[*k] - front).abs() <= STILL * front;
        let first = |is: &dyn Fn(&usize) -> bool| {
            let found = (peak..energy.len()).find(is);
            found.map(|k| series.time()[k])
        };
        Some(Self {
            peak_time: series.time()[peak],
            peak_energy: energy[peak],
            rest_time: first(&|k| is_slow(k) && is_there(k)),
            energy_rest_time: first(&is_slow),
            front_rest_time: first(&is_there),
            front,
            height: last.value(Measure::DepositHeight),
        })
    }

    /// Whether nothing more is to come of it `now` [s], at the last sample.
    pub fn is_over(&self, now: f64) -> bool {
        self.rest_time
            .is_some_and(|rest| now >= (1.0 + BELIEVED) * rest)
    }
}

/// Kinetic energy per grain at each sample [J].
fn energies(series: &Series) -> Vec<f64> {
    let translation = series.column(Measure::TranslationalEnergy).iter();
    let rotation = series.column(Measure::RotationalEnergy);
    translation.zip(rotation).map(|(t, r)| t + r).collect()
}
