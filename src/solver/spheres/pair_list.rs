//! A list of pairs with what they remember.
//!
//! In: pairs sorted by their key, wherever they come from. Out: the same list with the histories
//! and bridges of those that were listed before: histories follow their pairs from list to
//! list. Both lists are sorted by one key, so that one pass over both finds what stands in both.
//! Pairs come in whole groups ([`GROUP`]): the last ones may be padding.

use super::super::tangential::UNLOADED;
use super::bridges::Bridges;
use super::rows::{ContactForce, GROUP, PairKind, Slot, SpherePair, WallId};
use crate::lanes::Row;

/// What a contact remembers from one step to the next, as it comes from a world.
#[derive(Clone, Copy)]
pub struct ContactMemory {
    /// Tangential spring [m]; its stiffness when it was last updated [N/m].
    pub spring: Row,
    /// Torque of rolling friction on the grain [N m]; 1 where the two touched.
    pub rolling: Row,
}

/// Pairs of grains with partners `P`, and what they remember, in whole groups: the last ones may be
/// padding.
#[derive(Default)]
pub struct SpherePairs<P = Slot> {
    /// The pairs, sorted by their key.
    pub pairs: Vec<SpherePair<P>>,
    /// The kind of all of them, if it is one.
    pub kind: Option<PairKind>,
    /// Tangential spring of each [m], and its stiffness when it was last updated [N/m]; all zero
    /// where the two do not touch. The torque of rolling friction is remembered by the contact
    /// force ([`ContactForce::rolling`]).
    pub springs: Vec<Row>,
    /// Bridge of each; empty where nothing is wet.
    pub bridges: Bridges,
}

impl<P> SpherePairs<P>
where
    SpherePair<P>: PairOrder,
{
    /// Takes over `pairs`, sorted by their key; those that were listed before keep their springs,
    /// and their bridges where the list is `wet`. Returns the torques of rolling friction of the
    /// new pairs, out of the `forces` of the old ones.
    pub fn replace(
        &mut self,
        pairs: Vec<SpherePair<P>>,
        forces: &[ContactForce],
        wet: bool,
    ) -> Vec<Row> {
        let mut bridges = Bridges::none(if wet { pairs.len() } else { 0 });
        if wet {
            for (old, new) in in_both(&self.pairs, &pairs) {
                bridges.set(new, &self.bridges.get(old));
            }
        }
        self.bridges = bridges;
        self.springs = carried(&self.pairs, &pairs, |old| self.springs[old]);
        let known = |old: usize| forces.get(old).map_or(UNLOADED, |force| force.rolling);
        let torques = carried(&self.pairs, &pairs, known);
        let kind = pairs.first().map(|pair| pair.kind);
        self.kind = kind.filter(|kind| pairs.iter().all(|pair| pair.kind == *kind));
        self.pairs = pairs;
        torques
    }

    /// Gives the listed pairs, and their contact `forces`, the histories of the `known` ones, in any
    /// order; others have none.
    pub fn load_histories(
        &mut self,
        mut known: Vec<(SpherePair<P>, ContactMemory)>,
        forces: &mut [ContactForce],
    ) {
        known.sort_unstable_by_key(|(pair, _)| pair.key());
        let (pairs, histories): (Vec<_>, Vec<_>) = known.into_iter().unzip();
        self.springs.fill(UNLOADED);
        for force in &mut *forces {
            force.rolling = UNLOADED;
        }
        for (old, new) in in_both(&pairs, &self.pairs) {
            self.springs[new] = histories[old].spring;
            forces[new].rolling = histories[old].rolling;
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

/// What the pairs of the old list remember, for those of the new one; nothing where a pair is new.
fn carried<P>(
    old: &[SpherePair<P>],
    new: &[SpherePair<P>],
    remembered: impl Fn(usize) -> Row,
) -> Vec<Row>
where
    SpherePair<P>: PairOrder,
{
    let mut rows = vec![UNLOADED; new.len()];
    for (from, to) in in_both(old, new) {
        rows[to] = remembered(from);
    }
    rows
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
