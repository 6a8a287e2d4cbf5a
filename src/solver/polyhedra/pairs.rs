//! Pairs of bodies near each other, and what their contacts do.
//!
//! In: bodies and where their features are. Out: force and torques of every pair, its springs one step on. A pair lives as
//! long as its bodies are near each other; which of its features may touch is listed anew when the two have moved relative
//! to each other by the list's skin ([`super::listing`]), each pair in its own time, so that a crowd that moves as one
//! lists nothing.
//!
//! The contacts of a pair are summed in the order of their features: neither lists nor threads nor lanes show in a sum.

use super::super::contacts::WallBody;
use super::super::lanes::{Lanes, Quad, Row, Work, cross, dot, minus, plus, side_by_side, times};
use super::super::law::{Hooke, Law};
use super::super::row::{length_squared, row, sub, vector};
use super::super::spring::{UNLOADED, stretch};
use super::bodies::{Body, Shapes};
use super::listing::{Entry, Search, Wanted, edge_job};
use super::nearest::{EdgeJob, FaceJob, Geometry, Nearest, above_faces, at_faces, between_edges};
use crate::scene::FeatureRule;
use crate::world::{Feature, Surface};

/// Steps that a list is made to last at the pace at which its bodies move.
const LIFE: f64 = 40.0;
/// Bounds of a list's skin relative to the distance of cores at which the two touch.
const SKIN: std::ops::RangeInclusive<f64> = 0.01..=0.5;
/// Bodies are taken to move by so much more than their velocities say.
const CAUTION: f64 = 1.05;
/// Two cores that come nearer than the rest of this share of the touching distance could pass through each other.
pub const DEEPEST: f64 = 0.8;
/// Results that are computed in one go: they stay in the nearest cache.
const BATCH: usize = 256;

/// Two bodies near each other.
#[derive(Clone, Debug, Default)]
pub struct Pair {
    /// The grain on which the computed force acts.
    pub first: u32,
    /// The other grain; from the number of grains on, a wall.
    pub second: u32,
    /// `K_n`, the normal dashpot `m_e γ_n`, `K_t`, μ.
    pub law: Row,
    /// Distance of cores at which the two touch: the sum of their rounding radii [m].
    pub touch: f64,
    /// Half the difference of the rounding radii [m].
    pub offset: f64,
    /// How far the two may still move relative to each other until the list must be made anew [m].
    pub slack: f64,
    /// The direction that parted them best when it was last made; zero when never.
    pub axis: Row,
    /// What may touch, in order of the features.
    pub entries: Vec<Entry>,
    /// Tangential spring of each [m], and the stiffness of its last stretch [N/m].
    pub springs: Vec<Row>,
    /// Overlap of each, zero where it does not touch [m].
    pub overlaps: Vec<f64>,
    /// What the normal springs store, where they share their stiffness [J].
    pub stored: f64,
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
    /// Their shapes.
    pub shapes: &'a Shapes,
    /// Where those are.
    pub geometry: Geometry<'a>,
    /// Every wall.
    pub walls: &'a [WallBody],
}

/// A pair on the way through the pair loop, what its contacts depend on in rows.
#[derive(Clone, Copy, Default)]
struct Span {
    /// Velocity of the first relative to the second at the first's centroid [m/s]; part of the stiffness that each contact
    /// has.
    velocity: Row,
    /// Relative spin [rad/s].
    spin: Row,
    /// Centroid of the first [m]; half the difference of the rounding radii [m].
    centre: Row,
    /// As [`Pair::law`].
    law: Row,
    /// Index of the pair.
    pair: usize,
    /// First of its results.
    first: usize,
    /// First of its touching contacts.
    touching: usize,
}

