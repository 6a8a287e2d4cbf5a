//! Velocity Verlet: sums the forces on each grain, finishes the step and starts the next one.
//!
//! In: actions per pair, the bodies half a step behind in velocity. Out: the bodies half a step ahead, at their next
//! positions; or, at the last step of a call, with velocities at the time of the positions.

use super::contacts::{Action, Body, Total};
use super::lanes::{Lanes, Row, Work};
use super::row::{add, add_scaled, length_squared, sub};

/// What only the integration reads or writes of a grain.
#[derive(Clone, Copy, Debug, Default)]
pub struct Load {
    /// Sum over the grain's contacts at the last evaluation.
    pub total: Total,
    /// Energy exchanged since the start [J].
    pub exchanged: Row,
    /// Moment of inertia over the time step [N m s].
    pub stopping: f64,
    /// Largest speed that is not absurd, squared [m²/s²].
    pub speed_limit_squared: f64,
}

/// Constants of the integration.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    /// Length of a step [s].
    pub dt: f64,
    /// Gravity [m/s²].
    pub gravity: Row,
    /// Square of the distance from the reference at which the active list must be refreshed [m²].
    pub slack_squared: f64,
}

/// Where to find a grain's pairs.
#[derive(Clone, Copy)]
pub struct Incidence<'a> {
    /// Actions between grains and, by second grain, their indices.
    pub grains: &'a [Action],
    /// Begin of each grain's own pairs.
    pub first: &'a [u32],
    /// Begin of each grain's pairs as second partner.
    pub second_first: &'a [u32],
    /// Indices of pairs by second grain.
    pub as_second: &'a [u32],
    /// Actions of walls.
    pub walls: &'a [Action],
    /// Begin of each grain's wall pairs.
    pub wall_first: &'a [u32],
}

/// What a range of grains asks for after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Some grain has used up the slack of the active list.
    pub refresh: bool,
    /// Some grain's state is absurd.
    pub fault: bool,
}

impl Incidence<'_> {
    /// Sum over the pairs of grain `i`, in the pairs' order.
    #[inline(always)]
    fn total(&self, i: usize) -> Total {
        let mut total = Total::default();
        for &pair in
            &self.as_second[self.second_first[i] as usize..self.second_first[i + 1] as usize]
        {
            total.add_other(&self.grains[pair as usize]);
        }
        for action in &self.grains[self.first[i] as usize..self.first[i + 1] as usize] {
            total.add_own(action);
        }
        for action in &self.walls[self.wall_first[i] as usize..self.wall_first[i + 1] as usize] {
            total.add_own(action);
        }
        total
    }
}

/// Half a step of velocity and spin under the forces of `load`.
#[inline(always)]
fn kick(body: &mut Body, load: &Load, motion: &Motion) {
    let half = 0.5 * motion.dt;
    let (inverse_mass, inverse_inertia) = (body.position[3], body.velocity[3]);
    let (f, g) = (load.total.force, motion.gravity);
    let (t, q) = (load.total.torque, load.total.rolling);
    for axis in 0..3 {
        body.velocity[axis] += half * (f[axis] * inverse_mass + g[axis]);
        body.spin[axis] += half * ((t[axis] + q[axis]) * inverse_inertia);
    }
}

/// A full step of position, and the spin that rolling friction works against.
#[inline(always)]
fn drift(body: &mut Body, load: &Load, motion: &Motion) {
    let inverse_inertia = body.velocity[3];
    for axis in 0..3 {
        body.position[axis] += motion.dt * body.velocity[axis];
    }
    let contacts = if load.total.rolling[3] > 1.0 {
        load.total.rolling[3]
    } else {
        1.0
    };
    let mut free = add_scaled(body.spin, load.total.torque, motion.dt * inverse_inertia);
    free[3] = load.stopping / contacts;
    body.free_spin = free;
}

#[inline(always)]
fn used_up(body: &Body, reference: Row, motion: &Motion) -> bool {
    length_squared(sub(body.position, reference)) > motion.slack_squared
}

/// Starts the first step of a call from the forces that `loads` hold.
pub fn start(motion: &Motion, bodies: &mut [Body], loads: &[Load], references: &[Row]) -> Outcome {
    let mut outcome = Outcome::default();
    for ((body, load), reference) in bodies.iter_mut().zip(loads).zip(references) {
        kick(body, load, motion);
        drift(body, load, motion);
        outcome.refresh |= used_up(body, *reference, motion);
    }
    outcome
}

/// Finishes a step for a range of grains and, unless it is the last of a call, starts the next.
pub struct Finish<'a> {
    /// Constants.
    pub motion: &'a Motion,
    /// Where to find the grains' pairs.
    pub pairs: Incidence<'a>,
    /// Index of the first grain of the range.
    pub begin: usize,
    /// The range.
    pub bodies: &'a mut [Body],
    /// What acts on it.
    pub loads: &'a mut [Load],
    /// Where it was when the active list was filtered.
    pub references: &'a [Row],
    /// Whether this is the last step of a call.
    pub last: bool,
}

impl Work for Finish<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn run<N: Lanes>(self, _processor: N::Processor) -> Outcome {
        let Self {
            motion,
            pairs,
            begin,
            bodies,
            loads,
            references,
            last,
        } = self;
        let mut outcome = Outcome::default();
        for (k, ((body, load), reference)) in
            bodies.iter_mut().zip(loads).zip(references).enumerate()
        {
            load.total = pairs.total(begin + k);
            load.exchanged = add(load.exchanged, load.total.exchanged);
            kick(body, load, motion);
            // Written so that a NaN is not sane.
            let sane = length_squared(body.velocity) <= load.speed_limit_squared
                && length_squared(body.spin) < f64::INFINITY;
            outcome.fault |= !sane;
            // A grain in fault stays where it is, for the diagnosis.
            if sane && !last {
                kick(body, load, motion);
                drift(body, load, motion);
                outcome.refresh |= used_up(body, *reference, motion);
            }
        }
        outcome
    }
}
