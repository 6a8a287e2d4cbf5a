//! What limits a time step, as laws and bridges say it.
//!
//! The words that laws and bridges state their limits in: the smallest grain of a material and its
//! circumstances go in, limits with their reasons come out. What is done with limits is the
//! solver's.

use crate::geometry::spheres_volume;
use crate::physics::{Integrator, Material};

/// One limit on the time step.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct StepLimit {
    /// What sets it: `Rayleigh wave`, `Hertz contact` …
    pub name: &'static str,
    /// The step must not exceed it [s].
    pub time_step: f64,
    /// How it was computed, in words and numbers.
    pub reason: String,
}

/// The smallest grain of one material: what limits the step.
#[derive(Clone, Copy, Debug)]
pub struct SmallestGrain<'a> {
    /// What it is made of.
    pub material: &'a Material,
    /// Its radius, of a polyhedron that of the sphere of its volume [m].
    pub radius: f64,
    /// Restitution of its most strongly damped contacts.
    pub restitution: f64,
}

impl SmallestGrain<'_> {
    /// Its mass [kg].
    pub fn mass(&self) -> f64 {
        spheres_volume(1.0, self.radius) * self.material.density
    }
}

/// What the limits of a law depend on beside the grains.
#[derive(Clone, Copy, Debug)]
pub struct Circumstances {
    /// Speed at which grains hit each other [m/s].
    pub impact_speed: f64,
    /// Whether the grains are polyhedra, which touch in several places.
    pub are_polyhedra: bool,
    /// How the equations of motion are integrated.
    pub integrator: Integrator,
    /// Smallest sphero-radius of polyhedra; infinite where none has one [m].
    pub rounding: f64,
    /// How fast grains may become as they fall, or hit each other [m/s].
    pub fastest: f64,
}
