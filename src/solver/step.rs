//! One step, from top to bottom, for grains of every shape.
//!
//! In: a world, and a [`Kernel`] that knows how grains of its shape are listed, pressed and moved.
//! Out: the world some steps later, or a [`Fault`] and the world as it was. This file is the order
//! of work; what each stage does is in [`super::spheres`] and [`super::polyhedra`], how workers
//! share it in [`super::workers`].
//!
//! A call of `n` steps is
//!
//! | stage | what happens | timed as |
//! |---|---|---|
//! | load | the world's columns become the kernel's rows | exchange |
//! | start | first half kick and drift | integration |
//! | lists | neighbour lists are brought up to date, if a grain or wall has moved far | neighbours |
//! | forces | every worker computes the forces of its pairs | contacts |
//! | motion | every worker sums the forces on its grains, kicks twice, drifts | integration |
//! | store | rows become columns again, clock, walls and angle follow | exchange |
//!
//! where forces and motion alternate in batches of steps, between which only the lists are touched.
//! Polyhedra do one after the other and meet between; spheres do both in one pass
//! ([`super::spheres`]), from one copy of their grains into another. The motion of the last step is
//! one kick, without a drift. Velocity Verlet's second half kick of
//! one step and the first of the next are one pass over the grains.
//!
//! Faults are looked for where they are cheap: every grain's speed after every step, as a number
//! that is not finite makes a speed that is not. A call that meets one gives the world back as it
//! was, and only then asks which grain it was and why.
//!
//! Not here: any formula.

use super::barrier::OwnLine;
use super::profile::{Profile, Stage};
use super::walls::Walls;
use super::workers::{Batch, ForcePhase, InPhase, MotionPhase, WorkerPool};
use super::{Fault, FaultKind};
use crate::lanes::Processor;
use crate::world::World;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The profile reads the clock in one step out of this many: reading it costs as much as a hundred
/// grains.
const STEPS_PER_TIMING: u64 = 16;

/// The working copy of a world of grains of one shape.
pub trait Kernel {
    /// What one worker works on during a batch.
    type Share<'a>: Share
    where
        Self: 'a;

    /// Takes `world` in; what is known of it from the last call is kept.
    fn load(&mut self, processor: Processor, pool: &mut WorkerPool, world: &World);

    /// Kicks and drifts the grains from the forces of the world; true when the lists must be
    /// brought up to date. The walls have moved already.
    fn start(&mut self, processor: Processor) -> bool;

    /// Brings the lists up to date with the positions; returns how often neighbours were searched
    /// for.
    fn refresh_lists(&mut self, pool: &mut WorkerPool, world: &World) -> u64;

    /// Makes the lists suit batches of so many steps.
    fn adapt_lists(&mut self, steps: u64);

    /// Steps in which no wall uses up what the lists allow it, at least one.
    fn steps_within_slack(&self) -> u64;

    /// A share for each of the batch's workers.
    fn lend<'a>(&'a mut self, batch: &'a Batch) -> Vec<Self::Share<'a>>;

    /// Takes note of what a batch of so many steps came to.
    fn note(&mut self, tally: &Tally, steps: u64);

    /// Puts all but clock and walls back into `world`.
    fn store(&self, pool: &mut WorkerPool, world: &mut World);

    /// The grain whose state is absurd, and what is wrong with it.
    fn find_fault(&self) -> (usize, FaultKind);

    /// Number of listed pairs.
    fn listed(&self) -> usize;

    /// The walls at the time of the positions.
    fn walls(&mut self) -> &mut Walls;

    /// Length of a step [s].
    fn time_step(&self) -> f64;
}

/// What one worker works on during a batch of steps.
pub trait Share: Send {
    /// Goes through the batch.
    fn follow(self, course: &Course, phase: InPhase<'_, ForcePhase>) -> BatchReport;
}

/// A share whose steps are two phases: all meet after the forces and after the motion.
pub trait PhasedShare: Send {
    /// Computes the forces of the worker's pairs. `walls` are the walls at the time of the
    /// positions.
    fn compute_forces(
        &mut self,
        processor: Processor,
        walls: &Walls,
        phase: &InPhase<'_, ForcePhase>,
    ) -> Tally;

