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
use super::ranges::split_once;
use super::row::{length_squared, row, vector};
use super::step::{Kernel, Tally};
use super::tangential::UNLOADED;
use super::walls::Walls;
use super::workers::{Batch, WorkerPool};
use crate::lanes::Processor;
use crate::physics::Liquid;
use crate::physics::law::{BridgeKinds, LawSource, contributions, rupture_gap};
use crate::world::{Contact, Partner, World};
use bridges::{BridgeRow, Bridges};
use integrate::{SphereAccount, SphereLoad, StartStep, StepConstants};
pub use normal_law::NormalLaw;
use pair_list::{PairOrder, SpherePairs};
use parts::Part;
use plan::Plan;
use rings::Rings;
use rows::{PairKind, Sphere, SpherePair};
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
        self.neighbours.load_histories(&world.contacts, &self.slots);
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
        let grains = &mut world.grains;
        let indices = self.slots.grains().iter().map(|grain| *grain as usize);
        let rows = self.loads.iter().zip(&self.accounts);
        for (i, (body, (load, account))) in indices.clone().zip(self.bodies.iter().zip(rows)) {
            grains.position[i] = vector(body.position);
            grains.velocity[i] = vector(body.velocity);
            grains.spin[i] = vector(body.spin);
            grains.force[i] = vector(load.force);
            grains.torque[i] = vector(load.torque);
            grains.rolling_torque[i] = vector(load.rolling);
            grains.contact_count[i] = load.contact_count() as u32;
            grains.exchanged[i] = account.exchanged;
        }
        let wet = self.bridge_loads.iter().zip(&self.films);
        for (i, ([viscous, capillary, open], film)) in indices.zip(wet) {
            grains.film[i] = *film;
            grains.open_bridges[i] = *open as u32;
            grains.liquid_loss[i] = [*viscous, *capillary];
        }
        world.ledger.ruptures += self.ruptures;
        world.contacts.clear();
        self.collect_contacts(pool, &mut world.contacts);
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
    /// Rows of the grains, slot by slot, and of the padding body.
    fn load_grains(&mut self, pool: &mut WorkerPool, world: &World) {
        let (grains, dt) = (&world.grains, world.clock.time_step);
        let count = grains.len();
        for bodies in [&mut self.bodies, &mut self.next_bodies] {
            bodies.resize(count + 1, Sphere::default());
            bodies[count] = Sphere::default();
        }
        self.loads.resize(count, SphereLoad::default());
        self.accounts.resize(count, SphereAccount::default());
        let ranges = pool.ranges(count, 1);
        let rows = split_once(&mut self.loads, ranges.iter().cloned())
            .zip(split_once(&mut self.accounts, ranges.iter().cloned()));
        let rows = split_once(&mut self.bodies, ranges.iter().cloned()).zip(rows);
        let shares = ranges.iter().cloned().zip(rows).collect();
        let indices = self.slots.grains();
        pool.map(shares, |(range, (bodies, (loads, accounts)))| {
            let rows = bodies.iter_mut().zip(loads.iter_mut().zip(accounts));
            for ((body, (load, account)), grain) in rows.zip(&indices[range]) {
                let i = *grain as usize;
                *body = Sphere::of(grains, i);
                *load = SphereLoad::of(grains, i);
                *account = SphereAccount::of(grains, i, dt);
            }
        });
    }

    /// Films, bridges and what bridges have done; the lists reach as far as any bridge can.
    fn load_liquid(&mut self, world: &World) {
        self.liquid = world.wetting().copied();
        self.films.clear();
        self.next_films.clear();
        self.bridge_loads.clear();
        self.ruptures = 0;
        let Some(liquid) = self.liquid else {
            self.neighbours.set_reach(None);
            return;
        };
        let grains = &world.grains;
        for i in self.slots.grains().iter().map(|grain| *grain as usize) {
            let [viscous, capillary] = grains.liquid_loss[i];
            let open = f64::from(grains.open_bridges[i]);
            self.bridge_loads.push([viscous, capillary, open]);
            self.films.push(grains.film[i]);
        }
        self.films.push(0.0);
        self.next_films.clone_from(&self.films);
        self.neighbours
            .set_reach(Some(largest_reach(world, &liquid)));
        self.adopt_bridges(world, &liquid);
    }

    /// Makes the pairs of `world` the listed ones, so that the next refresh keeps all that bridges
    /// hold.
    fn adopt_bridges(&mut self, world: &World, liquid: &Liquid) {
        let mut kinds = BridgeKinds::of(liquid);
        let mut rows = Vec::new();
        for contact in &world.contacts {
            let Partner::Grain(partner) = contact.partner else {
                continue;
            };
            let radius = &world.grains.radius;
            let radii = (radius[contact.grain as usize], radius[partner as usize]);
            let bridge = contact.bridge.as_ref();
            let bridge = bridge.map_or(BridgeRow::default(), |bridge| {
                BridgeRow::of(bridge, &mut kinds, radii)
            });
            let pair = self.pair(contact, self.slots.slot_of(partner));
            rows.push((pair, bridge));
        }
        rows.sort_unstable_by_key(|(pair, ..)| pair.key());
        let mut list = SpherePairs {
            springs: vec![UNLOADED; rows.len()],
            rolling: vec![UNLOADED; rows.len()],
            bridges: Bridges::none(rows.len()),
            ..SpherePairs::default()
        };
        for (k, (pair, bridge)) in rows.into_iter().enumerate() {
            list.pairs.push(pair);
            list.bridges.set(k, &bridge);
        }
        self.neighbours.adopt(list);
    }

    /// The pair of a contact with this partner; its kind does not matter.
    fn pair<P>(&self, contact: &Contact, partner: P) -> SpherePair<P> {
        SpherePair {
            grain: self.slots.slot_of(contact.grain),
            partner,
            kind: PairKind::default(),
        }
    }

    /// Makes the lists fit the positions that were just loaded.
    fn fit_lists(&mut self, pool: &mut WorkerPool, world: &World) {
        if self.liquid.is_some() || !self.neighbours.inner_covers(&self.bodies, &self.walls) {
            self.refresh(pool);
        }
        self.kinds.compute(self.source, world);
        let slack = self.neighbours.slack();
        self.motion.slack_squared = slack * slack;
    }

    /// The contacts of the grains, sorted by grain and partner.
    fn collect_contacts(&self, pool: &mut WorkerPool, contacts: &mut Vec<Contact>) {
        let ranges = pool.ranges(self.loads.len(), 1);
        let found = pool.map(ranges, |range| {
            let mut found = Vec::new();
            for i in range {
                let parts = self.neighbours.parts.of(self.slots.slot_of(i as u32));
                let contact = |part: &Part| self.neighbours.contact(*part, &self.slots);
                found.extend(parts.iter().filter_map(contact));
            }
            found
        });
        let count = found.iter().map(Vec::len).sum();
        contacts.reserve(count);
        for mut own in found {
            contacts.append(&mut own);
        }
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

/// Largest gap that a bridge of `world` can hold [m], for the largest grains and the thickest
/// films.
fn largest_reach(world: &World, liquid: &Liquid) -> f64 {
    let largest = |column: &[f64]| column.iter().copied().fold(0.0, f64::max);
    let (radius, film) = (largest(&world.grains.radius), largest(&world.grains.film));
    let (first, second) = contributions(liquid, (radius, radius), (film, film));
    let held = world.contacts.iter().filter_map(|c| c.bridge.as_ref());
    let volume = held
        .map(|bridge| bridge.volume)
        .fold(first + second, f64::max);
    rupture_gap(liquid, (radius, radius), volume)
}
