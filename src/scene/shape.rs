//! The shapes that listed grains can have.
//!
//! In: what a scene says of a shape. Out: the solid it is, about its own centroid, and the rounded
//! core a grain of it has.

use crate::geometry::Solid;
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Points of which a grain may be the hull.
pub(super) const MOST_POINTS: usize = 60;
/// Corners that a core may have.
pub(super) const MOST_CORNERS: usize = 250;
/// Sides that a prism may have.
pub(super) const MOST_SIDES: u32 = 30;

/// What a listed grain is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneShape {
    /// A sphere of the grain's radius.
    Sphere,
    /// A box along its axes.
    Box {
        /// Its edges along x, y and z [m].
        size: DVec3,
        /// Rounding radius [m].
        rounding: f64,
    },
    /// A regular tetrahedron.
    Tetrahedron {
        /// Its edge [m].
        edge: f64,
        /// Rounding radius [m].
        rounding: f64,
    },
    /// An upright prism over a regular polygon.
    Prism {
        /// Sides of the polygon.
        sides: u32,
        /// Side of the polygon [m].
        edge: f64,
        /// Height along y [m].
        height: f64,
        /// Rounding radius [m].
        rounding: f64,
    },
    /// The convex hull of points.
    Hull {
        /// The points, in any frame: the grain's position is the hull's centroid [m].
        points: Vec<DVec3>,
        /// Rounding radius [m].
        rounding: f64,
    },
    /// All that lies within the rounding radius of a convex core: a state's own grain, as it is.
    Core {
        /// The corners of the core about the grain's centroid, along its principal axes [m].
        corners: Vec<DVec3>,
        /// Its faces: each a loop of corners, anticlockwise seen from outside.
        faces: Vec<Vec<u16>>,
        /// Rounding radius [m].
        rounding: f64,
        /// Volume of the solid that its mass belongs to [m³].
        volume: f64,
        /// Principal moments of inertia over the mass [m²].
        gyration: DVec3,
    },
}

/// What a listed grain takes up in space.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneBody {
    /// A sphere.
    Sphere,
    /// A rounded core.
    Polyhedron {
        /// The solid in its place, eroded by the rounding radius.
        core: Solid,
        /// Rounding radius [m].
        rounding: f64,
    },
}

impl SceneShape {
    /// Whether it is a sphere.
    pub fn is_sphere(&self) -> bool {
        *self == Self::Sphere
    }

    /// Rounding radius [m]; none of a sphere.
    pub fn rounding(&self) -> Option<f64> {
        match self {
            Self::Sphere => None,
            Self::Box { rounding, .. }
            | Self::Tetrahedron { rounding, .. }
            | Self::Prism { rounding, .. }
            | Self::Hull { rounding, .. }
            | Self::Core { rounding, .. } => Some(*rounding),
        }
    }

    /// Volume of the solid that its mass belongs to [m³]; none of a sphere, nor where there is none.
    pub fn volume(&self) -> Option<f64> {
        match self {
            Self::Core { volume, .. } => Some(*volume),
            _ => Some(self.solid()?.moments().volume),
        }
    }

    /// Its core, its centroid at the origin; none of a sphere, nor where nothing is left to round.
    pub fn core(&self) -> Option<Solid> {
        match self {
            Self::Core { corners, faces, .. } => {
                are_faces_of(corners, faces).then(|| Solid::new(corners.clone(), faces.clone()))
            }
            _ => self.solid()?.eroded(self.rounding()?),
        }
    }

    /// Radius of the sphere about its centroid that holds it before it is rounded [m]; not a number
    /// for a sphere, nor where it encloses nothing. Of a core that of the sphere that holds it when it
    /// is rounded.
    pub fn radius(&self) -> f64 {
        if let Self::Core {
            corners, rounding, ..
        } = self
        {
            let farthest = corners.iter().map(|x| x.length()).fold(0.0, f64::max);
            return farthest + rounding;
        }
        let solid = self.solid();
        solid.map_or(f64::NAN, |solid| {
            let corners = solid.vertices.iter().map(|x| x.length());
            corners.fold(0.0, f64::max)
        })
    }

    /// The solid before it is rounded, its centroid at the origin; none of a sphere, of a core, of
    /// points in one plane, nor of too many points or sides.
    pub fn solid(&self) -> Option<Solid> {
        let solid = match self {
            Self::Box { size, .. } => Solid::cuboid(-0.5 * *size, 0.5 * *size),
            Self::Tetrahedron { edge, .. } => Solid::hull(&tetrahedron(*edge))?,
            Self::Prism {
                sides,
                edge,
                height,
                ..
            } if *sides <= MOST_SIDES => Solid::hull(&prism(*sides, *edge, *height))?,
            Self::Hull { points, .. } if points.len() <= MOST_POINTS => Solid::hull(points)?,
            Self::Sphere | Self::Prism { .. } | Self::Hull { .. } | Self::Core { .. } => {
                return None;
            }
        };
        let centroid = solid.moments().centroid;
        Some(solid.moved(-centroid))
    }
}

/// Whether these are the corners and faces of a solid, as far as their numbers go.
fn are_faces_of(corners: &[DVec3], faces: &[Vec<u16>]) -> bool {
    let is_face = |face: &Vec<u16>| {
        let mut corners_of = face.iter();
        face.len() >= 3 && corners_of.all(|&corner| usize::from(corner) < corners.len())
    };
    (4..=MOST_CORNERS).contains(&corners.len())
        && (4..=2 * MOST_CORNERS).contains(&faces.len())
        && faces.iter().all(is_face)
}

/// Radius of the sphere of this volume [m].
pub(super) fn sphere_radius(volume: f64) -> f64 {
    libm::cbrt(0.75 * volume / std::f64::consts::PI)
}

fn tetrahedron(edge: f64) -> [DVec3; 4] {
    let half = edge / 8.0_f64.sqrt();
    let corners = [
        DVec3::new(1.0, 1.0, 1.0),
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::new(-1.0, -1.0, 1.0),
    ];
    corners.map(|corner| half * corner)
}

fn prism(sides: u32, edge: f64, height: f64) -> Vec<DVec3> {
    let half_angle = std::f64::consts::PI / f64::from(sides);
    let radius = 0.5 * edge / libm::sin(half_angle);
    let corner = |i: u32| {
        let angle = 2.0 * half_angle * f64::from(i);
        radius * DVec3::new(libm::cos(angle), 0.0, libm::sin(angle))
    };
    let up = 0.5 * height * DVec3::Y;
    (0..sides)
        .flat_map(|i| [corner(i) - up, corner(i) + up])
        .collect()
}

/// The rotation by `angle` [rad] about `axis`, a unit vector; the same bits on every machine.
pub(super) fn rotation(axis: DVec3, angle: f64) -> DQuat {
    let along = libm::sin(0.5 * angle) * axis;
    DQuat::from_xyzw(along.x, along.y, along.z, libm::cos(0.5 * angle))
}
