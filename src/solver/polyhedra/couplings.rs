//! Springs and dashpots of pairs, as what couples the motions of their bodies within a step.
//!
//! In: springs and dashpots of the contacts of every pair that touches. Out: for each pair one
//! symmetric matrix `H`, what it makes of velocities, and in the end the pair's wrench. What is
//! solved with it, and why it is this, is told in [`super::joint`].
//!
//! With `w = (n, a × n)` of a contact's normal and arm, and `w_e = (e, a × e)` of each direction
//! `e` across the normal,
//!
//! ```text
//! A = Σ K_n w wᵀ  of contacts that hold,   T = Σ k_t Σ_e w_e w_eᵀ,
//! H = (θ Δt c/K_n + β Δt²) A + ¼ Δt² T,
//! ```
//!
//! as `c/K_n` is one number for a pair. The sum over `e` is that over all three axes less the
//! normal's: `Σ_e w_e w_eᵀ = E(a) − w wᵀ`, `E(a)` being the unit matrix for forces, `(a × e_i)_j`
//! between forces and torques, `a² − a aᵀ` for torques.
//!
//! Not here: which contacts hold, stick and slide ([`super::contact_group`]), the bodies
//! ([`super::joint`]).

use super::super::row::sub;
use super::bodies::Body;
use super::gaps::{ClosingGaps, Gap};
use super::implicit_contact::ImplicitContact;
use super::matrix::{ENTRIES, Matrix, Packed, ROWS, entry};
use super::motion::crossed;
use super::nearest::group;
use super::pairs::{PackedPartner, Pair, PairForce};
use crate::lanes::{Lanes, Quad, Row, WIDEST, Work, cross, minus, plus, side_by_side};
use crate::world::{Grains, Partner};
use std::ops::Range;

/// Where the sum of the springs stands behind the entries of a matrix.
const SUM: usize = ENTRIES;

/// Where the ratio of dashpot to spring stands behind it.
const RATIO: usize = SUM + 1;

/// Springs and dashpots of a pair together.
#[derive(Clone, Copy, Debug)]
pub struct Coupling {
    /// The pair, among those of its worker.
    pair: u32,
    /// The grain on which its force acts.
    first: u32,
    /// The other side.
    second: PackedPartner,
    /// `A` [N/m, N, N m]; sum of the springs [N/m]; dashpot over spring [s].
    normal: [Row; ROWS],
    /// `T`, likewise.
    tangential: [Row; ROWS],
    /// From which to which of its worker's gaps that close within the step are its.
    gaps: [u32; 2],
}

/// A pair's wrench.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub struct Wrench {
    /// Force on the first [N].
    pub force: Row,
    /// Its torque on the first [N m].
    pub first: Row,
    /// On the second [N m].
    pub second: Row,
}

/// A velocity and a spin.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct Motion {
    /// Velocity [m/s].
    pub velocity: Row,
    /// Spin [rad/s].
    pub spin: Row,
}

/// A symmetric matrix of three rows: xx, xy, xz, yy, yz, zz.
pub type Symmetric = [f64; 6];

/// What a pair adds to the matrices of its bodies: of forces for velocities, of torques on the
/// first for its spin, and of those on the second for its.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub struct Blocks {
    rows: [Row; 5],
}

impl Blocks {
    /// That on the velocity of either side.
    #[inline(always)]
    pub fn velocity(&self) -> Symmetric {
        let [[a, b, c, d], [e, f, ..], ..] = self.rows;
        [a, b, c, d, e, f]
    }

    /// That on the spin of the first or the second side.
    #[inline(always)]
    pub fn spin(&self, is_second: bool) -> Symmetric {
        let [_, [_, _, a, b], [c, d, e, f], [g, h, i, j], [k, l, ..]] = self.rows;
        if is_second {
            [g, h, i, j, k, l]
        } else {
            [a, b, c, d, e, f]
        }
    }
}

