//! The pair loop: contact law, sliding and rolling friction of every listed pair.
//!
//! In: bodies, listed pairs with their constants, springs and last forces. Out: forces, torques and
//! exchanged energy per pair, new springs. Pairs are computed in lanes and each writes rows of its
//! own; nothing is summed here, so the order of work never shows.
//!
//! With the overlap `δ`, the unit vector `n` from a grain to its partner, the speed of approach
//! `v_n`, the slip `u` of the surfaces, and the law's `k_n`, `η_n`, `k_t`, `η_t` at that overlap:
//!
//! | | |
//! |---|---|
//! | repulsion | `R = k_n δ + η_n v_n`, where the law keeps it |
//! | spring | `ξ`, turned with the grains and into the tangent plane, `+ u Δt`; no longer than `μ B/k_t` |
//! | across the normal | `T = −k_t ξ − η_t u`; no dashpot while the spring is at its bound |
//! | force on the grain | `F = T − R n`, and the bridge's |
//! | torques | `a n × T` on either side, with the arm `a` of that side |
//! | rolling friction | the torque so far, turned likewise, changed against the relative spin: see [`rolling_gain`] |
//!
//! `B` is the force that bounds friction, by the law and, where bridges pull, by the liquid's
//! choice (Kasper et al. 2021, Eqs. 5–10 and 20; Man et al. 2023, Eqs. 3.3–3.5). The partner gets
//! `−F` and `−q`. What is lost is booked by pair: `Δt ((R − k_n δ) v_n + η_t u²)` in dashpots, what
//! the spring gives back less than it took, `Δt q·ω` in rolling, and what a wall does on the grain.
//!
//! Not here: what a partner is ([`super::partners`]), bridges ([`super::bridges`]), formulas of
//! laws ([`crate::physics::law`]).

use super::super::tangential::{Slip, turned, update};
use super::super::walls::WallBody;
use super::bridges::{BridgeColumns, BridgeGroup, Encounter, LiquidForce, Wetting};
use super::partners::{GrainAndWall, PairGeometry, Partners, TwoGrains};
use super::rings::Target;
use super::rows::{ContactForce, GROUP, PairKind, Slot, Sphere, SpherePair, WallId};
use crate::lanes::{Lanes, Quad, Row, cross, dot, minus, plus, side_by_side, times};
use crate::physics::CoulombBound;
use crate::physics::law::{
    FilmConstants, Law, NormalContact, PairConstants, normal_contact, rolling_gain,
};
use std::ops::Range;

/// Constants of pairs side by side: the law's, then friction, rolling arm and both radii.
pub type Constants<N> = ([N; 4], [N; 4]);

/// Constants of pairs that are all of one kind.
#[inline(always)]
pub fn common_constants<N: Lanes>(
    processor: N::Processor,
    constants: &PairConstants,
) -> Constants<N> {
    (
        N::spread(processor, &constants.coefficients),
        N::spread(processor, &constants.contact),
    )
}

/// Constants of pairs of several kinds.
#[inline(always)]
fn own_constants<N: Lanes, P>(
    processor: N::Processor,
    constants: &[PairConstants],
    pairs: &[SpherePair<P>],
) -> Constants<N> {
    let kinds = side_by_side::<N, _>(|k| &constants[pairs[k].kind.index()]);
    (
        N::gather(processor, kinds.map(|kind| &kind.coefficients)),
        N::gather(processor, kinds.map(|kind| &kind.contact)),
    )
}

/// Torque of rolling friction on the grains, at most `cap` [N m]: the one `held` so far, changed
/// against the relative spin that they would have with it, but for its part about the normal, and
/// by no more than stops that spin within the step (Eq. 10 of Kasper et al. 2021, see
/// [`rolling_gain`]).
#[inline(always)]
fn roll<N: Lanes>(
    processor: N::Processor,
    normal: [N; 3],
    cap: N,
    held: [N; 3],
    (spin, compliance): ([N; 3], N),
) -> [N; 3] {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let spin = minus(spin, times(held, compliance));
    let speed = dot(spin, spin).sqrt();
    let gain = rolling_gain(cap, compliance, speed, zero, one);
    let without_twist = minus(spin, times(normal, dot(spin, normal)));
    times(without_twist, -gain)
}

