//! Who may touch whom.
//!
//! Two lists, both pure caches that never change a result. The *near* list, from a cell grid, holds pairs closer than a
//! wide skin; the *active* list, filtered from it, holds pairs closer than a narrow skin and is what the pair loop runs
//! over. Each list is good until some grain has moved by half its skin. Grains are named by their places ([`super::order`])
//! and pairs kept sorted by the lower and the higher of these, but the first grain of a pair is the one of lower index, and forces are summed in the
//! order of indices: so the sums do not depend on the places. A listed pair that does not touch adds exact zeros, so they do
//! not depend on the skins. A pair with a bridge is active however wide its gap. Tangential springs and bridges follow their pair from list to
//! list. The last of the bodies is a ghost that fills groups of
//! pairs up; nothing it does counts.

use super::bridges::{Bridges, LiquidAction};
use super::contacts::{Action, Body, GROUP, Pair, WallBody};
use super::grid::CellGrid;
use super::row::{Row, length_squared, sub, vector};
use crate::world::{Contact, Partner, Surface};

/// Pairs with what they remember, in whole groups: the last ones may be ghosts.
#[derive(Default)]
pub struct PairList {
    /// The pairs, sorted by their key.
    pub pairs: Vec<Pair>,
    /// The kind of all of them, if it is one.
    pub kind: Option<u32>,
    /// Tangential spring of each [m].
    pub springs: Vec<Row>,
    /// Bridge of each; empty where nothing is wet.
    pub bridges: Bridges,
}

/// A grain's part in a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part(u32);

impl Part {
    fn new(action: usize, second: bool) -> Self {
        Self((action as u32) << 1 | u32::from(second))
    }

    /// Index of the pair's action: pairs of grains come first, then pairs with walls.
    #[inline(always)]
    pub fn action(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// 1 where the grain is the second partner, else 0.
    #[inline(always)]
    pub fn side(self) -> usize {
        (self.0 & 1) as usize
    }
}

/// The parts that each grain has in active pairs: as the second partner, then as the first, each in the order of the
/// partners' indices, then at walls.
#[derive(Default)]
pub struct Parts {
    first: Vec<u32>,
    /// Where each grain's parts as the first partner begin.
    own: Vec<u32>,
    list: Vec<Part>,
}

impl Parts {
    /// The parts of grain `i`.
    #[inline(always)]
    pub fn of(&self, i: usize) -> &[Part] {
        &self.list[self.first[i] as usize..self.first[i + 1] as usize]
    }

    /// How many parts the grains before place `i` have.
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

    /// Sorts both sides of the pairs; places from `indices`' end on are ghosts'.
    fn fill(&mut self, grains: &[Pair], walls: &[Pair], indices: &[u32]) {
        let count = indices.len();
        let is_grain = |(place, _): &(u32, Part)| (*place as usize) < count;
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
        seconds().for_each(|(place, _)| self.own[place as usize] += 1);
        firsts().for_each(|(place, _)| self.first[place as usize + 1] += 1);
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
            for (place, part) in sides {
                let place = &mut next[place as usize];
                self.list[*place as usize] = part;
                *place += 1;
            }
        }
        let other = |part: &Part| match grains.get(part.action()) {
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
    /// Active pairs of grains, sorted by their places.
    pub grains: PairList,
    /// Active pairs of a grain and a wall, sorted by wall and grain; a group meets one wall.
    pub walls: PairList,
    /// What each active pair does: first those of grains, then those with walls.
    pub actions: Vec<Action>,
    /// What each active bridge does; empty where nothing is wet.
    pub liquid_actions: Vec<LiquidAction>,
    /// The grains' parts in the active pairs.
    pub parts: Parts,
    near_grains: Vec<Pair>,
    near_walls: Vec<Pair>,
    near_reference: Vec<Row>,
    near_surfaces: Vec<Surface>,
    skins: Skins,
    /// Largest gap that a bridge can hold; none where nothing is wet [m].
    reach: Option<f64>,
    /// Grain positions when the active list was filtered.
    pub reference: Vec<Row>,
    /// Near lists built since the start.
    pub rebuilds: u64,
}

/// Widths of the skins [m].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Skins {
    active: f64,
    near: f64,
    /// Smallest radius, which both are measured by.
    radius: f64,
}

/// Bounds of the active skin relative to the smallest radius: below the lower one refreshing costs more than the pairs
/// it saves, above the upper one the list holds more strangers than neighbours.
const ACTIVE_SKIN: std::ops::RangeInclusive<f64> = 0.01..=0.12;

/// Width of the near skin relative to the smallest radius.
const NEAR_SKIN: f64 = 0.35;

/// Active lists that live shorter than this many steps want a wider skin, longer than the second a narrower one.
const WANTED_STEPS: (u64, u64) = (25, 250);

impl Neighbours {
    /// How far a grain may move from [`Neighbours::reference`] before the active list must be refreshed [m].
    pub fn slack(&self) -> f64 {
        0.5 * self.skins.active
    }

