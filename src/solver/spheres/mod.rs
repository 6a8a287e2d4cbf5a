//! Worlds of spheres: the solver's working copy of one, and how it advances.
//!
//! In: a world of spheres. Out: the same world some steps later, by the stages of [`super::step`].
//! Rows of grains stand in slots that a spatial sort gives them, and pairs name slots; neither
//! shows in a result. [`Kernel::load`] and [`Kernel::store`] are exact.
//!
//! | file | holds |
//! |---|---|
//! | `slots` | the spatial sort: where each grain's rows stand |
//! | `neighbours` | who may touch whom: outer and inner Verlet list |
//! | `pair_list` | pairs with their histories, which follow them from list to list |
//! | `parts` | which pairs are whose, in the order in which forces are summed |
//! | `kinds` | constants of each kind of pair |
//! | `rows` | what the pair loop reads and writes of grains and pairs |
//! | `partners` | geometry and kinematics of two grains, and of a grain at a wall |
//! | `contacts` | the pair loop: contact law, sliding, rolling |
//! | `bridges` | liquid bridges in the pair loop |
//! | `integrate` | sums of forces, velocity Verlet |
//! | `terms` | a contact's force, term by term |
//! | `normal_law` | a contact's normal force over the gap |
//! | `working_copy` | what is kept between loading a world and storing it |
//! | `exchange` | how grains, films and contacts come into it and back |
//! | `plan` | what one worker does in a step, and in which order |
//! | `rings`, `places` | what pairs do, until their grains have moved; where each writes it |
//! | `pass` | a worker's step: pairs, and grains right behind them |
//! | `share` | what one worker works on during a batch |
//!
//! What a step reads of a grain stands in one place ([`rows::Sphere`], two cache lines), what only
//! its integration reads in another ([`integrate::SphereAccount`]), what only the end of a call asks
//! for in a third ([`integrate::SphereLoad`]). A step goes through the bed once, and what its pairs do
//! never leaves the cache: of a grain it reads and writes about a kilobyte. Numbers of three kinds name things here, each
//! with a type of its own: slots of rows, walls of the container, kinds of pairs; a bare number is
//! a grain's in the world. Histories of contacts (springs, bridges) stand beside the pairs of the
//! inner list and move with them; whatever is left of a call is in the world.
//!
//! Not here: the order of the stages (`super::step`), formulas of force laws
//! ([`crate::physics::law`]).

mod bridges;
mod contacts;
mod exchange;
mod integrate;
mod kinds;
mod neighbours;
mod normal_law;
mod pair_list;
mod partners;
mod parts;
mod pass;
mod places;
mod plan;
mod rings;
mod rows;
mod share;
mod slots;
mod terms;
mod working_copy;

use super::FaultKind;
use super::row::{length_squared, row, vector};
use super::step::{Kernel, Tally};
use super::walls::Walls;
use super::workers::{Batch, WorkerPool};
use crate::lanes::Processor;
use crate::physics::law::LawSource;
use crate::world::World;
use integrate::{SphereAccount, StartStep, StepConstants};
pub use normal_law::NormalLaw;
use plan::Plan;
use rings::Rings;
use rows::Sphere;
use share::SphereShare;
pub use terms::force_terms;
pub use working_copy::SphereKernel;

impl<S: LawSource> Kernel for SphereKernel<S> {
    type Share<'a>
        = SphereShare<'a, S>
    where
        S: 'a;

    /// Lists and slots of the last call are kept where they still suit the world: they never show
    /// in a result. Histories are always the world's.
    fn load(&mut self, _processor: Processor, pool: &mut WorkerPool, world: &World) {
        if !self.kinds.classify(world) {
            self.neighbours.forget();
        }
        let (grains, searches) = (&world.grains, self.neighbours.searches);
        if self.slots.is_stale(grains, searches) {
            self.slots.sort(grains, searches);
            self.neighbours.forget();
        }
        self.kinds.compute(self.source, world);
        self.law = world.law;
        self.walls.load(&world.container);
        self.motion = StepConstants {
            dt: world.clock.time_step,
            gravity: row(world.gravity, 0.0),
            slack_squared: 0.0,
        };
        self.load_grains(pool, world);
        self.load_liquid(world);
        self.fit_lists(pool, world);
        self.neighbours
            .load_histories(pool, &world.contacts, &self.slots);
    }

    fn start(&mut self, processor: Processor) -> bool {
        let count = self.loads.len();
        let start = StartStep {
            motion: &self.motion,
            bodies: &mut self.bodies[..count],
            loads: &self.loads,
            accounts: &self.accounts,
            bridge_loads: &self.bridge_loads,
            references: &self.neighbours.reference,
        };
        processor.run(start).refresh
    }

