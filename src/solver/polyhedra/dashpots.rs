//! Dashpots taken implicitly, pair by pair.
//!
//! In: the damping matrix of every pair whose features touch, its bodies before and after all other
//! forces have acted. Out: the force of each pair's dashpots and its torques, equal and opposite.
//!
//! All dashpots of a pair together are one symmetric matrix, `G = Σ c w wᵀ` over its contacts, with
//! `w = (n, a × n)` of the normal and the arm, that makes a force and a torque `F = −G u` of the
//! relative velocity and spin `u`. The θ-method takes
//!
//! ```text
//! F = −G [(1 − θ) u⁻ + θ u⁺],  u⁺ = u* + Δt A F + what the other pairs' dashpots do
//! ```
//!
//! where `u⁻` is that of half a step ago, `u*` what springs, friction and gravity make of it, and
//! `A` the response of the two bodies. With `θ = (1 + x)/(2 + x)`, `x = Δt Σc (1/m)` over all
//! dashpots of either body, a soft dashpot is taken at the middle of the step, to second order, and
//! a stiff one at its end, so that it cannot overshoot.
//!
//! Pairs are solved at once, each as if it had a part of its bodies' mass and inertia to itself, as
//! large as its part of their dashpots: then no body can be stopped more than once, whatever the
//! step (mass splitting). Every further sweep starts from the velocities that the last one led to,
//! and comes nearer to what all pairs together ask for. Whatever the number of sweeps, forces come
//! in pairs: momentum and angular momentum stay.
//!
//! Not here: which dashpots act, and at what normal ([`super::forces`]).

use super::bodies::{Body, Load};
use super::damping::{Matrix, Packed, ROWS, SUM, entry, softened};
use super::nearest::group;
use super::pairs::{PackedPartner, Pair, PairForce};
use crate::lanes::{Lanes, Quad, Row, WIDEST, Work, cross, dot, minus, plus, side_by_side, times};
use crate::world::{Grains, Partner};

/// How often the pairs are solved in a step.
pub const SWEEPS: usize = 2;

/// The dashpots of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Damper {
    /// The pair, among those of its worker.
    pub pair: u32,
    /// The grain on which its force acts.
    first: u32,
    /// The other side.
    second: PackedPartner,
    /// `G` [N s/m, N s, N m s], after the first sweep `(G⁻¹ + θ Δt A)⁻¹`; the sum of the dashpots
    /// [N s/m].
    matrix: [Row; ROWS],
    /// Force [N] and torque [N m] on the first.
    force: Row,
    torque: Row,
}

/// A contact's dashpot, and its springs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dashpot {
    /// Unit normal; the dashpot, none where the contact has let go [N s/m].
    pub normal: Row,
    /// The arm across the normal [m]; the normal spring, none where the contact has let go [N/m].
    pub moment: Row,
    /// The arm [m]; how stiff the contact is against a change of its slip within a step [N/m].
    pub arm: Row,
    /// Of a gap that closes within the step: its spring [N/m], none where it is none, and its
    /// overlap, which is negative [m].
    pub closing: Row,
}

impl Dashpot {
    /// The spring of a gap that closes within the step, none where it is none [N/m].
    pub fn closing_spring(&self) -> f64 {
        self.closing[0]
    }
}

/// How a body moves after all forces so far, and how it responds to more.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(128))]
pub struct Response {
    /// Velocity half a step ahead [m/s]; inverse mass [1/kg].
    pub velocity: Row,
    /// Spin half a step ahead at the present orientation [rad/s]; sum of all its dashpots [N s/m].
    pub spin: Row,
    /// Inverse inertia along the axes of the world: xx, xy, xz, yy [1/(kg m²)].
    pub inertia: Row,
    /// yz, zz.
    pub rest: Row,
}

/// How walls move, and how they respond to dashpots: not at all.
pub fn responses_of_walls(motions: &[[Row; 3]]) -> Vec<([Row; 3], Response)> {
    let response = |[_, velocity, spin]: &[Row; 3]| Response {
        velocity: *velocity,
        spin: *spin,
        ..Response::default()
    };
    let motions = motions.iter();
    motions.map(|motion| (*motion, response(motion))).collect()
}

impl Body {
    /// How the body moves half a step ahead under `load`, and how it responds to more; `strength`
    /// is the sum of its dashpots.
    #[inline(always)]
    pub fn response(&self, load: &Load, dt: f64, gravity: Row, strength: f64) -> Response {
        let [xx, xy, xz, yy, yz, zz] = self.inverse_inertia();
        let unloaded = Response {
            velocity: [0.0, 0.0, 0.0, self.inverse_mass()],
            spin: [0.0, 0.0, 0.0, strength],
            inertia: [xx, xy, xz, yy],
            rest: [yz, zz, 0.0, 0.0],
        };
        unloaded.under(self, load, dt, gravity)
    }
}

