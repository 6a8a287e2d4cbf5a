//! One number that tells whether two worlds are the same to the bit.

use super::{Contact, Partner, Polyhedra, World};
use glam::DVec3;
use std::fmt;

/// Hash of a world's whole state. Equal hashes mean equal bits.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct StateHash(blake3::Hash);

impl fmt::Display for StateHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.to_hex()[..32])
    }
}

impl fmt::Debug for StateHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "StateHash({self})")
    }
}

impl World {
    /// Hash of all that moves: clock, grains, contacts with their histories, the liquid,
    /// polyhedra's orientations, the container's angle.
    pub fn hash(&self) -> StateHash {
        let mut hasher = blake3::Hasher::new();
        let mut number = |x: f64| {
            hasher.update(&x.to_bits().to_le_bytes());
        };
        number(self.time());
        number(self.clock.time_step);
        number(self.container.angle);
        self.hash_grains(&mut number);
        for contact in &self.contacts {
            hash_contact(contact, &mut number);
        }
        if self.wetting().is_some() {
            self.hash_liquid(&mut number);
        }
        if let Some(polyhedra) = &self.polyhedra {
            hash_polyhedra(polyhedra, &mut number);
        }
        StateHash(hasher.finalize())
    }

    fn hash_grains(&self, number: &mut impl FnMut(f64)) {
        let grains = &self.grains;
        for i in 0..grains.len() {
            let motion = [grains.position[i], grains.velocity[i], grains.spin[i]];
            let load = [grains.force[i], grains.torque[i], grains.rolling_torque[i]];
            vectors(number, motion);
            vectors(number, load);
            number(grains.mass[i]);
            number(f64::from(grains.species[i].0));
            number(f64::from(grains.contact_count[i]));
            numbers(number, grains.exchanged[i]);
        }
    }

    fn hash_liquid(&self, number: &mut impl FnMut(f64)) {
        let grains = &self.grains;
        for i in 0..grains.len() {
            number(grains.film[i]);
            number(f64::from(grains.open_bridges[i]));
            numbers(number, grains.liquid_loss[i]);
        }
        number(self.ledger.ruptures as f64);
    }
}

fn hash_contact(contact: &Contact, number: &mut impl FnMut(f64)) {
    number(f64::from(contact.grain));
    match contact.partner {
        Partner::Grain(j) => number(f64::from(j)),
        Partner::Wall(w) => number(-1.0 - f64::from(w)),
    }
    vectors(number, [contact.spring]);
    if contact.rolling != DVec3::ZERO {
        vectors(number, [contact.rolling]);
    }
    if let Some(bridge) = &contact.bridge {
        numbers(
            number,
            [
                bridge.volume,
                bridge.transfer,
                bridge.capillary,
                bridge.viscous,
            ],
        );
        vectors(number, [bridge.drag]);
    }
}

fn hash_polyhedra(polyhedra: &Polyhedra, number: &mut impl FnMut(f64)) {
    let motions = polyhedra
        .orientation
        .iter()
        .zip(&polyhedra.angular_momentum);
    for (orientation, angular_momentum) in motions {
        numbers(number, orientation.to_array());
        vectors(number, [*angular_momentum]);
    }
    for contact in &polyhedra.features {
        numbers(number, [contact.overlap, contact.dashpot]);
        vectors(number, [contact.spring]);
    }
}

fn numbers<const N: usize>(number: &mut impl FnMut(f64), values: [f64; N]) {
    values.into_iter().for_each(number);
}

fn vectors<const N: usize>(number: &mut impl FnMut(f64), vectors: [DVec3; N]) {
    for v in vectors {
        v.to_array().into_iter().for_each(&mut *number);
    }
}
