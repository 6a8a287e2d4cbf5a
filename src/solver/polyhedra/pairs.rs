//! Pairs of bodies near each other: what is kept of them from step to step.
//!
//! A pair lives as long as its bodies are near each other. Of its features those that may touch
//! before long are on its *outer* list, made anew when the two have moved relative to each other by
//! the list's skin ([`super::listing`]), each pair in its own time, so that a crowd that moves as
//! one lists nothing. Of these the ones that may touch within a few steps are *active*, the inner
//! list: only they are measured. What an active feature remembers is a [`ContactPoint`].
//!
//! Pairs are worked on in blocks. The contact points of a block lie in one piece of memory, in
//! order, a cache line each: a step reads it from beginning to end.
//!
//! All of it but the histories of points that touch is a cache, and none of it shows in a result:
//! whatever is left out would have added nothing, to the bit. So a slack is what a bound on the
//! motion leaves of a bound on a distance ([`super::motion`]), less the margin by which a computed
//! distance may jump.
//!
//! Not here: how lists are made and forces computed ([`super::workspace`], [`super::forces`]).

use super::super::row::{Row, row, vector};
use super::super::tangential::UNLOADED;
use super::bodies::{Body, Shapes};
use super::extents::Extents;
use super::listed::Listed;
use super::nearest::Nearest;
use crate::physics::law::PairConstants;
use crate::world::{FeatureContact, Partner, Surface, World};
use std::ops::Range;

/// Pairs that are worked on in one go, whose contact points lie together: enough to fill the lanes,
/// few enough to stay in the nearest cache.
pub const BLOCK: usize = 32;

/// Two bodies near each other: what is looked at in every step.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Pair {
    /// The grain on which the computed force acts.
    pub first: u32,
    /// The other side.
    pub second: PackedPartner,
    /// How far the two may still move relative to each other until [`Self::outer`] must be made
    /// anew [m].
    pub outer_slack: f64,
    /// How far they may still move before anything else than what is active can touch [m].
    pub inner_slack: f64,
    /// How far they may still move before anything active can touch; none where something does [m].
    /// A pair is left out while it is positive: all of it is a bound, so that what is left out
    /// would have added nothing, to the bit.
    pub clearance: f64,
    /// Where the active features are among the points of the block.
    pub points: PointRange,
    /// What may touch until the slack is used up, in the order of the features.
    pub outer: Box<[Listed]>,
}

impl Pair {
    /// Two sides of which nothing is known yet.
    pub fn new((first, second): (u32, PackedPartner)) -> Self {
        Self {
            first,
            second,
            outer_slack: -1.0,
            ..Self::default()
        }
    }

    /// What the world calls the second side.
    pub fn partner(&self) -> Partner {
        self.second.unpack()
    }
}

/// The second side of a pair, a [`Partner`] in four bytes, so that a [`Pair`] is one cache line.
/// Sorted as partners are: grains before walls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct PackedPartner(u32);

impl PackedPartner {
    /// The bit that tells walls; no world has so many grains.
    const WALL: u32 = 1 << 31;

    /// Grain `j`.
    pub fn grain(j: u32) -> Self {
        Self(j)
    }

    /// Wall `w` of the container.
    pub fn wall(w: u32) -> Self {
        Self(w | Self::WALL)
    }

    /// As the world tells it.
    #[inline(always)]
    pub fn unpack(self) -> Partner {
        if self.0 < Self::WALL {
            Partner::Grain(self.0)
        } else {
            Partner::Wall(self.0 & !Self::WALL)
        }
    }

    /// Its index among the grains, if it is one.
    #[inline(always)]
    pub fn as_grain(self) -> Option<usize> {
        match self.unpack() {
            Partner::Grain(j) => Some(j as usize),
            Partner::Wall(_) => None,
        }
    }
}

/// Where a pair's active features are among the points of its block.
#[derive(Clone, Copy, Debug, Default)]
pub struct PointRange {
    start: u32,
    /// How many they are.
    pub count: u32,
    /// How many of them are vertices with faces: they come before edges.
    pub faces: u32,
    /// How many there is room for.
    pub room: u32,
}

impl PointRange {
    /// `own` points that begin at `start`, with no room beyond.
    pub fn at(start: usize, own: &[ContactPoint]) -> Self {
        Self {
            start: start as u32,
            count: own.len() as u32,
            faces: own.partition_point(|point| point.listed.is_face()) as u32,
            room: own.len() as u32,
        }
    }

    /// Its points.
    #[inline(always)]
    pub fn range(&self) -> Range<usize> {
        self.start as usize..(self.start + self.count) as usize
    }
}

/// What a pair's contacts depend on, and where to look for them first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct Terms {
    /// `K_n`, the normal dashpot `m_e γ_n`, `K_t`, μ.
    pub law: Row,
    /// Distance of cores at which the two touch: the sum of their sphero-radii [m].
    pub touch: f64,
    /// Half the difference of the sphero-radii [m].
    pub offset: f64,
    /// About the axis that separated the two best when they were last listed; zero when never.
    pub axis: [f32; 3],
    /// By how much a computed distance of two of their features may jump though they hardly move
    /// [m]: what is left of any slack is smaller by this.
    pub margin: f32,
}

