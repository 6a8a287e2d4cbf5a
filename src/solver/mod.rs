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
//! | `workers` | the worker pool, and who may write what when |
//! | `barrier` | where workers wait for each other |
//! | `ranges` | which part of a slice is whose |
//! | `walls` | how walls move |
//! | `grid` | which spheres are near each other |
//! | `tangential` | tangential springs, capped by Coulomb |
//! | `terms` | what there is to tell of the force of a contact, term by term |
//! | `time_step` | how long a step may be |
//! | `impact_accuracy` | what a step makes of an impact, and the steps that a scene can have |
//! | `profile` | where the time goes |
//! | `fault` | what makes the solver stop |
//! | `row` | four numbers side by side |
//!
//! # What a step computes
//!
//! Velocity Verlet: with forces `F`, torques `T` and gravity `g`, a step of `Δt` is
//! `v ← v + ½ Δt (F/m + g)`, `x ← x + Δt v`, the forces there, `v ← v + ½ Δt (F/m + g)`, likewise
//! for spins or angular momenta. Forces see positions at the end of the step and velocities of half
//! a step before. Every pair pushes by its law along the normal ([`crate::physics::law`]: Kasper et
//! al. 2021, Eqs. 5–9; Man et al. 2023, Eqs. 3.3–3.5), drags by a tangential spring under Coulomb's
//! bound ([`tangential`]), and may have a liquid bridge; spheres resist rolling.
//!
//! # What never shows in a bit
//!
//! | | because |
//! |---|---|
//! | number of threads | workers write ranges of their own, and each grain's sum has one order |
//! | width of the lanes | every operation is an exact one of IEEE 754, number by number, never fused |
//! | lists, skins, slots | what is listed too much adds exact zeros; what is left out would have |
//! | steps per call | the lists' ages are no part of the world, loading and storing are exact |
//! | the machine | nothing but + − × ÷ √ reaches the state |
//!
//! `tests/golden` and `tests/core/solver/determinism.rs` hold it to that.
//!
//! Formulas of force laws are in [`crate::physics::law`], the lanes that they are computed in are
//! [`crate::lanes`].
//!
//! What is not here: damping other than the contact laws', rolling friction or liquid between
//! polyhedra, periodic boundaries.

mod barrier;
mod fault;
mod grid;
mod impact_accuracy;
mod polyhedra;
mod profile;
mod ranges;
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
pub use impact_accuracy::{ImpactAccuracy, StepChoice, step_choices};
pub use profile::{Profile, Stage};
pub use spheres::NormalLaw;
pub use terms::ForceTerms;
pub use time_step::{Extremes, Limit, TimeStepAdvice, advise};

use crate::physics::law::{LawSource, StatedLaw};
use crate::world::{Clock, Contact, World};
use polyhedra::PolyhedronKernel;
use spheres::SphereKernel;
use std::time::Instant;
use workers::WorkerPool;

/// The terms of `contact`: one entry for spheres, one for each pair of features of polyhedra.
pub fn force_terms(world: &World, contact: &Contact) -> Vec<ForceTerms> {
    if world.polyhedra.is_some() {
        polyhedra::force_terms(world, contact)
    } else {
        vec![spheres::force_terms(world, contact)]
    }
}

/// So short that no number changes by a bit but those that are zero, and yet a time [s]: what holds
/// grains from rolling is the torque that would stop them within the step.
const NO_TIME: f64 = 1e-30;

/// Advances worlds; spheres press each other by the law of `S`, as a rule the one that the world
/// states.
pub struct Solver<S = StatedLaw> {
    pool: WorkerPool,
    processor: Processor,
    spheres: SphereKernel<S>,
    polyhedra: PolyhedronKernel,
    profile: Profile,
}

impl Solver {
    /// A solver that works on `threads` threads (at least one).
    pub fn new(threads: usize) -> Self {
        Self::with_law(StatedLaw, threads)
    }

    /// A solver that uses only what `processor` says, with the same results to the bit;
    /// [`Processor::Scalar`] makes it the plain twin of [`Solver::new`].
    pub fn on(processor: Processor, threads: usize) -> Self {
        Self {
            processor,
            ..Self::new(threads)
        }
    }
}

impl<S: LawSource> Solver<S> {
    /// A solver on `threads` threads whose spheres press each other by a `law` of the caller's own,
    /// whatever law the world states. It is compiled into the pair loop as the built-in ones are.
    ///
    /// The world still states a law of its own, and whatever else asks for one hears of that: the
    /// advice on the time step, the energy of contacts, a force term by term. See
    /// `examples/own_force_law.rs`.
    pub fn with_law(law: S, threads: usize) -> Self {
        Self {
            pool: WorkerPool::new(threads),
            processor: Processor::detect(),
            spheres: SphereKernel::new(law),
            polyhedra: PolyhedronKernel::default(),
            profile: Profile::default(),
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
    ///
    /// # Panics
    /// When a solver with a law of the caller's own is given polyhedra: their features have Hooke's
    /// springs.
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
            assert!(S::STATED, "a law of one's own is for spheres");
            resources.advance(&mut self.polyhedra, world, steps)
        } else {
            resources.advance(&mut self.spheres, world, steps)
        };
        self.profile.steps += steps;
        self.profile.grains = world.grains.len();
        self.profile.total += begin.elapsed();
        result
    }

    /// Computes the forces at the present positions and velocities, without a step: contacts,
    /// forces, torques and bridges become those of a step of no length.
    ///
    /// No time passes, nothing moves, no energy is booked. What a contact remembers does follow, as
    /// in every step: springs are turned into the tangent plane and capped by Coulomb's law,
    /// bridges form where grains touch, break beyond their rupture gap and are counted then.
    /// Rolling
    /// friction has its full torque where grains roll, and where they do not the torque that holds
    /// them.
    ///
    /// ```
    /// use grainfall::scene::Scene;
    /// use grainfall::solver::{Solver, advise};
    /// use grainfall::world;
    ///
    /// let scene = Scene::open("two-grains")?;
    /// let mut world = world::build(&scene, advise(&scene).time_step);
    /// let mut solver = Solver::new(1);
    /// // Two grains of radius 3 mm, 5 mm apart: how strongly do they press each other?
    /// world.grains.position[0].x = -0.004;
    /// solver.evaluate(&mut world)?;
    /// assert!(world.grains.force[0].length() > 1.0);
    /// assert_eq!(world.grains.force[0], -world.grains.force[1]);
    /// assert_eq!(world.time(), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A [`Fault`] when a grain's state is absurd; `world` is then as it was.
    pub fn evaluate(&mut self, world: &mut World) -> Result<(), Fault> {
        let mut probe = world.clone();
        probe.clock = Clock::new(NO_TIME);
        let now = world.time();
        self.advance(&mut probe, 1).map_err(|fault| Fault {
            time: now,
            good_time: now,
            ..fault
        })?;
        // The rest moves by nothing, but a quaternion may be put right in its last digit.
        let (grains, found) = (&mut world.grains, probe.grains);
        grains.force = found.force;
        grains.torque = found.torque;
        grains.rolling_torque = found.rolling_torque;
        grains.contact_count = found.contact_count;
        grains.film = found.film;
        grains.open_bridges = found.open_bridges;
        world.contacts = probe.contacts;
        world.ledger.ruptures = probe.ledger.ruptures;
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
