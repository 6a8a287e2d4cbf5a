//! Pairs of bodies near each other, and what their contacts do.
//!
//! In: bodies and where their features are. Out: force and torques of every pair, its springs one step on. A pair lives as
//! long as its bodies are near each other; which of its features may touch is listed anew when the two have moved relative
//! to each other by the list's skin ([`super::listing`]), each pair in its own time, so that a crowd that moves as one
//! lists nothing.
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
use super::listing::{List, Search, Wanted};
use super::nearest::{Jobs, Nearest, group};
use crate::scene::FeatureRule;
use crate::world::{Feature, Surface};

/// Steps that a list is made to last at the pace at which its bodies move.
const LIFE: f64 = 60.0;
/// Bounds of a list's skin relative to the distance of cores at which the two touch.
const SKIN: std::ops::RangeInclusive<f64> = 0.01..=0.5;
/// Steps that a choice of active features is made to last.
const ACTIVE_LIFE: f64 = 10.0;
/// Smallest skin of active features relative to the distance at which the two touch.
const ACTIVE_SKIN: f64 = 1e-4;
/// Bodies are taken to move by so much more than their velocities say.
const CAUTION: f64 = 1.05;
/// Two cores that come nearer than the rest of this share of the touching distance could pass through each other.
pub const DEEPEST: f64 = 0.8;
/// Features that are measured in one go: enough to fill the lanes, few enough to stay in the nearest cache.
const BATCH: usize = 192;

/// Two bodies near each other: what is looked at in every step.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Pair {
    /// The grain on which the computed force acts.
    pub first: u32,
    /// The other grain; from the number of grains on, a wall.
    pub second: u32,
    /// Distance of cores at which the two touch: the sum of their rounding radii [m].
    pub touch: f64,
    /// How far the two may still move relative to each other until [`Memory::near`] must be made anew [m].
    pub slack: f64,
    /// How far they may still move before anything else than what is active can touch [m].
    pub active_slack: f64,
    /// How far they may still move before anything active can touch; none where something does [m].
    pub quiet: f64,
    /// What it remembers.
    pub memory: Box<Memory>,
}

/// What a pair remembers, what is looked at in most steps first.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Memory {
    /// `K_n`, the normal dashpot `m_e γ_n`, `K_t`, μ.
    pub law: Row,
    /// Half the difference of the rounding radii [m].
    pub offset: f64,
    /// What may touch before long.
    pub active: List,
    /// Tangential spring of each active feature [m], and the stiffness of its last stretch [N/m].
    pub springs: Vec<Row>,
    /// Overlap of each, zero where it does not touch [m].
    pub overlaps: Vec<f64>,
    /// What the normal springs store, where they share their stiffness [J].
    pub stored: f64,
    /// The direction that parted the two best when `near` was last made; zero when never.
    pub axis: Row,
    /// What may touch until the slack is used up.
    pub near: List,
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
}

/// How the bodies of a pair move relative to each other.
#[derive(Clone, Copy, Default)]
struct Relative {
    /// Velocity of the first relative to the second at the first's centroid [m/s].
    velocity: Row,
    /// Relative spin [rad/s].
    spin: Row,
    /// Centroid of the second; of a wall, the origin [m].
    second: Row,
}

/// A pair on its way through a batch.
#[derive(Clone, Copy, Default)]
struct Span {
    /// Velocity of the first relative to the second at the first's centroid [m/s]; part of the pair's stiffness that each
    /// contact has.
    velocity: Row,
    /// Relative spin [rad/s].
    spin: Row,
    /// Centroid of the first [m]; half the difference of the rounding radii [m].
    centre: Row,
    /// As [`Memory::law`].
    law: Row,
    /// Centroid of the second; of a wall, the origin [m].
    second: Row,
    /// Number of the pair.
    pair: usize,
    /// Where its results begin.
    results: usize,
    /// Where its contacts begin.
    contacts: usize,
    /// By how much it moved in this step, where its active features are to be chosen [m].
    choose: Option<f64>,
    /// What the springs stored that lost their contact in this step [J].
    released: f64,
}

/// A contact on its way through a batch: where its span and its result are, and its number among the active features.
#[derive(Clone, Copy)]
struct Touch {
    span: u32,
    result: u32,
    slot: u32,
}

