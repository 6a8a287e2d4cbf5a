//! One number that tells whether two worlds are the same to the bit.

use super::{Partner, World};
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
    /// Hash of all that moves: clock, grains, contacts with their histories, polyhedra's orientations, the container's angle.
    pub fn hash(&self) -> StateHash {
        let mut hasher = blake3::Hasher::new();
        let mut number = |x: f64| {
            hasher.update(&x.to_bits().to_le_bytes());
        };
        number(self.time());
        number(self.clock.time_step);
        number(self.container.angle);
        let grains = &self.grains;
        for i in 0..grains.len() {
            vectors(
                &mut number,
                [grains.position[i], grains.velocity[i], grains.spin[i]],
            );
            vectors(
                &mut number,
                [grains.force[i], grains.torque[i], grains.rolling_torque[i]],
            );
            number(grains.mass[i]);
            number(f64::from(grains.species[i].0));
            number(f64::from(grains.contact_count[i]));
            grains.exchanged[i].into_iter().for_each(&mut number);
        }
        for contact in &self.contacts {
            number(f64::from(contact.grain));
            match contact.partner {
                Partner::Grain(j) => number(f64::from(j)),
                Partner::Wall(w) => number(-1.0 - f64::from(w)),
            }
            vectors(&mut number, [contact.spring]);
            if let Some(bridge) = &contact.bridge {
                [bridge.volume, bridge.transfer]
                    .into_iter()
                    .for_each(&mut number);
                [bridge.capillary, bridge.viscous]
                    .into_iter()
                    .for_each(&mut number);
                vectors(&mut number, [bridge.drag]);
            }
        }
        if self.wetting().is_some() {
            for i in 0..grains.len() {
                number(grains.film[i]);
                number(f64::from(grains.open_bridges[i]));
                grains.liquid_loss[i].into_iter().for_each(&mut number);
            }
            number(self.ledger.ruptures as f64);
        }
        if let Some(polyhedra) = &self.polyhedra {
            for (turn, momentum) in polyhedra
                .orientation
                .iter()
                .zip(&polyhedra.angular_momentum)
            {
                turn.to_array().into_iter().for_each(&mut number);
                vectors(&mut number, [*momentum]);
            }
            for contact in &polyhedra.features {
                [contact.overlap, contact.dashpot]
                    .into_iter()
                    .for_each(&mut number);
                vectors(&mut number, [contact.spring]);
            }
        }
        StateHash(hasher.finalize())
    }
}

fn vectors<const N: usize>(number: &mut impl FnMut(f64), vectors: [DVec3; N]) {
    for v in vectors {
        v.to_array().into_iter().for_each(&mut *number);
    }
}
