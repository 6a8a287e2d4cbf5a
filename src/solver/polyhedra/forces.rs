//! The contact forces of polyhedra, block by block.
//!
//! In: bodies and where their features are, pairs with their histories. Out: force and torques of
//! every pair, its histories one step on. Every two features that overlap press each other with a
//! spring and a dashpot and drag each other by a tangential spring (Man et al. 2023, Eqs. 3.1–3.6).
//! The contacts of a pair are summed in the order of their features: neither lists nor threads nor
//! lanes show in a sum.
//!
//! Not here: the contact law ([`super::contact_group`]), which features are measured
//! ([`super::workspace`]).

use super::super::row::{sub, vector};
use super::super::step::Tally;
use super::super::tangential::UNLOADED;
use super::contact_group::ContactGroup;
use super::couplings::Coupling;
use super::gaps::Gap;
use super::implicit_contact::ImplicitContact;
use super::motion::{Surroundings, crossed};
use super::nearest::{Nearest, group};
use super::pairs::{BLOCK, Block, ContactPoint, Pair, PairForce, Terms};
use super::workspace::{ActivePair, Effect, Workspace};
use crate::lanes::{Lanes, Quad, Work, side_by_side};
use crate::physics::FeatureRule;
use crate::world::Grains;

/// Largest overlap that is gone on with, as a share of the touching distance (the sum of the
/// sphero-radii). Two cores that come nearer than the rest of this share of the touching distance
/// could pass through each other.
pub const DEEPEST: f64 = 0.8;

/// The forces of a range of pairs: whole blocks, but for the last.
pub struct Forces<'a> {
    /// What they depend on.
    pub surroundings: Surroundings<'a>,
    /// The pairs.
    pub pairs: &'a mut [Pair],
    /// What their contacts depend on.
    pub terms: &'a mut [Terms],
    /// What the active features of each block remember.
    pub points: &'a mut [Vec<ContactPoint>],
    /// What the pairs do; of those that do nothing, whatever they did before.
    pub effects: &'a mut [PairForce],
    /// Whether they do anything.
    pub acting: &'a mut [bool],
    /// Where to write what is left for [`super::joint`]; none where springs and dashpots act here.
    pub implicit: Option<ImplicitPairs<'a>>,
    /// Room to work in.
    pub workspace: &'a mut Workspace,
}

/// Of which pairs springs and dashpots are left for [`super::joint`].
pub struct ImplicitPairs<'a> {
    /// Whether they are.
    pub resisting: &'a mut [bool],
    /// Which numbers those have.
    pub slots: &'a mut [u32],
    /// The first of these numbers.
    pub base: u32,
}

impl Work for Forces<'_> {
    type Output = Tally;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Tally {
        let Self {
            surroundings: all,
            pairs,
            terms,
            points,
            effects,
            acting,
            mut implicit,
            workspace,
        } = self;
        let mut tally = Tally::default();
        acting.fill(false);
        workspace.joint.clear();
        if let Some(implicit) = &mut implicit {
            implicit.resisting.fill(false);
        }
        let blocks = pairs.chunks_mut(BLOCK).zip(terms.chunks_mut(BLOCK));
        let effects = effects.chunks_mut(BLOCK).zip(acting.chunks_mut(BLOCK));
        for (number, (((pairs, terms), points), (forces, acting))) in
            blocks.zip(points).zip(effects).enumerate()
        {
            let mut block = Block {
                pairs,
                terms,
                points,
            };
            tally.relisted += workspace.gather::<N>(processor, &all, &mut block);
            workspace.choose::<N>(processor, &all, &mut block);
            workspace.measure::<N>(processor, &all, &block);
            tally.fault |= workspace.evaluate_overlaps(&all, &mut block);
            if let Some(implicit) = &mut implicit {
                let ahead = if all.look_ahead > 0.0 { all.dt } else { 0.0 };
                workspace.compute_forces::<N, true>(processor, [all.dt, ahead], &mut block);
                workspace.sum(&all, &block, forces, acting);
                let first = number * BLOCK;
                workspace.collect_couplings::<N::Quad>(
                    processor,
                    &block,
                    first,
                    (forces, acting),
                    implicit,
                );
            } else {
                workspace.compute_forces::<N, false>(processor, [all.dt, 0.0], &mut block);
                workspace.sum(&all, &block, forces, acting);
            }
        }
        tally
    }
}

