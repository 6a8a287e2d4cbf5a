//! How the equations of motion are integrated: a choice of the scene.
//!
//! Not here: the integration itself, which is the solver's.

use serde::{Deserialize, Serialize};

/// How the equations of motion are integrated. All integrators agree as the step becomes shorter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// Velocity Verlet; dashpots take the velocity of half a step ago. The step must be shorter
    /// than the time in which all dashpots of a grain stop it.
    #[default]
    Explicit,
    /// Velocity Verlet for springs, friction and gravity, the θ-method for the dashpots of
    /// polyhedra (IMEX, implicit–explicit): dashpots limit the step no longer. Spheres move as with
    /// [`Self::Explicit`].
    Imex,
    /// Springs and dashpots of polyhedra are taken implicitly, for all bodies together: neither
    /// limits the step. Spheres move as with [`Self::Explicit`].
    Implicit,
}

impl Integrator {
    /// Whether it is the explicit one.
    pub fn is_explicit(&self) -> bool {
        *self == Self::Explicit
    }
}
