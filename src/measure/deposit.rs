//! What lies on the floor where a column stood: how far it reaches, how high it is, what shape it
//! has.
//!
//! A grain's farthest point is that of its rounded body from the axis of the column, its top the
//! highest one; both are exact for spheres and polyhedra. Grains in flight and lone ones count: the
//! cluster's radius leaves them out.

use super::column::volume;
use crate::world::{Contact, Partner, Shape, World};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

/// Rings of a height profile at most: a lone grain that flew away takes no memory.
const MOST_RINGS: usize = 1000;
/// Sectors over which the front is averaged.
const SECTORS: usize = 72;
/// Share of the column's radius at the start within which the deposit's height is taken.
const MIDDLE: f64 = 0.5;
/// Grains whose outline one thread looks for at a time.
const PART: usize = 8192;
/// Width of the rings of the height profile in grain sizes.
const RING_WIDTH: f64 = 2.0;
/// The top is flat as far as the profile keeps this share of its apex.
const FLAT: f64 = 0.9;
/// A deposit whose flat top reaches farther than this share of its front is a frustum; that of a
/// cone reaches a tenth.
const FRUSTUM: f64 = 0.25;

/// The grains of a column as a heap.
#[derive(Clone, Debug)]
pub struct Deposit {
    /// Radius of the column at the start [m].
    initial_radius: f64,
    /// Cube root of the grains' mean volume [m].
    grain_size: f64,
    grains: Vec<Extent>,
}

/// Where a heap ends and how high it is, for a picture of it.
#[derive(Clone, Debug, PartialEq)]
pub struct DepositOutline {
    /// Distance of the farthest point of a grain from the axis in each sector, NaN where there is
    /// none [m]. The first sector begins opposite to the x axis, the next ones follow from x to z.
    pub sectors: [f64; SECTORS],
    /// Their mean over the sectors that hold a grain, as [`Deposit::front_radius`] [m].
    pub front: f64,
    /// Height of the highest grain about the axis, as [`Deposit::height`] [m].
    pub height: f64,
    /// Distance from the axis within which that grain is looked for [m].
    pub middle: f64,
    /// Radius of the column at the start [m].
    pub initial_radius: f64,
}

/// How far one grain reaches.
#[derive(Clone, Copy, Debug)]
struct Extent {
    /// Distance of its centre from the axis [m].
    distance: f64,
    /// Azimuth of its centre, as a share of the turn, 0 … 1.
    turn: f64,
    /// Distance of its farthest point from the axis [m].
    reach: f64,
    /// Height of its highest point above the floor [m].
    top: f64,
}

/// Mean height of a heap over the azimuth, at the middle of rings about the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeightProfile {
    /// Distances from the axis [m].
    pub radius: Vec<f64>,
    /// Mean heights there [m].
    pub height: Vec<f64>,
}

/// The shape of a heap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepositShape {
    /// With a point at the top.
    Cone,
    /// With a flat top that reaches farther than a quarter of its front.
    Frustum,
}