    /// A search may meet kinds of pairs that there were none of before: they need constants.
    fn refresh_lists(&mut self, pool: &mut WorkerPool, world: &World) -> u64 {
        let searches = self.refresh(pool);
        self.kinds.complete(self.source, world);
        searches
    }

    fn adapt_lists(&mut self, steps: u64) {
        self.neighbours.adapt(steps);
    }

    fn steps_within_slack(&self) -> u64 {
        let slack = self.neighbours.slack();
        self.walls.steps_within(slack, self.motion.dt)
    }

    fn lend<'a>(&'a mut self, batch: &'a Batch) -> Vec<SphereShare<'a, S>> {
        SphereShare::all(self, batch)
    }

    /// Bridges that broke are booked when the world is put back.
    fn note(&mut self, tally: &Tally, steps: u64) {
        self.ruptures += tally.ruptures;
        if steps % 2 == 1 {
            std::mem::swap(&mut self.bodies, &mut self.next_bodies);
            std::mem::swap(&mut self.films, &mut self.next_films);
        }
    }

    /// Columns are written in the order of the grains' indices, contacts too: slots do not show.
    fn store(&self, pool: &mut WorkerPool, world: &mut World) {
        self.store_grains(pool, &mut world.grains);
        self.store_contacts(pool, &mut world.contacts);
        world.ledger.ruptures += self.ruptures;
    }

    /// Of several grains the one of lowest index, so that the message does not depend on slots.
    fn find_fault(&self) -> (usize, FaultKind) {
        let rows = self.bodies.iter().zip(&self.accounts);
        let found = self.slots.grains().iter().zip(rows);
        let (grain, kind) = found
            .filter_map(|(grain, (body, account))| Some((*grain, self.judge(body, account)?)))
            .min_by_key(|(grain, _)| *grain)
            .unwrap_or((0, FaultKind::NotFinite("state")));
        (grain as usize, kind)
    }

    /// Pairs on both inner lists, padding included.
    fn listed(&self) -> usize {
        self.neighbours.grains.pairs.len() + self.neighbours.walls.pairs.len()
    }

    fn walls(&mut self) -> &mut Walls {
        &mut self.walls
    }

    fn time_step(&self) -> f64 {
        self.motion.dt
    }
}

impl<S: LawSource> SphereKernel<S> {
    /// Makes the lists fit the positions that were just loaded.
    fn fit_lists(&mut self, pool: &mut WorkerPool, world: &World) {
        if self.liquid.is_some() || !self.neighbours.inner_covers(&self.bodies, &self.walls) {
            self.refresh(pool);
        }
        self.kinds.compute(self.source, world);
        let slack = self.neighbours.slack();
        self.motion.slack_squared = slack * slack;
    }

    /// Brings the lists up to date with the positions; returns how often neighbours were searched
    /// for.
    fn refresh(&mut self, pool: &mut WorkerPool) -> u64 {
        let before = self.neighbours.searches;
        self.neighbours.refresh(
            pool,
            (&self.bodies, &self.walls),
            &self.slots,
            &mut self.kinds,
        );
        let slack = self.neighbours.slack();
        self.motion.slack_squared = slack * slack;
        self.neighbours.searches - before
    }

    /// Makes the plans of `size` workers fit the lists.
    fn make_plans(&mut self, size: usize) {
        let generation = self.neighbours.generation;
        if self.planned != generation || self.plans.len() != size {
            self.plans = Plan::all(&self.neighbours, size);
            self.planned = generation;
        }
        self.rings.resize_with(size, Rings::default);
    }

    /// What is wrong with a grain, if anything is.
    fn judge(&self, body: &Sphere, account: &SphereAccount) -> Option<FaultKind> {
        let position = vector(body.position);
        let behind = self
            .walls
            .iter()
            .map(|wall| -wall.surface.distance(position).0)
            .fold(f64::NEG_INFINITY, f64::max);
        let speed_squared = length_squared(body.velocity);
        if !position.is_finite() {
            Some(FaultKind::NotFinite("position"))
        } else if behind >= 0.0 {
            Some(FaultKind::BehindWall(behind))
        } else if !speed_squared.is_finite() {
            Some(FaultKind::NotFinite("velocity"))
        } else if !length_squared(body.spin).is_finite() {
            Some(FaultKind::NotFinite("spin"))
        } else if speed_squared > account.speed_limit_squared {
            Some(FaultKind::TooFast(speed_squared.sqrt()))
        } else {
            None
        }
    }
}
