//! A list of pairs with what they remember.
//!
//! In: pairs sorted by their key, wherever they come from. Out: the same list with the histories
//! and bridges of those that were listed before: histories follow their pairs from list to
//! list. Both lists are sorted by one key, so that one pass over both finds what stands in both.
//! Pairs come in whole groups ([`GROUP`]): the last ones may be padding.

use super::super::ranges::split_once;
use super::super::tangential::UNLOADED;
use super::super::workers::WorkerPool;
use super::bridges::Bridges;
use super::rows::{GROUP, PairKind, Slot, SpherePair, WallId};
use crate::lanes::Row;
use std::ops::Range;

/// Pairs of grains with partners `P`, and what they remember, in whole groups: the last ones may be
/// padding.
#[derive(Default)]
pub struct SpherePairs<P = Slot> {
    /// The pairs, sorted by their key.
    pub pairs: Vec<SpherePair<P>>,
    /// The kind of all of them, if it is one.
    pub kind: Option<PairKind>,
    /// Tangential spring of each [m], and its stiffness when it was last updated [N/m]; all zero
    /// where the two do not touch.
    pub springs: Vec<Row>,
    /// Torque of rolling friction on the grain of each [N m]; 1 where the two touch, else 0.
    pub rolling: Vec<Row>,
    /// Force on the grain of each at the last step of a call [N].
    pub forces: Vec<Row>,
    /// Bridge of each; empty where nothing is wet.
    pub bridges: Bridges,
}

impl<P: Sync> SpherePairs<P>
where
    SpherePair<P>: PairOrder,
{
    /// Takes over `pairs`, sorted by their key; those that were listed before keep their springs,
    /// their rolling friction, and their bridges where the list is `wet`.
    pub fn replace(&mut self, pool: &mut WorkerPool, pairs: Vec<SpherePair<P>>, wet: bool) {
        let ranges = pool.ranges(pairs.len(), GROUP);
        let mut springs = vec![UNLOADED; pairs.len()];
        let mut rolling = vec![UNLOADED; pairs.len()];
        let mut bridges = Bridges::none(if wet { pairs.len() } else { 0 });
        let groups = |range: &Range<usize>| {
            let group = |end: usize| if wet { end.div_ceil(GROUP) } else { 0 };
            group(range.start)..group(range.end)
        };
        let rows = split_once(&mut springs, ranges.iter().cloned())
            .zip(split_once(&mut rolling, ranges.iter().cloned()));
        let columns = split_once(&mut bridges.groups, ranges.iter().map(groups));
        let shares = ranges.iter().cloned().zip(rows).zip(columns).collect();
        let (old, new) = (&*self, &pairs);
        pool.map(shares, |((range, (springs, rolling)), bridges)| {
            for (from, to) in in_both(&old.pairs, &new[range]) {
                springs[to] = old.springs[from];
                rolling[to] = old.rolling[from];
                if wet {
                    bridges[to / GROUP].set(to % GROUP, &old.bridges.get(from));
                }
            }
        });
        let kind = pairs.first().map(|pair| pair.kind);
        self.kind = kind.filter(|kind| pairs.iter().all(|pair| pair.kind == *kind));
        self.forces.resize(pairs.len(), UNLOADED);
        (self.springs, self.rolling) = (springs, rolling);
        (self.pairs, self.bridges) = (pairs, bridges);
    }
}

impl<P: Sync> SpherePairs<P> {
    /// Gives every pair the spring and the torque of rolling friction that `history` knows of it;
    /// where it knows none, the two do not touch.
    pub fn remember(
        &mut self,
        pool: &mut WorkerPool,
        history: impl Fn(&SpherePair<P>) -> Option<[Row; 2]> + Sync,
    ) {
        let ranges = pool.ranges(self.pairs.len(), 1);
        let rows = split_once(&mut self.springs, ranges.iter().cloned())
            .zip(split_once(&mut self.rolling, ranges.iter().cloned()));
        let shares = ranges.iter().cloned().zip(rows).collect();
        let pairs = &self.pairs;
        pool.map(
            shares,
            |(range, (springs, rolling)): (Range<usize>, (&mut [Row], &mut [Row]))| {
                let rows = springs.iter_mut().zip(rolling);
                for (pair, (spring, rolling)) in pairs[range].iter().zip(rows) {
                    [*spring, *rolling] = history(pair).unwrap_or([UNLOADED; 2]);
                }
            },
        );
    }
}

impl<P> SpherePairs<P> {
    /// Spring, torque of rolling friction and force of the pair of this number.
    pub fn history(&self, k: usize) -> [Row; 3] {
        [self.springs[k], self.rolling[k], self.forces[k]]
    }
}

impl SpherePairs {
    /// The keys of the pairs that have a bridge, in order, from the key `first` on.
    pub fn bridged(&self, first: (Slot, Slot)) -> impl Iterator<Item = (Slot, Slot)> {
        let begin = self.pairs.partition_point(|pair| pair.key() < first);
        let pairs = self.pairs.iter().enumerate().skip(begin);
        pairs
            .filter(|(k, _)| self.bridges.get(*k).exists())
            .map(|(_, pair)| pair.key())
    }
}

/// What a list of such pairs is sorted by.
pub trait PairOrder {
    /// The key.
    type Key: Ord;

    /// That of this pair; no two pairs of a list share one, but padding.
    fn key(&self) -> Self::Key;
}

/// Pairs of grains in the order of their lower slots, so that pairs stand as their grains do.
impl PairOrder for SpherePair {
    type Key = (Slot, Slot);

    fn key(&self) -> (Slot, Slot) {
        let (grain, partner) = (self.grain, self.partner);
        (grain.min(partner), grain.max(partner))
    }
}

/// Pairs with walls wall by wall.
impl PairOrder for SpherePair<WallId> {
    type Key = (WallId, Slot);

    fn key(&self) -> (WallId, Slot) {
        (self.partner, self.grain)
    }
}

/// Adds padding until the last group is whole.
pub fn fill_group<P: Copy>(pairs: &mut Vec<SpherePair<P>>, padding: SpherePair<P>) {
    pairs.resize(pairs.len().next_multiple_of(GROUP), padding);
}

/// Where the pairs that stand in both lists, each sorted by its key, stand in the old and in the
/// new one.
fn in_both<P>(old: &[SpherePair<P>], new: &[SpherePair<P>]) -> impl Iterator<Item = (usize, usize)>
where
    SpherePair<P>: PairOrder,
{
    let first = new.first().map(PairOrder::key);
    let begin = first.map_or(0, |first| old.partition_point(|pair| pair.key() < first));
    let mut known = old.iter().enumerate().skip(begin).peekable();
    new.iter().enumerate().filter_map(move |(k, pair)| {
        while known.next_if(|(_, old)| old.key() < pair.key()).is_some() {}
        let (known, _) = known.next_if(|(_, old)| old.key() == pair.key())?;
        Some((known, k))
    })
}