/// What a contact does.
#[derive(Clone, Copy, Default)]
struct Effect {
    force: Row,
    moment: Row,
    energy: Row,
}

/// What one member of the team needs again and again.
#[derive(Default)]
pub struct Desk {
    search: Search,
    found: List,
    old_features: Vec<Feature>,
    old_springs: Vec<Row>,
    numbers: Vec<u32>,
    spans: Vec<Span>,
    jobs: Jobs,
    results: Vec<Nearest>,
    touching: Vec<Touch>,
    /// The springs of what touches.
    springs: Vec<Row>,
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

/// The forces of a range of pairs.
pub struct Forces<'a> {
    /// What they depend on.
    pub surroundings: Surroundings<'a>,
    /// The pairs.
    pub pairs: &'a mut [Pair],
    /// What they do; of those that do nothing, whatever they did before.
    pub actions: &'a mut [Action],
    /// Whether they do anything.
    pub busy: &'a mut [bool],
    /// Room to work in.
    pub desk: &'a mut Desk,
}

impl Work for Forces<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        let Self {
            surroundings: all,
            pairs,
            actions,
            busy,
            desk,
        } = self;
        let mut outcome = Outcome::default();
        busy.fill(false);
        desk.clear();
        for index in 0..pairs.len() {
            fetch_ahead(pairs, index);
            let pair = &mut pairs[index];
            let relative = all.relative(pair);
            let moved = CAUTION * all.dt * pace(&relative, all.bodies[pair.first as usize].spin[3]);
            pair.slack -= moved;
            pair.active_slack -= moved;
            pair.quiet -= moved;
            if pair.slack < 0.0 {
                outcome.listed += 1;
                desk.list::<N>(processor, &all, moved, pair);
            }
            let choose = pair.active_slack < 0.0;
            if !choose && pair.quiet > 0.0 {
                continue;
            }
            desk.queue(&all, pair, &relative, index, choose.then_some(moved));
            if desk.results.len() >= BATCH {
                outcome.fault |= desk.finish::<N>(processor, &all, pairs, actions, busy);
            }
        }
        outcome.fault |= desk.finish::<N>(processor, &all, pairs, actions, busy);
        outcome
    }
}

/// Asks for what the pairs after `index` remember: it lies scattered in memory.
#[inline(always)]
fn fetch_ahead(pairs: &[Pair], index: usize) {
    const FAR: usize = 12;
    const NEAR: usize = 6;
    let wanted = |ahead: usize| pairs.get(index + ahead).filter(|pair| pair.quiet <= 0.0);
    if let Some(pair) = wanted(FAR) {
        prefetch::<_, 4>(std::slice::from_ref(&*pair.memory));
    }
    if let Some(pair) = wanted(NEAR) {
        let memory = &pair.memory;
        let jobs = &memory.active.jobs;
        prefetch::<_, 2>(&jobs.above);
        prefetch::<_, 2>(&jobs.outlines);
        prefetch::<_, 2>(&jobs.sides);
        prefetch::<_, 3>(&jobs.edges);
        prefetch::<_, 2>(&memory.overlaps);
        prefetch::<_, 8>(&memory.springs);
    }
}

/// A speed that no point of the first body, `reach` from its centroid at most, exceeds relative to the second [m/s].
#[inline(always)]
fn pace(relative: &Relative, reach: f64) -> f64 {
    length_squared(relative.velocity).sqrt() + length_squared(relative.spin).sqrt() * reach
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

    /// Position, velocity and spin of the second side; a wall moves about the origin.
    #[inline(always)]
    fn second(&self, pair: &Pair) -> [Row; 3] {
        if let Some(wall) = self.wall(pair) {
            return [
                [0.0; 4],
                row(wall.motion.velocity, 0.0),
                row(wall.motion.spin, 0.0),
            ];
        }
        let body = &self.bodies[pair.second as usize];
        [body.position, body.velocity, body.spin]
    }

    /// How the two move relative to each other.
    #[inline(always)]
    fn relative(&self, pair: &Pair) -> Relative {
        let first = &self.bodies[pair.first as usize];
        let [position, velocity, spin] = self.second(pair);
        let turning = crossed(spin, sub(first.position, position));
        Relative {
            velocity: sub(sub(first.velocity, velocity), turning),
            spin: sub(first.spin, spin),
            second: position,
        }
    }
}

