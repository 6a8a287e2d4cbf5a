//! Worlds of rounded polyhedra: the solver's working copy of one, and how it advances.
//!
//! In: a world of polyhedra. Out: the same world some steps later, by the stages of
//! [`super::step`].
//!
//! Contacts are those of Man et al. 2023, Eqs. 3.1–3.6: every vertex and face, and every two edges,
//! that are nearer than the sum of the sphero-radii press each other with a spring and a dashpot
//! and drag each other by a tangential spring. Walls are partners like any other; only vertices
//! meet them, which for planes and the inside of drums is exact.
//!
//! | file | holds |
//! |---|---|
//! | `bodies` | what moves of each grain, where its vertices and faces are |
//! | `neighbours` | pairs of bodies near each other, and which are whose |
//! | `pairs` | what is kept of a pair from step to step |
//! | `motion` | how two bodies move relative to each other, and how far at most |
//! | `extents` | sizes of bodies and walls that bound distances and motions |
//! | `listing` | which features of a pair may touch before long |
//! | `listed` | two such features, and what is to be computed of them |
//! | `separating_axis` | the direction that separates two bodies best |
//! | `nearest` | nearest points of two features |
//! | `workspace` | which features are measured in a step, and their measurement |
//! | `contact_group` | the contact law between features, lane by lane |
//! | `forces` | contact forces of blocks of pairs |
//! | `matrix` | symmetric matrices of six rows |
//! | `implicit_contact` | a contact whose springs and dashpot are taken implicitly |
//! | `couplings` | springs and dashpots of pairs as what couples their bodies within a step |
//! | `gaps` | gaps of pairs that close within a step, as part of that |
//! | `joint` | springs and dashpots of all pairs, taken implicitly for all bodies together |
//! | `working_copy` | what is kept between loading a world and storing it |
//! | `share` | what one worker works on in the two phases of a step |
//! | `terms` | contact forces again, term by term |
//!
//! Not here: rolling friction, liquid, laws other than Hooke's, bodies that are not convex. A
//! sphere is a core of one vertex.

mod bodies;
mod contact_group;
mod couplings;
mod extents;
mod forces;
mod gaps;
mod implicit_contact;
mod joint;
mod listed;
mod listing;
mod matrix;
mod motion;
mod nearest;
mod neighbours;
mod pairs;
mod separating_axis;
mod share;
mod terms;
mod working_copy;
mod workspace;

pub use terms::force_terms;

use super::FaultKind;
use super::row::{row, vector};
use super::step::{Kernel, Tally};
use super::walls::Walls;
use super::workers::{Batch, WorkerPool};
use crate::lanes::Processor;
use crate::physics::{FeatureRule, Integrator};
use crate::world::{Contact, World};
use bodies::{Body, Load, Placing, Shapes};
use extents::Extents;
use forces::DEEPEST;
use glam::DVec3;
use neighbours::{PairList, PairsOfBodies};
use pairs::PairForce;
use share::PolyhedraShare;
use std::sync::Arc;
use working_copy::Known;
pub use working_copy::PolyhedronKernel;

/// Width of the skin in which pairs are kept, relative to the smallest bounding radius.
const SKIN: f64 = 0.2;

/// Motions of so many steps ahead are looked for what comes to touch within one, where springs are
/// implicit: more than one, as a gap is measured farther from a centroid than any point of its body.
const LOOK_AHEAD: f64 = 1.5;

/// How far a body or a wall may move until the pairs must be found anew, relative to the skin: less
/// than half of it, by more than rounding.
const SLACK: f64 = 0.499;

impl Kernel for PolyhedronKernel {
    type Share<'a> = PolyhedraShare<'a>;

    /// Pairs and lists of the last call are kept where the world is as that call left it; else all
    /// is made anew, to the same results.
    fn load(&mut self, processor: Processor, _pool: &mut WorkerPool, world: &World) {
        self.dt = world.clock.time_step;
        if self.integrator != world.integrator() {
            self.integrator = world.integrator();
            self.resisting.fill(false);
        }
        self.gravity = row(world.gravity, 0.0);
        self.rule = (world.law.feature_springs()).map_or(FeatureRule::Full, |springs| springs.rule);
        let unmoved = self.load_bodies(world);
        if !unmoved {
            self.known_shapes = world.polyhedra.as_ref().map(|p| p.shapes.clone());
            self.shapes = Shapes::of(world, 0..world.grains.len());
            self.place_all(processor);
            self.pairs = PairList::default();
            self.find_pairs(world);
            if let Some(polyhedra) = &world.polyhedra {
                self.pairs.adopt(&polyhedra.features);
            }
        }
        self.compute_constants(world);
    }

