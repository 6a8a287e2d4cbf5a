//! Velocity Verlet: sums the forces on each grain, finishes the step and starts the next one.
//!
//! In: forces per pair, the bodies half a step behind in velocity. Out: the bodies half a step
//! ahead, at their next positions; or, at the last step of a call, with velocities at the time of
//! the positions.
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
use super::rows::{ContactForce, Sphere};
use crate::lanes::{Lanes, Quad, Row, Work};
use crate::world::Grains;

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

/// What only the integration reads or writes of a grain.
#[derive(Clone, Copy, Debug, Default)]
pub struct SphereLoad {
    /// Contact forces at the last evaluation [N].
    pub force: Row,
    /// Their torque [N m].
    pub torque: Row,
    /// Torque of rolling friction [N m]; number of touching partners.
    pub rolling: Row,
    /// Energy exchanged since the start [J].
    pub exchanged: Row,
    /// Time step over moment of inertia [1/(N m s)].
    pub compliance: f64,
    /// Largest speed that is not absurd, squared [m²/s²].
    pub speed_limit_squared: f64,
}

impl SphereLoad {
    /// What acts on grain `i` of the world, in steps of `dt` [s].
    pub fn of(grains: &Grains, i: usize, dt: f64) -> Self {
        let speed_limit = LARGEST_MOVE * grains.radius[i] / dt;
        Self {
            force: row(grains.force[i], 0.0),
            torque: row(grains.torque[i], 0.0),
            rolling: row(grains.rolling_torque[i], f64::from(grains.contact_count[i])),
            exchanged: grains.exchanged[i],
            compliance: dt / grains.inertia[i],
            speed_limit_squared: speed_limit * speed_limit,
        }
    }

    /// Number of touching partners.
    pub fn contact_count(&self) -> f64 {
        self.rolling[3]
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

/// Where to find what the pairs of a grain do.
#[derive(Clone, Copy)]
pub struct PairEffects<'a> {
    /// What every pair does.
    pub forces: &'a [ContactForce],
    /// What every bridge does; empty where nothing is wet.
    pub bridge_effects: &'a [BridgeEffect],
    /// Each grain's parts in them.
    pub parts: &'a Parts,
}

impl PairEffects<'_> {
    /// Sum over the pairs of grain `i`, in the pairs' order.
    #[inline(always)]
    fn total<Q: Quad, const WET: bool>(&self, processor: Q::Processor, i: usize) -> Total<Q> {
        let mut total = Total::zero(processor);
        let [as_second, as_first] = self.parts.by_side(i);
        for part in as_second {
            total.add_second(processor, &self.forces[part.pair()]);
            if WET {
                total.add_bridge(processor, &self.bridge_effects[part.pair()], 1);
            }
        }
        for part in as_first {
            total.add_first(processor, &self.forces[part.pair()]);
            if WET && let Some(effect) = self.bridge_effects.get(part.pair()) {
                total.add_bridge(processor, effect, 0);
            }
        }
        total
    }
}

/// Half a step of velocity and spin: `v ← v + ½ Δt (F/m + g)`, `ω ← ω + ½ Δt T/I`.
#[inline(always)]
pub fn kick<Q: Quad>(
    processor: Q::Processor,
    body: &mut Sphere,
    total: &Total<Q>,
    motion: &StepConstants,
) {
    let half = 0.5 * motion.dt;
    // The fourth number of a row is no velocity: it gets nothing added.
    let half = Q::load(processor, &[half, half, half, 0.0]);
    let (inverse_mass, inverse_inertia) = (body.inverse_mass(), body.inverse_inertia());
    let gravity = Q::load(processor, &motion.gravity);
    let acceleration = total.force * Q::repeat(processor, inverse_mass) + gravity;
    let turning = (total.torque + total.rolling) * Q::repeat(processor, inverse_inertia);
    body.velocity = (Q::load(processor, &body.velocity) + acceleration * half).row();
    body.spin = (Q::load(processor, &body.spin) + turning * half).row();
}

/// A full step of position, `x ← x + Δt v`, and the spin that rolling friction works against. True
/// when the slack of the inner list is used up.
#[inline(always)]
fn drift<Q: Quad>(
    processor: Q::Processor,
    body: &mut Sphere,
    load: &SphereLoad,
    total: &Total<Q>,
    reference: &Row,
    motion: &StepConstants,
) -> bool {
    let dt = motion.dt;
    let step = Q::load(processor, &[dt, dt, dt, 0.0]);
    let position = Q::load(processor, &body.position) + Q::load(processor, &body.velocity) * step;
    set_free_spin(processor, body, load, total, dt);
    body.position = position.row();
    (position - Q::load(processor, reference)).length_squared() > motion.slack_squared
}

