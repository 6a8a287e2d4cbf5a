//! How a wall moves.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The velocity field of a rigid body: `velocity + spin × x`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallMotion {
    /// Velocity at the origin [m/s].
    pub velocity: DVec3,
    /// Angular velocity about the origin [rad/s].
    pub spin: DVec3,
}

impl WallMotion {
    /// Velocity at the point `x` [m/s].
    pub fn velocity_at(&self, x: DVec3) -> DVec3 {
        self.velocity + self.spin.cross(x)
    }
}
