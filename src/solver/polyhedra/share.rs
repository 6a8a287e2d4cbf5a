//! What one worker works on during a batch of steps: its blocks of pairs and its bodies.
//!
//! In: the working copy and its pairs. Out: shares that take about equally long, and the two phases
//! of a step on a share.
//!
//! | column | length | written by | read by all in |
//! |---|---|---|---|
//! | bodies, vertices, planes, stiffnesses | bodies, features | the body's worker, motion phase | force phase |
//! | changes, motions, products | bodies, bundles | the body's worker, motion phase | force phase |
//! | forces, acting, resistances, resisting | pairs | the pair's worker, force phase | motion phase |
//! | slots, wrenches, blocks | pairs | the pair's worker, force phase | motion phase |
//! | loads | bodies | the body's worker, motion phase | nobody else |
//! | pairs, terms, points | pairs, blocks | the pair's worker, force phase | nobody else |
//!
//! A pair is one worker's, its two bodies may be others': so the pair's worker leaves a force and
//! two torques, and each body's worker sums those of its own pairs, in the order of the pairs,
//! whoever computed them. Shares are made anew for each batch, as the lists may have changed.
//!
//! Not here: the order of the phases ([`super::super::step`]), who may touch a column when
//! ([`super::super::workers`]).

use super::super::ranges::{range_of, split_once};
use super::super::row::Row;
use super::super::step::{BatchReport, Course, Outcome, PhasedShare, Share, Tally};
use super::super::walls::Walls;
use super::super::workers::{Batch, Column, ForcePhase, InPhase, MotionPhase};
use super::PolyhedronKernel;
use super::bodies::{Body, Geometry, Load, Place, Shapes};
use super::couplings::{Assembly, Blocks, Final, Image, Motion, Product, Wrench};
use super::extents::Extents;
use super::forces::{Forces, ImplicitPairs};
use super::joint::{BUNDLE, Beginning, Bodies, Next, SharedColumns, Stage};
use super::motion::{Surroundings, motions_of};
use super::nearest::Places;
use super::neighbours::PairsOfBodies;
use super::pairs::{BLOCK, ContactPoint, Pair, PairForce, Terms};
use super::workspace::Workspace;
use crate::lanes::{Lanes, Processor, Work, prefetch};
use crate::physics::{FeatureRule, Integrator};
use crate::world::Grains;
use std::ops::Range;

/// A worker's share of a world of polyhedra.
pub struct PolyhedraShare<'a> {
    common: Common<'a>,
    /// The bodies that it moves.
    own: Range<usize>,
    /// Read by all in the force phase, as are vertices and planes.
    bodies: Column<'a, Body, MotionPhase>,
    vertices: Column<'a, Row, MotionPhase>,
    planes: Column<'a, Row, MotionPhase>,
    /// Read by all in the motion phase, as is which of them act.
    forces: Column<'a, PairForce, ForcePhase>,
    acting: Column<'a, bool, ForcePhase>,
    /// What springs and dashpots that are taken implicitly do, and which: read by all in the motion
    /// phase.
    resistances: Column<'a, PairForce, ForcePhase>,
    resisting: Column<'a, bool, ForcePhase>,
    /// The sum of the normal springs on each body over its mass, where they are implicit [1/s²]:
    /// read by all in the force phase.
    stiffnesses: Column<'a, f64, MotionPhase>,
    /// What the joint solution of springs and dashpots shares.
    joint: JointColumns<'a>,
    /// What only this worker touches: loads of its bodies, all that is kept of its pairs.
    loads: &'a mut [Load],
    pairs: &'a mut [Pair],
    terms: &'a mut [Terms],
    points: &'a mut [Vec<ContactPoint>],
    workspace: &'a mut Workspace,
    /// The origin, and the velocity and the spin of every wall.
    wall_motions: Vec<[Row; 3]>,
}

