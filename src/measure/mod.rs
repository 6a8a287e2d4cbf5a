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
//! | `contacts` | coordination number, largest overlap |
//! | `energy` | elastic energy and the energy ledger |
//! | `avalanches` | extrema of θ(t) |
//! | `flow` | velocity in the cross-section, its profile over depth |
//! | `reference` | stored dry drums to compare wet ones with |
//! | `liquid` | bridges, capillary and Galilei number, torque of a drum |
//! | `summary` | averages over a window of a series |
//!
//! `neighbours` finds the pairs of grains that are near each other, for the measures that need them.

mod avalanches;
mod contacts;
mod energy;
mod flow;
mod liquid;
mod neighbours;
mod packing;
mod quantity;
mod reference;
mod series;
mod summary;
mod surface;
mod temperature;

pub use avalanches::{Avalanche, SMOOTHING_TIME, avalanches};
pub use contacts::{coordination_number, largest_overlap};
pub use energy::{EnergyLedger, elastic_energy};
pub use flow::{FlowHistory, FlowProfile, kernel_reach, mean_velocity};
pub use liquid::{bridges, capillary_number, drop_ratio_law, drum_torque, galilei_number};
pub use packing::packing_fraction;
pub use quantity::{Measure, QUANTITIES, Quantity};
pub use reference::{DryDrum, dry_drum};
pub use series::{Sample, Series};
pub use summary::{
    NON_RIGID_TEMPERATURE, Regime, SMALLEST_DROPS, Summary, SummaryEntry, summarise,
};
pub use surface::{MIDDLE_SHARE, SurfaceLine, surface_line};
pub use temperature::{Temperatures, granular_temperatures};

use crate::world::World;

/// Every [`Measure`] of `world` as it is now.
pub fn sample(world: &World) -> Sample {
    sample_and_surface(world).0
}

/// Every [`Measure`] of `world` as it is now, and the surface line that they were taken with.
pub fn sample_and_surface(world: &World) -> (Sample, Option<SurfaceLine>) {
    let mut values = [f64::NAN; Measure::COUNT];
    let mut set = |measure: Measure, value: f64| values[measure as usize] = value;
    let surface = surface_line(world, MIDDLE_SHARE);
    let temperatures = granular_temperatures(world);
    let energy = EnergyLedger::of(world);
    if let Some(line) = &surface {
        set(Measure::SurfaceAngle, line.angle);
        set(Measure::PackingFraction, packing_fraction(world, line));
        set(Measure::SurfaceRoughness, line.roughness);
        set(Measure::SurfaceCurvature, line.curvature);
    }
    set(Measure::Bridges, bridges(world) as f64);
    set(Measure::Ruptures, world.ledger.ruptures as f64);
    set(Measure::DrumTorque, drum_torque(world));
    set(Measure::ViscousLoss, energy.viscous_loss);
    set(Measure::CapillaryLoss, energy.capillary_loss);
    set(Measure::GranularTemperature, temperatures.laboratory);
    set(Measure::CorotatingTemperature, temperatures.corotating);
    set(Measure::CoordinationNumber, coordination_number(world));
    set(Measure::LargestOverlap, largest_overlap(world));
    set(Measure::KineticEnergy, energy.kinetic);
    set(Measure::ElasticEnergy, energy.elastic);
    set(Measure::GravityWork, energy.gravity_work);
    set(Measure::WallWork, energy.wall_work);
    set(Measure::DashpotLoss, energy.dashpot_loss);
    set(Measure::SlidingLoss, energy.sliding_loss);
    set(Measure::RollingLoss, energy.rolling_loss);
    set(Measure::EnergyResidual, energy.residual());
    set(Measure::MeanSpeed, mean_speed(world));
    let sample = Sample {
        step: world.clock.step,
        time: world.time(),
        values,
    };
    (sample, surface)
}

/// Mean speed of the grains' centres [m/s]; NaN without grains.
pub fn mean_speed(world: &World) -> f64 {
    let speeds = world.grains.velocity.iter().map(|v| v.length());
    speeds.sum::<f64>() / world.grains.len() as f64
}
