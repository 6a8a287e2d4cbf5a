//! Convex solids with plane faces, the rounded polyhedra that are made of them, and surfaces of
//! triangles.
//!
//! In: points, boxes, half-spaces, STL files. Out: corners and faces, integrals, cut, eroded and
//! rounded solids; the points of a surface that are nearest to a point. Nothing here knows of a
//! world.

mod polyhedron;
mod smooth_parts;
mod solid;
mod stl;
mod surface_mesh;
mod triangle;

pub use polyhedron::{Polyhedron, Rounded, sphere_volume, spheres_volume};
pub use smooth_parts::{MOST_PARTS, MeshFlaw, open_edges, smooth_parts};
pub use solid::{Flaw, HalfSpace, Moments, Solid};
pub use stl::{LARGEST_STL, read_stl};
pub use surface_mesh::{MOST_TRIANGLES, MeshPart, NearestOnPart};
pub use triangle::{Region, hit_triangle, nearest_on_triangle};