    /// Whether the active list still covers these bodies and walls.
    pub fn active_covers(&self, bodies: &[Body], walls: &[WallBody]) -> bool {
        let slack = self.slack();
        self.covers(bodies, walls)
            && self.reference.len() + 1 == bodies.len()
            && bodies
                .iter()
                .zip(&self.reference)
                .all(|(body, old)| length_squared(sub(body.position, *old)) <= slack * slack)
    }

    /// Whether the near list was built for these bodies and walls and still covers them.
    fn covers(&self, bodies: &[Body], walls: &[WallBody]) -> bool {
        let inner = self.skins.active.max(self.reach.unwrap_or(0.0));
        let slack = 0.5 * (self.skins.near - inner);
        self.near_reference.len() + 1 == bodies.len()
            && walls
                .iter()
                .map(|wall| wall.surface)
                .eq(self.near_surfaces.iter().copied())
            && bodies.iter().zip(&self.near_reference).all(|(body, old)| {
                length_squared(sub(body.position, *old)) < slack * slack && body.spin[3] == old[3]
            })
    }

    /// The pair of which a grain has this part as a contact between places, if it touches or has a bridge and the grain is
    /// its first partner.
    pub fn contact(&self, part: Part) -> Option<Contact> {
        let (index, action) = (part.action(), &self.actions[part.action()]);
        let touching = action.rolling[3] > 0.0;
        let bridge = self.grains.bridges.get(index).bridge();
        let (pair, partner, spring) = match index.checked_sub(self.grains.pairs.len()) {
            None => {
                let pair = self.grains.pairs[index];
                (
                    pair,
                    Partner::Grain(pair.partner),
                    self.grains.springs[index],
                )
            }
            Some(k) => {
                let pair = self.walls.pairs[k];
                (pair, Partner::Wall(pair.partner), self.walls.springs[k])
            }
        };
        ((touching || bridge.is_some()) && part.side() == 0).then(|| Contact {
            grain: pair.grain,
            partner,
            spring: vector(spring),
            stiffness: spring[3],
            force: vector(action.force),
            touching,
            bridge,
        })
    }

    /// Says how far bridges reach [m], none where nothing is wet. The lists follow at the next refresh.
    pub fn set_reach(&mut self, reach: Option<f64>) {
        if self.reach != reach {
            self.reach = reach;
            self.forget();
        }
    }

    /// Takes over pairs with their springs and bridges, sorted by their places, whatever was listed before. They are
    /// no whole groups: a refresh must follow.
    pub fn adopt(&mut self, pairs: PairList) {
        self.grains = pairs;
    }

    /// Forgets the near list, for bodies or walls that are not those it was built for.
    pub fn forget(&mut self) {
        self.near_reference.clear();
    }