/// The columns of the joint solution: see [`SharedColumns`].
struct JointColumns<'a> {
    /// Number of the first pair of the worker.
    base: u32,
    slots: Column<'a, u32, ForcePhase>,
    wrenches: Column<'a, Wrench, ForcePhase>,
    blocks: Column<'a, Blocks, ForcePhase>,
    changes: Column<'a, Motion, MotionPhase>,
    motions: Column<'a, Motion, MotionPhase>,
    products: Column<'a, f64, MotionPhase>,
}

impl<'a> JointColumns<'a> {
    /// Those of all workers; without any rows where nothing is solved jointly.
    fn all(
        shared: &'a mut SharedColumns,
        batch: &'a Batch,
        division: &Division,
    ) -> impl Iterator<Item = Self> {
        let used = !shared.changes.is_empty();
        let within = |ranges: &[Range<usize>]| {
            let ranges = ranges.iter().cloned();
            let ranges: Vec<_> = ranges.map(|own| if used { own } else { 0..0 }).collect();
            ranges.into_iter()
        };
        let by_pair = || within(&division.pairs);
        let by_body = || within(&division.bodies);
        let mut slots = batch.lend_ranges(&mut shared.slots, by_pair());
        let mut wrenches = batch.lend_ranges(&mut shared.wrenches, by_pair());
        let mut blocks = batch.lend_ranges(&mut shared.blocks, by_pair());
        let mut changes = batch.lend_ranges(&mut shared.changes, by_body());
        let mut motions = batch.lend_ranges(&mut shared.motions, by_body());
        let bundles = within(&division.bundles);
        let mut products = batch.lend_ranges(&mut shared.products, bundles);
        by_pair().map_while(move |own| {
            Some(Self {
                base: own.start as u32,
                slots: slots.next()?,
                wrenches: wrenches.next()?,
                blocks: blocks.next()?,
                changes: changes.next()?,
                motions: motions.next()?,
                products: products.next()?,
            })
        })
    }
}

/// What all workers read and none writes.
#[derive(Clone, Copy)]
struct Common<'a> {
    /// The shapes of all bodies.
    shapes: &'a Shapes,
    /// Which pairs are whose.
    pairs_of: &'a PairsOfBodies,
    /// Where every body was when the pairs were found [m].
    reference: &'a [Row],
    /// Square of the distance from there at which they must be found anew [m²].
    slack_squared: f64,
    /// Length of a step [s].
    dt: f64,
    /// Gravity [m/s²].
    gravity: Row,
    /// How the equations of motion are integrated.
    integrator: Integrator,
    /// Whether the features of a pair share its stiffness.
    rule: FeatureRule,
    /// Motions of so many steps ahead are looked for what comes to touch.
    look_ahead: f64,
    /// Sizes that bound how far two bodies move in a step.
    extents: Extents,
}

/// Which part of each column is whose, worker by worker.
struct Division {
    /// Whole blocks of pairs.
    blocks: Vec<Range<usize>>,
    /// The pairs in them.
    pairs: Vec<Range<usize>>,
    /// Bodies, in equal numbers or in whole bundles.
    bodies: Vec<Range<usize>>,
    /// Their bundles, where they are divided so.
    bundles: Vec<Range<usize>>,
    /// Their vertices.
    vertices: Vec<Range<usize>>,
    /// Their faces.
    planes: Vec<Range<usize>>,
}

impl Division {
    /// That of `world` among `size` workers.
    fn of(world: &PolyhedronKernel, size: usize) -> Self {
        let (count, pair_count) = (world.bodies.len(), world.pairs.list.len());
        let blocks = world.pairs.shares(size);
        let first_of = |block: usize| (block * BLOCK).min(pair_count);
        let pairs = blocks
            .iter()
            .map(|own| first_of(own.start)..first_of(own.end));
        let pairs = pairs.collect();
        let is_joint = world.integrator == Integrator::Implicit;
        let bundle = if is_joint { BUNDLE } else { 1 };
        let bundles: Vec<_> = (0..size)
            .map(|worker| range_of(count.div_ceil(bundle), worker, size))
            .collect();
        let first_body = |bundles: usize| (bundles * bundle).min(count);
        let bodies: Vec<_> = (bundles.iter())
            .map(|own| first_body(own.start)..first_body(own.end))
            .collect();
        let features = |first: fn(&Place) -> u32| {
            let place = |i: usize| first(&world.shapes.places[i]) as usize;
            let own = bodies.iter().map(|own| place(own.start)..place(own.end));
            own.collect()
        };
        Self {
            vertices: features(|place| place.vertex),
            planes: features(|place| place.face),
            blocks,
            pairs,
            bodies,
            bundles,
        }
    }
}

