//! The grains of a scene: a filling of spheres, Voronoi cells, or a list.

use super::container::{SceneContainer, volume};
use super::shape::{SceneBody, SceneShape, sphere_radius};
use super::stored_cells::StoredCells;
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Volume of the smallest of some ten thousand Voronoi cells, in lattice cells (one of 70 000 is
/// smaller, with 0.16).
const SMALLEST_CELL: f64 = 0.2;

/// Part of a cell that a wall leaves where the cell's centroid lies inside of it, at least
/// (Grünbaum 1960: (3/4)³).
const SMALLEST_PART: f64 = 0.42;

/// The grains of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneGrains {
    /// The container is filled from below with `count` grains in all, then settled while it is at
    /// rest.
    Fill {
        /// Number of grains (given, or from the bulk fraction of the container's volume at a
        /// packing fraction).
        count: usize,
        /// Volume of all grains that a bulk fraction asks for [m³]; none where the count was given.
        solid_volume: Option<f64>,
        /// The species and their shares; the shares add up to 1. Labels are exact in number, random
        /// in place.
        species: Vec<SceneSpecies>,
    },
    /// Rounded Voronoi cells that fill the container, some of them taken away at random; nothing is
    /// settled.
    Voronoi(SceneCells),
    /// Each grain as listed; nothing is settled.
    List(Vec<SceneGrain>),
}

/// Voronoi cells as grains, after Man et al. 2023: of one random point in each cell of a lattice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneCells {
    /// Size of a lattice cell [m].
    pub cell: f64,
    /// Rounding radius `R_s` of the grains [m].
    pub rounding: f64,
    /// Share of the cells' volume that becomes grains, `φ_i`.
    pub solid_fraction: f64,
    /// Part of the container's volume that the cells take, from below.
    pub bulk_fraction: f64,
    /// The file that the grains come from in place of being cut. The cell above is then a cube of
    /// their mean volume, the rounding their smallest, and nothing is taken away.
    pub packing: Option<StoredCells>,
    /// The species and their shares; the shares add up to 1. Labels are exact in number, random in
    /// place.
    pub species: Vec<SceneCellSpecies>,
}

/// A kind of grain among Voronoi cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneCellSpecies {
    /// What people call it.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Share by number, 0 … 1.
    pub share: f64,
}

/// A kind of grain in a filling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneSpecies {
    /// What people call it.
    pub name: String,
    /// Radius [m].
    pub radius: f64,
    /// Name of its material.
    pub material: String,
    /// Share by number, 0 … 1.
    pub share: f64,
}

/// One grain of an explicit list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneGrain {
    /// Centre [m].
    pub position: DVec3,
    /// Velocity [m/s].
    pub velocity: DVec3,
    /// Angular velocity [rad/s].
    pub spin: DVec3,
    /// Radius [m]; of a polyhedron that of the sphere about its centroid that holds it before it is
    /// rounded.
    pub radius: f64,
    /// What it is.
    pub shape: SceneShape,
    /// Rotation from the shape's axes to those of the world, a unit quaternion.
    pub orientation: DQuat,
    /// Name of its material.
    pub material: String,
    /// Volume of the liquid film on it, where it is not its share of the scene's liquid [m³].
    pub film: Option<f64>,
}

impl SceneGrain {
    /// What it takes up in space; none where its shape encloses nothing, or nothing is left of it
    /// to round.
    pub fn body(&self) -> Option<SceneBody> {
        let Some(rounding) = self.shape.rounding() else {
            return Some(SceneBody::Sphere);
        };
        let core = self.shape.core()?;
        Some(SceneBody::Polyhedron {
            core: core.turned(self.orientation).moved(self.position),
            rounding,
        })
    }

    /// Radius of the sphere of its volume [m].
    pub fn equal_volume_radius(&self) -> f64 {
        self.shape.volume().map_or(self.radius, sphere_radius)
    }
}

impl SceneCells {
    /// Volume of a cell of the lattice [m³].
    fn cell_volume(&self) -> f64 {
        self.cell * self.cell * self.cell
    }

    /// Radius of the sphere of the volume of the smallest grains that it makes in `container` [m].
    pub fn smallest_radius(&self, container: &SceneContainer) -> f64 {
        let whole = SMALLEST_CELL * self.cell_volume();
        sphere_radius(if container.cuts_cells() {
            SMALLEST_PART * whole
        } else {
            whole
        })
    }

    /// Lattice cells in the box round `container`, whatever part of it the bed takes.
    pub fn lattice_size(&self, container: &SceneContainer) -> f64 {
        container.cells_box().map_or(0.0, |(min, max)| {
            let counts = lattice_counts(max - min, self.cell);
            counts.map(|count| count as f64).iter().product()
        })
    }

    /// Lattice cells that the bed takes.
    pub fn cell_count(&self, container: &SceneContainer) -> usize {
        let volume = bed_volume(container).unwrap_or(0.0) * self.bulk_fraction;
        (volume / self.cell_volume()).round() as usize
    }

    /// Grains that the bed is made of: `π R_i² H_i` times cells per volume times `φ_i` for a
    /// column.
    pub fn grain_count(&self, container: &SceneContainer) -> usize {
        if let Some(packing) = &self.packing {
            return packing.grains().len();
        }
        let volume = bed_volume(container).unwrap_or(0.0) * self.bulk_fraction;
        (volume / self.cell_volume() * self.solid_fraction).round() as usize
    }
}

/// Lattice cells along each edge of a box of this `extent` [m] that come nearest to the `size` [m].
pub fn lattice_counts(extent: DVec3, size: f64) -> [i64; 3] {
    extent
        .to_array()
        .map(|length| ((length / size).round() as i64).max(1))
}

/// Volume that Voronoi cells can fill [m³]; none of an open container.
fn bed_volume(container: &SceneContainer) -> Option<f64> {
    match container {
        SceneContainer::Column { radius, height, .. } => {
            Some(std::f64::consts::PI * radius * radius * height)
        }
        closed => volume(closed).ok(),
    }
}