/// Half a step [s], by which velocities lag behind positions; none for a law that is not
/// [objective](Law::OBJECTIVE).
#[inline(always)]
pub fn half_step<N: Lanes, L: Law>(processor: N::Processor, dt: f64) -> N {
    N::splat(processor, if L::OBJECTIVE { 0.5 * dt } else { 0.0 })
}

/// The state of pairs side by side before friction and liquid: geometry, normal force, relative
/// motion.
pub struct PairState<N: Lanes> {
    /// Unit vectors from the grains to their partners.
    pub normal: [N; 3],
    /// Overlaps, negative at a gap [m].
    pub depth: N,
    /// Where they are positive.
    pub touching: N::Mask,
    /// Arms from both centres to the contact [m]; walls need none.
    pub arms: [N; 2],
    /// What the law makes of them along the normal.
    pub along: NormalContact<N>,
    /// Speeds of approach [m/s].
    pub approach: N,
    /// Spins of both [rad/s].
    pub spins: [[N; 3]; 2],
    /// Velocities of the grains' surfaces over their partners' [m/s].
    pub slip: [N; 3],
    /// Angles by which the contacts turn about their normals during the step.
    twist: N,
}

impl<N: Lanes> PairState<N> {
    /// Pairs of `partners` with these constants; `half_step` as [`half_step`] has it.
    #[inline(always)]
    pub fn of<L: Law, P: Partners<N>>(
        processor: N::Processor,
        law: L,
        partners: P,
        (law_constants, [_, _, radius, partner_radius]): &Constants<N>,
        half_step: N,
    ) -> Self {
        let (zero, half) = (N::splat(processor, 0.0), N::splat(processor, 0.5));
        let PairGeometry {
            normal,
            middle_normal,
            depth,
        } = partners.geometry(processor, [*radius, *partner_radius], half_step);
        let touching = depth.exceeds(zero);
        let overlap = N::choose(touching, depth, zero);
        let arm = *radius - half * overlap;
        let partner_arm = if P::WALL {
            zero
        } else {
            *partner_radius - half * overlap
        };
        let velocity = partners.velocity(processor);
        let approach = dot(velocity, middle_normal);
        let contact = (touching, overlap);
        let along = normal_contact(law, *law_constants, contact, approach, zero);
        let (spin, partner_spin) = partners.spins(processor);
        let rolling_sum = if P::WALL {
            times(spin, arm)
        } else {
            plus(times(spin, arm), times(partner_spin, partner_arm))
        };
        let surfaces = plus(velocity, cross(rolling_sum, middle_normal));
        Self {
            normal,
            depth,
            touching,
            arms: [arm, partner_arm],
            along,
            approach,
            spins: [spin, partner_spin],
            twist: half_step * dot(plus(spin, partner_spin), normal),
            slip: minus(surfaces, times(normal, dot(surfaces, normal))),
        }
    }

    /// Torques of rolling friction, at most `cap` [N m], from those of the step `before`; none where
    /// nothing touches.
    #[inline(always)]
    fn rolling(
        &self,
        processor: N::Processor,
        cap: N,
        [x, y, z, _]: [N; 4],
        spin: ([N; 3], N),
    ) -> [N; 3] {
        let held = turned(processor, [x, y, z], self.normal, self.twist);
        let torque = roll(processor, self.normal, cap, held, spin);
        torque.map(|part| N::choose(self.touching, part, N::splat(processor, 0.0)))
    }

