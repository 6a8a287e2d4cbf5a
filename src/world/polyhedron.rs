//! One rounded convex polyhedron in its body frame.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A convex core and the radius by which it is rounded: the body is all that lies within `rounding` of the core.
///
/// The body frame has its origin at the centroid of the solid that mass and inertia belong to and its axes along that
/// solid's principal axes. A core of one vertex, without edges or faces, is a sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Polyhedron {
    /// Corners of the core [m].
    pub vertices: Vec<DVec3>,
    /// Edges of the core: pairs of vertices, each pair once.
    pub edges: Vec<[u16; 2]>,
    /// Faces of the core: each a loop of vertices, anticlockwise seen from outside.
    pub faces: Vec<Vec<u16>>,
    /// Rounding radius `R_s` [m].
    pub rounding: f64,
    /// Volume of the solid that the mass belongs to: for a Voronoi grain its whole cell [m³].
    pub volume: f64,
    /// Principal second moments of that solid over its volume, `inertia / mass` [m²].
    pub gyration: DVec3,
}

impl Polyhedron {
    /// A sphere.
    pub fn sphere(radius: f64) -> Self {
        Self {
            vertices: vec![DVec3::ZERO],
            edges: Vec::new(),
            faces: Vec::new(),
            rounding: radius,
            volume: 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius,
            gyration: DVec3::splat(0.4 * radius * radius),
        }
    }

    /// Distance of the farthest point of the surface from the origin of the body frame [m].
    pub fn bounding_radius(&self) -> f64 {
        let farthest = self.vertices.iter().map(|v| v.length());
        farthest.fold(0.0, f64::max) + self.rounding
    }
}