impl<'a> PolyhedraShare<'a> {
    /// The shares of a batch's workers: whole blocks of pairs, and bodies in equal numbers with
    /// their vertices and faces.
    pub fn all(world: &'a mut PolyhedronKernel, batch: &'a Batch) -> Vec<Self> {
        let needed = batch.size().max(world.workspaces.len());
        world.workspaces.resize_with(needed, Workspace::default);
        let count = world.bodies.len();
        world.stiffnesses.resize(count, 0.0);
        if world.integrator == Integrator::Implicit {
            world.implicit.resize(world.pairs.list.len(), count);
        } else {
            world.implicit.clear();
        }
        let division = Division::of(world, batch.size());
        let by_pair = || division.pairs.iter().cloned();
        let by_body = || division.bodies.iter().cloned();
        let vertices = division.vertices.iter().cloned();
        let planes = division.planes.iter().cloned();
        let wall_motions = motions_of(&world.walls);
        let common = Common {
            shapes: &world.shapes,
            pairs_of: &world.pairs_of,
            reference: &world.reference,
            slack_squared: world.slack() * world.slack(),
            dt: world.dt,
            gravity: world.gravity,
            integrator: world.integrator,
            rule: world.rule,
            look_ahead: world.look_ahead(),
            extents: world.extents,
        };
        let mut bodies = batch.lend_ranges(&mut world.bodies, by_body());
        let mut vertices = batch.lend_ranges(&mut world.vertices, vertices);
        let mut planes = batch.lend_ranges(&mut world.planes, planes);
        let mut forces = batch.lend_ranges(&mut world.forces, by_pair());
        let mut acting = batch.lend_ranges(&mut world.acting, by_pair());
        let mut resistances = batch.lend_ranges(&mut world.resistances, by_pair());
        let mut resisting = batch.lend_ranges(&mut world.resisting, by_pair());
        let mut stiffnesses = batch.lend_ranges(&mut world.stiffnesses, by_body());
        let mut joint = JointColumns::all(&mut world.implicit, batch, &division);
        let mut loads = split_once(&mut world.loads, by_body());
        let mut pairs = split_once(&mut world.pairs.list, by_pair());
        let mut terms = split_once(&mut world.pairs.terms, by_pair());
        let mut points = split_once(&mut world.pairs.points, division.blocks.iter().cloned());
        let mut workspaces = world.workspaces.iter_mut();
        let share = |own: Range<usize>| {
            Some(Self {
                common,
                own,
                bodies: bodies.next()?,
                vertices: vertices.next()?,
                planes: planes.next()?,
                forces: forces.next()?,
                acting: acting.next()?,
                resistances: resistances.next()?,
                resisting: resisting.next()?,
                stiffnesses: stiffnesses.next()?,
                joint: joint.next()?,
                loads: loads.next()?,
                pairs: pairs.next()?,
                terms: terms.next()?,
                points: points.next()?,
                workspace: workspaces.next()?,
                wall_motions: wall_motions.clone(),
            })
        };
        by_body().filter_map(share).collect()
    }
}

impl Share for PolyhedraShare<'_> {
    fn follow(self, course: &Course, phase: InPhase<'_, ForcePhase>) -> BatchReport {
        course.in_phases(self, phase)
    }
}