    /// The bridges' forces, where there is liquid, and the normal forces that bound Coulomb
    /// friction.
    #[inline(always)]
    fn wetted<L: Law>(
        &self,
        processor: N::Processor,
        all: &PairSurroundings<'_, L>,
        liquid: Option<(BridgeGroup<'_>, Constants<N>)>,
        (_, [_, _, radius, partner_radius]): &Constants<N>,
        compliance: N,
    ) -> (Option<LiquidForce<N>>, N) {
        let zero = N::splat(processor, 0.0);
        let bounding = self.along.bounding;
        let Some((bridges, film)) = liquid else {
            return (None, bounding);
        };
        let encounter = Encounter {
            depth: self.depth,
            touching: self.touching,
            approach: self.approach,
            slip: self.slip,
            compliance,
        };
        let coulomb = bridges.wetting.liquid.law.coulomb;
        let dt = N::splat(processor, all.dt);
        let force = bridges.act(processor, dt, [*radius, *partner_radius], &film, &encounter);
        if coulomb == CoulombBound::Total {
            let total = self.along.repulsion + force.repulsion;
            return (Some(force), N::choose(zero.exceeds(total), -total, total));
        }
        (Some(force), bounding)
    }
}

/// Contact law, bridges, sliding and rolling of as many pairs as there are lanes. Returns how many
/// bridges broke.
///
/// The normal force is what the law makes of overlap and approach. The tangential one is that of a
/// spring and a dashpot, capped by Coulomb's law; a contact that slides has no tangential dashpot.
/// Rolling friction works against the spin that the grain would have after the step without it.
/// Energy is booked pair by pair: what dashpots and springs lose, what rolling takes, what a wall
/// does. Pairs that do not touch and padding lanes come to exact zeros.
#[inline(always)]
fn interact<N: Lanes, L: Law, P: Partners<N>>(
    processor: N::Processor,
    all: &PairSurroundings<'_, L>,
    partners: P,
    constants: &Constants<N>,
    (springs, held): (&mut [Row], &mut [Row]),
    contacts: &mut [ContactForce],
    liquid: Option<(BridgeGroup<'_>, Constants<N>)>,
) -> u32 {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let dt = N::splat(processor, all.dt);
    let (_, [friction, rolling_arm, ..]) = *constants;
    let half_step = half_step::<N, L>(processor, all.dt);
    let state = PairState::of(processor, all.law, partners, constants, half_step);
    let [spin, partner_spin] = state.spins;
    let rolling_spin = partners.rolling(processor);
    let (bridge, bounding) = state.wetted(processor, all, liquid, constants, rolling_spin.1);

    let (normal, slip, touching) = (state.normal, state.slip, state.touching);
    let (law, elastic) = (state.along.coefficients, state.along.elastic);
    let stiffness = N::choose(touching, law.tangential_stiffness, zero);
    let updated = update(
        processor,
        side_by_side::<N, _>(|k| &springs[k]),
        Slip {
            way: times(slip, dt),
            twist: state.twist,
        },
        normal,
        touching,
        stiffness,
        friction * bounding,
    );
    let unslid = N::choose(updated.slides, zero, law.tangential_damping);
    let damping = N::choose(touching, unslid, zero);
    let mut tangential = minus(times(updated.spring, -stiffness), times(slip, damping));
    let damped = (state.along.repulsion - elastic) * state.approach;
    let in_dashpots = dt * (damped + damping * dot(slip, slip));
    let (mut repulsion, mut ruptures) = (state.along.repulsion, 0);
    if let Some(bridge) = bridge {
        repulsion = repulsion + bridge.repulsion;
        tangential = plus(tangential, bridge.drag);
        ruptures = bridge.ruptures;
    }
    let force = minus(tangential, times(normal, repulsion));
    let moment = cross(normal, tangential);

    let before = N::gather(processor, side_by_side::<N, _>(|k| &held[k]));
    let rolling = state.rolling(processor, rolling_arm * elastic, before, rolling_spin);
    let in_rolling = dt * dot(rolling, minus(partner_spin, spin));
    let by_wall = dt * partners.wall_power(processor, force, rolling);
    let ([arm, partner_arm], count) = (state.arms, N::choose(touching, one, zero));
    let exchanged = [in_dashpots, updated.lost, in_rolling, by_wall];
    let companions = [arm, partner_arm, count];
    write(
        (contacts, held),
        [force, moment, rolling],
        companions,
        exchanged,
    );
    for (spring, updated) in springs.iter_mut().zip(&updated.rows) {
        *spring = updated.row();
    }
    ruptures
}

/// Writes contact forces: force, moment and rolling torque, each with its companion, and energies;
/// and the rolling torque where it is remembered.
#[inline(always)]
fn write<N: Lanes>(
    (contacts, held): (&mut [ContactForce], &mut [Row]),
    [force, moment, rolling]: [[N; 3]; 3],
    [arm, partner_arm, count]: [N; 3],
    exchanged: [N; 4],
) {
    let forces = N::rows([force[0], force[1], force[2], arm]);
    let moments = N::rows([moment[0], moment[1], moment[2], partner_arm]);
    let rollings = N::rows([rolling[0], rolling[1], rolling[2], count]);
    let exchanged = N::rows(exchanged);
    for (k, (contact, held)) in contacts.iter_mut().zip(held).enumerate() {
        contact.force = forces[k].row();
        contact.moment = moments[k].row();
        contact.rolling = rollings[k].row();
        *held = rollings[k].row();
        contact.exchanged = exchanged[k].row();
    }
}

/// A range of pairs with what they remember.
pub struct PairRows<'a, P = Slot> {
    /// The pairs.
    pub pairs: &'a [SpherePair<P>],
    /// The kind of all of them, if it is one.
    pub kind: Option<PairKind>,
    /// Their tangential springs.
    pub springs: &'a mut [Row],
    /// Their torques of rolling friction.
    pub rolling: &'a mut [Row],
    /// Their bridges, by groups; empty where nothing is wet.
    pub bridges: &'a mut [BridgeColumns],
}

impl<P> PairRows<'_, P> {
    /// Those in this range, whole groups.
    #[inline(always)]
    pub fn range(&mut self, range: Range<usize>) -> PairRows<'_, P> {
        let groups = if self.bridges.is_empty() {
            0..0
        } else {
            range.start / GROUP..range.end / GROUP
        };
        PairRows {
            pairs: &self.pairs[range.clone()],
            kind: self.kind,
            springs: &mut self.springs[range.clone()],
            rolling: &mut self.rolling[range],
            bridges: &mut self.bridges[groups],
        }
    }
}

