//! Pairs side by side: geometry and kinematics of two grains, and of a grain at a wall.
//!
//! In: the rows of as many pairs as there are lanes. Out: normals, overlaps, relative velocities
//! and spins, which is all that the pair loop knows of what a partner is. Not here: forces
//! ([`super::contacts`]), the distance from a wall ([`crate::world::Surface::contact_in_lanes`]).

use super::super::walls::WallBody;
use super::rows::Sphere;
use crate::lanes::{Lanes, Row, Rows, WIDEST, cross, dot, minus, plus, splat_vector, times};

/// Partners side by side, as many as there are lanes: geometry and kinematics of a pair, for two
/// grains and for a grain at a wall.
///
/// With centres `x`, radii `r`, velocities `v`, spins `ω` and arms `a` from the centres to the
/// contact, the normal is `n = (x₂ − x₁)/|x₂ − x₁|`, the overlap `δ = r₁ + r₂ − |x₂ − x₁|`, the
/// speed of approach `(v₁ − v₂) · m` and the slip of the surfaces `v₁ − v₂ + (a₁ ω₁ + a₂ ω₂) × m`
/// without its part along `n`. Velocities are those of the middle of the step, and so is the normal `m`
/// that they go with, `n` as it was half a step ago: grains that turn as one body with the angular
/// velocity `Ω` would else slip by `½ Ω² Δt` of their distance. What a law needs of them is read
/// when it is needed: registers are few.
pub trait Partners<N: Lanes>: Copy {
    /// Whether the second side is a wall: its velocity is taken at the contact, so that it needs no
    /// arm.
    const WALL: bool;

    /// Where the two are, for these radii, and where they were `half_step` ago [s].
    fn geometry(self, processor: N::Processor, radii: [N; 2], half_step: N) -> PairGeometry<N>;
    /// Power of this force and this torque on the grain [W], where the partner is a wall that moves.
    fn wall_power(self, processor: N::Processor, force: [N; 3], torque: [N; 3]) -> N;
    /// Velocity of the grain relative to its partner.
    fn velocity(self, processor: N::Processor) -> [N; 3];
    /// Spins of both.
    fn spins(self, processor: N::Processor) -> ([N; 3], [N; 3]);
    /// Relative spin for rolling friction, and how much of it a unit of torque stops.
    fn rolling(self, processor: N::Processor) -> ([N; 3], N);
}

/// Where pairs are.
pub struct PairGeometry<N> {
    /// Unit vectors from the grains to their partners.
    pub normal: [N; 3],
    /// The same in the middle of the step; as long as one but for terms of second order.
    pub middle_normal: [N; 3],
    /// Overlaps, negative at a gap [m].
    pub depth: N,
}

/// Pairs of grains.
#[derive(Clone, Copy)]
pub struct TwoGrains<'a> {
    /// The grains on which the computed forces act.
    pub first: [&'a Sphere; WIDEST],
    /// Their partners.
    pub second: [&'a Sphere; WIDEST],
}

/// Grains at one wall.
#[derive(Clone, Copy)]
pub struct GrainAndWall<'a, N> {
    /// The grains.
    grain: [&'a Sphere; WIDEST],
    /// The wall that all of them meet.
    wall: &'a WallBody,
    /// Unit vectors from the grains to the wall.
    normal: [N; 3],
    /// The same in the middle of the step.
    middle_normal: [N; 3],
    /// Distances of their centres from it, not a number behind it [m].
    gap: N,
    /// Where the forces acted in the middle of the step [m].
    contact: [N; 3],
}

/// One row of each body.
#[inline(always)]
fn rows<'a>(bodies: [&'a Sphere; WIDEST], row: impl Fn(&'a Sphere) -> &'a Row) -> Rows<'a> {
    bodies.map(row)
}

