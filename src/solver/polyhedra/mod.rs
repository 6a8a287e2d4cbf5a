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
use super::lanes::{Lanes, Processor, Work, prefetch};
use super::law::PairConstants;
use super::row::{Row, length_squared, row, sub, vector};
use super::state::move_walls;
use super::team::{Barrier, Shared, Team, share};
use super::{Fault, FaultKind, Profile, Stage, Stretch};
use crate::physics::{ContactLaw, FeatureRule, Materials};
use crate::world::{Contact, FeatureContact, Partner, Polyhedron, SpeciesId, Surface, World};
use bodies::{Body, Geometry, Load, Placing, Shapes};
use listing::Listed;
use nearest::Places;
use pairs::{
    Action, Active, BLOCK, DEEPEST, Desk, Extents, Forces, Pair, Spot, Surroundings, Terms,
};
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
    pairs: Pairs,
    actions: Vec<Action>,
    /// Which pairs act.
    busy: Vec<bool>,
    sides: Sides,
    /// Where the bodies were when the pairs were found.
    reference: Vec<Row>,
    /// Where the walls were then.
    reference_surfaces: Vec<Surface>,
    near_skin: f64,
    extents: Extents,
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

/// The pairs near each other, sorted by [`key`].
#[derive(Default)]
struct Pairs {
    list: Vec<Pair>,
    terms: Vec<Terms>,
    /// What the active features of each block remember.
    spots: Vec<Vec<Spot>>,
}

impl Pairs {
    /// Adds a pair after all others.
    fn push(&mut self, mut pair: Pair, terms: Terms, spots: &[Spot]) {
        if self.list.len().is_multiple_of(BLOCK) {
            self.spots.push(Vec::new());
        }
        if let Some(block) = self.spots.last_mut() {
            pair.active = Active::at(block.len(), spots);
            block.extend_from_slice(spots);
        }
        self.list.push(pair);
        self.terms.push(terms);
    }

    /// What the active features of pair `k` remember.
    fn spots_of(&self, k: usize) -> &[Spot] {
        &self.spots[k / BLOCK][self.list[k].active.spots()]
    }
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
    pub fn load(&mut self, processor: Processor, world: &World) {
        let count = world.grains.len();
        self.dt = world.clock.time_step;
        self.gravity = row(world.gravity, 0.0);
        self.rule = (world.law.feature_springs()).map_or(FeatureRule::Full, |springs| springs.rule);
        let surfaces = || world.container.walls.iter().map(|wall| wall.surface);
        let same_walls = surfaces().eq(self.walls.iter().map(|wall| wall.surface));
        self.walls.clear();
        self.walls
            .extend(world.container.walls.iter().map(|wall| WallBody {
                surface: wall.surface,
                motion: wall.motion,
            }));
        let bodies: Vec<Body> = (0..count).map(|i| Body::of(world, i, self.dt)).collect();
        let unmoved = same_walls && bodies == self.bodies && self.holds(world);
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
            self.place_all(processor);
            self.pairs = Pairs::default();
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
        self.pairs
            .list
            .iter()
            .enumerate()
            .flat_map(move |(k, pair)| {
                let touching = self
                    .pairs
                    .spots_of(k)
                    .iter()
                    .filter(|spot| spot.overlap > 0.0);
                touching.map(move |spot| FeatureContact {
                    grain: pair.first,
                    partner: partner(pair, count),
                    feature: spot.listed.feature,
                    overlap: spot.overlap,
                    dashpot: spot.dashpot,
                    spring: vector(spot.spring),
                    stiffness: spot.spring[3],
                })
            })
    }

