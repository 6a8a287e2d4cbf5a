//! The contact law between features of polyhedra, as many contacts at a time as there are lanes.
//!
//! In: pairs with their constants and relative motion, nearest points of features, what the
//! contacts remember. Out: forces, torques, energies, tangential springs one step on.
//!
//! With the unit vector `n` from the first side to the second, the overlap `δ`, the speed of
//! approach `v_n` and the slip `u`, a feature that has the part `p` of its pair's stiffness presses
//! with `R = max(0, p (K_n δ + m_e γ_n v_n))` and drags with `−p K_t ξ`, capped at `μ p K_n δ` (Man
//! et al. 2023, Eqs. 3.1–3.6): Hooke's law ([`Hooke`]) with the pair's constants times `p`. The
//! force on the first side is `−p K_t ξ − R n`, its torque that about the centroid.
//!
//! Where springs are taken implicitly they push, in a step, by the mean `δ + ¼ Δt² δ''` of their
//! overlap, which is less than `δ` while an impact is stopped. Friction is bounded by what they push:
//! by `μ p K_n (δ + ¼ Δt (v_n − w))`, where the running mean `w ← ½ (w + v_n)` of the speed of
//! approach, which begins with the contact, lags behind it by `Δt v_n'`. By `δ` alone the friction of
//! an impact would be too large by `¼ Δt² K_n/m`.
//!
//! Not here: which features are measured ([`super::workspace`]), sums over a pair's contacts
//! ([`super::forces`]), what of it is taken implicitly ([`super::joint`]).

use super::super::tangential::{Slip, update};
use super::nearest::Nearest;
use super::pairs::ContactPoint;
use super::workspace::ActivePair;
use crate::lanes::{Lanes, Rows, WIDEST, cross, dot, minus, plus, side_by_side, times};
use crate::physics::law::{Hooke, NormalContact, normal_contact};

/// As many contacts as there are lanes, side by side.
pub struct ContactGroup<N> {
    /// Unit vectors from the first sides to the second.
    pub normal: [N; 3],
    /// Overlaps, negative at a gap [m].
    pub depth: N,
    /// Arms from the centroids of the first sides to the contacts [m].
    pub arm: [N; 3],
    /// Velocities of the first sides relative to the second at the first's centroids [m/s].
    velocity: [N; 3],
    /// Relative spins [rad/s].
    spin: [N; 3],
    /// Mean spins of both sides [rad/s].
    mean_spin: [N; 3],
    /// Parts of the pairs' stiffness that the contacts have, now and a step ago.
    parts: [N; 2],
    /// `K_n`, the normal dashpot, `K_t`, μ.
    law: [N; 4],
    /// Overlaps a step ago [m], and what is remembered along the normal ([`ContactPoint::normal_memory`]).
    before: [N; 2],
}

/// How contacts side by side press each other before anything drags them.
pub struct NormalForces<N: Lanes> {
    /// Where features overlap.
    pub touching: N::Mask,
    /// Overlaps, none at a gap [m].
    pub overlap: N,
    /// Speeds of approach along the normal [m/s].
    pub approach: N,
    /// Velocities of the firsts' surfaces over the seconds' [m/s].
    pub slip: [N; 3],
    /// What the law makes of them.
    pub along: NormalContact<N>,
    /// Repulsion, of the spring alone where dashpots are taken implicitly [N].
    pub repulsion: N,
    /// Those dashpots, none where the contact has let go [N s/m].
    pub dashpot: N,
    /// The springs beside them, likewise [N/m].
    pub stiffness: N,
}

/// What contacts do: rows, of which the first [`Lanes::COUNT`] count.
pub struct ContactForces<N: Lanes> {
    /// Force on the first [N]; overlap [m].
    pub forces: [N::Quad; WIDEST],
    /// Its torque [N m]; what is to be remembered along the normal ([`ContactPoint::normal_memory`]).
    pub moments: [N::Quad; WIDEST],
    /// Energy lost in the dashpot, by the tangential spring, put into the normal spring [J].
    pub energies: [N::Quad; WIDEST],
    /// Tangential springs [m] and their stiffness [N/m].
    pub springs: [N::Quad; WIDEST],
    /// Where springs and dashpots are taken implicitly: normals and dashpots [N s/m], arms across the
    /// normals [m] and springs, arms [m] and tangential springs; springs of contacts that have let go
    /// or slide are none [N/m].
    pub implicit: [[N::Quad; WIDEST]; 3],
    /// Of gaps that close within the step: springs [N/m] and overlaps, which are negative [m].
    pub closing: [N::Quad; WIDEST],
}

