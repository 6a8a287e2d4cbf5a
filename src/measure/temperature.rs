//! Granular temperature: how much grains move relative to their neighbours (Eqs. 21 and 22 of
//! Kasper et al. 2021).
//!
//! `Tg = 1/(3 N) Σ |U_i|²` with `U_i = u_i − ū_i`, where `ū_i` is the mean velocity of the grains,
//! without `i`, whose centres lie within a sphere of radius 7r/3 around the centre of `i`; in a
//! mixture, within 7/6 of the sum of both radii. A grain with no neighbour has no `U_i` and is left
//! out of the sum and of `N`.
//!
//! In the laboratory frame even a rigid rotation has some temperature, because a grain's neighbours
//! are not placed evenly around it; in the frame that turns with the drum it has none.

use super::near_pairs::for_each_near_pair;
use crate::world::World;
use glam::DVec3;

/// Reach of the neighbourhood relative to the sum of two radii: 7r/3 for equal grains.
const REACH: f64 = 7.0 / 6.0;

/// The granular temperature in two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperatures {
    /// Of the velocities in the laboratory frame [m²/s²]; NaN where no grain has a neighbour.
    pub laboratory: f64,
    /// Of the velocities relative to the turning drum [m²/s²]; NaN where no grain has a neighbour.
    pub corotating: f64,
}

/// Granular temperature in the laboratory frame [m²/s²] of the grains of `world` turning with their
/// drum as one rigid body; NaN where no grain has a neighbour.
pub fn rotation_temperature(world: &World) -> f64 {
    let drum_spin = world.container.spin();
    let (mut sum, mut count) = (0.0, 0_u32);
    for around in neighbourhoods(world)
        .iter()
        .filter(|around| around.count > 0)
    {
        let turning = drum_spin.cross(around.offset / f64::from(around.count));
        sum += turning.length_squared();
        count += 1;
    }
    sum / (3.0 * f64::from(count))
}

/// Sums over the neighbours of one grain.
#[derive(Clone, Copy, Default)]
struct Around {
    count: u32,
    velocity: DVec3,
    offset: DVec3,
}

impl Around {
    fn add(&mut self, velocity: DVec3, offset: DVec3) {
        self.count += 1;
        self.velocity += velocity;
        self.offset += offset;
    }
}

/// Granular temperatures of `world` now.
pub fn granular_temperatures(world: &World) -> Temperatures {
    let drum_spin = world.container.spin();
    let (mut laboratory, mut corotating, mut count) = (0.0, 0.0, 0_u32);
    for (own, around) in world.grains.velocity.iter().zip(neighbourhoods(world)) {
        if around.count == 0 {
            continue;
        }
        let neighbours = f64::from(around.count);
        let fluctuation = *own - around.velocity / neighbours;
        // Both frames share the neighbourhood: u_i − ū_i differs by Ω × (x̄ − x_i).
        let turning = drum_spin.cross(around.offset / neighbours);
        laboratory += fluctuation.length_squared();
        corotating += (fluctuation + turning).length_squared();
        count += 1;
    }
    let degrees_of_freedom = 3.0 * f64::from(count);
    Temperatures {
        laboratory: laboratory / degrees_of_freedom,
        corotating: corotating / degrees_of_freedom,
    }
}

/// The part of each grain in the temperature of the drum's frame, `|U_i|²/3`, zero without a
/// neighbour [m²/s²].
pub(super) fn fluctuations(world: &World) -> Vec<f64> {
    let drum_spin = world.container.spin();
    let around = neighbourhoods(world);
    let grains = world.grains.velocity.iter().zip(around);
    let part = |(own, around): (&DVec3, Around)| {
        let neighbours = f64::from(around.count.max(1));
        let turning = drum_spin.cross(around.offset / neighbours);
        let fluctuation = *own - around.velocity / neighbours + turning;
        if around.count > 0 {
            fluctuation.length_squared() / 3.0
        } else {
            0.0
        }
    };
    grains.map(part).collect()
}

fn neighbourhoods(world: &World) -> Vec<Around> {
    let grains = &world.grains;
    let mut around = vec![Around::default(); grains.len()];
    let largest = grains.radius.iter().copied().fold(0.0, f64::max);
    for_each_near_pair(&grains.position, REACH * 2.0 * largest, |i, j, offset| {
        let reach = REACH * (grains.radius[i] + grains.radius[j]);
        if offset.length_squared() < reach * reach {
            around[i].add(grains.velocity[j], offset);
            around[j].add(grains.velocity[i], -offset);
        }
    });
    around
}