/// Two grains: differences of their rows, column by column.
impl<N: Lanes> Partners<N> for TwoGrains<'_> {
    const WALL: bool = false;

    #[inline(always)]
    fn geometry(self, processor: N::Processor, radii: [N; 2], half_step: N) -> PairGeometry<N> {
        let (a, b) = (
            rows(self.first, |body| &body.position),
            rows(self.second, |body| &body.position),
        );
        let [x, y, z, _] = N::gather_difference(processor, b, a);
        let length = dot([x, y, z], [x, y, z]).sqrt();
        let inverse = N::splat(processor, 1.0) / length;
        let normal = times([x, y, z], inverse);
        let velocity = self.velocity(processor);
        let across = minus(velocity, times(normal, dot(velocity, normal)));
        PairGeometry {
            normal,
            middle_normal: plus(normal, times(across, half_step * inverse)),
            depth: radii[0] + radii[1] - length,
        }
    }

    #[inline(always)]
    fn wall_power(self, processor: N::Processor, _force: [N; 3], _torque: [N; 3]) -> N {
        N::splat(processor, 0.0)
    }

    #[inline(always)]
    fn velocity(self, processor: N::Processor) -> [N; 3] {
        let (a, b) = (
            rows(self.first, |body| &body.velocity),
            rows(self.second, |body| &body.velocity),
        );
        let [x, y, z, _] = N::gather_difference(processor, a, b);
        [x, y, z]
    }

    #[inline(always)]
    fn spins(self, processor: N::Processor) -> ([N; 3], [N; 3]) {
        let [ax, ay, az, _] = N::gather(processor, rows(self.first, |body| &body.spin));
        let [bx, by, bz, _] = N::gather(processor, rows(self.second, |body| &body.spin));
        ([ax, ay, az], [bx, by, bz])
    }

    #[inline(always)]
    fn rolling(self, processor: N::Processor) -> ([N; 3], N) {
        let (a, b) = (
            rows(self.first, |body| &body.free_spin),
            rows(self.second, |body| &body.free_spin),
        );
        let [x, y, z, compliance] = N::gather_difference_and_sum(processor, a, b);
        ([x, y, z], compliance)
    }
}

impl<'a, N: Lanes> GrainAndWall<'a, N> {
    /// Grains at `wall`, and where they were `half_step` ago [s].
    #[inline(always)]
    pub fn new(
        processor: N::Processor,
        grain: [&'a Sphere; WIDEST],
        wall: &'a WallBody,
        half_step: N,
    ) -> Self {
        let [x, y, z, _] = N::gather(processor, rows(grain, |body| &body.position));
        let [_, _, _, radius] = N::gather(processor, rows(grain, |body| &body.spin));
        let position = [x, y, z];
        let [x, y, z, _] = N::gather(processor, rows(grain, |body| &body.velocity));
        let middle = minus(position, times([x, y, z], half_step));
        let (gap, normal) = wall.surface.contact_in_lanes(processor, position);
        let (middle_gap, middle_normal) = wall.surface.distance_in_lanes(processor, middle);
        // A centre on or behind the surface is no contact any more: the check after the step
        // reports it.
        let inside = gap.exceeds(N::splat(processor, 0.0));
        let nowhere = N::splat(processor, f64::NAN);
        let gap = N::choose(inside, gap, nowhere);
        let middle_gap = N::choose(inside, middle_gap, nowhere);
        Self {
            grain,
            wall,
            normal,
            middle_normal,
            gap,
            // Where the force acts, half the overlap behind the surface: else a grain at rest on a
            // turning wall would slip.
            contact: plus(
                middle,
                times(
                    middle_normal,
                    N::splat(processor, 0.5) * (radius + middle_gap),
                ),
            ),
        }
    }

    /// Velocity of the wall at the contact in the middle of the step.
    #[inline(always)]
    fn wall_velocity(self, processor: N::Processor) -> [N; 3] {
        let motion = &self.wall.motion;
        plus(
            splat_vector(processor, motion.velocity.to_array()),
            cross(
                splat_vector(processor, motion.spin.to_array()),
                self.contact,
            ),
        )
    }
}

/// A grain and a wall: a partner of infinite mass whose surface moves by the wall's velocity field.
impl<N: Lanes> Partners<N> for GrainAndWall<'_, N> {
    const WALL: bool = true;

    #[inline(always)]
    fn geometry(self, _processor: N::Processor, radii: [N; 2], _half_step: N) -> PairGeometry<N> {
        PairGeometry {
            normal: self.normal,
            middle_normal: self.middle_normal,
            depth: radii[0] - self.gap,
        }
    }

    #[inline(always)]
    fn wall_power(self, processor: N::Processor, force: [N; 3], torque: [N; 3]) -> N {
        let spin = splat_vector(processor, self.wall.motion.spin.to_array());
        dot(force, self.wall_velocity(processor)) + dot(torque, spin)
    }

    #[inline(always)]
    fn velocity(self, processor: N::Processor) -> [N; 3] {
        let [x, y, z, _] = N::gather(processor, rows(self.grain, |body| &body.velocity));
        minus([x, y, z], self.wall_velocity(processor))
    }

    #[inline(always)]
    fn spins(self, processor: N::Processor) -> ([N; 3], [N; 3]) {
        let [x, y, z, _] = N::gather(processor, rows(self.grain, |body| &body.spin));
        (
            [x, y, z],
            splat_vector(processor, self.wall.motion.spin.to_array()),
        )
    }

    #[inline(always)]
    fn rolling(self, processor: N::Processor) -> ([N; 3], N) {
        let [x, y, z, compliance] = N::gather(processor, rows(self.grain, |body| &body.free_spin));
        (
            minus(
                [x, y, z],
                splat_vector(processor, self.wall.motion.spin.to_array()),
            ),
            compliance,
        )
    }
}
