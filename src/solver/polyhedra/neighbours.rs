//! Pairs of bodies near each other, and which are whose.
//!
//! In: bodies and walls. Out: every pair whose bounding spheres are nearer than a skin, sorted by
//! the first and the second side, walls behind grains; what is known of a pair follows it from list
//! to list.
//!
//! A pair's first side is the grain of lower number. Old and new list have one order, so that one
//! pass over both carries histories over. The sums of a body run over its pairs as the second side,
//! in rising order of the first, then as the first side, which stand together: the order is that of
//! the grains' numbers, whatever else is listed.
//!
//! Not here: which features of a pair are listed ([`super::listing`]), when pairs are found anew
//! ([`super`]).

use super::super::grid::for_each_near;
use super::super::row::{row, vector};
use super::super::walls::Walls;
use super::bodies::Body;
use super::listed::Listed;
use super::pairs::{BLOCK, ContactPoint, PackedPartner, Pair, PointRange, Terms};
use crate::world::FeatureContact;
use std::ops::Range;

/// The pairs near each other, sorted by [`key`].
#[derive(Default)]
pub struct PairList {
    /// The pairs.
    pub list: Vec<Pair>,
    /// What their contacts depend on.
    pub terms: Vec<Terms>,
    /// The contact points of each block.
    pub points: Vec<Vec<ContactPoint>>,
}

/// Key by which pairs are sorted.
fn key(pair: &Pair) -> (u32, PackedPartner) {
    (pair.first, pair.second)
}

impl PairList {
    /// The pairs nearer to each other than `skin` [m]; those of `known` keep what they hold.
    pub fn find(bodies: &[Body], walls: &Walls, skin: f64, known: Self) -> Self {
        let Self {
            list,
            terms,
            points,
        } = known;
        let mut known = list.into_iter().zip(terms).enumerate().peekable();
        let mut pairs = Self::default();
        let mut push = |wanted: (u32, PackedPartner)| {
            while known.next_if(|(_, (pair, _))| key(pair) < wanted).is_some() {}
            match known.next_if(|(_, (pair, _))| key(pair) == wanted) {
                Some((k, (pair, terms))) => {
                    let points = &points[k / BLOCK][pair.points.range()];
                    pairs.push(pair, terms, points);
                }
                None => pairs.push(Pair::new(wanted), Terms::default(), &[]),
            }
        };
        let spheres = bodies.iter().map(|body| row(body.centre(), body.reach()));
        for_each_near(spheres, skin, |i, near| {
            for j in near {
                push((i, PackedPartner::grain(*j)));
            }
            let body = &bodies[i as usize];
            for (w, wall) in (0..).zip(walls.iter()) {
                if wall.surface.distance(body.centre()).0 < body.reach() + skin {
                    push((i, PackedPartner::wall(w)));
                }
            }
        });
        pairs
    }

    /// Adds a pair after all others.
    fn push(&mut self, mut pair: Pair, terms: Terms, points: &[ContactPoint]) {
        if self.list.len().is_multiple_of(BLOCK) {
            self.points.push(Vec::new());
        }
        if let Some(block) = self.points.last_mut() {
            pair.points = PointRange::at(block.len(), points);
            block.extend_from_slice(points);
        }
        self.list.push(pair);
        self.terms.push(terms);
    }

    /// The contact points of pair `k`.
    pub fn points_of(&self, k: usize) -> &[ContactPoint] {
        &self.points[k / BLOCK][self.list[k].points.range()]
    }

    /// Every feature contact with its history.
    pub fn contacts(&self) -> impl Iterator<Item = FeatureContact> + Clone {
        let pairs = self.list.iter().enumerate();
        pairs.flat_map(|(k, pair)| {
            let points = self.points_of(k).iter();
            let touching = points.filter(|point| point.overlap > 0.0);
            touching.map(move |point| FeatureContact {
                grain: pair.first,
                partner: pair.partner(),
                feature: point.listed.feature,
                overlap: point.overlap,
                normal_memory: point.normal_memory,
                spring: vector(point.spring),
                stiffness: point.stiffness(),
            })
        })
    }