    /// Whether there is another sweep, in which bodies respond to their pairs and pairs resist their
    /// bodies: none where all forces are explicit. All workers say the same.
    fn has_sweep(&self) -> bool;

    /// Makes known how the worker's grains move after the forces and the sweeps so far.
    fn respond(&mut self, processor: Processor, sweep: usize, phase: &InPhase<'_, MotionPhase>);

    /// Solves what the worker's pairs do implicitly.
    fn resist(&mut self, processor: Processor, sweep: usize, phase: &InPhase<'_, ForcePhase>);

    /// Sums the forces on the worker's grains and moves them; at the `last` step of a call they
    /// stay where they are and their velocities become those of that time.
    fn move_grains(
        &mut self,
        processor: Processor,
        last: bool,
        phase: &InPhase<'_, MotionPhase>,
    ) -> Outcome;
}

/// A share whose steps are one pass each, from one copy of the grains into another and from that
/// back: all meet once a step.
pub trait PassingShare: Send {
    /// Takes a step from the first copy into the second.
    fn pass_forth(&mut self, moment: &Moment<'_>, phase: &InPhase<'_, ForcePhase>) -> PassReport;

    /// Takes the next one, back into the first.
    fn pass_back(&mut self, moment: &Moment<'_>, phase: &InPhase<'_, MotionPhase>) -> PassReport;
}

/// A step of a batch.
pub struct Moment<'a> {
    /// What the processor can.
    pub processor: Processor,
    /// The walls at the time of the positions.
    pub walls: &'a Walls,
    /// Whether it is the last step of a call: grains stay where they are and their velocities
    /// become those of that time.
    pub last: bool,
    /// Whether the clock is to be read.
    pub timed: bool,
}

/// What a pass came to.
#[derive(Clone, Copy, Debug, Default)]
pub struct PassReport {
    /// What came of computing forces.
    pub tally: Tally,
    /// What the grains ask for.
    pub outcome: Outcome,
    /// Time spent on forces and on motion, where it was clocked.
    pub times: [Duration; 2],
}

/// What a worker's grains ask for after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Some grain has used up the slack of the lists.
    pub refresh: bool,
    /// Some grain's state is absurd.
    pub fault: bool,
}

impl Outcome {
    /// Adds what other grains ask for.
    pub fn add(&mut self, other: Self) {
        self.refresh |= other.refresh;
        self.fault |= other.fault;
    }
}

/// What came of computing forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Liquid bridges that broke.
    pub ruptures: u64,
    /// Lists of the features of two polyhedra made.
    pub relisted: u64,
    /// Some pair's state is absurd.
    pub fault: bool,
}

impl Tally {
    /// Adds what another worker, or another step, came to.
    pub fn add(&mut self, other: &Self) {
        self.ruptures += other.ruptures;
        self.relisted += other.relisted;
        self.fault |= other.fault;
    }
}

/// What a solver works with.
pub struct Resources<'a> {
    /// The worker pool.
    pub pool: &'a mut WorkerPool,
    /// What the processor can.
    pub processor: Processor,
    /// Where the time goes.
    pub profile: &'a mut Profile,
}

