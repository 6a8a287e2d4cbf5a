//! Springs and dashpots of all pairs taken implicitly, for all bodies together.
//!
//! In: loads of the bodies, the matrix `H` of every pair ([`super::couplings`]). Out: the change of
//! every body's velocity and spin in the step, from which each pair's wrench follows.
//!
//! # The step
//!
//! Forces are known at the positions of the step's middle; velocities `u⁻` are those of half a step
//! before, `u⁺ = u⁻ + Δu` of half a step after. With the overlap `δ` of the middle, and
//! `δ ∓ Δt w·u` half-way to the last and the next, Newmark's method takes a normal spring at
//!
//! ```text
//! δ + σ Δt w·u⁻ + β Δt w·Δu,   β = ¼ (1 + σ)²,
//! ```
//!
//! which for `σ = 0` is his average acceleration: second order, without damping of its own, stable
//! for any step. A spring that is much stiffer than the step is short would throw its bodies back
//! and forth; `σ = 1` takes the spring at the step's end, which cannot. So `σ = q²/(1 + q²)`,
//! `q = ¼ y²`, `y² = Δt² ΣK_n (1/m)` over all normal springs on either body: what it adds is of
//! fifth order in the step. A dashpot is taken by the θ-method, `(1 − θ) u⁻ + θ u⁺`, with
//! `θ = (1 + x)/(2 + x)`, `x = y² (c/K_n)/Δt`, a soft one at the middle of the step and a stiff one
//! at its end. Gaps that close within the step belong to it as well ([`super::gaps`]).
//!
//! Along the surfaces springs of contacts that stick have `σ = 0`. One that slides drags with what
//! Coulomb's law allows it at this moment ([`super::contact_group`]), whatever happens in the step;
//! were that all, a light body would be thrown back and forth by frictions that reverse its slip in
//! a step. Against a change of its slip it is therefore as stiff as the force that it drags with over
//! the way that it slides in a step, at most `K_t`: steady slips feel nothing of it, and what they
//! feel of it while they change falls with the square of the step.
//!
//! Directions are those of this moment (linearly implicit). With masses and inertias `M` and the
//! pairs' motions `B u` this is one symmetric, positive system,
//!
//! ```text
//! (M + Bᵀ H B) Δu = Δt F,   F: all forces of this moment, and what pairs add by u⁻.
//! ```
//!
//! # How it is solved
//!
//! By conjugate gradients, each body preconditioned by the inverse of its own two blocks, for its
//! velocity and its spin, in the form of Chronopoulos and Gear (1989), which reuses the product of
//! the residuals for that of the searches. They begin at nothing: so a step depends on the state
//! alone. What is applied is not `Δu` but the pairs' wrenches, equal and opposite: momentum and
//! angular momentum stay, however far the iterations went. A body then moves by what `Δu` leaves of
//! its equation too, the more the lighter it is: looser than [`TOLERANCE`] steps of 40 µs of a
//! paper's column heat up.
//!
//! Then gaps that stay open after all are let go, and the iterations go on with what is left of the
//! equations without them.
//!
//! Products are summed body by body within [`BUNDLE`]s, and these in order, by every worker for
//! itself: the same bits whatever their number.
//!
//! # What it is not
//!
//! A contact lets go where spring and dashpot would pull by `u⁻`; one that comes to pull within the
//! step does so to its end. Which contacts there are, and which slide, is told by the beginning of
//! the step, but for gaps that close. Springs that turn are as explicit as ever. What springs take
//! beyond what they store is booked with the dashpots, as what those lose.
//!
//! Not here: what springs and dashpots are ([`super::contact_group`]), the order of the phases
//! ([`super::share`]).

use super::super::row::Row;
use super::bodies::{Body, Load};
use super::couplings::{Blocks, Coupling, Motion, Symmetric, Wrench};
use super::gaps::Gap;
use super::neighbours::PairsOfBodies;
use super::pairs::PackedPartner;
use crate::lanes::{Lanes, Work};
use std::ops::Range;

/// Bodies whose products are summed together.
pub const BUNDLE: usize = 16;

/// Searches at most: a column of the paper takes 10 to 20.
const MOST_SEARCHES: u32 = 60;

/// Where searches end: what is left of the equations, in the norm of the preconditioner, relative
/// to what it was at first.
const TOLERANCE: f64 = 1e-3;

/// What one worker keeps of the joint solution within a step.
#[derive(Default)]
pub struct Joint {
    /// Its pairs.
    pub couplings: Vec<Coupling>,
    /// Their sides.
    pub sides: Vec<[PackedPartner; 2]>,
    /// The gaps of its pairs that close within the step.
    pub gaps: Vec<Gap>,
    /// Their matrices, as many side by side as there are lanes.
    pub columns: Vec<f64>,
    /// Which of the pairs of all workers act on its bodies.
    links: Links,
    /// Its bodies.
    unknowns: Vec<Unknown>,
    /// How far the iterations are.
    pub progress: Progress,
}

