//! Which features of a block of pairs are measured in a step, and their measurement.
//!
//! In: a block of pairs after a drift. Out: the nearest points of every pair of active features;
//! lists of features made anew for those pairs that have used up their slack. A [`Workspace`] is
//! what one worker needs for it again and again.
//!
//! A pair passes three sieves, each with a slack that the step's motion is taken off:
//!
//! | sieve | what passes it | how often |
//! |---|---|---|
//! | outer list | features nearer than touching distance and outer skin | every [`OUTER_LIFE`] steps |
//! | inner list | of these, features nearer than touching distance and inner skin | every [`INNER_LIFE`] steps |
//! | clearance | pairs of which anything on the inner list may touch | looked at in each step |
//!
//! Not here: forces ([`super::forces`]), how a list is made ([`super::listing`]).

use super::super::row::{Row, vector};
use super::implicit_contact::ImplicitContact;
use super::joint::Joint;
use super::listed::Listed;
use super::listing::{Search, Wanted, choose};
use super::motion::Surroundings;
use super::nearest::{Jobs, Nearest};
use super::pairs::{Block, ContactPoint, Pair, Terms, to_wall};
use crate::lanes::{Lanes, prefetch};
use crate::world::{Feature, Partner, Surface};
use std::ops::Range;

/// Steps that an outer list is made to last at the pace at which its bodies move.
const OUTER_LIFE: f64 = 60.0;
/// Bounds of its skin relative to the distance of cores at which the two touch.
const OUTER_SKIN: std::ops::RangeInclusive<f64> = 0.01..=0.5;
/// Steps that a choice of active features is made to last.
const INNER_LIFE: f64 = 10.0;
/// Smallest skin of active features relative to the distance at which the two touch.
const INNER_SKIN: f64 = 1e-4;
/// Bodies are asked for so many pairs ahead.
const AHEAD: usize = 8;

/// A pair of which something may touch, on its way through a block.
#[derive(Clone, Copy, Default)]
pub struct ActivePair {
    /// Velocity of the first relative to the second at the first's centroid [m/s]; part of the
    /// pair's stiffness that each contact has.
    pub velocity: Row,
    /// Relative spin [rad/s]; the part that each contact had a step ago.
    pub spin: Row,
    /// Mean spin of both [rad/s].
    pub mean_spin: Row,
    /// Centroid of the first [m]; half the difference of the sphero-radii [m].
    pub centre: Row,
    /// Number of the pair in the block.
    pub pair: u32,
    /// Where its results begin.
    pub results: u32,
    /// By how much it moved in this step, where its active features are to be chosen [m].
    pub choose: Option<f64>,
    /// What the normal springs store more than a step ago, where they share their stiffness [J].
    pub stored: f64,
    /// Whether anything touches.
    pub touches: bool,
}

impl ActivePair {
    /// Takes note of the part of the pair's stiffness that each contact had a step ago and has now.
    #[inline(always)]
    pub fn set_parts(&mut self, before: f64, now: f64) {
        (self.spin[3], self.velocity[3]) = (before, now);
    }
}

/// Where the pair and the contact point of a result are.
#[derive(Clone, Copy)]
pub struct ResultOf {
    /// Number of the active pair.
    pub pair: u32,
    /// Number of the contact point in the block.
    pub point: u32,
}

/// Room to work in: what one worker needs again and again.
#[derive(Default)]
pub struct Workspace {
    /// What a search for features needs.
    search: Search,
    /// Features that were found.
    found: Vec<Listed>,
    /// The contact points that a pair had.
    known: Vec<ContactPoint>,
    /// The contact points of a block that is given more room.
    moved_points: Vec<ContactPoint>,
    /// Nearest points to compute.
    jobs: Jobs,
    /// The active pairs of the block.
    pub active: Vec<ActivePair>,
    /// Nearest points of their active features.
    pub results: Vec<Nearest>,
    /// Whose the results are.
    pub result_of: Vec<ResultOf>,
    /// What each contact does.
    pub effects: Vec<Effect>,
    /// Its springs and its dashpot, where they are taken implicitly.
    pub implicit: Vec<ImplicitContact>,
    /// The worker's part of the joint solution of springs and dashpots.
    pub joint: Joint,
}

/// What a contact does.
#[derive(Clone, Copy, Default)]
pub struct Effect {
    /// Force on the first [N]; overlap, none at a gap [m].
    pub force: Row,
    /// Its torque [N m]; what is to be remembered along the normal ([`ContactPoint::normal_memory`]).
    pub moment: Row,
    /// Energy lost in the dashpot, by the tangential spring, and put into the normal spring [J].
    pub energy: Row,
}