impl Resources<'_> {
    /// Takes `steps` steps of `world`.
    ///
    /// # Errors
    /// A [`Fault`] when a grain's state becomes absurd; `world` is then as it was.
    pub fn advance(
        mut self,
        kernel: &mut impl Kernel,
        world: &mut World,
        steps: u64,
    ) -> Result<(), Fault> {
        let processor = self.processor;
        let pool = &mut *self.pool;
        self.profile
            .time_stage(Stage::Exchange, || kernel.load(processor, pool, world));
        self.take_steps(kernel, world, steps)
            .map_err(|done| diagnose(kernel, world, done))?;
        let pool = &mut *self.pool;
        self.profile
            .time_stage(Stage::Exchange, || store(kernel, pool, world, steps));
        self.profile.listed = kernel.listed();
        Ok(())
    }

    /// Takes `steps` steps of the working copy, batch by batch; on a fault, says after how many.
    fn take_steps(
        &mut self,
        kernel: &mut impl Kernel,
        world: &World,
        steps: u64,
    ) -> Result<(), u64> {
        let processor = self.processor;
        let mut refresh = self.profile.time_stage(Stage::Integration, || {
            let dt = kernel.time_step();
            kernel.walls().advance(dt);
            kernel.start(processor)
        });
        let mut done = 0;
        while done < steps {
            if refresh {
                let pool = &mut *self.pool;
                let searches = self
                    .profile
                    .time_stage(Stage::Neighbours, || kernel.refresh_lists(pool, world));
                self.profile.rebuilds += searches;
            }
            let batch = self.take_batch(kernel, steps - done);
            batch.book(self.profile);
            kernel.note(&batch.tally, batch.steps);
            done += batch.steps;
            if batch.fault {
                return Err(done);
            }
            // The end of a call cuts a list's life short: it says nothing of how long the list
            // would have lived.
            if done < steps {
                kernel.adapt_lists(batch.steps);
                refresh = true;
            }
        }
        Ok(())
    }

    /// Takes up to `remaining` steps on the lists as they are; the workers stay in step from
    /// beginning to end.
    fn take_batch(&mut self, kernel: &mut impl Kernel, remaining: u64) -> BatchReport {
        let dt = kernel.time_step();
        let course = Course {
            processor: self.processor,
            remaining,
            limit: remaining.min(kernel.steps_within_slack()),
            dt,
            walls: kernel.walls().clone(),
            requests: Default::default(),
        };
        let batch = Batch::new(self.pool.size());
        let shares = kernel.lend(&batch);
        let reports = self
            .pool
            .run(&batch, shares, |share, phase| share.follow(&course, phase));
        let mut whole = BatchReport::default();
        for (worker, report) in reports.iter().enumerate() {
            if worker == 0 {
                (whole.steps, whole.times) = (report.steps, report.times);
            }
            whole.tally.add(&report.tally);
        }
        whole.fault = course
            .requests
            .iter()
            .any(|asked| asked.0.fault.load(Ordering::Relaxed));
        // At the last step of a call nothing moves any more.
        let moves = whole.steps - u64::from(whole.steps == remaining);
        (0..moves).for_each(|_| kernel.walls().advance(dt));
        whole
    }
}

/// What a batch of steps came to, for one worker or for all.
#[derive(Default)]
pub struct BatchReport {
    steps: u64,
    fault: bool,
    tally: Tally,
    /// Time spent on forces and on motion in the steps that were timed.
    times: [Duration; 2],
}

impl BatchReport {
    /// Whether the worker of this number reads the clock in the next step.
    fn is_timed(&self, worker: usize) -> bool {
        worker == 0 && self.steps.is_multiple_of(STEPS_PER_TIMING)
    }

    /// Books the times, scaled up to all steps, and what was counted.
    fn book(&self, profile: &mut Profile) {
        let scale = STEPS_PER_TIMING.min(self.steps.max(1)) as u32;
        profile.add(Stage::Contacts, self.times[0] * scale);
        profile.add(Stage::Integration, self.times[1] * scale);
        profile.relisted += self.tally.relisted;
    }
}

/// What all workers of a batch go by.
pub struct Course {
    processor: Processor,
    /// Steps to the end of the call.
    remaining: u64,
    /// Steps of this batch at most.
    limit: u64,
    dt: f64,
    walls: Walls,
    /// What some worker asks for, in even and in odd steps: those of a step are read at the beginning
    /// of the next, while a worker that is ahead may write those of that one already. Each on lines of its
    /// own, as all read them.
    requests: [OwnLine<BatchRequests>; 2],
}

/// What workers ask for: the batch ends after the step.
#[derive(Default)]
struct BatchRequests {
    /// The lists are to be brought up to date.
    refresh: AtomicBool,
    /// A grain's or a pair's state is absurd.
    fault: AtomicBool,
}