impl PhasedShare for PolyhedraShare<'_> {
    fn compute_forces(
        &mut self,
        processor: Processor,
        walls: &Walls,
        phase: &InPhase<'_, ForcePhase>,
    ) -> Tally {
        let common = &self.common;
        processor.run(Forces {
            surroundings: Surroundings {
                dt: common.dt,
                rule: common.rule,
                look_ahead: common.look_ahead,
                bodies: self.bodies.read(phase),
                geometry: Geometry {
                    shapes: common.shapes,
                    places: Places {
                        vertices: self.vertices.read(phase),
                        planes: self.planes.read(phase),
                        corners: &common.shapes.loops,
                    },
                },
                walls,
                wall_motions: &self.wall_motions,
                extents: common.extents,
            },
            pairs: &mut *self.pairs,
            terms: &mut *self.terms,
            points: &mut *self.points,
            effects: self.forces.write_first(phase),
            acting: self.acting.write_first(phase),
            implicit: (common.integrator == Integrator::Implicit).then(|| ImplicitPairs {
                resisting: self.resisting.write_first(phase),
                slots: self.joint.slots.write_first(phase),
                base: self.joint.base,
            }),
            workspace: &mut *self.workspace,
        })
    }

    fn has_sweep(&self) -> bool {
        match self.common.integrator {
            Integrator::Explicit => false,
            Integrator::Implicit => !self.workspace.joint.progress.is_done,
        }
    }

    fn respond(&mut self, processor: Processor, sweep: usize, phase: &InPhase<'_, MotionPhase>) {
        if sweep > 0 {
            return self.move_jointly(processor, phase);
        }
        let incidence = Incidence {
            forces: self.forces.read(phase),
            acting: self.acting.read(phase),
            resistances: self.resistances.read(phase),
            resisting: self.resisting.read(phase),
            pairs_of: self.common.pairs_of,
        };
        let bodies = self.bodies.write_first(phase);
        let stiffnesses = self.stiffnesses.write_first(phase);
        let all = bodies.iter().zip(&mut *self.loads).zip(stiffnesses);
        for (i, ((body, load), stiffness)) in self.own.clone().zip(all) {
            *stiffness = incidence.sum(i, load) * body.inverse_mass();
        }
    }

    fn resist(&mut self, processor: Processor, sweep: usize, phase: &InPhase<'_, ForcePhase>) {
        self.resist_jointly(processor, sweep == 0, phase);
    }

    fn move_grains(
        &mut self,
        processor: Processor,
        last: bool,
        phase: &InPhase<'_, MotionPhase>,
    ) -> Outcome {
        processor.run(Finish {
            own: self.own.clone(),
            bodies: self.bodies.write_first(phase),
            loads: &mut *self.loads,
            vertices: self.vertices.write_first(phase),
            planes: self.planes.write_first(phase),
            incidence: Incidence {
                forces: self.forces.read(phase),
                acting: self.acting.read(phase),
                resistances: self.resistances.read(phase),
                resisting: self.resisting.read(phase),
                pairs_of: self.common.pairs_of,
            },
            common: self.common,
            last,
        })
    }
}