impl Terms {
    /// Takes over the law's constants for grain `first` of `world` and its `partner`.
    pub fn set_law(&mut self, world: &World, first: usize, partner: Partner) {
        let pairing = world.pairing(first, partner);
        let PairConstants {
            coefficients: [stiffness, damping, tangential_stiffness, _],
            contact: [friction, ..],
        } = pairing.constants(world.law, &world.materials, false);
        self.law = [stiffness, damping, tangential_stiffness, friction];
    }

    /// Takes over what follows from the sizes and shapes of the pair's sides; walls are not rounded
    /// and have no uneven faces.
    pub fn set_geometry(
        &mut self,
        pair: &Pair,
        bodies: &[Body],
        shapes: &Shapes,
        extents: &Extents,
    ) {
        let first = pair.first as usize;
        let second = pair.second.as_grain();
        let radius = bodies[first].sphero_radius();
        let other_radius = second.map_or(0.0, |j| bodies[j].sphero_radius());
        let uneven = shapes.uneven[first] + second.map_or(0.0, |j| shapes.uneven[j]);
        self.touch = radius + other_radius;
        self.offset = 0.5 * (radius - other_radius);
        self.margin = extents.margin(bodies[first].reach(), self.touch, uneven);
    }
}

/// What an active feature of a pair remembers: a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct ContactPoint {
    /// Its tangential spring [m], and the stiffness of its last update [N/m].
    pub spring: Row,
    /// Overlap, zero where it does not touch [m].
    pub overlap: f64,
    /// What the normal dashpot adds to the spring's push [N]. Where these are taken implicitly, the
    /// running mean of the speed of approach [m/s], zero where they have let go.
    pub normal_memory: f64,
    /// Which features.
    pub listed: Listed,
}

impl ContactPoint {
    /// The stiffness with which its tangential spring was last updated [N/m].
    pub fn stiffness(&self) -> f64 {
        self.spring[3]
    }

    /// Features that touch, with the history that a world holds of them.
    pub fn known(contact: &FeatureContact, listed: Listed) -> Self {
        Self {
            spring: row(contact.spring, contact.stiffness),
            overlap: contact.overlap,
            normal_memory: contact.normal_memory,
            listed,
        }
    }

    /// Features that do not touch.
    pub const fn apart(listed: Listed) -> Self {
        Self {
            spring: UNLOADED,
            overlap: 0.0,
            normal_memory: 0.0,
            listed,
        }
    }
}

/// The contact force of a pair and its torques.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct PairForce {
    /// Force on the first [N]; 1 while the two touch, else 0.
    pub force: Row,
    /// Torque on the first [N m]; the sum of the normal springs, where they are taken implicitly
    /// [N/m].
    pub first: Row,
    /// Torque on the second [N m].
    pub second: Row,
    /// Energy exchanged during the step, as [`crate::world::Grains::exchanged`] has it [J]: what
    /// stiffness that is shared anew takes or gives stands with sliding.
    pub exchanged: Row,
}

impl PairForce {
    /// Whether the two touch.
    #[inline(always)]
    pub fn touches(&self) -> bool {
        self.force[3] > 0.0
    }

    /// Takes note of whether they do.
    #[inline(always)]
    pub fn set_touches(&mut self, touches: bool) {
        self.force[3] = if touches { 1.0 } else { 0.0 };
    }

    /// 1 while they touch, else 0: what they add to either's number of touching partners.
    #[inline(always)]
    pub fn contact_count(&self) -> f64 {
        self.force[3]
    }

    /// The sum of its normal springs, where they are taken implicitly [N/m].
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        self.first[3]
    }

    /// Takes note of it.
    #[inline(always)]
    pub fn set_stiffness(&mut self, stiffness: f64) {
        self.first[3] = stiffness;
    }
}

/// A block of pairs.
pub struct Block<'a> {
    /// The pairs.
    pub pairs: &'a mut [Pair],
    /// What their contacts depend on.
    pub terms: &'a mut [Terms],
    /// What their active features remember.
    pub points: &'a mut Vec<ContactPoint>,
}

impl Block<'_> {
    /// Gives the pair `wanted` room for `count` active features, more than it has; the new points
    /// are `spare` ones.
    pub fn make_room(
        &mut self,
        wanted: usize,
        count: usize,
        spare: ContactPoint,
        room: &mut Vec<ContactPoint>,
    ) {
        room.clear();
        for (number, pair) in self.pairs.iter_mut().enumerate() {
            let (old, start) = (pair.points.range(), room.len());
            let needed = if number == wanted { count } else { old.len() };
            room.extend_from_slice(&self.points[old]);
            room.resize(start + needed + needed / 8, spare);
            pair.points.start = start as u32;
            pair.points.room = (room.len() - start) as u32;
        }
        self.points.clear();
        self.points.reserve_exact(room.len());
        self.points.extend_from_slice(room);
    }
}

/// The point of a wall nearest to a vertex.
#[inline(always)]
pub fn to_wall(surface: &Surface, vertex: Row) -> Nearest {
    let place = vector(vertex);
    let (distance, direction) = surface.distance(place);
    Nearest {
        normal: row(direction, distance),
        middle: row(place + 0.5 * distance * direction, 0.0),
    }
}
