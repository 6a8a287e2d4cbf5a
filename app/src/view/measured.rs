//! What is measured of a world and has a place in it: the line along its free surface, the front
//! and the height of a heap.
//!
//! In: a world. Out: the same values that its samples hold, of the state shown.

use grainfall::measure::{DepositOutline, MIDDLE_SHARE, SurfaceLine, surface_line};
use grainfall::world::World;

/// What is measured of a world and has a place in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The line whose slope is the surface angle θ.
    pub surface: Option<SurfaceLine>,
    /// Front R and height H of a heap.
    pub deposit: Option<DepositOutline>,
}

impl Measured {
    /// What is measured of no world.
    pub const NOTHING: Self = Self {
        surface: None,
        deposit: None,
    };

    /// What is measured of `world`.
    pub fn of(world: &World) -> Self {
        Self {
            surface: surface_line(world, MIDDLE_SHARE),
            deposit: DepositOutline::of(world),
        }
    }
}