impl Course {
    /// One worker's way through the batch, in two phases a step.
    pub fn in_phases<'a>(
        &self,
        mut share: impl PhasedShare,
        mut forces: InPhase<'a, ForcePhase>,
    ) -> BatchReport {
        let mut report = BatchReport::default();
        // A copy of its own, which moves as all others do.
        let mut walls = self.walls.clone();
        while self.goes_on(&report) {
            let begin = report.is_timed(forces.worker()).then(Instant::now);
            let tally = share.compute_forces(self.processor, &walls, &forces);
            let mut sweep = 0;
            while share.has_sweep() {
                let responding = forces.meet();
                share.respond(self.processor, sweep, &responding);
                forces = responding.meet();
                share.resist(self.processor, sweep, &forces);
                sweep += 1;
            }
            let motion: InPhase<'a, MotionPhase> = forces.meet();
            let middle = begin.map(|_| Instant::now());
            let outcome = share.move_grains(self.processor, self.is_last(&report), &motion);
            let mut pass = PassReport {
                tally,
                outcome,
                ..PassReport::default()
            };
            self.ask(&report, &pass);
            forces = motion.meet();
            if let (Some(begin), Some(middle)) = (begin, middle) {
                pass.times = [middle - begin, middle.elapsed()];
            }
            self.finish(&mut report, &mut walls, &pass);
        }
        report
    }

    /// One worker's way through the batch, in one pass a step.
    pub fn in_passes<'a>(
        &self,
        mut share: impl PassingShare,
        mut forth: InPhase<'a, ForcePhase>,
    ) -> BatchReport {
        let mut report = BatchReport::default();
        let mut walls = self.walls.clone();
        while self.goes_on(&report) {
            let moment = self.moment(&report, &walls, forth.worker());
            let pass = share.pass_forth(&moment, &forth);
            self.ask(&report, &pass);
            let back: InPhase<'a, MotionPhase> = forth.meet();
            self.finish(&mut report, &mut walls, &pass);
            if !self.goes_on(&report) {
                break;
            }
            let moment = self.moment(&report, &walls, back.worker());
            let pass = share.pass_back(&moment, &back);
            self.ask(&report, &pass);
            forth = back.meet();
            self.finish(&mut report, &mut walls, &pass);
        }
        report
    }

    fn moment<'w>(&self, report: &BatchReport, walls: &'w Walls, worker: usize) -> Moment<'w> {
        Moment {
            processor: self.processor,
            walls,
            last: self.is_last(report),
            timed: report.is_timed(worker),
        }
    }

    /// Whether the next step is the last of the call.
    fn is_last(&self, report: &BatchReport) -> bool {
        report.steps + 1 == self.remaining
    }

    /// Whether there is a next step, by what was asked for in the last one.
    fn goes_on(&self, report: &BatchReport) -> bool {
        let BatchRequests { refresh, fault } = &self.requests[(report.steps + 1) as usize % 2].0;
        let asked = refresh.load(Ordering::Relaxed) || fault.load(Ordering::Relaxed);
        report.steps < self.limit && !asked
    }

    /// Makes known what the step asks for, before all meet.
    fn ask(&self, report: &BatchReport, pass: &PassReport) {
        let requests = &self.requests[report.steps as usize % 2].0;
        raise(&requests.refresh, pass.outcome.refresh);
        raise(&requests.fault, pass.outcome.fault || pass.tally.fault);
    }

    /// Goes on to the next step.
    fn finish(&self, report: &mut BatchReport, walls: &mut Walls, pass: &PassReport) {
        if !self.is_last(report) {
            walls.advance(self.dt);
        }
        report.steps += 1;
        report.tally.add(&pass.tally);
        for (sum, time) in report.times.iter_mut().zip(pass.times) {
            *sum += time;
        }
    }
}

/// Sets `flag` where `raised`; writing it at every step would take its cache line from the other
/// workers.
fn raise(flag: &AtomicBool, raised: bool) {
    if raised {
        flag.store(true, Ordering::Relaxed);
    }
}

/// Puts the working copy, `steps` steps on, back into `world`.
fn store(kernel: &mut impl Kernel, pool: &mut WorkerPool, world: &mut World, steps: u64) {
    kernel.store(pool, world);
    world.clock.step += steps;
    let dt = kernel.time_step();
    kernel.walls().store(&mut world.container, steps, dt);
}

/// What went wrong with which grain, `steps` steps after `world`.
fn diagnose(kernel: &impl Kernel, world: &World, steps: u64) -> Fault {
    let (grain, kind) = kernel.find_fault();
    Fault {
        grain,
        kind,
        time: world.clock.time_at(world.clock.step + steps),
        good_time: world.time(),
    }
}
