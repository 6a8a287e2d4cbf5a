//! Numbers read from a world.
//!
//! In: a [`World`], or a [`Series`] of samples taken from one. Out: numbers with names and units. Every measure is a pure
//! function that sums in a fixed order, so the same world gives the same bits; NaN or `None` stands where a measure has
//! no meaning (no surface, no grains). Nothing here changes a world or knows what made it.
//!
//! | file | measure |
//! |---|---|
//! | `quantity` | what a sample holds: [`Measure`], [`QUANTITIES`] |
//! | `series` | samples in columns: [`Series`] |
//! | `surface` | the free surface as a straight line: θ, h |
//! | `temperature` | granular temperature, laboratory and co-rotating frame |
//! | `packing` | packing fraction |
//! | `contacts` | coordination number, shares of the pairs of species, largest overlap |
//! | `energy` | elastic energy and the energy ledger |
//! | `avalanches` | extrema of θ(t) |
//! | `flow` | velocity in the cross-section, its profile over depth, its fastest moments |
//! | `velocity_map` | mean velocities on a grid over the cross-section |
//! | `reference` | stored dry drums to compare wet ones with |
//! | `grain` | numbers of each grain, to colour a picture by |
//! | `liquid` | bridges, capillary and Galilei number, torque of a drum |
//! | `column` | the column that collapses: `α_eff`, `μ_p`, the laws of Man et al. 2023 |
//! | `deposit` | the heap it becomes: front, height, profile, shape |
//! | `collapse` | what the samples of a collapse say of it as a whole |
//! | `summary` | averages over a window of a series, results of a run |
//!
//! `neighbours` finds the pairs of grains that are near each other, for the measures that need them.

mod avalanches;
mod collapse;
mod column;
mod contacts;
mod deposit;
mod energy;
mod flow;
mod grain;
mod liquid;
mod neighbours;
mod packing;
mod quantity;
mod reference;
mod series;
mod summary;
mod surface;
mod temperature;
mod velocity_map;

pub use avalanches::{Avalanche, SMOOTHING_TIME, avalanches};
pub use collapse::Collapse;
pub use column::{
    CRITICAL_ASPECT_RATIO, Column, PEAK_TIME_LAW, REST_TIME_LAW, TALL_ASPECT_RATIO,
    TALL_REST_TIME_LAW, cone_volume, cone_volume_law, contact_shares_law, run_out_law,
};
pub use contacts::{contact_shares, coordination_number, largest_overlap};
pub use deposit::{Deposit, DepositShape, HeightProfile};
pub use energy::{EnergyLedger, elastic_energy};
pub use flow::{FlowHistory, FlowProfile, kernel_reach, mean_velocity};
pub use grain::GrainQuantity;
pub use liquid::{bridges, capillary_number, drop_ratio_law, drum_torque, galilei_number};
pub use packing::packing_fraction;
pub use quantity::{Measure, QUANTITIES, Quantity};
pub use reference::{DryDrum, dry_drum};
pub use series::{Sample, Series};
pub use summary::{
    NON_RIGID_TEMPERATURE, Regime, SMALLEST_DROPS, Summary, SummaryEntry, results, summarise,
};
pub use surface::{MIDDLE_SHARE, SurfaceLine, surface_line};
pub use temperature::{Temperatures, granular_temperatures};
pub use velocity_map::{VelocityMap, velocity_map};

use crate::world::World;

/// Every [`Measure`] of `world` as it is now.
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
    let surface = match Column::of(world) {
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
fn set_collapse(sample: &mut Sample, world: &World, column: &Column) {
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
}

/// Mean speed of the grains' centres [m/s]; NaN without grains.
pub fn mean_speed(world: &World) -> f64 {
    let speeds = world.grains.velocity.iter().map(|v| v.length());
    speeds.sum::<f64>() / world.grains.len() as f64
}
