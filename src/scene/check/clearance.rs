//! How far a point is from the walls of a scene's container, and how deep a touch may be.

use crate::scene::container::{SceneContainer, SceneTube};
use glam::DVec3;

/// Overlap of a listed polyhedron with a wall that is still a contact, in rounding radii.
pub(super) const DEEPEST_ROUNDING: f64 = 0.5;

/// Overlap of two listed grains, or of one with a wall, that is still a contact, in radii of the
/// smaller grain.
pub(super) const LARGEST_OVERLAP: f64 = 0.1;

/// Distance of `x` from the nearest wall, negative behind it [m]; of a mesh, on whichever side.
pub(super) fn clearance(container: &SceneContainer, x: DVec3) -> f64 {
    match container {
        SceneContainer::Nothing => f64::INFINITY,
        SceneContainer::Drum { radius, width, .. } => {
            (radius - x.truncate().length()).min(0.5 * width - x.z.abs())
        }
        SceneContainer::Box { min, max, .. } => (x - *min).min(*max - x).min_element(),
        SceneContainer::Column { radius, tube, .. } => {
            let inside = radius - (x.x * x.x + x.z * x.z).sqrt();
            // Below its rim a tube that has risen holds nothing, and grains lie on both sides of it.
            let from = |tube: &SceneTube| match tube.rim {
                rim if x.y < rim => f64::INFINITY,
                rim if rim > 0.0 => inside.abs(),
                _ => inside,
            };
            tube.as_ref().map_or(x.y, |tube| x.y.min(from(tube)))
        }
        SceneContainer::Mesh { surface, .. } => surface.distance(x),
        SceneContainer::Planes(planes) => planes
            .iter()
            .map(|plane| (x - plane.point).dot(plane.normal))
            .fold(f64::INFINITY, f64::min),
    }
}

/// Whether `x` is no part of the column that the container is for.
pub(super) fn is_beside_column(container: &SceneContainer, x: DVec3) -> bool {
    matches!(container, SceneContainer::Column { radius, height, .. }
        if x.x * x.x + x.z * x.z > radius * radius || x.y > *height)
}
