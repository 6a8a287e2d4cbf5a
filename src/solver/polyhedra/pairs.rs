//! Pairs of bodies near each other, and what their contacts do.
//!
//! In: bodies and where their features are. Out: force and torques of every pair, its springs one step on. A pair lives as
//! long as its bodies are near each other; which of its features may touch is listed anew when the two have moved relative
//! to each other by the list's skin ([`super::listing`]), each pair in its own time, so that a crowd that moves as one
//! lists nothing. Of those listed the ones that may touch within a few steps are active: only they are measured.
//!
//! Pairs are worked on in blocks. What the active features of a block remember lies in one piece of memory, in order, a
//! cache line each: a step reads it from beginning to end.
//!
//! The contacts of a pair are summed in the order of their features: neither lists nor threads nor lanes show in a sum.

use super::super::contacts::WallBody;
use super::super::lanes::{
    Lanes, Quad, Row, Work, cross, dot, minus, plus, prefetch, side_by_side, times,
};
use super::super::law::{Hooke, Law};
use super::super::row::{length_squared, row, sub, vector};
use super::super::spring::{UNLOADED, stretch};
use super::bodies::{Body, Geometry};
use super::listing::{Listed, Search, Wanted, choose};
use super::nearest::{Jobs, Nearest, PARALLEL, group};
use crate::physics::FeatureRule;
use crate::world::{Feature, Surface};
use std::ops::Range;

/// Steps that a list is made to last at the pace at which its bodies move.
const LIFE: f64 = 60.0;
/// Bounds of a list's skin relative to the distance of cores at which the two touch.
const SKIN: std::ops::RangeInclusive<f64> = 0.01..=0.5;
/// Steps that a choice of active features is made to last.
const ACTIVE_LIFE: f64 = 10.0;
/// Smallest skin of active features relative to the distance at which the two touch.
const ACTIVE_SKIN: f64 = 1e-4;
/// What the speed of two bodies makes in a step is taken this much larger: more than its rounding.
const CAUTION: f64 = 1.01;
/// Two cores that come nearer than the rest of this share of the touching distance could pass through each other.
pub const DEEPEST: f64 = 0.8;
/// Pairs that are worked on in one go, whose active features lie together: enough to fill the lanes, few enough to stay in
/// the nearest cache.
pub const BLOCK: usize = 32;

/// Bodies are asked for so many pairs ahead.
const AHEAD: usize = 8;

/// Two bodies near each other: what is looked at in every step.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Pair {
    /// The grain on which the computed force acts.
    pub first: u32,
    /// The other grain; from the number of grains on, a wall.
    pub second: u32,
    /// How far the two may still move relative to each other until [`Self::near`] must be made anew [m].
    pub slack: f64,
    /// How far they may still move before anything else than what is active can touch [m].
    pub active_slack: f64,
    /// How far they may still move before anything active can touch; none where something does [m]. A pair is left
    /// out while it is positive: all of it is a bound, so that what is left out would have added nothing, to the bit.
    pub quiet: f64,
    /// Where the active features are among the spots of the block.
    pub active: Active,
    /// What may touch until the slack is used up, in the order of the features.
    pub near: Box<[Listed]>,
}

/// Where a pair's active features are among the spots of its block.
#[derive(Clone, Copy, Debug, Default)]
pub struct Active {
    start: u32,
    count: u32,
    /// How many of them are vertices with faces: they come before edges.
    faces: u32,
    room: u32,
}

impl Active {
    /// `own` spots that begin at `start`, with no room beyond.
    pub fn at(start: usize, own: &[Spot]) -> Self {
        Self {
            start: start as u32,
            count: own.len() as u32,
            faces: own.partition_point(|spot| spot.listed.is_face()) as u32,
            room: own.len() as u32,
        }
    }

    /// Its spots.
    #[inline(always)]
    pub fn spots(&self) -> Range<usize> {
        self.start as usize..(self.start + self.count) as usize
    }
}

