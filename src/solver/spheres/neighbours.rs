//! Who may touch whom.
//!
//! Two Verlet lists, both pure caches that never change a result. The *outer* list, from a cell
//! grid, holds pairs closer than a wide skin; the *inner* list, filtered from it, holds pairs
//! closer than a narrow skin and is what the pair loop runs over. Each list is good until some
//! grain has moved by half its skin.
//!
//! Grains are named by their slots ([`super::slots`]) and pairs kept sorted by the lower and the
//! higher of these, but the first grain of a pair is the one of lower index, and forces are summed
//! in the order of indices: so the sums do not depend on the slots. A listed pair that does not
//! touch adds exact zeros, so they do not depend on the skins. A pair with a bridge is on the inner
//! list however wide its gap. Histories and bridges follow their pair from list to list.
//! The last of the bodies is a padding body, which fills groups of pairs up; nothing it does
//! counts.

use super::super::grid::for_each_near;
use super::super::row::{Row, length_squared, sub, vector};
use super::super::walls::Walls;
use super::bridges::{BridgeEffect, Bridges};
use super::rows::{Body, ContactForce, GROUP, History, Pair};
use crate::world::{Contact, Partner, Surface};

/// Pairs with what they remember, in whole groups: the last ones may be padding.
#[derive(Default)]
pub struct PairList {
    /// The pairs, sorted by their key.
    pub pairs: Vec<Pair>,
    /// The kind of all of them, if it is one.
    pub kind: Option<u32>,
    /// Tangential spring and rolling friction of each.
    pub histories: Vec<History>,
    /// Bridge of each; empty where nothing is wet.
    pub bridges: Bridges,
}

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
}

impl Parts {
    /// The parts of grain `i`.
    #[inline(always)]
    pub fn of(&self, i: usize) -> &[Part] {
        &self.list[self.first[i] as usize..self.first[i + 1] as usize]
    }

    /// How many parts the grains before slot `i` have.
    pub fn before(&self, i: usize) -> usize {
        self.first[i] as usize
    }

    /// The parts of grain `i` as the second partner, then those as the first.
    #[inline(always)]
    pub fn by_side(&self, i: usize) -> [&[Part]; 2] {
        let (first, own, end) = (self.first[i], self.own[i], self.first[i + 1]);
        [
            &self.list[first as usize..own as usize],
            &self.list[own as usize..end as usize],
        ]
    }

    /// Sorts both sides of the pairs; slots from `indices`' end on are padding'.
    fn fill(&mut self, grains: &[Pair], walls: &[Pair], indices: &[u32]) {
        let count = indices.len();
        let is_grain = |(slot, _): &(u32, Part)| (*slot as usize) < count;
        let seconds = || {
            let sides = grains.iter().enumerate();
            sides
                .map(|(k, pair)| (pair.partner, Part::new(k, true)))
                .filter(is_grain)
        };
        let firsts = || {
            let pairs = grains.iter().chain(walls).enumerate();
            pairs
                .map(|(k, pair)| (pair.grain, Part::new(k, false)))
                .filter(is_grain)
        };
        self.first.clear();
        self.first.resize(count + 1, 0);
        self.own.clear();
        self.own.resize(count, 0);
        seconds().for_each(|(slot, _)| self.own[slot as usize] += 1);
        firsts().for_each(|(slot, _)| self.first[slot as usize + 1] += 1);
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
                let slot = &mut next[slot as usize];
                self.list[*slot as usize] = part;
                *slot += 1;
            }
        }
        let other = |part: &Part| match grains.get(part.pair()) {
            Some(pair) if part.side() == 1 => indices[pair.grain as usize],
            Some(pair) => indices[pair.partner as usize],
            // Walls come last, in the order of the pairs, which is theirs.
            None => u32::MAX,
        };
        for i in 0..count {
            let (first, own, end) = (self.first[i], self.own[i], self.first[i + 1]);
            self.list[first as usize..own as usize].sort_by_key(other);
            self.list[own as usize..end as usize].sort_by_key(other);
        }
    }
}