/// A contact: where its span, its spring and its result are.
#[derive(Clone, Copy)]
struct Touch {
    span: usize,
    slot: usize,
    result: usize,
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
    old_entries: Vec<Entry>,
    old_springs: Vec<Row>,
    spans: Vec<Span>,
    edges: Vec<EdgeJob>,
    above: Vec<FaceJob>,
    faces: Vec<FaceJob>,
    results: Vec<Nearest>,
    touching: Vec<Touch>,
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
    /// What they do.
    pub actions: &'a mut [Action],
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
            desk,
        } = self;
        let mut outcome = Outcome::default();
        desk.clear();
        for index in 0..pairs.len() {
            let pair = &mut pairs[index];
            let mut span = all.span(pair);
            pair.slack -= CAUTION * all.dt * pace(&span, all.bodies[pair.first as usize].spin[3]);
            if pair.slack < 0.0 {
                outcome.listed += 1;
                desk.list::<N>(processor, &all, &span, pair);
            }
            if pair.entries.is_empty() {
                actions[index] = Action::default();
                continue;
            }
            span.pair = index;
            desk.queue(&all, pair, span);
            if desk.results.len() >= BATCH {
                outcome.fault |= desk.finish::<N>(processor, &all, pairs, actions);
            }
        }
        outcome.fault |= desk.finish::<N>(processor, &all, pairs, actions);
        outcome
    }
}

/// A speed that no point of the first body, `reach` from its centroid at most, exceeds relative to the second [m/s].
#[inline(always)]
fn pace(span: &Span, reach: f64) -> f64 {
    length_squared(span.velocity).sqrt() + length_squared(span.spin).sqrt() * reach
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
        match self.wall(pair) {
            Some(wall) => [
                [0.0; 4],
                row(wall.motion.velocity, 0.0),
                row(wall.motion.spin, 0.0),
            ],
            None => {
                let body = &self.bodies[pair.second as usize];
                [body.position, body.velocity, body.spin]
            }
        }
    }

    /// How the two move relative to each other.
    #[inline(always)]
    fn span(&self, pair: &Pair) -> Span {
        let first = &self.bodies[pair.first as usize];
        let [position, velocity, spin] = self.second(pair);
        let turning = crossed(spin, sub(first.position, position));
        let mut span = Span {
            velocity: sub(sub(first.velocity, velocity), turning),
            spin: sub(first.spin, spin),
            centre: first.position,
            law: pair.law,
            ..Span::default()
        };
        span.velocity[3] = 1.0;
        span.centre[3] = pair.offset;
        span
    }
}

impl Desk {
    fn clear(&mut self) {
        self.spans.clear();
        self.edges.clear();
        self.above.clear();
        self.faces.clear();
        self.results.clear();
        self.touching.clear();
    }

