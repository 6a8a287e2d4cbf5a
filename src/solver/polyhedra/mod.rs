//! Worlds of rounded polyhedra: the solver's working copy of one and how it advances.
//!
//! Contacts are those of Man et al. 2023, Eqs. 3.1–3.6: every vertex and face, and every two edges, that are nearer than
//! the sum of the rounding radii press each other with a spring and a dashpot and drag each other by a spring of their own.
//! Walls are partners like any other; only vertices meet them, which for planes and the inside of drums is exact.
//!
//! | file | holds |
//! |---|---|
//! | `bodies` | what moves of each grain, where its vertices and faces are |
//! | `nearest` | nearest points of two features |
//! | `listing` | which features of a pair may touch before long |
//! | `pairs` | pairs near each other, their contacts' forces |
//! | `terms` | those forces, term by term |
//!
//! Not here: rolling friction, liquid, laws other than Hooke's, bodies that are not convex. A sphere is a core of one
//! vertex.

mod bodies;
mod listing;
mod nearest;
mod pairs;
mod terms;

pub use terms::force_terms;

use super::contacts::WallBody;
use super::grid::CellGrid;
use super::lanes::Processor;
use super::law::{PairConstants, Pairing};
use super::row::{Row, length_squared, row, sub, vector};
use super::state::move_walls;
use super::team::{Barrier, Shared, Team, share};
use super::{Fault, FaultKind, Profile, Stage, Stretch};
use crate::scene::{ContactLaw, FeatureRule};
use crate::world::{Contact, FeatureContact, Materials, Partner, Polyhedron, SpeciesId, World};
use bodies::{Body, Geometry, Load, Shapes};
use nearest::Places;
use pairs::{Action, DEEPEST, Desk, Forces, Pair, Surroundings};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Width of the skin in which pairs are kept, relative to the smallest bounding radius.
const NEAR_SKIN: f64 = 0.2;

/// The working copy.
#[derive(Default)]
pub struct State {
    bodies: Vec<Body>,
    loads: Vec<Load>,
    shapes: Shapes,
    vertices: Vec<Row>,
    planes: Vec<Row>,
    walls: Vec<WallBody>,
    pairs: Vec<Pair>,
    actions: Vec<Action>,
    /// Which pairs act.
    busy: Vec<bool>,
    sides: Sides,
    /// Where the bodies were when the pairs were found.
    reference: Vec<Row>,
    near_skin: f64,
    known: Known,
    known_shapes: Option<Arc<[Polyhedron]>>,
    desks: Vec<Mutex<Desk>>,
    dt: f64,
    gravity: Row,
    rule: FeatureRule,
}

/// What the pairs' constants depend on.
#[derive(Default, PartialEq)]
struct Known {
    law: ContactLaw,
    materials: Materials,
    species: Vec<SpeciesId>,
    masses: Vec<f64>,
}

/// The pairs of each body.
#[derive(Default)]
struct Sides {
    /// Where in `second` each body's begin.
    second_starts: Vec<u32>,
    /// Pairs of which it is the second.
    second: Vec<u32>,
    /// Where its pairs as the first begin.
    first_starts: Vec<u32>,
}

impl Sides {
    fn of(pairs: &[Pair], count: usize) -> Self {
        let mut sides = Self {
            second_starts: vec![0; count + 1],
            second: Vec::new(),
            first_starts: vec![0; count + 1],
        };
        let between = |pair: &&Pair| (pair.second as usize) < count;
        for pair in pairs {
            sides.first_starts[pair.first as usize + 1] += 1;
        }
        for pair in pairs.iter().filter(between) {
            sides.second_starts[pair.second as usize + 1] += 1;
        }
        for i in 0..count {
            sides.first_starts[i + 1] += sides.first_starts[i];
            sides.second_starts[i + 1] += sides.second_starts[i];
        }
        let mut next = sides.second_starts.clone();
        sides.second = vec![0; sides.second_starts[count] as usize];
        for (k, pair) in pairs.iter().enumerate().filter(|(_, pair)| between(pair)) {
            let place = &mut next[pair.second as usize];
            sides.second[*place as usize] = k as u32;
            *place += 1;
        }
        sides
    }

    /// The pairs of body `i`: those of which it is the second, then those of which it is the first.
    #[inline(always)]
    fn of_body(&self, i: usize) -> (&[u32], Range<usize>) {
        let second = self.second_starts[i] as usize..self.second_starts[i + 1] as usize;
        let first = self.first_starts[i] as usize..self.first_starts[i + 1] as usize;
        (&self.second[second], first)
    }
}