impl Workspace {
    /// Finds the overlaps `δ`, touching distance less distance of the cores [m], how they share the
    /// stiffness, and how far nothing touches yet. True where two cores are so near each other that
    /// they might pass through. Where features share stiffness, `active.stored` becomes what the
    /// springs of the pair store more than a step ago, `½ K_n (Σδ²)²/(Σδ)²` now less then [J].
    #[inline(always)]
    pub fn evaluate_overlaps(&mut self, all: &Surroundings<'_>, block: &mut Block<'_>) -> bool {
        let mut fault = false;
        for number in 0..self.active.len() {
            let range = self.results_of(number);
            let (active, results) = (&mut self.active[number], &mut self.results[range]);
            let own = active.pair as usize;
            let (pair, terms) = (&mut block.pairs[own], &block.terms[own]);
            let (mut deepest, mut hidden) = (f64::NEG_INFINITY, false);
            let mut nearest = f64::INFINITY;
            for result in results.iter_mut() {
                let overlap = terms.touch - result.distance();
                let least = result.least_distance();
                nearest = if least < nearest { least } else { nearest };
                result.set_overlap(overlap);
                deepest = if overlap > deepest { overlap } else { deepest };
                hidden |= overlap == f64::NEG_INFINITY;
            }
            active.touches = deepest > 0.0;
            // A vertex behind a face may come round its edge at any time.
            pair.clearance = if active.touches || hidden {
                0.0
            } else {
                nearest - terms.touch - f64::from(terms.margin)
            };
            fault |= deepest > DEEPEST * terms.touch && !all.has_sides(pair);
            if all.rule == FeatureRule::Shared {
                let points = &block.points[pair.points.range()];
                let before = Sums::of(points.iter().map(|point| point.overlap));
                let now = Sums::of(results.iter().map(Nearest::overlap));
                active.set_parts(before.part(), now.part());
                active.stored = 0.5 * terms.law[0] * (now.shared() - before.shared());
            }
        }
        fault
    }

    /// The contact law of every active feature of the block, [`Lanes::COUNT`] at a time, whichever
    /// pairs they are of; springs, overlaps and what is remembered beside them go back into the
    /// points. A last group that is not full computes its last feature again.
    #[inline(always)]
    fn compute_forces<N: Lanes, const IMPLICIT: bool>(
        &mut self,
        processor: N::Processor,
        [dt, ahead]: [f64; 2],
        block: &mut Block<'_>,
    ) {
        let (terms, points) = (&*block.terms, &mut *block.points);
        self.effects.resize(self.results.len(), Effect::default());
        if IMPLICIT {
            let count = self.results.len();
            self.implicit.resize(count, ImplicitContact::default());
        }
        let outputs = self.effects.chunks_mut(N::COUNT).enumerate();
        let results = self.results.chunks(N::COUNT);
        let numbers = self.result_of.chunks(N::COUNT);
        for ((numbers, results), (group_number, effects)) in numbers.zip(results).zip(outputs) {
            let all = group::<N, _>(numbers);
            let pair = side_by_side::<N, _>(|k| &self.active[all[k].pair as usize]);
            let law = side_by_side::<N, _>(|k| &terms[pair[k].pair as usize].law);
            let point = side_by_side::<N, _>(|k| &points[all[k].point as usize]);
            let contacts =
                ContactGroup::<N>::gather(processor, pair, law, group::<N, _>(results), point);
            let springs = side_by_side::<N, _>(|k| &point[k].spring);
            let found = contacts.forces::<IMPLICIT>(processor, dt, springs, ahead);
            if IMPLICIT {
                let begin = group_number * N::COUNT;
                let implicit = &mut self.implicit[begin..begin + effects.len()];
                for (k, contact) in implicit.iter_mut().enumerate() {
                    contact.normal = found.implicit[0][k].row();
                    contact.moment = found.implicit[1][k].row();
                    contact.arm = found.implicit[2][k].row();
                    contact.closing = found.closing[k].row();
                }
            }
            for (k, (effect, number)) in effects.iter_mut().zip(numbers).enumerate() {
                effect.force = found.forces[k].row();
                effect.moment = found.moments[k].row();
                effect.energy = found.energies[k].row();
                let point = &mut points[number.point as usize];
                point.overlap = effect.overlap();
                // A spring that is let go leaves zeros without a sign, which would tell where it
                // has been.
                let touches = point.overlap > 0.0;
                point.spring = if touches {
                    found.springs[k].row()
                } else {
                    UNLOADED
                };
                point.normal_memory = effect.normal_memory();
            }
        }
    }

    /// Sums what the contacts of each collected pair do, in the order of their features. A pair
    /// whose last contact has just ended still books what its springs lost.
    #[inline(always)]
    fn sum(
        &self,
        all: &Surroundings<'_>,
        block: &Block<'_>,
        forces: &mut [PairForce],
        acting: &mut [bool],
    ) {
        for (number, active) in self.active.iter().enumerate() {
            let pair = active.pair as usize;
            let effects = &self.effects[self.results_of(number)];
            let force = all.force_of(&block.pairs[pair], active, effects);
            let exchanges = force.exchanged != [0.0; 4];
            if active.touches || exchanges {
                forces[pair] = force;
                acting[pair] = true;
            }
        }
    }
}

