//! What one worker works on during a batch of steps: its grains and pairs, and what it copies of
//! other workers' pairs.
//!
//! In: the working copy, its lists and plans ([`super::plan`]). Out: shares that take about equally
//! long, and a step of a share ([`super::pass`]).
//!
//! Grains and films stand in two copies. A step reads all of one and writes the worker's own range
//! of the other; the next goes back. All else that a step writes only its worker touches: so workers
//! meet once a step, and share no cache line but those of the grains along the cuts between them.

use super::super::ranges::{split, split_once};
use super::super::row::Row;
use super::super::step::{BatchReport, Course, Moment, PassReport, PassingShare, Share};
use super::super::tangential::UNLOADED;
use super::super::workers::{Batch, Column, ForcePhase, InPhase, MotionPhase, Phase};
use super::SphereKernel;
use super::bridges::{BridgeColumns, Bridges, Wetting};
use super::contacts::{PairRows, PairSurroundings};
use super::integrate::{BridgeLoad, GrainRows, SphereAccount, SphereLoad, StepConstants};
use super::neighbours::Neighbours;
use super::pair_list::{SpherePairs, fill_group};
use super::parts::Parts;
use super::pass::{AtWall, Pass};
use super::plan::Plan;
use super::rings::Rings;
use super::rows::{GROUP, PairKind, Slot, Sphere, SpherePair, WallId};
use crate::physics::law::{FilmConstants, Law, LawSource, LawUser, PairConstants};
use crate::physics::{ContactLaw, Liquid};

/// A worker's share of a world of spheres.
pub struct SphereShare<'a, S> {
    /// The first copy of grains and films, and the second.
    first: Copies<'a, MotionPhase>,
    second: Copies<'a, ForcePhase>,
    stepper: Stepper<'a, S>,
}

/// What takes steps from one copy to the other.
struct Stepper<'a, S> {
    plan: &'a Plan,
    common: SphereInputs<'a, S>,
    own: OwnRows<'a>,
}

/// A copy of grains and films, which phase `P` writes and the other reads.
struct Copies<'a, P> {
    bodies: Column<'a, Sphere, P>,
    films: Column<'a, f64, P>,
}

/// What only one worker touches.
struct OwnRows<'a> {
    /// Of its grains.
    loads: &'a mut [SphereLoad],
    accounts: &'a mut [SphereAccount],
    bridge_loads: &'a mut [BridgeLoad],
    /// Of its pairs.
    springs: &'a mut [Row],
    rolling: &'a mut [Row],
    forces: &'a mut [Row],
    bridges: &'a mut [BridgeColumns],
    at_walls: Vec<WallRows<'a>>,
    /// What other workers' pairs remember.
    foreign: SpherePairs,
    foreign_at_walls: Vec<WallGroup>,
    rings: &'a mut Rings,
}

/// A range of a worker's pairs with one wall.
struct WallRows<'a> {
    first: usize,
    pairs: &'a [SpherePair<WallId>],
    springs: &'a mut [Row],
    rolling: &'a mut [Row],
    forces: &'a mut [Row],
}

/// A group of another worker's pairs with one wall.
struct WallGroup {
    first: usize,
    springs: [Row; GROUP],
    rolling: [Row; GROUP],
}

/// What all workers read and none writes.
#[derive(Clone, Copy)]
struct SphereInputs<'a, S> {
    /// Where the contact law comes from: chosen once per step and worker, outside of the pair loop.
    source: S,
    /// The law that the world states.
    law: ContactLaw,
    /// Step, gravity, slack of the inner list.
    motion: &'a StepConstants,
    /// The liquid, where there is any.
    liquid: Option<&'a Liquid>,
    /// Constants of every kind of pair.
    constants: &'a [PairConstants],
    /// What bridges depend on, kind by kind; empty where nothing is wet.
    film_constants: &'a [FilmConstants],
    /// The inner list of pairs of grains.
    grain_pairs: &'a [SpherePair],
    /// The kind of all of them, if it is one.
    grain_kind: Option<PairKind>,
    /// The inner list of pairs of a grain and a wall.
    wall_pairs: &'a [SpherePair<WallId>],
    /// Which pairs are whose.
    parts: &'a Parts,
    /// Where every grain was when the inner list was filtered [m].
    reference: &'a [Row],
}

impl WallGroup {
    /// The group of `walls` that begins with number `first`.
    fn of(walls: &SpherePairs<WallId>, first: usize) -> Self {
        let copy = |rows: &[Row]| std::array::from_fn(|k| rows[first + k]);
        Self {
            first,
            springs: copy(&walls.springs),
            rolling: copy(&walls.rolling),
        }
    }
}

