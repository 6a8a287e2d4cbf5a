//! What one worker works on during a batch of steps: its ranges of grains, pairs and pairs with
//! walls.
//!
//! In: the working copy and its lists. Out: shares such that workers have about as much to do and
//! few pairs have grains of two workers, as only what crosses has to travel between cores; and the
//! two phases of a step on a share.
//!
//! Pairs are dealt out in equal numbers, whole groups each, as a pair takes as long whether it
//! touches or not. Grains are dealt out by their number of partners, which is what summing takes,
//! plus what moving takes ([`COST_OF_GRAIN`]). As slots are sorted in space and pairs by their
//! slots, a worker's pairs are about those of its grains: what the other workers wrote is read
//! along the cuts alone. A pair with a wall goes to whom its grain belongs.
//!
//! Rows that cross from one phase to the other are whole cache lines ([`super::rows`]), so that two
//! workers never write the same one but where their ranges meet.

use super::super::ranges::{range_of, split, split_once};
use super::super::row::Row;
use super::super::step::{Outcome, Share, Tally};
use super::super::walls::Walls;
use super::super::workers::{Batch, Column, ForcePhase, InPhase, MotionPhase};
use super::SphereKernel;
use super::bridges::{BridgeColumns, BridgeEffect, Wetting};
use super::contacts::{PairLoop, PairRows, PairSurroundings};
use super::integrate::{BridgeLoad, FinishStep, PairEffects, SphereLoad, StepConstants};
use super::neighbours::Neighbours;
use super::parts::Parts;
use super::rows::{ContactForce, GROUP, PairKind, Sphere, SpherePair, WallId};
use crate::lanes::Processor;
use crate::physics::law::{FilmConstants, Law, LawSource, LawUser, PairConstants};
use crate::physics::{ContactLaw, Liquid};
use std::ops::Range;

/// A worker's share of a world of spheres.
pub struct SphereShare<'a, S> {
    ranges: WorkerRanges,
    common: SphereInputs<'a, S>,
    /// Read by all in the force phase, as are films.
    bodies: Column<'a, Sphere, MotionPhase>,
    films: Column<'a, f64, MotionPhase>,
    /// Read by all in the motion phase, as are the bridges' effects.
    forces: Column<'a, ContactForce, ForcePhase>,
    bridge_effects: Column<'a, BridgeEffect, ForcePhase>,
    /// What only this worker touches: loads and bridge loads of its grains, springs and bridges of
    /// its pairs.
    loads: &'a mut [SphereLoad],
    bridge_loads: &'a mut [BridgeLoad],
    grain_springs: &'a mut [Row],
    wall_springs: Vec<&'a mut [Row]>,
    bridges: &'a mut [BridgeColumns],
}

/// What all workers read and none writes.
#[derive(Clone, Copy)]
struct SphereInputs<'a, S> {
    /// Where the contact law comes from: chosen once per step and worker, outside of the pair loop.
    source: S,
    /// The law that the world states.
    law: ContactLaw,
    /// Step, gravity, slack of the inner list.
    motion: &'a StepConstants,
    /// The liquid, where there is any.
    liquid: Option<&'a Liquid>,
    /// Constants of every kind of pair.
    constants: &'a [PairConstants],
    /// What bridges depend on, kind by kind; empty where nothing is wet.
    film_constants: &'a [FilmConstants],
    /// The inner list of pairs of grains.
    grain_pairs: &'a [SpherePair],
    /// The kind of all of them, if it is one.
    grain_kind: Option<PairKind>,
    /// The inner list of pairs of a grain and a wall.
    wall_pairs: &'a [SpherePair<WallId>],
    /// The grains' parts in the pairs.
    parts: &'a Parts,
    /// Where every grain was when the inner list was filtered [m].
    reference: &'a [Row],
}

