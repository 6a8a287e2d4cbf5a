//! Four numbers side by side in two registers of NEON, which every 64-bit ARM processor has.
//!
//! In: numbers and rows. Out: the operations of [`Lanes`] and [`Quad`], element by element. What the
//! target always has needs no proof at run time.

#![expect(
    unsafe_code,
    reason = "the pair loop is faster in lanes than one number at a time"
)]

use super::vocabulary::{Lanes, Quad, Row, Rows, WIDEST, split_bits};
use std::arch::aarch64::{
    float64x2_t, uint64x2_t, vaddq_f64, vaddq_u64, vaddvq_u64, vandq_u64, vbslq_f64, vcgtq_f64,
    vdivq_f64, vdupq_n_f64, vdupq_n_u64, vld1q_f64, vmulq_f64, vnegq_f64, vorrq_u64,
    vreinterpretq_f64_u64, vreinterpretq_u64_f64, vshrq_n_u64, vsqrtq_f64, vst1q_f64, vsubq_f64,
    vzip1q_f64, vzip2q_f64,
};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Carries out intrinsics that touch no memory.
macro_rules! neon {
    ($intrinsics:expr) => {
        // SAFETY: every 64-bit ARM processor has NEON, and the target is compiled for it.
        unsafe { $intrinsics }
    };
}

/// Four numbers: the first two, the last two.
#[derive(Clone, Copy, Debug)]
pub struct Four(float64x2_t, float64x2_t);

impl Four {
    /// The four numbers that `numbers` begins with.
    #[inline(always)]
    fn from_memory(numbers: &[f64]) -> Self {
        let start = numbers[..4].as_ptr();
        // SAFETY: NEON is there; four numbers begin there, of any alignment.
        unsafe { Self(vld1q_f64(start), vld1q_f64(start.add(2))) }
    }

    #[inline(always)]
    fn to_memory(self, numbers: &mut [f64]) {
        let start = numbers[..4].as_mut_ptr();
        // SAFETY: NEON is there; there is room for four numbers, of any alignment.
        unsafe {
            vst1q_f64(start, self.0);
            vst1q_f64(start.add(2), self.1);
        }
    }

    /// Turns four rows into four columns, or back.
    #[inline(always)]
    fn transpose([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        neon!([
            Self(vzip1q_f64(a.0, b.0), vzip1q_f64(c.0, d.0)),
            Self(vzip2q_f64(a.0, b.0), vzip2q_f64(c.0, d.0)),
            Self(vzip1q_f64(a.1, b.1), vzip1q_f64(c.1, d.1)),
            Self(vzip2q_f64(a.1, b.1), vzip2q_f64(c.1, d.1)),
        ])
    }

    /// The vector of `a − b`, the companion of `a + b`.
    #[inline(always)]
    fn difference_and_sum(a: &Row, b: &Row) -> Self {
        let [x, y, z, w] = *b;
        Self::from_memory(a) - Self::from_memory(&[x, y, z, -w])
    }
}

macro_rules! vector {
    ($($operator:ident $function:ident $intrinsic:ident),*) => {$(
        impl $operator for Four {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                neon!(Self(
                    $intrinsic(self.0, other.0),
                    $intrinsic(self.1, other.1)
                ))
            }
        }
    )*};
}
vector!(
    Add add vaddq_f64,
    Sub sub vsubq_f64,
    Mul mul vmulq_f64,
    Div div vdivq_f64
);

impl Neg for Four {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        neon!(Self(vnegq_f64(self.0), vnegq_f64(self.1)))
    }
}

impl Quad for Four {
    type Processor = ();

    #[inline(always)]
    fn load((): (), row: &Row) -> Self {
        Self::from_memory(row)
    }

    #[inline(always)]
    fn repeat((): (), x: f64) -> Self {
        neon!(Self(vdupq_n_f64(x), vdupq_n_f64(x)))
    }

    #[inline(always)]
    fn row(self) -> Row {
        let mut row = [0.0; 4];
        self.to_memory(&mut row);
        row
    }
}

