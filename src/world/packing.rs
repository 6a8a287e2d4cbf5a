//! Which Voronoi cells become grains: those of the bed, without as many as the solid fraction
//! leaves out.
//!
//! In: a scene whose grains are Voronoi cells. Out: rounded polyhedra in their places, in slices of
//! work, so that whoever waits can show progress. A cell belongs to a column or a drum if its
//! centroid does; where a curved wall stands at the start, what reaches through it is cut off along
//! the flat sides of a prism inside of that wall. The lowest bodies touch the floor and neighbours
//! touch each other, all without overlap but for rounding.

use super::mixture::random;
use super::voronoi::{Boundary, Tessellation};
use super::{Polyhedron, Rounded};
use crate::geometry::{HalfSpace, Solid};
use crate::scene::{Scene, SceneCells, SceneContainer, SceneGrains};
use glam::DVec3;
use rand::seq::SliceRandom;
use rayon::prelude::*;

/// Random stream of the cells that are taken away.
const REMOVED: u64 = 4;
/// Slices of work that the cells are made in, each some ten milliseconds to a second long.
const SLICES: usize = 16;
/// A cell whose point is farther than this from a column's or a drum's wall lies wholly outside, in
/// diagonals of a lattice cell.
const MARGIN: f64 = 1.0;
/// Halvings of 60° that lead to the angle between the sides of a prism in a curved wall: 96 sides,
/// which leave a gap of half a thousandth of the radius at most.
const HALVINGS: u32 = 4;

/// Voronoi cells on their way to be grains.
pub struct Packing {
    cells: SceneCells,
    /// Cells that a part of the container takes; none where all of it is filled.
    lowest: Option<usize>,
    wanted: usize,
    seed: u64,
    tessellation: Tessellation,
    region: Region,
    sites: Vec<usize>,
    next: usize,
    made: Vec<Rounded>,
}

/// Where cells can be grains.
struct Region {
    /// Radius and axis of a cylinder [m]; none where the whole box is filled.
    cylinder: Option<(f64, CylinderAxis)>,
    /// Planes of a prism inside of the cylinder; empty where cells may reach out of it.
    sides: Vec<HalfSpace>,
}

#[derive(Clone, Copy)]
enum CylinderAxis {
    Y,
    Z,
}

impl Packing {
    /// The cells that `scene` asks for; none where its grains are no Voronoi cells, come from a
    /// file, or its container is open.
    pub fn new(scene: &Scene) -> Option<Self> {
        let SceneGrains::Voronoi(cells) = &scene.grains else {
            return None;
        };
        if cells.packing.is_some() {
            return None;
        }
        let (min, max) = scene.container.cells_box()?;
        let region = Region::of(&scene.container);
        let tessellation = Tessellation::new(min, max, cells.cell, Boundary::Walls, scene.seed);
        let margin = MARGIN * tessellation.largest_distance();
        let inside = |site: &usize| region.distance(tessellation.point(*site)) <= margin;
        let sites = (0..tessellation.len()).filter(inside).collect();
        Some(Self {
            lowest: (cells.bulk_fraction < 1.0).then(|| cells.cell_count(&scene.container)),
            wanted: if cells.solid_fraction < 1.0 {
                cells.grain_count(&scene.container)
            } else {
                usize::MAX
            },
            cells: cells.clone(),
            seed: scene.seed,
            tessellation,
            region,
            sites,
            next: 0,
            made: Vec::new(),
        })
    }

    /// Makes the next few cells and says whether all are made.
    pub fn advance(&mut self) -> bool {
        let slice = self.sites.len().div_ceil(SLICES);
        let end = (self.next + slice).min(self.sites.len());
        let cells = self.tessellation.cells(&self.sites[self.next..end]);
        let made = cells.into_par_iter().filter_map(|cell| self.grain(cell));
        let made: Vec<Rounded> = made.collect();
        self.made.extend(made);
        self.next = end;
        end == self.sites.len()
    }

    /// How far it has come, 0 … 1.
    pub fn progress(&self) -> f32 {
        self.next as f32 / self.sites.len().max(1) as f32
    }

