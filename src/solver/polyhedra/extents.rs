//! Sizes of a world of polyhedra, and the bounds that follow from them.
//!
//! In: bodies and walls where they are. Out: how far anything is from anything that matters to it,
//! what rounding may add to a motion, and by how much a computed distance may jump: so that the
//! slack of a list is a bound to the last bit.
//!
//! Not here: how far two bodies move in a step ([`super::motion`]).

use super::super::walls::Walls;
use super::bodies::Body;
use super::nearest::PARALLEL;
use crate::world::Surface;
use glam::DVec3;

/// Sizes that bound how far two bodies move relative to each other in a step, to the last bit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extents {
    /// Distance of any point of a body from the centroid of another that is near it, at most [m].
    pub between_grains: f64,
    /// Distance of any point of a body from the origin, about which walls move, at most [m].
    pub to_origin: f64,
    /// What rounding adds to the relative motion of two bodies in a step, at most [m].
    pub rounding: f64,
}

/// Roundings that a coordinate meets in a step and in the computation of a distance, generously
/// counted, each of half the distance of two neighbouring numbers of its size.
const ROUNDINGS: f64 = 32.0;

impl Extents {
    /// For pairs of `bodies`, and of them with `walls`, nearer than their reaches and `skin` [m].
    pub fn of(bodies: &[Body], walls: &Walls, skin: f64) -> Self {
        let largest = |v: DVec3| v.abs().max_element();
        let centres = bodies.iter().map(|body| largest(body.centre()));
        let walls = walls.surfaces().map(|surface| match surface {
            Surface::Plane { point, .. } => largest(*point),
            Surface::Cylinder { radius } => *radius,
            Surface::Tube { radius, rim } => radius.max(rim.abs()),
            Surface::Mesh(mesh) => {
                let corners = mesh.triangles().flatten();
                corners.map(largest).fold(0.0, f64::max)
            }
        });
        let coordinate = centres.chain(walls).fold(0.0, f64::max);
        let reach = bodies.iter().map(Body::reach).fold(0.0, f64::max);
        let to_origin = 2.0 * coordinate + reach + skin;
        Self {
            between_grains: 3.0 * reach + 2.0 * skin,
            to_origin,
            rounding: ROUNDINGS * f64::EPSILON * to_origin,
        }
    }

    /// How much a computed distance of features of two bodies may jump, the first of which reaches
    /// to `reach`, that touch at `touch` and whose faces are as `uneven` [m]. Edges change from
    /// crossing to parallel where the square of their sine is [`PARALLEL`]: this is what a tilt
    /// sideways does, and [`super::nearest::Nearest::least_distance`] counts one towards each other;
    /// a vertex leaves a face across an edge that is not quite in its plane.
    pub fn margin(&self, reach: f64, touch: f64, uneven: f64) -> f32 {
        let parallel = 2.0 * PARALLEL * reach * reach / touch;
        let margin = 4.0 * (parallel + uneven + self.rounding);
        margin as f32
    }
}
