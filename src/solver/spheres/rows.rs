//! Rows: what the pair loop reads and writes of grains and pairs, packed for lanes.
//!
//! Each row is four numbers, as a rule a vector and a companion, which an accessor names.

use super::super::row::row;
use crate::lanes::{Row, WIDEST};
use crate::world::Grains;

/// Listed pairs come in groups of this many, filled up with padding lanes, whatever lanes the
/// processor has.
pub const GROUP: usize = WIDEST;

/// What the pair loop reads of a grain: two cache lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct Sphere {
    /// Centre [m]; inverse mass [1/kg].
    pub position: Row,
    /// Velocity half a step ago [m/s]; inverse moment of inertia [1/(kg m²)].
    pub velocity: Row,
    /// Spin half a step ago [rad/s]; radius [m].
    pub spin: Row,
    /// Spin after the step if all torques stayed as they were [rad/s]; time step and contact count
    /// over inertia [1/(N m s)].
    pub free_spin: Row,
}

/// Where the rows of a grain stand ([`super::slots`]). Bare numbers of grains are always those of
/// the world's columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Slot(pub u32);

/// A wall, by its index in the container.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct WallId(pub u32);

/// A kind of pair: where its constants stand ([`super::kinds`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairKind(pub u32);

impl Slot {
    /// As an index of rows.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl WallId {
    /// As an index of walls.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl PairKind {
    /// Of a pair whose kind is not known yet.
    pub const UNKNOWN: Self = Self(u32::MAX);

    /// As an index of constants.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A pair on a list: a grain and its partner `P`, a grain ([`Slot`]) or a wall ([`WallId`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpherePair<P = Slot> {
    /// The grain on which the computed force acts.
    pub grain: Slot,
    /// The other side.
    pub partner: P,
    /// Which constants are the pair's.
    pub kind: PairKind,
}

impl Sphere {
    /// Grain `i` of the world, before anything says how it would spin freely.
    pub fn of(grains: &Grains, i: usize) -> Self {
        Self {
            position: row(grains.position[i], 1.0 / grains.mass[i]),
            velocity: row(grains.velocity[i], 1.0 / grains.inertia[i]),
            spin: row(grains.spin[i], grains.radius[i]),
            free_spin: [0.0; 4],
        }
    }

    /// How much relative spin a unit of torque stops: time step and contact count over inertia
    /// [1/(N m s)].
    #[inline(always)]
    pub fn compliance(&self) -> f64 {
        self.free_spin[3]
    }

    /// Inverse mass [1/kg].
    #[inline(always)]
    pub fn inverse_mass(&self) -> f64 {
        self.position[3]
    }

    /// Inverse moment of inertia [1/(kg m²)].
    #[inline(always)]
    pub fn inverse_inertia(&self) -> f64 {
        self.velocity[3]
    }

    /// Radius [m].
    #[inline(always)]
    pub fn radius(&self) -> f64 {
        self.spin[3]
    }
}

/// The contact force of a pair and its torques, in rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct ContactForce {
    /// Force on the grain [N]; arm from the grain's centre to the contact [m].
    pub force: Row,
    /// Normal × force [N]; arm from the partner's centre to the contact [m]. Times the arm, the
    /// torque on either side.
    pub moment: Row,
    /// Torque of rolling friction on the grain [N m], which the next step changes; 1 while touching,
    /// else 0.
    pub rolling: Row,
    /// Energy lost in dashpots, by the tangential spring (in sliding and as its stiffness changes),
    /// in rolling and done by a wall during the step [J].
    pub exchanged: Row,
}

impl ContactForce {
    /// Arm from the grain's centre to the contact [m].
    #[inline(always)]
    pub fn arm(&self) -> f64 {
        self.force[3]
    }

    /// Arm from the partner's centre to the contact [m].
    #[inline(always)]
    pub fn partner_arm(&self) -> f64 {
        self.moment[3]
    }
}
