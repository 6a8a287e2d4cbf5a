//! The Voronoi cells of one random point in each cell of a lattice.
//!
//! In: a box, the wanted size of a lattice cell and a seed. Out: the Voronoi cell of each point as a [`Solid`]; together
//! they fill the box. A point is uniformly distributed in its lattice cell, as in the program of Man et al. 2023; so no
//! place is farther from the nearest point than a lattice cell is wide from corner to corner, which bounds both a cell and
//! the neighbours that can cut it.

use super::mixture::random;
use crate::geometry::{HalfSpace, Solid};
use glam::DVec3;
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

/// A box filled with Voronoi cells, each computed when it is asked for.
#[derive(Clone, Debug)]
pub struct Tessellation {
    min: DVec3,
    max: DVec3,
    counts: [i64; 3],
    lattice_cell: DVec3,
    boundary: Boundary,
    points: Vec<DVec3>,
}

impl Tessellation {
    /// The box between `min` and `max` with lattice cells as near `size` [m] as whole numbers of them allow.
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
            counts,
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

    /// The cell at `index`: all places of the box that are nearer to its point than to any other.
    pub fn cell(&self, index: usize) -> Solid {
        let centre = self.points[index];
        let reach = DVec3::splat(self.largest_distance());
        let (low, high) = match self.boundary {
            Boundary::Walls => (
                (self.min - centre).max(-reach),
                (self.max - centre).min(reach),
            ),
            Boundary::Periodic => (-reach, reach),
        };
        let mut cell = Solid::cuboid(low, high);
        let mut farthest = farthest_corner(&cell);
        let site = self.site(index);
        let narrow = self.lattice_cell.min_element();
        for ring in 0.. {
            for offset in self.ring(site, centre, ring) {
                let distance = offset.length();
                if 0.5 * distance < farthest && distance > 0.0 {
                    cell.clip(HalfSpace {
                        normal: offset / distance,
                        offset: 0.5 * distance,
                    });
                    farthest = farthest_corner(&cell);
                }
            }
            // Points of the next ring are at least this many lattice cells away.
            if 0.5 * ring as f64 * narrow >= farthest {
                break;
            }
        }
        cell.moved(centre)
    }

    fn site(&self, index: usize) -> [i64; 3] {
        let [x, _, z] = self.counts;
        let index = i64::from(index as u32);
        [index / z % x, index / (x * z), index % z]
    }

    /// Where the points of the lattice cells `ring` cells away from `site` are, seen from `centre`, the nearest first.
    fn ring(&self, site: [i64; 3], centre: DVec3, ring: i64) -> Vec<DVec3> {
        let mut offsets: Vec<DVec3> = shell(ring)
            .filter_map(|step| self.neighbour([0, 1, 2].map(|axis| site[axis] + step[axis])))
            .map(|point| point - centre)
            .collect();
        offsets.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        offsets
    }

    /// The point of the lattice cell at `site`; outside of the box that of its image, or none.
    fn neighbour(&self, site: [i64; 3]) -> Option<DVec3> {
        let mut home = site;
        let mut shift = DVec3::ZERO;
        for axis in 0..3 {
            let count = self.counts[axis];
            home[axis] = site[axis].rem_euclid(count);
            let turns = site[axis].div_euclid(count);
            if turns != 0 && self.boundary == Boundary::Walls {
                return None;
            }
            shift[axis] = turns as f64 * (self.max - self.min)[axis];
        }
        let [x, y, z] = home;
        let index = (y * self.counts[0] + x) * self.counts[2] + z;
        Some(self.points[index as usize] + shift)
    }
}

/// Lattice cells along each edge of a box of this `extent` [m] that come nearest to the `size` [m].
pub fn lattice_counts(extent: DVec3, size: f64) -> [i64; 3] {
    extent
        .to_array()
        .map(|length| ((length / size).round() as i64).max(1))
}

/// Steps to the lattice cells that are `ring` cells away along at least one axis and no farther along any.
fn shell(ring: i64) -> impl Iterator<Item = [i64; 3]> {
    let steps = move || -ring..=ring;
    steps()
        .flat_map(move |y| steps().flat_map(move |x| steps().map(move |z| [x, y, z])))
        .filter(move |step| step.iter().any(|i| i.abs() == ring))
}

fn farthest_corner(cell: &Solid) -> f64 {
    let squares = cell.vertices.iter().map(|x| x.length_squared());
    squares.fold(0.0, f64::max).sqrt()
}
