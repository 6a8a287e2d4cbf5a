//! How far the spheres of a run have turned since time zero, for pictures of them: no force depends
//! on it, so that it is no part of a world and of its hash.
//!
//! In: the spins from state to state. Out: a rotation for each grain. Between two states it turns
//! about the mean of both spins, which is exact while a spin stays or changes evenly; states are
//! at most [`LONGEST`] apart, and follow each other step by step where few
//! grains meet. Polyhedra have their orientations in the world.

use crate::world::World;
use glam::{DQuat, DVec3, Quat};
use std::sync::Arc;

/// Simulated time between two states at most [s]: spins in a bed jump at each impact, and over a
/// second their errors stay below some degrees.
const LONGEST: f64 = 2e-3;

/// A rotation for each sphere from what it was at time zero.
pub type Turned = Arc<[Quat]>;

/// How far each sphere has turned since time zero, where somebody looks at it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Orientations(Option<Followed>);

#[derive(Clone, Debug, PartialEq)]
struct Followed {
    of_grain: Vec<DQuat>,
    /// The spins at the last state [rad/s].
    spin: Vec<DVec3>,
    /// The time of that state [s].
    time: f64,
}

impl Orientations {
    /// Follows the spheres of `world` from now on; polyhedra say themselves how they lie.
    pub fn begin(&mut self, world: &World) {
        if self.0.is_none() && world.polyhedra.is_none() {
            self.0 = Some(Followed::of(world, None));
        }
    }

    /// Goes on from the state of `world`, where its spheres have turned as `known` says; where that
    /// is not known, from none that has turned.
    pub fn jump(&mut self, world: &World, known: Option<&[Quat]>) {
        if self.0.is_some() || known.is_some() {
            self.0 = Some(Followed::of(world, known));
        }
    }

    /// The step up to which `world` may go, of those until `stop`, before it is followed again.
    pub fn before(&self, stop: u64, world: &World) -> u64 {
        let steps = ((LONGEST / world.clock.time_step) as u64).max(1);
        match self.0 {
            Some(_) => stop.min(world.clock.step + steps),
            None => stop,
        }
    }

    /// Turns every sphere up to the state of `world`.
    pub fn follow(&mut self, world: &World) {
        let Some(followed) = &mut self.0 else { return };
        let passed = world.time() - followed.time;
        followed.time = world.time();
        let grains = followed.of_grain.iter_mut().zip(&mut followed.spin);
        for ((turn, before), now) in grains.zip(&world.grains.spin) {
            *turn = turned(*turn, 0.5 * passed * (*before + *now));
            *before = *now;
        }
    }

    /// A rotation for each sphere, where that is followed.
    pub fn shared(&self) -> Option<Turned> {
        let followed = self.0.as_ref()?;
        Some(
            followed
                .of_grain
                .iter()
                .map(|turn| turn.as_quat())
                .collect(),
        )
    }
}

impl Followed {
    fn of(world: &World, known: Option<&[Quat]>) -> Self {
        let count = world.grains.len();
        let known = known.filter(|known| known.len() == count);
        Self {
            of_grain: match known {
                Some(known) => known.iter().map(|turn| turn.as_dquat()).collect(),
                None => vec![DQuat::IDENTITY; count],
            },
            spin: world.grains.spin.to_vec(),
            time: world.time(),
        }
    }
}

/// `before`, turned by the vector `by` [rad]. The tangent of half the angle is taken to its
/// third order.
fn turned(before: DQuat, by: DVec3) -> DQuat {
    let half = 0.5 * by;
    let tangent = half * (1.0 + half.length_squared() / 3.0);
    let more = DQuat::from_xyzw(tangent.x, tangent.y, tangent.z, 1.0);
    (more * before).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_turns_add_up_to_a_large_one() {
        let by = DVec3::new(0.02, -0.05, 0.03);
        let turn = (0..1000).fold(DQuat::IDENTITY, |turn, _| turned(turn, by));
        let exact = DQuat::from_scaled_axis(1000.0 * by);
        // A thousandth of a degree after ten turns.
        assert!(turn.angle_between(exact) < 2e-5 || (-turn).angle_between(exact) < 2e-5);
    }
}