    /// Makes the skin suit lists that live for `steps` steps.
    pub fn adapt(&mut self, steps: u64) {
        let factor = match steps {
            _ if steps < WANTED_STEPS.0 => 1.4,
            _ if steps > WANTED_STEPS.1 => 0.8,
            _ => 1.0,
        };
        let radius = self.skins.radius;
        self.skins.active = (self.skins.active * factor)
            .clamp(ACTIVE_SKIN.start() * radius, ACTIVE_SKIN.end() * radius);
    }

    /// Brings both lists up to date; springs follow their pairs. `indices` are those of the grains at each place;
    /// `kind(grain, partner)` and `wall_kind(grain, wall)` name the constants of a pair of indices.
    pub fn refresh(
        &mut self,
        bodies: &[Body],
        walls: &[WallBody],
        indices: &[u32],
        mut kind: impl FnMut(u32, u32) -> u32,
        mut wall_kind: impl FnMut(u32, u32) -> u32,
    ) {
        if !self.covers(bodies, walls) {
            self.rebuild(bodies, walls, indices, &mut kind, &mut wall_kind);
        }
        let skin = self.skins.active;
        let close = |pair: &&Pair| {
            let (a, b) = (&bodies[pair.grain as usize], &bodies[pair.partner as usize]);
            let reach = a.spin[3] + b.spin[3] + skin;
            length_squared(sub(b.position, a.position)) < reach * reach
        };
        let at_wall = |pair: &&Pair| {
            let body = &bodies[pair.grain as usize];
            let (distance, _) = walls[pair.partner as usize]
                .surface
                .distance(vector(body.position));
            distance < body.spin[3] + skin
        };
        let count = bodies.len() - 1;
        let ghost = Pair {
            grain: count as u32,
            partner: count as u32,
            kind: 0,
        };
        let mut bridged = self.grains.bridged().peekable();
        let mut is_bridged = |pair: &Pair| {
            while bridged.next_if(|known| *known < grain_key(pair)).is_some() {}
            bridged.next_if_eq(&grain_key(pair)).is_some()
        };
        let mut pairs: Vec<Pair> = self
            .near_grains
            .iter()
            .filter(|pair| is_bridged(pair) || close(pair))
            .copied()
            .collect();
        drop(bridged);
        fill_group(&mut pairs, ghost);
        self.grains.replace(pairs, grain_key, self.reach.is_some());
        let mut pairs = Vec::new();
        for of_wall in self.near_walls.chunk_by(|a, b| a.partner == b.partner) {
            pairs.extend(of_wall.iter().filter(at_wall));
            fill_group(
                &mut pairs,
                Pair {
                    partner: of_wall[0].partner,
                    kind: of_wall[0].kind,
                    ..ghost
                },
            );
        }
        self.walls.replace(pairs, wall_key, false);
        self.actions.resize(
            self.grains.pairs.len() + self.walls.pairs.len(),
            Action::default(),
        );
        let wet = self.grains.bridges.groups.len() * GROUP;
        self.liquid_actions.resize(wet, LiquidAction::default());
        self.parts
            .fill(&self.grains.pairs, &self.walls.pairs, indices);
        self.reference.clear();
        self.reference
            .extend(bodies[..count].iter().map(|body| body.position));
    }

