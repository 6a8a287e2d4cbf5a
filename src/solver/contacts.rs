//! The pair loop: geometry, contact law, sliding and rolling friction of every listed pair.
//!
//! In: bodies, listed pairs with their constants and tangential springs. Out: forces, torques and exchanged energy per
//! pair, new springs. Pairs are packed into blocks of rows, computed in lanes, and written to rows of their own; nothing
//! is summed here, so the order of work never shows.

use super::law::{Coefficients, Law, PairConstants, rolling_gain};
use super::row::{Row, add, row, sub, vector};
use crate::world::{Motion, Surface};
use multiversion::multiversion;

/// Pairs computed together; enough to hide latency, few enough to stay in the first-level cache.
const BLOCK: usize = 32;

/// What the pair loop reads of a grain: two cache lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct Body {
    /// Centre [m]; inverse mass [1/kg].
    pub position: Row,
    /// Velocity half a step ago [m/s]; inverse moment of inertia [1/(kg m²)].
    pub velocity: Row,
    /// Spin half a step ago [rad/s]; radius [m].
    pub spin: Row,
    /// Spin after the step if nothing resisted rolling [rad/s]; inertia over time step and contact count [N m s].
    pub free_spin: Row,
}

/// What the pair loop reads of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallBody {
    /// Where it is.
    pub surface: Surface,
    /// How it moves.
    pub motion: Motion,
}

/// A pair on the list: a grain, its partner (a grain or a wall) and the index of its constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pair {
    /// The grain on which the computed force acts.
    pub grain: u32,
    /// The other grain's index, or the wall's.
    pub partner: u32,
    /// Index into the pair constants.
    pub kind: u32,
}

/// What a pair does to its partners, in rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(128))]
pub struct Action {
    /// Force on the grain [N]; arm from the grain's centre to the contact [m].
    pub force: Row,
    /// Normal × force [N]; arm from the partner's centre to the contact [m]. Times the arm, the torque on either side.
    pub twist: Row,
    /// Torque of rolling friction on the grain [N m]; 1 while touching, else 0.
    pub rolling: Row,
    /// Energy lost in dashpots, in sliding, in rolling and done by a wall during the step [J].
    pub exchanged: Row,
}

/// A block of pairs, packed row by row.
struct Block {
    /// From the grain's centre to the partner's; a wall's centre is the foot of the perpendicular.
    distance: [Row; BLOCK],
    /// Velocity of the grain relative to its partner; inertia that stops rolling.
    velocity: [Row; BLOCK],
    /// Spin of the grain; radius.
    spin: [Row; BLOCK],
    /// Spin of the partner; radius (0 for a wall).
    partner_spin: [Row; BLOCK],
    /// Relative spin for rolling friction.
    rolling_spin: [Row; BLOCK],
    /// Velocity of a wall at the contact.
    wall_velocity: [Row; BLOCK],
    /// The law's constants.
    coefficients: [Row; BLOCK],
    /// Sliding friction, rolling arm.
    friction: [[f64; 2]; BLOCK],
}

impl Block {
    /// Rows at unit distance that touch nothing.
    fn empty() -> Self {
        Self {
            distance: [[1.0, 0.0, 0.0, 0.0]; BLOCK],
            velocity: [[0.0; 4]; BLOCK],
            spin: [[0.0; 4]; BLOCK],
            partner_spin: [[0.0; 4]; BLOCK],
            rolling_spin: [[0.0; 4]; BLOCK],
            wall_velocity: [[0.0; 4]; BLOCK],
            coefficients: [[0.0; 4]; BLOCK],
            friction: [[0.0; 2]; BLOCK],
        }
    }

    #[inline(always)]
    fn set_constants(&mut self, k: usize, constants: &PairConstants) {
        self.coefficients[k] = constants.coefficients;
        self.friction[k] = [constants.friction, constants.rolling_arm];
    }

    #[inline(always)]
    fn pack_grains(&mut self, k: usize, a: &Body, b: &Body) {
        self.distance[k] = sub(b.position, a.position);
        let mut velocity = sub(a.velocity, b.velocity);
        let (stop_a, stop_b) = (a.free_spin[3], b.free_spin[3]);
        velocity[3] = 0.5 * if stop_a < stop_b { stop_a } else { stop_b };
        self.velocity[k] = velocity;
        self.spin[k] = a.spin;
        self.partner_spin[k] = b.spin;
        self.rolling_spin[k] = sub(a.free_spin, b.free_spin);
    }