    fn place_all(&mut self, processor: Processor) {
        self.vertices
            .resize(self.shapes.body_vertices.len(), [0.0; 4]);
        self.planes.resize(self.shapes.body_normals.len(), [0.0; 4]);
        processor.run(Placing {
            shapes: &self.shapes,
            bodies: &self.bodies,
            vertices: &mut self.vertices,
            planes: &mut self.planes,
        });
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
        let Pairs { list, terms, spots } = std::mem::take(&mut self.pairs);
        let mut known = list.into_iter().zip(terms).enumerate().peekable();
        let mut pairs = Pairs::default();
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
                while known.next_if(|(_, (pair, _))| key(pair) < wanted).is_some() {}
                match known.next_if(|(_, (pair, _))| key(pair) == wanted) {
                    Some((k, (pair, terms))) => {
                        let spots = &spots[k / BLOCK][pair.active.spots()];
                        pairs.push(pair, terms, spots);
                    }
                    None => pairs.push(new_pair(wanted), Terms::default(), &[]),
                }
            }
        }
        self.pairs = pairs;
        self.actions.clear();
        self.actions
            .resize(self.pairs.list.len(), Action::default());
        self.busy.clear();
        self.busy.resize(self.pairs.list.len(), false);
        self.sides = Sides::of(&self.pairs.list, count);
        self.reference.clear();
        self.reference
            .extend(self.bodies.iter().map(|body| body.position));
        self.reference_surfaces.clear();
        self.reference_surfaces
            .extend(self.walls.iter().map(|wall| wall.surface));
        self.set_geometry_constants();
        self.known = Known::default();
        self.compute_constants(world);
    }

    /// Sizes of the bodies and of where they and the walls are.
    fn extents(&self) -> Extents {
        let largest = |v: glam::DVec3| v.abs().max_element();
        let bodies = self.bodies.iter().map(|body| largest(body.centre()));
        let walls = self.walls.iter().map(|wall| match wall.surface {
            Surface::Plane { point, .. } => largest(point),
            Surface::Cylinder { radius } => radius,
            Surface::Tube { radius, rim } => radius.max(rim.abs()),
        });
        let reach = self.bodies.iter().map(|body| body.spin[3]);
        Extents::new(
            bodies.chain(walls).fold(0.0, f64::max),
            reach.fold(0.0, f64::max),
            self.near_skin,
        )
    }

    fn set_geometry_constants(&mut self) {
        let extents = self.extents();
        for (pair, terms) in self.pairs.list.iter().zip(&mut self.pairs.terms) {
            let first = &self.bodies[pair.first as usize];
            let other = self.bodies.get(pair.second as usize);
            let (own, other) = (first.rounding(), other.map_or(0.0, Body::rounding));
            terms.touch = own + other;
            terms.offset = 0.5 * (own - other);
            let uneven = |body: u32| self.shapes.uneven.get(body as usize).unwrap_or(&0.0);
            let uneven = uneven(pair.first) + uneven(pair.second);
            terms.margin = extents.margin(first.spin[3], terms.touch, uneven);
        }
        self.extents = extents;
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
        for (pair, terms) in self.pairs.list.iter().zip(&mut self.pairs.terms) {
            let pairing = world.pairing(pair.first as usize, partner(pair, count));
            let PairConstants {
                coefficients,
                contact,
            } = pairing.constants(world.law, &world.materials, false);
            let [stiffness, damping, tangential_stiffness, _] = coefficients;
            terms.law = [stiffness, damping, tangential_stiffness, contact[0]];
        }
    }

    /// Gives the pairs the contacts that `world` holds.
    fn adopt(&mut self, world: &World) {
        let Some(polyhedra) = &world.polyhedra else {
            return;
        };
        let count = self.bodies.len();
        let mut features = polyhedra.features.iter().peekable();
        let mut spots = Vec::new();
        let Pairs { list, terms, .. } = std::mem::take(&mut self.pairs);
        for (pair, terms) in list.into_iter().zip(terms) {
            let wanted = (pair.first, partner(&pair, count));
            while features
                .next_if(|contact| (contact.grain, contact.partner) < wanted)
                .is_some()
            {}
            let next = || features.next_if(|contact| (contact.grain, contact.partner) == wanted);
            spots.clear();
            spots.extend(std::iter::from_fn(next).map(|contact| Spot {
                spring: row(contact.spring, contact.stiffness),
                overlap: contact.overlap,
                dashpot: contact.dashpot,
                listed: Listed::face(contact.feature, 0),
            }));
            self.pairs.push(pair, terms, &spots);
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
            polyhedra.features.reserve_exact(self.contacts().count());
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
        let acting = self.pairs.list.iter().zip(&self.actions).zip(&self.busy);
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
        self.pairs.list.iter().map(|pair| pair.near.len()).sum()
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
        let mut refresh = self.start(processor);
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
    fn start(&mut self, processor: Processor) -> bool {
        move_walls(&mut self.walls, self.dt);
        let half = 0.5 * self.dt;
        for (body, load) in self.bodies.iter_mut().zip(&self.loads) {
            body.kick(load, half, self.gravity);
            body.drift(self.dt);
        }
        self.place_all(processor);
        let slack = self.slack();
        let moved = self.bodies.iter().zip(&self.reference);
        moved
            .map(|(body, old)| length_squared(sub(body.position, *old)))
            .any(|square| square > slack * slack)
            || self.walls_moved() > slack
    }

    /// How far a body or a wall may move until the pairs must be found anew [m]: less than half of the skin, by more than
    /// rounding.
    fn slack(&self) -> f64 {
        0.499 * self.near_skin
    }

    /// How far any wall is from where it was when the pairs were found; without bound where it is another [m].
    fn walls_moved(&self) -> f64 {
        let old = &self.reference_surfaces;
        if old.len() != self.walls.len() {
            return f64::INFINITY;
        }
        let moved = self.walls.iter().zip(old);
        moved
            .map(|(wall, old)| wall.moved_from(old))
            .fold(0.0, f64::max)
    }

    /// Steps after which a wall may have used up its half of the near skin.
    fn steps_within_slack(&self) -> u64 {
        let speed = self.walls.iter().map(WallBody::speed).fold(0.0, f64::max);
        if speed > 0.0 {
            ((self.slack() - self.walls_moved()) / (speed * self.dt)).max(1.0) as u64
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
                let outcome = unsafe { phase.finish(processor, member, size, last) };
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
        let (shares, slack) = (shares(&self.pairs.spots, size), self.slack());
        Phase {
            shares,
            pair_count: self.pairs.list.len(),
            bodies: Shared::new(&mut self.bodies),
            loads: Shared::new(&mut self.loads),
            vertices: Shared::new(&mut self.vertices),
            planes: Shared::new(&mut self.planes),
            pairs: Shared::new(&mut self.pairs.list),
            terms: Shared::new(&mut self.pairs.terms),
            spots: Shared::new(&mut self.pairs.spots),
            actions: Shared::new(&mut self.actions),
            busy: Shared::new(&mut self.busy),
            shapes: &self.shapes,
            sides: &self.sides,
            reference: &self.reference,
            walls: &self.walls,
            desks: &self.desks,
            slack_squared: slack * slack,
            dt: self.dt,
            gravity: self.gravity,
            rule: self.rule,
            extents: self.extents,
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
        let deep = self.pairs.list.iter().enumerate().find_map(|(k, pair)| {
            let overlaps = self.pairs.spots_of(k).iter().map(|spot| spot.overlap);
            let deepest = overlaps.fold(0.0, f64::max) / self.pairs.terms[k].touch;
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

/// Two bodies of which nothing is known yet.
fn new_pair((first, second): (u32, u32)) -> Pair {
    Pair {
        first,
        second,
        slack: -1.0,
        ..Pair::default()
    }
}

/// Ranges of blocks that take about equally long.
fn shares(blocks: &[Vec<Spot>], size: usize) -> Vec<Range<usize>> {
    let cost = |block: &Vec<Spot>| BLOCK + block.len();
    let all: usize = blocks.iter().map(cost).sum();
    let mut shares = Vec::with_capacity(size);
    let (mut begin, mut spent) = (0, 0);
    for member in 0..size {
        let goal = all * (member + 1) / size;
        let mut end = begin;
        while end < blocks.len() && (spent < goal || member + 1 == size) {
            spent += cost(&blocks[end]);
            end += 1;
        }
        shares.push(begin..end);
        begin = end;
    }
    shares
}

/// The state on loan to a team for a stretch of steps: each member presses and moves its own share.
struct Phase<'a> {
    /// Each member's blocks of pairs.
    shares: Vec<Range<usize>>,
    bodies: Shared<'a, Body>,
    loads: Shared<'a, Load>,
    vertices: Shared<'a, Row>,
    planes: Shared<'a, Row>,
    pairs: Shared<'a, Pair>,
    terms: Shared<'a, Terms>,
    spots: Shared<'a, Vec<Spot>>,
    pair_count: usize,
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
    extents: Extents,
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
        let blocks = self.shares[member].clone();
        let pair = |block: usize| (block * BLOCK).min(self.pair_count);
        let own = pair(blocks.start)..pair(blocks.end);
        // SAFETY: in this phase bodies and features are only read, pairs and actions only written, each member its own
        // share.
        let (bodies, vertices, planes, pairs, terms, spots, actions, busy) = unsafe {
            (
                self.bodies.all(),
                self.vertices.all(),
                self.planes.all(),
                self.pairs.range_mut(own.clone()),
                self.terms.range_mut(own.clone()),
                self.spots.range_mut(blocks),
                self.actions.range_mut(own.clone()),
                self.busy.range_mut(own),
            )
        };
        let wall_motions: Vec<[Row; 3]> = walls
            .iter()
            .map(|wall| {
                [
                    [0.0; 4],
                    row(wall.motion.velocity, 0.0),
                    row(wall.motion.spin, 0.0),
                ]
            })
            .collect();
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
                    places: Places {
                        vertices,
                        planes,
                        corners: &self.shapes.loops,
                    },
                },
                walls,
                wall_motions: &wall_motions,
                extents: self.extents,
            },
            pairs,
            terms,
            spots,
            actions,
            busy,
            desk: &mut desk,
        })
    }

    /// Sums the forces on `member`'s share of the bodies and moves them.
    ///
    /// # Safety
    /// As for [`Phase::forces`].
    unsafe fn finish(
        &self,
        processor: Processor,
        member: usize,
        size: usize,
        last: bool,
    ) -> Outcome {
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
        processor.run(Finish {
            own,
            bodies,
            loads,
            vertices,
            planes,
            incidence: Incidence {
                actions,
                busy,
                sides: self.sides,
            },
            shapes: self.shapes,
            reference: self.reference,
            slack_squared: self.slack_squared,
            dt: self.dt,
            gravity: self.gravity,
            last,
        })
    }
}

/// What every pair does, and which are whose.
#[derive(Clone, Copy)]
struct Incidence<'a> {
    actions: &'a [Action],
    busy: &'a [bool],
    sides: &'a Sides,
}