impl Response {
    /// The same under another `load` of the same `body`.
    #[inline(always)]
    #[must_use]
    pub fn under(&self, body: &Body, load: &Load, dt: f64, gravity: Row) -> Self {
        let ([xx, xy, xz, yy], [yz, zz, ..]) = (self.inertia, self.rest);
        let mut found = *self;
        let inverse_mass = self.velocity[3];
        let turn = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        for axis in 0..3 {
            let [x, y, z] = turn[axis];
            let [tx, ty, tz, _] = load.torque;
            let acceleration = load.force[axis] * inverse_mass + gravity[axis];
            found.velocity[axis] = body.velocity[axis] + dt * acceleration;
            found.spin[axis] = body.spin[axis] + dt * (x * tx + y * ty + z * tz);
        }
        found
    }
}

impl Damper {
    /// The `dashpots` of the contacts of `pair`, number `number` of its worker; none where all have
    /// let go.
    #[inline(always)]
    pub fn of(number: u32, pair: &Pair, dashpots: &[Dashpot]) -> Option<Self> {
        let mut matrix: Packed = [0.0; 4 * ROWS];
        for dashpot in dashpots {
            let [nx, ny, nz, strength] = dashpot.normal;
            let [tx, ty, tz, _] = dashpot.moment;
            let along = [nx, ny, nz, tx, ty, tz];
            for i in 0..6 {
                let scaled = strength * along[i];
                for j in 0..=i {
                    matrix[entry(i, j)] += scaled * along[j];
                }
            }
            matrix[SUM] += strength;
        }
        let mut rows = [[0.0; 4]; ROWS];
        for (k, row) in rows.iter_mut().enumerate() {
            row.copy_from_slice(&matrix[4 * k..4 * k + 4]);
        }
        (matrix[SUM] > 0.0).then_some(Self {
            pair: number,
            first: pair.first,
            second: pair.second,
            matrix: rows,
            force: [0.0; 4],
            torque: [0.0; 4],
        })
    }

    /// The sum of the dashpots [N s/m].
    #[inline(always)]
    pub fn strength(&self) -> f64 {
        self.matrix[SUM / 4][SUM % 4]
    }
}

/// One sweep over the dampers of a worker.
pub struct DampingSweep<'a> {
    /// Whether it is the first of the step.
    pub first: bool,
    /// Length of the step [s].
    pub dt: f64,
    /// The dampers.
    pub dampers: &'a mut [Damper],
    /// Every body as it was half a step ago.
    pub bodies: &'a [Body],
    /// What it has become so far.
    pub responses: &'a [Response],
    /// Position, velocity and spin of every wall, and what it becomes: the same.
    pub walls: &'a [([Row; 3], Response)],
    /// What each pair's dashpots do.
    pub forces: &'a mut [PairForce],
}

impl Work for DampingSweep<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        for start in (0..self.dampers.len()).step_by(N::COUNT) {
            let end = (start + N::COUNT).min(self.dampers.len());
            let own = group::<N, _>(&self.dampers[start..end]);
            let pairs = DampedPairs::<N>::gather(processor, &self, own);
            let matrix = pairs.matrix(processor, own, self.first);
            let wrench = pairs.wrench(processor, &matrix, own, self.first);
            let found = pairs.forces(processor, wrench);
            if self.first {
                for row in 0..ROWS {
                    let columns = matrix.row(row);
                    for (k, damper) in self.dampers[start..end].iter_mut().enumerate() {
                        damper.matrix[row] = columns[k].row();
                    }
                }
            }
            for (k, damper) in self.dampers[start..end].iter_mut().enumerate() {
                let (force, first, second) =
                    (found[0][k].row(), found[1][k].row(), found[2][k].row());
                damper.force = force;
                damper.torque = first;
                let effect = &mut self.forces[damper.pair as usize];
                (effect.force, effect.first, effect.second) = (force, first, second);
                if let Partner::Wall(w) = damper.second.unpack() {
                    let ([_, velocity, spin], _) = &self.walls[w as usize];
                    let product = |a: &Row, b: &Row| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                    effect.exchanged[Grains::BY_WALLS] =
                        self.dt * (product(&force, velocity) - product(&second, spin));
                }
            }
        }
    }
}