    /// Gives the pairs the contacts that a world holds, sorted like them.
    pub fn adopt(&mut self, contacts: &[FeatureContact]) {
        let mut contacts = contacts.iter().peekable();
        let mut points = Vec::new();
        let Self { list, terms, .. } = std::mem::take(self);
        for (pair, terms) in list.into_iter().zip(terms) {
            let wanted = (pair.first, pair.partner());
            while contacts
                .next_if(|contact| (contact.grain, contact.partner) < wanted)
                .is_some()
            {}
            let next = || contacts.next_if(|contact| (contact.grain, contact.partner) == wanted);
            points.clear();
            points.extend(std::iter::from_fn(next).map(|contact| {
                // Its place in the order is all that is read of it before it is listed anew.
                ContactPoint::known(contact, Listed::face(contact.feature, 0))
            }));
            self.push(pair, terms, &points);
        }
    }

    /// Ranges of blocks that take about equally long, one for each of `size` workers. A block costs
    /// its pairs, each of which is looked at in every step, and its points, each of which may be
    /// measured: both weigh alike.
    pub fn shares(&self, size: usize) -> Vec<Range<usize>> {
        let blocks = &self.points;
        let cost = |block: &Vec<ContactPoint>| BLOCK + block.len();
        let all: usize = blocks.iter().map(cost).sum();
        let mut shares = Vec::with_capacity(size);
        let (mut begin, mut spent) = (0, 0);
        for worker in 0..size {
            let goal = all * (worker + 1) / size;
            let mut end = begin;
            while end < blocks.len() && (spent < goal || worker + 1 == size) {
                spent += cost(&blocks[end]);
                end += 1;
            }
            shares.push(begin..end);
            begin = end;
        }
        shares
    }
}

/// The pairs of each body, as indices of the list: compressed rows, `starts[i]..starts[i + 1]`
/// being those of body `i`. Pairs of which a body is the first stand together in the list itself;
/// pairs of which it is the second are written out.
#[derive(Default)]
pub struct PairsOfBodies {
    /// Where in `second` each body's begin.
    second_starts: Vec<u32>,
    /// Pairs of which it is the second.
    second: Vec<u32>,
    /// Where its pairs as the first begin.
    first_starts: Vec<u32>,
}

impl PairsOfBodies {
    /// Those of `pairs` of `count` bodies.
    pub fn of(pairs: &[Pair], count: usize) -> Self {
        let mut found = Self {
            second_starts: vec![0; count + 1],
            second: Vec::new(),
            first_starts: vec![0; count + 1],
        };
        for pair in pairs {
            found.first_starts[pair.first as usize + 1] += 1;
            if let Some(j) = pair.second.as_grain() {
                found.second_starts[j + 1] += 1;
            }
        }
        for i in 0..count {
            found.first_starts[i + 1] += found.first_starts[i];
            found.second_starts[i + 1] += found.second_starts[i];
        }
        let mut next = found.second_starts.clone();
        found.second = vec![0; found.second_starts[count] as usize];
        for (k, pair) in (0..).zip(pairs) {
            if let Some(j) = pair.second.as_grain() {
                found.second[next[j] as usize] = k;
                next[j] += 1;
            }
        }
        found
    }

    /// Number of bodies.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.second_starts.len() - 1
    }

    /// The pairs of body `i`: those of which it is the second, then those of which it is the first.
    #[inline(always)]
    pub fn of_body(&self, i: usize) -> (&[u32], Range<usize>) {
        let second = self.second_starts[i] as usize..self.second_starts[i + 1] as usize;
        let first = self.first_starts[i] as usize..self.first_starts[i + 1] as usize;
        (&self.second[second], first)
    }
}
