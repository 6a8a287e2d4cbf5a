//! How the equations of motion are integrated: a choice of the scene.
//!
//! Not here: the integration itself, which is the solver's.

use serde::{Deserialize, Serialize};

/// How the equations of motion are integrated. Both agree as the step becomes shorter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub enum Integrator {
    /// Velocity Verlet; dashpots take the velocity of half a step ago. The step must be shorter
    /// than the time in which all dashpots of a grain stop it.
    #[default]
    Explicit,
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

/// An integrator as scenes and states write it, with the number that it has there.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Integrator")]
enum Stored {
    Explicit,
    /// Of earlier versions: dashpots alone were implicit.
    Imex,
    Implicit,
}

impl From<Integrator> for Stored {
    fn from(integrator: Integrator) -> Self {
        match integrator {
            Integrator::Explicit => Self::Explicit,
            Integrator::Implicit => Self::Implicit,
        }
    }
}

impl TryFrom<Stored> for Integrator {
    type Error = &'static str;

    fn try_from(stored: Stored) -> Result<Self, Self::Error> {
        match stored {
            Stored::Explicit => Ok(Self::Explicit),
            Stored::Imex => Err(
                "the integrator `Imex` is no longer there: write `Implicit`, which takes longer steps and is \
                 more accurate",
            ),
            Stored::Implicit => Ok(Self::Implicit),
        }
    }
}
