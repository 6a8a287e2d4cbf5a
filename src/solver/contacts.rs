//! The pair loop: geometry, contact law, sliding and rolling friction of every listed pair.
//!
//! In: bodies, listed pairs with their constants and tangential springs. Out: forces, torques and exchanged energy per
//! pair, new springs. Pairs are packed into blocks of rows, computed in lanes, and written to rows of their own; nothing
//! is summed here, so the order of work never shows.

use super::lanes::{Lanes, Work, cross, dot, minus, plus, times};
use super::law::{Coefficients, Law, PairConstants, rolling_gain};
use super::row::{Row, add, row, sub, vector};
use crate::world::{Motion, Surface};

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

/// A block of pairs, packed row by row: a stride of four is what the compiler can turn into lanes.
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
    friction: [Row; BLOCK],
    /// Tangential springs, in and out.
    springs: [Row; BLOCK],
}

/// What a block of pairs does, row by row; the rows of an [`Action`].
struct Effects {
    force: [Row; BLOCK],
    twist: [Row; BLOCK],
    rolling: [Row; BLOCK],
    exchanged: [Row; BLOCK],
}

impl Effects {
    fn empty() -> Self {
        let rows = [[0.0; 4]; BLOCK];
        Self {
            force: rows,
            twist: rows,
            rolling: rows,
            exchanged: rows,
        }
    }

    #[inline(always)]
    fn unpack(&self, k: usize) -> Action {
        Action {
            force: self.force[k],
            twist: self.twist[k],
            rolling: self.rolling[k],
            exchanged: self.exchanged[k],
        }
    }
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
            friction: [[0.0; 4]; BLOCK],
            springs: [[0.0; 4]; BLOCK],
        }
    }

    #[inline(always)]
    fn set_constants(&mut self, k: usize, constants: &PairConstants) {
        self.coefficients[k] = constants.coefficients;
        self.friction[k] = constants.friction;
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

    /// Computes the pairs from `k` on, as many as there are lanes.
    #[inline(always)]
    fn compute<N: Lanes, L: Law, const WALL: bool>(
        &mut self,
        processor: N::Processor,
        law: L,
        dt: f64,
        k: usize,
        effects: &mut Effects,
    ) {
        let (zero, half) = (N::splat(processor, 0.0), N::splat(processor, 0.5));
        let (one, dt) = (N::splat(processor, 1.0), N::splat(processor, dt));
        let rows = k..k + N::COUNT;

        // Geometry.
        let [x, y, z, _] = N::load(processor, &self.distance[rows.clone()]);
        let distance = [x, y, z];
        let length = dot(distance, distance).sqrt();
        let normal = times(distance, one / length);
        let [x, y, z, radius] = N::load(processor, &self.spin[rows.clone()]);
        let spin = [x, y, z];
        let [x, y, z, partner_radius] = N::load(processor, &self.partner_spin[rows.clone()]);
        let partner_spin = [x, y, z];
        let depth = radius + partner_radius - length;
        let touching = depth.exceeds(zero);
        let overlap = N::choose(touching, depth, zero);
        let arm = radius - half * overlap;
        let partner_arm = if WALL {
            zero
        } else {
            partner_radius - half * overlap
        };

        // Normal force.
        let [x, y, z, stopping] = N::load(processor, &self.velocity[rows.clone()]);
        let velocity = [x, y, z];
        let approach = dot(velocity, normal);
        let law_constants = N::load(processor, &self.coefficients[rows.clone()]);
        let Coefficients {
            normal_stiffness,
            normal_damping,
            tangential_stiffness,
            tangential_damping,
        } = law.coefficients(law_constants, overlap);
        let normal_damping = N::choose(touching, normal_damping, zero);
        let elastic = normal_stiffness * overlap;
        let repulsion = law.normal_force(elastic, normal_damping * approach, zero);

        // Slip of the grain's surface over its partner's, and the spring it stretches.
        let [friction, rolling_arm, _, _] = N::load(processor, &self.friction[rows.clone()]);
        let rolling_sum = plus(times(spin, arm), times(partner_spin, partner_arm));
        let slip = plus(
            minus(velocity, times(normal, approach)),
            cross(rolling_sum, normal),
        );
        let [x, y, z, _] = N::load(processor, &self.springs[rows.clone()]);
        let stretched = plus([x, y, z], times(slip, dt));
        let stretched = minus(stretched, times(normal, dot(stretched, normal)));
        let stretch_squared = dot(stretched, stretched);
        let trial = tangential_stiffness * stretch_squared.sqrt();
        let bound = friction * law.coulomb_force(elastic, repulsion, zero);
        let slides = trial.exceeds(bound);
        let kept = N::choose(slides, bound / trial, one);
        let kept = N::choose(touching, kept, zero);
        let damping = N::choose(touching, N::choose(slides, zero, tangential_damping), zero);
        let spring = times(stretched, kept);
        N::store(
            [spring[0], spring[1], spring[2], zero],
            &mut self.springs[rows.clone()],
        );
        let tangential = minus(times(spring, -tangential_stiffness), times(slip, damping));

        // Rolling.
        let [x, y, z, _] = N::load(processor, &self.rolling_spin[rows.clone()]);
        let rolling_spin = [x, y, z];
        let gain = rolling_gain(
            rolling_arm * elastic,
            stopping,
            dot(rolling_spin, rolling_spin).sqrt(),
        );
        let without_twist = minus(rolling_spin, times(normal, dot(rolling_spin, normal)));
        let rolling = times(without_twist, -gain);

        // What it does, and where the energy goes.
        let force = minus(tangential, times(normal, repulsion));
        let twist = cross(normal, tangential);
        let in_dashpots = dt * ((repulsion - elastic) * approach + damping * dot(slip, slip));
        let in_sliding = tangential_stiffness * stretch_squared * kept * (one - kept);
        let in_rolling = dt * dot(rolling, minus(partner_spin, spin));
        let by_wall = if WALL {
            let [x, y, z, _] = N::load(processor, &self.wall_velocity[rows.clone()]);
            dt * (dot(force, [x, y, z]) + dot(rolling, partner_spin))
        } else {
            zero
        };
        let touches = N::choose(touching, one, zero);
        N::store(
            [force[0], force[1], force[2], arm],
            &mut effects.force[rows.clone()],
        );
        N::store(
            [twist[0], twist[1], twist[2], partner_arm],
            &mut effects.twist[rows.clone()],
        );
        N::store(
            [rolling[0], rolling[1], rolling[2], touches],
            &mut effects.rolling[rows.clone()],
        );
        N::store(
            [in_dashpots, in_sliding, in_rolling, by_wall],
            &mut effects.exchanged[rows],
        );
    }
}