/// The pairs of these `numbers` with what they remember, in whole groups.
fn copied(grains: &SpherePairs, numbers: &[u32], padding: Slot) -> SpherePairs {
    let numbers = || numbers.iter().map(|number| *number as usize);
    let mut pairs: Vec<SpherePair> = numbers().map(|k| grains.pairs[k]).collect();
    let padding = SpherePair {
        grain: padding,
        partner: padding,
        kind: PairKind::default(),
    };
    fill_group(&mut pairs, padding);
    let rows = |rows: &[Row]| {
        let mut copied: Vec<Row> = numbers().map(|k| rows[k]).collect();
        copied.resize(pairs.len(), UNLOADED);
        copied
    };
    let is_wet = !grains.bridges.groups.is_empty();
    let mut bridges = Bridges::none(if is_wet { pairs.len() } else { 0 });
    if is_wet {
        for (k, number) in numbers().enumerate() {
            bridges.set(k, &grains.bridges.get(number));
        }
    }
    SpherePairs {
        springs: rows(&grains.springs),
        rolling: rows(&grains.rolling),
        forces: Vec::new(),
        kind: grains.kind,
        bridges,
        pairs,
    }
}

impl<'a, S: LawSource> SphereShare<'a, S> {
    /// The shares of a batch's workers. What one step writes and the next reads is lent as
    /// columns, what stays with a worker is cut into slices.
    pub fn all(spheres: &'a mut SphereKernel<S>, batch: &'a Batch) -> Vec<Self> {
        spheres.make_plans(batch.size());
        let plans = &spheres.plans;
        let wet = spheres.liquid.is_some();
        for (rings, plan) in spheres.rings.iter_mut().zip(plans) {
            rings.fit(plan, spheres.walls.len(), wet);
        }
        let padding = Slot(spheres.loads.len() as u32);
        let Neighbours {
            grains,
            walls,
            parts,
            reference,
            ..
        } = &mut spheres.neighbours;
        let mut foreign = (plans.iter())
            .map(|plan| {
                let groups = plan.foreign_at_walls.iter();
                let at_walls: Vec<_> = groups.map(|first| WallGroup::of(walls, *first)).collect();
                (copied(grains, &plan.foreign, padding), at_walls)
            })
            .collect::<Vec<_>>()
            .into_iter();
        let common = SphereInputs {
            source: spheres.source,
            law: spheres.law,
            motion: &spheres.motion,
            liquid: spheres.liquid.as_ref(),
            constants: &spheres.kinds.constants,
            film_constants: &spheres.kinds.films,
            grain_pairs: &grains.pairs,
            grain_kind: grains.kind,
            wall_pairs: &walls.pairs,
            parts,
            reference,
        };
        let own_grains = || plans.iter().map(|plan| plan.grains.clone());
        let own_films = || own_grains().map(|own| if wet { own } else { 0..0 });
        let own_pairs = || plans.iter().map(|plan| plan.pairs.clone());
        let own_groups = || {
            let groups = own_pairs().map(|own| own.start / GROUP..own.end / GROUP);
            groups.map(|own| if wet { own } else { 0..0 })
        };
        let own_walls = || plans.iter().map(|plan| plan.at_walls.clone());

        let mut first_bodies = batch.lend_ranges(&mut spheres.bodies, own_grains());
        let mut second_bodies = batch.lend_ranges(&mut spheres.next_bodies, own_grains());
        let mut first_films = batch.lend_ranges(&mut spheres.films, own_films());
        let mut second_films = batch.lend_ranges(&mut spheres.next_films, own_films());
        let mut loads = split_once(&mut spheres.loads, own_grains());
        let mut accounts = split_once(&mut spheres.accounts, own_grains());
        let mut bridge_loads = split_once(&mut spheres.bridge_loads, own_films());
        let mut springs = split_once(&mut grains.springs, own_pairs());
        let mut rolling = split_once(&mut grains.rolling, own_pairs());
        let mut forces = split_once(&mut grains.forces, own_pairs());
        let mut bridges = split_once(&mut grains.bridges.groups, own_groups());
        let mut wall_springs = split(&mut walls.springs, own_walls()).into_iter();
        let mut wall_rolling = split(&mut walls.rolling, own_walls()).into_iter();
        let mut wall_forces = split(&mut walls.forces, own_walls()).into_iter();
        let mut rings = spheres.rings.iter_mut();
        let wall_pairs = &walls.pairs;
        let mut share = |plan: &'a Plan| {
            let histories = wall_springs.next()?.into_iter().zip(wall_rolling.next()?);
            let rows = histories.zip(wall_forces.next()?).zip(&plan.at_walls);
            let at_walls = rows.map(|(((springs, rolling), forces), own)| WallRows {
                first: own.start,
                pairs: &wall_pairs[own.clone()],
                springs,
                rolling,
                forces,
            });
            let at_walls = at_walls.collect();
            let (foreign, foreign_at_walls) = foreign.next()?;
            Some(Self {
                first: Copies {
                    bodies: first_bodies.next()?,
                    films: first_films.next()?,
                },
                second: Copies {
                    bodies: second_bodies.next()?,
                    films: second_films.next()?,
                },
                stepper: Stepper {
                    plan,
                    common,
                    own: OwnRows {
                        loads: loads.next()?,
                        accounts: accounts.next()?,
                        bridge_loads: bridge_loads.next()?,
                        springs: springs.next()?,
                        rolling: rolling.next()?,
                        forces: forces.next()?,
                        bridges: bridges.next()?,
                        at_walls,
                        foreign,
                        foreign_at_walls,
                        rings: rings.next()?,
                    },
                },
            })
        };
        plans.iter().filter_map(&mut share).collect()
    }
}