impl Coupling {
    /// That of the contacts of `pair`, number `number` of its worker; `ratio` is a dashpot over its
    /// spring [s]. None where nothing holds, sticks or slides.
    #[inline(always)]
    pub fn of<Q: Quad>(
        processor: Q::Processor,
        (number, pair): (u32, &Pair),
        ratio: f64,
        contacts: &[ImplicitContact],
    ) -> Option<Self> {
        let mut sums = Sums::<Q>::none(processor);
        for contact in contacts {
            sums.add(processor, contact);
        }
        let closing: f64 = contacts.iter().map(ImplicitContact::closing_spring).sum();
        if sums.springs + sums.arms[3] + closing == 0.0 {
            return None;
        }
        let mut normal = packed(&sums.normal);
        (normal[SUM], normal[RATIO]) = (sums.springs + closing, ratio);
        let mut tangential = packed(&sums.across).map(|x| -x);
        add_directions(&mut tangential, sums.arms, sums.squares);
        Some(Self {
            pair: number,
            first: pair.first,
            second: pair.second,
            normal: rows_of(&normal),
            tangential: rows_of(&tangential),
            gaps: [0; 2],
        })
    }

    /// Takes note of which gaps of its worker are its.
    #[inline(always)]
    pub fn set_gaps(&mut self, own: Range<usize>) {
        self.gaps = [own.start as u32, own.end as u32];
    }

    /// Which these are.
    #[inline(always)]
    fn gaps(&self) -> Range<usize> {
        self.gaps[0] as usize..self.gaps[1] as usize
    }

    /// The sum of the normal springs [N/m].
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        self.normal[SUM / 4][SUM % 4]
    }

    /// Both sides.
    #[inline(always)]
    pub fn sides(&self) -> [PackedPartner; 2] {
        [PackedPartner::grain(self.first), self.second]
    }

    /// Number of the pair among those of its worker.
    #[inline(always)]
    pub fn pair(&self) -> usize {
        self.pair as usize
    }
}

/// Sums over the contacts of a pair.
struct Sums<Q> {
    /// `K_n w wᵀ` and `k_t w wᵀ`.
    normal: [Q; PIECES],
    across: [Q; PIECES],
    /// `K_n`.
    springs: f64,
    /// `k_t a` and `k_t`.
    arms: Row,
    /// `k_t a aᵀ`.
    squares: Symmetric,
}

impl<Q: Quad> Sums<Q> {
    #[inline(always)]
    fn none(processor: Q::Processor) -> Self {
        let zero = Q::repeat(processor, 0.0);
        Self {
            normal: [zero; PIECES],
            across: [zero; PIECES],
            springs: 0.0,
            arms: [0.0; 4],
            squares: [0.0; 6],
        }
    }

    #[inline(always)]
    fn add(&mut self, processor: Q::Processor, contact: &ImplicitContact) {
        let [nx, ny, nz, _] = contact.normal;
        let [tx, ty, tz, spring] = contact.moment;
        let [x, y, z, stick] = contact.arm;
        let along = [nx, ny, nz, tx, ty, tz, ty, tz];
        let begin = Q::load(processor, &[nx, ny, nz, tx]);
        let end = Q::load(processor, &[tx, ty, tz, 0.0]);
        let [springs, sticks] = [spring, stick].map(|k| Q::repeat(processor, k));
        for (piece, along) in along.into_iter().enumerate() {
            let row = if piece < 6 { begin } else { end };
            let product = row * Q::repeat(processor, along);
            self.normal[piece] = self.normal[piece] + springs * product;
            self.across[piece] = self.across[piece] + sticks * product;
        }
        self.springs += spring;
        let arm = [stick * x, stick * y, stick * z, stick];
        let [sx, sy, sz, _] = arm;
        let squares = [sx * x, sx * y, sx * z, sy * y, sy * z, sz * z];
        for (sum, own) in self.arms.iter_mut().zip(arm) {
            *sum += own;
        }
        for (sum, own) in self.squares.iter_mut().zip(squares) {
            *sum += own;
        }
    }
}

