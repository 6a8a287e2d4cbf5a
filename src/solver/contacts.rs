//! The pair loop: geometry, contact law, sliding and rolling friction of every listed pair.
//!
//! In: bodies, listed pairs with their constants and tangential springs. Out: forces, torques and exchanged energy per
//! pair, new springs. Pairs are computed in lanes and each writes rows of its own; nothing is summed here, so the order of
//! work never shows.

use super::lanes::{Lanes, Quad, Row, Work, cross, dot, minus, plus, times};
use super::law::{Coefficients, Law, PairConstants, rolling_gain};
use crate::world::{Motion, Surface};
use glam::DVec3;

/// Listed pairs come in groups of this many, filled up with ghosts, whatever lanes the processor has.
pub const GROUP: usize = 4;

/// What the pair loop reads of a grain: two cache lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct Body {
    /// Centre [m]; inverse mass [1/kg].
    pub position: Row,
    /// Velocity half a step ago [m/s]; inverse moment of inertia [1/(kg m²)].
    pub velocity: Row,
    /// Spin half a step ago [rad/s]; radius [m].
    pub spin: Row,
    /// Spin after the step if nothing resisted rolling [rad/s]; inertia over time step and contact count [N m s].
    pub free_spin: Row,
}

/// What the pair loop reads of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallBody {
    /// Where it is.
    pub surface: Surface,
    /// How it moves.
    pub motion: Motion,
}

/// A pair on the list: a grain, its partner (a grain or a wall) and the index of its constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pair {
    /// The grain on which the computed force acts.
    pub grain: u32,
    /// The other grain's index, or the wall's.
    pub partner: u32,
    /// Index into the pair constants.
    pub kind: u32,
}

/// What a pair does to its partners, in rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct Action {
    /// Force on the grain [N]; arm from the grain's centre to the contact [m].
    pub force: Row,
    /// Normal × force [N]; arm from the partner's centre to the contact [m]. Times the arm, the torque on either side.
    pub twist: Row,
    /// Torque of rolling friction on the grain [N m]; 1 while touching, else 0.
    pub rolling: Row,
    /// Energy lost in dashpots, in sliding, in rolling and done by a wall during the step [J].
    pub exchanged: Row,
}

/// How a grain meets its partner, side by side for as many pairs as there are lanes.
struct Meeting<N> {
    /// Unit vector from the grain to its partner.
    normal: [N; 3],
    /// Overlap, negative at a gap.
    depth: N,
    radius: N,
    /// Zero for a wall: its velocity is taken at the contact.
    partner_radius: N,
    /// Of the grain relative to its partner.
    velocity: [N; 3],
    spin: [N; 3],
    partner_spin: [N; 3],
    /// Relative spin for rolling friction, and the inertia that stops it.
    rolling_spin: [N; 3],
    stopping: N,
    /// Velocity of a wall at the contact.
    wall_velocity: [N; 3],
}

#[inline(always)]
fn rows<'a>(bodies: [&'a Body; 4], row: impl Fn(&'a Body) -> &'a Row) -> [&'a Row; 4] {
    [
        row(bodies[0]),
        row(bodies[1]),
        row(bodies[2]),
        row(bodies[3]),
    ]
}

/// Four grains, of which the first [`Lanes::COUNT`] are those of `pairs`.
#[inline(always)]
fn first_bodies<'a, N: Lanes>(bodies: &'a [Body], pairs: &[Pair]) -> [&'a Body; 4] {
    let body = |k: usize| &bodies[pairs[k.min(N::COUNT - 1)].grain as usize];
    [body(0), body(1), body(2), body(3)]
}

#[inline(always)]
fn second_bodies<'a, N: Lanes>(bodies: &'a [Body], pairs: &[Pair]) -> [&'a Body; 4] {
    let body = |k: usize| &bodies[pairs[k.min(N::COUNT - 1)].partner as usize];
    [body(0), body(1), body(2), body(3)]
}