impl<'a, S: LawSource> SphereShare<'a, S> {
    /// The shares of a batch's workers. What one phase writes and the other reads is lent as
    /// columns, what stays with a worker is cut into slices.
    pub fn all(spheres: &'a mut SphereKernel<S>, batch: &'a Batch) -> Vec<Self> {
        let ranges = WorkerRanges::all(&spheres.neighbours, batch.size());
        let Neighbours {
            grains,
            walls,
            forces,
            bridge_effects,
            parts,
            reference,
            ..
        } = &mut spheres.neighbours;
        let common = SphereInputs {
            source: spheres.source,
            law: spheres.law,
            motion: &spheres.motion,
            liquid: spheres.liquid.as_ref(),
            constants: &spheres.kinds.constants,
            film_constants: &spheres.kinds.films,
            grain_pairs: &grains.pairs,
            grain_kind: grains.kind,
            wall_pairs: &walls.pairs,
            parts,
            reference,
        };
        let wet = spheres.liquid.is_some();
        let own_grains = || ranges.iter().map(|own| own.grains.clone());
        let own_films = || ranges.iter().map(|own| own.films(wet));
        let own_pairs = || ranges.iter().map(|own| own.pairs.clone());
        let own_bridges = || ranges.iter().map(|own| own.bridges(wet));
        let own_groups = || own_bridges().map(|own| own.start / GROUP..own.end / GROUP);
        let own_walls = ranges.iter().map(|own| own.at_walls.clone());
        let own_forces = ranges.iter().map(|own| own.forces(grains.pairs.len()));

        let mut bodies = batch.lend_ranges(&mut spheres.bodies, own_grains());
        let mut films = batch.lend_ranges(&mut spheres.films, own_films());
        let mut forces = batch.lend(forces, own_forces).into_iter();
        let mut bridge_effects = batch.lend_ranges(bridge_effects, own_bridges());
        let mut loads = split_once(&mut spheres.loads, own_grains());
        let mut bridge_loads = split_once(&mut spheres.bridge_loads, own_films());
        let mut grain_springs = split_once(&mut grains.springs, own_pairs());
        let mut wall_springs = split(&mut walls.springs, own_walls).into_iter();
        let mut bridges = split_once(&mut grains.bridges.groups, own_groups());
        let share = |own: &WorkerRanges| {
            Some(Self {
                ranges: own.clone(),
                common,
                bodies: bodies.next()?,
                films: films.next()?,
                forces: forces.next()?,
                bridge_effects: bridge_effects.next()?,
                loads: loads.next()?,
                bridge_loads: bridge_loads.next()?,
                grain_springs: grain_springs.next()?,
                wall_springs: wall_springs.next()?,
                bridges: bridges.next()?,
            })
        };
        ranges.iter().filter_map(share).collect()
    }

    /// Computes the forces of the worker's pairs by `law`; returns how many bridges broke.
    fn compute<L: Law>(
        &mut self,
        processor: Processor,
        law: L,
        walls: &Walls,
        phase: &InPhase<'_, ForcePhase>,
    ) -> u64 {
        let common = &self.common;
        let mut forces = self.forces.write(phase);
        let of_grains = PairRows {
            pairs: &common.grain_pairs[self.ranges.pairs.clone()],
            kind: common.grain_kind,
            springs: &mut *self.grain_springs,
            forces: forces.next().unwrap_or_default(),
            bridges: &mut *self.bridges,
            bridge_effects: self.bridge_effects.write_first(phase),
        };
        let rows = self.ranges.at_walls.iter().zip(&mut self.wall_springs);
        let of_walls = rows.zip(forces).map(|((own, springs), forces)| PairRows {
            pairs: &common.wall_pairs[own.clone()],
            kind: None,
            springs,
            forces,
            // Walls hold no bridges.
            bridges: &mut [],
            bridge_effects: &mut [],
        });
        let films = self.films.read(phase);
        processor.run(PairLoop {
            surroundings: PairSurroundings {
                law,
                dt: common.motion.dt,
                bodies: self.bodies.read(phase),
                walls,
                constants: common.constants,
                wetting: common.liquid.map(|liquid| Wetting {
                    liquid,
                    films,
                    constants: common.film_constants,
                }),
            },
            of_grains,
            of_walls,
        })
    }

    /// Sums the forces on the worker's grains and moves them.
    fn finish<const WET: bool>(
        &mut self,
        processor: Processor,
        last: bool,
        phase: &InPhase<'_, MotionPhase>,
    ) -> Outcome {
        let own = self.ranges.grains.clone();
        processor.run(FinishStep::<WET> {
            motion: self.common.motion,
            pairs: PairEffects {
                forces: self.forces.read(phase),
                bridge_effects: self.bridge_effects.read(phase),
                parts: self.common.parts,
            },
            begin: own.start,
            bodies: self.bodies.write_first(phase),
            loads: &mut *self.loads,
            films: self.films.write_first(phase),
            bridge_loads: &mut *self.bridge_loads,
            references: &self.common.reference[own],
            last,
        })
    }
}

/// The forces of a share, by a law that is chosen once for all pairs.
struct ComputeForces<'s, 'a, 'p, S> {
    share: &'s mut SphereShare<'a, S>,
    processor: Processor,
    walls: &'s Walls,
    phase: &'s InPhase<'p, ForcePhase>,
}