    /// Makes the list of `pair` anew; springs follow their features.
    #[inline(always)]
    fn list<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        span: &Span,
        pair: &mut Pair,
    ) {
        let first = pair.first as usize;
        let moves = CAUTION * all.dt * pace(span, all.bodies[first].spin[3]);
        let skin = (LIFE * moves).clamp(SKIN.start() * pair.touch, SKIN.end() * pair.touch);
        std::mem::swap(&mut self.old_entries, &mut pair.entries);
        std::mem::swap(&mut self.old_springs, &mut pair.springs);
        pair.slack = match all.wall(pair) {
            Some(wall) => list_at_wall(all, &wall.surface, skin, pair),
            None => {
                let wanted = Wanted {
                    bodies: [first, pair.second as usize],
                    axis: pair.axis,
                    touch: pair.touch,
                    skin,
                };
                let found = self.search.run::<N>(
                    processor,
                    all.shapes,
                    &all.geometry,
                    &wanted,
                    &mut pair.entries,
                );
                pair.axis = found.axis;
                found.slack
            }
        };
        pair.springs.clear();
        let mut known = self.old_entries.iter().zip(&self.old_springs).peekable();
        for entry in &pair.entries {
            while known
                .next_if(|(old, _)| old.feature < entry.feature)
                .is_some()
            {}
            let same = known.next_if(|(old, _)| old.feature == entry.feature);
            pair.springs
                .push(same.map_or(UNLOADED, |(_, spring)| *spring));
        }
        pair.overlaps.clear();
        pair.overlaps.resize(pair.entries.len(), 0.0);
    }

    /// Puts a pair's features on the list of what to compute.
    #[inline(always)]
    fn queue(&mut self, all: &Surroundings<'_>, pair: &Pair, mut span: Span) {
        span.first = self.results.len();
        let own = all.shapes.places[pair.first as usize];
        let wall = all.wall(pair);
        let other = all.shapes.places[wall.map_or(pair.second as usize, |_| all.bodies.len())];
        for entry in &pair.entries {
            let out = self.results.len() as u32;
            let mut result = Nearest::default();
            let job = |vertex, face, side| FaceJob {
                vertex,
                face,
                side,
                out,
            };
            let face_job = match entry.feature {
                Feature::VertexFace(vertex, face) => {
                    let vertex = own.vertex + u32::from(vertex);
                    if let Some(wall) = wall {
                        result = to_wall(&wall.surface, all.geometry.vertices[vertex as usize]);
                        None
                    } else {
                        Some(job(vertex, other.face + u32::from(face), 0))
                    }
                }
                Feature::FaceVertex(face, vertex) => Some(job(
                    other.vertex + u32::from(vertex),
                    own.face + u32::from(face),
                    1,
                )),
                Feature::EdgeEdge(first, second) => {
                    let edges = [own.edge + u32::from(first), other.edge + u32::from(second)];
                    self.edges.push(edge_job(all.shapes, edges, out));
                    None
                }
                Feature::VertexVertex => {
                    self.edges
                        .push(edge_job(all.shapes, [own.edge, other.edge], out));
                    None
                }
            };
            match face_job {
                Some(job) if entry.inside => self.above.push(job),
                Some(job) => self.faces.push(job),
                None => {}
            }
            self.results.push(result);
        }
        self.spans.push(span);
    }

    /// Computes what is on the list and clears it. True where two cores came too near each other.
    #[inline(always)]
    fn finish<N: Lanes>(
        &mut self,
        processor: N::Processor,
        all: &Surroundings<'_>,
        pairs: &mut [Pair],
        actions: &mut [Action],
    ) -> bool {
        above_faces::<N>(processor, &all.geometry, &self.above, &mut self.results);
        at_faces::<N, false>(processor, &all.geometry, &self.faces, &mut self.results);
        between_edges::<N>(processor, &all.geometry, &self.edges, &mut self.results);
        let fault = self.find_touching(all, pairs);
        self.effects.clear();
        self.effects.resize(self.touching.len(), Effect::default());
        self.press::<N>(processor, all.dt, pairs);
        for k in 0..self.spans.len() {
            let end = self
                .spans
                .get(k + 1)
                .map_or(self.touching.len(), |next| next.touching);
            let span = &self.spans[k];
            let effects = &self.effects[span.touching..end];
            let pair = &mut pairs[span.pair];
            actions[span.pair] = all.action(pair, span, effects);
        }
        self.clear();
        fault
    }

    /// Finds the contacts among the results. Springs of what does not touch are gone, and their energy is lost.
    #[inline(always)]
    fn find_touching(&mut self, all: &Surroundings<'_>, pairs: &mut [Pair]) -> bool {
        let mut fault = false;
        for (index, span) in self.spans.iter_mut().enumerate() {
            let pair = &mut pairs[span.pair];
            span.touching = self.touching.len();
            let (mut sum, mut squares) = (0.0, 0.0);
            for slot in 0..pair.entries.len() {
                let result = span.first + slot;
                let overlap = pair.touch - self.results[result].normal[3];
                if overlap > 0.0 {
                    self.results[result].middle[3] = overlap;
                    pair.overlaps[slot] = overlap;
                    sum += overlap;
                    squares += overlap * overlap;
                    self.touching.push(Touch {
                        span: index,
                        slot,
                        result,
                    });
                } else {
                    pair.overlaps[slot] = 0.0;
                }
            }
            fault |= all.is_too_deep(pair);
            if all.rule == FeatureRule::Shared && sum > 0.0 {
                span.velocity[3] = squares / (sum * sum);
            }
        }
        fault
    }

    /// The contact law of every contact.
    #[inline(always)]
    fn press<N: Lanes>(&mut self, processor: N::Processor, dt: f64, pairs: &mut [Pair]) {
        let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
        let step = N::splat(processor, dt);
        let touching = one.exceeds(zero);
        let groups = self.touching.chunks(N::COUNT);
        for (group, effects) in groups.zip(self.effects.chunks_mut(N::COUNT)) {
            let last = group.len() - 1;
            let span = side_by_side::<N, _>(|k| &self.spans[group[k.min(last)].span]);
            let result = side_by_side::<N, _>(|k| &self.results[group[k.min(last)].result]);
            let springs = side_by_side::<N, _>(|k| {
                let touch = &group[k.min(last)];
                &pairs[self.spans[touch.span].pair].springs[touch.slot]
            });
            let [nx, ny, nz, _] = N::gather(processor, result.map(|result| &result.normal));
            let normal = [nx, ny, nz];
            let [mx, my, mz, overlap] = N::gather(processor, result.map(|result| &result.middle));
            let [cx, cy, cz, offset] = N::gather(processor, span.map(|span| &span.centre));
            let [vx, vy, vz, part] = N::gather(processor, span.map(|span| &span.velocity));
            let [wx, wy, wz, _] = N::gather(processor, span.map(|span| &span.spin));
            let [normal_stiffness, damping, tangential_stiffness, friction] =
                N::gather(processor, span.map(|span| &span.law));
            let arm = plus(minus([mx, my, mz], [cx, cy, cz]), times(normal, offset));
            let velocity = plus([vx, vy, vz], cross([wx, wy, wz], arm));
            let approach = dot(velocity, normal);
            let elastic = normal_stiffness * part * overlap;
            let repulsion = Hooke.normal_force(elastic, damping * part * approach, zero);
            let slip = minus(velocity, times(normal, approach));
            let stiffness = tangential_stiffness * part;
            let stretched = stretch::<N>(
                processor,
                springs,
                times(slip, step),
                normal,
                touching,
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
            for (k, effect) in effects.iter_mut().enumerate() {
                *effect = Effect {
                    force: forces[k].row(),
                    moment: moments[k].row(),
                    energy: energies[k].row(),
                };
                let touch = &group[k];
                let pair = &mut pairs[self.spans[touch.span].pair];
                pair.springs[touch.slot] = stretched.rows[k].row();
            }
        }
    }
}