#[inline(always)]
fn meet_grains<N: Lanes>(processor: N::Processor, a: [&Body; 4], b: [&Body; 4]) -> Meeting<N> {
    let [ax, ay, az, _] = N::gather(processor, rows(a, |body| &body.position));
    let [bx, by, bz, _] = N::gather(processor, rows(b, |body| &body.position));
    let distance = minus([bx, by, bz], [ax, ay, az]);
    let length = dot(distance, distance).sqrt();
    let [ax, ay, az, _] = N::gather(processor, rows(a, |body| &body.velocity));
    let [bx, by, bz, _] = N::gather(processor, rows(b, |body| &body.velocity));
    let velocity = minus([ax, ay, az], [bx, by, bz]);
    let [sx, sy, sz, radius] = N::gather(processor, rows(a, |body| &body.spin));
    let [px, py, pz, partner_radius] = N::gather(processor, rows(b, |body| &body.spin));
    let [ax, ay, az, stop_a] = N::gather(processor, rows(a, |body| &body.free_spin));
    let [bx, by, bz, stop_b] = N::gather(processor, rows(b, |body| &body.free_spin));
    Meeting {
        normal: times(distance, N::splat(processor, 1.0) / length),
        depth: radius + partner_radius - length,
        radius,
        partner_radius,
        velocity,
        spin: [sx, sy, sz],
        partner_spin: [px, py, pz],
        rolling_spin: minus([ax, ay, az], [bx, by, bz]),
        // Half the smaller inertia never exceeds the pair's reduced one.
        stopping: N::splat(processor, 0.5) * N::choose(stop_a.exceeds(stop_b), stop_b, stop_a),
        wall_velocity: [N::splat(processor, 0.0); 3],
    }
}

#[inline(always)]
fn meet_wall<N: Lanes>(processor: N::Processor, a: [&Body; 4], wall: &WallBody) -> Meeting<N> {
    let zero = N::splat(processor, 0.0);
    let [x, y, z, _] = N::gather(processor, rows(a, |body| &body.position));
    let position = [x, y, z];
    let (gap, normal) = match wall.surface {
        Surface::Plane { point, normal } => {
            let normal = splat_vector::<N>(processor, normal);
            (
                dot(minus(position, splat_vector(processor, point)), normal),
                [-normal[0], -normal[1], -normal[2]],
            )
        }
        Surface::Cylinder { radius } => {
            let rho = (x * x + y * y).sqrt();
            (N::splat(processor, radius) - rho, [x / rho, y / rho, zero])
        }
    };
    // A centre on or behind the surface is no contact any more: the check after the step reports it.
    let gap = N::choose(gap.exceeds(zero), gap, N::splat(processor, f64::NAN));
    let foot = plus(position, times(normal, gap));
    let partner_spin = splat_vector(processor, wall.motion.spin);
    let wall_velocity = plus(
        splat_vector(processor, wall.motion.velocity),
        cross(partner_spin, foot),
    );
    let [x, y, z, _] = N::gather(processor, rows(a, |body| &body.velocity));
    let velocity = minus([x, y, z], wall_velocity);
    let [sx, sy, sz, radius] = N::gather(processor, rows(a, |body| &body.spin));
    let [x, y, z, stopping] = N::gather(processor, rows(a, |body| &body.free_spin));
    Meeting {
        normal,
        depth: radius - gap,
        radius,
        partner_radius: zero,
        velocity,
        spin: [sx, sy, sz],
        partner_spin,
        rolling_spin: minus([x, y, z], partner_spin),
        stopping,
        wall_velocity,
    }
}

#[inline(always)]
fn splat_vector<N: Lanes>(processor: N::Processor, v: DVec3) -> [N; 3] {
    [
        N::splat(processor, v.x),
        N::splat(processor, v.y),
        N::splat(processor, v.z),
    ]
}