impl<S: LawSource> LawUser for ComputeForces<'_, '_, '_, S> {
    type Output = Tally;

    fn with<L: Law>(self, law: L) -> Tally {
        Tally {
            ruptures: self
                .share
                .compute(self.processor, law, self.walls, self.phase),
            ..Tally::default()
        }
    }
}

impl<S: LawSource> Share for SphereShare<'_, S> {
    fn compute_forces(
        &mut self,
        processor: Processor,
        walls: &Walls,
        phase: &InPhase<'_, ForcePhase>,
    ) -> Tally {
        let (source, stated) = (self.common.source, self.common.law);
        let forces = ComputeForces {
            share: self,
            processor,
            walls,
            phase,
        };
        source.choose(stated, forces)
    }

    fn move_grains(
        &mut self,
        processor: Processor,
        last: bool,
        phase: &InPhase<'_, MotionPhase>,
    ) -> Outcome {
        if self.common.liquid.is_some() {
            self.finish::<true>(processor, last, phase)
        } else {
            self.finish::<false>(processor, last, phase)
        }
    }
}

/// Which rows one worker works on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct WorkerRanges {
    /// Slots of the grains that it moves.
    grains: Range<usize>,
    /// Pairs of grains whose forces it computes, in whole groups.
    pairs: Range<usize>,
    /// Pairs with walls, likewise: about those of its grains.
    at_walls: Vec<Range<usize>>,
}

/// What it takes to move a grain without partners, measured in partners.
const COST_OF_GRAIN: usize = 3;

impl WorkerRanges {
    /// The ranges of `size` workers: pairs of grains in equal numbers, as each takes about as long,
    /// and grains such that each worker has as many partners to sum up.
    fn all(neighbours: &Neighbours, size: usize) -> Vec<Self> {
        let groups = neighbours.grains.pairs.len() / GROUP;
        let cuts = cuts(neighbours, size);
        let mut ranges: Vec<Self> = (0..size)
            .map(|worker| {
                let groups = range_of(groups, worker, size);
                Self {
                    grains: cuts[worker]..cuts[worker + 1],
                    pairs: groups.start * GROUP..groups.end * GROUP,
                    at_walls: Vec::new(),
                }
            })
            .collect();
        share_walls(&neighbours.walls.pairs, &mut ranges);
        ranges
    }

    /// Where its films are: those of its grains, in a `wet` world.
    fn films(&self, wet: bool) -> Range<usize> {
        if wet { self.grains.clone() } else { 0..0 }
    }

    /// Where its bridges are: those of its pairs of grains, in a `wet` world.
    fn bridges(&self, wet: bool) -> Range<usize> {
        if wet { self.pairs.clone() } else { 0..0 }
    }

    /// Where the forces of its pairs are: those with walls stand behind those of `grain_pairs`
    /// pairs of grains.
    fn forces(&self, grain_pairs: usize) -> Vec<Range<usize>> {
        let behind = |own: &Range<usize>| own.start + grain_pairs..own.end + grain_pairs;
        let of_walls = self.at_walls.iter().map(behind);
        std::iter::once(self.pairs.clone())
            .chain(of_walls)
            .collect()
    }
}

/// Slots at which the workers' grains begin, and the end: each worker has as much to sum up and
/// move.
fn cuts(neighbours: &Neighbours, size: usize) -> Vec<usize> {
    let count = neighbours.reference.len();
    let cost = |slot: usize| neighbours.parts.before(slot) + COST_OF_GRAIN * slot;
    let begin = |worker: usize| {
        let before = |slot: &usize| cost(*slot) * size < cost(count) * worker;
        (0..count).take_while(before).count()
    };
    (0..=size).map(begin).collect()
}

/// Gives each group of pairs with a wall to whom its first grain belongs.
fn share_walls(pairs: &[SpherePair<WallId>], ranges: &mut [WorkerRanges]) {
    let last = ranges.len() - 1;
    for (group, own) in pairs.chunks(GROUP).enumerate() {
        let slot = own[0].grain.index();
        let owner = ranges.partition_point(|range| range.grains.end <= slot);
        let at_walls = &mut ranges[owner.min(last)].at_walls;
        let begin = group * GROUP;
        match at_walls.last_mut().filter(|range| range.end == begin) {
            Some(range) => range.end += own.len(),
            None => at_walls.push(begin..begin + own.len()),
        }
    }
}