/// What a pair's contacts depend on, and where to look for them first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct Terms {
    /// `K_n`, the normal dashpot `m_e γ_n`, `K_t`, μ.
    pub law: Row,
    /// Distance of cores at which the two touch: the sum of their rounding radii [m].
    pub touch: f64,
    /// Half the difference of the rounding radii [m].
    pub offset: f64,
    /// About the direction that parted the two best when they were last listed; zero when never.
    pub axis: [f32; 3],
    /// By how much a computed distance of two of their features may jump though they hardly move [m]: what is
    /// left of any slack is smaller by this.
    pub margin: f32,
}

/// What an active feature of a pair remembers: a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Spot {
    /// Its tangential spring [m], and the stiffness of its last stretch [N/m].
    pub spring: Row,
    /// Overlap, zero where it does not touch [m].
    pub overlap: f64,
    /// What the normal dashpot adds to the spring's push [N].
    pub dashpot: f64,
    /// Which features.
    pub listed: Listed,
}

impl Spot {
    /// Features that do not touch.
    const fn apart(listed: Listed) -> Self {
        Self {
            spring: UNLOADED,
            overlap: 0.0,
            dashpot: 0.0,
            listed,
        }
    }
}

/// What a pair does to its bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct Action {
    /// Force on the first [N]; 1 while the two touch, else 0.
    pub force: Row,
    /// Torque on the first [N m].
    pub first: Row,
    /// Torque on the second [N m].
    pub second: Row,
    /// Energy lost in dashpots, by springs (in sliding and as stiffness is shared anew), none in rolling, and done by a wall
    /// during the step [J].
    pub exchanged: Row,
}

/// What every pair's force depends on.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// Length of the step [s].
    pub dt: f64,
    /// Whether the features of a pair share its stiffness.
    pub rule: FeatureRule,
    /// Every grain.
    pub bodies: &'a [Body],
    /// Where their features are.
    pub geometry: Geometry<'a>,
    /// Every wall.
    pub walls: &'a [WallBody],
    /// The origin, and the velocity and the spin of every wall.
    pub wall_motions: &'a [[Row; 3]],
    /// Sizes that bound how far two bodies move in a step.
    pub extents: Extents,
}

/// Sizes that bound how far two bodies move relative to each other in a step, to the last bit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extents {
    /// Distance of any point of a body from the centroid of another that is near it, at most [m].
    pub between_grains: f64,
    /// Distance of any point of a body from the origin, about which walls move, at most [m].
    pub to_origin: f64,
    /// What rounding adds to the relative motion of two bodies in a step, at most [m].
    pub rounding: f64,
}

/// Roundings that a coordinate meets in a step and in the computation of a distance, generously counted, each of
/// half the distance of two neighbouring numbers of its size.
const ROUNDINGS: f64 = 32.0;

impl Extents {
    /// For bodies whose coordinates and those of the walls' points are at most `coordinate`, and whose points are at
    /// most `reach` from their centroids; pairs are nearer than their reaches and `skin` [m].
    pub fn new(coordinate: f64, reach: f64, skin: f64) -> Self {
        let to_origin = 2.0 * coordinate + reach + skin;
        Self {
            between_grains: 3.0 * reach + 2.0 * skin,
            to_origin,
            rounding: ROUNDINGS * f64::EPSILON * to_origin,
        }
    }

    /// How much a computed distance of features of two bodies may jump, the first of which reaches to `reach`, that
    /// touch at `touch` and whose faces are as `uneven` [m]. Edges change from crossing to parallel where their
    /// sine is that of [`PARALLEL`]; a vertex leaves a face across an edge that is not quite in its plane.
    pub fn margin(&self, reach: f64, touch: f64, uneven: f64) -> f32 {
        let parallel = 2.0 * PARALLEL * reach * reach / touch;
        let margin = 4.0 * (parallel + uneven + self.rounding);
        margin as f32
    }
}

/// How the bodies of a pair move relative to each other.
struct Relative {
    /// Velocity of the first relative to the second at the first's centroid [m/s].
    velocity: Row,
    /// Relative spin [rad/s].
    spin: Row,
    /// How far a point of the first has come in this step, seen from the second, at most [m].
    moved: f64,
}