impl Joint {
    /// Begins a step.
    pub fn clear(&mut self) {
        self.couplings.clear();
        self.sides.clear();
        self.gaps.clear();
        self.progress = Progress::default();
    }
}

/// Numbers of the pairs that act on each of a worker's bodies, in the order of their sums; each
/// number twice, and one more where the body is the second side.
#[derive(Default)]
struct Links {
    all: Vec<u32>,
    /// Where each body's begin, and the end.
    starts: Vec<u32>,
}

impl Links {
    /// Collects those of the bodies `own`; `slots` tells of each pair that resists which number it
    /// has.
    fn collect(
        &mut self,
        own: Range<usize>,
        pairs_of: &PairsOfBodies,
        resisting: &[bool],
        slots: &[u32],
    ) {
        self.all.clear();
        self.starts.clear();
        self.starts.push(0);
        for i in own {
            let (as_second, as_first) = pairs_of.of_body(i);
            let seconds = as_second.iter().map(|&pair| (pair as usize, 1));
            for (pair, side) in seconds.chain(as_first.map(|pair| (pair, 0))) {
                if resisting[pair] {
                    self.all.push(2 * slots[pair] + side);
                }
            }
            self.starts.push(self.all.len() as u32);
        }
    }

    /// Those of the worker's body number `k`.
    #[inline(always)]
    fn of(&self, k: usize) -> &[u32] {
        &self.all[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}

/// A force and a torque, or a velocity and a spin.
type Six = [Row; 2];

/// A body's equation.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
struct Unknown {
    /// What is left of it [N s, N m s].
    residual: Six,
    /// Direction of the search [m/s, rad/s].
    search: Six,
    /// What the equation's left side makes of it.
    image: Six,
    /// What it makes of the preconditioned residual.
    fresh: Six,
    /// Mass [kg], inertia along the axes of the world [kg m²].
    mass: f64,
    inertia: Symmetric,
    /// Inverses of the body's own blocks.
    preconditioner: [Symmetric; 2],
}

/// What the bodies do next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Next {
    /// They set their equations up.
    #[default]
    Begin,
    /// They sum what the pairs make of the preconditioned residuals.
    Sum,
    /// They go along the search.
    Go,
}

/// Where the iterations are: the same for every worker.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// How often a search was chosen.
    searches: u32,
    /// Whether the step's wrenches are found.
    pub is_done: bool,
    /// What comes next.
    pub next: Next,
    /// Whether gaps that stay open have been let go.
    pub is_amended: bool,
    /// What was left of the equations at first.
    begin: f64,
    /// What is left of them now.
    left: f64,
    /// What was left before the last search.
    before: f64,
    /// How far to go along the search, and how much of the last search goes into it.
    step: f64,
    memory: f64,
}

impl Progress {
    /// Whether what is left of the equations is little enough; to be called after every change of
    /// the residuals with their products with what they are preconditioned.
    pub fn conclude(&mut self, products: &[f64]) {
        self.left = products.iter().sum();
        if self.searches == 0 && !self.is_amended {
            self.begin = self.left;
        }
        // Written so that what is not a number ends it.
        let goes_on = self.left > TOLERANCE * TOLERANCE * self.begin;
        if goes_on && self.searches < MOST_SEARCHES {
            self.next = Next::Sum;
        } else if self.is_amended {
            self.is_done = true;
        } else {
            self.is_amended = true;
            self.searches = 0;
            self.memory = 0.0;
            self.next = Next::Begin;
        }
    }

    /// Chooses the next search, from the products of preconditioned residuals with what the
    /// equations' left sides make of them.
    pub fn search(&mut self, products: &[f64]) {
        let across: f64 = products.iter().sum();
        if self.searches == 0 {
            self.step = self.left / across;
        } else {
            self.memory = self.left / self.before;
            self.step = self.left / (across - self.memory * self.left / self.step);
        }
        self.before = self.left;
        self.searches += 1;
        self.next = Next::Go;
    }
}

/// `m v`.
#[inline(always)]
fn apply([xx, xy, xz, yy, yz, zz]: &Symmetric, v: &Row) -> Row {
    [
        xx * v[0] + xy * v[1] + xz * v[2],
        xy * v[0] + yy * v[1] + yz * v[2],
        xz * v[0] + yz * v[1] + zz * v[2],
        0.0,
    ]
}