impl Effect {
    /// Overlap, none at a gap [m].
    #[inline(always)]
    pub fn overlap(&self) -> f64 {
        self.force[3]
    }

    /// What is to be remembered along the normal ([`ContactPoint::normal_memory`]).
    #[inline(always)]
    pub fn normal_memory(&self) -> f64 {
        self.moment[3]
    }
}

impl Workspace {
    /// Collects the pairs of a block whose features are to be measured; lists anew those that have
    /// used up their slack, and returns how many these are.
    #[inline(always)]
    pub fn gather<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        block: &mut Block<'_>,
    ) -> u64 {
        let mut listed = 0;
        self.active.clear();
        for index in 0..block.pairs.len() {
            if let Some(ahead) = block.pairs.get(index + AHEAD) {
                all.fetch(ahead);
            }
            let pair = &mut block.pairs[index];
            let relative = all.relative(pair);
            let moved = relative.moved;
            pair.outer_slack -= moved;
            pair.inner_slack -= moved;
            pair.clearance -= moved;
            let ahead = all.look_ahead * moved;
            if pair.outer_slack < ahead {
                listed += 1;
                self.list::<N>(processor, all, moved, pair, &mut block.terms[index]);
            }
            let choose = pair.inner_slack < ahead;
            if !choose && pair.clearance > ahead {
                continue;
            }
            prefetch::<_, 16>(&block.points[pair.points.range()]);
            if let Some(j) = pair.second.as_grain() {
                all.geometry.fetch(j);
            }
            let [vx, vy, vz, _] = relative.velocity;
            let [wx, wy, wz, _] = relative.spin;
            let [x, y, z, _] = all.bodies[pair.first as usize].position;
            self.active.push(ActivePair {
                velocity: [vx, vy, vz, 1.0],
                spin: [wx, wy, wz, 1.0],
                mean_spin: relative.mean_spin,
                centre: [x, y, z, block.terms[index].offset],
                pair: index as u32,
                choose: choose.then_some(moved),
                ..ActivePair::default()
            });
        }
        listed
    }

    /// Makes the list of `pair`, which has `moved` by so much in this step, anew. The skin is what
    /// lets it last for [`OUTER_LIFE`] steps at that pace, within bounds: a wide one lists features
    /// that never touch, a narrow one has to be made again soon.
    #[inline(always)]
    fn list<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        moved: f64,
        pair: &mut Pair,
        terms: &mut Terms,
    ) {
        let [least, most] = [OUTER_SKIN.start(), OUTER_SKIN.end()].map(|skin| skin * terms.touch);
        let skin = (OUTER_LIFE * moved).clamp(least, most);
        let first = pair.first as usize;
        let slack = match pair.partner() {
            Partner::Wall(w) => {
                let (surface, reach) = (&all.walls[w as usize].surface, [terms.touch, skin]);
                list_at_wall(all, surface, first, reach, &mut self.found)
            }
            Partner::Grain(j) => {
                let wanted = Wanted {
                    bodies: [first, j as usize],
                    axis: terms.axis.map(f64::from),
                    reach: all.bodies[first].reach(),
                    touch: terms.touch,
                    skin,
                };
                let found =
                    self.search
                        .run::<N>(processor, &all.geometry, &wanted, &mut self.found);
                terms.axis = found.axis.map(|x| x as f32);
                found.slack
            }
        };
        pair.outer_slack = slack - f64::from(terms.margin);
        pair.outer = self.found.as_slice().into();
        pair.inner_slack = -1.0;
    }

    /// Measures features of a pair with a wall, or has them measured: features of two bodies are
    /// queued by kind, so that all pairs of the block fill the lanes together.
    #[inline(always)]
    fn queue(
        &mut self,
        all: &Surroundings<'_>,
        pair: &Pair,
        [faces, edges]: [impl ExactSizeIterator<Item = Listed>; 2],
    ) {
        let (shapes, first) = (all.geometry.shapes, pair.first as usize);
        let second = match pair.partner() {
            Partner::Grain(j) => j as usize,
            Partner::Wall(w) => {
                let surface = &all.walls[w as usize].surface;
                let vertices = all.geometry.vertices_of(first);
                self.results.extend(faces.map(|listed| {
                    let Feature::VertexFace(vertex, _) = listed.feature else {
                        return Nearest::default();
                    };
                    to_wall(surface, vertices[usize::from(vertex)])
                }));
                return;
            }
        };
        let starts = [first, second].map(|body| shapes.places[body]);
        let out = self.results.len();
        let end = out + faces.len() + edges.len();
        self.jobs
            .extend(shapes, &starts, [faces, edges], out as u32);
        self.results.resize(end, Nearest::default());
    }

    /// Makes active what may touch within a few steps, for those pairs of the block that have used
    /// up their inner slack.
    #[inline(always)]
    pub fn choose<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        block: &mut Block<'_>,
    ) {
        if self.active.iter().all(|pair| pair.choose.is_none()) {
            return;
        }
        self.jobs.clear();
        self.results.clear();
        for number in 0..self.active.len() {
            if self.active[number].choose.is_none() {
                continue;
            }
            let pair = &block.pairs[self.active[number].pair as usize];
            self.active[number].results = self.results.len() as u32;
            let faces = pair.outer.partition_point(Listed::is_face);
            let (faces, edges) = pair.outer.split_at(faces);
            let kinds = [faces, edges].map(|kind| kind.iter().copied());
            self.queue(all, pair, kinds);
        }
        let places = &all.geometry.places;
        self.jobs
            .run::<N, false>(processor, places, &mut self.results);
        for number in 0..self.active.len() {
            if let Some(moved) = self.active[number].choose {
                self.activate(number, moved, block);
            }
        }
    }

    /// Makes active what may touch within a few steps of the measured features on the outer list of
    /// a pair; what they remember follows them. Whatever touched a step ago is among them: no pair
    /// moves that far in a step.
    fn activate(&mut self, number: usize, moved: f64, block: &mut Block<'_>) {
        let measured = self.active[number].results as usize;
        let own = self.active[number].pair as usize;
        let (pair, terms) = (&mut block.pairs[own], &block.terms[own]);
        let skin = (INNER_LIFE * moved).max(INNER_SKIN * terms.touch);
        let results = &self.results[measured..];
        let nearest = choose(&pair.outer, results, terms.touch + skin, &mut self.found);
        pair.inner_slack = nearest - terms.touch - f64::from(terms.margin);
        let old = &block.points[pair.points.range()];
        self.known.clear();
        self.known.extend_from_slice(old);
        let count = self.found.len();
        if count > pair.points.room as usize {
            let spare = ContactPoint::apart(self.found[0]);
            block.make_room(own, count, spare, &mut self.moved_points);
        }
        let points = &mut block.pairs[own].points;
        points.count = count as u32;
        points.faces = self.found.partition_point(Listed::is_face) as u32;
        let mut known = self.known.iter().peekable();
        for (point, listed) in block.points[points.range()].iter_mut().zip(&self.found) {
            while known
                .next_if(|old| old.listed.feature < listed.feature)
                .is_some()
            {}
            let same = known.next_if(|old| old.listed.feature == listed.feature);
            *point = ContactPoint {
                listed: *listed,
                ..same.copied().unwrap_or(ContactPoint::apart(*listed))
            };
        }
    }

    /// Measures the active features of the collected pairs.
    #[inline(always)]
    pub fn measure<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        block: &Block<'_>,
    ) {
        self.jobs.clear();
        self.results.clear();
        self.result_of.clear();
        for number in 0..self.active.len() {
            let pair = &block.pairs[self.active[number].pair as usize];
            self.active[number].results = self.results.len() as u32;
            let range = pair.points.range();
            let points = range.start as u32..range.end as u32;
            let pair_number = number as u32;
            let of_pair = points.map(|point| ResultOf {
                pair: pair_number,
                point,
            });
            self.result_of.extend(of_pair);
            let (faces, edges) = block.points[range].split_at(pair.points.faces as usize);
            let kinds = [faces, edges].map(|kind| kind.iter().map(|point| point.listed));
            self.queue(all, pair, kinds);
        }
        let places = &all.geometry.places;
        self.jobs
            .run::<N, false>(processor, places, &mut self.results);
    }

    /// Where the results of the active pair `number` are.
    #[inline(always)]
    pub fn results_of(&self, number: usize) -> Range<usize> {
        let next = self.active.get(number + 1);
        let end = next.map_or(self.results.len(), |next| next.results as usize);
        self.active[number].results as usize..end
    }
}

/// Lists in `found` the vertices of body `first` nearer to a wall than `touch` and `skin`; returns
/// how far it may move until the next time.
fn list_at_wall(
    all: &Surroundings<'_>,
    surface: &Surface,
    first: usize,
    [touch, skin]: [f64; 2],
    found: &mut Vec<Listed>,
) -> f64 {
    found.clear();
    let mut nearest = f64::INFINITY;
    for (vertex, place) in (0..).zip(all.geometry.vertices_of(first)) {
        let distance = surface.distance(vector(*place)).0;
        nearest = nearest.min(distance);
        if distance < touch + skin {
            found.push(Listed::face(Feature::VertexFace(vertex, 0), 0));
        }
    }
    skin.max(nearest - touch)
}
