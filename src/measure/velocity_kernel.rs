//! The local mean of the grains' velocities in the cross-section.
//!
//! In: a world and a point of the x–y plane. Out: the mean velocity of the grains near it, each
//! weighed by a Gaussian of its distance in that plane, whatever its place along the axis. The
//! kernel reaches as far as that of Kasper et al. 2021: 8 mm, and 11 mm for grains of 3 mm; here
//! that is where the Gaussian is cut off, at two standard deviations.

use super::surface::mean_radius;
use crate::world::World;
use glam::DVec2;

/// Reach of the kernel in mean radii, within [`REACH`].
const REACH_IN_RADII: f64 = 11.0 / 3.0;
/// Reach of the kernel [m].
const REACH: std::ops::RangeInclusive<f64> = 0.008..=0.011;
/// Standard deviations at which the kernel is cut off.
const CUT_OFF: f64 = 2.0;

/// Reach of the kernel that suits the grains of `world` [m].
pub fn kernel_reach(world: &World) -> f64 {
    let reach = REACH_IN_RADII * mean_radius(&world.grains);
    reach.clamp(*REACH.start(), *REACH.end())
}

/// Mean velocity of the grains near `point` of the cross-section, each weighed by a Gaussian of its
/// distance that is cut off at `reach` [m]; none where there is no grain.
pub fn mean_velocity(world: &World, point: DVec2, reach: f64) -> Option<DVec2> {
    let (mut weights, mut sum) = (0.0, DVec2::ZERO);
    for (position, velocity) in world.grains.position.iter().zip(&world.grains.velocity) {
        let weight = weight((position.truncate() - point).length_squared(), reach);
        weights += weight;
        sum += weight * velocity.truncate();
    }
    (weights > 0.0).then(|| sum / weights)
}

/// Weight of a grain at this squared distance [m²] in a mean whose kernel is cut off at `reach`
/// [m].
fn weight(squared: f64, reach: f64) -> f64 {
    if squared < reach * reach {
        gaussian(squared, reach)
    } else {
        0.0
    }
}

/// The Gaussian of the kernel that is cut off at `reach` [m], at this squared distance [m²]: the
/// product of those of the distance's two parts.
pub(super) fn gaussian(squared: f64, reach: f64) -> f64 {
    let width = reach / CUT_OFF;
    (-0.5 * squared / (width * width)).exp()
}