impl<N: Lanes> ContactGroup<N> {
    /// Contacts of these pairs, with their laws' constants, nearest points and memories.
    #[inline(always)]
    pub fn gather(
        processor: N::Processor,
        pair: [&ActivePair; WIDEST],
        law: Rows<'_>,
        nearest: [&Nearest; WIDEST],
        point: [&ContactPoint; WIDEST],
    ) -> Self {
        let before = side_by_side::<N, _>(|k| [point[k].overlap, point[k].normal_memory, 0.0, 0.0]);
        let [nx, ny, nz, _] = N::gather(processor, side_by_side::<N, _>(|k| &nearest[k].normal));
        let normal = [nx, ny, nz];
        let [mx, my, mz, depth] =
            N::gather(processor, side_by_side::<N, _>(|k| &nearest[k].middle));
        let [cx, cy, cz, offset] = N::gather(processor, side_by_side::<N, _>(|k| &pair[k].centre));
        let [vx, vy, vz, part] = N::gather(processor, side_by_side::<N, _>(|k| &pair[k].velocity));
        let [wx, wy, wz, part_before] =
            N::gather(processor, side_by_side::<N, _>(|k| &pair[k].spin));
        let [x, y, z, _] = N::gather(processor, side_by_side::<N, _>(|k| &pair[k].mean_spin));
        let law = N::gather(processor, law);
        let [overlap, memory, ..] = N::gather(processor, side_by_side::<N, _>(|k| &before[k]));
        Self {
            normal,
            depth,
            arm: plus(minus([mx, my, mz], [cx, cy, cz]), times(normal, offset)),
            velocity: [vx, vy, vz],
            spin: [wx, wy, wz],
            mean_spin: [x, y, z],
            parts: [part, part_before],
            law,
            before: [overlap, memory],
        }
    }

    /// What they do along the normal: Hooke's spring and a dashpot, together never pulling. Where
    /// dashpots are `IMPLICIT` the spring alone presses, and a contact that would pull lets go of
    /// both.
    #[inline(always)]
    pub fn normal_forces<const IMPLICIT: bool>(&self, zero: N) -> NormalForces<N> {
        let ([part, _], [stiffness, damping, tangential_stiffness, _]) = (self.parts, self.law);
        let touching = self.depth.exceeds(zero);
        let overlap = N::choose(touching, self.depth, zero);
        let velocity = plus(self.velocity, cross(self.spin, self.arm));
        let approach = dot(velocity, self.normal);
        let constants = [
            stiffness * part,
            damping * part,
            tangential_stiffness * part,
            zero,
        ];
        let contact = (touching, overlap);
        let along = normal_contact(Hooke::default(), constants, contact, approach, zero);
        let (repulsion, dashpot, stiffness) = if IMPLICIT {
            let holds = along.repulsion.exceeds(zero);
            (
                N::choose(holds, along.elastic, zero),
                N::choose(holds, along.coefficients.normal_damping, zero),
                N::choose(holds, along.coefficients.normal_stiffness, zero),
            )
        } else {
            (along.repulsion, zero, zero)
        };
        NormalForces {
            touching,
            overlap,
            approach,
            slip: minus(velocity, times(self.normal, approach)),
            along,
            repulsion,
            dashpot,
            stiffness,
        }
    }

    /// The friction that Coulomb's law allows [N], with the `memory` that contacts keep of this
    /// step along their normals.
    #[inline(always)]
    pub fn coulomb_bound<const IMPLICIT: bool>(
        &self,
        processor: N::Processor,
        dt: f64,
        (pressed, memory): (&NormalForces<N>, N),
    ) -> N {
        let bounding = pressed.along.bounding;
        if !IMPLICIT {
            return self.law[3] * bounding;
        }
        let zero = N::splat(processor, 0.0);
        let faster = N::splat(processor, 0.25 * dt) * (pressed.approach - memory);
        let bounding = bounding + pressed.stiffness * faster;
        self.law[3] * N::choose(bounding.exceeds(zero), bounding, zero)
    }

    /// What contacts remember along their normals of this step ([`ContactPoint::normal_memory`]).
    #[inline(always)]
    fn normal_memory<const IMPLICIT: bool>(
        &self,
        processor: N::Processor,
        pressed: &NormalForces<N>,
    ) -> N {
        if !IMPLICIT {
            return pressed.repulsion - pressed.along.elastic;
        }
        let (zero, half) = (N::splat(processor, 0.0), N::splat(processor, 0.5));
        let mean = half * (self.before[1] + pressed.approach);
        let mean = self.where_held(zero, mean, pressed.approach);
        // What holds is never remembered by zero.
        let mean = mean + N::splat(processor, f64::MIN_POSITIVE);
        N::choose(pressed.stiffness.exceeds(zero), mean, zero)
    }

    /// `held` of contacts that spring and dashpot, taken implicitly, pressed a step ago, `other` of
    /// all else.
    #[inline(always)]
    fn where_held(&self, zero: N, held: N, other: N) -> N {
        let [_, mean] = self.before;
        let other = N::choose(zero.exceeds(mean), held, other);
        N::choose(mean.exceeds(zero), held, other)
    }