impl Surroundings<'_> {
    /// Whether the cores of `pair` are so near that they might pass through each other. A plane and the inside of a drum
    /// know which side is theirs.
    #[inline(always)]
    fn is_too_deep(&self, pair: &Pair) -> bool {
        let has_sides = self.wall(pair).is_some_and(|wall| match wall.surface {
            Surface::Plane { .. } | Surface::Cylinder { .. } => true,
            Surface::Tube { .. } => false,
        });
        let deepest = DEEPEST * pair.touch;
        !has_sides && pair.overlaps.iter().any(|&overlap| overlap > deepest)
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
        for (spring, overlap) in pair.springs.iter_mut().zip(&pair.overlaps) {
            if *overlap == 0.0 && spring[3] > 0.0 {
                action.exchanged[1] += 0.5 * spring[3] * length_squared(*spring);
                *spring = UNLOADED;
            }
        }
        if self.rule == FeatureRule::Shared {
            // Stiffness that is shared anew is no potential's: what it takes or gives is booked with the springs.
            let stored = pair.stored_energy(span.velocity[3]);
            action.exchanged[1] += pressed - (stored - pair.stored);
            pair.stored = stored;
        }
        let [position, velocity, spin] = self.second(pair);
        let across = crossed(sub(span.centre, position), action.force);
        for axis in 0..3 {
            action.second[axis] = -action.first[axis] - across[axis];
        }
        if self.wall(pair).is_some() {
            let force = vector(action.force).dot(vector(velocity));
            let torque = -vector(action.second).dot(vector(spin));
            action.exchanged[3] = self.dt * (force + torque);
        }
        action.force[3] = if effects.is_empty() { 0.0 } else { 1.0 };
        action
    }
}

impl Pair {
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
    pair.entries.clear();
    let i = pair.first as usize;
    let (from, to) = (all.shapes.places[i].vertex, all.shapes.places[i + 1].vertex);
    let mut nearest = f64::INFINITY;
    for vertex in from..to {
        let place = vector(all.geometry.vertices[vertex as usize]);
        let distance = surface.distance(place).0;
        nearest = nearest.min(distance);
        if distance < pair.touch + skin {
            pair.entries.push(Entry {
                feature: Feature::VertexFace((vertex - from) as u16, 0),
                inside: true,
            });
        }
    }
    skin.max(nearest - pair.touch)
}

/// The point of a wall nearest to a vertex.
#[inline(always)]
fn to_wall(surface: &Surface, vertex: Row) -> Nearest {
    let place = vector(vertex);
    let (distance, direction) = surface.distance(place);
    Nearest {
        normal: row(direction, distance),
        middle: row(place + 0.5 * distance * direction, 0.0),
    }
}
