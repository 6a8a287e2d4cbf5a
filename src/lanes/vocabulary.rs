//! What can be computed with numbers that stand side by side, whatever their number.
//!
//! In: nothing. Out: the traits [`Lanes`], [`Quad`] and [`Work`], rows in memory, and vectors of
//! three of which each component is lanes. What the operations are made of is not here: `scalar`,
//! `avx2`, `avx512` and `neon` do that, each for one width.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four numbers side by side in memory: usually a vector and a companion scalar.
pub type Row = [f64; 4];

/// The most numbers that stand side by side.
pub const WIDEST: usize = 8;

/// One row for each of the numbers side by side; the first [`Lanes::COUNT`] of them count.
pub type Rows<'a> = [&'a Row; WIDEST];

/// Numbers that are computed side by side.
pub trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// How many.
    const COUNT: usize;
    /// Proof that the processor can.
    type Processor: Copy;
    /// One truth value for each.
    type Mask: Copy;
    /// A row in registers.
    type Quad: Quad<Processor = Self::Processor>;

    /// `x` in every lane.
    fn splat(processor: Self::Processor, x: f64) -> Self;
    /// The first numbers of a column.
    fn load(processor: Self::Processor, column: &[f64]) -> Self;
    /// To the first numbers of a column.
    fn store(self, column: &mut [f64]);
    /// Column by column.
    fn gather(processor: Self::Processor, rows: Rows) -> [Self; 4];
    /// Column by column, from `a − b`.
    fn gather_difference(processor: Self::Processor, a: Rows, b: Rows) -> [Self; 4];
    /// Column by column: the vectors of `a − b`, the companions of `a + b`.
    fn gather_difference_and_sum(processor: Self::Processor, a: Rows, b: Rows) -> [Self; 4];
    /// The four numbers of one row, each in every lane.
    fn spread(processor: Self::Processor, row: &Row) -> [Self; 4];
    /// Rows again; the first [`Lanes::COUNT`] of them count.
    fn rows(columns: [Self; 4]) -> [Self::Quad; WIDEST];
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Where `self > other`.
    fn exceeds(self, other: Self) -> Self::Mask;
    /// `a` where `mask` holds, elsewhere `b`.
    fn choose(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// In how many lanes `mask` holds.
    fn count(mask: Self::Mask) -> u32;
    /// One number from each lane; the first [`Lanes::COUNT`] of them count.
    fn numbers(self) -> [f64; WIDEST];
    /// `m` between √½ and √2 and whole `k` with `m 2ᵏ` the number, where that is positive and
    /// normal.
    fn split(self) -> (Self, Self);
}

/// How [`Lanes::split`] takes the bits of a number apart. With those of √½ taken off, the
/// exponent's are those of `k`, off by `BIAS`; the others, put on √½'s again, are
/// those of `m`.
pub(super) mod split_bits {
    /// The bits of √½.
    pub const ROOT_OF_HALF: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    /// Brings the exponent of √½ to the bias.
    pub const OFFSET: u64 = 1.0_f64.to_bits() - ROOT_OF_HALF;
    /// All but sign and exponent.
    pub const FRACTION: u64 = (1 << EXPONENT) - 1;
    /// Where the exponent begins.
    pub const EXPONENT: u32 = 52;
    /// A number of which the lowest bits are whole numbers.
    pub const WHOLE: f64 = (1_u64 << EXPONENT) as f64;
    /// That number with the bias of exponents.
    pub const BIAS: f64 = WHOLE + 1023.0;
}

/// A row in registers: four numbers of one grain or pair, whatever the number of lanes.
pub trait Quad: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Proof that the processor can.
    type Processor: Copy;

    /// From memory.
    fn load(processor: Self::Processor, row: &Row) -> Self;
    /// `x` four times.
    fn repeat(processor: Self::Processor, x: f64) -> Self;
    /// To memory.
    fn row(self) -> Row;

    /// Square of the length of the vector part.
    #[inline(always)]
    fn length_squared(self) -> f64 {
        let squares = (self * self).row();
        squares[0] + squares[1] + squares[2]
    }
}

/// The vector `v` in every lane.
#[inline(always)]
pub fn splat_vector<N: Lanes>(processor: N::Processor, [x, y, z]: [f64; 3]) -> [N; 3] {
    [
        N::splat(processor, x),
        N::splat(processor, y),
        N::splat(processor, z),
    ]
}

/// `a · b`.
#[inline(always)]
pub fn dot<N: Lanes>(a: [N; 3], b: [N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`.
#[inline(always)]
pub fn cross<N: Lanes>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a s`.
#[inline(always)]
pub fn times<N: Lanes>(a: [N; 3], s: N) -> [N; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// `a + b`.
#[inline(always)]
pub fn plus<N: Lanes>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
#[inline(always)]
pub fn minus<N: Lanes>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// What `of` makes of the numbers of the lanes; where there are fewer than [`WIDEST`], the last one
/// fills up.
#[inline(always)]
pub fn side_by_side<N: Lanes, T>(of: impl Fn(usize) -> T) -> [T; WIDEST] {
    std::array::from_fn(|k| of(k.min(N::COUNT - 1)))
}

/// Something to compute in lanes.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Does it with the lanes `N`.
    fn run<N: Lanes>(self, processor: N::Processor) -> Self::Output;
}