/// Runs `rows` through blocks: pairs of a grain and a wall where `WALL` says so, else pairs of grains.
#[inline(always)]
fn blocks<N: Lanes, L: Law, const WALL: bool>(
    processor: N::Processor,
    all: &Surroundings<'_, L>,
    rows: PairRows<'_>,
) {
    let (mut block, mut effects) = (Block::empty(), Effects::empty());
    let outputs = rows
        .springs
        .chunks_mut(BLOCK)
        .zip(rows.actions.chunks_mut(BLOCK));
    for (pairs, (springs, actions)) in rows.pairs.chunks(BLOCK).zip(outputs) {
        block.springs[..springs.len()].copy_from_slice(springs);
        for (k, pair) in pairs.iter().enumerate() {
            block.set_constants(k, &all.constants[pair.kind as usize]);
            let grain = &all.bodies[pair.grain as usize];
            if WALL {
                block.pack_wall(k, grain, &all.walls[pair.partner as usize]);
            } else {
                block.pack_grains(k, grain, &all.bodies[pair.partner as usize]);
            }
        }
        for k in (0..pairs.len()).step_by(N::COUNT) {
            block.compute::<N, L, WALL>(processor, all.law, all.dt, k, &mut effects);
        }
        springs.copy_from_slice(&block.springs[..springs.len()]);
        for (k, action) in actions.iter_mut().enumerate() {
            *action = effects.unpack(k);
        }
    }
}

/// A range of pairs with the rows they write.
pub struct PairRows<'a> {
    /// The pairs.
    pub pairs: &'a [Pair],
    /// Their tangential springs.
    pub springs: &'a mut [Row],
    /// What they do.
    pub actions: &'a mut [Action],
}

/// What every pair's force depends on.
pub struct Surroundings<'a, L> {
    /// The contact law.
    pub law: L,
    /// Length of the step [s].
    pub dt: f64,
    /// Every grain.
    pub bodies: &'a [Body],
    /// Every wall.
    pub walls: &'a [WallBody],
    /// Constants of every kind of pair.
    pub constants: &'a [PairConstants],
}

/// The forces of a range of pairs of grains and a range of pairs with walls.
pub struct Forces<'a, L> {
    /// What they depend on.
    pub surroundings: Surroundings<'a, L>,
    /// Pairs of grains.
    pub of_grains: PairRows<'a>,
    /// Pairs of a grain and a wall.
    pub of_walls: PairRows<'a>,
}

impl<L: Law> Work for Forces<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        blocks::<N, L, false>(processor, &self.surroundings, self.of_grains);
        blocks::<N, L, true>(processor, &self.surroundings, self.of_walls);
    }
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
