//! The Bevy resource and the plugin: one fixed-timestep system that lets a [`Simulation`] go on.

use crate::lab::{Half, Lab, Options};
use crate::recording::Recording;
use crate::run::Session;
use crate::scene::Scene;
use bevy::app::{App, FixedUpdate, Plugin};
use bevy::ecs::component::{Component, Mutable, StorageType};
use bevy::ecs::resource::Resource;
use bevy::ecs::schedule::{IntoScheduleConfigs, SystemSet};
use bevy::ecs::system::{Res, ResMut};
use bevy::time::Time;
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
impl Component for Half {
    const STORAGE_TYPE: StorageType = StorageType::Table;
    type Mutability = Mutable;
}

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