/// Both lists.
#[derive(Default)]
pub struct Neighbours {
    /// Listed pairs of grains, sorted by their slots.
    pub grains: PairList,
    /// Listed pairs of a grain and a wall, sorted by wall and grain; a group meets one wall.
    pub walls: PairList,
    /// What each listed pair does: first those of grains, then those with walls.
    pub forces: Vec<ContactForce>,
    /// What each listed bridge does; empty where nothing is wet.
    pub bridge_effects: Vec<BridgeEffect>,
    /// The grains' parts in the listed pairs.
    pub parts: Parts,
    /// Pairs of grains on the outer list, sorted by their slots.
    outer_grains: Vec<Pair>,
    /// Pairs of a grain and a wall on it, sorted by wall and grain.
    outer_walls: Vec<Pair>,
    /// Where the grains were when it was made, and their radii [m].
    outer_reference: Vec<Row>,
    /// Where the walls were then.
    outer_surfaces: Vec<Surface>,
    /// Widths of the skins.
    skins: Skins,
    /// Largest gap that a bridge can hold; none where nothing is wet [m].
    reach: Option<f64>,
    /// Grain positions when the inner list was filtered.
    pub reference: Vec<Row>,
    /// Outer lists built since the start.
    pub searches: u64,
}

/// Widths of the skins [m].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Skins {
    /// Of the inner list: it grows and shrinks with use.
    inner: f64,
    /// Of the outer list.
    outer: f64,
    /// Smallest radius, which both are measured by.
    radius: f64,
}

/// Bounds of the inner skin relative to the smallest radius: below the lower one refreshing costs
/// more than the pairs it saves, above the upper one the list holds more strangers than neighbours.
const INNER_SKIN: std::ops::RangeInclusive<f64> = 0.01..=0.12;

/// Width of the inner skin at first, relative to the smallest radius.
const FIRST_INNER_SKIN: f64 = 0.03;

/// Width of the outer skin relative to the smallest radius.
const OUTER_SKIN: f64 = 0.35;

/// Inner lists that live shorter than this many steps want a wider skin, longer than the second a
/// narrower one.
const WANTED_STEPS: (u64, u64) = (25, 250);

impl Neighbours {
    /// How far a grain may move from [`Neighbours::reference`] before the inner list must be
    /// refreshed [m].
    pub fn slack(&self) -> f64 {
        0.5 * self.skins.inner
    }

    /// Whether the inner list still covers these bodies and walls.
    pub fn inner_covers(&self, bodies: &[Body], walls: &Walls) -> bool {
        let slack = self.slack();
        self.covers(bodies, walls)
            && self.reference.len() + 1 == bodies.len()
            && bodies
                .iter()
                .zip(&self.reference)
                .all(|(body, old)| length_squared(sub(body.position, *old)) <= slack * slack)
    }

    /// Whether the outer list was built for these bodies and walls and still covers them.
    fn covers(&self, bodies: &[Body], walls: &Walls) -> bool {
        let inner = self.skins.inner.max(self.reach.unwrap_or(0.0));
        let slack = 0.5 * (self.skins.outer - inner);
        self.outer_reference.len() + 1 == bodies.len()
            && walls.surfaces().eq(self.outer_surfaces.iter().copied())
            && bodies.iter().zip(&self.outer_reference).all(|(body, old)| {
                length_squared(sub(body.position, *old)) < slack * slack && body.radius() == old[3]
            })
    }

    /// The pair of which a grain has this part as a contact between slots, if it touches or has a
    /// bridge and the grain is its first partner.
    pub fn contact(&self, part: Part) -> Option<Contact> {
        let (index, force) = (part.pair(), &self.forces[part.pair()]);
        let touching = force.touches();
        let bridge = self.grains.bridges.get(index).bridge();
        let (pair, partner, history) = match index.checked_sub(self.grains.pairs.len()) {
            None => {
                let pair = self.grains.pairs[index];
                (
                    pair,
                    Partner::Grain(pair.partner),
                    self.grains.histories[index],
                )
            }
            Some(k) => {
                let pair = self.walls.pairs[k];
                (pair, Partner::Wall(pair.partner), self.walls.histories[k])
            }
        };
        ((touching || bridge.is_some()) && part.side() == 0).then(|| Contact {
            grain: pair.grain,
            partner,
            spring: vector(history.spring),
            stiffness: history.spring[3],
            rolling: vector(history.rolling),
            force: vector(force.force),
            touching,
            bridge,
        })
    }

    /// Says how far bridges reach [m], none where nothing is wet. The lists follow at the next
    /// refresh.
    pub fn set_reach(&mut self, reach: Option<f64>) {
        if self.reach != reach {
            self.reach = reach;
            self.forget();
        }
    }

