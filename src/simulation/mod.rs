//! The Bevy plugin that lets a [`Simulation`] go on, the same with and without a window.

#[cfg(feature = "headless")]
mod plugin;

pub use crate::lab::*;
pub use crate::run::*;
#[cfg(feature = "headless")]
pub use plugin::{SimulationPlugin, SimulationSystems, advance_simulation};