    /// Their forces, with the tangential `springs` of a step ago.
    #[inline(always)]
    pub fn forces<const IMPLICIT: bool>(
        &self,
        processor: N::Processor,
        dt: f64,
        springs: Rows<'_>,
        ahead: f64,
    ) -> ContactForces<N> {
        let (zero, step) = (N::splat(processor, 0.0), N::splat(processor, dt));
        let pressed = self.normal_forces::<IMPLICIT>(zero);
        let (normal, arm, touching) = (self.normal, self.arm, pressed.touching);
        let tangential_stiffness = pressed.along.coefficients.tangential_stiffness;
        let stiffness = N::choose(touching, tangential_stiffness, zero);
        let memory = self.normal_memory::<IMPLICIT>(processor, &pressed);
        let bound = self.coulomb_bound::<IMPLICIT>(processor, dt, (&pressed, memory));
        let updated = update::<N>(
            processor,
            springs,
            Slip {
                way: times(pressed.slip, step),
                twist: step * dot(self.mean_spin, normal),
            },
            normal,
            touching,
            stiffness,
            bound,
        );
        let pull = times(updated.spring, -stiffness);
        let force = minus(pull, times(normal, pressed.repulsion));
        let moment = cross(arm, force);
        let [in_dashpot, stored] = self.normal_energies::<IMPLICIT>(processor, dt, &pressed);
        ContactForces {
            forces: N::rows([force[0], force[1], force[2], pressed.overlap]),
            moments: N::rows([moment[0], moment[1], moment[2], memory]),
            energies: N::rows([in_dashpot, updated.lost, stored, zero]),
            springs: updated.rows,
            implicit: if IMPLICIT {
                let [tx, ty, tz] = cross(arm, normal);
                let sticking = stiffness_across(
                    processor,
                    stiffness,
                    (bound, updated.slides),
                    (&pressed, step),
                );
                [
                    N::rows([normal[0], normal[1], normal[2], pressed.dashpot]),
                    N::rows([tx, ty, tz, pressed.stiffness]),
                    N::rows([arm[0], arm[1], arm[2], sticking]),
                ]
            } else {
                [updated.rows; 3]
            },
            closing: if IMPLICIT {
                let spring = self.closing(&pressed, zero, N::splat(processor, ahead));
                N::rows([spring, self.depth, zero, zero])
            } else {
                updated.rows
            },
        }
    }

    /// Springs of the gaps that would close within `ahead` at the present pace.
    #[inline(always)]
    fn closing(&self, pressed: &NormalForces<N>, zero: N, ahead: N) -> N {
        let then = self.depth + ahead * pressed.approach;
        let spring = N::choose(then.exceeds(zero), self.law[0] * self.parts[0], zero);
        N::choose(self.depth.exceeds(zero), zero, spring)
    }

    /// Energy that the step cost along the normal: lost in the dashpot, and put into the spring, by
    /// the mean of what each did before and does now [J].
    #[inline(always)]
    fn normal_energies<const IMPLICIT: bool>(
        &self,
        processor: N::Processor,
        dt: f64,
        pressed: &NormalForces<N>,
    ) -> [N; 2] {
        let (half, half_step) = (N::splat(processor, 0.5), N::splat(processor, 0.5 * dt));
        let ([_, part_before], [overlap_before, memory]) = (self.parts, self.before);
        let (elastic, approach) = (pressed.along.elastic, pressed.approach);
        let dashpot = pressed.repulsion - elastic;
        let elastic_before = self.law[0] * part_before * overlap_before;
        let springs = elastic_before + elastic;
        let closed = pressed.overlap - overlap_before;
        let stored = half * (springs * closed);
        if IMPLICIT {
            let zero = N::splat(processor, 0.0);
            let let_go_before = self.where_held(zero, zero, elastic_before);
            // Where a contact begins or ends within a step, the way along the normal is more than its
            // overlap tells.
            let way = N::splat(processor, dt) * approach;
            let both = N::choose(pressed.touching, closed, way);
            let way = N::choose(overlap_before.exceeds(zero), both, way);
            let taken = half * ((springs + dashpot - let_go_before) * way);
            return [taken - stored, stored];
        }
        let in_dashpot = half_step * ((memory + dashpot) * approach);
        [in_dashpot, stored]
    }
}

/// How stiff contacts are against a change of their slip within a step: a spring where they
/// stick, and where they slide no stiffer than the force they drag with over the way they slide.
#[inline(always)]
fn stiffness_across<N: Lanes>(
    processor: N::Processor,
    stiffness: N,
    (bound, slides): (N, N::Mask),
    (pressed, step): (&NormalForces<N>, N),
) -> N {
    let still = N::splat(processor, f64::MIN_POSITIVE);
    let way = step * dot(pressed.slip, pressed.slip).sqrt() + still;
    let sliding = bound / way;
    let sliding = N::choose(stiffness.exceeds(sliding), sliding, stiffness);
    N::choose(slides, sliding, stiffness)
}