    /// Takes over pairs with their histories and bridges, sorted by their slots, whatever was listed
    /// before. They are no whole groups: a refresh must follow.
    pub fn adopt(&mut self, pairs: PairList) {
        self.grains = pairs;
    }

    /// Forgets the outer list, for bodies or walls that are not those it was built for.
    pub fn forget(&mut self) {
        self.outer_reference.clear();
    }

    /// Makes the skin suit lists that live for `steps` steps.
    pub fn adapt(&mut self, steps: u64) {
        let factor = match steps {
            _ if steps < WANTED_STEPS.0 => 1.4,
            _ if steps > WANTED_STEPS.1 => 0.8,
            _ => 1.0,
        };
        let radius = self.skins.radius;
        self.skins.inner = (self.skins.inner * factor)
            .clamp(INNER_SKIN.start() * radius, INNER_SKIN.end() * radius);
    }

    /// Brings both lists up to date; histories follow their pairs. `indices` are those of the grains
    /// in each slot; `kind(grain, partner)` names the constants of a pair of indices.
    pub fn refresh(
        &mut self,
        bodies: &[Body],
        walls: &Walls,
        indices: &[u32],
        mut kind: impl FnMut(u32, Partner) -> u32,
    ) {
        if !self.covers(bodies, walls) {
            self.search(bodies, walls, indices, &mut kind);
        }
        let count = bodies.len() - 1;
        let padding = Pair {
            grain: count as u32,
            partner: count as u32,
            kind: 0,
        };
        let pairs = self.inner_pairs(bodies, padding);
        self.grains.replace(pairs, grain_key, self.reach.is_some());
        let pairs = self.inner_pairs_at_walls(bodies, walls, padding);
        self.walls.replace(pairs, wall_key, false);

        let listed = self.grains.pairs.len() + self.walls.pairs.len();
        self.forces.resize(listed, ContactForce::default());
        let wet = self.grains.bridges.groups.len() * GROUP;
        self.bridge_effects.resize(wet, BridgeEffect::default());
        self.parts
            .fill(&self.grains.pairs, &self.walls.pairs, indices);
        self.reference.clear();
        self.reference
            .extend(bodies[..count].iter().map(|body| body.position));
    }

    /// The pairs of grains on the outer list that belong on the inner one: near ones and those with
    /// a bridge.
    fn inner_pairs(&self, bodies: &[Body], padding: Pair) -> Vec<Pair> {
        let skin = self.skins.inner;
        let close = |pair: &&Pair| {
            let (a, b) = (&bodies[pair.grain as usize], &bodies[pair.partner as usize]);
            let reach = a.radius() + b.radius() + skin;
            length_squared(sub(b.position, a.position)) < reach * reach
        };
        let mut bridged = self.grains.bridged().peekable();
        let mut is_bridged = |pair: &Pair| {
            while bridged.next_if(|known| *known < grain_key(pair)).is_some() {}
            bridged.next_if_eq(&grain_key(pair)).is_some()
        };
        let outer = self.outer_grains.iter();
        let mut pairs: Vec<Pair> = outer
            .filter(|pair| is_bridged(pair) || close(pair))
            .copied()
            .collect();
        fill_group(&mut pairs, padding);
        pairs
    }

    /// Those of a grain and a wall; each group meets one wall.
    fn inner_pairs_at_walls(&self, bodies: &[Body], walls: &Walls, padding: Pair) -> Vec<Pair> {
        let skin = self.skins.inner;
        let close = |pair: &&Pair| {
            let body = &bodies[pair.grain as usize];
            let surface = &walls[pair.partner as usize].surface;
            surface.distance(vector(body.position)).0 < body.radius() + skin
        };
        let mut pairs = Vec::new();
        for of_wall in self.outer_walls.chunk_by(|a, b| a.partner == b.partner) {
            pairs.extend(of_wall.iter().filter(close));
            let of_same_wall = Pair {
                partner: of_wall[0].partner,
                kind: of_wall[0].kind,
                ..padding
            };
            fill_group(&mut pairs, of_same_wall);
        }
        pairs
    }