/// The sweeps of the joint solution ([`super::joint`]):
///
/// | sweep | bodies | pairs |
/// |---|---|---|
/// | 0 | how they move without their pairs | assemble their matrices |
/// | 1 | set their equations up | products |
/// | 2, 4, … | sum the products | choose the next search |
/// | 3, 5, … | go along it | products |
///
/// Once little is left of the equations, the pairs let go of gaps that stay open in the place of
/// the products, and the sweeps begin again with the first; the second time they find the wrenches.
impl PolyhedraShare<'_> {
    /// What the worker's bodies do in a `sweep` after the first.
    fn move_jointly(&mut self, processor: Processor, phase: &InPhase<'_, MotionPhase>) {
        let joint = &mut self.joint;
        let progress = self.workspace.joint.progress;
        let stage = match progress.next {
            Next::Begin => Stage::Begin(Beginning {
                own: self.own.clone(),
                pairs_of: self.common.pairs_of,
                resisting: self.resisting.read(phase),
                slots: joint.slots.read(phase),
                bodies: self.bodies.write_first(phase),
                loads: &*self.loads,
                gravity: self.common.gravity,
                dt: self.common.dt,
                blocks: joint.blocks.read(phase),
                goes_on: progress.is_amended,
            }),
            Next::Sum => Stage::Sum,
            Next::Go => Stage::Go,
        };
        processor.run(Bodies {
            stage,
            joint: &mut self.workspace.joint,
            wrenches: joint.wrenches.read(phase),
            changes: joint.changes.write_first(phase),
            motions: joint.motions.write_first(phase),
            products: joint.products.write_first(phase),
        });
    }

    /// What the worker's pairs do in a sweep; `begins` at the first of a step.
    fn resist_jointly(
        &mut self,
        processor: Processor,
        begins: bool,
        phase: &InPhase<'_, ForcePhase>,
    ) {
        let (joint, own) = (&mut self.joint, &mut self.workspace.joint);
        if !begins {
            let products = joint.products.read(phase);
            if own.progress.next == Next::Sum {
                return own.progress.search(products);
            }
            own.progress.conclude(products);
        }
        let is_done = own.progress.is_done;
        let amends = !begins && !is_done && own.progress.next == Next::Begin;
        if begins || amends {
            processor.run(Assembly {
                dt: self.common.dt,
                couplings: &own.couplings,
                gaps: &mut own.gaps,
                changes: amends.then(|| joint.changes.read(phase)),
                bodies: self.bodies.read(phase),
                stiffnesses: self.stiffnesses.read(phase),
                walls: &self.wall_motions,
                columns: &mut own.columns,
                wrenches: joint.wrenches.write_first(phase),
                blocks: joint.blocks.write_first(phase),
            });
        }
        if begins {
            return;
        }
        let motions = if is_done || amends {
            &joint.changes
        } else {
            &joint.motions
        };
        let product = Product {
            sides: &own.sides,
            columns: &own.columns,
            motions: motions.read(phase),
        };
        if is_done {
            processor.run(Final {
                dt: self.common.dt,
                couplings: &own.couplings,
                product,
                walls: &self.wall_motions,
                forces: self.resistances.write_first(phase),
            });
        } else {
            processor.run(Image {
                factor: amends.then_some(-1.0 / self.common.dt),
                product,
                wrenches: joint.wrenches.write_first(phase),
            });
        }
    }
}

/// What every pair does, and which are whose.
#[derive(Clone, Copy)]
struct Incidence<'a> {
    /// The contact force of every pair.
    forces: &'a [PairForce],
    /// Which of them act.
    acting: &'a [bool],
    /// What springs and dashpots do that are taken implicitly, and which pairs have such.
    resistances: &'a [PairForce],
    resisting: &'a [bool],
    /// Which pairs are whose.
    pairs_of: &'a PairsOfBodies,
}

/// Finishes a step for a range of bodies and, unless it is the last of a call, starts the next.
struct Finish<'a> {
    /// Numbers of the bodies.
    own: Range<usize>,
    /// The bodies, what acts on them, their vertices and faces.
    bodies: &'a mut [Body],
    loads: &'a mut [Load],
    vertices: &'a mut [Row],
    planes: &'a mut [Row],
    /// Where to find the forces.
    incidence: Incidence<'a>,
    common: Common<'a>,
    /// Whether this is the last step of a call.
    last: bool,
}

impl Work for Finish<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        let (shapes, common) = (self.common.shapes, &self.common);
        let half = 0.5 * common.dt;
        let mut outcome = Outcome::default();
        let from = shapes.places[self.own.start];
        for (i, (body, load)) in self.own.zip(self.bodies.iter_mut().zip(self.loads)) {
            if common.integrator == Integrator::Explicit {
                self.incidence.sum(i, load);
            } else {
                self.incidence.resist(i, body, load, common);
            }
            body.kick(load, half, common.gravity);
            if self.last {
                body.update_spin();
                outcome.fault |= !body.is_sane();
                continue;
            }
            body.kick(load, half, common.gravity);
            body.drift(common.dt);
            outcome.fault |= !body.is_sane();
            let (begin, end) = (shapes.places[i], shapes.places[i + 1]);
            let span = |a: u32, b: u32, start: u32| (a - start) as usize..(b - start) as usize;
            shapes.place::<N::Quad>(
                processor,
                i,
                body,
                &mut self.vertices[span(begin.vertex, end.vertex, from.vertex)],
                &mut self.planes[span(begin.face, end.face, from.face)],
            );
            let moved = body.moved_from(&common.reference[i], common.look_ahead * common.dt);
            outcome.refresh |= moved > common.slack_squared;
        }
        outcome
    }
}

