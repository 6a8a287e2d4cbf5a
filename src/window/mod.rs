//! The window: Bevy's app with simulation, view and panels.

pub mod environment;
pub mod picture;