/// What every pair's force depends on.
pub struct PairSurroundings<'a, L> {
    /// The contact law.
    pub law: L,
    /// Length of the step [s].
    pub dt: f64,
    /// Every grain.
    pub bodies: &'a [Sphere],
    /// Every wall.
    pub walls: &'a [WallBody],
    /// Constants of every kind of pair.
    pub constants: &'a [PairConstants],
    /// What bridges depend on, where there is liquid.
    pub wetting: Option<Wetting<'a>>,
}

/// What bridges of pairs that are all of one kind depend on.
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

/// What bridges of pairs of several kinds depend on.
#[inline(always)]
fn own_film_constants<N: Lanes>(
    processor: N::Processor,
    wetting: &Wetting<'_>,
    pairs: &[SpherePair],
) -> Constants<N> {
    let kinds = side_by_side::<N, _>(|k| &wetting.constants[pairs[k].kind.index()]);
    (
        N::gather(processor, kinds.map(|kind| &kind.viscous)),
        N::gather(processor, kinds.map(|kind| &kind.gaps)),
    )
}

/// Pairs of grains, as many at a time as there are lanes; with bridges where `WET`. They write where
/// `target` says. Returns how many bridges broke.
#[inline(always)]
pub fn between_grains<N: Lanes, L: Law, const WET: bool>(
    processor: N::Processor,
    all: &PairSurroundings<'_, L>,
    rows: PairRows<'_>,
    target: Target<'_>,
) -> u64 {
    // As a rule all grains are of one class, and the constants are the same throughout.
    let common = rows.kind.map(PairKind::index);
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
            first: side_by_side::<N, _>(|k| &all.bodies[pairs[k].grain.index()]),
            second: side_by_side::<N, _>(|k| &all.bodies[pairs[k].partner.index()]),
        };
        let history = (
            &mut rows.springs[group.clone()],
            &mut rows.rolling[group.clone()],
        );
        let place = (target.first + first) & target.mask;
        let place = place..place + N::COUNT;
        let liquid = match all.wetting {
            Some(wetting) if WET => Some((
                BridgeGroup {
                    wetting,
                    pairs,
                    columns: &mut rows.bridges[first / GROUP],
                    first: first % GROUP,
                    effects: &mut target.bridge_effects[place.clone()],
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
            None => own_constants::<N, _>(processor, all.constants, pairs),
        };
        let forces = &mut target.forces[place];
        ruptures += u64::from(interact(
            processor, all, partners, &constants, history, forces, liquid,
        ));
    }
    ruptures
}

/// As many pairs with one wall as there are lanes.
#[inline(always)]
pub fn at_wall<N: Lanes, L: Law>(
    processor: N::Processor,
    all: &PairSurroundings<'_, L>,
    rows: PairRows<'_, WallId>,
    forces: &mut [ContactForce],
) {
    let pairs = rows.pairs;
    let grain = side_by_side::<N, _>(|k| &all.bodies[pairs[k].grain.index()]);
    let partners = GrainAndWall::<N>::new(
        processor,
        grain,
        &all.walls[pairs[0].partner.index()],
        half_step::<N, L>(processor, all.dt),
    );
    let own = own_constants::<N, _>(processor, all.constants, pairs);
    let history = (rows.springs, rows.rolling);
    interact(processor, all, partners, &own, history, forces, None);
}