/// Constants of the pairs: as a rule all of one kind.
#[inline(always)]
fn pair_constants<N: Lanes>(
    processor: N::Processor,
    constants: &[PairConstants],
    pairs: &[Pair],
) -> ([N; 4], [N; 4]) {
    let kind = |k: usize| pairs[k.min(N::COUNT - 1)].kind;
    let first = &constants[kind(0) as usize];
    if kind(1) == kind(0) && kind(2) == kind(0) && kind(3) == kind(0) {
        return (
            N::spread(processor, &first.coefficients),
            N::spread(processor, &first.friction),
        );
    }
    let all = [
        first,
        &constants[kind(1) as usize],
        &constants[kind(2) as usize],
        &constants[kind(3) as usize],
    ];
    (
        N::gather(
            processor,
            [
                &all[0].coefficients,
                &all[1].coefficients,
                &all[2].coefficients,
                &all[3].coefficients,
            ],
        ),
        N::gather(
            processor,
            [
                &all[0].friction,
                &all[1].friction,
                &all[2].friction,
                &all[3].friction,
            ],
        ),
    )
}

/// Contact law, sliding and rolling of as many pairs as there are lanes.
#[inline(always)]
fn interact<N: Lanes, L: Law, const WALL: bool>(
    processor: N::Processor,
    all: &Surroundings<'_, L>,
    meeting: &Meeting<N>,
    pairs: &[Pair],
    springs: &mut [Row],
    actions: &mut [Action],
) {
    let (zero, half) = (N::splat(processor, 0.0), N::splat(processor, 0.5));
    let (one, dt) = (N::splat(processor, 1.0), N::splat(processor, all.dt));
    let &Meeting {
        normal,
        depth,
        radius,
        partner_radius,
        velocity,
        spin,
        partner_spin,
        ..
    } = meeting;
    let &Meeting {
        rolling_spin,
        stopping,
        wall_velocity,
        ..
    } = meeting;
    let touching = depth.exceeds(zero);
    let overlap = N::choose(touching, depth, zero);
    let arm = radius - half * overlap;
    let partner_arm = if WALL {
        zero
    } else {
        partner_radius - half * overlap
    };

    // Normal force.
    let approach = dot(velocity, normal);
    let (law_constants, [friction, rolling_arm, _, _]) =
        pair_constants(processor, all.constants, pairs);
    let Coefficients {
        normal_stiffness,
        normal_damping,
        tangential_stiffness,
        tangential_damping,
    } = all.law.coefficients(law_constants, overlap);
    let normal_damping = N::choose(touching, normal_damping, zero);
    let elastic = normal_stiffness * overlap;
    let repulsion = all
        .law
        .normal_force(elastic, normal_damping * approach, zero);

    // Slip of the grain's surface over its partner's, and the spring it stretches.
    let rolling_sum = plus(times(spin, arm), times(partner_spin, partner_arm));
    let slip = plus(
        minus(velocity, times(normal, approach)),
        cross(rolling_sum, normal),
    );
    let last = N::COUNT - 1;
    let old = [
        &springs[0],
        &springs[1.min(last)],
        &springs[2.min(last)],
        &springs[3.min(last)],
    ];
    let [x, y, z, _] = N::gather(processor, old);
    let stretched = plus([x, y, z], times(slip, dt));
    let stretched = minus(stretched, times(normal, dot(stretched, normal)));
    let stretch_squared = dot(stretched, stretched);
    let trial = tangential_stiffness * stretch_squared.sqrt();
    let bound = friction * all.law.coulomb_force(elastic, repulsion, zero);
    let slides = trial.exceeds(bound);
    let kept = N::choose(slides, bound / trial, one);
    let kept = N::choose(touching, kept, zero);
    let damping = N::choose(touching, N::choose(slides, zero, tangential_damping), zero);
    let spring = times(stretched, kept);
    let new = N::rows([spring[0], spring[1], spring[2], zero]);
    for (spring, new) in springs.iter_mut().zip(new) {
        *spring = new.row();
    }
    let tangential = minus(times(spring, -tangential_stiffness), times(slip, damping));

    // Rolling.
    let gain = rolling_gain(
        rolling_arm * elastic,
        stopping,
        dot(rolling_spin, rolling_spin).sqrt(),
    );
    let without_twist = minus(rolling_spin, times(normal, dot(rolling_spin, normal)));
    let rolling = times(without_twist, -gain);

    // What it does, and where the energy goes.
    let force = minus(tangential, times(normal, repulsion));
    let twist = cross(normal, tangential);
    let in_dashpots = dt * ((repulsion - elastic) * approach + damping * dot(slip, slip));
    let in_sliding = tangential_stiffness * stretch_squared * kept * (one - kept);
    let in_rolling = dt * dot(rolling, minus(partner_spin, spin));
    let by_wall = if WALL {
        dt * (dot(force, wall_velocity) + dot(rolling, partner_spin))
    } else {
        zero
    };
    let touches = N::choose(touching, one, zero);
    let force = N::rows([force[0], force[1], force[2], arm]);
    let twist = N::rows([twist[0], twist[1], twist[2], partner_arm]);
    let rolling = N::rows([rolling[0], rolling[1], rolling[2], touches]);
    let exchanged = N::rows([in_dashpots, in_sliding, in_rolling, by_wall]);
    for (k, action) in actions.iter_mut().enumerate() {
        *action = Action {
            force: force[k].row(),
            twist: twist[k].row(),
            rolling: rolling[k].row(),
            exchanged: exchanged[k].row(),
        };
    }
}