    /// Vertices and planes follow their bodies.
    fn start(&mut self, processor: Processor) -> bool {
        let half = 0.5 * self.dt;
        for (body, load) in self.bodies.iter_mut().zip(&self.loads) {
            body.kick(load, half, self.gravity);
            body.drift(self.dt);
        }
        self.place_all(processor);
        let slack = self.slack();
        let moved = self.bodies.iter().zip(&self.reference);
        let ahead = self.look_ahead() * self.dt;
        moved
            .map(|(body, old)| body.moved_from(old, ahead))
            .any(|square| square > slack * slack)
            || self.slack_of_walls() < 0.0
    }

    /// Finds the pairs anew. Their lists of features have slacks of their own and are left alone.
    fn refresh_lists(&mut self, _pool: &mut WorkerPool, world: &World) -> u64 {
        self.find_pairs(world);
        1
    }

    /// Lists of features suit the pace of each pair by themselves.
    fn adapt_lists(&mut self, _steps: u64) {}

    /// What walls have moved since the pairs were found, in calls before, is gone already.
    fn steps_within_slack(&self) -> u64 {
        self.walls.steps_within(self.slack_of_walls(), self.dt)
    }

    fn lend<'a>(&'a mut self, batch: &'a Batch) -> Vec<PolyhedraShare<'a>> {
        PolyhedraShare::all(self, batch)
    }

    /// Nothing of a batch outlasts it but what the profile counts.
    fn note(&mut self, _tally: &Tally, _steps: u64) {}

    /// The histories of the features that touch, and the contact force of each pair that does.
    fn store(&self, _pool: &mut WorkerPool, world: &mut World) {
        let grains = &mut world.grains;
        if let Some(polyhedra) = &mut world.polyhedra {
            for (i, (body, load)) in self.bodies.iter().zip(&self.loads).enumerate() {
                grains.position[i] = body.centre();
                grains.velocity[i] = vector(body.velocity);
                grains.spin[i] = vector(body.spin);
                grains.force[i] = vector(load.force);
                grains.torque[i] = vector(load.torque);
                grains.contact_count[i] = load.contact_count() as u32;
                grains.exchanged[i] = load.exchanged;
                polyhedra.orientation[i] = body.quaternion();
                polyhedra.angular_momentum[i] = vector(body.angular_momentum);
            }
            let contacts = self.pairs.contacts();
            polyhedra.features.clear();
            polyhedra.features.reserve_exact(contacts.clone().count());
            polyhedra.features.extend(contacts);
        }
        let pairs = self.pairs.list.iter().enumerate();
        let touching = pairs
            .filter(|(k, _)| self.acting[*k] && self.forces[*k].touches())
            .map(|(k, pair)| Contact {
                grain: pair.first,
                partner: pair.partner(),
                spring: DVec3::ZERO,
                stiffness: 0.0,
                rolling: DVec3::ZERO,
                force: self.force_of(k),
                touching: true,
                bridge: None,
            });
        world.contacts.clear();
        world.contacts.extend(touching);
    }

    /// A body that is too fast first, then a pair that is pressed too deep.
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
            let overlaps = self.pairs.points_of(k).iter().map(|point| point.overlap);
            let deepest = overlaps.fold(0.0, f64::max) / self.pairs.terms[k].touch;
            (deepest > DEEPEST).then_some((pair.first as usize, FaultKind::TooDeep(deepest)))
        });
        deep.unwrap_or((0, FaultKind::NotFinite("state")))
    }

    /// Pairs of features on all outer lists.
    fn listed(&self) -> usize {
        self.pairs.list.iter().map(|pair| pair.outer.len()).sum()
    }

    fn walls(&mut self) -> &mut Walls {
        &mut self.walls
    }

    fn time_step(&self) -> f64 {
        self.dt
    }
}

