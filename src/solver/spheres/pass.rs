//! One step of one worker's share: a pass over its pairs and grains.
//!
//! In: every grain half a step ago, the worker's pairs with what they remember. Out: its grains
//! half a step on. Pairs are computed block by block of grains, each block's grains moved right
//! behind them, while what its pairs do is still in the processor's cache; a bed that fits no cache
//! is gone through once a step. Grains as they were and as they become stand in two places, so that
//! no worker reads what another writes.

use super::super::step::{Outcome, PassReport};
use super::contacts::{PairRows, PairSurroundings, at_wall, between_grains};
use super::integrate::GrainRows;
use super::plan::Plan;
use super::rings::{Rings, Target};
use super::rows::{GROUP, WallId};
use crate::lanes::{Lanes, Processor, Row, Work};
use crate::physics::law::Law;
use std::ops::Range;
use std::time::Instant;

/// A step of a share.
pub struct Pass<'a, 'w, L> {
    /// What forces depend on.
    pub surroundings: PairSurroundings<'a, L>,
    /// The order of work.
    pub plan: &'a Plan,
    /// The worker's own pairs of grains.
    pub own: PairRows<'a>,
    /// Force on the grain of each of them, written at the last step of a call [N].
    pub own_forces: &'a mut [Row],
    /// Other workers' pairs of its grains.
    pub foreign: PairRows<'a>,
    /// Ranges of pairs with one wall each.
    pub at_walls: &'a mut [AtWall<'w>],
    /// Where pairs write.
    pub rings: &'a mut Rings,
    /// The worker's grains.
    pub grains: GrainRows<'a>,
    /// Whether to read the clock.
    pub timed: bool,
}

/// Pairs with one wall, in the order of their grains' slots.
pub struct AtWall<'a> {
    /// Number of the first one.
    pub first: usize,
    /// The pairs.
    pub rows: PairRows<'a, WallId>,
    /// Force on the grain of each, written at the last step of a call [N]; empty where another
    /// worker writes them.
    pub forces: &'a mut [Row],
    /// How many of them are computed.
    pub done: usize,
}

impl<L: Law> Pass<'_, '_, L> {
    /// Takes the step.
    pub fn take(mut self, processor: Processor) -> PassReport {
        let mut report = PassReport::default();
        self.compute_foreign(processor);
        let (mut slot, mut done) = (self.plan.grains.start, 0);
        for block in &self.plan.blocks {
            let begin = self.timed.then(Instant::now);
            let pairs = done..block.pair_end;
            report.tally.ruptures += self.compute(processor, pairs, block.slot_end);
            let middle = begin.map(|_| Instant::now());
            report.outcome.add(processor.run(Finish {
                grains: &mut self.grains,
                rings: self.rings,
                slots: slot..block.slot_end,
            }));
            (slot, done) = (block.slot_end, block.pair_end);
            if let (Some(begin), Some(middle)) = (begin, middle) {
                report.times[0] += middle - begin;
                report.times[1] += middle.elapsed();
            }
        }
        report
    }

    /// Computes other workers' pairs: what breaks in them is theirs to count.
    fn compute_foreign(&mut self, processor: Processor) {
        let all = 0..self.foreign.pairs.len();
        processor.run(BetweenGrains {
            surroundings: &self.surroundings,
            rows: self.foreign.range(all),
            target: self.rings.foreign(),
        });
        self.rings.place_foreign(&self.plan.foreign);
    }

    /// Computes these of the worker's own pairs, and those with walls of grains before the slot
    /// `end`; returns how many bridges broke.
    fn compute(&mut self, processor: Processor, pairs: Range<usize>, end: usize) -> u64 {
        let first = self.plan.pairs.start;
        let ruptures = processor.run(BetweenGrains {
            surroundings: &self.surroundings,
            rows: self.own.range(pairs.clone()),
            target: self.rings.own(first + pairs.start),
        });
        let walls_from = self.at_walls.iter().map(|range| range.done);
        let walls_from: Vec<usize> = if self.grains.last {
            walls_from.collect()
        } else {
            Vec::new()
        };
        processor.run(AtWalls {
            surroundings: &self.surroundings,
            ranges: &mut *self.at_walls,
            rings: self.rings,
            end,
        });
        if self.grains.last {
            for (k, kept) in pairs.clone().zip(&mut self.own_forces[pairs]) {
                *kept = self.rings.force(first + k).force;
            }
            for (range, from) in self.at_walls.iter_mut().zip(walls_from) {
                range.keep(self.rings, from);
            }
        }
        ruptures
    }
}

impl AtWall<'_> {
    /// Keeps the forces of the pairs from number `from` of the range on that are computed.
    fn keep(&mut self, rings: &Rings, from: usize) {
        let pairs = self.rows.pairs.iter().enumerate().zip(&mut *self.forces);
        for ((k, pair), kept) in pairs.take(self.done).skip(from) {
            *kept = rings.force_at_wall(pair.partner, self.first + k).force;
        }
    }
}

/// The forces of pairs of grains.
struct BetweenGrains<'a, 's, L> {
    surroundings: &'a PairSurroundings<'s, L>,
    rows: PairRows<'a>,
    target: Target<'a>,
}

impl<L: Law> Work for BetweenGrains<'_, '_, L> {
    /// How many bridges broke.
    type Output = u64;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> u64 {
        if self.surroundings.wetting.is_some() {
            between_grains::<N, L, true>(processor, self.surroundings, self.rows, self.target)
        } else {
            between_grains::<N, L, false>(processor, self.surroundings, self.rows, self.target)
        }
    }
}

/// The forces of pairs with walls of grains before a slot.
struct AtWalls<'a, 's, 'w, L> {
    surroundings: &'a PairSurroundings<'s, L>,
    ranges: &'a mut [AtWall<'w>],
    rings: &'a mut Rings,
    end: usize,
}

impl<L: Law> Work for AtWalls<'_, '_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        for range in self.ranges {
            while let Some(pair) = range.rows.pairs.get(range.done)
                && pair.grain.index() < self.end
            {
                // Whole groups: who computes the first of one computes all of it.
                let forces = self.rings.at_wall(pair.partner, range.first + range.done);
                for lanes in (0..GROUP).step_by(N::COUNT) {
                    let rows = range.done + lanes..range.done + lanes + N::COUNT;
                    let forces = &mut forces[lanes..lanes + N::COUNT];
                    at_wall::<N, L>(processor, self.surroundings, range.rows.range(rows), forces);
                }
                range.done += GROUP;
            }
        }
    }
}

/// The end of the step for the grains in some slots.
struct Finish<'a, 'g> {
    grains: &'a mut GrainRows<'g>,
    rings: &'a Rings,
    slots: Range<usize>,
}

impl Work for Finish<'_, '_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        if self.grains.films.is_empty() {
            self.grains
                .finish::<N, false>(processor, self.rings, self.slots)
        } else {
            self.grains
                .finish::<N, true>(processor, self.rings, self.slots)
        }
    }
}
