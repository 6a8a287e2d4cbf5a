//! How two bodies move relative to each other, and how far at most.
//!
//! In: bodies and walls after a drift. Out: relative velocity and spin of a pair, and a bound on
//! the way that any point of the first has come in the step, seen from the second. The bound holds
//! to the last bit: it counts what bodies that turn do beyond their velocities, and rounding.

use super::super::row::{Row, length_squared, row, sub};
use super::super::walls::{WallBody, Walls};
use super::bodies::{Body, Geometry};
use super::extents::Extents;
use super::pairs::{PackedPartner, Pair};
use crate::lanes::prefetch;
use crate::physics::FeatureRule;
use crate::world::{Partner, Surface};

/// What the speed of two bodies makes in a step is taken this much larger: more than its rounding.
const CAUTION: f64 = 1.01;

/// What every pair's force depends on.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// Length of the step [s].
    pub dt: f64,
    /// Whether the features of a pair share its stiffness.
    pub rule: FeatureRule,
    /// Motions of so many steps ahead are looked for what comes to touch.
    pub look_ahead: f64,
    /// Every grain.
    pub bodies: &'a [Body],
    /// Where their features are.
    pub geometry: Geometry<'a>,
    /// Every wall.
    pub walls: &'a [WallBody],
    /// The origin, and the velocity and the spin of every wall.
    pub wall_motions: &'a [[Row; 3]],
    /// Sizes that bound how far two bodies move in a step.
    pub extents: Extents,
}

/// The origin, and the velocity [m/s] and the spin [rad/s] of every wall: what the motion of a side
/// of a pair is where that is a wall.
pub fn motions_of(walls: &Walls) -> Vec<[Row; 3]> {
    let motion = |wall: &WallBody| {
        let motion = &wall.motion;
        [[0.0; 4], row(motion.velocity, 0.0), row(motion.spin, 0.0)]
    };
    walls.iter().map(motion).collect()
}

/// How the bodies of a pair move relative to each other.
pub struct Relative {
    /// Velocity of the first relative to the second at the first's centroid [m/s].
    pub velocity: Row,
    /// Relative spin [rad/s].
    pub spin: Row,
    /// Mean spin of both, with which the contacts turn [rad/s].
    pub mean_spin: Row,
    /// How far a point of the first has come in this step, seen from the second, at most [m].
    pub moved: f64,
}

/// `½ (a + b)`, element by element.
#[inline(always)]
fn mean(a: Row, b: Row) -> Row {
    [0, 1, 2, 3].map(|k| 0.5 * (a[k] + b[k]))
}

/// `a × b`, of the vector parts.
#[inline(always)]
pub fn crossed(a: Row, b: Row) -> Row {
    let [x, y, z] = cross_product([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
    [x, y, z, 0.0]
}

/// `a × b`.
#[inline(always)]
fn cross_product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl Surroundings<'_> {
    /// The wall that is the second side of `pair`, if it is one.
    #[inline(always)]
    pub fn wall(&self, pair: &Pair) -> Option<&WallBody> {
        match pair.partner() {
            Partner::Grain(_) => None,
            Partner::Wall(w) => Some(&self.walls[w as usize]),
        }
    }

    /// Position, velocity and spin of the second side of a pair; a wall moves about the origin.
    #[inline(always)]
    pub fn motion(&self, second: PackedPartner) -> [&Row; 3] {
        match second.unpack() {
            Partner::Grain(j) => {
                let body = &self.bodies[j as usize];
                [&body.position, &body.velocity, &body.spin]
            }
            Partner::Wall(w) => self.wall_motions[w as usize].each_ref(),
        }
    }

    /// Asks for the second side of `pair`.
    #[inline(always)]
    pub fn fetch(&self, pair: &Pair) {
        if let Some(j) = pair.second.as_grain() {
            prefetch::<_, 3>(std::slice::from_ref(&self.bodies[j]));
        }
    }

    /// How the two move relative to each other.
    ///
    /// With velocities `v`, spins `ω` and centroids `x` in the middle of the step, a point of the
    /// first at `y` from its centroid has moved by `Δt (v₁ − v₂ − ω₂ × (x₁ − x₂) + (ω₁ − ω₂) × y)`
    /// seen from the second, but for terms of second order: each body turns on a circle (`½ (ω
    /// Δt)²` of the distance from its centroid), its spin changes by `ω² Δt` at most where its
    /// momentum stays, and `x₁ − x₂` changes during the step. Bodies that turn as one do not move
    /// so; with the `x` of the step's end they would, by `½ ω² Δt` of their distance. Together they are less than `3 Δt²
    /// (ω₁² + ω₂²) a + Δt² v²/a`, `a` being no smaller than any of these distances.
    #[inline(always)]
    pub fn relative(&self, pair: &Pair) -> Relative {
        let first = &self.bodies[pair.first as usize];
        let [position, velocity, other_spin] = self.motion(pair.second);
        let closing = sub(first.velocity, *velocity);
        let (apart, half_step) = (sub(first.position, *position), 0.5 * self.dt);
        let apart = [0, 1, 2, 3].map(|k| apart[k] - half_step * closing[k]);
        let velocity = sub(closing, crossed(*other_spin, apart));
        let (reach, spin) = (first.reach(), sub(first.spin, *other_spin));
        let arm = match pair.partner() {
            Partner::Grain(_) => self.extents.between_grains,
            Partner::Wall(_) => self.extents.to_origin,
        };
        let speed_squared = length_squared(velocity);
        let spins_squared = length_squared(first.spin) + length_squared(*other_spin);
        let pace = speed_squared.sqrt() + length_squared(spin).sqrt() * reach;
        let bend = 3.0 * spins_squared * arm + speed_squared / arm;
        Relative {
            velocity,
            spin,
            mean_spin: mean(first.spin, *other_spin),
            moved: self.dt * (CAUTION * pace + self.dt * bend) + self.extents.rounding,
        }
    }

    /// Whether the second side of `pair` knows which side of it is which, however deep a body
    /// sinks: a plane and the inside of a drum do.
    #[inline(always)]
    pub fn has_sides(&self, pair: &Pair) -> bool {
        self.wall(pair).is_some_and(|wall| match wall.surface {
            Surface::Plane { .. } | Surface::Cylinder { .. } => true,
            Surface::Tube { .. } | Surface::Mesh(_) => false,
        })
    }
}
