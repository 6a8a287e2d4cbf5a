//! The lab as a Bevy resource, and the plugin that lets it go on, the same with and without a
//! window.
//!
//! In: a [`Simulation`] among the resources, fixed ticks. Out: the same resource, gone on by these
//! ticks. Nothing is decided here: [`grainfall::lab`] does.

use bevy::app::{App, FixedUpdate, Plugin};
use bevy::ecs::component::Component;
use bevy::ecs::resource::Resource;
use bevy::ecs::schedule::{IntoScheduleConfigs, SystemSet};
use bevy::ecs::system::{Res, ResMut};
use bevy::time::Time;
use grainfall::lab::{Half, Lab, Options};
use grainfall::recording::Recording;
use grainfall::run::Session;
use grainfall::scene::Scene;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// The lab of the present scene as a resource; see [`Lab`] for all that it can do.
#[derive(Resource)]
pub struct Simulation(Lab);

impl Simulation {
    /// As [`Lab::open`].
    pub fn open(scene: Scene, options: Options) -> Self {
        Self(Lab::open(scene, options))
    }

    /// As [`Lab::resume`].
    pub fn resume(session: Session, options: Options) -> Self {
        Self(Lab::resume(session, options))
    }

    /// As [`Lab::play_back`].
    pub fn play_back(recording: Recording, options: Options) -> Self {
        Self(Lab::play_back(recording, options))
    }

    /// As [`Lab::unsaved`].
    #[must_use]
    pub fn unsaved(self) -> Self {
        Self(self.0.unsaved())
    }

    /// As [`Lab::made_of`].
    #[must_use]
    pub fn made_of(self, original: Arc<Scene>) -> Self {
        Self(self.0.made_of(original))
    }
}

impl Deref for Simulation {
    type Target = Lab;

    fn deref(&self) -> &Lab {
        &self.0
    }
}

impl DerefMut for Simulation {
    fn deref_mut(&mut self) -> &mut Lab {
        &mut self.0
    }
}

/// Entities of the picture say which half of it they are drawn in.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnIn(pub Half);

/// Steps the [`Simulation`] resource, where there is one, in `FixedUpdate`; under `MinimalPlugins`
/// and `DefaultPlugins` alike.
pub struct SimulationPlugin;

/// What the plugin does, for ordering other systems by.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SimulationSystems {
    /// The newest state, samples and status are taken in and the next wall-clock time is granted.
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
