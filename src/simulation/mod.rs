//! The lab as a Bevy resource, and the plugin that lets it go on, the same with and without a
//! window.
//!
//! In: a [`Simulation`] among the resources, fixed ticks. Out: the same resource, gone on by these
//! ticks. Nothing is decided here: [`crate::lab`] does. Without the feature `headless` there is no
//! Bevy and this is a list of names.

#[cfg(feature = "headless")]
mod plugin;

pub use crate::lab::*;
pub use crate::run::*;
#[cfg(feature = "headless")]
pub use plugin::{Simulation, SimulationPlugin, SimulationSystems, advance_simulation};