    /// Makes the outer lists anew.
    fn search(
        &mut self,
        bodies: &[Body],
        walls: &Walls,
        indices: &[u32],
        kind: &mut impl FnMut(u32, Partner) -> u32,
    ) {
        self.searches += 1;
        let bodies = &bodies[..bodies.len() - 1];
        self.set_skins(bodies);
        let outer = self.skins.outer;
        let index = |slot: u32| indices[slot as usize];
        let spheres = bodies.iter().map(with_radius);
        let pairs = &mut self.outer_grains;
        pairs.clear();
        for_each_near(spheres, outer, |slot, partners| {
            pairs.extend(partners.iter().map(|&other| {
                let (grain, partner) = if index(slot) < index(other) {
                    (slot, other)
                } else {
                    (other, slot)
                };
                let kind = kind(index(grain), Partner::Grain(index(partner)));
                Pair {
                    grain,
                    partner,
                    kind,
                }
            }));
        });
        self.outer_walls.clear();
        for (partner, wall) in (0..).zip(walls.iter()) {
            for (grain, body) in (0..).zip(bodies) {
                let distance = wall.surface.distance(vector(body.position)).0;
                if distance < body.radius() + outer {
                    self.outer_walls.push(Pair {
                        grain,
                        partner,
                        kind: kind(index(grain), Partner::Wall(partner)),
                    });
                }
            }
        }
        self.outer_surfaces.clear();
        self.outer_surfaces.extend(walls.surfaces());
        self.outer_reference.clear();
        self.outer_reference.extend(bodies.iter().map(with_radius));
    }

    /// Widths of the skins for these bodies: the inner one as it has become, unless they are others
    /// than before.
    fn set_skins(&mut self, bodies: &[Body]) {
        let radii = bodies.iter().map(Body::radius);
        let smallest = radii.fold(f64::INFINITY, f64::min);
        let inner = if self.skins.radius == smallest {
            self.skins.inner
        } else {
            FIRST_INNER_SKIN * smallest
        };
        self.skins = Skins {
            inner,
            outer: smallest * OUTER_SKIN + self.reach.unwrap_or(0.0),
            radius: smallest,
        };
    }
}

/// Where a body is, and its radius.
fn with_radius(body: &Body) -> Row {
    let [x, y, z, _] = body.position;
    [x, y, z, body.radius()]
}

impl PairList {
    /// Takes over `pairs`, sorted by `key`; those that were listed before keep their histories.
    fn replace(&mut self, pairs: Vec<Pair>, key: Key, wet: bool) {
        let mut histories = vec![History::default(); pairs.len()];
        let mut bridges = Bridges::none(if wet { pairs.len() } else { 0 });
        for (old, new) in in_both(&self.pairs, &pairs, key) {
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

    /// Sets the histories of the listed pairs from `known` pairs with their histories, sorted by
    /// `key`; others have none.
    pub fn load_histories(&mut self, known: &[Pair], histories: &[History], key: Key) {
        self.histories.fill(History::default());
        for (old, new) in in_both(known, &self.pairs, key) {
            self.histories[new] = histories[old];
        }
    }

    /// The keys of the pairs that have a bridge, in order.
    fn bridged(&self) -> impl Iterator<Item = (u32, u32)> {
        let pairs = self.pairs.iter().enumerate();
        pairs
            .filter(|(k, _)| self.bridges.get(*k).exists())
            .map(|(_, pair)| grain_key(pair))
    }
}

/// What a list is sorted by.
type Key = fn(&Pair) -> (u32, u32);

/// Order of pairs of grains: that of their first slots, so that pairs stand as their grains do.
pub fn grain_key(pair: &Pair) -> (u32, u32) {
    let (grain, partner) = (pair.grain, pair.partner);
    (grain.min(partner), grain.max(partner))
}

/// Order of pairs with walls.
pub fn wall_key(pair: &Pair) -> (u32, u32) {
    (pair.partner, pair.grain)
}

/// Adds padding until the last group is whole.
fn fill_group(pairs: &mut Vec<Pair>, padding: Pair) {
    pairs.resize(pairs.len().next_multiple_of(GROUP), padding);
}

/// Where the pairs that stand in both lists, each sorted by `key`, stand in the old and in the new
/// one.
fn in_both(old: &[Pair], new: &[Pair], key: Key) -> impl Iterator<Item = (usize, usize)> {
    let mut known = old.iter().enumerate().peekable();
    new.iter().enumerate().filter_map(move |(k, pair)| {
        while known.next_if(|(_, old)| key(old) < key(pair)).is_some() {}
        let (known, _) = known.next_if(|(_, old)| key(old) == key(pair))?;
        Some((known, k))
    })
}
