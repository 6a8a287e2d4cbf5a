//! Convex solids with plane faces: what angular grains are cut from.
//!
//! In: points, boxes, half-spaces. Out: corners and faces, integrals, cut and eroded solids. Nothing here knows of grains.

mod solid;

pub use solid::{Flaw, HalfSpace, Moments, Solid};
