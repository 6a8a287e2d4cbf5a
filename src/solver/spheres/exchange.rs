//! How grains, films and contacts come into the working copy and back.
//!
//! In: the world's columns, in the order of the grains' indices. Out: rows in slots; and the same the
//! other way. Whoever writes goes through his own part in order and reads the other side where it
//! stands, so that workers share the work. All of it is exact.
//!
//! Not here: what a step does with the rows.

use super::super::ranges::split_once;
use super::super::row::vector;
use super::super::tangential::UNLOADED;
use super::super::workers::WorkerPool;
use super::bridges::{BridgeRow, Bridges};
use super::integrate::{SphereAccount, SphereLoad};
use super::pair_list::{PairOrder, SpherePairs};
use super::rows::{PairKind, Sphere, SpherePair};
use super::working_copy::SphereKernel;
use crate::physics::Liquid;
use crate::physics::law::{BridgeKinds, contributions, rupture_gap};
use crate::world::{Contact, Grains, Partner, World};
use glam::DVec3;
use std::ops::Range;

impl<S: Sync> SphereKernel<S> {
    /// Rows of the grains, slot by slot, and of the padding body.
    pub(super) fn load_grains(&mut self, pool: &mut WorkerPool, world: &World) {
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
    pub(super) fn load_liquid(&mut self, world: &World) {
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

    /// Columns of the grains, in the order of their indices.
    pub(super) fn store_grains(&self, pool: &mut WorkerPool, grains: &mut Grains) {
        let (bodies, loads, accounts) = (&self.bodies, &self.loads, &self.accounts);
        self.store_column(pool, &mut grains.position, |i| vector(bodies[i].position));
        self.store_column(pool, &mut grains.velocity, |i| vector(bodies[i].velocity));
        self.store_column(pool, &mut grains.spin, |i| vector(bodies[i].spin));
        self.store_column(pool, &mut grains.force, |i| vector(loads[i].force));
        self.store_column(pool, &mut grains.torque, |i| vector(loads[i].torque));
        self.store_column(pool, &mut grains.rolling_torque, |i| {
            vector(loads[i].rolling)
        });
        self.store_column(pool, &mut grains.contact_count, |i| {
            loads[i].contact_count() as u32
        });
        self.store_column(pool, &mut grains.exchanged, |i| accounts[i].exchanged);
        if self.bridge_loads.is_empty() {
            return;
        }
        let (wet, films) = (&self.bridge_loads, &self.films);
        self.store_column(pool, &mut grains.film, |i| films[i]);
        self.store_column(pool, &mut grains.open_bridges, |i| wet[i][2] as u32);
        self.store_column(pool, &mut grains.liquid_loss, |i| [wet[i][0], wet[i][1]]);
    }

    /// One of them: `entry` tells a grain's from its slot.
    fn store_column<T: Send>(
        &self,
        pool: &mut WorkerPool,
        column: &mut [T],
        entry: impl Fn(usize) -> T + Sync,
    ) {
        let ranges = pool.ranges(column.len(), 1);
        let parts = split_once(column, ranges.iter().cloned());
        let shares = ranges.iter().cloned().zip(parts).collect();
        pool.map(shares, |(range, part): (Range<usize>, &mut [T])| {
            for (to, grain) in part.iter_mut().zip(range) {
                *to = entry(self.slots.slot_of(grain as u32).index());
            }
        });
    }

    /// The contacts of the grains, sorted by grain and partner.
    pub(super) fn store_contacts(&self, pool: &mut WorkerPool, contacts: &mut Vec<Contact>) {
        let ranges = pool.ranges(self.loads.len(), 1);
        let slots = |grains: Range<usize>| grains.map(|grain| self.slots.slot_of(grain as u32));
        let count = |grains| -> usize {
            slots(grains)
                .map(|slot| self.neighbours.contact_count(slot))
                .sum()
        };
        let mut end = 0;
        let places: Vec<Range<usize>> = (pool.map(ranges.clone(), count).into_iter())
            .map(|count| {
                end += count;
                end - count..end
            })
            .collect();
        contacts.resize(end, NO_CONTACT);
        let parts = split_once(contacts, places.into_iter());
        let shares = ranges.into_iter().zip(parts).collect();
        pool.map(shares, |(grains, part): (Range<usize>, &mut [Contact])| {
            let found =
                slots(grains).flat_map(|slot| self.neighbours.contacts_of(slot, &self.slots));
            for (to, contact) in part.iter_mut().zip(found) {
                *to = contact;
            }
        });
    }
}

/// What stands where a contact will.
const NO_CONTACT: Contact = Contact {
    grain: 0,
    partner: Partner::Wall(0),
    spring: DVec3::ZERO,
    stiffness: 0.0,
    rolling: DVec3::ZERO,
    force: DVec3::ZERO,
    touching: false,
    bridge: None,
};

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