/// Key by which pairs are sorted: grains before walls, as [`Partner`] sorts.
fn key(pair: &Pair) -> (u32, u32) {
    (pair.first, pair.second)
}

impl State {
    /// Takes `world` in. What is known of it from the last call is kept.
    pub fn load(&mut self, world: &World) {
        let count = world.grains.len();
        self.dt = world.clock.time_step;
        self.gravity = row(world.gravity, 0.0);
        self.rule = match world.law {
            ContactLaw::Hooke { features, .. } => features,
            ContactLaw::HertzMindlin => FeatureRule::Full,
        };
        self.walls.clear();
        self.walls
            .extend(world.container.walls.iter().map(|wall| WallBody {
                surface: wall.surface,
                motion: wall.motion,
            }));
        let bodies: Vec<Body> = (0..count).map(|i| Body::of(world, i, self.dt)).collect();
        let unmoved = bodies == self.bodies && self.holds(world);
        self.bodies = bodies;
        self.loads.clear();
        self.loads.extend((0..count).map(|i| Load {
            force: row(
                world.grains.force[i],
                f64::from(world.grains.contact_count[i]),
            ),
            torque: row(world.grains.torque[i], 0.0),
            exchanged: world.grains.exchanged[i],
        }));
        if !unmoved {
            self.known_shapes = world.polyhedra.as_ref().map(|p| p.shapes.clone());
            self.shapes = Shapes::of(world);
            self.place_all();
            self.pairs.clear();
            self.find_pairs(world);
            self.adopt(world);
        }
        self.compute_constants(world);
    }

    /// Whether the shapes and the contacts' histories are those of `world`.
    fn holds(&self, world: &World) -> bool {
        let (Some(polyhedra), Some(shapes)) = (&world.polyhedra, &self.known_shapes) else {
            return false;
        };
        Arc::ptr_eq(shapes, &polyhedra.shapes)
            && self.contacts().eq(polyhedra.features.iter().copied())
    }

    /// Every feature contact with its history.
    fn contacts(&self) -> impl Iterator<Item = FeatureContact> {
        let count = self.bodies.len();
        self.pairs.iter().flat_map(move |pair| {
            let features = pair
                .memory
                .active
                .features
                .iter()
                .zip(&pair.memory.springs)
                .zip(&pair.memory.overlaps);
            features.filter(|(_, overlap)| **overlap > 0.0).map(
                move |((feature, spring), overlap)| FeatureContact {
                    grain: pair.first,
                    partner: partner(pair, count),
                    feature: *feature,
                    overlap: *overlap,
                    spring: vector(*spring),
                    stiffness: spring[3],
                },
            )
        })
    }

    fn place_all(&mut self) {
        self.vertices.clear();
        self.vertices
            .resize(self.shapes.body_vertices.len(), [0.0; 4]);
        self.planes.clear();
        self.planes.resize(self.shapes.body_normals.len(), [0.0; 4]);
        for (i, body) in self.bodies.iter().enumerate() {
            let (from, to) = (self.shapes.places[i], self.shapes.places[i + 1]);
            self.shapes.place(
                i,
                body,
                &mut self.vertices[from.vertex as usize..to.vertex as usize],
                &mut self.planes[from.face as usize..to.face as usize],
            );
        }
    }