/// The inverse, by cofactors.
#[inline(always)]
fn inverse([xx, xy, xz, yy, yz, zz]: &Symmetric) -> Symmetric {
    let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
    let scale = 1.0 / (xx * a + xy * b + xz * c);
    [
        a * scale,
        b * scale,
        c * scale,
        (xx * zz - xz * xz) * scale,
        (xy * xz - xx * yz) * scale,
        (xx * yy - xy * xy) * scale,
    ]
}

/// `a · b`.
#[inline(always)]
fn product(a: &Six, b: &Six) -> f64 {
    let part = |a: &Row, b: &Row| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    part(&a[0], &b[0]) + part(&a[1], &b[1])
}

/// `a + s b`.
#[inline(always)]
fn along(a: &Row, s: f64, b: &Row) -> Row {
    [
        a[0] + s * b[0],
        a[1] + s * b[1],
        a[2] + s * b[2],
        a[3] + s * b[3],
    ]
}

/// What the pairs of `links` do together to a body.
#[inline(always)]
fn gather(links: &[u32], wrenches: &[Wrench]) -> Six {
    let (mut force, mut torque) = ([0.0; 4], [0.0; 4]);
    for link in links {
        let wrench = &wrenches[(link / 2) as usize];
        // No branch: which side a body is cannot be foretold.
        let (sign, turn) = if link % 2 == 0 {
            (1.0, &wrench.first)
        } else {
            (-1.0, &wrench.second)
        };
        force = along(&force, sign, &wrench.force);
        torque = along(&torque, 1.0, turn);
    }
    [force, torque]
}

impl Unknown {
    /// The equation of `body` under `load`, before what its pairs add.
    #[inline(always)]
    fn of(body: &Body, load: &Load, dt: f64, gravity: Row) -> Self {
        let mass = 1.0 / body.inverse_mass();
        let push = [0, 1, 2, 3].map(|k| dt * (load.force[k] + mass * gravity[k]));
        Self {
            residual: [push, load.torque.map(|x| dt * x)],
            mass,
            inertia: body.inertia(),
            ..Self::default()
        }
    }

    /// Adds what the pairs of `links` do by the velocities of half a step ago, and makes the
    /// preconditioner of what they add to the body's blocks.
    #[inline(always)]
    fn add(&mut self, links: &[u32], dt: f64, wrenches: &[Wrench], blocks: &[Blocks]) {
        let [force, torque] = gather(links, wrenches);
        self.residual[0] = along(&self.residual[0], dt, &force);
        self.residual[1] = along(&self.residual[1], dt, &torque);
        let mut on_velocity = [self.mass, 0.0, 0.0, self.mass, 0.0, self.mass];
        let mut on_spin = self.inertia;
        for link in links {
            let own = &blocks[(link / 2) as usize];
            let (velocity, spin) = (own.velocity(), own.spin(link % 2 == 1));
            for k in 0..6 {
                on_velocity[k] += velocity[k];
                on_spin[k] += spin[k];
            }
        }
        self.preconditioner = [inverse(&on_velocity), inverse(&on_spin)];
    }

    /// The preconditioned residual, and its product with the residual.
    #[inline(always)]
    fn precondition(&self) -> (Motion, f64) {
        let velocity = apply(&self.preconditioner[0], &self.residual[0]);
        let spin = apply(&self.preconditioner[1], &self.residual[1]);
        let left = product(&self.residual, &[velocity, spin]);
        (Motion { velocity, spin }, left)
    }
}

/// What the bodies of a worker do between two products of the pairs.
pub enum Stage<'a> {
    /// They set their equations up.
    Begin(Beginning<'a>),
    /// They sum what the pairs make of the preconditioned residuals.
    Sum,
    /// They go along the search.
    Go,
}

/// What the bodies' equations are made of.
pub struct Beginning<'a> {
    /// Numbers of the worker's bodies.
    pub own: Range<usize>,
    /// Which pairs are whose.
    pub pairs_of: &'a PairsOfBodies,
    /// Which of them resist.
    pub resisting: &'a [bool],
    /// Which numbers these have.
    pub slots: &'a [u32],
    /// The worker's bodies.
    pub bodies: &'a [Body],
    /// Their loads.
    pub loads: &'a [Load],
    /// Gravity [m/s²].
    pub gravity: Row,
    /// Length of the step [s].
    pub dt: f64,
    /// What the pairs add to the bodies' matrices.
    pub blocks: &'a [Blocks],
    /// Whether changes of the motions are known that are begun from.
    pub goes_on: bool,
}

