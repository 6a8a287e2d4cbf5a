//! A pair that touches or is held by a liquid bridge, and what it remembers.

use super::{Bridge, World};
use crate::physics::law::{Pairing, reduced};
use glam::DVec3;
use serde::{Deserialize, Serialize};

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