    /// Finds the pairs that are near each other; those known keep what they hold.
    fn find_pairs(&mut self, world: &World) {
        let radii = self.bodies.iter().map(|body| body.spin[3]);
        self.near_skin = NEAR_SKIN * radii.fold(f64::INFINITY, f64::min);
        let (skin, count) = (self.near_skin, self.bodies.len());
        let grid = CellGrid::new(
            self.bodies.iter().map(|body| (body.position, body.spin[3])),
            skin,
        );
        let mut known = std::mem::take(&mut self.pairs).into_iter().peekable();
        let mut partners = Vec::new();
        for (i, body) in self.bodies.iter().enumerate() {
            partners.clear();
            grid.for_near(body.position, |j| {
                let other = &self.bodies[j as usize];
                let reach = body.spin[3] + other.spin[3] + skin;
                let near = length_squared(sub(other.position, body.position)) < reach * reach;
                if j as usize > i && near {
                    partners.push(j);
                }
            });
            partners.sort_unstable();
            let centre = vector(body.position);
            partners.extend((0..self.walls.len()).filter_map(|w| {
                let near = self.walls[w].surface.distance(centre).0 < body.spin[3] + skin;
                near.then_some((count + w) as u32)
            }));
            for &second in &partners {
                let wanted = (i as u32, second);
                while known.next_if(|pair| key(pair) < wanted).is_some() {}
                let pair = known.next_if(|pair| key(pair) == wanted);
                self.pairs.push(pair.unwrap_or_else(|| Pair {
                    first: wanted.0,
                    second,
                    slack: -1.0,
                    ..Pair::default()
                }));
            }
        }
        self.actions.clear();
        self.actions.resize(self.pairs.len(), Action::default());
        self.busy.clear();
        self.busy.resize(self.pairs.len(), false);
        self.sides = Sides::of(&self.pairs, count);
        self.reference.clear();
        self.reference
            .extend(self.bodies.iter().map(|body| body.position));
        self.set_geometry_constants();
        self.known = Known::default();
        self.compute_constants(world);
    }

    fn set_geometry_constants(&mut self) {
        let count = self.bodies.len();
        for pair in &mut self.pairs {
            let own = self.bodies[pair.first as usize].rounding();
            let other = match self.bodies.get(pair.second as usize) {
                Some(body) if (pair.second as usize) < count => body.rounding(),
                _ => 0.0,
            };
            pair.touch = own + other;
            pair.memory.offset = 0.5 * (own - other);
        }
    }

    /// Computes what the law needs of every pair, if anything it depends on has changed.
    fn compute_constants(&mut self, world: &World) {
        let known = Known {
            law: world.law,
            materials: world.materials.clone(),
            species: world.grains.species.clone(),
            masses: world.grains.mass.clone(),
        };
        if known == self.known {
            return;
        }
        self.known = known;
        let count = self.bodies.len();
        for pair in &mut self.pairs {
            let pairing = Pairing::of(world, pair.first as usize, partner(pair, count));
            let PairConstants {
                coefficients,
                contact,
            } = pairing.constants(world.law, &world.materials, false);
            pair.memory.law = [
                coefficients[0],
                coefficients[1],
                coefficients[2],
                contact[0],
            ];
            if self.rule == FeatureRule::Shared {
                pair.memory.stored = pair.memory.stored_energy(pair.memory.part());
            }
        }
    }

    /// Gives the pairs the contacts that `world` holds.
    fn adopt(&mut self, world: &World) {
        let Some(polyhedra) = &world.polyhedra else {
            return;
        };
        let count = self.bodies.len();
        let mut features = polyhedra.features.iter().peekable();
        for pair in &mut self.pairs {
            let wanted = (pair.first, partner(pair, count));
            while features
                .next_if(|contact| (contact.grain, contact.partner) < wanted)
                .is_some()
            {}
            while let Some(contact) =
                features.next_if(|contact| (contact.grain, contact.partner) == wanted)
            {
                pair.memory.active.features.push(contact.feature);
                pair.memory
                    .springs
                    .push(row(contact.spring, contact.stiffness));
                pair.memory.overlaps.push(contact.overlap);
            }
            if self.rule == FeatureRule::Shared {
                pair.memory.stored = pair.memory.stored_energy(pair.memory.part());
            }
        }
    }

    /// Puts the state, `steps` steps on, back into `world`.
    pub fn store(&self, world: &mut World, steps: u64) {
        let grains = &mut world.grains;
        if let Some(polyhedra) = &mut world.polyhedra {
            for (i, (body, load)) in self.bodies.iter().zip(&self.loads).enumerate() {
                grains.position[i] = vector(body.position);
                grains.velocity[i] = vector(body.velocity);
                grains.spin[i] = vector(body.spin);
                grains.force[i] = vector(load.force);
                grains.torque[i] = vector(load.torque);
                grains.contact_count[i] = load.force[3] as u32;
                grains.exchanged[i] = load.exchanged;
                polyhedra.orientation[i] = body.quaternion();
                polyhedra.angular_momentum[i] = vector(body.angular_momentum);
            }
            polyhedra.features.clear();
            polyhedra.features.extend(self.contacts());
        }
        world.clock.step += steps;
        let container = &mut world.container;
        let turn = container.drum_speed() * self.dt;
        (0..steps).for_each(|_| container.angle += turn);
        for (wall, body) in container.walls.iter_mut().zip(&self.walls) {
            wall.surface = body.surface;
        }
        let count = self.bodies.len();
        let acting = self.pairs.iter().zip(&self.actions).zip(&self.busy);
        let touching = acting
            .filter(|((_, action), busy)| **busy && action.force[3] > 0.0)
            .map(|((pair, action), _)| Contact {
                grain: pair.first,
                partner: partner(pair, count),
                spring: glam::DVec3::ZERO,
                stiffness: 0.0,
                force: vector(action.force),
                touching: true,
                bridge: None,
            });
        world.contacts.clear();
        world.contacts.extend(touching);
    }

