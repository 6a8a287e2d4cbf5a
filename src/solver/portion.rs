//! Which part of the rows each member of a team works on.
//!
//! In: the lists. Out: for each member a range of grains, of pairs of grains and of pairs with walls, such that members have
//! about as much to do and few pairs have grains of two members: only what crosses has to travel between cores.

use super::contacts::{GROUP, Pair};
use super::neighbours::Neighbours;
use super::team::share;
use std::ops::Range;

/// What one member works on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Portion {
    /// Places of the grains that it moves.
    pub grains: Range<usize>,
    /// Pairs of grains whose forces it computes, in whole groups.
    pub pairs: Range<usize>,
    /// Pairs with walls, likewise: about those of its grains.
    pub at_walls: Vec<Range<usize>>,
}

/// What it takes to move a grain without partners, measured in partners.
const COST_OF_GRAIN: usize = 3;

impl Portion {
    /// The portions of `size` members.
    pub fn all(neighbours: &Neighbours, size: usize) -> Vec<Self> {
        let groups = neighbours.grains.pairs.len() / GROUP;
        let cuts = cuts(neighbours, size);
        let mut portions: Vec<Self> = (0..size)
            .map(|member| {
                let groups = share(groups, member, size);
                Self {
                    grains: cuts[member]..cuts[member + 1],
                    pairs: groups.start * GROUP..groups.end * GROUP,
                    at_walls: Vec::new(),
                }
            })
            .collect();
        share_walls(&neighbours.walls.pairs, &mut portions);
        portions
    }
}

/// Places at which the members' grains begin, and the end: each member has as much to sum up and move.
fn cuts(neighbours: &Neighbours, size: usize) -> Vec<usize> {
    let count = neighbours.reference.len();
    let cost = |place: usize| neighbours.parts.before(place) + COST_OF_GRAIN * place;
    let begin = |member: usize| {
        let before = |place: &usize| cost(*place) * size < cost(count) * member;
        (0..count).take_while(before).count()
    };
    (0..=size).map(begin).collect()
}

/// Gives each group of pairs with a wall to whom its first grain belongs.
fn share_walls(pairs: &[Pair], portions: &mut [Portion]) {
    let last = portions.len() - 1;
    for (group, own) in pairs.chunks(GROUP).enumerate() {
        let place = own[0].grain as usize;
        let owner = portions.partition_point(|portion| portion.grains.end <= place);
        let at_walls = &mut portions[owner.min(last)].at_walls;
        let begin = group * GROUP;
        match at_walls.last_mut().filter(|range| range.end == begin) {
            Some(range) => range.end += own.len(),
            None => at_walls.push(begin..begin + own.len()),
        }
    }
}
