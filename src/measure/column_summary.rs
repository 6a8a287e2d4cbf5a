//! The results of a column that collapsed, as Man et al. 2023 quote them of each run.
//!
//! In: the column at the start, what its samples show, its last state. Out: entries of a
//! [`Summary`].

use super::collapse::Collapse;
use super::column::{InitialColumn, cone_volume};
use super::deposit::{Deposit, HeightProfile};
use super::quantity::MeasuredValue;
use super::run_quantity::RunQuantity;
use super::sampled_quantity::Measure;
use super::summary::Summary;
use crate::world::World;

impl Summary {
    /// Adds what a `collapse` of `column` gave, the last state of which is `world`.
    pub(super) fn add_collapse(
        &mut self,
        world: &World,
        column: &InitialColumn,
        collapse: &Collapse,
    ) {
        self.add_column(column);
        self.add_motion(column, collapse);
        self.add_deposit(world, column, collapse);
    }

    fn add_column(&mut self, column: &InitialColumn) {
        let effective = column.effective_aspect_ratio();
        self.add(RunQuantity::AspectRatio, column.aspect_ratio());
        self.add(RunQuantity::EffectiveAspectRatio, effective);
        self.add(RunQuantity::ParticleFriction, column.particle_friction);
        self.add(RunQuantity::SecondShare, column.second_share);
        self.add(RunQuantity::SolidFraction, column.solid_fraction);
        self.add(RunQuantity::PackedAspectRatio, column.packed_aspect_ratio());
    }

    fn add_motion(&mut self, column: &InitialColumn, collapse: &Collapse) {
        let (peak, unit) = (collapse.peak_time, column.time_unit());
        let or_none = |time: Option<f64>| time.unwrap_or(f64::NAN);
        let rest = or_none(collapse.rest_time);
        self.add(RunQuantity::PeakEnergy, collapse.peak_energy);
        self.add(RunQuantity::PeakTime, peak);
        self.add(RunQuantity::RestTime, rest);
        let by_energy = or_none(collapse.energy_rest_time);
        self.add(RunQuantity::EnergyRestTime, by_energy);
        let by_front = or_none(collapse.front_rest_time);
        self.add(RunQuantity::FrontRestTime, by_front);
        self.add(RunQuantity::DimensionlessPeakTime, peak / unit);
        self.add(RunQuantity::DimensionlessRestTime, rest / unit);
    }

    fn add_deposit(&mut self, world: &World, column: &InitialColumn, collapse: &Collapse) {
        let (front, height) = (collapse.front, collapse.height);
        let at_end = |measure: Measure| format!("at the end. {}", measure.quantity().explanation());
        let front_note = at_end(Measure::FrontRadius);
        self.add_noted(RunQuantity::FinalFront, front, front_note);
        self.add(RunQuantity::RunOut, column.run_out(front));
        let height_note = at_end(Measure::DepositHeight);
        self.add_noted(RunQuantity::FinalHeight, height, height_note);
        self.add(RunQuantity::RelativeHeight, height / column.radius);
        self.add(RunQuantity::ConeVolume, cone_volume(front, height));
        let ratio = column.cone_volume_ratio(front, height);
        self.add(RunQuantity::RelativeConeVolume, ratio);
        let profile = Deposit::of(world).map(|deposit| deposit.height_profile());
        let flat = profile
            .as_ref()
            .map_or(f64::NAN, HeightProfile::flat_radius);
        self.add(RunQuantity::FlatRadius, flat);
        let shape = profile.map(|profile| profile.shape(front).word());
        self.add_value(RunQuantity::Shape, shape.map(MeasuredValue::Choice));
    }
}