/// Adds `Σ k E(a)` to a matrix, from the sums of `k a` and `k`, and of `k a aᵀ`.
#[inline(always)]
fn add_directions(matrix: &mut Packed, [x, y, z, k]: Row, [xx, xy, xz, yy, yz, zz]: Symmetric) {
    let mut add = |i: usize, j: usize, value: f64| matrix[entry(i, j)] += value;
    for i in 0..3 {
        add(i, i, k);
    }
    // a × e_i: (0, z, −y), (−z, 0, x), (y, −x, 0).
    add(4, 0, z);
    add(5, 0, -y);
    add(3, 1, -z);
    add(5, 1, x);
    add(3, 2, y);
    add(4, 2, -x);
    add(3, 3, yy + zz);
    add(4, 4, xx + zz);
    add(5, 5, xx + yy);
    add(4, 3, -xy);
    add(5, 3, -xz);
    add(5, 4, -yz);
}

/// Pieces of four products in which `w wᵀ` is summed: of `w_i` with the first four, row by row,
/// then of the last two with the last three.
const PIECES: usize = 8;

/// The lower triangle of what such pieces add up to.
#[inline(always)]
fn packed<Q: Quad>(pieces: &[Q; PIECES]) -> Packed {
    let rows = pieces.map(Quad::row);
    let mut packed = [0.0; 4 * ROWS];
    for i in 0..6 {
        for j in 0..=i {
            packed[entry(i, j)] = if j < 4 {
                rows[i][j]
            } else {
                rows[2 + i][j - 3]
            };
        }
    }
    packed
}

fn rows_of(matrix: &Packed) -> [Row; ROWS] {
    std::array::from_fn(|k| [0, 1, 2, 3].map(|i| matrix[4 * k + i]))
}

/// Columns that a group of pairs keeps from the assembly on: the entries of `H`, from the second
/// centroid to the first, the wrench at the velocities of half a step ago.
const COLUMNS: usize = ENTRIES + 3 + 6;

/// The matrices of a worker's pairs.
pub struct Assembly<'a> {
    /// Length of the step [s].
    pub dt: f64,
    /// The worker's pairs.
    pub couplings: &'a [Coupling],
    /// Gaps of these that close within the step.
    pub gaps: &'a mut [Gap],
    /// The changes of the bodies' motions that were found with all gaps, if they were: then only
    /// pairs are assembled again of which a gap stays open by them.
    pub changes: Option<&'a [Motion]>,
    /// Every body as it was half a step ago.
    pub bodies: &'a [Body],
    /// The sum of the normal springs on each over its mass [1/s²].
    pub stiffnesses: &'a [f64],
    /// Position, velocity and spin of every wall.
    pub walls: &'a [[Row; 3]],
    /// Groups of pairs, [`COLUMNS`] after each other.
    pub columns: &'a mut Vec<f64>,
    /// Wrenches at the velocities of half a step ago.
    pub wrenches: &'a mut [Wrench],
    /// What the pairs add to their bodies' matrices.
    pub blocks: &'a mut [Blocks],
}

/// Sides of pairs.
struct Side<N> {
    /// Centroids [m].
    position: [N; 3],
    /// Velocities and spins half a step ago.
    motion: [[N; 3]; 2],
    /// All normal springs on the body over its mass [1/s²].
    stiffness: N,
}

/// How pairs side by side are placed, how they moved, and how stiff they are.
struct Placed<N> {
    /// From the second centroids to the first [m].
    between: [N; 3],
    /// Relative motions half a step ago.
    before: [N; 6],
    /// `y² = Δt² ΣK_n (1/m)` over all normal springs on either body.
    stiffness: N,
}

