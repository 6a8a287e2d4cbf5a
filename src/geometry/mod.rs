//! Convex solids with plane faces, and the rounded polyhedra that are made of them.
//!
//! In: points, boxes, half-spaces. Out: corners and faces, integrals, cut, eroded and rounded
//! solids. Nothing here knows of a world.

mod polyhedron;
mod solid;

pub use polyhedron::{Polyhedron, Rounded, sphere_volume, spheres_volume};
pub use solid::{Flaw, HalfSpace, Moments, Solid};