/// A body's response: inverse mass and inverse inertia, each already multiplied by how often the
/// body has to be shared.
struct Compliance<N> {
    mass: N,
    inertia: [[N; 3]; 3],
}

impl<N: Lanes> Compliance<N> {
    /// Spin that a torque gives.
    #[inline(always)]
    fn turn(&self, torque: [N; 3]) -> [N; 3] {
        let [a, b, c] = self.inertia;
        [dot(a, torque), dot(b, torque), dot(c, torque)]
    }
}

/// A side of each pair.
struct Side<N> {
    /// Its centroid [m].
    position: [N; 3],
    /// Velocity and spin half a step ago.
    before: [[N; 3]; 2],
    /// What they have become so far.
    after: [[N; 3]; 2],
    /// Its response by its shared mass.
    compliance: Compliance<N>,
}

impl<N: Lanes> Side<N> {
    /// These sides of pairs whose dashpots add up to `strength`.
    #[inline(always)]
    fn gather(
        processor: N::Processor,
        all: &DampingSweep<'_>,
        sides: [PackedPartner; WIDEST],
        strength: N,
    ) -> Self {
        let motions = side_by_side::<N, _>(|k| all.motion(sides[k]));
        let responses = side_by_side::<N, _>(|k| all.response(sides[k]));
        let [x, y, z, _] = N::gather(processor, side_by_side::<N, _>(|k| motions[k][0]));
        let [vx, vy, vz, _] = N::gather(processor, side_by_side::<N, _>(|k| motions[k][1]));
        let [wx, wy, wz, _] = N::gather(processor, side_by_side::<N, _>(|k| motions[k][2]));
        let [ax, ay, az, mass] =
            N::gather(processor, side_by_side::<N, _>(|k| &responses[k].velocity));
        let [bx, by, bz, dashpots] =
            N::gather(processor, side_by_side::<N, _>(|k| &responses[k].spin));
        let [jxx, jxy, jxz, jyy] =
            N::gather(processor, side_by_side::<N, _>(|k| &responses[k].inertia));
        let [jyz, jzz, ..] = N::gather(processor, side_by_side::<N, _>(|k| &responses[k].rest));
        let part = dashpots / strength;
        Self {
            position: [x, y, z],
            before: [[vx, vy, vz], [wx, wy, wz]],
            after: [[ax, ay, az], [bx, by, bz]],
            compliance: Compliance {
                mass: mass * part,
                inertia: [
                    times([jxx, jxy, jxz], part),
                    times([jxy, jyy, jyz], part),
                    times([jxz, jyz, jzz], part),
                ],
            },
        }
    }
}

/// Velocity and spin of the first side relative to the second at the first's centroid.
#[inline(always)]
pub fn relative<N: Lanes>(between: [N; 3], [first, second]: [[[N; 3]; 2]; 2]) -> [N; 6] {
    let turning = cross(second[1], between);
    let [vx, vy, vz] = minus(minus(first[0], second[0]), turning);
    let [wx, wy, wz] = minus(first[1], second[1]);
    [vx, vy, vz, wx, wy, wz]
}

impl DampingSweep<'_> {
    /// Position, velocity and spin half a step ago of a side of a pair.
    #[inline(always)]
    fn motion(&self, side: PackedPartner) -> [&Row; 3] {
        match side.unpack() {
            Partner::Grain(i) => {
                let body = &self.bodies[i as usize];
                [&body.position, &body.velocity, &body.spin]
            }
            Partner::Wall(w) => self.walls[w as usize].0.each_ref(),
        }
    }

    /// What such a side has become so far.
    #[inline(always)]
    fn response(&self, side: PackedPartner) -> &Response {
        match side.unpack() {
            Partner::Grain(i) => &self.responses[i as usize],
            Partner::Wall(w) => &self.walls[w as usize].1,
        }
    }
}

/// As many pairs as there are lanes, side by side.
struct DampedPairs<N> {
    /// From the second's centroid to the first's [m].
    between: [N; 3],
    /// `(1 − θ) u⁻ + θ u` with the velocities so far.
    relative: [N; 6],
    /// `θ Δt`.
    h: N,
    /// Responses of the sides.
    sides: [Compliance<N>; 2],
}

