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
//!
//! Two grains that are farther apart than a skin cannot touch before one of them has moved by half
//! of it: that half is the list's slack. Motion since the list was made is measured, not bounded:
//! each grain's distance from where it was, squared, at every step ([`super::integrate`]). The
//! inner skin adapts: lists that live too short get a wider one, lists that live long hold too many
//! strangers and get a narrower one. The outer skin has room for the inner one and for the longest
//! bridge.
//!
//! Not here: the search itself ([`super::super::grid`]), histories on their way from list to list
//! ([`super::pair_list`]), sums ([`super::parts`]).

use super::super::grid::NearSearch;
use super::super::row::{Row, length_squared, row, sub, vector};
use super::super::walls::Walls;
use super::super::workers::WorkerPool;
use super::kinds::{KindFinder, Kinds};
use super::pair_list::{PairOrder, SpherePairs, fill_group};
use super::parts::Parts;
use super::rows::{PairKind, Slot, Sphere, SpherePair, WallId};
use super::slots::Slots;
use crate::world::{Contact, Partner, Surface};
use std::ops::Range;

/// Both lists.
#[derive(Default)]
pub struct Neighbours {
    /// Listed pairs of grains, sorted by their slots.
    pub grains: SpherePairs,
    /// Listed pairs of a grain and a wall, sorted by wall and grain; a group meets one wall.
    pub walls: SpherePairs<WallId>,
    /// The grains' parts in the listed pairs.
    pub parts: Parts,
    /// Pairs of grains on the outer list, sorted by their slots.
    outer_grains: Vec<SpherePair>,
    /// Pairs of a grain and a wall on it, sorted by wall and grain.
    outer_walls: Vec<SpherePair<WallId>>,
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
    /// Where the walls were then.
    surfaces: Vec<Surface>,
    /// Outer lists built since the start.
    pub searches: u64,
    /// Inner lists filtered since the start.
    pub generation: u64,
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
    pub fn inner_covers(&self, bodies: &[Sphere], walls: &Walls) -> bool {
        let slack = self.slack();
        self.covers(bodies, walls)
            && walls.surfaces().eq(&self.surfaces)
            && self.reference.len() + 1 == bodies.len()
            && bodies
                .iter()
                .zip(&self.reference)
                .all(|(body, old)| length_squared(sub(body.position, *old)) <= slack * slack)
    }

    /// Whether the outer list was built for these bodies and walls and still covers them.
    fn covers(&self, bodies: &[Sphere], walls: &Walls) -> bool {
        let inner = self.skins.inner.max(self.reach.unwrap_or(0.0));
        let slack = 0.5 * (self.skins.outer - inner);
        self.outer_reference.len() + 1 == bodies.len()
            && walls.are_near(&self.outer_surfaces, slack)
            && bodies.iter().zip(&self.outer_reference).all(|(body, old)| {
                length_squared(sub(body.position, *old)) < slack * slack && body.radius() == old[3]
            })
    }