/// A pair on its way through a block.
#[derive(Clone, Copy, Default)]
struct Span {
    /// Velocity of the first relative to the second at the first's centroid [m/s]; part of the pair's stiffness that each
    /// contact has.
    velocity: Row,
    /// Relative spin [rad/s]; the part that each contact had a step ago.
    spin: Row,
    /// Centroid of the first [m]; half the difference of the rounding radii [m].
    centre: Row,
    /// Number of the pair in the block.
    pair: u32,
    /// Where its results begin.
    results: u32,
    /// By how much it moved in this step, where its active features are to be chosen [m].
    choose: Option<f64>,
    /// What the normal springs store more than a step ago, where they share their stiffness [J].
    stored: f64,
    /// Whether anything touches.
    touches: bool,
}

/// Where the span and the spot of a result are.
#[derive(Clone, Copy)]
struct Place {
    span: u32,
    spot: u32,
}

/// What a contact does.
#[derive(Clone, Copy, Default)]
struct Effect {
    force: Row,
    moment: Row,
    /// Energy lost in the dashpot, by the tangential spring, and put into the normal spring [J].
    energy: Row,
}

/// What one member of the team needs again and again.
#[derive(Default)]
pub struct Desk {
    search: Search,
    found: Vec<Listed>,
    known: Vec<Spot>,
    moved_spots: Vec<Spot>,
    spans: Vec<Span>,
    jobs: Jobs,
    results: Vec<Nearest>,
    places: Vec<Place>,
    effects: Vec<Effect>,
}

/// What came of a range of pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Lists made.
    pub listed: u64,
    /// Two cores came too near each other.
    pub fault: bool,
}

/// The forces of a range of pairs: whole blocks, but for the last.
pub struct Forces<'a> {
    /// What they depend on.
    pub surroundings: Surroundings<'a>,
    /// The pairs.
    pub pairs: &'a mut [Pair],
    /// What their contacts depend on.
    pub terms: &'a mut [Terms],
    /// What the active features of each block remember.
    pub spots: &'a mut [Vec<Spot>],
    /// What the pairs do; of those that do nothing, whatever they did before.
    pub actions: &'a mut [Action],
    /// Whether they do anything.
    pub busy: &'a mut [bool],
    /// Room to work in.
    pub desk: &'a mut Desk,
}

/// A block of pairs.
struct Block<'a> {
    pairs: &'a mut [Pair],
    terms: &'a mut [Terms],
    spots: &'a mut Vec<Spot>,
}

impl Work for Forces<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        let Self {
            surroundings: all,
            pairs,
            terms,
            spots,
            actions,
            busy,
            desk,
        } = self;
        let mut outcome = Outcome::default();
        busy.fill(false);
        let blocks = pairs.chunks_mut(BLOCK).zip(terms.chunks_mut(BLOCK));
        let effects = actions.chunks_mut(BLOCK).zip(busy.chunks_mut(BLOCK));
        for (((pairs, terms), spots), (actions, busy)) in blocks.zip(spots).zip(effects) {
            let mut block = Block {
                pairs,
                terms,
                spots,
            };
            outcome.listed += desk.gather::<N>(processor, &all, &mut block);
            desk.choose::<N>(processor, &all, &mut block);
            desk.measure::<N>(processor, &all, &block);
            outcome.fault |= desk.weigh(&all, &mut block);
            desk.press::<N>(processor, all.dt, &mut block);
            desk.sum(&all, &block, actions, busy);
        }
        outcome
    }
}

