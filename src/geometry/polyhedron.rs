//! One rounded convex polyhedron in its body frame.

use super::{Flaw, Solid};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Smallest and largest size of a body that is taken from a file, in SI units: products of a few of
/// them are numbers still.
const SMALLEST: f64 = 1e-60;
const LARGEST: f64 = 1e12;

/// A convex core and the radius by which it is rounded: the body is all that lies within `rounding`
/// of the core.
///
/// The body frame has its origin at the centroid of the solid that mass and inertia belong to and
/// its axes along that solid's principal axes. A core of one vertex, without edges or faces, is a
/// sphere.
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

/// A solid made a rounded polyhedron, and where its body frame is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rounded {
    /// The rounded polyhedron in its body frame.
    pub shape: Polyhedron,
    /// Centroid of the solid [m].
    pub position: DVec3,
    /// Rotation from body axes to the solid's.
    pub orientation: DQuat,
}

impl Polyhedron {
    /// `solid` with its edges and corners rounded: it is eroded by `rounding` [m], then dilated by
    /// it, so that flat faces stay where they were. Volume and moments are those of `solid` itself,
    /// as in the program of Man et al. 2023.
    ///
    /// # Errors
    /// [`Flaw::Empty`] where erosion leaves nothing.
    pub fn rounded(solid: &Solid, rounding: f64) -> Result<Rounded, Flaw> {
        let core = solid.eroded(rounding).ok_or(Flaw::Empty)?;
        let moments = solid.moments();
        let (orientation, second) = moments.principal_axes();
        let into_body = orientation.conjugate();
        let vertices = core.vertices.iter();
        let shape = Self {
            vertices: vertices
                .map(|x| into_body * (*x - moments.centroid))
                .collect(),
            edges: core.edges(),
            faces: core.faces,
            rounding,
            volume: moments.volume,
            gyration: (DVec3::splat(second.element_sum()) - second) / moments.volume,
        };
        Ok(Rounded {
            shape,
            position: moments.centroid,
            orientation,
        })
    }

    /// A `core` along its principal axes, about the centroid of a solid of this `volume` [m³] and
    /// `gyration` [m²], rounded by `rounding` [m]. Whether it is a body says
    /// [`Polyhedron::is_sound_core`].
    pub fn of_core(core: Solid, rounding: f64, volume: f64, gyration: DVec3) -> Self {
        Self {
            edges: core.edges(),
            vertices: core.vertices,
            faces: core.faces,
            rounding,
            volume,
            gyration,
        }
    }

    /// A sphere.
    pub fn sphere(radius: f64) -> Self {
        Self {
            vertices: vec![DVec3::ZERO],
            edges: Vec::new(),
            faces: Vec::new(),
            rounding: radius,
            volume: sphere_volume(radius),
            gyration: DVec3::splat(0.4 * radius * radius),
        }
    }

    /// Distance of the farthest point of the surface from the origin of the body frame [m].
    pub fn bounding_radius(&self) -> f64 {
        let farthest = self.vertices.iter().map(|v| v.length());
        farthest.fold(0.0, f64::max) + self.rounding
    }

    /// Whether it is a sphere that a world can hold.
    pub fn is_sound_sphere(&self) -> bool {
        self.vertices == [DVec3::ZERO]
            && self.edges.is_empty()
            && self.faces.is_empty()
            && self.has_sound_sizes()
    }

    /// Whether it has a core that a world can hold: finite, its edges and faces between corners
    /// that exist.
    pub fn is_sound_core(&self) -> bool {
        let exists = |&v: &u16| usize::from(v) < self.vertices.len();
        let is_edge = |&[a, b]: &[u16; 2]| exists(&a) && exists(&b) && a != b;
        let is_face = |face: &Vec<u16>| {
            (3..=self.vertices.len()).contains(&face.len()) && face.iter().all(exists)
        };
        (4..=usize::from(u16::MAX)).contains(&self.vertices.len())
            && self
                .vertices
                .iter()
                .all(|x| x.abs().max_element() <= LARGEST)
            && self.edges.iter().all(is_edge)
            && self.faces.iter().all(is_face)
            && self.vertices.len() + self.faces.len() == self.edges.len() + 2
            && self.has_sound_sizes()
    }

    /// Whether its sizes are positive and not absurd.
    fn has_sound_sizes(&self) -> bool {
        let positive = |x: f64| (SMALLEST..=LARGEST).contains(&x);
        positive(self.rounding)
            && positive(self.volume)
            && self.gyration.to_array().into_iter().all(positive)
    }

    /// Mean of the principal moments of inertia over the mass [m²].
    pub fn mean_gyration(&self) -> f64 {
        self.gyration.element_sum() / 3.0
    }
}

impl Rounded {
    /// Whether it is a body that a world can hold, as one from a file may not be.
    pub fn is_sound(&self) -> bool {
        self.shape.is_sound_core() && self.position.is_finite() && self.orientation.is_normalized()
    }

    /// Corners of the core in place [m].
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        let corners = self.shape.vertices.iter();
        corners.map(|x| self.orientation * *x + self.position)
    }
}

/// Volume of a sphere [m³].
///
/// The masses of all grains come from it: the order of the products is in the bits of every run.
pub fn sphere_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}

/// Volume of this many equal spheres, or of one times a share [m³].
///
/// The numbers of grains and the limits of the time step come from it, in this order of the
/// products; the last bit may differ from that of [`sphere_volume`].
pub fn spheres_volume(count: f64, radius: f64) -> f64 {
    count * 4.0 / 3.0 * PI * (radius * radius * radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_of_one_sphere_is_that_of_spheres() {
        for radius in [1.25e-3, 3e-3, 0.1] {
            // A few roundings.
            let ratio = spheres_volume(1.0, radius) / sphere_volume(radius);
            assert!((ratio - 1.0).abs() < 1e-15);
        }
        assert_eq!(spheres_volume(2.0, 0.1), 2.0 * spheres_volume(1.0, 0.1));
    }
}