    #[inline(always)]
    fn pack_wall(&mut self, k: usize, a: &Body, wall: &WallBody) {
        let x = vector(a.position);
        let (gap, towards) = wall.surface.distance(x);
        // A centre on or behind the surface has no distance to take a direction from: the check after the step reports it.
        let reach = towards * if gap > 0.0 { gap } else { f64::NAN };
        let wall_velocity = wall.motion.velocity_at(x + reach);
        let wall_spin = row(wall.motion.spin, 0.0);
        self.distance[k] = row(reach, 0.0);
        let mut velocity = sub(a.velocity, row(wall_velocity, 0.0));
        velocity[3] = a.free_spin[3];
        self.velocity[k] = velocity;
        self.spin[k] = a.spin;
        self.partner_spin[k] = wall_spin;
        self.rolling_spin[k] = sub(a.free_spin, wall_spin);
        self.wall_velocity[k] = row(wall_velocity, 0.0);
    }

    /// Computes every pair of the block; `springs` and `actions` are its pairs' rows.
    #[inline(always)]
    fn compute<L: Law, const WALL: bool>(
        &self,
        law: L,
        dt: f64,
        springs: &mut [Row; BLOCK],
        actions: &mut [Action; BLOCK],
    ) {
        for k in 0..BLOCK {
            let (d, spin, other) = (self.distance[k], self.spin[k], self.partner_spin[k]);
            let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let inverse = 1.0 / length;
            let (nx, ny, nz) = (d[0] * inverse, d[1] * inverse, d[2] * inverse);

            let depth = spin[3] + other[3] - length;
            let touching = depth > 0.0;
            let overlap = if touching { depth } else { 0.0 };
            let arm = spin[3] - 0.5 * overlap;
            let partner_arm = if WALL { 0.0 } else { other[3] - 0.5 * overlap };

            let v = self.velocity[k];
            let approach = v[0] * nx + v[1] * ny + v[2] * nz;
            let c = law.coefficients(self.coefficients[k], overlap);
            let c = Coefficients {
                normal_damping: if touching { c.normal_damping } else { 0.0 },
                tangential_damping: if touching { c.tangential_damping } else { 0.0 },
                ..c
            };
            let elastic = c.normal_stiffness * overlap;
            let normal = law.normal_force(elastic, c.normal_damping * approach);
            let bound = self.friction[k][0] * law.coulomb_force(elastic, normal);

            // Slip velocity of the grain's surface over its partner's.
            let wx = arm * spin[0] + partner_arm * other[0];
            let wy = arm * spin[1] + partner_arm * other[1];
            let wz = arm * spin[2] + partner_arm * other[2];
            let tx = v[0] - approach * nx + (wy * nz - wz * ny);
            let ty = v[1] - approach * ny + (wz * nx - wx * nz);
            let tz = v[2] - approach * nz + (wx * ny - wy * nx);

            let s = springs[k];
            let (sx, sy, sz) = (s[0] + tx * dt, s[1] + ty * dt, s[2] + tz * dt);
            let along = sx * nx + sy * ny + sz * nz;
            let (sx, sy, sz) = (sx - along * nx, sy - along * ny, sz - along * nz);
            let stretch_squared = sx * sx + sy * sy + sz * sz;
            let trial = c.tangential_stiffness * stretch_squared.sqrt();
            let slides = trial > bound;
            let kept = if slides { bound / trial } else { 1.0 };
            let kept = if touching { kept } else { 0.0 };
            let damping = if slides { 0.0 } else { c.tangential_damping };
            let (sx, sy, sz) = (sx * kept, sy * kept, sz * kept);
            springs[k] = [sx, sy, sz, 0.0];
            let stiffness = c.tangential_stiffness;
            let (gx, gy, gz) = (
                -stiffness * sx - damping * tx,
                -stiffness * sy - damping * ty,
                -stiffness * sz - damping * tz,
            );

            let r = self.rolling_spin[k];
            let rolling_speed = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
            let gain = rolling_gain(self.friction[k][1] * elastic, v[3], rolling_speed);
            let twist = r[0] * nx + r[1] * ny + r[2] * nz;
            let qx = -gain * (r[0] - twist * nx);
            let qy = -gain * (r[1] - twist * ny);
            let qz = -gain * (r[2] - twist * nz);

            let (fx, fy, fz) = (gx - normal * nx, gy - normal * ny, gz - normal * nz);
            let slip_squared = tx * tx + ty * ty + tz * tz;
            let dashpots = dt * ((normal - elastic) * approach + damping * slip_squared);
            let sliding = stiffness * stretch_squared * kept * (1.0 - kept);
            let rolling = -dt
                * (qx * (spin[0] - other[0])
                    + qy * (spin[1] - other[1])
                    + qz * (spin[2] - other[2]));
            let wall = if WALL {
                let u = self.wall_velocity[k];
                dt * (fx * u[0]
                    + fy * u[1]
                    + fz * u[2]
                    + (qx * other[0] + qy * other[1] + qz * other[2]))
            } else {
                0.0
            };
            actions[k] = Action {
                force: [fx, fy, fz, arm],
                twist: [
                    ny * gz - nz * gy,
                    nz * gx - nx * gz,
                    nx * gy - ny * gx,
                    partner_arm,
                ],
                rolling: [qx, qy, qz, if touching { 1.0 } else { 0.0 }],
                exchanged: [dashpots, sliding, rolling, wall],
            };
        }
    }
}