#[inline(always)]
fn crossed(a: Row, b: Row) -> Row {
    let [x, y, z] = cross_product([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
    [x, y, z, 0.0]
}

#[inline(always)]
fn cross_product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl Surroundings<'_> {
    /// The wall that is the second side of `pair`, if it is one.
    #[inline(always)]
    fn wall(&self, pair: &Pair) -> Option<&WallBody> {
        let wall = (pair.second as usize).checked_sub(self.bodies.len())?;
        Some(&self.walls[wall])
    }

    /// Position, velocity and spin of a side of a pair; a wall moves about the origin.
    #[inline(always)]
    fn motion(&self, side: u32) -> [&Row; 3] {
        match (side as usize).checked_sub(self.bodies.len()) {
            None => {
                let body = &self.bodies[side as usize];
                [&body.position, &body.velocity, &body.spin]
            }
            Some(wall) => self.wall_motions[wall].each_ref(),
        }
    }

    /// Asks for the second side of `pair`.
    #[inline(always)]
    fn fetch(&self, pair: &Pair) {
        if let Some(body) = self.bodies.get(pair.second as usize) {
            prefetch::<_, 3>(std::slice::from_ref(body));
        }
    }

    /// How the two move relative to each other.
    ///
    /// With velocities `v`, spins `ω` and centroids `x` at the end of the step, a point of the first at `y` from its
    /// centroid has moved by `Δt (v₁ − v₂ − ω₂ × (x₁ − x₂) + (ω₁ − ω₂) × y)` seen from the second, but for terms of
    /// second order: each body turns on a circle (`½ (ω Δt)²` of the distance from its centroid), its spin changes
    /// by `ω² Δt` at most where its momentum stays, and `x₁ − x₂` changes during the step. Together they are less
    /// than `3 Δt² (ω₁² + ω₂²) a + Δt² v²/a`, `a` being no smaller than any of these distances.
    #[inline(always)]
    fn relative(&self, pair: &Pair) -> Relative {
        let first = &self.bodies[pair.first as usize];
        let [position, velocity, other_spin] = self.motion(pair.second);
        let turning = crossed(*other_spin, sub(first.position, *position));
        let velocity = sub(sub(first.velocity, *velocity), turning);
        let (reach, spin) = (first.spin[3], sub(first.spin, *other_spin));
        let arm = if (pair.second as usize) < self.bodies.len() {
            self.extents.between_grains
        } else {
            self.extents.to_origin
        };
        let speed_squared = length_squared(velocity);
        let spins_squared = length_squared(first.spin) + length_squared(*other_spin);
        let pace = speed_squared.sqrt() + length_squared(spin).sqrt() * reach;
        let bend = 3.0 * spins_squared * arm + speed_squared / arm;
        Relative {
            velocity,
            spin,
            moved: self.dt * (CAUTION * pace + self.dt * bend) + self.extents.rounding,
        }
    }
}

impl Block<'_> {
    /// Gives the pair `wanted` room for `count` active features, more than it has; the new spots are `spare` ones.
    fn make_room(&mut self, wanted: usize, count: usize, spare: Spot, room: &mut Vec<Spot>) {
        room.clear();
        for (number, pair) in self.pairs.iter_mut().enumerate() {
            let (old, start) = (pair.active.spots(), room.len());
            let needed = if number == wanted { count } else { old.len() };
            room.extend_from_slice(&self.spots[old]);
            room.resize(start + needed + needed / 8, spare);
            pair.active.start = start as u32;
            pair.active.room = (room.len() - start) as u32;
        }
        self.spots.clear();
        self.spots.reserve_exact(room.len());
        self.spots.extend_from_slice(room);
    }
}

