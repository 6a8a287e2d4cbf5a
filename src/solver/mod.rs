//! How the state advances.
//!
//! In: a [`World`]. Out: the same world some steps later, or a [`Fault`] and the world as it was.
//! The solver keeps only caches of its own (neighbour lists, lane buffers), so a world that was
//! restored or changed from outside simply goes on, and neither the number of threads, nor the
//! skins, nor how many steps a call takes show in a single bit of it.
//!
//! | file | holds |
//! |---|---|
//! | `step` | the order of work of a step, for grains of every shape |
//! | `spheres` | spheres: lists, contact forces, bridges, integration |
//! | `polyhedra` | rounded polyhedra: the same |
//! | `workers` | the worker pool, the barrier, and who may write what when |
//! | `walls` | how walls move |
//! | `grid` | which spheres are near each other |
//! | `tangential` | tangential springs, capped by Coulomb |
//! | `terms` | the force of a contact, term by term |
//! | `time_step` | how long a step may be |
//! | `profile` | where the time goes |
//! | `fault` | what makes the solver stop |
//! | `row` | four numbers side by side |
//!
//! Formulas of force laws are in [`crate::physics::law`], the lanes that they are computed in are
//! [`crate::lanes`].
//!
//! What is not here: damping other than the contact laws', rolling friction or liquid between
//! polyhedra, periodic boundaries.

mod fault;
mod grid;
mod polyhedra;
mod profile;
mod row;
mod spheres;
mod step;
mod tangential;
mod terms;
mod time_step;
mod walls;
mod workers;

pub use crate::lanes::Processor;
pub use fault::{Fault, FaultKind};
pub use profile::{Profile, Stage};
pub use terms::{ForceTerms, NormalLaw};
pub use time_step::{Extremes, Limit, TimeStepAdvice, advise};

use crate::world::{Clock, Contact, World};
use crate::{lanes, physics::law};
use polyhedra::Polyhedra;
use spheres::Spheres;
use std::time::Instant;
use workers::WorkerPool;

/// The terms of `contact`: one entry for spheres, one for each pair of features of polyhedra.
pub fn force_terms(world: &World, contact: &Contact) -> Vec<ForceTerms> {
    if world.polyhedra.is_some() {
        polyhedra::force_terms(world, contact)
    } else {
        vec![terms::terms_of_spheres(world, contact)]
    }
}

/// Advances worlds.
pub struct Solver {
    pool: WorkerPool,
    processor: Processor,
    spheres: Spheres,
    polyhedra: Polyhedra,
    profile: Profile,
}

impl Solver {
    /// A solver that works on `threads` threads (at least one).
    pub fn new(threads: usize) -> Self {
        Self {
            pool: WorkerPool::new(threads),
            processor: Processor::detect(),
            spheres: Spheres::default(),
            polyhedra: Polyhedra::default(),
            profile: Profile::default(),
        }
    }

    /// A solver that uses only what `processor` says, with the same results to the bit;
    /// [`Processor::Scalar`] makes it the plain twin of [`Solver::new`].
    pub fn on(processor: Processor, threads: usize) -> Self {
        Self {
            processor,
            ..Self::new(threads)
        }
    }

    /// Takes `steps` steps.
    ///
    /// ```
    /// use grainfall::measure::coordination_number;
    /// use grainfall::scene::Scene;
    /// use grainfall::solver::{Solver, advise};
    /// use grainfall::world;
    ///
    /// let scene = Scene::open("bouncing-grain")?;
    /// let mut world = world::build(&scene, advise(&scene).time_step);
    /// Solver::new(1).advance(&mut world, 100)?;
    /// assert_eq!(world.clock.step, 100);
    /// println!("{} contacts per grain", coordination_number(&world));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A [`Fault`] when a grain's state becomes absurd; `world` is then as it was before the call.
    pub fn advance(&mut self, world: &mut World, steps: u64) -> Result<(), Fault> {
        if steps == 0 || world.grains.is_empty() {
            world.clock.step += steps;
            return Ok(());
        }
        // Later positions are finite as long as speeds are.
        if let Some(grain) = world.grains.position.iter().position(|x| !x.is_finite()) {
            return Err(Fault {
                grain,
                kind: FaultKind::NotFinite("position"),
                time: world.time(),
                good_time: world.time(),
            });
        }
        let begin = Instant::now();
        let resources = step::Resources {
            pool: &mut self.pool,
            processor: self.processor,
            profile: &mut self.profile,
        };
        let result = if world.polyhedra.is_some() {
            resources.advance(&mut self.polyhedra, world, steps)
        } else {
            resources.advance(&mut self.spheres, world, steps)
        };
        self.profile.steps += steps;
        self.profile.grains = world.grains.len();
        self.profile.total += begin.elapsed();
        result
    }

    /// Computes the forces at the present positions and velocities: contacts, forces, torques and
    /// bridges become those of a step of no length. No time passes, nothing moves, no work is
    /// booked; springs are turned into the tangent plane and capped, as in every step. Rolling
    /// friction has its full torque, as nothing says how long it acts.
    ///
    /// # Errors
    /// A [`Fault`] when a grain's state is absurd; `world` is then as it was.
    pub fn evaluate(&mut self, world: &mut World) -> Result<(), Fault> {
        let mut probe = world.clone();
        probe.clock = Clock::new(0.0);
        self.advance(&mut probe, 1)?;
        // The rest moves by nothing, but a quaternion may be put right in its last digit.
        let (grains, found) = (&mut world.grains, probe.grains);
        grains.force = found.force;
        grains.torque = found.torque;
        grains.rolling_torque = found.rolling_torque;
        grains.contact_count = found.contact_count;
        grains.film = found.film;
        grains.open_bridges = found.open_bridges;
        world.contacts = probe.contacts;
        if let (Some(polyhedra), Some(found)) = (&mut world.polyhedra, probe.polyhedra) {
            polyhedra.features = found.features;
        }
        Ok(())
    }

    /// Where the time went since the last call.
    pub fn take_profile(&mut self) -> Profile {
        std::mem::take(&mut self.profile)
    }
}
