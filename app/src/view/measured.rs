//! What is measured of a world and has a place in it: the line along its free surface, the front
//! and the height of a heap, the flowing layer, the temperature of each cell.
//!
//! In: a world, the mean flow of its run. Out: the same values that its samples hold, of the state shown, as numbers and in
//! words.

use grainfall::measure::{
    DepositOutline, MIDDLE_SHARE, MeanFlow, Measure, SurfaceLine, TemperatureMap, surface_line,
    temperature_map,
};
use grainfall::world::World;
use std::sync::Arc;

/// What is measured of a world and has a place in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The line whose slope is the surface angle θ.
    pub surface: Option<SurfaceLine>,
    /// Front R and height H of a heap.
    pub deposit: Option<DepositOutline>,
    /// Mean velocity over depth, where it is to be seen.
    pub flow: Option<Arc<MeanFlow>>,
    /// Granular temperature of the cross-section, where it is to be seen.
    pub temperature: Option<TemperatureMap>,
}

impl Measured {
    /// What is measured of no world.
    pub const NOTHING: Self = Self {
        surface: None,
        deposit: None,
        flow: None,
        temperature: None,
    };

    /// What is measured of `world`: of a heap its outline, of a bed its surface.
    pub fn of(world: &World) -> Self {
        let deposit = DepositOutline::of(world);
        let is_bed = deposit.is_none();
        Self {
            surface: is_bed.then(|| surface_line(world, MIDDLE_SHARE)).flatten(),
            deposit,
            ..Self::NOTHING
        }
    }

    /// It with the `flow` of its run.
    #[must_use]
    pub fn with_flow(self, flow: Option<Arc<MeanFlow>>) -> Self {
        Self { flow, ..self }
    }

    /// It with the temperatures of `world`, where that has a bed.
    #[must_use]
    pub fn with_temperature(self, world: &World) -> Self {
        let has_bed = self.surface.is_some();
        let map = || temperature_map(world);
        Self {
            temperature: has_bed.then(map).flatten(),
            ..self
        }
    }

    /// What matters most of it, in words: the angle of a surface, else the front of a heap.
    pub fn in_words(&self) -> Option<String> {
        let angle = self.surface.as_ref().map(|surface| surface.angle);
        let front = self.deposit.as_ref().map(|deposit| deposit.front);
        let angle = angle.map(|angle| in_words(Measure::SurfaceAngle, angle));
        angle.or_else(|| Some(in_words(Measure::FrontRadius, front?)))
    }
}

/// `θ = 24.31°`.
pub(super) fn in_words(measure: Measure, value: f64) -> String {
    let quantity = measure.quantity();
    format!("{} = {}", quantity.symbol, quantity.text(value))
}