    /// Number of listed pairs of features.
    pub fn listed(&self) -> usize {
        self.pairs
            .iter()
            .map(|pair| pair.memory.near.features.len())
            .sum()
    }

    /// Takes `steps` steps; on a fault, says after how many.
    pub fn march(
        &mut self,
        team: &mut Team,
        processor: Processor,
        profile: &mut Profile,
        world: &World,
        steps: u64,
    ) -> Result<(), u64> {
        self.desks
            .resize_with(team.size().max(self.desks.len()), Mutex::default);
        let mut done = 0;
        let mut refresh = self.start();
        while done < steps {
            if refresh {
                let begin = Instant::now();
                self.find_pairs(world);
                profile.rebuilds += 1;
                profile.stages[Stage::Neighbours as usize] += begin.elapsed();
            }
            let stretch = self.stretch(team, processor, profile, steps - done);
            done += stretch.steps;
            if stretch.fault {
                return Err(done);
            }
            refresh = true;
        }
        Ok(())
    }

    /// Starts the first step of a call; true when the pairs must be found anew.
    fn start(&mut self) -> bool {
        move_walls(&mut self.walls, self.dt);
        let half = 0.5 * self.dt;
        for (body, load) in self.bodies.iter_mut().zip(&self.loads) {
            body.kick(load, half, self.gravity);
            body.drift(self.dt);
        }
        self.place_all();
        let slack = 0.5 * self.near_skin;
        let moved = self.bodies.iter().zip(&self.reference);
        moved
            .map(|(body, old)| length_squared(sub(body.position, *old)))
            .any(|square| square > slack * slack)
    }

    /// Steps after which a wall may have used up its half of the near skin.
    fn steps_within_slack(&self) -> u64 {
        let speed = self.walls.iter().map(WallBody::speed).fold(0.0, f64::max);
        if speed > 0.0 {
            (0.5 * self.near_skin / (speed * self.dt)).max(1.0) as u64
        } else {
            u64::MAX
        }
    }

