//! The pair loop: geometry, contact law, sliding and rolling friction of every listed pair.
//!
//! In: bodies, listed pairs with their constants and tangential springs. Out: forces, torques and exchanged energy per
//! pair, new springs. Pairs are computed in lanes and each writes rows of its own; nothing is summed here, so the order of
//! work never shows.

use super::bridges::{BridgeColumns, BridgeGroup, Encounter, LiquidAction, Wetting};
use super::lanes::{
    Lanes, Quad, Row, Rows, WIDEST, Work, cross, dot, minus, plus, side_by_side, times,
};
use super::law::{FilmConstants, Law, PairConstants, normal_contact, rolling_gain};
use super::spring::stretch;
use crate::physics::CoulombBound;
use crate::world::{Motion, Surface};
use glam::DVec3;

/// Listed pairs come in groups of this many, filled up with ghosts, whatever lanes the processor has.
pub const GROUP: usize = WIDEST;

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
    /// Spin after the step if nothing resisted rolling [rad/s]; time step and contact count over inertia [1/(N m s)].
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
    /// Energy lost in dashpots, by the tangential spring (in sliding and as its stiffness changes), in rolling and done by a
    /// wall during the step [J].
    pub exchanged: Row,
}

/// Partners side by side, as many as there are lanes. What a law needs of them is read when it is needed: registers are
/// few.
trait Partners<N: Lanes>: Copy {
    /// Whether the second side is a wall: its velocity is taken at the contact, so that it needs no arm.
    const WALL: bool;

    /// Unit vectors from the grains to their partners, and the overlaps (negative at a gap), for these radii.
    fn geometry(self, processor: N::Processor, radii: [N; 2]) -> ([N; 3], N);
    /// Velocity of the partner at the contact, where it is a wall.
    fn wall_velocity(self, processor: N::Processor) -> [N; 3];
    /// Velocity of the grain relative to its partner.
    fn velocity(self, processor: N::Processor) -> [N; 3];
    /// Spins of both.
    fn spins(self, processor: N::Processor) -> ([N; 3], [N; 3]);
    /// Relative spin for rolling friction, and how much of it a unit of torque stops.
    fn rolling(self, processor: N::Processor) -> ([N; 3], N);
}

/// Pairs of grains.
#[derive(Clone, Copy)]
struct TwoGrains<'a> {
    first: [&'a Body; WIDEST],
    second: [&'a Body; WIDEST],
}

/// Grains at one wall.
#[derive(Clone, Copy)]
struct GrainAndWall<'a, N> {
    grain: [&'a Body; WIDEST],
    wall: &'a WallBody,
    normal: [N; 3],
    gap: N,
    contact: [N; 3],
}

#[inline(always)]
fn rows<'a>(bodies: [&'a Body; WIDEST], row: impl Fn(&'a Body) -> &'a Row) -> Rows<'a> {
    bodies.map(row)
}

