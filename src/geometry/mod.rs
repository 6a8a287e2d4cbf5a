//! Convex solids with plane faces, the rounded polyhedra that are made of them, and surfaces of
//! triangles.
//!
//! In: points, boxes, half-spaces, STL files. Out: corners and faces, integrals, cut, eroded and
//! rounded solids; the points of a surface that are nearest to a point. Nothing here knows of a
//! world.

mod polyhedron;
mod solid;
mod stl;
mod surface_mesh;
mod triangle;

pub use polyhedron::{Polyhedron, Rounded, sphere_volume, spheres_volume};
pub use solid::{Flaw, HalfSpace, Moments, Solid};
pub use stl::{LARGEST_STL, read_stl};
pub use surface_mesh::{
    MOST_PARTS, MOST_TRIANGLES, MeshFlaw, MeshPart, NearestOnPart, smooth_parts,
};
pub use triangle::{Region, nearest_on_triangle};
