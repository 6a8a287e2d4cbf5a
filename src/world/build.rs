//! From a scene to the world it starts with: grains placed without overlap, nothing settled yet.

use super::World;
use crate::scene::Scene;

/// The world that `scene` asks for at time zero, with steps of `time_step` [s].
pub fn build(_scene: &Scene, _time_step: f64) -> World {
    unimplemented!("world::build")
}