impl Incidence<'_> {
    /// Asks for what the pairs do of which body `i` is the second: it lies scattered.
    #[inline(always)]
    fn fetch(&self, i: usize) {
        if i < self.pairs_of.count() {
            for &pair in self.pairs_of.of_body(i).0 {
                if self.acting[pair as usize] {
                    prefetch::<_, 2>(&self.forces[pair as usize..=pair as usize]);
                }
            }
        }
    }

    /// Sums what springs and dashpots that are taken implicitly do to body `i`, in the pairs' order.
    #[inline(always)]
    fn resistance(&self, i: usize) -> Load {
        let (as_second, as_first) = self.pairs_of.of_body(i);
        let mut load = Load::default();
        for pair in as_second.iter().map(|&pair| pair as usize) {
            if self.resisting[pair] {
                let force = &self.resistances[pair];
                for axis in 0..3 {
                    load.force[axis] -= force.force[axis];
                    load.torque[axis] += force.second[axis];
                }
            }
        }
        for pair in as_first {
            if self.resisting[pair] {
                let force = &self.resistances[pair];
                for axis in 0..3 {
                    load.force[axis] += force.force[axis];
                    load.torque[axis] += force.first[axis];
                }
                load.exchanged[Grains::BY_WALLS] += force.exchanged[Grains::BY_WALLS];
            }
        }
        load
    }

    /// Adds what they do to body `i` to its load, and books what they lose: what walls do
    /// against them, less what they do to the body by the mean of its velocities before and after,
    /// `½ Δt (F·(v⁻ + v⁺) + T·(ω⁻ + ω⁺))`: what they change of its kinetic energy from half step to
    /// half step, but for how its inertia turns meanwhile.
    #[inline(always)]
    fn resist(&self, i: usize, body: &Body, load: &mut Load, common: &Common<'_>) {
        let resistance = self.resistance(i);
        *load = load.with(&resistance);
        let [velocity, spin] = body.half_a_step_ahead(load, common.dt, common.gravity);
        let mut work = 0.0;
        for axis in 0..3 {
            work += resistance.force[axis] * (body.velocity[axis] + velocity[axis]);
            work += resistance.torque[axis] * (body.spin[axis] + spin[axis]);
        }
        let by_walls = resistance.exchanged[Grains::BY_WALLS];
        load.exchanged[Grains::IN_DASHPOTS] += by_walls - 0.5 * common.dt * work;
        load.exchanged[Grains::BY_WALLS] += by_walls;
    }

    /// Sums what the pairs of body `i` do to it, in the pairs' order; returns the sum of its normal
    /// springs, where they are taken implicitly [N/m].
    #[inline(always)]
    fn sum(&self, i: usize, load: &mut Load) -> f64 {
        let mut stiffness = 0.0;
        let (as_second, as_first) = self.pairs_of.of_body(i);
        self.fetch(i + 2);
        load.force = [0.0; 4];
        load.torque = [0.0; 4];
        for pair in as_second.iter().map(|&pair| pair as usize) {
            if !self.acting[pair] {
                continue;
            }
            let force = &self.forces[pair];
            for axis in 0..3 {
                load.force[axis] -= force.force[axis];
                load.torque[axis] += force.second[axis];
            }
            load.force[3] += force.contact_count();
            stiffness += force.stiffness();
        }
        for pair in as_first {
            if !self.acting[pair] {
                continue;
            }
            let force = &self.forces[pair];
            for axis in 0..4 {
                load.force[axis] += force.force[axis];
                load.torque[axis] += force.first[axis];
                load.exchanged[axis] += force.exchanged[axis];
            }
            stiffness += force.stiffness();
        }
        stiffness
    }
}