/// Finishes a step for a range of bodies and, unless it is the last of a call, starts the next.
struct Finish<'a> {
    own: Range<usize>,
    bodies: &'a mut [Body],
    loads: &'a mut [Load],
    vertices: &'a mut [Row],
    planes: &'a mut [Row],
    incidence: Incidence<'a>,
    shapes: &'a Shapes,
    reference: &'a [Row],
    slack_squared: f64,
    dt: f64,
    gravity: Row,
    last: bool,
}

impl Work for Finish<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        let half = 0.5 * self.dt;
        let mut outcome = Outcome::default();
        let from = self.shapes.places[self.own.start];
        for (i, (body, load)) in self.own.zip(self.bodies.iter_mut().zip(self.loads)) {
            self.incidence.sum(i, load);
            body.kick(load, half, self.gravity);
            if self.last {
                body.update_spin();
                outcome.fault |= !body.is_sane();
                continue;
            }
            body.kick(load, half, self.gravity);
            body.drift(self.dt);
            outcome.fault |= !body.is_sane();
            let (begin, end) = (self.shapes.places[i], self.shapes.places[i + 1]);
            let span = |a: u32, b: u32, start: u32| (a - start) as usize..(b - start) as usize;
            self.shapes.place::<N::Quad>(
                processor,
                i,
                body,
                &mut self.vertices[span(begin.vertex, end.vertex, from.vertex)],
                &mut self.planes[span(begin.face, end.face, from.face)],
            );
            let moved = length_squared(sub(body.position, self.reference[i]));
            outcome.refresh |= moved > self.slack_squared;
        }
        outcome
    }
}