    /// Takes up to `remaining` steps with the pairs as they are; the team stays in step from beginning to end.
    #[expect(
        unsafe_code,
        reason = "the barriers here are what the phases' contracts ask for"
    )]
    fn stretch(
        &mut self,
        team: &mut Team,
        processor: Processor,
        profile: &mut Profile,
        remaining: u64,
    ) -> Stretch {
        let size = team.size();
        let barrier = Barrier::new(size);
        let (refresh, fault) = (AtomicBool::new(false), AtomicBool::new(false));
        let limit = remaining.min(self.steps_within_slack());
        let result = Mutex::new((0, [Duration::ZERO; 2]));
        let listed = AtomicU64::new(0);
        let phase = self.phase(size);
        team.run(|member| {
            let mut timings = [Duration::ZERO; 2];
            let mut walls = phase.walls.to_vec();
            let mut steps = 0;
            while steps < limit
                && !refresh.load(Ordering::Relaxed)
                && !fault.load(Ordering::Relaxed)
            {
                let begin = (member == 0).then(Instant::now);
                // SAFETY: all members are between the same two barriers, each under its own number.
                let outcome = unsafe { phase.forces(processor, &walls, member) };
                listed.fetch_add(outcome.listed, Ordering::Relaxed);
                let too_deep = outcome.fault;
                barrier.wait(member);
                let middle = begin.map(|begin| (begin.elapsed(), Instant::now()));
                steps += 1;
                let last = steps == remaining;
                // SAFETY: likewise, one barrier further.
                let outcome = unsafe { phase.finish(member, size, last) };
                refresh.fetch_or(outcome.refresh, Ordering::Relaxed);
                fault.fetch_or(outcome.fault || too_deep, Ordering::Relaxed);
                if !last {
                    move_walls(&mut walls, phase.dt);
                }
                barrier.wait(member);
                if let Some((forces, middle)) = middle {
                    timings[0] += forces;
                    timings[1] += middle.elapsed();
                }
            }
            if member == 0
                && let Ok(mut result) = result.lock()
            {
                *result = (steps, timings);
            }
        });
        let (steps, timings) = result.into_inner().unwrap_or_default();
        let moves = if steps == remaining { steps - 1 } else { steps };
        (0..moves).for_each(|_| move_walls(&mut self.walls, self.dt));
        profile.relisted += listed.into_inner();
        profile.stages[Stage::Contacts as usize] += timings[0];
        profile.stages[Stage::Integration as usize] += timings[1];
        Stretch {
            steps,
            fault: fault.into_inner(),
        }
    }

    /// Lends the state to a team of `size`.
    fn phase(&mut self, size: usize) -> Phase<'_> {
        let shares = shares(&self.pairs, size);
        Phase {
            shares,
            bodies: Shared::new(&mut self.bodies),
            loads: Shared::new(&mut self.loads),
            vertices: Shared::new(&mut self.vertices),
            planes: Shared::new(&mut self.planes),
            pairs: Shared::new(&mut self.pairs),
            actions: Shared::new(&mut self.actions),
            busy: Shared::new(&mut self.busy),
            shapes: &self.shapes,
            sides: &self.sides,
            reference: &self.reference,
            walls: &self.walls,
            desks: &self.desks,
            slack_squared: (0.5 * self.near_skin).powi(2),
            dt: self.dt,
            gravity: self.gravity,
            rule: self.rule,
        }
    }

    /// What went wrong with which grain, `steps` steps after `world`.
    pub fn diagnose(&self, world: &World, steps: u64) -> Fault {
        let (grain, kind) = self.find_fault();
        Fault {
            grain,
            kind,
            time: world.clock.time_at(world.clock.step + steps),
            good_time: world.time(),
        }
    }

    fn find_fault(&self) -> (usize, FaultKind) {
        let insane = self.bodies.iter().position(|body| !body.is_sane());
        if let Some(grain) = insane {
            let body = &self.bodies[grain];
            let kind = if !body.centre().is_finite() {
                FaultKind::NotFinite("position")
            } else if !body.fastest().is_finite() {
                FaultKind::NotFinite("velocity or spin")
            } else {
                FaultKind::TooFastForRounding(body.fastest())
            };
            return (grain, kind);
        }
        let deep = self.pairs.iter().find_map(|pair| {
            let deepest = pair.memory.overlaps.iter().copied().fold(0.0, f64::max) / pair.touch;
            (deepest > DEEPEST).then_some((pair.first as usize, FaultKind::TooDeep(deepest)))
        });
        deep.unwrap_or((0, FaultKind::NotFinite("state")))
    }
}

/// The other side of `pair` in a world of `count` grains.
fn partner(pair: &Pair, count: usize) -> Partner {
    match (pair.second as usize).checked_sub(count) {
        None => Partner::Grain(pair.second),
        Some(wall) => Partner::Wall(wall as u32),
    }
}

/// Ranges of pairs that take about equally long.
fn shares(pairs: &[Pair], size: usize) -> Vec<Range<usize>> {
    let cost = |pair: &Pair| 1 + pair.memory.active.features.len();
    let all: usize = pairs.iter().map(cost).sum();
    let mut shares = Vec::with_capacity(size);
    let (mut begin, mut spent) = (0, 0);
    for member in 0..size {
        let goal = all * (member + 1) / size;
        let mut end = begin;
        while end < pairs.len() && (spent < goal || member + 1 == size) {
            spent += cost(&pairs[end]);
            end += 1;
        }
        shares.push(begin..end);
        begin = end;
    }
    shares
}

/// The state on loan to a team for a stretch of steps: each member presses and moves its own share.
struct Phase<'a> {
    shares: Vec<Range<usize>>,
    bodies: Shared<'a, Body>,
    loads: Shared<'a, Load>,
    vertices: Shared<'a, Row>,
    planes: Shared<'a, Row>,
    pairs: Shared<'a, Pair>,
    actions: Shared<'a, Action>,
    busy: Shared<'a, bool>,
    shapes: &'a Shapes,
    sides: &'a Sides,
    reference: &'a [Row],
    walls: &'a [WallBody],
    desks: &'a [Mutex<Desk>],
    slack_squared: f64,
    dt: f64,
    gravity: Row,
    rule: FeatureRule,
}

