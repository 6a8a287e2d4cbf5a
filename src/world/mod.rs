//! The state of a granular system at one instant, in columns.
//!
//! A [`World`] holds all that determines its future, so that a clone is a snapshot and putting the
//! clone back restores it: the run then continues bit for bit. Only the solver moves it and only
//! commands change its settings; measures and views read it. Caches (neighbour lists, lane buffers)
//! are no part of it.

mod build;
mod contact;
mod container;
mod grain_column;
mod grains;
mod hash;
mod ledger;
mod memory;
mod mesh_wall;
mod mixture;
mod motion;
mod packing;
mod polyhedra;
mod soundness;
mod voronoi;
mod walls;
mod wetting;

pub use crate::geometry::{Polyhedron, Rounded};
pub use build::{build, build_packed, build_without_grains, materials};
pub use contact::{Contact, Partner};
pub use container::{Container, Shape, Surface, Wall};
pub use grain_column::GrainColumn;
pub use grains::{Grains, Species, SpeciesId};
pub use hash::StateHash;
pub use ledger::Ledger;
pub use mesh_wall::{MeshPose, MeshWall};
pub use mixture::{label_order, set_share};
pub use motion::WallMotion;
pub use packing::Packing;
pub use polyhedra::{Feature, FeatureContact, PlacedPolyhedron, Polyhedra};
pub use soundness::{MOST_STEPS, Unsound};
pub use voronoi::{Boundary, Tessellation};
pub use wetting::Bridge;

use crate::physics::{ContactLaw, Integrator, Liquid, Materials};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The whole state at one instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct World {
    /// Steps taken and the simulated time.
    pub clock: Clock,
    /// The grains, one entry per grain in every column.
    pub grains: Grains,
    /// What kinds of grain there are; [`Grains::species`] indexes it.
    pub species: Vec<Species>,
    /// Materials and the properties of their pairs.
    pub materials: Materials,
    /// The walls and the shape they make.
    pub container: Container,
    /// Gravitational acceleration [m/s²].
    pub gravity: DVec3,
    /// The liquid between the grains, if the scene has one.
    pub liquid: Option<Liquid>,
    /// Which contact law acts.
    pub law: ContactLaw,
    /// Every pair that touches or is held by a bridge, with its history, sorted by
    /// ([`Contact::grain`], [`Contact::partner`]).
    pub contacts: Vec<Contact>,
    /// What grains that are no spheres need beside their columns; none where all are spheres.
    pub polyhedra: Option<Box<Polyhedra>>,
    /// What the energy balance needs beside the grains' own columns.
    pub ledger: Ledger,
}

/// Steps taken and simulated time. The time step may change during a run; time stays exact to
/// rounding.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Steps taken since the start.
    pub step: u64,
    /// Length of a step [s].
    pub time_step: f64,
    /// Step at which the present time step began to hold.
    origin_step: u64,
    /// Simulated time at that step [s].
    origin_time: f64,
}

impl Clock {
    /// A clock at time zero with steps of `time_step` [s].
    pub fn new(time_step: f64) -> Self {
        Self {
            step: 0,
            time_step,
            origin_step: 0,
            origin_time: 0.0,
        }
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.time_at(self.step)
    }

    /// Simulated time at `step` if the present time step holds until then [s].
    pub fn time_at(&self, step: u64) -> f64 {
        self.origin_time + (step - self.origin_step) as f64 * self.time_step
    }

    /// The first step at or after `time` [s] if the present time step holds until then.
    pub fn step_at(&self, time: f64) -> u64 {
        let steps = ((time - self.origin_time) / self.time_step - 1e-9)
            .ceil()
            .max(0.0);
        self.origin_step.saturating_add(steps as u64).max(self.step)
    }

    /// Whether the present step is the first at or after `time` [s].
    pub fn has_just_come_to(&self, time: f64) -> bool {
        let steps = ((time - self.origin_time) / self.time_step - 1e-9).ceil();
        steps == (self.step - self.origin_step) as f64
    }

    /// Changes the length of a step [s] from now on.
    pub fn set_time_step(&mut self, time_step: f64) {
        self.origin_time = self.time();
        self.origin_step = self.step;
        self.time_step = time_step;
    }
}

impl World {
    /// It as far as a picture of grains and walls needs it: without its contacts, half of its memory.
    #[must_use]
    pub fn without_contacts(&self) -> Self {
        Self {
            clock: self.clock,
            grains: self.grains.clone(),
            species: self.species.clone(),
            materials: self.materials.clone(),
            container: self.container.clone(),
            gravity: self.gravity,
            liquid: self.liquid,
            law: self.law,
            contacts: Vec::new(),
            polyhedra: self.polyhedra.clone(),
            ledger: self.ledger,
        }
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// How the equations of motion are integrated.
    pub fn integrator(&self) -> Integrator {
        (self.polyhedra.as_ref()).map_or(Integrator::Explicit, |polyhedra| polyhedra.integrator)
    }

    /// Potential energy of the grains in gravity, `−Σ m g·x` [J].
    pub fn potential_energy(&self) -> f64 {
        let g = self.gravity;
        self.grains
            .mass
            .iter()
            .zip(&self.grains.position)
            .map(|(m, x)| -m * g.dot(*x))
            .sum()
    }

    /// Kinetic energy of translation and rotation [J].
    pub fn kinetic_energy(&self) -> f64 {
        (0..self.grains.len())
            .map(|i| self.kinetic_energy_of(i))
            .sum()
    }

    /// Kinetic energy of translation and rotation of grain `i` [J].
    pub fn kinetic_energy_of(&self, i: usize) -> f64 {
        let grains = &self.grains;
        0.5 * grains.mass[i] * grains.velocity[i].length_squared() + self.rotational_energy(i)
    }

    /// Kinetic energy of the rotation of grain `i` [J].
    pub fn rotational_energy(&self, i: usize) -> f64 {
        let spin = self.grains.spin[i];
        match &self.polyhedra {
            Some(polyhedra) => 0.5 * polyhedra.angular_momentum[i].dot(spin),
            None => 0.5 * self.grains.inertia[i] * spin.length_squared(),
        }
    }

    /// Changes gravity [m/s²]; the energy ledger keeps the work done until now.
    pub fn set_gravity(&mut self, gravity: DVec3) {
        let before = self.potential_energy();
        self.gravity = gravity;
        let after = self.potential_energy();
        self.ledger.close_gravity_segment(before, after);
    }

    /// Starts the clock, the energy ledger and the container's angle afresh, keeping the grains
    /// where they are.
    ///
    /// `elastic` is the elastic energy stored in the contacts now [J].
    pub fn restart_clock(&mut self, elastic: f64) {
        self.clock = Clock::new(self.clock.time_step);
        self.container.angle = 0.0;
        self.grains.exchanged.fill([0.0; 4]);
        self.grains.liquid_loss.fill([0.0; 2]);
        self.ledger = Ledger::starting_at(self.kinetic_energy() + elastic, self.potential_energy());
    }
}
