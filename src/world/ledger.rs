//! What the energy balance needs beside the grains' own columns.

use serde::{Deserialize, Serialize};

/// Bookkeeping of the energy balance since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic and elastic energy at the start [J].
    pub initial_energy: f64,
    /// Work of gravity up to its last change [J].
    pub gravity_work: f64,
    /// Potential energy when the present gravity began to act [J].
    pub potential_reference: f64,
    /// Energy put in by commands that changed masses or stiffnesses [J].
    pub command_work: f64,
    /// Bridges that broke.
    pub ruptures: u64,
}

impl Ledger {
    /// A ledger that starts now, with `energy` (kinetic and elastic) and `potential` energy [J].
    pub fn starting_at(energy: f64, potential: f64) -> Self {
        Self {
            initial_energy: energy,
            potential_reference: potential,
            ..Self::default()
        }
    }

    /// Records that potential energy was `before` under the old gravity and is `after` under the
    /// new one [J].
    pub fn close_gravity_segment(&mut self, before: f64, after: f64) {
        self.gravity_work += self.potential_reference - before;
        self.potential_reference = after;
    }
}
