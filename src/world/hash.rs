//! One number that tells whether two worlds are the same to the bit.

use super::World;
use std::fmt;
use std::io::{BufWriter, Write};

/// Hash of a world's whole state, every field of it. Equal hashes mean equal bits.
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
    /// Hash of every field, in the form in which a session stores a world: clock, grains, contacts
    /// with their histories, shapes and features of polyhedra, liquid, materials, container, ledger.
    /// A field that is added to a world is hashed without being named here.
    ///
    /// # Panics
    /// Never: columns of numbers, names and choices have a binary form, and a hasher takes it all.
    pub fn hash(&self) -> StateHash {
        let mut bits = BufWriter::new(blake3::Hasher::new());
        let written = postcard::to_io(self, &mut bits).map(Write::flush);
        assert!(matches!(written, Ok(Ok(()))), "a world has a binary form");
        StateHash(bits.get_ref().finalize())
    }
}