impl<N: Lanes> DampedPairs<N> {
    #[inline(always)]
    fn gather(processor: N::Processor, all: &DampingSweep<'_>, own: [&Damper; WIDEST]) -> Self {
        let one = N::splat(processor, 1.0);
        let two = N::splat(processor, 2.0);
        let dt = N::splat(processor, all.dt);
        let strength = side_by_side::<N, _>(|k| &own[k].matrix[SUM / 4]);
        let strength = N::gather(processor, strength)[SUM % 4];
        let firsts = side_by_side::<N, _>(|k| PackedPartner::grain(own[k].first));
        let seconds = side_by_side::<N, _>(|k| own[k].second);
        let first = Side::<N>::gather(processor, all, firsts, strength);
        let second = Side::<N>::gather(processor, all, seconds, strength);
        let between = minus(first.position, second.position);
        let before = relative(between, [first.before, second.before]);
        let after = relative(between, [first.after, second.after]);
        let x = dt * strength * (first.compliance.mass + second.compliance.mass);
        let theta = (one + x) / (two + x);
        let mut mixed = before;
        for k in 0..6 {
            mixed[k] = before[k] + theta * (after[k] - before[k]);
        }
        Self {
            between,
            relative: mixed,
            h: theta * dt,
            sides: [first.compliance, second.compliance],
        }
    }

    /// `(G⁻¹ + θ Δt A)⁻¹`: computed in the first sweep, remembered in the others.
    #[inline(always)]
    fn matrix(&self, processor: N::Processor, own: [&Damper; WIDEST], first: bool) -> Matrix<N> {
        let zero = N::splat(processor, 0.0);
        let mut known = Matrix([zero; 4 * ROWS]);
        for row in 0..ROWS {
            let columns = N::gather(processor, side_by_side::<N, _>(|k| &own[k].matrix[row]));
            for (column, of) in columns.into_iter().enumerate() {
                known.0[4 * row + column] = of;
            }
        }
        if first {
            let one = N::splat(processor, 1.0);
            softened(one, &known, &self.response(zero), self.h)
        } else {
            known
        }
    }

    /// `A`: velocity and spin of the first relative to the second that a force on the first and a
    /// torque about its centroid make, by the shared masses.
    #[inline(always)]
    fn response(&self, zero: N) -> Matrix<N> {
        let [first, second] = &self.sides;
        let [x, y, z] = self.between;
        // J₂ R with R f = r × f.
        let [a, b, c] = second.inertia;
        let r = [x, y, z];
        let turned = [cross(a, r), cross(b, r), cross(c, r)];
        let mut found = Matrix([zero; 4 * ROWS]);
        for i in 0..3 {
            // Rᵀ (J₂ R): column j of J₂ R crossed with r.
            let column = cross([turned[0][i], turned[1][i], turned[2][i]], [x, y, z]);
            for j in 0..3 {
                found.0[entry(3 + j, i)] = turned[j][i];
                if j >= i {
                    found.0[entry(j, i)] = column[j];
                    found.0[entry(3 + j, 3 + i)] = first.inertia[j][i] + second.inertia[j][i];
                }
            }
            found.0[entry(i, i)] = found.0[entry(i, i)] + first.mass + second.mass;
        }
        found
    }

    /// Force and torque on the firsts.
    #[inline(always)]
    fn wrench(
        &self,
        processor: N::Processor,
        matrix: &Matrix<N>,
        own: [&Damper; WIDEST],
        first: bool,
    ) -> [N; 6] {
        let mut wanted = self.relative;
        for k in 0..6 {
            wanted[k] = -wanted[k];
        }
        if !first {
            let [fx, fy, fz, _] = N::gather(processor, side_by_side::<N, _>(|k| &own[k].force));
            let [tx, ty, tz, _] = N::gather(processor, side_by_side::<N, _>(|k| &own[k].torque));
            let (force, torque) = ([fx, fy, fz], [tx, ty, tz]);
            let [one, other] = &self.sides;
            let turned = other.turn(plus(torque, cross(self.between, force)));
            let velocity = plus(
                times(force, one.mass + other.mass),
                cross(turned, self.between),
            );
            let spin = plus(one.turn(torque), turned);
            for axis in 0..3 {
                wanted[axis] = wanted[axis] + self.h * velocity[axis];
                wanted[3 + axis] = wanted[3 + axis] + self.h * spin[axis];
            }
        }
        matrix.times(wanted)
    }

    /// Force on the first, its torque on the first and on the second.
    #[inline(always)]
    fn forces(&self, processor: N::Processor, wrench: [N; 6]) -> [[N::Quad; WIDEST]; 3] {
        let zero = N::splat(processor, 0.0);
        let [fx, fy, fz, tx, ty, tz] = wrench;
        let [sx, sy, sz] = plus([tx, ty, tz], cross(self.between, [fx, fy, fz]));
        [
            N::rows([fx, fy, fz, zero]),
            N::rows([tx, ty, tz, zero]),
            N::rows([-sx, -sy, -sz, zero]),
        ]
    }
}
