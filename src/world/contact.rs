//! A pair that touches or is held by a liquid bridge, and what it remembers.

use super::{Bridge, World};
use crate::physics::law::{Pairing, reduced};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Distance of two centres that share a contact without a liquid, in the sum of their radii, at most:
/// they touch, or did a step before.
const NEAR: f64 = 1.5;

/// The other side of a contact. Grains sort before walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Partner {
    /// Another grain, by index; always larger than the index of the contact's own grain.
    Grain(u32),
    /// A wall, by its index in the container.
    Wall(u32),
}

/// A pair that touches or is held by a liquid bridge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// The grain on which [`Contact::force`] acts; the smaller index of a pair of grains.
    pub grain: u32,
    /// The other side.
    pub partner: Partner,
    /// Tangential spring ξ, the elastic part of the tangential displacement of the grain's surface
    /// over its partner's [m].
    pub spring: DVec3,
    /// Stiffness `k_t` with which the spring was last stretched [N/m].
    pub stiffness: f64,
    /// Torque of rolling friction on the grain at the last force evaluation [N m].
    pub rolling: DVec3,
    /// Force on the grain at the last force evaluation [N].
    pub force: DVec3,
    /// Whether the two touched then.
    pub touching: bool,
    /// The bridge between them, if there is one. In a box: dry contacts stay small.
    pub bridge: Option<Box<Bridge>>,
}

impl World {
    /// All contacts and bridges of `grain`, in their order.
    ///
    /// Contacts are sorted by grain and partner. Where no liquid holds grains together, those that
    /// others share with this one are looked for among those near it alone: tall columns have a quarter
    /// of a million.
    pub fn contacts_of(&self, grain: usize) -> Vec<&Contact> {
        let own = Partner::Grain(grain as u32);
        if self.liquid.is_some() {
            let concerns =
                |contact: &&Contact| contact.grain == grain as u32 || contact.partner == own;
            return self.contacts.iter().filter(concerns).collect();
        }
        let (places, radii) = (&self.grains.position, &self.grains.radius);
        let (Some(&x), Some(&r)) = (places.get(grain), radii.get(grain)) else {
            return Vec::new();
        };
        let is_near = |j: &usize| {
            let reach = NEAR * (radii[*j] + r);
            places[*j].distance_squared(x) < reach * reach
        };
        let of_other = |j: usize| {
            let key = (j as u32, own);
            let at = |contact: &Contact| (contact.grain, contact.partner).cmp(&key);
            let index = self.contacts.binary_search_by(at).ok()?;
            Some(&self.contacts[index])
        };
        let before = |contact: &Contact| (contact.grain as usize) < grain;
        let first = self.contacts.partition_point(before);
        let others = (0..grain).filter(is_near).filter_map(of_other);
        let its = self.contacts[first..].iter();
        let its = its.take_while(|contact| contact.grain as usize == grain);
        others.chain(its).collect()
    }

    /// What `grain` and its `partner` are to each other.
    pub fn pairing(&self, grain: usize, partner: Partner) -> Pairing {
        let (world, grains) = (self, &self.grains);
        let material = |i: usize| world.species[usize::from(grains.species[i].0)].material;
        match partner {
            Partner::Grain(j) => {
                let j = j as usize;
                Pairing {
                    effective_radius: reduced(grains.radius[grain], grains.radius[j]),
                    effective_mass: reduced(grains.mass[grain], grains.mass[j]),
                    radii: (grains.radius[grain], grains.radius[j]),
                    materials: (material(grain), material(j)),
                }
            }
            Partner::Wall(w) => Pairing {
                effective_radius: grains.radius[grain],
                effective_mass: grains.mass[grain],
                radii: (grains.radius[grain], 0.0),
                materials: (material(grain), world.container.walls[w as usize].material),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::solver::Solver;
    use crate::world::build;

    /// Both sides of each contact are found, in the order in which all contacts stand.
    #[test]
    fn contacts_of_a_grain_are_those_that_name_it() {
        for (name, liquid, steps) in [
            ("small-column", "0", 200),
            ("small-drum", "0", 5000),
            ("small-drum", "4", 5000),
        ] {
            let mut scene = Scene::open(name).unwrap();
            if liquid != "0" {
                scene.set("liquid", liquid).unwrap();
            }
            let mut world = build(&scene, 1e-5);
            Solver::new(1).advance(&mut world, steps).unwrap();
            let mut found = 0;
            for grain in 0..world.grains.len() {
                let own = Partner::Grain(grain as u32);
                let names =
                    |contact: &&Contact| contact.grain as usize == grain || contact.partner == own;
                let expected: Vec<&Contact> = world.contacts.iter().filter(names).collect();
                assert_eq!(
                    world.contacts_of(grain),
                    expected,
                    "{name}, liquid {liquid}, grain {grain}"
                );
                found += expected.len();
            }
            assert!(found > 0, "{name}, liquid {liquid}");
        }
        assert!(
            build(&Scene::open("small-drum").unwrap(), 1e-5)
                .contacts_of(10_000)
                .is_empty()
        );
    }
}