impl<N: Lanes> Partners<N> for TwoGrains<'_> {
    const WALL: bool = false;

    #[inline(always)]
    fn geometry(self, processor: N::Processor, radii: [N; 2]) -> ([N; 3], N) {
        let (a, b) = (
            rows(self.first, |body| &body.position),
            rows(self.second, |body| &body.position),
        );
        let [x, y, z, _] = N::gather_difference(processor, b, a);
        let length = dot([x, y, z], [x, y, z]).sqrt();
        let inverse = N::splat(processor, 1.0) / length;
        (times([x, y, z], inverse), radii[0] + radii[1] - length)
    }

    #[inline(always)]
    fn wall_velocity(self, processor: N::Processor) -> [N; 3] {
        [N::splat(processor, 0.0); 3]
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
    #[inline(always)]
    fn new(processor: N::Processor, grain: [&'a Body; WIDEST], wall: &'a WallBody) -> Self {
        let [x, y, z, _] = N::gather(processor, rows(grain, |body| &body.position));
        let [_, _, _, radius] = N::gather(processor, rows(grain, |body| &body.spin));
        let position = [x, y, z];
        let (gap, normal) = match wall.surface {
            Surface::Plane { point, normal } => {
                let inward = splat_vector::<N>(processor, normal);
                (
                    dot(minus(position, splat_vector(processor, point)), inward),
                    splat_vector(processor, -normal),
                )
            }
            Surface::Cylinder { radius } => {
                let rho = (x * x + y * y).sqrt();
                (
                    N::splat(processor, radius) - rho,
                    [x / rho, y / rho, N::splat(processor, 0.0)],
                )
            }
            Surface::Tube { radius, rim } => {
                let zero = N::splat(processor, 0.0);
                let rho = (x * x + z * z).sqrt();
                let outward = (N::splat(processor, radius) - rho) / rho;
                let below = N::splat(processor, rim) - y;
                let below = N::choose(below.exceeds(zero), below, zero);
                let nearest = [x * outward, below, z * outward];
                let distance = dot(nearest, nearest).sqrt();
                (
                    distance,
                    times(nearest, N::splat(processor, 1.0) / distance),
                )
            }
        };
        // A centre on or behind the surface is no contact any more: the check after the step reports it.
        let gap = N::choose(
            gap.exceeds(N::splat(processor, 0.0)),
            gap,
            N::splat(processor, f64::NAN),
        );
        Self {
            grain,
            wall,
            normal,
            gap,
            // Where the force acts, half the overlap behind the surface: else a grain at rest on a turning wall would slip.
            contact: plus(
                position,
                times(normal, N::splat(processor, 0.5) * (radius + gap)),
            ),
        }
    }
}

impl<N: Lanes> Partners<N> for GrainAndWall<'_, N> {
    const WALL: bool = true;

    #[inline(always)]
    fn geometry(self, _processor: N::Processor, radii: [N; 2]) -> ([N; 3], N) {
        (self.normal, radii[0] - self.gap)
    }

    #[inline(always)]
    fn wall_velocity(self, processor: N::Processor) -> [N; 3] {
        let motion = &self.wall.motion;
        plus(
            splat_vector(processor, motion.velocity),
            cross(splat_vector(processor, motion.spin), self.contact),
        )
    }

    #[inline(always)]
    fn velocity(self, processor: N::Processor) -> [N; 3] {
        let [x, y, z, _] = N::gather(processor, rows(self.grain, |body| &body.velocity));
        minus([x, y, z], self.wall_velocity(processor))
    }

    #[inline(always)]
    fn spins(self, processor: N::Processor) -> ([N; 3], [N; 3]) {
        let [x, y, z, _] = N::gather(processor, rows(self.grain, |body| &body.spin));
        ([x, y, z], splat_vector(processor, self.wall.motion.spin))
    }

    #[inline(always)]
    fn rolling(self, processor: N::Processor) -> ([N; 3], N) {
        let [x, y, z, compliance] = N::gather(processor, rows(self.grain, |body| &body.free_spin));
        (
            minus([x, y, z], splat_vector(processor, self.wall.motion.spin)),
            compliance,
        )
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

/// Constants of pairs side by side: the law's, then friction, rolling arm and both radii.
type Constants<N> = ([N; 4], [N; 4]);

#[inline(always)]
fn common_constants<N: Lanes>(processor: N::Processor, constants: &PairConstants) -> Constants<N> {
    (
        N::spread(processor, &constants.coefficients),
        N::spread(processor, &constants.contact),
    )
}

#[inline(always)]
fn own_constants<N: Lanes>(
    processor: N::Processor,
    constants: &[PairConstants],
    pairs: &[Pair],
) -> Constants<N> {
    let kinds = side_by_side::<N, _>(|k| &constants[pairs[k].kind as usize]);
    (
        N::gather(processor, kinds.map(|kind| &kind.coefficients)),
        N::gather(processor, kinds.map(|kind| &kind.contact)),
    )
}

/// Torque of rolling friction on the grains, at most `cap` [N m].
#[inline(always)]
fn roll<N: Lanes>(
    processor: N::Processor,
    normal: [N; 3],
    cap: N,
    (spin, compliance): ([N; 3], N),
) -> [N; 3] {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let speed = dot(spin, spin).sqrt();
    let gain = rolling_gain(cap, compliance, speed, zero, one);
    let without_twist = minus(spin, times(normal, dot(spin, normal)));
    times(without_twist, -gain)
}

/// Contact law, bridges, sliding and rolling of as many pairs as there are lanes. Returns how many bridges broke.
#[inline(always)]
fn interact<N: Lanes, L: Law, P: Partners<N>>(
    processor: N::Processor,
    all: &Surroundings<'_, L>,
    partners: P,
    constants: &Constants<N>,
    springs: &mut [Row],
    actions: &mut [Action],
    liquid: Option<(BridgeGroup<'_>, Constants<N>)>,
) -> u32 {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let (half, dt) = (N::splat(processor, 0.5), N::splat(processor, all.dt));
    let (law_constants, [friction, rolling_arm, radius, partner_radius]) = *constants;

    let (normal, depth) = partners.geometry(processor, [radius, partner_radius]);
    let touching = depth.exceeds(zero);
    let overlap = N::choose(touching, depth, zero);
    let arm = radius - half * overlap;
    let partner_arm = if P::WALL {
        zero
    } else {
        partner_radius - half * overlap
    };

    // Normal force.
    let velocity = partners.velocity(processor);
    let approach = dot(velocity, normal);
    let along = normal_contact(all.law, law_constants, (touching, overlap), approach, zero);
    let (law, elastic, repulsion) = (along.coefficients, along.elastic, along.repulsion);

    // Slip of the grain's surface over its partner's.
    let (spin, partner_spin) = partners.spins(processor);
    let rolling_sum = if P::WALL {
        times(spin, arm)
    } else {
        plus(times(spin, arm), times(partner_spin, partner_arm))
    };
    let slip = plus(
        minus(velocity, times(normal, approach)),
        cross(rolling_sum, normal),
    );
    let rolling_spin = partners.rolling(processor);

    let mut bounding = along.bounding;
    let bridge = if let Some((bridges, film)) = liquid {
        let encounter = Encounter {
            depth,
            touching,
            approach,
            slip,
            compliance: rolling_spin.1,
        };
        let coulomb = bridges.wetting.liquid.law.coulomb;
        let force = bridges.act(processor, dt, [radius, partner_radius], &film, &encounter);
        if coulomb == CoulombBound::Total {
            let total = repulsion + force.repulsion;
            bounding = N::choose(zero.exceeds(total), -total, total);
        }
        Some(force)
    } else {
        None
    };

    // Tangential force.
    let stiffness = N::choose(touching, law.tangential_stiffness, zero);
    let slipped = times(slip, dt);
    let stretched = stretch(
        processor,
        side_by_side::<N, _>(|k| &springs[k]),
        slipped,
        normal,
        touching,
        stiffness,
        friction * bounding,
    );
    for (row, new) in springs.iter_mut().zip(stretched.rows) {
        *row = new.row();
    }
    let unslid = N::choose(stretched.slides, zero, law.tangential_damping);
    let damping = N::choose(touching, unslid, zero);
    let mut tangential = minus(times(stretched.spring, -stiffness), times(slip, damping));
    let in_dashpots = dt * ((repulsion - elastic) * approach + damping * dot(slip, slip));

    let (mut total_repulsion, mut ruptures) = (repulsion, 0);
    if let Some(bridge) = bridge {
        total_repulsion = repulsion + bridge.repulsion;
        tangential = plus(tangential, bridge.drag);
        ruptures = bridge.ruptures;
    }
    let force = minus(tangential, times(normal, total_repulsion));
    let twist = cross(normal, tangential);

    let rolling = roll(processor, normal, rolling_arm * elastic, rolling_spin);
    let in_rolling = dt * dot(rolling, minus(partner_spin, spin));
    let by_wall = if P::WALL {
        dt * (dot(force, partners.wall_velocity(processor)) + dot(rolling, partner_spin))
    } else {
        zero
    };

    let count = N::choose(touching, one, zero);
    let forces = N::rows([force[0], force[1], force[2], arm]);
    let twists = N::rows([twist[0], twist[1], twist[2], partner_arm]);
    let rollings = N::rows([rolling[0], rolling[1], rolling[2], count]);
    let exchanged = N::rows([in_dashpots, stretched.lost, in_rolling, by_wall]);
    for (k, action) in actions.iter_mut().enumerate() {
        action.force = forces[k].row();
        action.twist = twists[k].row();
        action.rolling = rollings[k].row();
        action.exchanged = exchanged[k].row();
    }
    ruptures
}

/// A range of pairs with the rows they write.
pub struct PairRows<'a> {
    /// The pairs.
    pub pairs: &'a [Pair],
    /// The kind of all of them, if it is one.
    pub kind: Option<u32>,
    /// Their tangential springs [m], and the stiffness of each when it was last stretched [N/m].
    pub springs: &'a mut [Row],
    /// What they do.
    pub actions: &'a mut [Action],
    /// Their bridges, by groups; empty where nothing is wet.
    pub bridges: &'a mut [BridgeColumns],
    /// What the bridges do.
    pub liquid_actions: &'a mut [LiquidAction],
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
    /// What bridges depend on, where there is liquid.
    pub wetting: Option<Wetting<'a>>,
}

/// The forces of a range of pairs of grains and of ranges of pairs with walls.
pub struct Forces<'a, L, W> {
    /// What they depend on.
    pub surroundings: Surroundings<'a, L>,
    /// Pairs of grains.
    pub of_grains: PairRows<'a>,
    /// Pairs of a grain and a wall, range by range.
    pub of_walls: W,
}

#[inline(always)]
fn common_film_constants<N: Lanes>(
    processor: N::Processor,
    constants: &FilmConstants,
) -> Constants<N> {
    (
        N::spread(processor, &constants.viscous),
        N::spread(processor, &constants.gaps),
    )
}

#[inline(always)]
fn own_film_constants<N: Lanes>(
    processor: N::Processor,
    wetting: &Wetting<'_>,
    pairs: &[Pair],
) -> Constants<N> {
    let kinds = side_by_side::<N, _>(|k| &wetting.constants[pairs[k].kind as usize]);
    (
        N::gather(processor, kinds.map(|kind| &kind.viscous)),
        N::gather(processor, kinds.map(|kind| &kind.gaps)),
    )
}

/// Pairs of grains, as many at a time as there are lanes; with bridges where `WET`. Returns how many of those broke.
#[inline(always)]
fn between_grains<N: Lanes, L: Law, const WET: bool>(
    processor: N::Processor,
    all: &Surroundings<'_, L>,
    rows: PairRows<'_>,
) -> u64 {
    // As a rule all grains are of one class, and the constants are the same throughout.
    let common = rows.kind.map(|kind| kind as usize);
    let common_film = match all.wetting {
        Some(wetting) if WET => {
            common.map(|kind| common_film_constants::<N>(processor, &wetting.constants[kind]))
        }
        _ => None,
    };
    let common = common.map(|kind| common_constants::<N>(processor, &all.constants[kind]));
    let mut ruptures = 0;
    for first in (0..rows.pairs.len()).step_by(N::COUNT) {
        let group = first..first + N::COUNT;
        let pairs = &rows.pairs[group.clone()];
        let partners = TwoGrains {
            first: side_by_side::<N, _>(|k| &all.bodies[pairs[k].grain as usize]),
            second: side_by_side::<N, _>(|k| &all.bodies[pairs[k].partner as usize]),
        };
        let springs = &mut rows.springs[group.clone()];
        let actions = &mut rows.actions[group.clone()];
        let liquid = match all.wetting {
            Some(wetting) if WET => Some((
                BridgeGroup {
                    wetting,
                    pairs,
                    columns: &mut rows.bridges[first / GROUP],
                    first: first % GROUP,
                    actions: &mut rows.liquid_actions[group],
                },
                match &common_film {
                    Some(film) => *film,
                    None => own_film_constants(processor, &wetting, pairs),
                },
            )),
            _ => None,
        };
        let constants = match &common {
            Some(common) => *common,
            None => own_constants::<N>(processor, all.constants, pairs),
        };
        ruptures += u64::from(interact(
            processor, all, partners, &constants, springs, actions, liquid,
        ));
    }
    ruptures
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
        let grain = side_by_side::<N, _>(|k| &all.bodies[pairs[k].grain as usize]);
        let partners =
            GrainAndWall::<N>::new(processor, grain, &all.walls[pairs[0].partner as usize]);
        let own = own_constants::<N>(processor, all.constants, pairs);
        interact(processor, all, partners, &own, springs, actions, None);
    }
}

impl<'a, L: Law, W: Iterator<Item = PairRows<'a>>> Work for Forces<'a, L, W> {
    type Output = u64;

    /// Returns how many bridges broke.
    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> u64 {
        let ruptures = if self.surroundings.wetting.is_some() {
            between_grains::<N, L, true>(processor, &self.surroundings, self.of_grains)
        } else {
            between_grains::<N, L, false>(processor, &self.surroundings, self.of_grains)
        };
        for rows in self.of_walls {
            at_walls::<N, L>(processor, &self.surroundings, rows);
        }
        ruptures
    }
}
