//! What one worker does in a step, and in which order.
//!
//! In: the lists, the number of workers. Out: for each worker its grains, its pairs, and blocks of
//! grains that are moved as soon as all of their pairs are computed; and which pairs of other
//! workers it computes too, as its grains have a part in them.
//!
//! Grains are dealt out by their number of partners, which is what summing takes, plus what moving
//! takes ([`COST_OF_GRAIN`]). A pair is that worker's whose grain has the lower slot, to the end of
//! its group. As slots are sorted in space, what two workers share is along a cut through the bed:
//! those pairs are computed by both, with histories of their own that come out the same to the bit,
//! so that nobody waits for another's forces.
//!
//! A plan holds as long as the lists do.

use super::neighbours::Neighbours;
use super::pair_list::PairOrder;
use super::places::BLOCK;
use super::rows::{GROUP, SpherePair, WallId};
use std::ops::Range;

/// What it takes to move a grain without partners, measured in partners.
const COST_OF_GRAIN: usize = 3;

/// What a worker does in a step.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// Slots of the grains that it moves.
    pub grains: Range<usize>,
    /// Numbers of the pairs of grains that are its own: whole groups.
    pub pairs: Range<usize>,
    /// Of pairs with walls, likewise: those whose groups begin with a grain of its own; a range is of
    /// one wall.
    pub at_walls: Vec<Range<usize>>,
    /// Its blocks, in order.
    pub blocks: Vec<Block>,
    /// How far behind the pairs computed so far the first one lies that a block still asks for.
    pub span: usize,
    /// Numbers of pairs of other workers in which its grains have a part.
    pub foreign: Vec<u32>,
    /// First numbers of other workers' groups of pairs with walls in which they have one.
    pub foreign_at_walls: Vec<usize>,
}

/// Grains that are moved together, behind those before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Slot behind the last of them.
    pub slot_end: usize,
    /// Pairs computed by then, among the worker's own.
    pub pair_end: usize,
}

impl Plan {
    /// Those of `size` workers.
    pub fn all(lists: &Neighbours, size: usize) -> Vec<Self> {
        let cuts = cuts(lists, size);
        let plans = cuts.windows(2).map(|cut| Self::of(lists, cut[0]..cut[1]));
        plans.collect()
    }

    /// That of whom these grains belong to.
    fn of(lists: &Neighbours, grains: Range<usize>) -> Self {
        let pairs = &lists.grains.pairs;
        let of_lower = |slot: usize| {
            let count = pairs.partition_point(|pair| pair.key().0.index() < slot);
            count.next_multiple_of(GROUP)
        };
        let mut plan = Self {
            pairs: of_lower(grains.start)..of_lower(grains.end),
            grains: grains.clone(),
            ..Self::default()
        };
        plan.share_walls(&lists.walls.pairs);
        for start in grains.clone().step_by(BLOCK) {
            let slot_end = (start + BLOCK).min(grains.end);
            let pair_end = of_lower(slot_end);
            plan.blocks.push(Block {
                slot_end,
                pair_end: pair_end - plan.pairs.start,
            });
            let mut first = pair_end;
            for slot in start..slot_end {
                let places = lists.parts.places(slot).into_iter().flatten();
                let of_grains = places.filter(|place| !place.is_at_wall());
                for number in of_grains.map(|place| place.number()) {
                    first = first.min(number);
                    if number < plan.pairs.start {
                        plan.foreign.push(number as u32);
                    }
                }
            }
            plan.span = plan.span.max(pair_end - first);
        }
        plan.foreign.sort_unstable();
        plan.foreign.dedup();
        plan
    }

    /// Which groups of pairs with walls are its own, and which have grains of its own behind
    /// others'.
    fn share_walls(&mut self, pairs: &[SpherePair<WallId>]) {
        let is_own = |pair: &SpherePair<WallId>| self.grains.contains(&pair.grain.index());
        for (number, group) in pairs.chunks(GROUP).enumerate() {
            let begin = number * GROUP;
            if is_own(&group[0]) {
                let goes_on = |own: &&mut Range<usize>| {
                    own.end == begin && pairs[own.start].partner == group[0].partner
                };
                match self.at_walls.last_mut().filter(goes_on) {
                    Some(own) => own.end += GROUP,
                    None => self.at_walls.push(begin..begin + GROUP),
                }
            } else if group.iter().any(is_own) {
                self.foreign_at_walls.push(begin);
            }
        }
    }
}

/// Slots at which the workers' grains begin, and the end: each worker has as much to compute, sum up
/// and move.
fn cuts(lists: &Neighbours, size: usize) -> Vec<usize> {
    let count = lists.reference.len();
    let cost = |slot: usize| lists.parts.before(slot) + COST_OF_GRAIN * slot;
    let begin = |worker: usize| {
        let before = |slot: &usize| cost(*slot) * size < cost(count) * worker;
        (0..count).take_while(before).count()
    };
    (0..=size).map(begin).collect()
}
