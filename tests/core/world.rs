//! Claims about the geometry of grains and how a world is filled with them.

mod packing;
mod solid;
mod voronoi;
