//! Map of the cross-section: the mean velocity of the grains on a square grid over the x–y plane.
//!
//! The mean is that of [`mean_velocity`](super::mean_velocity), with the same kernel and reach; a
//! point that no grain covers, seen along z, has none.

use super::velocity_kernel::{gaussian, kernel_reach};
use crate::world::World;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Points per reach of the kernel.
const FINENESS: f64 = 4.0;
/// Points along a side at most: grains that are strewn wide are mapped more coarsely.
const MOST_POINTS: f64 = 128.0;

/// Mean velocities at one instant on a square grid over the cross-section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VelocityMap {
    /// The instant [s].
    pub time: f64,
    /// The lowest and leftmost point [m].
    pub corner: DVec2,
    /// Distance between neighbouring points [m].
    pub spacing: f64,
    /// Points in a row.
    pub columns: usize,
    /// Mean velocity at each point, row by row from below [m/s]; none where no grain is.
    pub velocity: Vec<Option<DVec2>>,
}

/// Sums over the grains near each point.
struct KernelSums {
    weight: Vec<f64>,
    velocity: [Vec<f64>; 2],
    covered: Vec<bool>,
}

impl KernelSums {
    fn of_points(count: usize) -> Self {
        Self {
            weight: vec![0.0; count],
            velocity: [vec![0.0; count], vec![0.0; count]],
            covered: vec![false; count],
        }
    }

    /// Adds a grain to the points of a row, the first of which is `first`; `row` is its part of the
    /// distance and of the weight.
    fn add(&mut self, first: usize, columns: &Factors, row: (f64, f64), grain: &KernelGrain) {
        let points = first..first + columns.count;
        let [sums_x, sums_y] = &mut self.velocity;
        let sums = (self.weight[points.clone()].iter_mut())
            .zip(&mut sums_x[points.clone()])
            .zip(&mut sums_y[points.clone()])
            .zip(&mut self.covered[points]);
        let columns = columns.squared.iter().zip(&columns.weight);
        for ((((sum, x), y), covered), (squared, weight)) in sums.zip(columns) {
            // Not branched to: what lies beyond the reach adds zero.
            let squared = squared + row.0;
            let is_near = squared < grain.reach_squared;
            let is_over = squared < grain.radius_squared;
            let weight = if is_near { weight * row.1 } else { 0.0 };
            *sum += weight;
            *x += weight * grain.velocity.x;
            *y += weight * grain.velocity.y;
            *covered |= is_near & is_over;
        }
    }
}

/// What a grain adds to the points near it.
struct KernelGrain {
    velocity: DVec2,
    reach_squared: f64,
    radius_squared: f64,
}

/// Columns or rows within a grain's reach at most.
const MOST_WITHIN_REACH: usize = 2 * FINENESS as usize + 2;

/// The columns or the rows within a grain's reach.
struct Factors {
    first: usize,
    count: usize,
    /// Square of the distance along this axis [m²].
    squared: [f64; MOST_WITHIN_REACH],
    /// Its Gaussian: a point's weight is the product of those of its column and its row.
    weight: [f64; MOST_WITHIN_REACH],
}

/// The points of the grid along one axis.
struct Axis {
    /// The first one [m].
    corner: f64,
    /// From one to the next [m].
    spacing: f64,
    points: usize,
    /// Of the kernel [m].
    reach: f64,
}

impl Axis {
    /// Those within reach of a grain at this `place` [m].
    fn near(&self, place: f64) -> Factors {
        let (own, reach) = (
            (place - self.corner) / self.spacing,
            self.reach / self.spacing,
        );
        let last = (own + reach).min(self.points as f64 - 1.0) as usize;
        let first = (own - reach).ceil().max(0.0) as usize;
        let mut near = Factors {
            first,
            count: (last + 1).saturating_sub(first).min(MOST_WITHIN_REACH),
            squared: [0.0; MOST_WITHIN_REACH],
            weight: [0.0; MOST_WITHIN_REACH],
        };
        for k in 0..near.count {
            let index = (first + k) as f64;
            let squared = (self.corner + self.spacing * index - place).powi(2);
            (near.squared[k], near.weight[k]) = (squared, gaussian(squared, self.reach));
        }
        near
    }
}

impl VelocityMap {
    /// Whether it is a grid of whole rows, as a file may not say.
    pub fn is_whole(&self) -> bool {
        let most = MOST_POINTS as usize + 2;
        (1..=most).contains(&self.columns)
            && self.velocity.len().is_multiple_of(self.columns)
            && self.rows() <= most
            && self.time.is_finite()
            && self.corner.is_finite()
            && self.spacing.is_finite()
            && self.spacing > 0.0
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.velocity.len() / self.columns.max(1)
    }

    /// Place of the point in this column and row [m].
    pub fn point(&self, column: usize, row: usize) -> DVec2 {
        self.corner + self.spacing * DVec2::new(column as f64, row as f64)
    }

    /// Velocity at the point in this column and row [m/s].
    pub fn at(&self, column: usize, row: usize) -> Option<DVec2> {
        let index = row * self.columns + column;
        (column < self.columns).then(|| self.velocity.get(index).copied().flatten())?
    }

    /// The points that have a velocity, with it.
    pub fn points(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        let place = |index| self.point(index % self.columns, index / self.columns);
        let cells = self.velocity.iter().enumerate();
        cells.filter_map(move |(index, velocity)| Some((place(index), (*velocity)?)))
    }

    /// The largest speed of all points [m/s]; 0 without any.
    pub fn largest_speed(&self) -> f64 {
        let speeds = self.velocity.iter().flatten().map(|v| v.length());
        speeds.fold(0.0, f64::max)
    }
}

/// The velocities in the cross-section of `world` now, seen from a frame that turns about the z
/// axis at `turning` [rad/s]: 0 for the laboratory's. None without grains.
pub fn velocity_map(world: &World, turning: f64) -> Option<VelocityMap> {
    let grains = &world.grains;
    let places = || grains.position.iter().map(|x| x.truncate());
    let low = places().reduce(DVec2::min)?;
    let high = places().reduce(DVec2::max)?;
    let reach = kernel_reach(world);
    let spacing = (reach / FINENESS).max((high - low).max_element() / MOST_POINTS);
    // Points lie at whole multiples of the spacing, so that they stand still while the grains move.
    let first = (low / spacing).floor() - 1.0;
    let size = (high / spacing).ceil() + 2.0 - first;
    let mut map = VelocityMap {
        time: world.time(),
        corner: first * spacing,
        spacing,
        columns: size.x as usize,
        velocity: Vec::new(),
    };
    let mut sums = KernelSums::of_points(map.columns * size.y as usize);
    for ((place, velocity), &radius) in places().zip(&grains.velocity).zip(&grains.radius) {
        let axis = |k: usize| Axis {
            corner: map.corner[k],
            spacing,
            points: size[k] as usize,
            reach,
        };
        let (columns, rows) = (axis(0).near(place.x), axis(1).near(place.y));
        let grain = KernelGrain {
            velocity: velocity.truncate() - turning * place.perp(),
            reach_squared: reach * reach,
            radius_squared: radius * radius,
        };
        for k in 0..rows.count {
            let first = (rows.first + k) * map.columns + columns.first;
            let row = (rows.squared[k], rows.weight[k]);
            sums.add(first, &columns, row, &grain);
        }
    }
    let [x, y] = &sums.velocity;
    let mean = |i: usize| sums.covered[i].then(|| DVec2::new(x[i], y[i]) / sums.weight[i]);
    map.velocity = (0..sums.weight.len()).map(mean).collect();
    Some(map)
}