    /// The contacts of which the grain in this slot is the first partner, in the order of the
    /// partners.
    pub fn contacts_of<'a>(
        &'a self,
        slot: Slot,
        slots: &'a Slots,
    ) -> impl Iterator<Item = Contact> + use<'a> {
        self.held_pairs(slot)
            .map(|index| self.contact(index, slots))
    }

    /// How many there are.
    pub fn contact_count(&self, slot: Slot) -> usize {
        self.held_pairs(slot).count()
    }

    /// The pairs of which the grain in this slot is the first partner and that touch or have a
    /// bridge.
    fn held_pairs(&self, slot: Slot) -> impl Iterator<Item = usize> {
        let pairs = self
            .parts
            .as_first(slot.index())
            .iter()
            .map(|part| part.pair());
        pairs.filter(|index| {
            let rolling = match index.checked_sub(self.grains.pairs.len()) {
                None => self.grains.rolling[*index],
                Some(k) => self.walls.rolling[k],
            };
            rolling[3] > 0.0 || self.grains.bridges.get(*index).exists()
        })
    }

    /// The pair of this number as a contact.
    fn contact(&self, index: usize, slots: &Slots) -> Contact {
        let (grain, partner, history) = match index.checked_sub(self.grains.pairs.len()) {
            None => {
                let pair = self.grains.pairs[index];
                let partner = Partner::Grain(slots.grain_in(pair.partner));
                (pair.grain, partner, self.grains.history(index))
            }
            Some(k) => {
                let pair = self.walls.pairs[k];
                let partner = Partner::Wall(pair.partner.0);
                (pair.grain, partner, self.walls.history(k))
            }
        };
        let [spring, rolling, force] = history;
        Contact {
            grain: slots.grain_in(grain),
            partner,
            spring: vector(spring),
            stiffness: spring[3],
            rolling: vector(rolling),
            force: vector(force),
            touching: rolling[3] > 0.0,
            bridge: self.grains.bridges.get(index).bridge(),
        }
    }

    /// Says how far bridges reach [m], none where nothing is wet. The lists follow at the next
    /// refresh.
    pub fn set_reach(&mut self, reach: Option<f64>) {
        if self.reach != reach {
            self.reach = reach;
            self.forget();
        }
    }

    /// Gives the listed pairs the histories of these contacts, sorted by grain; all others have
    /// none.
    pub fn load_histories(&mut self, pool: &mut WorkerPool, contacts: &[Contact], slots: &Slots) {
        let first = first_contacts(contacts, slots.grains().len());
        let history = |slot: Slot, partner: Partner| {
            // Padding is no grain.
            let grain = slots
                .grains()
                .get(slot.index())
                .map(|grain| *grain as usize)?;
            let own = &contacts[first[grain]..first[grain + 1]];
            let contact = own.iter().find(|contact| contact.partner == partner)?;
            let touching = f64::from(contact.touching);
            Some([
                row(contact.spring, contact.stiffness),
                row(contact.rolling, touching),
            ])
        };
        self.grains.remember(pool, |pair| {
            history(pair.grain, Partner::Grain(slots.grain_in(pair.partner)))
        });
        self.walls.remember(pool, |pair| {
            history(pair.grain, Partner::Wall(pair.partner.0))
        });
    }

    /// Takes over pairs with their bridges, sorted by their slots, whatever was listed
    /// before. They are no whole groups: a refresh must follow.
    pub fn adopt(&mut self, pairs: SpherePairs) {
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

    /// Brings both lists up to date; histories follow their pairs. `kinds` tells of which kind a pair
    /// is, and takes note of kinds that were not met before.
    pub fn refresh(
        &mut self,
        pool: &mut WorkerPool,
        (bodies, walls): (&[Sphere], &Walls),
        slots: &Slots,
        kinds: &mut Kinds,
    ) {
        if !self.covers(bodies, walls) {
            self.search(pool, (bodies, walls), slots, kinds);
        }
        self.generation += 1;
        let count = bodies.len() - 1;
        let padding = Slot(count as u32);
        let pairs = self.inner_pairs(pool, bodies, padding);
        self.grains.replace(pool, pairs, self.reach.is_some());
        let pairs = self.inner_pairs_at_walls(bodies, walls, padding);
        self.walls.replace(pool, pairs, false);
        self.parts
            .fill(pool, &self.grains.pairs, &self.walls.pairs, slots);
        self.surfaces.clear();
        self.surfaces.extend(walls.surfaces().cloned());
        self.reference.clear();
        self.reference
            .extend(bodies[..count].iter().map(|body| body.position));
    }

    /// The pairs of grains on the outer list that belong on the inner one: near ones and those with
    /// a bridge.
    fn inner_pairs(
        &self,
        pool: &mut WorkerPool,
        bodies: &[Sphere],
        padding: Slot,
    ) -> Vec<SpherePair> {
        let skin = self.skins.inner;
        let close = |pair: &SpherePair| {
            let (a, b) = (&bodies[pair.grain.index()], &bodies[pair.partner.index()]);
            let reach = a.radius() + b.radius() + skin;
            length_squared(sub(b.position, a.position)) < reach * reach
        };
        let ranges = pool.ranges(self.outer_grains.len(), 1);
        let found = pool.map(ranges, |range| {
            let outer = &self.outer_grains[range];
            let from = outer.first().map(PairOrder::key);
            let mut bridged = from.map(|key| self.grains.bridged(key).peekable());
            let mut is_bridged = |pair: &SpherePair| {
                bridged.as_mut().is_some_and(|bridged| {
                    while bridged.next_if(|known| *known < pair.key()).is_some() {}
                    bridged.next_if_eq(&pair.key()).is_some()
                })
            };
            let belongs = |pair: &&SpherePair| is_bridged(pair) || close(pair);
            outer.iter().filter(belongs).copied().collect()
        });
        let mut pairs = joined(found);
        let padding = SpherePair {
            grain: padding,
            partner: padding,
            kind: PairKind::default(),
        };
        fill_group(&mut pairs, padding);
        pairs
    }

    /// Those of a grain and a wall; each group meets one wall.
    fn inner_pairs_at_walls(
        &self,
        bodies: &[Sphere],
        walls: &Walls,
        padding: Slot,
    ) -> Vec<SpherePair<WallId>> {
        let skin = self.skins.inner;
        let close = |pair: &&SpherePair<WallId>| {
            let body = &bodies[pair.grain.index()];
            let surface = &walls[pair.partner.index()].surface;
            surface.distance(vector(body.position)).0 < body.radius() + skin
        };
        let mut pairs = Vec::new();
        for of_wall in self.outer_walls.chunk_by(|a, b| a.partner == b.partner) {
            pairs.extend(of_wall.iter().filter(close));
            let of_same_wall = SpherePair {
                grain: padding,
                ..of_wall[0]
            };
            fill_group(&mut pairs, of_same_wall);
        }
        pairs
    }

    /// Makes the outer lists anew.
    fn search(
        &mut self,
        pool: &mut WorkerPool,
        (bodies, walls): (&[Sphere], &Walls),
        slots: &Slots,
        kinds: &mut Kinds,
    ) {
        self.searches += 1;
        let bodies = &bodies[..bodies.len() - 1];
        self.set_skins(bodies);
        let outer = self.skins.outer;
        let near = NearSearch::new(bodies.iter().map(with_radius).collect(), outer);
        let search = OuterSearch {
            outer,
            near: &near,
            bodies,
            walls,
            slots,
        };
        let ranges = pool.ranges(bodies.len(), 1);
        let finder = || kinds.finder();
        let found = pool.map(ranges, |range| search.run(range, finder()));
        let (of_grains, at_walls): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        self.outer_grains = joined(of_grains);
        self.outer_walls = joined(at_walls);
        // Of one wall they are in the order of the grains already.
        self.outer_walls.sort_by_key(|pair| pair.partner);
        for pair in unknown(&mut self.outer_grains) {
            let [grain, partner] = [pair.grain, pair.partner].map(|slot| slots.grain_in(slot));
            pair.kind = kinds.of(grain, Partner::Grain(partner));
        }
        for pair in unknown(&mut self.outer_walls) {
            let wall = Partner::Wall(pair.partner.0);
            pair.kind = kinds.of(slots.grain_in(pair.grain), wall);
        }
        self.outer_surfaces.clear();
        self.outer_surfaces.extend(walls.surfaces().cloned());
        self.outer_reference.clear();
        self.outer_reference.extend(bodies.iter().map(with_radius));
    }

    /// Widths of the skins for these bodies: the inner one as it has become, unless they are others
    /// than before.
    fn set_skins(&mut self, bodies: &[Sphere]) {
        let radii = bodies.iter().map(Sphere::radius);
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

/// What the outer lists are made from.
struct OuterSearch<'a> {
    /// Width of the skin [m].
    outer: f64,
    near: &'a NearSearch,
    bodies: &'a [Sphere],
    walls: &'a Walls,
    slots: &'a Slots,
}

/// Pairs of grains, and pairs of a grain and a wall.
type BothKinds = (Vec<SpherePair>, Vec<SpherePair<WallId>>);

impl OuterSearch<'_> {
    /// The pairs whose lower slots are these, and those of these slots with walls.
    fn run(&self, slots: Range<usize>, mut kinds: KindFinder<'_>) -> BothKinds {
        let (mut of_grains, mut at_walls) = (Vec::new(), Vec::new());
        let index = |slot: Slot| self.slots.grain_in(slot);
        self.near.visit(slots.clone(), |slot, partners| {
            let slot = Slot(slot);
            of_grains.extend(partners.iter().map(|&other| {
                let other = Slot(other);
                let (grain, partner) = if index(slot) < index(other) {
                    (slot, other)
                } else {
                    (other, slot)
                };
                let kind = kinds.find(index(grain), Partner::Grain(index(partner)));
                SpherePair {
                    grain,
                    partner,
                    kind: kind.unwrap_or(PairKind::UNKNOWN),
                }
            }));
        });
        for (partner, wall) in (0..).map(WallId).zip(self.walls.iter()) {
            for (grain, body) in (slots.start as u32..)
                .map(Slot)
                .zip(&self.bodies[slots.clone()])
            {
                let distance = wall.surface.distance(vector(body.position)).0;
                if distance < body.radius() + self.outer {
                    let kind = kinds.find(index(grain), Partner::Wall(partner.0));
                    at_walls.push(SpherePair {
                        grain,
                        partner,
                        kind: kind.unwrap_or(PairKind::UNKNOWN),
                    });
                }
            }
        }
        (of_grains, at_walls)
    }
}

/// Where the contacts of each of so many grains begin among `contacts`, which are sorted by grain,
/// and where those of the last one end.
fn first_contacts(contacts: &[Contact], grains: usize) -> Vec<usize> {
    let mut first = vec![0; grains + 1];
    for contact in contacts {
        first[contact.grain as usize + 1] += 1;
    }
    for grain in 0..grains {
        first[grain + 1] += first[grain];
    }
    first
}

/// The pairs whose kind is not known yet.
fn unknown<P>(pairs: &mut [SpherePair<P>]) -> impl Iterator<Item = &mut SpherePair<P>> {
    let is_unknown = |pair: &&mut SpherePair<P>| pair.kind == PairKind::UNKNOWN;
    pairs.iter_mut().filter(is_unknown)
}

/// What workers have found, one behind the other.
fn joined<T: Copy>(mut found: Vec<Vec<T>>) -> Vec<T> {
    if found.len() == 1 {
        found.swap_remove(0)
    } else {
        found.concat()
    }
}

/// Where a body is, and its radius.
fn with_radius(body: &Sphere) -> Row {
    let [x, y, z, _] = body.position;
    [x, y, z, body.radius()]
}