impl Assembly<'_> {
    /// These sides; of a wall no mass counts its springs.
    #[inline(always)]
    fn side<N: Lanes>(&self, processor: N::Processor, sides: [PackedPartner; WIDEST]) -> Side<N> {
        let of = |side: PackedPartner| match side.unpack() {
            Partner::Grain(i) => {
                let (body, stiffness) = (&self.bodies[i as usize], self.stiffnesses[i as usize]);
                ([&body.position, &body.velocity, &body.spin], stiffness)
            }
            Partner::Wall(w) => (self.walls[w as usize].each_ref(), 0.0),
        };
        let all = side_by_side::<N, _>(|k| of(sides[k]));
        let [x, y, z, _] = N::gather(processor, side_by_side::<N, _>(|k| all[k].0[0]));
        let [vx, vy, vz, _] = N::gather(processor, side_by_side::<N, _>(|k| all[k].0[1]));
        let [wx, wy, wz, _] = N::gather(processor, side_by_side::<N, _>(|k| all[k].0[2]));
        let stiffnesses = side_by_side::<N, _>(|k| all[k].1);
        Side {
            position: [x, y, z],
            motion: [[vx, vy, vz], [wx, wy, wz]],
            stiffness: N::load(processor, &stiffnesses[..N::COUNT]),
        }
    }

    #[inline(always)]
    fn place<N: Lanes>(&self, processor: N::Processor, own: [&Coupling; WIDEST]) -> Placed<N> {
        let firsts = side_by_side::<N, _>(|k| PackedPartner::grain(own[k].first));
        let first = self.side::<N>(processor, firsts);
        let second = self.side::<N>(processor, side_by_side::<N, _>(|k| own[k].second));
        let between = minus(first.position, second.position);
        let square = N::splat(processor, self.dt * self.dt);
        Placed {
            between,
            before: relative(between, [first.motion, second.motion]),
            stiffness: square * (first.stiffness + second.stiffness),
        }
    }

    /// `H` and, as a force and a torque on the firsts, what springs and dashpots add by the
    /// velocities of half a step ago: `−(c/K_n + σ Δt) A u⁻`.
    #[inline(always)]
    fn matrix<N: Lanes>(
        &self,
        processor: N::Processor,
        own: [&Coupling; WIDEST],
        placed: &Placed<N>,
    ) -> (Matrix<N>, [N; 6]) {
        let normal = gather::<N>(processor, |k, row| &own[k].normal[row]);
        let mut matrix = gather::<N>(processor, |k, row| &own[k].tangential[row]);
        let (one, dt) = (N::splat(processor, 1.0), N::splat(processor, self.dt));
        let quarter = N::splat(processor, 0.25 * self.dt * self.dt);
        let (ratio, square) = (normal.0[RATIO], placed.stiffness);
        let x = square * ratio / dt;
        let theta = (one + x) / (one + one + x);
        let soft = N::splat(processor, 0.0625) * square * square;
        let sigma = soft / (one + soft);
        let beta = quarter * (one + sigma) * (one + sigma);
        let weight = theta * dt * ratio + beta;
        for k in 0..ENTRIES {
            matrix.0[k] = weight * normal.0[k] + quarter * matrix.0[k];
        }
        let mut wrench = normal.times(placed.before);
        for part in 0..6 {
            wrench[part] = -(wrench[part] * (ratio + sigma * dt));
        }
        if own.iter().any(|own| !own.gaps().is_empty()) {
            let late = theta + theta - one;
            let share = (late * ratio + sigma * dt, placed.before);
            self.add_gaps(processor, own, share, (&mut matrix, &mut wrench));
        }
        (matrix, wrench)
    }
}