/// A range of pairs with the rows they write.
pub struct PairRows<'a> {
    /// The pairs.
    pub pairs: &'a [Pair],
    /// Their tangential springs.
    pub springs: &'a mut [Row],
    /// What they do.
    pub actions: &'a mut [Action],
}

/// What every pair's force depends on.
pub struct Surroundings<'a, L> {
    /// The contact law.
    pub law: L,
    /// Length of the step [s].
    pub dt: f64,
    /// Every grain.
    pub bodies: &'a [Body],
    /// Every wall.
    pub walls: &'a [WallBody],
    /// Constants of every kind of pair.
    pub constants: &'a [PairConstants],
}

/// The forces of a range of pairs of grains and a range of pairs with walls.
pub struct Forces<'a, L> {
    /// What they depend on.
    pub surroundings: Surroundings<'a, L>,
    /// Pairs of grains.
    pub of_grains: PairRows<'a>,
    /// Pairs of a grain and a wall.
    pub of_walls: PairRows<'a>,
}

/// Pairs of grains, as many at a time as there are lanes.
#[inline(always)]
fn between_grains<N: Lanes, L: Law>(
    processor: N::Processor,
    all: &Surroundings<'_, L>,
    rows: PairRows<'_>,
) {
    let outputs = rows
        .springs
        .chunks_exact_mut(N::COUNT)
        .zip(rows.actions.chunks_exact_mut(N::COUNT));
    for (pairs, (springs, actions)) in rows.pairs.chunks_exact(N::COUNT).zip(outputs) {
        let (a, b) = (
            first_bodies::<N>(all.bodies, pairs),
            second_bodies::<N>(all.bodies, pairs),
        );
        let meeting = meet_grains::<N>(processor, a, b);
        interact::<N, L, false>(processor, all, &meeting, pairs, springs, actions);
    }
}

/// Pairs with walls, as many at a time as there are lanes; each such group meets one wall.
#[inline(always)]
fn at_walls<N: Lanes, L: Law>(
    processor: N::Processor,
    all: &Surroundings<'_, L>,
    rows: PairRows<'_>,
) {
    let outputs = rows
        .springs
        .chunks_exact_mut(N::COUNT)
        .zip(rows.actions.chunks_exact_mut(N::COUNT));
    for (pairs, (springs, actions)) in rows.pairs.chunks_exact(N::COUNT).zip(outputs) {
        let a = first_bodies::<N>(all.bodies, pairs);
        let meeting = meet_wall::<N>(processor, a, &all.walls[pairs[0].partner as usize]);
        interact::<N, L, true>(processor, all, &meeting, pairs, springs, actions);
    }
}

impl<L: Law> Work for Forces<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        between_grains::<N, L>(processor, &self.surroundings, self.of_grains);
        at_walls::<N, L>(processor, &self.surroundings, self.of_walls);
    }
}
