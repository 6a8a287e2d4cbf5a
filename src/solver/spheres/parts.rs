//! Which pairs are whose: each grain's parts in the listed pairs.
//!
//! In: the inner list, and the index of the grain in each slot. Out: for each slot its grain's
//! pairs, those of which it is the second partner first, then those of which it is the first, each
//! in the order of the partners' indices, walls last. That order is a function of the state alone,
//! as neither slots nor the place of a pair in its list enter it: so a sum over a grain's parts has
//! the same bits whatever the lists and the spatial sort are.

use super::super::ranges::split_once;
use super::super::workers::WorkerPool;
use super::places::Place;
use super::rows::{Slot, SpherePair, WallId};
use super::slots::Slots;
use std::ops::Range;

/// A grain's part in a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part(u32);

impl Part {
    /// A part in the pair of number `pair`.
    fn new(pair: usize, second: bool) -> Self {
        Self((pair as u32) << 1 | u32::from(second))
    }

    /// Index of the pair: pairs of grains come first, then pairs with walls.
    #[inline(always)]
    pub fn pair(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// 1 where the grain is the second partner, else 0.
    #[inline(always)]
    pub fn side(self) -> usize {
        (self.0 & 1) as usize
    }
}

/// The parts that each grain has in listed pairs: as the second partner, then as the first, each in
/// the order of the partners' indices, then at walls.
#[derive(Default)]
pub struct Parts {
    /// Where each grain's parts begin, those as the second partner.
    first: Vec<u32>,
    /// Where each grain's parts as the first partner begin.
    own: Vec<u32>,
    /// The parts, grain by grain.
    list: Vec<Part>,
    /// Where to find what their pairs do.
    places: Vec<Place>,
}

impl Parts {
    /// How many parts the grains before the `i`-th slot have.
    pub fn before(&self, i: usize) -> usize {
        self.first[i] as usize
    }

    /// Where to find what the pairs of the grain in the `i`-th slot do: those of which it is the
    /// second partner, two grains each, then those of which it is the first.
    #[inline(always)]
    pub fn places(&self, i: usize) -> [&[Place]; 2] {
        let (first, own, end) = (self.first[i], self.own[i], self.first[i + 1]);
        [
            &self.places[first as usize..own as usize],
            &self.places[own as usize..end as usize],
        ]
    }

    /// Those as the first partner, of grains and at walls.
    pub fn as_first(&self, i: usize) -> &[Part] {
        &self.list[self.own[i] as usize..self.first[i + 1] as usize]
    }

    /// Sorts both sides of the pairs; slots behind those of the grains are padding's.
    pub fn fill(
        &mut self,
        pool: &mut WorkerPool,
        grains: &[SpherePair],
        walls: &[SpherePair<WallId>],
        slots: &Slots,
    ) {
        let count = slots.grains().len();
        let is_grain = |(slot, _): &(Slot, Part)| slot.index() < count;
        let seconds = || {
            let sides = grains.iter().enumerate();
            sides
                .map(|(k, pair)| (pair.partner, Part::new(k, true)))
                .filter(is_grain)
        };
        let firsts = || {
            let of_grains = grains.iter().map(|pair| pair.grain);
            let slots = of_grains.chain(walls.iter().map(|pair| pair.grain));
            (slots.enumerate())
                .map(|(k, slot)| (slot, Part::new(k, false)))
                .filter(is_grain)
        };
        self.first.clear();
        self.first.resize(count + 1, 0);
        self.own.clear();
        self.own.resize(count, 0);
        seconds().for_each(|(slot, _)| self.own[slot.index()] += 1);
        firsts().for_each(|(slot, _)| self.first[slot.index() + 1] += 1);
        for i in 0..count {
            self.first[i + 1] += self.first[i] + self.own[i];
            self.own[i] += self.first[i];
        }
        self.list
            .resize(self.first[count] as usize, Part::default());
        for (begins, sides) in [
            (
                &self.first[..count],
                &mut seconds() as &mut dyn Iterator<Item = _>,
            ),
            (&self.own, &mut firsts()),
        ] {
            let mut next = begins.to_vec();
            for (slot, part) in sides {
                let place = &mut next[slot.index()];
                self.list[*place as usize] = part;
                *place += 1;
            }
        }
        let other = |part: &Part| match grains.get(part.pair()) {
            Some(pair) if part.side() == 1 => slots.grain_in(pair.grain),
            Some(pair) => slots.grain_in(pair.partner),
            // Walls come last, in the order of the pairs, which is theirs.
            None => u32::MAX,
        };
        let ranges = pool.ranges(count, 1);
        let (first, own) = (&self.first, &self.own);
        let places = |range: &Range<usize>| first[range.start] as usize..first[range.end] as usize;
        let lists = split_once(&mut self.list, ranges.iter().map(places));
        let shares = ranges.iter().cloned().zip(lists).collect();
        pool.map(shares, |(range, list): (Range<usize>, &mut [Part])| {
            let begin = first[range.start];
            let place = |at: u32| (at - begin) as usize;
            for i in range {
                let (start, middle, end) = (place(first[i]), place(own[i]), place(first[i + 1]));
                list[start..middle].sort_by_key(other);
                list[middle..end].sort_by_key(other);
            }
        });
        self.places.clear();
        let place = |part: &Part| match part.pair().checked_sub(grains.len()) {
            None => Place::of(part.pair()),
            Some(k) => Place::at_wall(walls[k].partner, k),
        };
        self.places.extend(self.list.iter().map(place));
    }
}