    fn rebuild(
        &mut self,
        bodies: &[Body],
        walls: &[WallBody],
        indices: &[u32],
        kind: &mut impl FnMut(u32, u32) -> u32,
        wall_kind: &mut impl FnMut(u32, u32) -> u32,
    ) {
        self.rebuilds += 1;
        let bodies = &bodies[..bodies.len() - 1];
        let smallest = bodies
            .iter()
            .map(|body| body.spin[3])
            .fold(f64::INFINITY, f64::min);
        let near = smallest * NEAR_SKIN + self.reach.unwrap_or(0.0);
        let active = if self.skins.radius == smallest {
            self.skins.active
        } else {
            0.03 * smallest
        };
        self.skins = Skins {
            active,
            near,
            radius: smallest,
        };

        self.near_grains.clear();
        let places = bodies.iter().map(|body| (body.position, body.spin[3]));
        let grid = CellGrid::new(places, near);
        let mut partners = Vec::new();
        for (i, body) in bodies.iter().enumerate() {
            partners.clear();
            grid.for_near(body.position, |j| {
                let other = &bodies[j as usize];
                let reach = body.spin[3] + other.spin[3] + near;
                if j as usize > i
                    && length_squared(sub(other.position, body.position)) < reach * reach
                {
                    partners.push(j);
                }
            });
            partners.sort_unstable();
            let place = i as u32;
            let index = |place: u32| indices[place as usize];
            self.near_grains.extend(partners.iter().map(|&other| {
                let (grain, partner) = if index(place) < index(other) {
                    (place, other)
                } else {
                    (other, place)
                };
                let kind = kind(index(grain), index(partner));
                Pair {
                    grain,
                    partner,
                    kind,
                }
            }));
        }

        self.near_walls.clear();
        for (w, wall) in walls.iter().enumerate() {
            for (i, body) in bodies.iter().enumerate() {
                if wall.surface.distance(vector(body.position)).0 < body.spin[3] + near {
                    let (grain, partner) = (i as u32, w as u32);
                    self.near_walls.push(Pair {
                        grain,
                        partner,
                        kind: wall_kind(indices[i], partner),
                    });
                }
            }
        }
        self.near_surfaces.clear();
        self.near_surfaces
            .extend(walls.iter().map(|wall| wall.surface));
        self.near_reference.clear();
        self.near_reference.extend(bodies.iter().map(|body| {
            let p = body.position;
            [p[0], p[1], p[2], body.spin[3]]
        }));
    }
}

impl PairList {
    /// Takes over `pairs`, sorted by `key`; those that were listed before keep their springs.
    fn replace(&mut self, pairs: Vec<Pair>, key: Key, wet: bool) {
        let mut springs = vec![[0.0; 4]; pairs.len()];
        let mut bridges = Bridges::none(if wet { pairs.len() } else { 0 });
        for (old, new) in in_both(&self.pairs, &pairs, key) {
            springs[new] = self.springs[old];
            if wet {
                bridges.set(new, &self.bridges.get(old));
            }
        }
        self.springs = springs;
        self.bridges = bridges;
        let kind = pairs.first().map(|pair| pair.kind);
        self.kind = kind.filter(|kind| pairs.iter().all(|pair| pair.kind == *kind));
        self.pairs = pairs;
    }

    /// Sets the springs of the listed pairs from `known` pairs with their springs, sorted by `key`; others are unloaded.
    pub fn load_springs(&mut self, known: &[Pair], springs: &[Row], key: Key) {
        self.springs.fill([0.0; 4]);
        for (old, new) in in_both(known, &self.pairs, key) {
            self.springs[new] = springs[old];
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

/// Order of pairs of grains: that of their first places, so that pairs stand as their grains do.
pub fn grain_key(pair: &Pair) -> (u32, u32) {
    let (grain, partner) = (pair.grain, pair.partner);
    (grain.min(partner), grain.max(partner))
}

/// Order of pairs with walls.
pub fn wall_key(pair: &Pair) -> (u32, u32) {
    (pair.partner, pair.grain)
}

/// Adds ghosts until the last group is whole.
fn fill_group(pairs: &mut Vec<Pair>, ghost: Pair) {
    pairs.resize(pairs.len().next_multiple_of(GROUP), ghost);
}

/// Where the pairs that stand in both lists, each sorted by `key`, stand in the old and in the new one.
fn in_both(old: &[Pair], new: &[Pair], key: Key) -> impl Iterator<Item = (usize, usize)> {
    let mut known = old.iter().enumerate().peekable();
    new.iter().enumerate().filter_map(move |(k, pair)| {
        while known.next_if(|(_, old)| key(old) < key(pair)).is_some() {}
        let (known, _) = known.next_if(|(_, old)| key(old) == key(pair))?;
        Some((known, k))
    })
}
