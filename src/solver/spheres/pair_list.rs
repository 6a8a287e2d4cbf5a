//! A list of pairs with what they remember.
//!
//! In: pairs sorted by their key, wherever they come from. Out: the same list with the histories
//! and bridges of those that were listed before: histories follow their pairs from list to
//! list. Both lists are sorted by one key, so that one pass over both finds what stands in both.
//! Pairs come in whole groups ([`GROUP`]): the last ones may be padding.

use super::bridges::Bridges;
use super::rows::{GROUP, History, PairKind, Slot, SpherePair, WallId};

/// Pairs of grains with partners `P`, and what they remember, in whole groups: the last ones may be
/// padding.
#[derive(Default)]
pub struct SpherePairs<P = Slot> {
    /// The pairs, sorted by their key.
    pub pairs: Vec<SpherePair<P>>,
    /// The kind of all of them, if it is one.
    pub kind: Option<PairKind>,
    /// Tangential spring and rolling friction of each.
    pub histories: Vec<History>,
    /// Bridge of each; empty where nothing is wet.
    pub bridges: Bridges,
}

impl<P> SpherePairs<P>
where
    SpherePair<P>: PairOrder,
{
    /// Takes over `pairs`, sorted by their key; those that were listed before keep their histories,
    /// and their bridges where the list is `wet`.
    pub fn replace(&mut self, pairs: Vec<SpherePair<P>>, wet: bool) {
        let mut histories = vec![History::default(); pairs.len()];
        let mut bridges = Bridges::none(if wet { pairs.len() } else { 0 });
        for (old, new) in in_both(&self.pairs, &pairs) {
            histories[new] = self.histories[old];
            if wet {
                bridges.set(new, &self.bridges.get(old));
            }
        }
        self.histories = histories;
        self.bridges = bridges;
        let kind = pairs.first().map(|pair| pair.kind);
        self.kind = kind.filter(|kind| pairs.iter().all(|pair| pair.kind == *kind));
        self.pairs = pairs;
    }

    /// Gives the listed pairs the histories of the `known` ones, in any order; others have none.
    pub fn load_histories(&mut self, mut known: Vec<(SpherePair<P>, History)>) {
        known.sort_unstable_by_key(|(pair, _)| pair.key());
        let (pairs, histories): (Vec<_>, Vec<_>) = known.into_iter().unzip();
        self.histories.fill(History::default());
        for (old, new) in in_both(&pairs, &self.pairs) {
            self.histories[new] = histories[old];
        }
    }
}

impl SpherePairs {
    /// The keys of the pairs that have a bridge, in order.
    pub fn bridged(&self) -> impl Iterator<Item = (Slot, Slot)> {
        let pairs = self.pairs.iter().enumerate();
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
    let mut known = old.iter().enumerate().peekable();
    new.iter().enumerate().filter_map(move |(k, pair)| {
        while known.next_if(|(_, old)| old.key() < pair.key()).is_some() {}
        let (known, _) = known.next_if(|(_, old)| old.key() == pair.key())?;
        Some((known, k))
    })
}