/// Sets the spin that the grain would have after a step of `dt` [s] if all torques stayed,
/// and how much of it a unit of torque stops: rolling friction works against the one and stops at
/// the other, shared by all partners.
#[inline(always)]
pub fn set_free_spin<Q: Quad>(
    processor: Q::Processor,
    body: &mut Sphere,
    load: &SphereLoad,
    total: &Total<Q>,
    dt: f64,
) {
    let partners = total.partners();
    let partners = if partners > 1.0 { partners } else { 1.0 };
    let free = Q::load(processor, &body.spin)
        + (total.torque + total.rolling) * Q::repeat(processor, dt * body.inverse_inertia());
    let free = free.row();
    body.free_spin = [free[0], free[1], free[2], load.compliance * partners];
}

/// Starts the first step of a call from the forces that the loads hold.
pub struct StartStep<'a> {
    /// Constants.
    pub motion: &'a StepConstants,
    /// Every grain.
    pub bodies: &'a mut [Sphere],
    /// What acts on it.
    pub loads: &'a [SphereLoad],
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
            bridge_loads,
            references,
        } = self;
        let mut outcome = Outcome::default();
        let rows = bodies.iter_mut().zip(loads).zip(references);
        for (i, ((body, load), reference)) in rows.enumerate() {
            let open_bridges = bridge_loads.get(i).map_or(0.0, |load| load[2]);
            let total = Total::<N::Quad>::load(processor, load, open_bridges);
            kick(processor, body, &total, motion);
            outcome.refresh |= drift(processor, body, load, &total, reference, motion);
        }
        outcome
    }
}

/// Finishes a step for a range of grains and, unless it is the last of a call, starts the next.
pub struct FinishStep<'a, const WET: bool> {
    /// Constants.
    pub motion: &'a StepConstants,
    /// Where to find the grains' pairs.
    pub pairs: PairEffects<'a>,
    /// Index of the first grain of the range.
    pub begin: usize,
    /// The range.
    pub bodies: &'a mut [Sphere],
    /// What acts on it; written at the last step.
    pub loads: &'a mut [SphereLoad],
    /// Volume of the film on each; empty where nothing is wet [m³].
    pub films: &'a mut [f64],
    /// What the bridges of each have done; empty where nothing is wet.
    pub bridge_loads: &'a mut [BridgeLoad],
    /// Where it was when the inner list was filtered.
    pub references: &'a [Row],
    /// Whether this is the last step of a call.
    pub last: bool,
}

impl<const WET: bool> Work for FinishStep<'_, WET> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Outcome {
        let Self {
            motion,
            pairs,
            begin,
            bodies,
            loads,
            films,
            bridge_loads,
            references,
            last,
        } = self;
        let mut outcome = Outcome::default();
        for (k, ((body, load), reference)) in
            bodies.iter_mut().zip(loads).zip(references).enumerate()
        {
            let total = pairs.total::<N::Quad, WET>(processor, begin + k);
            load.exchanged = (N::Quad::load(processor, &load.exchanged) + total.exchanged).row();
            if WET {
                let [viscous, capillary, open, gained] = total.liquid.row();
                let [viscous_before, capillary_before, ..] = bridge_loads[k];
                bridge_loads[k] = [viscous_before + viscous, capillary_before + capillary, open];
                films[k] += gained;
            }
            kick(processor, body, &total, motion);
            let speed_squared = N::Quad::load(processor, &body.velocity).length_squared();
            let spin_squared = N::Quad::load(processor, &body.spin).length_squared();
            // Written so that a NaN is not sane.
            let sane = speed_squared <= load.speed_limit_squared && spin_squared < f64::INFINITY;
            outcome.fault |= !sane;
            if last {
                load.force = total.force.row();
                load.torque = total.torque.row();
                load.rolling = total.rolling.row();
            } else if sane {
                // A grain in fault stays where it is, for the diagnosis.
                kick(processor, body, &total, motion);
                outcome.refresh |= drift(processor, body, load, &total, reference, motion);
            }
        }
        outcome
    }
}
