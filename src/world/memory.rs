//! How much memory a state takes.

use super::{Bridge, Grains, Polyhedra, World};
use std::mem::size_of_val;

impl World {
    /// Memory that a clone of this world takes [bytes]; shapes of polyhedra and
    /// meshes of walls are shared by all clones and do not count.
    pub fn memory(&self) -> usize {
        let bridges = self.contacts.iter().filter(|c| c.bridge.is_some()).count();
        size_of_val(self)
            + self.grains.memory()
            + size_of_val(&self.contacts[..])
            + bridges * size_of::<Bridge>()
            + self.polyhedra.as_ref().map_or(0, |own| own.memory())
    }
}

impl Grains {
    fn memory(&self) -> usize {
        let vectors = [
            &self.position,
            &self.velocity,
            &self.spin,
            &self.force,
            &self.torque,
            &self.rolling_torque,
        ];
        let numbers = [&self.radius, &self.mass, &self.inertia, &self.film];
        let counts = [&self.contact_count, &self.open_bridges];
        vectors
            .map(|column| size_of_val(&column[..]))
            .iter()
            .sum::<usize>()
            + numbers
                .map(|column| size_of_val(&column[..]))
                .iter()
                .sum::<usize>()
            + counts
                .map(|column| size_of_val(&column[..]))
                .iter()
                .sum::<usize>()
            + size_of_val(&self.species[..])
            + size_of_val(&self.exchanged[..])
            + size_of_val(&self.liquid_loss[..])
    }
}

impl Polyhedra {
    fn memory(&self) -> usize {
        size_of_val(self)
            + size_of_val(&self.shape[..])
            + size_of_val(&self.orientation[..])
            + size_of_val(&self.angular_momentum[..])
            + size_of_val(&self.inertia[..])
            + size_of_val(&self.features[..])
    }
}
