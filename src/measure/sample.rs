//! Every [`Measure`] of a world at one instant.
//!
//! In: a world. Out: a [`Sample`], NaN where a measure has no meaning in that world.

use super::column::InitialColumn;
use super::contact_network::{contact_shares, coordination_number, largest_overlap};
use super::deposit::Deposit;
use super::drum_torque::drum_torque;
use super::energy_ledger::EnergyLedger;
use super::floor::{floor_force, weight};
use super::mixing::mixing_index;
use super::packing_fraction::packing_fraction;
use super::sampled_quantity::Measure;
use super::surface::{MIDDLE_SHARE, SurfaceLine, surface_line};
use super::temperature::granular_temperatures;
use super::wet_bed::bridges;
use crate::world::World;

/// Every measure of a world at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Steps taken.
    pub step: u64,
    /// Simulated time [s].
    pub time: f64,
    /// One value per [`Measure`], in SI units; NaN where a measure is undefined.
    pub values: [f64; Measure::COUNT],
}

impl Sample {
    /// The value of one measure.
    pub fn value(&self, measure: Measure) -> f64 {
        self.values[measure as usize]
    }

    /// Gives one measure its value.
    fn set(&mut self, measure: Measure, value: f64) {
        self.values[measure as usize] = value;
    }
}

/// Every [`Measure`] of `world` as it is now.
///
/// ```
/// use grainfall::measure::{Measure, sample};
/// use grainfall::solver::{Solver, advise};
/// use grainfall::{scene::Scene, world};
///
/// let scene = Scene::open("bouncing-grain")?;
/// let mut world = world::build(&scene, advise(&scene).time_step);
/// Solver::new(1).advance(&mut world, 500)?;
/// let energy = sample(&world).value(Measure::KineticEnergy);
/// assert!(energy > 0.0);
/// // Symbol, unit and digits are those of the quantity's row in the registry.
/// let row = Measure::KineticEnergy.quantity();
/// println!("{}: {}", row.label(), row.text(energy));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sample(world: &World) -> Sample {
    sample_and_surface(world).0
}

/// Every [`Measure`] of `world` as it is now, and the surface line that they were taken with.
pub fn sample_and_surface(world: &World) -> (Sample, Option<SurfaceLine>) {
    let mut sample = Sample {
        step: world.clock.step,
        time: world.time(),
        values: [f64::NAN; Measure::COUNT],
    };
    set_common(&mut sample, world);
    let surface = match InitialColumn::of(world) {
        Some(column) => {
            set_collapse(&mut sample, world, &column);
            None
        }
        None => set_bed(&mut sample, world),
    };
    (sample, surface)
}

fn set_common(sample: &mut Sample, world: &World) {
    let energy = EnergyLedger::of(world);
    sample.set(Measure::Bridges, bridges(world) as f64);
    sample.set(Measure::Ruptures, world.ledger.ruptures as f64);
    sample.set(Measure::ViscousLoss, energy.viscous_loss);
    sample.set(Measure::CapillaryLoss, energy.capillary_loss);
    sample.set(Measure::CoordinationNumber, coordination_number(world));
    sample.set(Measure::LargestOverlap, largest_overlap(world));
    sample.set(Measure::KineticEnergy, energy.kinetic);
    sample.set(Measure::ElasticEnergy, energy.elastic);
    sample.set(Measure::GravityWork, energy.gravity_work);
    sample.set(Measure::WallWork, energy.wall_work);
    sample.set(Measure::DashpotLoss, energy.dashpot_loss);
    sample.set(Measure::SlidingLoss, energy.sliding_loss);
    sample.set(Measure::RollingLoss, energy.rolling_loss);
    sample.set(Measure::EnergyResidual, energy.residual());
    sample.set(Measure::MeanSpeed, mean_speed(world));
    sample.set(Measure::MixingIndex, mixing_index(world));
}

/// What a bed with a free surface shows; returns that surface.
fn set_bed(sample: &mut Sample, world: &World) -> Option<SurfaceLine> {
    let surface = surface_line(world, MIDDLE_SHARE);
    if let Some(line) = &surface {
        sample.set(Measure::SurfaceAngle, line.angle);
        sample.set(Measure::PackingFraction, packing_fraction(world, line));
        sample.set(Measure::SurfaceRoughness, line.roughness);
        sample.set(Measure::SurfaceCurvature, line.curvature);
    }
    let temperatures = granular_temperatures(world);
    sample.set(Measure::GranularTemperature, temperatures.laboratory);
    sample.set(Measure::CorotatingTemperature, temperatures.corotating);
    sample.set(Measure::DrumTorque, drum_torque(world));
    surface
}

/// What a collapsing column shows.
fn set_collapse(sample: &mut Sample, world: &World, column: &InitialColumn) {
    let Some(deposit) = Deposit::of(world) else {
        return;
    };
    let (front, height) = (deposit.front_radius(), deposit.height());
    sample.set(Measure::FrontRadius, front);
    sample.set(Measure::FrontRadius99, deposit.radius_of_share(0.99));
    sample.set(Measure::FrontRadius95, deposit.radius_of_share(0.95));
    sample.set(Measure::ClusterRadius, deposit.cluster_radius(world));
    sample.set(Measure::DepositHeight, height);
    sample.set(Measure::ApexHeight, deposit.height_profile().apex());
    sample.set(
        Measure::ConeVolumeRatio,
        column.cone_volume_ratio(front, height),
    );
    let count = world.grains.len() as f64;
    let rotation: f64 = (0..world.grains.len())
        .map(|i| world.rotational_energy(i))
        .sum();
    let kinetic = sample.value(Measure::KineticEnergy);
    sample.set(Measure::TranslationalEnergy, (kinetic - rotation) / count);
    sample.set(Measure::RotationalEnergy, rotation / count);
    let [first, mixed, second] = contact_shares(world);
    sample.set(Measure::FirstPairs, first);
    sample.set(Measure::MixedPairs, mixed);
    sample.set(Measure::SecondPairs, second);
    sample.set(Measure::FloorForce, floor_force(world));
    sample.set(Measure::Weight, weight(world));
}

/// Mean speed of the grains' centres [m/s]; NaN without grains.
pub fn mean_speed(world: &World) -> f64 {
    let speeds = world.grains.velocity.iter().map(|v| v.length());
    speeds.sum::<f64>() / world.grains.len() as f64
}