impl Lanes for Four {
    const COUNT: usize = 4;
    type Processor = ();
    type Mask = [uint64x2_t; 2];
    type Quad = Self;

    #[inline(always)]
    fn splat((): (), x: f64) -> Self {
        Self::repeat((), x)
    }

    #[inline(always)]
    fn load((): (), column: &[f64]) -> Self {
        Self::from_memory(column)
    }

    #[inline(always)]
    fn store(self, column: &mut [f64]) {
        self.to_memory(column);
    }

    #[inline(always)]
    fn gather((): (), rows: Rows) -> [Self; 4] {
        let [a, b, c, d, ..] = rows;
        Self::transpose([
            Self::from_memory(a),
            Self::from_memory(b),
            Self::from_memory(c),
            Self::from_memory(d),
        ])
    }

    #[inline(always)]
    fn gather_difference((): (), a: Rows, b: Rows) -> [Self; 4] {
        Self::transpose([
            Self::from_memory(a[0]) - Self::from_memory(b[0]),
            Self::from_memory(a[1]) - Self::from_memory(b[1]),
            Self::from_memory(a[2]) - Self::from_memory(b[2]),
            Self::from_memory(a[3]) - Self::from_memory(b[3]),
        ])
    }

    #[inline(always)]
    fn gather_difference_and_sum((): (), a: Rows, b: Rows) -> [Self; 4] {
        Self::transpose([
            Self::difference_and_sum(a[0], b[0]),
            Self::difference_and_sum(a[1], b[1]),
            Self::difference_and_sum(a[2], b[2]),
            Self::difference_and_sum(a[3], b[3]),
        ])
    }

    #[inline(always)]
    fn spread((): (), row: &Row) -> [Self; 4] {
        [
            Self::repeat((), row[0]),
            Self::repeat((), row[1]),
            Self::repeat((), row[2]),
            Self::repeat((), row[3]),
        ]
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [Self; WIDEST] {
        let [a, b, c, d] = Self::transpose(columns);
        [a, b, c, d, a, b, c, d]
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        neon!(Self(vsqrtq_f64(self.0), vsqrtq_f64(self.1)))
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> Self::Mask {
        neon!([vcgtq_f64(self.0, other.0), vcgtq_f64(self.1, other.1)])
    }

    #[inline(always)]
    fn choose(mask: Self::Mask, a: Self, b: Self) -> Self {
        neon!(Self(
            vbslq_f64(mask[0], a.0, b.0),
            vbslq_f64(mask[1], a.1, b.1)
        ))
    }

    #[inline(always)]
    fn count(mask: Self::Mask) -> u32 {
        // Each lane that holds is −1, so their sum is minus their number.
        let sum = neon!(vaddvq_u64(vaddq_u64(mask[0], mask[1])));
        sum.wrapping_neg() as u32
    }

    #[inline(always)]
    fn numbers(self) -> [f64; WIDEST] {
        let [a, b, c, d] = self.row();
        [a, b, c, d, a, b, c, d]
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let (a, b) = (split_in_two(self.0), split_in_two(self.1));
        let (m, whole) = (Self(a.0, b.0), Self(a.1, b.1));
        (m, whole - Self::repeat((), split_bits::BIAS))
    }
}

/// The `m` of [`Lanes::split`], and [`split_bits::WHOLE`] with the exponent's bits.
#[inline(always)]
fn split_in_two(x: float64x2_t) -> (float64x2_t, float64x2_t) {
    const EXPONENT: i32 = split_bits::EXPONENT.cast_signed();
    neon!({
        let bits = vaddq_u64(vreinterpretq_u64_f64(x), vdupq_n_u64(split_bits::OFFSET));
        let fraction = vandq_u64(bits, vdupq_n_u64(split_bits::FRACTION));
        let m = vaddq_u64(fraction, vdupq_n_u64(split_bits::ROOT_OF_HALF));
        let whole = vdupq_n_u64(split_bits::WHOLE.to_bits());
        let whole = vorrq_u64(vshrq_n_u64::<EXPONENT>(bits), whole);
        (vreinterpretq_f64_u64(m), vreinterpretq_f64_u64(whole))
    })
}
