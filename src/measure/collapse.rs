//! A collapse as a whole: when it was fastest, when it came to rest, what it left.
//!
//! In: the samples of a column. Out: the numbers that Man et al. 2023 quote of each run, to the time between two samples.

use super::{Column, Deposit, DepositShape, Measure, Series, Summary, cone_volume};
use crate::world::World;

/// A column is at rest when the kinetic energy per grain is below this share of its peak and the front no farther from its
/// last place than [`STILL`] of it.
const AT_REST: f64 = 0.01;
const STILL: f64 = 0.01;

/// What the samples of a collapse show so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collapse {
    /// Time of the largest kinetic energy, `t_max` [s].
    pub peak_time: f64,
    /// Largest kinetic energy per grain, translation and rotation [J].
    pub peak_energy: f64,
    /// First time after that with a kinetic energy per grain below 1 % of the peak and the front within 1 % of `R_∞`, `t_f`
    /// [s]; none while it moves.
    pub rest_time: Option<f64>,
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
        let rests = |k: &usize| {
            energy[*k] < AT_REST * energy[peak] && (fronts[*k] - front).abs() <= STILL * front
        };
        Some(Self {
            peak_time: series.time()[peak],
            peak_energy: energy[peak],
            rest_time: (peak..energy.len()).find(rests).map(|k| series.time()[k]),
            front,
            height: last.value(Measure::DepositHeight),
        })
    }
}

/// Kinetic energy per grain at each sample [J].
fn energies(series: &Series) -> Vec<f64> {
    let translation = series.column(Measure::TranslationalEnergy).iter();
    let rotation = series.column(Measure::RotationalEnergy);
    translation.zip(rotation).map(|(t, r)| t + r).collect()
}

impl Summary {
    /// Adds what a `collapse` of `column` gave, the last state of which is `world`.
    pub(super) fn add_collapse(&mut self, world: &World, column: &Column, collapse: &Collapse) {
        self.add_column(column);
        self.add_motion(column, collapse);
        self.add_deposit(world, column, collapse);
    }

    fn add_column(&mut self, column: &Column) {
        let mut pure = |name, value, note| self.add(name, "1", value, note);
        let effective = column.effective_aspect_ratio();
        pure("aspect ratio α", column.aspect_ratio(), "H_i/R_i");
        pure(
            "effective aspect ratio α_eff",
            effective,
            "α √(1/(μ_w + 2 μ_p)), Eq. 1.1 of Man et al. 2023",
        );
        pure(
            "particle friction μ_p",
            column.particle_friction,
            "Σ P_a P_b μ_ab over the shares by number of the species, Eqs. 4.1 and 4.2",
        );
        pure(
            "second share P_2",
            column.second_share,
            "share by number of the second species",
        );
        pure(
            "solid fraction φ_i",
            column.solid_fraction,
            "volume of the grains over that of the column at the start",
        );
        pure(
            "φ_i^0.5 α_eff",
            column.packed_aspect_ratio(),
            "columns of different solid fractions fall together over it, Eq. 4.6",
        );
    }

    fn add_motion(&mut self, column: &Column, collapse: &Collapse) {
        let rest = collapse.rest_time.unwrap_or(f64::NAN);
        let unit = column.time_unit();
        self.add(
            "peak energy",
            "J",
            collapse.peak_energy,
            "largest kinetic energy per grain of the samples, translation and rotation",
        );
        self.add(
            "peak time t_max",
            "s",
            collapse.peak_time,
            "time of the sample with the largest kinetic energy",
        );
        self.add(
            "rest time t_f",
            "s",
            rest,
            "first sample after the peak with a kinetic energy per grain below 1 % of the peak and the front within 1 % of R_∞",
        );
        let note = "over √(R_i/g), Eq. 4.5 of Man et al. 2023";
        self.add("T_max", "1", collapse.peak_time / unit, note);
        self.add("T_f", "1", rest / unit, note);
    }

    fn add_deposit(&mut self, world: &World, column: &Column, collapse: &Collapse) {
        let (front, height) = (collapse.front, collapse.height);
        let front_note = Measure::FrontRadius.quantity().description;
        self.add(
            "front radius R_∞",
            "m",
            front,
            &format!("at the end. {front_note}"),
        );
        self.add("run-out ℛ", "1", column.run_out(front), "(R_∞ − R_i)/R_i");
        let height_note = Measure::DepositHeight.quantity().description;
        self.add(
            "height H_∞",
            "m",
            height,
            &format!("at the end. {height_note}"),
        );
        self.add(
            "H_∞/R_i",
            "1",
            height / column.radius,
            "height over the initial radius",
        );
        self.add(
            "V_cone",
            "m³",
            cone_volume(front, height),
            "(π/3) R_∞² H_∞, Eq. 4.3 of Man et al. 2023",
        );
        self.add(
            "V_cone/V_init",
            "1",
            column.cone_volume_ratio(front, height),
            "volume of the cone over that of the column, π R_i² H_i",
        );
        let profile = Deposit::of(world).map(|deposit| deposit.height_profile());
        let profile = profile.unwrap_or_default();
        self.add(
            "flat radius",
            "m",
            profile.flat_radius(),
            "where the mean profile of height falls below nine tenths of its apex",
        );
        let shape = match profile.shape(front) {
            DepositShape::Cone => 0.0,
            DepositShape::Frustum => 1.0,
        };
        self.add(
            "deposit shape",
            "1",
            shape,
            "1 frustum: the flat radius is larger than a quarter of R_∞; 0 cone",
        );
    }
}