impl Assembly<'_> {
    /// Lets those gaps of the pairs `start` to `end` stay open that the `changes` of the motions
    /// leave open; true where there are any.
    #[inline(always)]
    fn let_open(&mut self, [start, end]: [usize; 2], changes: &[Motion]) -> bool {
        let mut opens = false;
        for own in &self.couplings[start..end] {
            if own.gaps().is_empty() {
                continue;
            }
            let first = self.after(PackedPartner::grain(own.first), changes);
            let motion = relative_rows(&first, &self.after(own.second, changes));
            for gap in &mut self.gaps[own.gaps()] {
                opens |= gap.let_open(&motion, self.dt);
            }
        }
        opens
    }

    /// The position of a side of a pair, and how it moves after these `changes`.
    #[inline(always)]
    fn after(&self, side: PackedPartner, changes: &[Motion]) -> [Row; 3] {
        match side.unpack() {
            Partner::Grain(i) => {
                let (body, change) = (&self.bodies[i as usize], &changes[i as usize]);
                let velocity = add(body.velocity, change.velocity);
                [body.position, velocity, add(body.spin, change.spin)]
            }
            Partner::Wall(w) => self.walls[w as usize],
        }
    }

    /// Adds what the gaps of these pairs that close within the step do to `H` and to the wrench at
    /// the velocities of half a step ago; they act as long as `share` [s].
    #[inline(always)]
    fn add_gaps<N: Lanes>(
        &self,
        processor: N::Processor,
        own: [&Coupling; WIDEST],
        (share, before): (N, [N; 6]),
        (matrix, wrench): (&mut Matrix<N>, &mut [N; 6]),
    ) {
        let gaps = side_by_side::<N, _>(|k| ClosingGaps::of(&self.gaps[own[k].gaps()]));
        let springs = gather::<N>(processor, |k, row| &gaps[k].springs[row]);
        let [fx, fy, fz, _] = N::gather(processor, side_by_side::<N, _>(|k| &gaps[k].push[0]));
        let [tx, ty, tz, _] = N::gather(processor, side_by_side::<N, _>(|k| &gaps[k].push[1]));
        let (push, dt) = ([fx, fy, fz, tx, ty, tz], N::splat(processor, self.dt));
        let closed = springs.times(before);
        for part in 0..6 {
            wrench[part] = wrench[part] - share * (push[part] / dt + closed[part]);
        }
        for k in 0..ENTRIES {
            matrix.0[k] = matrix.0[k] + share * dt * springs.0[k];
        }
    }
}

/// Matrices of pairs side by side, from their rows.
#[inline(always)]
fn gather<'a, N: Lanes>(
    processor: N::Processor,
    row_of: impl Fn(usize, usize) -> &'a Row,
) -> Matrix<N> {
    let mut found = Matrix([N::splat(processor, 0.0); 4 * ROWS]);
    for row in 0..ROWS {
        let columns = N::gather(processor, side_by_side::<N, _>(|k| row_of(k, row)));
        found.0[4 * row..4 * row + 4].copy_from_slice(&columns);
    }
    found
}

impl Work for Assembly<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(mut self, processor: N::Processor) {
        let groups = self.couplings.len().div_ceil(N::COUNT);
        self.columns.resize(groups * COLUMNS * N::COUNT, 0.0);
        for number in 0..groups {
            let start = number * N::COUNT;
            let end = (start + N::COUNT).min(self.couplings.len());
            if let Some(changes) = self.changes
                && !self.let_open([start, end], changes)
            {
                continue;
            }
            let own = group::<N, _>(&self.couplings[start..end]);
            let placed = self.place::<N>(processor, own);
            let (matrix, wrench) = self.matrix(processor, own, &placed);
            let columns = self.columns[start * COLUMNS..].chunks_exact_mut(N::COUNT);
            let kept = matrix.0[..ENTRIES]
                .iter()
                .chain(&placed.between)
                .chain(&wrench);
            for (column, value) in columns.zip(kept) {
                value.store(column);
            }
            let found = rows_of_wrench(processor, placed.between, wrench);
            for (k, out) in self.wrenches[start..end].iter_mut().enumerate() {
                *out = wrench_of::<N>(&found, k);
            }
            let found = blocks_of(processor, &matrix, placed.between);
            for (k, out) in self.blocks[start..end].iter_mut().enumerate() {
                for row in 0..5 {
                    out.rows[row] = found[row][k].row();
                }
            }
        }
    }
}

/// Rows of [`Wrench`] of a force on the firsts and its torque about their centroids.
#[inline(always)]
fn rows_of_wrench<N: Lanes>(
    processor: N::Processor,
    between: [N; 3],
    [fx, fy, fz, tx, ty, tz]: [N; 6],
) -> [[N::Quad; WIDEST]; 3] {
    let zero = N::splat(processor, 0.0);
    let [sx, sy, sz] = plus([tx, ty, tz], cross(between, [fx, fy, fz]));
    [
        N::rows([fx, fy, fz, zero]),
        N::rows([tx, ty, tz, zero]),
        N::rows([-sx, -sy, -sz, zero]),
    ]
}

/// That of pair `k` of them.
#[inline(always)]
fn wrench_of<N: Lanes>(rows: &[[N::Quad; WIDEST]; 3], k: usize) -> Wrench {
    Wrench {
        force: rows[0][k].row(),
        first: rows[1][k].row(),
        second: rows[2][k].row(),
    }
}

