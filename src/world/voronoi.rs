//! The Voronoi cells of one random point in each cell of a lattice.
//!
//! In: a box, the wanted size of a lattice cell and a seed. Out: the Voronoi cell of each point as
//! a [`Solid`]; together they fill the box. A point is uniformly distributed in its lattice cell,
//! as in the program of Man et al. 2023; so no place is farther from the nearest point than a
//! lattice cell is wide from corner to corner. The cells themselves are those of
//! `meshless_voronoi`, which treats degenerate cases exactly.

use super::mixture::random;
use crate::geometry::Solid;
use crate::scene::lattice_counts;
use glam::DVec3;
use meshless_voronoi::{Dimensionality, VoronoiIntegrator};
use rand::RngExt;

/// Random stream of the points.
const POINTS: u64 = 3;

/// What bounds the cells at the faces of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The faces are walls: cells end there.
    Walls,
    /// The box repeats itself in every direction: cells reach out of it.
    Periodic,
}

/// A box filled with Voronoi cells, computed when they are asked for.
#[derive(Clone, Debug)]
pub struct Tessellation {
    min: DVec3,
    max: DVec3,
    lattice_cell: DVec3,
    boundary: Boundary,
    points: Vec<DVec3>,
}

impl Tessellation {
    /// The box between `min` and `max` with lattice cells as near `size` [m] as whole numbers of
    /// them allow.
    pub fn new(min: DVec3, max: DVec3, size: f64, boundary: Boundary, seed: u64) -> Self {
        let counts = lattice_counts(max - min, size);
        let lattice_cell = (max - min) / DVec3::from_array(counts.map(|count| count as f64));
        let mut rng = random(seed, POINTS);
        let mut place = || DVec3::from_array([(); 3].map(|()| rng.random::<f64>()));
        let [x, y, z] = counts;
        let sites = (0..y).flat_map(|y| (0..x).flat_map(move |x| (0..z).map(move |z| [x, y, z])));
        let points = sites
            .map(|site| min + (DVec3::from_array(site.map(|i| i as f64)) + place()) * lattice_cell)
            .collect();
        Self {
            min,
            max,
            lattice_cell,
            boundary,
            points,
        }
    }

    /// Number of its cells. They come layer by layer from below, in rows along z.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The point whose cell the one at `index` is [m].
    pub fn point(&self, index: usize) -> DVec3 {
        self.points[index]
    }

    /// Largest distance that a place of the box can have from the nearest point [m].
    pub fn largest_distance(&self) -> f64 {
        self.lattice_cell.length()
    }

    /// The cells of the points at `indices`, which ascend: all places of the box that are nearer to
    /// the one point than to any other. Cells of a box that repeats itself reach out of it.
    pub fn cells(&self, indices: &[usize]) -> Vec<Solid> {
        let mut wanted = vec![false; self.len()];
        for index in indices {
            wanted[*index] = true;
        }
        let points: Vec<_> = (self.points.iter()).map(|x| x.to_array().into()).collect();
        let cells = VoronoiIntegrator::build(
            &points,
            Some(&wanted),
            self.min.to_array().into(),
            (self.max - self.min).to_array().into(),
            Dimensionality::ThreeD,
            self.boundary == Boundary::Periodic,
        );
        let cells = cells.with_faces();
        let solids = cells.cells_iter().map(|cell| {
            let corner = |v: &usize| *v as u16;
            // The crate's loops run clockwise seen from outside.
            let face = |face| cell.face_vertices(face).iter().rev().map(corner).collect();
            let vertices = cell.vertices.iter();
            Solid::new(
                vertices
                    .map(|vertex| vertex.loc.to_array().into())
                    .collect(),
                (0..cell.face_count()).map(face).collect(),
            )
        });
        solids.collect()
    }
}