impl Incidence<'_> {
    /// Asks for what the pairs do of which body `i` is the second: it lies scattered.
    #[inline(always)]
    fn fetch(&self, i: usize) {
        if i + 1 < self.sides.second_starts.len() {
            for &pair in self.sides.of_body(i).0 {
                if self.busy[pair as usize] {
                    prefetch::<_, 2>(&self.actions[pair as usize..=pair as usize]);
                }
            }
        }
    }

    /// Sums what the pairs of body `i` do to it, in the pairs' order.
    #[inline(always)]
    fn sum(&self, i: usize, load: &mut Load) {
        let (as_second, as_first) = self.sides.of_body(i);
        self.fetch(i + 2);
        load.force = [0.0; 4];
        load.torque = [0.0; 4];
        for pair in as_second.iter().map(|&pair| pair as usize) {
            if !self.busy[pair] {
                continue;
            }
            let action = &self.actions[pair];
            for axis in 0..3 {
                load.force[axis] -= action.force[axis];
                load.torque[axis] += action.second[axis];
            }
            load.force[3] += action.force[3];
        }
        for pair in as_first {
            if !self.busy[pair] {
                continue;
            }
            let action = &self.actions[pair];
            for axis in 0..4 {
                load.force[axis] += action.force[axis];
                load.torque[axis] += action.first[axis];
                load.exchanged[axis] += action.exchanged[axis];
            }
        }
    }
}
