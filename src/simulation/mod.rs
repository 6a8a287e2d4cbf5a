//! A run and the Bevy plugin that steps it.
//!
//! [`Run`] is the trajectory: a scene, its world, the solver, the commands carried out and the samples taken. It knows
//! nothing of wall-clock time, frames or threads: the same scene, seed and commands give the same bits. [`Simulation`] is
//! what panels and views see of it; a driver moves the run on, inline or on its own thread.

mod command;

pub use command::{Command, Parameter, StampedCommand};
