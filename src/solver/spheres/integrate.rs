//! Velocity Verlet: sums the forces on each grain, finishes the step and starts the next one.
//!
//! In: forces per pair, a body half a step behind in velocity. Out: the body half a step
//! ahead, at its next position; or, at the last step of a call, with its velocity at the time of
//! the position.
//!
//! ```text
//! kick    v ← v + ½ Δt (F/m + g)      ω ← ω + ½ Δt (T + q)/I
//! drift   x ← x + Δt v
//! forces  at x, with v and ω of half a step before
//! kick    v ← v + ½ Δt (F/m + g)      ω ← ω + ½ Δt (T + q)/I
//! ```
//!
//! The last kick of one step and the first of the next are one pass over the grains. `T` is the
//! torque of the contact forces, `q` that of rolling friction, which is found from the spin that
//! there would be if all torques stayed. Spheres need no orientation.
//!
//! A grain's sum goes over its pairs in the order of [`super::parts`], partner by partner: one
//! order for any number of workers, any list and any slot, hence one result.

use super::super::row::row;
use super::super::step::Outcome;
use super::bridges::BridgeEffect;
use super::parts::Parts;
use super::rings::Rings;
use super::rows::{ContactForce, Sphere};
use crate::lanes::{Lanes, Quad, Row, Work};
use crate::world::Grains;
use std::ops::Range;

/// A grain that moves by more than this share of its radius in one step is lost.
const LARGEST_MOVE: f64 = 0.1;

/// Sum over the contact forces on one grain.
#[derive(Clone, Copy, Debug, Default)]
pub struct Total<Q> {
    /// Contact forces [N].
    pub force: Q,
    /// Their torque [N m].
    pub torque: Q,
    /// Torque of rolling friction [N m]; number of touching partners.
    pub rolling: Q,
    /// Energy exchanged at the grain's own pairs [J].
    pub exchanged: Q,
    /// Energy that the grain's own bridges lose [J], bridges to grains that it does not touch,
    /// volume its film gains [m³].
    pub liquid: Q,
}

impl<Q: Quad> Total<Q> {
    #[inline(always)]
    fn zero(processor: Q::Processor) -> Self {
        let zero = Q::repeat(processor, 0.0);
        Self {
            force: zero,
            torque: zero,
            rolling: zero,
            exchanged: zero,
            liquid: zero,
        }
    }

    /// Adds a pair of which this grain is the first partner: the energy is booked on it.
    #[inline(always)]
    fn add_first(&mut self, processor: Q::Processor, contact: &ContactForce) {
        let arm = Q::repeat(processor, contact.arm());
        self.force = self.force + Q::load(processor, &contact.force);
        self.torque = self.torque + Q::load(processor, &contact.moment) * arm;
        self.rolling = self.rolling + Q::load(processor, &contact.rolling);
        self.exchanged = self.exchanged + Q::load(processor, &contact.exchanged);
    }

    /// Adds a pair of which this grain is the second partner: forces turn round, the count of
    /// partners does not.
    #[inline(always)]
    fn add_second(&mut self, processor: Q::Processor, contact: &ContactForce) {
        const TURNED: Row = [-1.0, -1.0, -1.0, 1.0];
        let arm = Q::repeat(processor, contact.partner_arm());
        self.force = self.force - Q::load(processor, &contact.force);
        self.torque = self.torque + Q::load(processor, &contact.moment) * arm;
        let turned = Q::load(processor, &TURNED);
        self.rolling = self.rolling + Q::load(processor, &contact.rolling) * turned;
    }

    /// Adds the bridge of such a pair.
    #[inline(always)]
    fn add_bridge(&mut self, processor: Q::Processor, effect: &BridgeEffect, side: usize) {
        // Losses are booked on the first side, both count the bridge, and what one film gains the
        // other loses.
        const SIGNS: [Row; 2] = [[1.0; 4], [0.0, 0.0, 1.0, -1.0]];
        let sign = Q::load(processor, &SIGNS[side]);
        self.liquid = self.liquid + Q::load(processor, effect) * sign;
    }

    /// Partners that hold the grain: those it touches and those on bridges.
    #[inline(always)]
    fn partners(&self) -> f64 {
        self.rolling.row()[3] + self.liquid.row()[2]
    }

    /// The sum that `load` holds, of a grain with so many open bridges.
    #[inline(always)]
    pub fn load(processor: Q::Processor, load: &SphereLoad, open_bridges: f64) -> Self {
        Self {
            force: Q::load(processor, &load.force),
            torque: Q::load(processor, &load.torque),
            rolling: Q::load(processor, &load.rolling),
            liquid: Q::load(processor, &[0.0, 0.0, open_bridges, 0.0]),
            exchanged: Q::repeat(processor, 0.0),
        }
    }
}

/// What acts on a grain at the end of a call.
#[derive(Clone, Copy, Debug, Default)]
pub struct SphereLoad {
    /// Contact forces [N].
    pub force: Row,
    /// Their torque [N m].
    pub torque: Row,
    /// Torque of rolling friction [N m]; number of touching partners.
    pub rolling: Row,
}