impl PolyhedronKernel {
    /// Takes bodies, what acts on them and walls in; true when all of it, with the contacts'
    /// histories, is as it was left: then lists and slacks of the last call still hold. Anything
    /// that was moved from outside, by ever so little, makes all lists anew.
    fn load_bodies(&mut self, world: &World) -> bool {
        let count = world.grains.len();
        let before = std::mem::take(&mut self.walls);
        self.walls.load(&world.container);
        let bodies: Vec<Body> = (0..count).map(|i| Body::of(world, i, self.dt)).collect();
        let unmoved = self.walls.surfaces().eq(before.surfaces())
            && bodies == self.bodies
            && self.holds(world);
        self.bodies = bodies;
        self.loads.clear();
        self.loads.extend((0..count).map(|i| Load::of(world, i)));
        unmoved
    }

    /// The whole contact force of pair `k` [N].
    fn force_of(&self, k: usize) -> DVec3 {
        let force = vector(self.forces[k].force);
        if self.resisting[k] {
            force + vector(self.resistances[k].force)
        } else {
            force
        }
    }

    /// Whether the shapes and the contacts' histories are those of `world`.
    fn holds(&self, world: &World) -> bool {
        let (Some(polyhedra), Some(shapes)) = (&world.polyhedra, &self.known_shapes) else {
            return false;
        };
        let contacts = self.pairs.contacts();
        Arc::ptr_eq(shapes, &polyhedra.shapes) && contacts.eq(polyhedra.features.iter().copied())
    }

    /// Puts all vertices and planes where the bodies are.
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

    /// How far a body or a wall may move until the pairs must be found anew [m].
    fn slack(&self) -> f64 {
        SLACK * self.skin
    }

    /// How far a wall may still move [m].
    fn slack_of_walls(&self) -> f64 {
        let gone = self.walls.moved_from(&self.reference_surfaces);
        self.slack() - gone - self.look_ahead() * self.dt * self.walls.speed()
    }

    /// Motions of so many steps ahead are looked for what comes to touch.
    fn look_ahead(&self) -> f64 {
        let looks = self.integrator == Integrator::Implicit && self.rule == FeatureRule::Full;
        if looks { LOOK_AHEAD } else { 0.0 }
    }

    /// Finds the pairs that are near each other; those known keep what they hold.
    fn find_pairs(&mut self, world: &World) {
        let radii = self.bodies.iter().map(Body::reach);
        self.skin = SKIN * radii.fold(f64::INFINITY, f64::min);
        let known = std::mem::take(&mut self.pairs);
        self.pairs = PairList::find(&self.bodies, &self.walls, self.skin, known);
        let (list, count) = (&self.pairs.list, self.bodies.len());
        self.forces.clear();
        self.forces.resize(list.len(), PairForce::default());
        self.acting.clear();
        self.acting.resize(list.len(), false);
        self.resistances.clear();
        self.resistances.resize(list.len(), PairForce::default());
        self.resisting.clear();
        self.resisting.resize(list.len(), false);
        self.pairs_of = PairsOfBodies::of(list, count);
        let positions = self.bodies.iter().map(|body| body.position);
        self.reference.clear();
        self.reference.extend(positions);
        self.reference_surfaces.clear();
        self.reference_surfaces
            .extend(self.walls.surfaces().cloned());
        self.set_geometry_constants();
        self.known = Known::default();
        self.compute_constants(world);
    }

    /// What the pairs' contacts depend on of the bodies' sizes and shapes.
    fn set_geometry_constants(&mut self) {
        let extents = Extents::of(&self.bodies, &self.walls, self.skin);
        for (pair, terms) in self.pairs.list.iter().zip(&mut self.pairs.terms) {
            terms.set_geometry(pair, &self.bodies, &self.shapes, &extents);
        }
        self.extents = extents;
    }

    /// Computes what the law needs of every pair, if anything it depends on has changed.
    fn compute_constants(&mut self, world: &World) {
        let known = Known {
            law: world.law,
            materials: world.materials.clone(),
            species: world.grains.species.to_vec(),
            masses: world.grains.mass.to_vec(),
        };
        if known == self.known {
            return;
        }
        self.known = known;
        for (pair, terms) in self.pairs.list.iter().zip(&mut self.pairs.terms) {
            terms.set_law(world, pair.first as usize, pair.partner());
        }
    }
}