impl Desk {
    fn clear(&mut self) {
        self.spans.clear();
        self.jobs.clear();
        self.results.clear();
        self.touching.clear();
        self.springs.clear();
    }

    /// Makes the list of `pair`, which has `moved` by so much in this step, anew; springs follow their features.
    #[inline(always)]
    fn list<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        moved: f64,
        pair: &mut Pair,
    ) {
        let skin = (LIFE * moved).clamp(SKIN.start() * pair.touch, SKIN.end() * pair.touch);
        pair.slack = if let Some(wall) = all.wall(pair) {
            list_at_wall(all, &wall.surface, skin, pair)
        } else {
            let wanted = Wanted {
                bodies: [pair.first as usize, pair.second as usize],
                axis: pair.memory.axis,
                touch: pair.touch,
                skin,
            };
            let found = self
                .search
                .run::<N>(processor, &all.geometry, &wanted, &mut self.found);
            let memory = &mut *pair.memory;
            memory.near.copy(&self.found);
            memory.axis = found.axis;
            found.slack
        };
        pair.active_slack = -1.0;
    }

    /// Puts a pair's features into the batch: the near ones where its active features are to be chosen, else those.
    #[inline(always)]
    fn queue(
        &mut self,
        all: &Surroundings<'_>,
        pair: &Pair,
        relative: &Relative,
        index: usize,
        choose: Option<f64>,
    ) {
        let memory = &pair.memory;
        let list = if choose.is_some() {
            &memory.near
        } else {
            &memory.active
        };
        let results = self.results.len();
        if let Some(wall) = all.wall(pair) {
            let vertices = all.geometry.vertices_of(pair.first as usize);
            self.results.extend(list.features.iter().map(|feature| {
                let Feature::VertexFace(vertex, _) = feature else {
                    return Nearest::default();
                };
                to_wall(&wall.surface, vertices[usize::from(*vertex)])
            }));
        } else {
            self.jobs.extend(&list.jobs, results as u32);
            let end = results + list.features.len();
            self.results.resize(end, Nearest::default());
        }
        let [vx, vy, vz, _] = relative.velocity;
        let [cx, cy, cz, _] = all.bodies[pair.first as usize].position;
        self.spans.push(Span {
            velocity: [vx, vy, vz, 1.0],
            spin: relative.spin,
            centre: [cx, cy, cz, memory.offset],
            law: memory.law,
            second: relative.second,
            pair: index,
            results,
            choose,
            ..Span::default()
        });
    }

    /// Does what the batch holds and empties it. True where two cores came too near each other.
    #[inline(always)]
    fn finish<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        pairs: &mut [Pair],
        actions: &mut [Action],
        busy: &mut [bool],
    ) -> bool {
        let places = &all.geometry.places;
        self.jobs
            .run::<N, false>(processor, places, &mut self.results);
        let mut fault = false;
        for number in 0..self.spans.len() {
            let pair = &mut pairs[self.spans[number].pair];
            fault |= self.find_touching(all, number, pair);
        }
        self.effects.clear();
        self.effects.resize(self.touching.len(), Effect::default());
        self.press::<N>(processor, all.dt);
        for (number, span) in self.spans.iter().enumerate() {
            let next = self.spans.get(number + 1);
            let contacts = span.contacts..next.map_or(self.touching.len(), |next| next.contacts);
            if contacts.is_empty() && span.released == 0.0 {
                continue;
            }
            let pair = &mut pairs[span.pair];
            let touching = self.touching[contacts.clone()].iter();
            for (touch, spring) in touching.zip(&self.springs[contacts.clone()]) {
                pair.memory.springs[touch.slot as usize] = *spring;
            }
            actions[span.pair] = all.action(pair, span, &self.effects[contacts]);
            busy[span.pair] = true;
        }
        self.clear();
        fault
    }

    /// Makes active what may touch within a few steps of the measured near features of a pair; springs follow their
    /// features.
    #[inline(always)]
    fn activate(&mut self, number: usize, moved: f64, pair: &mut Pair) {
        let span = &mut self.spans[number];
        let skin = (ACTIVE_LIFE * moved).max(ACTIVE_SKIN * pair.touch);
        let memory = &mut *pair.memory;
        std::mem::swap(&mut self.old_features, &mut memory.active.features);
        std::mem::swap(&mut self.old_springs, &mut memory.springs);
        let results = &mut self.results[span.results..];
        let cutoff = pair.touch + skin;
        let nearest = self
            .found
            .choose(&memory.near, results, cutoff, &mut self.numbers);
        memory.active.copy(&self.found);
        pair.active_slack = nearest - pair.touch;
        memory.springs.clear();
        memory.overlaps.clear();
        let mut known = self.old_features.iter().zip(&self.old_springs).peekable();
        let mut let_go = |spring: &Row| span.released += 0.5 * spring[3] * length_squared(*spring);
        for feature in &memory.active.features {
            while let Some((_, spring)) = known.next_if(|(old, _)| *old < feature) {
                let_go(spring);
            }
            let same = known.next_if(|(old, _)| *old == feature);
            let spring = same.map_or(UNLOADED, |(_, spring)| *spring);
            // That it touched before is all that its overlap tells until it is found touching.
            memory.overlaps.push(spring[3]);
            memory.springs.push(spring);
        }
        known.for_each(|(_, spring)| let_go(spring));
    }

    /// Finds the contacts of a pair among the results. Springs of what does not touch are gone, and their energy is lost.
    /// True where the cores are so near each other that they might pass through.
    #[inline(always)]
    fn find_touching(&mut self, all: &Surroundings<'_>, number: usize, pair: &mut Pair) -> bool {
        if let Some(moved) = self.spans[number].choose {
            self.activate(number, moved, pair);
        }
        let span = &mut self.spans[number];
        span.contacts = self.touching.len();
        let (mut sum, mut squares) = (0.0, 0.0);
        let (mut deepest, mut nearest) = (0.0, f64::INFINITY);
        let memory = &mut *pair.memory;
        let results = self.results[span.results..].iter_mut();
        for (slot, (known, result)) in memory.overlaps.iter_mut().zip(results).enumerate() {
            let overlap = pair.touch - result.normal[3];
            if overlap > 0.0 {
                result.middle[3] = overlap;
                *known = overlap;
                sum += overlap;
                squares += overlap * overlap;
                deepest = if overlap > deepest { overlap } else { deepest };
                self.touching.push(Touch {
                    span: number as u32,
                    result: (span.results + slot) as u32,
                    slot: slot as u32,
                });
                self.springs.push(memory.springs[slot]);
                continue;
            }
            nearest = if -overlap < nearest {
                -overlap
            } else {
                nearest
            };
            if *known > 0.0 {
                *known = 0.0;
                let spring = std::mem::replace(&mut memory.springs[slot], UNLOADED);
                span.released += 0.5 * spring[3] * length_squared(spring);
            }
        }
        pair.quiet = if sum > 0.0 { 0.0 } else { nearest };
        if all.rule == FeatureRule::Shared && sum > 0.0 {
            span.velocity[3] = squares / (sum * sum);
        }
        deepest > DEEPEST * pair.touch && !all.has_sides(pair)
    }

    /// The contact law of every contact of the batch.
    #[inline(always)]
    fn press<N: Lanes>(&mut self, processor: N::Processor, dt: f64) {
        let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
        let step = N::splat(processor, dt);
        let always = one.exceeds(zero);
        let outputs = self
            .springs
            .chunks_mut(N::COUNT)
            .zip(self.effects.chunks_mut(N::COUNT));
        for (chunk, (springs, effects)) in self.touching.chunks(N::COUNT).zip(outputs) {
            let all = group(chunk);
            let last = chunk.len() - 1;
            let span = side_by_side::<N, _>(|k| &self.spans[all[k].span as usize]);
            let result = side_by_side::<N, _>(|k| &self.results[all[k].result as usize]);
            let old = side_by_side::<N, _>(|k| &springs[k.min(last)]);
            let [nx, ny, nz, _] = N::gather(processor, side_by_side::<N, _>(|k| &result[k].normal));
            let normal = [nx, ny, nz];
            let [mx, my, mz, overlap] =
                N::gather(processor, side_by_side::<N, _>(|k| &result[k].middle));
            let [cx, cy, cz, offset] =
                N::gather(processor, side_by_side::<N, _>(|k| &span[k].centre));
            let [vx, vy, vz, part] =
                N::gather(processor, side_by_side::<N, _>(|k| &span[k].velocity));
            let [wx, wy, wz, _] = N::gather(processor, side_by_side::<N, _>(|k| &span[k].spin));
            let [normal_stiffness, damping, tangential_stiffness, friction] =
                N::gather(processor, side_by_side::<N, _>(|k| &span[k].law));
            let arm = plus(minus([mx, my, mz], [cx, cy, cz]), times(normal, offset));
            let velocity = plus([vx, vy, vz], cross([wx, wy, wz], arm));
            let approach = dot(velocity, normal);
            let elastic = normal_stiffness * part * overlap;
            let repulsion = Hooke.normal_force(elastic, damping * part * approach, zero);
            let slip = minus(velocity, times(normal, approach));
            let stiffness = tangential_stiffness * part;
            let stretched = stretch::<N>(
                processor,
                old,
                times(slip, step),
                normal,
                always,
                stiffness,
                friction * Hooke.coulomb_force(elastic, repulsion, zero),
            );
            let force = minus(
                times(stretched.spring, -stiffness),
                times(normal, repulsion),
            );
            let moment = cross(arm, force);
            let in_dashpot = step * ((repulsion - elastic) * approach);
            let pressed = step * (elastic * approach);
            let forces = N::rows([force[0], force[1], force[2], zero]);
            let moments = N::rows([moment[0], moment[1], moment[2], zero]);
            let energies = N::rows([in_dashpot, stretched.lost, pressed, zero]);
            for (k, (effect, spring)) in effects.iter_mut().zip(springs).enumerate() {
                effect.force = forces[k].row();
                effect.moment = moments[k].row();
                effect.energy = energies[k].row();
                *spring = stretched.rows[k].row();
            }
        }
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

    /// What `pair` does, from the `effects` of its contacts.
    #[inline(always)]
    fn action(&self, pair: &mut Pair, span: &Span, effects: &[Effect]) -> Action {
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
        action.exchanged[1] += span.released;
        if self.rule == FeatureRule::Shared {
            // Stiffness that is shared anew is no potential's: what it takes or gives is booked with the springs.
            let stored = pair.memory.stored_energy(span.velocity[3]);
            action.exchanged[1] += pressed - (stored - pair.memory.stored);
            pair.memory.stored = stored;
        }
        let across = crossed(sub(span.centre, span.second), action.force);
        for axis in 0..3 {
            action.second[axis] = -action.first[axis] - across[axis];
        }
        if let Some(wall) = self.wall(pair) {
            let force = vector(action.force).dot(wall.motion.velocity);
            let torque = -vector(action.second).dot(wall.motion.spin);
            action.exchanged[3] = self.dt * (force + torque);
        }
        action.force[3] = if effects.is_empty() { 0.0 } else { 1.0 };
        action
    }
}