/// Runs blocks of `pairs` through `pack` and [`Block::compute`].
#[inline(always)]
fn blocks<L: Law, const WALL: bool>(
    law: L,
    dt: f64,
    pairs: &[Pair],
    springs: &mut [Row],
    actions: &mut [Action],
    mut pack: impl FnMut(&mut Block, usize, Pair),
) {
    let mut block = Block::empty();
    let rows = springs.chunks_mut(BLOCK).zip(actions.chunks_mut(BLOCK));
    for (pairs, (springs, actions)) in pairs.chunks(BLOCK).zip(rows) {
        for (k, pair) in pairs.iter().enumerate() {
            pack(&mut block, k, *pair);
        }
        if let (Ok(springs), Ok(actions)) = ((&mut *springs).try_into(), (&mut *actions).try_into())
        {
            block.compute::<L, WALL>(law, dt, springs, actions);
        } else {
            let mut padded = ([[0.0; 4]; BLOCK], [Action::default(); BLOCK]);
            padded.0[..springs.len()].copy_from_slice(springs);
            block.compute::<L, WALL>(law, dt, &mut padded.0, &mut padded.1);
            springs.copy_from_slice(&padded.0[..springs.len()]);
            actions.copy_from_slice(&padded.1[..actions.len()]);
        }
    }
}

/// Forces between grains, on the widest lanes that the processor has.
#[multiversion(targets("x86_64+avx+avx2"))]
pub fn between_grains<L: Law>(
    law: L,
    dt: f64,
    bodies: &[Body],
    constants: &[PairConstants],
    pairs: &[Pair],
    springs: &mut [Row],
    actions: &mut [Action],
) {
    blocks::<L, false>(law, dt, pairs, springs, actions, |block, k, pair| {
        block.set_constants(k, &constants[pair.kind as usize]);
        block.pack_grains(
            k,
            &bodies[pair.grain as usize],
            &bodies[pair.partner as usize],
        );
    });
}

/// Forces of walls on grains, on the widest lanes that the processor has.
#[multiversion(targets("x86_64+avx+avx2"))]
pub fn at_walls<L: Law>(
    law: L,
    dt: f64,
    bodies: &[Body],
    walls: &[WallBody],
    constants: &[PairConstants],
    pairs: &[Pair],
    springs: &mut [Row],
    actions: &mut [Action],
) {
    blocks::<L, true>(law, dt, pairs, springs, actions, |block, k, pair| {
        block.set_constants(k, &constants[pair.kind as usize]);
        block.pack_wall(
            k,
            &bodies[pair.grain as usize],
            &walls[pair.partner as usize],
        );
    });
}

/// Sum over the actions on one grain.
#[derive(Clone, Copy, Debug, Default)]
pub struct Total {
    /// Contact forces [N].
    pub force: Row,
    /// Their torque [N m].
    pub torque: Row,
    /// Torque of rolling friction [N m]; number of touching partners.
    pub rolling: Row,
    /// Energy exchanged at the grain's own pairs [J].
    pub exchanged: Row,
}

impl Total {
    /// Adds a pair of which this grain is the first partner.
    #[inline(always)]
    pub fn add_own(&mut self, action: &Action) {
        self.force = add(self.force, action.force);
        self.torque = super::row::add_scaled(self.torque, action.twist, action.force[3]);
        self.rolling = add(self.rolling, action.rolling);
        self.exchanged = add(self.exchanged, action.exchanged);
    }

    /// Adds a pair of which this grain is the second partner.
    #[inline(always)]
    pub fn add_other(&mut self, action: &Action) {
        let q = action.rolling;
        self.force = sub(self.force, action.force);
        self.torque = super::row::add_scaled(self.torque, action.twist, action.twist[3]);
        self.rolling = [
            self.rolling[0] - q[0],
            self.rolling[1] - q[1],
            self.rolling[2] - q[2],
            self.rolling[3] + q[3],
        ];
    }
}