/// A stage of a worker's bodies.
pub struct Bodies<'a> {
    /// Which one.
    pub stage: Stage<'a>,
    /// The worker's part of the solution.
    pub joint: &'a mut Joint,
    /// What each pair of all workers does.
    pub wrenches: &'a [Wrench],
    /// Changes of velocity and spin so far.
    pub changes: &'a mut [Motion],
    /// Preconditioned residuals.
    pub motions: &'a mut [Motion],
    /// Products of each [`BUNDLE`] of bodies.
    pub products: &'a mut [f64],
}

impl Work for Bodies<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(mut self, _processor: N::Processor) {
        self.products.fill(0.0);
        match std::mem::replace(&mut self.stage, Stage::Sum) {
            Stage::Begin(beginning) => self.begin(&beginning),
            Stage::Sum => self.sum(),
            Stage::Go => self.go(),
        }
    }
}

impl Bodies<'_> {
    #[inline(always)]
    fn begin(&mut self, from: &Beginning<'_>) {
        let Joint {
            links, unknowns, ..
        } = &mut *self.joint;
        unknowns.clear();
        if !from.goes_on {
            links.collect(from.own.clone(), from.pairs_of, from.resisting, from.slots);
            self.changes.fill(Motion::default());
        }
        for (k, (body, load)) in from.bodies.iter().zip(from.loads).enumerate() {
            let mut unknown = Unknown::of(body, load, from.dt, from.gravity);
            if from.goes_on {
                let change = &self.changes[k];
                let momentum = apply(&unknown.inertia, &change.spin);
                let [push, turn] = &mut unknown.residual;
                *push = along(push, -unknown.mass, &change.velocity);
                *turn = along(turn, -1.0, &momentum);
            }
            unknown.add(links.of(k), from.dt, self.wrenches, from.blocks);
            let (motion, left) = unknown.precondition();
            self.motions[k] = motion;
            self.products[k / BUNDLE] += left;
            unknowns.push(unknown);
        }
    }

    #[inline(always)]
    fn sum(&mut self) {
        let Joint {
            links, unknowns, ..
        } = &mut *self.joint;
        for (k, (unknown, motion)) in unknowns.iter_mut().zip(&*self.motions).enumerate() {
            let [force, torque] = gather(links.of(k), self.wrenches);
            unknown.fresh = [
                along(&force, unknown.mass, &motion.velocity),
                along(&torque, 1.0, &apply(&unknown.inertia, &motion.spin)),
            ];
            let motion = [motion.velocity, motion.spin];
            self.products[k / BUNDLE] += product(&unknown.fresh, &motion);
        }
    }

    #[inline(always)]
    fn go(&mut self) {
        let Joint {
            unknowns, progress, ..
        } = &mut *self.joint;
        let (step, memory) = (progress.step, progress.memory);
        let moving = self.changes.iter_mut().zip(&mut *self.motions);
        for (k, (unknown, (change, motion))) in unknowns.iter_mut().zip(moving).enumerate() {
            let residual = [motion.velocity, motion.spin];
            for part in 0..2 {
                unknown.search[part] = along(&residual[part], memory, &unknown.search[part]);
                unknown.image[part] = along(&unknown.fresh[part], memory, &unknown.image[part]);
                unknown.residual[part] =
                    along(&unknown.residual[part], -step, &unknown.image[part]);
            }
            change.velocity = along(&change.velocity, step, &unknown.search[0]);
            change.spin = along(&change.spin, step, &unknown.search[1]);
            let left;
            (*motion, left) = unknown.precondition();
            self.products[k / BUNDLE] += left;
        }
    }
}

/// What all workers share of the joint solution: empty where no world is solved so.
#[derive(Default)]
pub struct SharedColumns {
    /// Which number each pair that resists has among those of its worker, from the worker's first
    /// pair on.
    pub slots: Vec<u32>,
    /// What these pairs do.
    pub wrenches: Vec<Wrench>,
    /// What they add to their bodies' matrices.
    pub blocks: Vec<Blocks>,
    /// Changes of the bodies' velocities and spins.
    pub changes: Vec<Motion>,
    /// Their preconditioned residuals.
    pub motions: Vec<Motion>,
    /// Products of each [`BUNDLE`] of bodies.
    pub products: Vec<f64>,
}

impl SharedColumns {
    /// Gives its memory back.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Makes room for so many pairs and bodies.
    pub fn resize(&mut self, pairs: usize, bodies: usize) {
        self.slots.resize(pairs, 0);
        self.wrenches.resize(pairs, Wrench::default());
        self.blocks.resize(pairs, Blocks::default());
        self.changes.resize(bodies, Motion::default());
        self.motions.resize(bodies, Motion::default());
        self.products.resize(bodies.div_ceil(BUNDLE), 0.0);
    }
}