impl Memory {
    /// What its normal springs store where each contact has `part` of the stiffness [J].
    pub fn stored_energy(&self, part: f64) -> f64 {
        let squares: f64 = self.overlaps.iter().map(|x| x * x).sum();
        0.5 * self.law[0] * part * squares
    }

    /// The part of the stiffness that each contact has where they share it.
    pub fn part(&self) -> f64 {
        let sum: f64 = self.overlaps.iter().sum();
        let squares: f64 = self.overlaps.iter().map(|x| x * x).sum();
        if sum > 0.0 {
            squares / (sum * sum)
        } else {
            1.0
        }
    }
}

/// Lists the vertices of the first body that may touch a wall; returns how far it may move until the next time.
fn list_at_wall(all: &Surroundings<'_>, surface: &Surface, skin: f64, pair: &mut Pair) -> f64 {
    pair.memory.near.clear();
    let mut nearest = f64::INFINITY;
    let vertices = all.geometry.vertices_of(pair.first as usize);
    for (vertex, place) in (0..).zip(vertices) {
        let distance = surface.distance(vector(*place)).0;
        nearest = nearest.min(distance);
        if distance < pair.touch + skin {
            pair.memory
                .near
                .features
                .push(Feature::VertexFace(vertex, 0));
        }
    }
    skin.max(nearest - pair.touch)
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