impl Workspace {
    /// Collects springs and dashpots of each pair, `first` being the number of the block's first
    /// pair; the worker's first of them has the number `base`.
    #[inline(always)]
    fn collect_couplings<Q: Quad>(
        &mut self,
        processor: Q::Processor,
        block: &Block<'_>,
        first: usize,
        (forces, acting): (&mut [PairForce], &mut [bool]),
        implicit: &mut ImplicitPairs<'_>,
    ) {
        for (number, active) in self.active.iter().enumerate() {
            let contacts = &self.implicit[self.results_of(number)];
            let first_gap = self.joint.gaps.len();
            self.joint.gaps.extend(contacts.iter().filter_map(Gap::of));
            let gaps = first_gap..self.joint.gaps.len();
            if !active.touches && gaps.is_empty() {
                continue;
            }
            let own = active.pair as usize;
            let [stiffness, damping, ..] = block.terms[own].law;
            let (pair, number) = (&block.pairs[own], (first + own) as u32);
            let ratio = damping / stiffness;
            let coupling = Coupling::of::<Q>(processor, (number, pair), ratio, contacts);
            if let Some(mut coupling) = coupling {
                coupling.set_gaps(gaps);
                if !acting[own] {
                    // Nothing touches yet.
                    forces[own] = PairForce::default();
                    acting[own] = true;
                }
                forces[own].set_stiffness(coupling.stiffness());
                implicit.resisting[first + own] = true;
                implicit.slots[first + own] = implicit.base + self.joint.couplings.len() as u32;
                self.joint.sides.push(coupling.sides());
                self.joint.couplings.push(coupling);
            }
        }
    }
}

/// Sums over the overlaps of a pair's contacts.
#[derive(Default)]
struct Sums {
    /// Of the overlaps, `Σδ` [m].
    overlaps: f64,
    /// Of their squares, `Σδ²` [m²].
    squares: f64,
}

impl Sums {
    /// Those of `overlaps`, of which negative ones do not count.
    fn of(overlaps: impl Iterator<Item = f64>) -> Self {
        let touching = overlaps.filter(|overlap| *overlap > 0.0);
        touching.fold(Self::default(), |sums, overlap| Self {
            overlaps: sums.overlaps + overlap,
            squares: sums.squares + overlap * overlap,
        })
    }

    /// The part of the pair's stiffness that each contact has where they share it, `Σδ²/(Σδ)²`: so
    /// `n` contacts of one overlap are as stiff together as one.
    fn part(&self) -> f64 {
        FeatureRule::Shared.part(self.overlaps, self.squares)
    }

    /// The sum of the squares, each with its part of the stiffness.
    fn shared(&self) -> f64 {
        self.part() * self.squares
    }
}

impl Surroundings<'_> {
    /// The contact force of `pair`, from the `effects` of its active features: nothing where they
    /// do not touch. With the force `F` on the first and its torque `T₁` about the first's centroid
    /// `x₁`, the torque on the second about its own is `T₂ = −T₁ − (x₁ − x₂) × F`, so that angular
    /// momentum is kept wherever the force acts; a wall does the work `Δt (F·v − T₂·ω)`.
    #[inline(always)]
    fn force_of(&self, pair: &Pair, active: &ActivePair, effects: &[Effect]) -> PairForce {
        let mut force = PairForce::default();
        let mut pressed = 0.0;
        for effect in effects {
            for axis in 0..3 {
                force.force[axis] += effect.force[axis];
                force.first[axis] += effect.moment[axis];
            }
            let [in_dashpot, in_sliding, stored, _] = effect.energy;
            force.exchanged[Grains::IN_DASHPOTS] += in_dashpot;
            force.exchanged[Grains::IN_SLIDING] += in_sliding;
            pressed += stored;
        }
        if self.rule == FeatureRule::Shared {
            // Stiffness that is shared anew is no potential's: what it takes or gives is booked
            // with the springs.
            force.exchanged[Grains::IN_SLIDING] += pressed - active.stored;
        }
        let [second, ..] = self.motion(pair.second);
        let across = crossed(sub(active.centre, *second), force.force);
        for axis in 0..3 {
            force.second[axis] = -force.first[axis] - across[axis];
        }
        if let Some(wall) = self.wall(pair) {
            let by_force = vector(force.force).dot(wall.motion.velocity);
            let by_torque = -vector(force.second).dot(wall.motion.spin);
            force.exchanged[Grains::BY_WALLS] = self.dt * (by_force + by_torque);
        }
        force.set_touches(active.touches);
        force
    }
}