/// What only the integration reads or writes of a grain in every step: a cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct SphereAccount {
    /// Energy exchanged since the start [J].
    pub exchanged: Row,
    /// Time step over moment of inertia [1/(N m s)].
    pub compliance: f64,
    /// Largest speed that is not absurd, squared [m²/s²].
    pub speed_limit_squared: f64,
}

impl SphereLoad {
    /// What acts on grain `i` of the world.
    pub fn of(grains: &Grains, i: usize) -> Self {
        Self {
            force: row(grains.force[i], 0.0),
            torque: row(grains.torque[i], 0.0),
            rolling: row(grains.rolling_torque[i], f64::from(grains.contact_count[i])),
        }
    }

    /// Number of touching partners.
    pub fn contact_count(&self) -> f64 {
        self.rolling[3]
    }
}

impl SphereAccount {
    /// That of grain `i` of the world, in steps of `dt` [s].
    pub fn of(grains: &Grains, i: usize, dt: f64) -> Self {
        let speed_limit = LARGEST_MOVE * grains.radius[i] / dt;
        Self {
            exchanged: grains.exchanged[i],
            compliance: dt / grains.inertia[i],
            speed_limit_squared: speed_limit * speed_limit,
        }
    }
}

/// What the bridges of a grain have done: energy lost to viscosity and to capillary forces since
/// the start [J]; bridges to grains that it does not touch.
pub type BridgeLoad = [f64; 3];

/// Constants of the integration.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepConstants {
    /// Length of a step [s].
    pub dt: f64,
    /// Gravity [m/s²].
    pub gravity: Row,
    /// Square of the distance from the reference at which the inner list must be refreshed [m²].
    pub slack_squared: f64,
}

/// Sum over the pairs of the grain in the `i`-th slot, in the pairs' order.
#[inline(always)]
fn total<Q: Quad, const WET: bool>(
    processor: Q::Processor,
    parts: &Parts,
    rings: &Rings,
    i: usize,
) -> Total<Q> {
    let mut total = Total::zero(processor);
    let [as_second, as_first] = parts.places(i);
    for place in as_second {
        let number = place.number();
        total.add_second(processor, rings.force(number));
        if WET {
            total.add_bridge(processor, rings.bridge_effect(number), 1);
        }
    }
    for place in as_first {
        total.add_first(processor, rings.force_at(*place));
        if WET {
            total.add_bridge(processor, rings.bridge_effect_at(*place), 0);
        }
    }
    total
}

/// A grain on its way through a step, in registers: what is written of a row is the whole row, once.
pub struct Moving<Q> {
    position: Q,
    velocity: Q,
    spin: Q,
    inverse_mass: f64,
    inverse_inertia: f64,
}

impl<Q: Quad> Moving<Q> {
    /// The grain as its row has it.
    #[inline(always)]
    pub fn of(processor: Q::Processor, body: &Sphere) -> Self {
        Self {
            position: Q::load(processor, &body.position),
            velocity: Q::load(processor, &body.velocity),
            spin: Q::load(processor, &body.spin),
            inverse_mass: body.inverse_mass(),
            inverse_inertia: body.inverse_inertia(),
        }
    }

    /// Half a step of velocity and spin: `v ← v + ½ Δt (F/m + g)`, `ω ← ω + ½ Δt T/I`.
    #[inline(always)]
    pub fn kick(&mut self, processor: Q::Processor, total: &Total<Q>, motion: &StepConstants) {
        let half = 0.5 * motion.dt;
        // The fourth number of a row is no velocity: it gets nothing added.
        let half = Q::load(processor, &[half, half, half, 0.0]);
        let gravity = Q::load(processor, &motion.gravity);
        let acceleration = total.force * Q::repeat(processor, self.inverse_mass) + gravity;
        let turning = (total.torque + total.rolling) * Q::repeat(processor, self.inverse_inertia);
        self.velocity = self.velocity + acceleration * half;
        self.spin = self.spin + turning * half;
    }

    /// A full step of position, `x ← x + Δt v`. True when the slack of the inner list is used up.
    #[inline(always)]
    fn drift(&mut self, processor: Q::Processor, reference: &Row, motion: &StepConstants) -> bool {
        let dt = motion.dt;
        let step = Q::load(processor, &[dt, dt, dt, 0.0]);
        self.position = self.position + self.velocity * step;
        (self.position - Q::load(processor, reference)).length_squared() > motion.slack_squared
    }

    /// The spin that the grain would have after a step of `dt` [s] if all torques stayed, and how
    /// much of it a unit of torque stops: rolling friction works against the one and stops at the
    /// other, shared by all partners.
    #[inline(always)]
    pub fn free_spin(
        &self,
        processor: Q::Processor,
        compliance: f64,
        total: &Total<Q>,
        dt: f64,
    ) -> Row {
        let partners = total.partners();
        let partners = if partners > 1.0 { partners } else { 1.0 };
        let free = self.spin
            + (total.torque + total.rolling) * Q::repeat(processor, dt * self.inverse_inertia);
        let free = free.row();
        [free[0], free[1], free[2], compliance * partners]
    }