/// Rows of [`Blocks`]. With `H` in blocks `A`, `S`, `T` about the first's centroid and
/// `X ω = ω × r`, `r` from the second's centroid to the first's, the second's block on its spin is
/// `T + Xᵀ(S + A X) + Sᵀ X`; a row `b` times `X` is `r × b`.
#[inline(always)]
fn blocks_of<N: Lanes>(
    processor: N::Processor,
    h: &Matrix<N>,
    between: [N; 3],
) -> [[N::Quad; WIDEST]; 5] {
    let zero = N::splat(processor, 0.0);
    let mut shifted = [[zero; 3]; 3];
    for i in 0..3 {
        let across = cross(between, [h.at(i, 0), h.at(i, 1), h.at(i, 2)]);
        shifted[i] = plus([h.at(i, 3), h.at(i, 4), h.at(i, 5)], across);
    }
    let mut second = [[zero; 3]; 3];
    for j in 0..3 {
        let turned = cross(between, [h.at(0, 3 + j), h.at(1, 3 + j), h.at(2, 3 + j)]);
        let again = cross(between, [shifted[0][j], shifted[1][j], shifted[2][j]]);
        for k in 0..3 {
            second[j][k] = second[j][k] + h.at(3 + j, 3 + k) + turned[k];
            second[k][j] = second[k][j] + again[k];
        }
    }
    let [[a, b, c], [_, d, e], [_, _, f]] = second;
    [
        N::rows([h.at(0, 0), h.at(0, 1), h.at(0, 2), h.at(1, 1)]),
        N::rows([h.at(1, 2), h.at(2, 2), h.at(3, 3), h.at(3, 4)]),
        N::rows([h.at(3, 5), h.at(4, 4), h.at(4, 5), h.at(5, 5)]),
        N::rows([a, b, c, d]),
        N::rows([e, f, zero, zero]),
    ]
}

/// What the matrices of a worker's pairs make of motions.
pub struct Product<'a> {
    /// Both sides of the worker's pairs: a product reads nothing else of them but what their assembly
    /// left, of which there is much.
    pub sides: &'a [[PackedPartner; 2]],
    /// What their assembly left.
    pub columns: &'a [f64],
    /// A motion of every body; walls have none.
    pub motions: &'a [Motion],
}

/// What does not move.
static STILL: Motion = Motion {
    velocity: [0.0; 4],
    spin: [0.0; 4],
};

impl Product<'_> {
    /// The motions of these sides.
    #[inline(always)]
    fn side<N: Lanes>(
        &self,
        processor: N::Processor,
        sides: [PackedPartner; WIDEST],
    ) -> [[N; 3]; 2] {
        let of = side_by_side::<N, _>(|k| sides[k].as_grain().map_or(&STILL, |i| &self.motions[i]));
        let [vx, vy, vz, _] = N::gather(processor, side_by_side::<N, _>(|k| &of[k].velocity));
        let [wx, wy, wz, _] = N::gather(processor, side_by_side::<N, _>(|k| &of[k].spin));
        [[vx, vy, vz], [wx, wy, wz]]
    }

    /// `H u` of the pairs `start` to `end`, or with the factor `f` their wrench of half a step ago
    /// and `f H u`.
    #[inline(always)]
    fn of_group<N: Lanes>(
        &self,
        processor: N::Processor,
        [start, end]: [usize; 2],
        factor: Option<f64>,
    ) -> [[N::Quad; WIDEST]; 3] {
        let columns = &self.columns[start * COLUMNS..][..COLUMNS * N::COUNT];
        let own = group::<N, _>(&self.sides[start..end]);
        let first = self.side::<N>(processor, side_by_side::<N, _>(|k| own[k][0]));
        let second = self.side::<N>(processor, side_by_side::<N, _>(|k| own[k][1]));
        let zero = N::splat(processor, 0.0);
        let mut between = [zero; 3];
        for k in 0..3 {
            between[k] = N::load(processor, &columns[(ENTRIES + k) * N::COUNT..][..N::COUNT]);
        }
        let mut matrix = Matrix([zero; 4 * ROWS]);
        for k in 0..ENTRIES {
            matrix.0[k] = N::load(processor, &columns[k * N::COUNT..][..N::COUNT]);
        }
        let u = relative(between, [first, second]);
        let mut wrench = matrix.times(u);
        if let Some(factor) = factor {
            let factor = N::splat(processor, factor);
            for k in 0..6 {
                let column = &columns[(ENTRIES + 3 + k) * N::COUNT..][..N::COUNT];
                wrench[k] = wrench[k] * factor + N::load(processor, column);
            }
        }
        rows_of_wrench(processor, between, wrench)
    }

    /// The pairs that are taken together, from each first to each end.
    #[inline(always)]
    fn groups<N: Lanes>(&self) -> impl Iterator<Item = [usize; 2]> + use<N> {
        let count = self.sides.len();
        (0..count)
            .step_by(N::COUNT)
            .map(move |start| [start, (start + N::COUNT).min(count)])
    }
}