impl DepositShape {
    /// The words for them, in order.
    pub const WORDS: [&'static str; 2] = ["cone", "frustum"];

    /// The word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

impl Deposit {
    /// The heap in `world`; none where no column stood, or without grains.
    pub fn of(world: &World) -> Option<Self> {
        let Shape::Column { radius, .. } = world.container.shape else {
            return None;
        };
        let count = world.grains.len();
        let volumes = (0..count).map(|i| volume(world, i)).sum::<f64>();
        (count > 0).then(|| Self {
            initial_radius: radius,
            grain_size: (volumes / count as f64).cbrt(),
            grains: (0..count).map(|i| Extent::of(world, i)).collect(),
        })
    }

    /// Radius of the front [m]: the farthest grain in each of 72 sectors about the axis, their mean
    /// over the sectors that hold a grain.
    pub fn front_radius(&self) -> f64 {
        front_radius(self.grains.iter())
    }

    /// Radius about the axis within which the centres of this share of the grains lie [m].
    pub fn radius_of_share(&self, share: f64) -> f64 {
        let mut distances: Vec<f64> = self.grains.iter().map(|grain| grain.distance).collect();
        let within = (share * distances.len() as f64).ceil() as usize;
        let last = within.clamp(1, distances.len()) - 1;
        *distances.select_nth_unstable_by(last, f64::total_cmp).1
    }

    /// Radius of the front of the largest cluster of grains that touch each other [m]; `world` is
    /// the deposit's own.
    pub fn cluster_radius(&self, world: &World) -> f64 {
        let members = largest_cluster(world);
        front_radius(members.iter().map(|&i| &self.grains[i]))
    }

    /// Height of the highest grain whose centre lies within half the column's initial radius of the
    /// axis [m]; zero where there is none.
    pub fn height(&self) -> f64 {
        let middle = MIDDLE * self.initial_radius;
        let inside = self.grains.iter().filter(|grain| grain.distance <= middle);
        inside.map(|grain| grain.top).fold(0.0, f64::max)
    }

    /// The mean height over the azimuth: the floor about the axis is cut into rings two grain sizes
    /// wide (the grain size is the cube root of the mean volume) and these into cells about as
    /// long; a cell is as high as the highest grain whose centre lies over it, an empty one has no
    /// height, and a ring has the mean height of its cells. Grains beyond [`MOST_RINGS`] rings are
    /// left out.
    pub fn height_profile(&self) -> HeightProfile {
        let width = RING_WIDTH * self.grain_size;
        let farthest = self.grains.iter().map(|grain| grain.distance);
        let rings = ((farthest.fold(0.0, f64::max) / width) as usize).min(MOST_RINGS - 1) + 1;
        let mut cells: Vec<Vec<f64>> = (0..rings).map(|ring| vec![0.0; cells_of(ring)]).collect();
        for grain in &self.grains {
            let Some(ring) = cells.get_mut((grain.distance / width) as usize) else {
                continue;
            };
            let count = ring.len();
            let cell = &mut ring[((grain.turn * count as f64) as usize).min(count - 1)];
            *cell = cell.max(grain.top);
        }
        HeightProfile {
            radius: (0..rings).map(|k| (k as f64 + 0.5) * width).collect(),
            height: cells.iter().map(|ring| mean(ring)).collect(),
        }
    }
}

impl DepositOutline {
    /// That of the heap in `world`; none where no column stood, or without grains. Grains that
    /// another one surely hides are passed over, so that it can be taken for every frame: a grain
    /// reaches at least as far as its centre, and at most as far as the sphere round it.
    pub fn of(world: &World) -> Option<Self> {
        let Shape::Column { radius, .. } = world.container.shape else {
            return None;
        };
        let middle = MIDDLE * radius;
        let grains = || world.grains.position.iter().zip(&world.grains.radius);
        let (mut known, mut height) = (KnownFront::NOWHERE, 0.0_f64);
        for (centre, _) in grains() {
            let distance = from_axis(*centre);
            known.reach(*centre, distance);
            if distance <= middle {
                height = height.max(centre.y);
            }
        }
        let count = world.grains.len();
        let part = |first: usize| {
            let grains = first..(first + PART).min(count);
            farthest(world, grains, middle, known.clone(), height)
        };
        let (sectors, height) = if count <= PART {
            part(0)
        } else {
            let parts = (0..count.div_ceil(PART)).into_par_iter();
            let none = || ([f64::NAN; SECTORS], height);
            parts.map(|k| part(k * PART)).reduce(none, |one, other| {
                let sectors = std::array::from_fn(|k| one.0[k].max(other.0[k]));
                (sectors, one.1.max(other.1))
            })
        };
        (!world.grains.is_empty()).then(|| Self {
            sectors,
            front: mean_front(&sectors),
            height,
            middle,
            initial_radius: radius,
        })
    }
}

/// The farthest points of these grains in each sector, NaN where none of them matters, and the highest of
/// those about the axis or `height` [m], where so much is `known`.
fn farthest(
    world: &World,
    grains: Range<usize>,
    middle: f64,
    mut known: KnownFront,
    mut height: f64,
) -> ([f64; SECTORS], f64) {
    let mut sectors = [f64::NAN; SECTORS];
    for i in grains {
        let (centre, bound) = (world.grains.position[i], world.grains.radius[i]);
        let distance = from_axis(centre);
        let is_high = distance <= middle && centre.y + bound > height;
        if !is_high && !known.is_below(centre, distance + bound) {
            continue;
        }
        let extent = Extent::of(world, i);
        if is_high {
            height = height.max(extent.top);
        }
        let front = &mut sectors[extent.sector()];
        *front = front.max(extent.reach);
        known.reach(centre, extent.reach);
    }
    (sectors, height)
}

/// How far the front reaches at least in each sector [m].
#[derive(Clone)]
struct KnownFront {
    sectors: [f64; SECTORS],
    /// The least of them.
    nearest: f64,
}

impl KnownFront {
    /// Nothing is known of it.
    const NOWHERE: Self = Self {
        sectors: [f64::NEG_INFINITY; SECTORS],
        nearest: f64::NEG_INFINITY,
    };

    /// Takes note that a grain about `centre` reaches as far as `distance`.
    fn reach(&mut self, centre: DVec3, distance: f64) {
        if self.is_below(centre, distance) {
            self.sectors[sector_of(turn_of(centre))] = distance;
            self.nearest = self.sectors.iter().copied().fold(f64::INFINITY, f64::min);
        }
    }

    /// Whether it is not known to reach as far as `distance` in the sector of `centre`.
    fn is_below(&self, centre: DVec3, distance: f64) -> bool {
        distance > self.nearest && distance > self.sectors[sector_of(turn_of(centre))]
    }
}

/// Azimuth of a point, as a share of the turn, 0 … 1.
fn turn_of(x: DVec3) -> f64 {
    x.z.atan2(x.x) / TAU + 0.5
}

/// Which of the sectors this share of the turn lies in.
fn sector_of(turn: f64) -> usize {
    ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}

impl Extent {
    /// Which of the sectors its centre lies in.
    fn sector(&self) -> usize {
        sector_of(self.turn)
    }

    fn of(world: &World, i: usize) -> Self {
        let centre = world.grains.position[i];
        let (mut reach, mut top, mut rounding) =
            (from_axis(centre), centre.y, world.grains.radius[i]);
        if let Some(polyhedra) = &world.polyhedra {
            let shape = polyhedra.shape_of(i);
            (reach, top, rounding) = (0.0, f64::NEG_INFINITY, shape.rounding);
            for vertex in &shape.vertices {
                let corner = centre + polyhedra.orientation[i] * *vertex;
                reach = from_axis(corner).max(reach);
                top = corner.y.max(top);
            }
        }
        Self {
            distance: from_axis(centre),
            turn: turn_of(centre),
            reach: reach + rounding,
            top: top + rounding,
        }
    }
}

impl HeightProfile {
    /// Its largest height [m].
    pub fn apex(&self) -> f64 {
        self.height.iter().copied().fold(0.0, f64::max)
    }

    /// Distance from the axis at which it first falls below nine tenths of its apex, interpolated
    /// between the rings [m].
    pub fn flat_radius(&self) -> f64 {
        let level = FLAT * self.apex();
        let top = self.height.iter().position(|height| *height >= level);
        let from = top.unwrap_or(0);
        let Some(below) = (from..self.height.len()).find(|&k| self.height[k] < level) else {
            return self.radius.last().copied().unwrap_or(0.0);
        };
        let (inner, outer) = (self.height[below - 1], self.height[below]);
        let share = (inner - level) / (inner - outer);
        self.radius[below - 1] + share * (self.radius[below] - self.radius[below - 1])
    }

    /// The shape of a heap with this profile whose front is at `front` [m].
    pub fn shape(&self, front: f64) -> DepositShape {
        if self.flat_radius() > FRUSTUM * front {
            DepositShape::Frustum
        } else {
            DepositShape::Cone
        }
    }
}

/// Distance of a point from the y axis [m].
fn from_axis(x: DVec3) -> f64 {
    (x.x * x.x + x.z * x.z).sqrt()
}

/// Mean over the sectors that hold one of `grains` of the farthest one's reach; NaN without grains.
fn front_radius<'a>(grains: impl Iterator<Item = &'a Extent>) -> f64 {
    let mut farthest = [f64::NAN; SECTORS];
    for grain in grains {
        let front = &mut farthest[grain.sector()];
        *front = front.max(grain.reach);
    }
    mean_front(&farthest)
}

/// Mean over the sectors that hold a grain; NaN without any.
fn mean_front(sectors: &[f64; SECTORS]) -> f64 {
    let held: Vec<f64> = (sectors.iter().copied())
        .filter(|r| r.is_finite())
        .collect();
    mean(&held)
}

/// Number of cells in a ring: as many as make them about as long as they are wide.
fn cells_of(ring: usize) -> usize {
    (TAU * (ring as f64 + 0.5)).round() as usize
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The grains of the largest cluster that hangs together by touching contacts, the floor left out;
/// of equal ones, that of the first grain.
fn largest_cluster(world: &World) -> Vec<usize> {
    let mut leader: Vec<u32> = (0..world.grains.len() as u32).collect();
    for contact in &world.contacts {
        if let Contact {
            grain,
            partner: Partner::Grain(other),
            touching: true,
            ..
        } = *contact
        {
            let (a, b) = (find(&mut leader, grain), find(&mut leader, other));
            leader[a.max(b) as usize] = a.min(b);
        }
    }
    let all = 0..leader.len() as u32;
    let leaders: Vec<u32> = all.map(|i| find(&mut leader, i)).collect();
    let mut sizes = vec![0_u32; leaders.len()];
    for &leader in &leaders {
        sizes[leader as usize] += 1;
    }
    let largest = (0..sizes.len()).rev().max_by_key(|&i| sizes[i]);
    (0..leaders.len())
        .filter(|&i| Some(leaders[i] as usize) == largest)
        .collect()
}

/// The grain that stands for the cluster of grain `i`; halves the way there.
fn find(leader: &mut [u32], mut i: u32) -> u32 {
    while leader[i as usize] != i {
        let above = leader[leader[i as usize] as usize];
        leader[i as usize] = above;
        i = above;
    }
    i
}