    /// Puts it, but for its free spin, back into a row.
    #[inline(always)]
    pub fn put(&self, body: &mut Sphere) {
        body.position = self.position.row();
        body.velocity = self.velocity.row();
        body.spin = self.spin.row();
    }
}

/// Starts the first step of a call from the forces that the loads hold.
pub struct StartStep<'a> {
    /// Constants.
    pub motion: &'a StepConstants,
    /// Every grain.
    pub bodies: &'a mut [Sphere],
    /// What acts on it.
    pub loads: &'a [SphereLoad],
    /// What is booked of it.
    pub accounts: &'a [SphereAccount],
    /// What their bridges have done; empty where nothing is wet.
    pub bridge_loads: &'a [BridgeLoad],
    /// Where it was when the inner list was filtered.
    pub references: &'a [Row],
}

impl Work for StartStep<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        let Self {
            motion,
            bodies,
            loads,
            accounts,
            bridge_loads,
            references,
        } = self;
        let mut outcome = Outcome::default();
        let rows = bodies.iter_mut().zip(loads.iter().zip(accounts));
        for (i, ((body, (load, account)), reference)) in rows.zip(references).enumerate() {
            let open_bridges = bridge_loads.get(i).map_or(0.0, |load| load[2]);
            let total = Total::<N::Quad>::load(processor, load, open_bridges);
            let mut moving = Moving::of(processor, body);
            moving.kick(processor, &total, motion);
            body.free_spin = moving.free_spin(processor, account.compliance, &total, motion.dt);
            outcome.refresh |= moving.drift(processor, reference, motion);
            moving.put(body);
        }
        outcome
    }
}

/// A range of grains at the end of a step.
pub struct GrainRows<'a> {
    /// Constants.
    pub motion: &'a StepConstants,
    /// Which pairs are whose.
    pub parts: &'a Parts,
    /// Slot of the first grain of the range.
    pub begin: usize,
    /// Every grain as it was.
    pub before: &'a [Sphere],
    /// The range as it becomes.
    pub bodies: &'a mut [Sphere],
    /// What acts on it, written at the last step.
    pub loads: &'a mut [SphereLoad],
    /// What is booked of it.
    pub accounts: &'a mut [SphereAccount],
    /// Volume of the film on every grain as it was; empty where nothing is wet [m³].
    pub films_before: &'a [f64],
    /// Of the range as it becomes.
    pub films: &'a mut [f64],
    /// What the bridges of each have done; empty where nothing is wet.
    pub bridge_loads: &'a mut [BridgeLoad],
    /// Where it was when the inner list was filtered.
    pub references: &'a [Row],
    /// Whether this is the last step of a call.
    pub last: bool,
}

impl GrainRows<'_> {
    /// Finishes the step of the grains in these slots from what their pairs do and, unless it is
    /// the last of a call, starts the next.
    #[inline(always)]
    pub fn finish<N: Lanes, const WET: bool>(
        &mut self,
        processor: N::Processor,
        rings: &Rings,
        slots: Range<usize>,
    ) -> Outcome {
        let mut outcome = Outcome::default();
        let motion = self.motion;
        for i in slots {
            let k = i - self.begin;
            let total = total::<N::Quad, WET>(processor, self.parts, rings, i);
            let account = &mut self.accounts[k];
            account.exchanged =
                (N::Quad::load(processor, &account.exchanged) + total.exchanged).row();
            if WET {
                let [viscous, capillary, open, gained] = total.liquid.row();
                let [viscous_before, capillary_before, ..] = self.bridge_loads[k];
                self.bridge_loads[k] =
                    [viscous_before + viscous, capillary_before + capillary, open];
                self.films[k] = self.films_before[i] + gained;
            }
            let before = &self.before[i];
            let mut moving = Moving::of(processor, before);
            moving.kick(processor, &total, motion);
            let speed_squared = moving.velocity.length_squared();
            let spin_squared = moving.spin.length_squared();
            // Written so that a NaN is not sane.
            let sane = speed_squared <= account.speed_limit_squared && spin_squared < f64::INFINITY;
            outcome.fault |= !sane;
            let mut free_spin = before.free_spin;
            if self.last {
                self.loads[k] = SphereLoad {
                    force: total.force.row(),
                    torque: total.torque.row(),
                    rolling: total.rolling.row(),
                };
            } else if sane {
                // A grain in fault stays where it is, for the diagnosis.
                moving.kick(processor, &total, motion);
                free_spin = moving.free_spin(processor, account.compliance, &total, motion.dt);
                outcome.refresh |= moving.drift(processor, &self.references[k], motion);
            }
            let body = &mut self.bodies[k];
            moving.put(body);
            body.free_spin = free_spin;
        }
        outcome
    }
}