/// `H u` of every pair.
pub struct Image<'a> {
    /// The pairs and the motions.
    pub product: Product<'a>,
    /// What comes of it.
    pub wrenches: &'a mut [Wrench],
    /// A factor of it, to which the wrench of half a step ago is added.
    pub factor: Option<f64>,
}

impl Work for Image<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        for [start, end] in self.product.groups::<N>() {
            let found = self
                .product
                .of_group::<N>(processor, [start, end], self.factor);
            for (k, wrench) in self.wrenches[start..end].iter_mut().enumerate() {
                *wrench = wrench_of::<N>(&found, k);
            }
        }
    }
}

/// The wrenches of the step, `−(c/K_n + σ Δt) A u⁻ − H Δu/Δt`.
pub struct Final<'a> {
    /// Length of the step [s].
    pub dt: f64,
    /// The worker's pairs.
    pub couplings: &'a [Coupling],
    /// What they make of the changes `Δu`.
    pub product: Product<'a>,
    /// Position, velocity and spin of every wall.
    pub walls: &'a [[Row; 3]],
    /// What each pair of the worker does.
    pub forces: &'a mut [PairForce],
}

impl Work for Final<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        let factor = Some(-1.0 / self.dt);
        for [start, end] in self.product.groups::<N>() {
            let found = self.product.of_group::<N>(processor, [start, end], factor);
            for (k, coupling) in self.couplings[start..end].iter().enumerate() {
                let wrench = wrench_of::<N>(&found, k);
                let effect = &mut self.forces[coupling.pair()];
                effect.force = wrench.force;
                effect.first = wrench.first;
                effect.second = wrench.second;
                if let Partner::Wall(w) = coupling.second.unpack() {
                    let [_, velocity, spin] = &self.walls[w as usize];
                    effect.exchanged[Grains::BY_WALLS] =
                        self.dt * (work(&wrench.force, velocity) - work(&wrench.second, spin));
                }
            }
        }
    }
}

/// Velocity and spin of the first side relative to the second at the first's centroid.
#[inline(always)]
fn relative<N: Lanes>(between: [N; 3], [first, second]: [[[N; 3]; 2]; 2]) -> [N; 6] {
    let turning = cross(second[1], between);
    let [vx, vy, vz] = minus(minus(first[0], second[0]), turning);
    let [wx, wy, wz] = minus(first[1], second[1]);
    [vx, vy, vz, wx, wy, wz]
}

/// `a + b` of the vector parts.
#[inline(always)]
fn add(a: Row, b: Row) -> Row {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], 0.0]
}

/// How the first of two moves relative to the second at the first's centroid, of their positions,
/// velocities and spins.
#[inline(always)]
fn relative_rows([x, v, w]: &[Row; 3], [y, u, s]: &[Row; 3]) -> [Row; 2] {
    let across = crossed(*s, sub(*x, *y));
    [sub(sub(*v, *u), across), sub(*w, *s)]
}

/// `a · b` of the vector parts.
#[inline(always)]
fn work(a: &Row, b: &Row) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
