//! How the equations of motion are integrated: a choice of the scene, and how far polyhedra may move in
//! a step.
//!
//! Not here: the integration itself, which is the solver's.

use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// How the equations of motion are integrated. Both agree as the step becomes shorter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(remote = "Self")]
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

    /// The share of its sphero-radius by which no point of a polyhedron may move in a step: features
    /// could pass through each other unseen. Where steps are as long as that allows, two bodies may
    /// come in one step half of the way at which they touch.
    pub fn largest_move(self) -> f64 {
        match self {
            Self::Explicit => 0.25,
            Self::Implicit => 0.5,
        }
    }

    /// The share by which the fastest polyhedron should move at most in a step that is chosen for it:
    /// light ones that turn came to twice its speed.
    pub fn advised_move(self) -> f64 {
        0.4 * self.largest_move()
    }

    /// The number that it has in stored states; 1 was dashpots alone taken implicitly.
    fn number(self) -> u32 {
        match self {
            Self::Explicit => 0,
            Self::Implicit => 2,
        }
    }

    /// The name that it has in scenes.
    fn name(self) -> &'static str {
        match self {
            Self::Explicit => "Explicit",
            Self::Implicit => "Implicit",
        }
    }
}

impl Serialize for Integrator {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_unit_variant("Integrator", self.number(), self.name())
    }
}

impl<'de> Deserialize<'de> for Integrator {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            // By name, as derived.
            return Self::deserialize(deserializer);
        }
        let number = u32::deserialize(deserializer)?;
        let all = [Self::Explicit, Self::Implicit];
        let known = all.into_iter().find(|own| own.number() == number);
        known.ok_or_else(|| {
            Error::invalid_value(
                Unexpected::Unsigned(number.into()),
                &"the number of an integrator",
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_stored_states_are_those_of_earlier_builds() {
        let read = |bytes: &[u8]| postcard::from_bytes::<Integrator>(bytes).ok();
        for (own, bytes) in [(Integrator::Explicit, [0]), (Integrator::Implicit, [2])] {
            assert_eq!(postcard::to_stdvec(&own).unwrap(), bytes);
            assert_eq!(read(&bytes), Some(own));
        }
        assert_eq!((read(&[1]), read(&[3])), (None, None));
    }
}