/// What a range of bodies asks for after a step.
#[derive(Clone, Copy, Debug, Default)]
struct Outcome {
    refresh: bool,
    fault: bool,
}

#[expect(
    unsafe_code,
    reason = "phases end at barriers: what one writes in shares the other reads whole"
)]
impl Phase<'_> {
    /// Computes `member`'s share of the pairs. `walls` are the walls at the time of the positions.
    ///
    /// # Safety
    /// Every member calls it between the same two barriers, each with its own number, and nothing else.
    unsafe fn forces(
        &self,
        processor: Processor,
        walls: &[WallBody],
        member: usize,
    ) -> pairs::Outcome {
        let own = self.shares[member].clone();
        // SAFETY: in this phase bodies and features are only read, pairs and actions only written, each member its own
        // share.
        let (bodies, vertices, planes, pairs, actions, busy) = unsafe {
            (
                self.bodies.all(),
                self.vertices.all(),
                self.planes.all(),
                self.pairs.range_mut(own.clone()),
                self.actions.range_mut(own.clone()),
                self.busy.range_mut(own),
            )
        };
        let Ok(mut desk) = self.desks[member].lock() else {
            return pairs::Outcome {
                fault: true,
                ..pairs::Outcome::default()
            };
        };
        processor.run(Forces {
            surroundings: Surroundings {
                dt: self.dt,
                rule: self.rule,
                bodies,
                geometry: Geometry {
                    shapes: self.shapes,
                    places: Places { vertices, planes },
                },
                walls,
            },
            pairs,
            actions,
            busy,
            desk: &mut desk,
        })
    }

    /// Sums the forces on `member`'s share of the bodies and moves them.
    ///
    /// # Safety
    /// As for [`Phase::forces`].
    unsafe fn finish(&self, member: usize, size: usize, last: bool) -> Outcome {
        let own = share(self.reference.len(), member, size);
        let (from, to) = (self.shapes.places[own.start], self.shapes.places[own.end]);
        // SAFETY: in this phase actions are only read, bodies and features only written, each member its own share.
        let (bodies, loads, vertices, planes, actions, busy) = unsafe {
            (
                self.bodies.range_mut(own.clone()),
                self.loads.range_mut(own.clone()),
                self.vertices
                    .range_mut(from.vertex as usize..to.vertex as usize),
                self.planes.range_mut(from.face as usize..to.face as usize),
                self.actions.all(),
                self.busy.all(),
            )
        };
        let half = 0.5 * self.dt;
        let mut outcome = Outcome::default();
        for (k, (body, load)) in bodies.iter_mut().zip(loads).enumerate() {
            let i = own.start + k;
            self.sum(i, actions, busy, load);
            body.kick(load, half, self.gravity);
            if last {
                body.update_spin();
                outcome.fault |= !body.is_sane();
                continue;
            }
            body.kick(load, half, self.gravity);
            body.drift(self.dt);
            outcome.fault |= !body.is_sane();
            let (begin, end) = (self.shapes.places[i], self.shapes.places[i + 1]);
            let span = |a: u32, b: u32, start: u32| (a - start) as usize..(b - start) as usize;
            self.shapes.place(
                i,
                body,
                &mut vertices[span(begin.vertex, end.vertex, from.vertex)],
                &mut planes[span(begin.face, end.face, from.face)],
            );
            let moved = length_squared(sub(body.position, self.reference[i]));
            outcome.refresh |= moved > self.slack_squared;
        }
        outcome
    }

    /// Sums what the pairs of body `i` do to it, in the pairs' order.
    fn sum(&self, i: usize, actions: &[Action], busy: &[bool], load: &mut Load) {
        let (as_second, as_first) = self.sides.of_body(i);
        load.force = [0.0; 4];
        load.torque = [0.0; 4];
        for pair in as_second.iter().map(|&pair| pair as usize) {
            if !busy[pair] {
                continue;
            }
            let action = &actions[pair];
            for axis in 0..3 {
                load.force[axis] -= action.force[axis];
                load.torque[axis] += action.second[axis];
            }
            load.force[3] += action.force[3];
        }
        for pair in as_first {
            if !busy[pair] {
                continue;
            }
            let action = &actions[pair];
            for axis in 0..4 {
                load.force[axis] += action.force[axis];
                load.torque[axis] += action.first[axis];
                load.exchanged[axis] += action.exchanged[axis];
            }
        }
    }
}
