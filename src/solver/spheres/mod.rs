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
//! | `kinds` | constants of each kind of pair |
//! | `rows` | what the pair loop reads and writes of grains and pairs |
//! | `contacts` | the pair loop: geometry, contact law, sliding, rolling |
//! | `bridges` | liquid bridges in the pair loop |
//! | `integrate` | sums of forces, velocity Verlet |
//! | `working_copy` | what is kept between loading a world and storing it |
//! | `share` | what one worker works on in the two phases of a step |
//!
//! Not here: the order of the stages (`super::step`), formulas of force laws
//! ([`crate::physics::law`]).

mod bridges;
mod contacts;
mod integrate;
mod kinds;
mod neighbours;
mod rows;
mod share;
mod slots;
mod working_copy;

use super::FaultKind;
use super::row::{length_squared, row, vector};
use super::step::{Kernel, Tally};
use super::walls::Walls;
use super::workers::Batch;
use crate::lanes::Processor;
use crate::physics::Liquid;
use crate::physics::law::{BridgeKinds, contributions, rupture_gap};
use crate::world::{Contact, Partner, World};
use bridges::{BridgeRow, Bridges};
use integrate::{Load, Motion, Start};
use neighbours::{Neighbours, PairList, grain_key, wall_key};
use rows::{Body, History, Pair};
use share::SphereShare;
pub use working_copy::Spheres;

/// A grain that moves by more than this share of its radius in one step is lost.
const LARGEST_MOVE: f64 = 0.1;

impl Kernel for Spheres {
    type Share<'a> = SphereShare<'a>;

    /// Lists and slots of the last call are kept where they still suit the world: they never show
    /// in a result. Histories are always the world's.
    fn load(&mut self, _processor: Processor, world: &World) {
        if !self.kinds.classify(world) {
            self.neighbours.forget();
        }
        let (grains, searches) = (&world.grains, self.neighbours.searches);
        if self.slots.is_stale(grains, searches) {
            self.slots.sort(grains, searches);
            self.neighbours.forget();
        }
        self.kinds.compute(world);
        self.law = world.law;
        self.walls.load(&world.container);
        self.motion = Motion {
            dt: world.clock.time_step,
            gravity: row(world.gravity, 0.0),
            slack_squared: 0.0,
        };
        self.load_grains(world);
        self.load_liquid(world);
        self.fit_lists(world);
        self.load_histories(&world.contacts);
    }

    fn start(&mut self, processor: Processor) -> bool {
        let count = self.loads.len();
        let start = Start {
            motion: &self.motion,
            bodies: &mut self.bodies[..count],
            loads: &self.loads,
            bridge_loads: &self.bridge_loads,
            references: &self.neighbours.reference,
        };
        processor.run(start).refresh
    }

    /// A search may meet kinds of pairs that there were none of before: they need constants.
    fn refresh_lists(&mut self, world: &World) -> u64 {
        let searches = self.refresh();
        self.kinds.complete(world);
        searches
    }

    fn adapt_lists(&mut self, steps: u64) {
        self.neighbours.adapt(steps);
    }

    fn steps_within_slack(&self) -> u64 {
        let slack = self.neighbours.slack();
        self.walls.steps_within(slack, self.motion.dt)
    }

    fn lend<'a>(&'a mut self, batch: &'a Batch) -> Vec<SphereShare<'a>> {
        SphereShare::all(self, batch)
    }

    /// Bridges that broke are booked when the world is put back.
    fn note(&mut self, tally: &Tally) {
        self.ruptures += tally.ruptures;
    }

    /// Columns are written in the order of the grains' indices, contacts too: slots do not show.
    fn store(&self, world: &mut World) {
        let grains = &mut world.grains;
        let indices = self.slots.grains().iter().map(|grain| *grain as usize);
        for (i, (body, load)) in indices.clone().zip(self.bodies.iter().zip(&self.loads)) {
            grains.position[i] = vector(body.position);
            grains.velocity[i] = vector(body.velocity);
            grains.spin[i] = vector(body.spin);
            grains.force[i] = vector(load.force);
            grains.torque[i] = vector(load.torque);
            grains.rolling_torque[i] = vector(load.rolling);
            grains.contact_count[i] = load.contact_count() as u32;
            grains.exchanged[i] = load.exchanged;
        }
        let wet = self.bridge_loads.iter().zip(&self.films);
        for (i, ([viscous, capillary, open], film)) in indices.zip(wet) {
            grains.film[i] = *film;
            grains.open_bridges[i] = *open as u32;
            grains.liquid_loss[i] = [*viscous, *capillary];
        }
        world.ledger.ruptures += self.ruptures;
        world.contacts.clear();
        self.collect_contacts(&mut world.contacts);
    }