impl Desk {
    /// Collects the pairs of a block whose features are to be measured; lists anew those that have used up their slack, and
    /// returns how many these are.
    #[inline(always)]
    fn gather<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        block: &mut Block<'_>,
    ) -> u64 {
        let mut listed = 0;
        self.spans.clear();
        for index in 0..block.pairs.len() {
            if let Some(ahead) = block.pairs.get(index + AHEAD) {
                all.fetch(ahead);
            }
            let pair = &mut block.pairs[index];
            let relative = all.relative(pair);
            let moved = relative.moved;
            pair.slack -= moved;
            pair.active_slack -= moved;
            pair.quiet -= moved;
            if pair.slack < 0.0 {
                listed += 1;
                self.list::<N>(processor, all, moved, pair, &mut block.terms[index]);
            }
            let choose = pair.active_slack < 0.0;
            if !choose && pair.quiet > 0.0 {
                continue;
            }
            prefetch::<_, 16>(&block.spots[pair.active.spots()]);
            if (pair.second as usize) < all.bodies.len() {
                all.geometry.fetch(pair.second as usize);
            }
            let [vx, vy, vz, _] = relative.velocity;
            let [wx, wy, wz, _] = relative.spin;
            let [x, y, z, _] = all.bodies[pair.first as usize].position;
            self.spans.push(Span {
                velocity: [vx, vy, vz, 1.0],
                spin: [wx, wy, wz, 1.0],
                centre: [x, y, z, block.terms[index].offset],
                pair: index as u32,
                choose: choose.then_some(moved),
                ..Span::default()
            });
        }
        listed
    }

    /// Makes the list of `pair`, which has `moved` by so much in this step, anew.
    #[inline(always)]
    fn list<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        moved: f64,
        pair: &mut Pair,
        terms: &mut Terms,
    ) {
        let skin = (LIFE * moved).clamp(SKIN.start() * terms.touch, SKIN.end() * terms.touch);
        let slack = if let Some(wall) = all.wall(pair) {
            let (first, reach) = (pair.first as usize, [terms.touch, skin]);
            list_at_wall(all, &wall.surface, first, reach, &mut self.found)
        } else {
            let wanted = Wanted {
                bodies: [pair.first as usize, pair.second as usize],
                axis: terms.axis.map(f64::from),
                reach: all.bodies[pair.first as usize].spin[3],
                touch: terms.touch,
                skin,
            };
            let found = self
                .search
                .run::<N>(processor, &all.geometry, &wanted, &mut self.found);
            terms.axis = found.axis.map(|x| x as f32);
            found.slack
        };
        pair.slack = slack - f64::from(terms.margin);
        pair.near = self.found.as_slice().into();
        pair.active_slack = -1.0;
    }

    /// Measures features of a pair with a wall, or has them measured.
    #[inline(always)]
    fn queue(
        &mut self,
        all: &Surroundings<'_>,
        pair: &Pair,
        [faces, edges]: [impl ExactSizeIterator<Item = Listed>; 2],
    ) {
        let shapes = all.geometry.shapes;
        if let Some(wall) = all.wall(pair) {
            let vertices = all.geometry.vertices_of(pair.first as usize);
            self.results.extend(faces.map(|listed| {
                let Feature::VertexFace(vertex, _) = listed.feature else {
                    return Nearest::default();
                };
                to_wall(&wall.surface, vertices[usize::from(vertex)])
            }));
            return;
        }
        let starts = [pair.first, pair.second].map(|body| shapes.places[body as usize]);
        let out = self.results.len();
        let end = out + faces.len() + edges.len();
        self.jobs
            .extend(shapes, &starts, [faces, edges], out as u32);
        self.results.resize(end, Nearest::default());
    }

    /// Makes active what may touch within a few steps, for those pairs of the block that have used up their active slack.
    #[inline(always)]
    fn choose<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        block: &mut Block<'_>,
    ) {
        if self.spans.iter().all(|span| span.choose.is_none()) {
            return;
        }
        self.jobs.clear();
        self.results.clear();
        for number in 0..self.spans.len() {
            if self.spans[number].choose.is_none() {
                continue;
            }
            let pair = &block.pairs[self.spans[number].pair as usize];
            self.spans[number].results = self.results.len() as u32;
            let faces = pair.near.partition_point(Listed::is_face);
            let (faces, edges) = pair.near.split_at(faces);
            let kinds = [faces, edges].map(|kind| kind.iter().copied());
            self.queue(all, pair, kinds);
        }
        let places = &all.geometry.places;
        self.jobs
            .run::<N, false>(processor, places, &mut self.results);
        for number in 0..self.spans.len() {
            if let Some(moved) = self.spans[number].choose {
                self.activate(number, moved, block);
            }
        }
    }

    /// Makes active what may touch within a few steps of the measured near features of a pair; what they remember follows
    /// them. Whatever touched a step ago is among them: no pair moves that far in a step.
    fn activate(&mut self, number: usize, moved: f64, block: &mut Block<'_>) {
        let span = &self.spans[number];
        let own = span.pair as usize;
        let (pair, terms) = (&mut block.pairs[own], &block.terms[own]);
        let skin = (ACTIVE_LIFE * moved).max(ACTIVE_SKIN * terms.touch);
        let results = &self.results[span.results as usize..];
        let nearest = choose(&pair.near, results, terms.touch + skin, &mut self.found);
        pair.active_slack = nearest - terms.touch - f64::from(terms.margin);
        let old = &block.spots[pair.active.spots()];
        self.known.clear();
        self.known.extend_from_slice(old);
        let count = self.found.len();
        if count > pair.active.room as usize {
            let spare = Spot::apart(self.found[0]);
            block.make_room(own, count, spare, &mut self.moved_spots);
        }
        let active = &mut block.pairs[own].active;
        active.count = count as u32;
        active.faces = self.found.partition_point(Listed::is_face) as u32;
        let mut known = self.known.iter().peekable();
        for (spot, listed) in block.spots[active.spots()].iter_mut().zip(&self.found) {
            while known
                .next_if(|old| old.listed.feature < listed.feature)
                .is_some()
            {}
            let same = known.next_if(|old| old.listed.feature == listed.feature);
            *spot = Spot {
                listed: *listed,
                ..same.copied().unwrap_or(Spot::apart(*listed))
            };
        }
    }

    /// Measures the active features of the collected pairs.
    #[inline(always)]
    fn measure<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        block: &Block<'_>,
    ) {
        self.jobs.clear();
        self.results.clear();
        self.places.clear();
        for number in 0..self.spans.len() {
            let pair = &block.pairs[self.spans[number].pair as usize];
            self.spans[number].results = self.results.len() as u32;
            let range = pair.active.spots();
            let spots = range.start as u32..range.end as u32;
            let span = number as u32;
            self.places.extend(spots.map(|spot| Place { span, spot }));
            let (faces, edges) = block.spots[range].split_at(pair.active.faces as usize);
            let kinds = [faces, edges].map(|kind| kind.iter().map(|spot| spot.listed));
            self.queue(all, pair, kinds);
        }
        let places = &all.geometry.places;
        self.jobs
            .run::<N, false>(processor, places, &mut self.results);
    }

    /// Where the results of the span `number` are.
    #[inline(always)]
    fn results_of(&self, number: usize) -> Range<usize> {
        let next = self.spans.get(number + 1);
        let end = next.map_or(self.results.len(), |next| next.results as usize);
        self.spans[number].results as usize..end
    }

    /// Finds the overlaps, how they share the stiffness, and how far nothing touches yet. True where two cores are so near
    /// each other that they might pass through.
    #[inline(always)]
    fn weigh(&mut self, all: &Surroundings<'_>, block: &mut Block<'_>) -> bool {
        let mut fault = false;
        for number in 0..self.spans.len() {
            let range = self.results_of(number);
            let (span, results) = (&mut self.spans[number], &mut self.results[range]);
            let own = span.pair as usize;
            let (pair, terms) = (&mut block.pairs[own], &block.terms[own]);
            let (mut deepest, mut hidden) = (f64::NEG_INFINITY, false);
            for result in results.iter_mut() {
                let overlap = terms.touch - result.normal[3];
                result.middle[3] = overlap;
                deepest = if overlap > deepest { overlap } else { deepest };
                hidden |= overlap == f64::NEG_INFINITY;
            }
            span.touches = deepest > 0.0;
            // A vertex behind a face may come round its edge at any time.
            pair.quiet = if span.touches || hidden {
                0.0
            } else {
                -deepest - f64::from(terms.margin)
            };
            fault |= deepest > DEEPEST * terms.touch && !all.has_sides(pair);
            if all.rule == FeatureRule::Shared {
                let spots = &block.spots[pair.active.spots()];
                let before = Sums::of(spots.iter().map(|spot| spot.overlap));
                let now = Sums::of(results.iter().map(|result| result.middle[3]));
                (span.spin[3], span.velocity[3]) = (before.part(), now.part());
                span.stored = 0.5 * terms.law[0] * (now.shared() - before.shared());
            }
        }
        fault
    }

    /// The contact law of every active feature of the block.
    #[inline(always)]
    fn press<N: Lanes>(&mut self, processor: N::Processor, dt: f64, block: &mut Block<'_>) {
        let (terms, spots) = (&*block.terms, &mut *block.spots);
        self.effects.resize(self.results.len(), Effect::default());
        let zero = N::splat(processor, 0.0);
        let step = N::splat(processor, dt);
        let half = N::splat(processor, 0.5);
        let half_step = N::splat(processor, 0.5 * dt);
        let outputs = self.effects.chunks_mut(N::COUNT);
        let results = self.results.chunks(N::COUNT);
        for ((places, results), effects) in self.places.chunks(N::COUNT).zip(results).zip(outputs) {
            let all = group::<N, _>(places);
            let span = side_by_side::<N, _>(|k| &self.spans[all[k].span as usize]);
            let result = group::<N, _>(results);
            let spot = side_by_side::<N, _>(|k| &spots[all[k].spot as usize]);
            let before = side_by_side::<N, _>(|k| [spot[k].overlap, spot[k].dashpot, 0.0, 0.0]);
            let [nx, ny, nz, _] = N::gather(processor, side_by_side::<N, _>(|k| &result[k].normal));
            let normal = [nx, ny, nz];
            let [mx, my, mz, depth] =
                N::gather(processor, side_by_side::<N, _>(|k| &result[k].middle));
            let [cx, cy, cz, offset] =
                N::gather(processor, side_by_side::<N, _>(|k| &span[k].centre));
            let [vx, vy, vz, part] =
                N::gather(processor, side_by_side::<N, _>(|k| &span[k].velocity));
            let [wx, wy, wz, part_before] =
                N::gather(processor, side_by_side::<N, _>(|k| &span[k].spin));
            let [normal_stiffness, damping, tangential_stiffness, friction] = N::gather(
                processor,
                side_by_side::<N, _>(|k| &terms[span[k].pair as usize].law),
            );
            let [overlap_before, dashpot_before, ..] =
                N::gather(processor, side_by_side::<N, _>(|k| &before[k]));
            let touching = depth.exceeds(zero);
            let overlap = N::choose(touching, depth, zero);
            let arm = plus(minus([mx, my, mz], [cx, cy, cz]), times(normal, offset));
            let velocity = plus([vx, vy, vz], cross([wx, wy, wz], arm));
            let approach = dot(velocity, normal);
            let elastic = normal_stiffness * part * overlap;
            let damped = N::choose(touching, damping * part * approach, zero);
            let repulsion = Hooke::default().normal_force(elastic, damped, zero);
            let slip = minus(velocity, times(normal, approach));
            let stiffness = N::choose(touching, tangential_stiffness * part, zero);
            let stretched = stretch::<N>(
                processor,
                side_by_side::<N, _>(|k| &spot[k].spring),
                times(slip, step),
                normal,
                touching,
                stiffness,
                friction * Hooke::default().coulomb_force(elastic, repulsion, zero),
            );
            let force = minus(
                times(stretched.spring, -stiffness),
                times(normal, repulsion),
            );
            let moment = cross(arm, force);
            // The mean of the old and the new push, along the way from one to the other.
            let dashpot = repulsion - elastic;
            let in_dashpot = half_step * ((dashpot_before + dashpot) * approach);
            let elastic_before = normal_stiffness * part_before * overlap_before;
            let pressed = half * ((elastic_before + elastic) * (overlap - overlap_before));
            let forces = N::rows([force[0], force[1], force[2], overlap]);
            let moments = N::rows([moment[0], moment[1], moment[2], dashpot]);
            let energies = N::rows([in_dashpot, stretched.lost, pressed, zero]);
            for (k, (effect, place)) in effects.iter_mut().zip(places).enumerate() {
                effect.force = forces[k].row();
                effect.moment = moments[k].row();
                effect.energy = energies[k].row();
                let spot = &mut spots[place.spot as usize];
                spot.spring = stretched.rows[k].row();
                spot.overlap = effect.force[3];
                spot.dashpot = effect.moment[3];
            }
        }
    }

    /// Sums what the contacts of each collected pair do.
    #[inline(always)]
    fn sum(
        &self,
        all: &Surroundings<'_>,
        block: &Block<'_>,
        actions: &mut [Action],
        busy: &mut [bool],
    ) {
        for (number, span) in self.spans.iter().enumerate() {
            let pair = span.pair as usize;
            let effects = &self.effects[self.results_of(number)];
            let action = all.action(&block.pairs[pair], span, effects);
            let exchanges = action.exchanged != [0.0; 4];
            if span.touches || exchanges {
                actions[pair] = action;
                busy[pair] = true;
            }
        }
    }
}

