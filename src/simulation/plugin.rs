//! The Bevy plugin: one fixed-timestep system that lets a [`Simulation`] go on.

use super::Simulation;
use bevy::app::{App, FixedUpdate, Plugin};
use bevy::ecs::schedule::{IntoScheduleConfigs, SystemSet};
use bevy::ecs::system::{Res, ResMut};
use bevy::time::Time;

/// Steps the [`Simulation`] resource, where there is one, in `FixedUpdate`; under `MinimalPlugins` and `DefaultPlugins`
/// alike.
pub struct SimulationPlugin;

/// What the plugin does, for ordering other systems by.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SimulationSystems {
    /// The newest state, samples and status are taken in and the next slice is handed over.
    Advance,
}

impl Plugin for SimulationPlugin {
    fn build(&self, app: &mut App) {
        let advance = advance_simulation.in_set(SimulationSystems::Advance);
        app.add_systems(FixedUpdate, advance);
    }
}

/// Lets the simulation go on by one tick.
pub fn advance_simulation(simulation: Option<ResMut<Simulation>>, time: Res<Time>) {
    if let Some(mut simulation) = simulation {
        simulation.tick(time.delta());
    }
}