    /// The grains, in the order of the lattice. Makes what cells are still to be made.
    pub fn finish(mut self) -> Vec<Rounded> {
        while !self.advance() {}
        if let Some(count) = self.lowest {
            keep_lowest(&mut self.made, count);
        }
        let mut order: Vec<usize> = (0..self.made.len()).collect();
        order.shuffle(&mut random(self.seed, REMOVED));
        let mut kept = vec![false; order.len()];
        for &cell in order.iter().take(self.wanted) {
            kept[cell] = true;
        }
        let mut cell = 0;
        self.made.retain(|_| {
            cell += 1;
            kept[cell - 1]
        });
        self.made
    }

    /// The grain that `cell` is, if its centroid lies in the region.
    ///
    /// A cell too thin to be rounded by the whole radius is rounded by half of it, or half of that.
    fn grain(&self, cell: Solid) -> Option<Rounded> {
        let cell = self.region.keep(cell)?;
        let mut rounding = self.cells.rounding;
        while rounding > 1e-3 * self.cells.rounding {
            if let Ok(grain) = Polyhedron::rounded(&cell, rounding) {
                return Some(grain);
            }
            rounding *= 0.5;
        }
        None
    }
}

impl Region {
    fn of(container: &SceneContainer) -> Self {
        let cylinder = match container {
            SceneContainer::Column { radius, .. } => Some((*radius, CylinderAxis::Y)),
            SceneContainer::Drum { radius, .. } => Some((*radius, CylinderAxis::Z)),
            _ => None,
        };
        let sides = cylinder.filter(|_| container.cuts_cells());
        Self {
            cylinder,
            sides: sides.map_or(Vec::new(), |(radius, axis)| prism(radius, axis)),
        }
    }

    /// Distance of `x` from the region, negative inside [m].
    fn distance(&self, x: DVec3) -> f64 {
        self.cylinder.map_or(f64::NEG_INFINITY, |(radius, axis)| {
            axis.across(x).length() - radius
        })
    }

    /// What is left of `cell`: nothing where its centroid lies outside, else all but what reaches
    /// through the wall.
    fn keep(&self, mut cell: Solid) -> Option<Solid> {
        if self.distance(cell.moments().centroid) > 0.0 {
            return None;
        }
        for side in &self.sides {
            cell.clip(*side);
        }
        Some(cell)
    }
}

impl CylinderAxis {
    /// The part of `x` at right angles to the axis.
    fn across(self, x: DVec3) -> DVec3 {
        match self {
            Self::Y => DVec3::new(x.x, 0.0, x.z),
            Self::Z => DVec3::new(x.x, x.y, 0.0),
        }
    }

    /// The direction at right angles to the axis with this cosine and sine.
    fn direction(self, cosine: f64, sine: f64) -> DVec3 {
        match self {
            Self::Y => DVec3::new(cosine, 0.0, sine),
            Self::Z => DVec3::new(cosine, sine, 0.0),
        }
    }
}

/// The sides of the regular prism whose edges lie in the cylinder of this radius.
fn prism(radius: f64, axis: CylinderAxis) -> Vec<HalfSpace> {
    let (mut cosine, mut sine): (f64, f64) = (0.5, 0.75_f64.sqrt());
    for _ in 0..HALVINGS {
        let half = (0.5 * (1.0 + cosine)).sqrt();
        (cosine, sine) = (half, 0.5 * sine / half);
    }
    let offset = radius * (0.5 * (1.0 + cosine)).sqrt();
    let mut direction = (1.0, 0.0);
    (0..6 << HALVINGS)
        .map(|_| {
            let (c, s): (f64, f64) = direction;
            direction = (c * cosine - s * sine, s * cosine + c * sine);
            HalfSpace {
                normal: axis.direction(c, s).normalize(),
                offset,
            }
        })
        .collect()
}

/// Leaves the `count` grains whose centroids are lowest, in their order.
fn keep_lowest(grains: &mut Vec<Rounded>, count: usize) {
    let mut heights: Vec<f64> = grains.iter().map(|grain| grain.position.y).collect();
    heights.sort_by(f64::total_cmp);
    if let Some(&limit) = heights.get(count) {
        grains.retain(|grain| grain.position.y < limit);
    }
}