impl<S: LawSource> Stepper<'_, S> {
    /// Takes a step from a copy into the one that phase `P` writes.
    fn step<P>(
        &mut self,
        moment: &Moment<'_>,
        (from, to): (&Copies<'_, P::Other>, &mut Copies<'_, P>),
        phase: &InPhase<'_, P>,
    ) -> PassReport
    where
        P: Phase<Other: Phase<Other = P>>,
    {
        let common = &self.common;
        let step = TakeStep {
            plan: self.plan,
            common,
            own: &mut self.own,
            moment,
            before: (from.bodies.read(phase), from.films.read(phase)),
            after: (to.bodies.write_first(phase), to.films.write_first(phase)),
        };
        common.source.choose(common.law, step)
    }
}

/// A step of a share, by a law that is chosen once for all pairs.
struct TakeStep<'s, 'a, S> {
    plan: &'a Plan,
    common: &'s SphereInputs<'a, S>,
    own: &'s mut OwnRows<'a>,
    moment: &'s Moment<'s>,
    /// All grains and films as they were, and the worker's own as they become.
    before: (&'s [Sphere], &'s [f64]),
    after: (&'s mut [Sphere], &'s mut [f64]),
}

impl<S: LawSource> LawUser for TakeStep<'_, '_, S> {
    type Output = PassReport;

    fn with<L: Law>(self, law: L) -> PassReport {
        let Self {
            plan,
            common,
            own,
            moment,
            before: (bodies_before, films_before),
            after: (bodies, films),
        } = self;
        let pairs_at_walls = common.wall_pairs;
        let own_walls = own.at_walls.iter_mut().map(|rows| AtWall {
            first: rows.first,
            rows: PairRows {
                pairs: rows.pairs,
                kind: None,
                springs: &mut *rows.springs,
                rolling: &mut *rows.rolling,
                bridges: &mut [],
            },
            forces: &mut *rows.forces,
            done: 0,
        });
        let foreign_walls = own.foreign_at_walls.iter_mut().map(|group| AtWall {
            first: group.first,
            rows: PairRows {
                pairs: &pairs_at_walls[group.first..group.first + GROUP],
                kind: None,
                springs: &mut group.springs[..],
                rolling: &mut group.rolling[..],
                bridges: &mut [],
            },
            forces: &mut [],
            done: 0,
        });
        let mut at_walls: Vec<AtWall<'_>> = own_walls.chain(foreign_walls).collect();
        let pass = Pass {
            surroundings: PairSurroundings {
                law,
                dt: common.motion.dt,
                bodies: bodies_before,
                walls: moment.walls,
                constants: common.constants,
                wetting: common.liquid.map(|liquid| Wetting {
                    liquid,
                    films: films_before,
                    constants: common.film_constants,
                }),
            },
            plan,
            own: PairRows {
                pairs: &common.grain_pairs[plan.pairs.clone()],
                kind: common.grain_kind,
                springs: &mut *own.springs,
                rolling: &mut *own.rolling,
                bridges: &mut *own.bridges,
            },
            own_forces: &mut *own.forces,
            foreign: PairRows {
                pairs: &own.foreign.pairs,
                kind: own.foreign.kind,
                springs: &mut own.foreign.springs,
                rolling: &mut own.foreign.rolling,
                bridges: &mut own.foreign.bridges.groups,
            },
            at_walls: &mut at_walls,
            rings: &mut *own.rings,
            grains: GrainRows {
                motion: common.motion,
                parts: common.parts,
                begin: plan.grains.start,
                before: bodies_before,
                bodies,
                loads: &mut *own.loads,
                accounts: &mut *own.accounts,
                films_before,
                films,
                bridge_loads: &mut *own.bridge_loads,
                references: &common.reference[plan.grains.clone()],
                last: moment.last,
            },
            timed: moment.timed,
        };
        pass.take(moment.processor)
    }
}

impl<S: LawSource> Share for SphereShare<'_, S> {
    fn follow(self, course: &Course, phase: InPhase<'_, ForcePhase>) -> BatchReport {
        course.in_passes(self, phase)
    }
}

impl<S: LawSource> PassingShare for SphereShare<'_, S> {
    fn pass_forth(&mut self, moment: &Moment<'_>, phase: &InPhase<'_, ForcePhase>) -> PassReport {
        let copies = (&self.first, &mut self.second);
        self.stepper.step(moment, copies, phase)
    }

    fn pass_back(&mut self, moment: &Moment<'_>, phase: &InPhase<'_, MotionPhase>) -> PassReport {
        let copies = (&self.second, &mut self.first);
        self.stepper.step(moment, copies, phase)
    }
}