/// Sums over the overlaps of a pair's contacts.
#[derive(Default)]
struct Sums {
    overlaps: f64,
    squares: f64,
}

impl Sums {
    /// Those of `overlaps`, of which negative ones do not count.
    fn of(overlaps: impl Iterator<Item = f64>) -> Self {
        let touching = overlaps.filter(|overlap| *overlap > 0.0);
        touching.fold(Self::default(), |sums, overlap| Self {
            overlaps: sums.overlaps + overlap,
            squares: sums.squares + overlap * overlap,
        })
    }

    /// The part of the pair's stiffness that each contact has where they share it.
    fn part(&self) -> f64 {
        if self.overlaps > 0.0 {
            self.squares / (self.overlaps * self.overlaps)
        } else {
            1.0
        }
    }

    /// The sum of the squares, each with its part of the stiffness.
    fn shared(&self) -> f64 {
        self.part() * self.squares
    }
}

impl Surroundings<'_> {
    /// Whether the second side of `pair` knows which side of it is which, however deep a body sinks: a plane and the inside
    /// of a drum do.
    #[inline(always)]
    fn has_sides(&self, pair: &Pair) -> bool {
        self.wall(pair).is_some_and(|wall| match wall.surface {
            Surface::Plane { .. } | Surface::Cylinder { .. } => true,
            Surface::Tube { .. } => false,
        })
    }

    /// What `pair` does, from the `effects` of its active features: nothing where they do not touch.
    #[inline(always)]
    fn action(&self, pair: &Pair, span: &Span, effects: &[Effect]) -> Action {
        let mut action = Action::default();
        let mut pressed = 0.0;
        for effect in effects {
            for axis in 0..3 {
                action.force[axis] += effect.force[axis];
                action.first[axis] += effect.moment[axis];
            }
            action.exchanged[0] += effect.energy[0];
            action.exchanged[1] += effect.energy[1];
            pressed += effect.energy[2];
        }
        if self.rule == FeatureRule::Shared {
            // Stiffness that is shared anew is no potential's: what it takes or gives is booked with the springs.
            action.exchanged[1] += pressed - span.stored;
        }
        let [second, ..] = self.motion(pair.second);
        let across = crossed(sub(span.centre, *second), action.force);
        for axis in 0..3 {
            action.second[axis] = -action.first[axis] - across[axis];
        }
        if let Some(wall) = self.wall(pair) {
            let force = vector(action.force).dot(wall.motion.velocity);
            let torque = -vector(action.second).dot(wall.motion.spin);
            action.exchanged[3] = self.dt * (force + torque);
        }
        action.force[3] = if span.touches { 1.0 } else { 0.0 };
        action
    }
}

/// Lists in `found` the vertices of body `first` nearer to a wall than `touch` and `skin`; returns how far it may move until
/// the next time.
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

/// The point of a wall nearest to a vertex.
#[inline(always)]
pub fn to_wall(surface: &Surface, vertex: Row) -> Nearest {
    let place = vector(vertex);
    let (distance, direction) = surface.distance(place);
    Nearest {
        normal: row(direction, distance),
        middle: row(place + 0.5 * distance * direction, 0.0),
    }
}