    /// Of several grains the one of lowest index, so that the message does not depend on slots.
    fn find_fault(&self) -> (usize, FaultKind) {
        let rows = self.bodies.iter().zip(&self.loads);
        let found = self.slots.grains().iter().zip(rows);
        let (grain, kind) = found
            .filter_map(|(grain, (body, load))| Some((*grain, self.judge(body, load)?)))
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

impl Spheres {
    /// Rows of the grains, slot by slot, and of the padding body.
    fn load_grains(&mut self, world: &World) {
        let (grains, dt) = (&world.grains, world.clock.time_step);
        self.bodies.clear();
        self.loads.clear();
        for i in self.slots.grains().iter().map(|grain| *grain as usize) {
            let radius = grains.radius[i];
            self.bodies.push(Body {
                position: row(grains.position[i], 1.0 / grains.mass[i]),
                velocity: row(grains.velocity[i], 1.0 / grains.inertia[i]),
                spin: row(grains.spin[i], radius),
                free_spin: [0.0; 4],
            });
            let speed_limit = LARGEST_MOVE * radius / dt;
            self.loads.push(Load {
                force: row(grains.force[i], 0.0),
                torque: row(grains.torque[i], 0.0),
                rolling: row(grains.rolling_torque[i], f64::from(grains.contact_count[i])),
                exchanged: grains.exchanged[i],
                compliance: dt / grains.inertia[i],
                speed_limit_squared: speed_limit * speed_limit,
            });
        }
        self.bodies.push(Body::default());
    }

    /// Films, bridges and what bridges have done; the lists reach as far as any bridge can.
    fn load_liquid(&mut self, world: &World) {
        self.liquid = world.wetting().copied();
        self.films.clear();
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
            rows.push((self.pair(contact), history(contact), bridge));
        }
        rows.sort_unstable_by_key(|(pair, ..)| grain_key(pair));
        let mut list = PairList {
            bridges: Bridges::none(rows.len()),
            ..PairList::default()
        };
        for (k, (pair, history, bridge)) in rows.into_iter().enumerate() {
            list.pairs.push(pair);
            list.histories.push(history);
            list.bridges.set(k, &bridge);
        }
        self.neighbours.adopt(list);
    }

    /// The pair of a contact, by slots.
    fn pair(&self, contact: &Contact) -> Pair {
        Pair {
            grain: self.slots.slot_of(contact.grain),
            partner: match contact.partner {
                Partner::Grain(j) => self.slots.slot_of(j),
                Partner::Wall(w) => w,
            },
            kind: 0,
        }
    }

    /// Makes the lists fit the positions that were just loaded.
    fn fit_lists(&mut self, world: &World) {
        if self.liquid.is_some() || !self.neighbours.inner_covers(&self.bodies, &self.walls) {
            self.refresh();
        }
        self.kinds.compute(world);
        let slack = self.neighbours.slack();
        self.motion.slack_squared = slack * slack;
    }

    /// Gives the listed pairs the histories of the world's contacts; all others have none.
    fn load_histories(&mut self, contacts: &[Contact]) {
        let rows = contacts.iter().map(|contact| (self.pair(contact), contact));
        let (mut of_grains, mut of_walls): (Vec<_>, Vec<_>) =
            rows.partition(|(_, contact)| matches!(contact.partner, Partner::Grain(_)));
        let Neighbours { grains, walls, .. } = &mut self.neighbours;
        for (list, rows, key) in [
            (grains, &mut of_grains, grain_key as fn(&Pair) -> _),
            (walls, &mut of_walls, wall_key),
        ] {
            rows.sort_unstable_by_key(|(pair, _)| key(pair));
            let rows = rows.iter().map(|(pair, contact)| (*pair, history(contact)));
            let (pairs, histories): (Vec<_>, Vec<_>) = rows.unzip();
            list.load_histories(&pairs, &histories, key);
        }
    }

    /// The contacts of the grains, sorted by grain and partner.
    fn collect_contacts(&self, contacts: &mut Vec<Contact>) {
        let grains = self.slots.grains();
        for i in 0..self.loads.len() as u32 {
            let parts = self.neighbours.parts.of(self.slots.slot_of(i) as usize);
            let own = parts
                .iter()
                .filter_map(|part| self.neighbours.contact(*part));
            contacts.extend(own.map(|contact| Contact {
                grain: i,
                partner: match contact.partner {
                    Partner::Grain(slot) => Partner::Grain(grains[slot as usize]),
                    wall @ Partner::Wall(_) => wall,
                },
                ..contact
            }));
        }
    }

    /// Brings the lists up to date with the positions; returns how often neighbours were searched
    /// for.
    fn refresh(&mut self) -> u64 {
        let before = self.neighbours.searches;
        let (kinds, grains) = (&mut self.kinds, self.slots.grains());
        self.neighbours
            .refresh(&self.bodies, &self.walls, grains, |grain, partner| {
                kinds.of(grain, partner)
            });
        let slack = self.neighbours.slack();
        self.motion.slack_squared = slack * slack;
        self.neighbours.searches - before
    }

    /// What is wrong with a grain, if anything is.
    fn judge(&self, body: &Body, load: &Load) -> Option<FaultKind> {
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
        } else if speed_squared > load.speed_limit_squared {
            Some(FaultKind::TooFast(speed_squared.sqrt()))
        } else {
            None
        }
    }
}

/// What a contact remembers, in rows.
fn history(contact: &Contact) -> History {
    History {
        spring: row(contact.spring, contact.stiffness),
        rolling: row(contact.rolling, f64::from(u8::from(contact.touching))),
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
