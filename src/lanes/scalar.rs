//! One number at a time, for any processor: the plain twin of the wide lanes.
//!
//! In: numbers and rows. Out: the same operations as `avx2`, `avx512` and `neon` do, with the same bits.

use super::vocabulary::{Lanes, Quad, Row, Rows, WIDEST, split_bits};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The scalar twin.
#[derive(Clone, Copy, Debug)]
pub struct One(f64);

impl One {
    /// The number.
    pub fn get(self) -> f64 {
        self.0
    }
}

macro_rules! scalar {
    ($($operator:ident $function:ident $sign:tt),*) => {$(
        impl $operator for One {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }
    )*};
}
scalar!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for One {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Lanes for One {
    const COUNT: usize = 1;
    type Processor = ();
    type Mask = bool;
    type Quad = Elementwise;

    #[inline(always)]
    fn splat((): (), x: f64) -> Self {
        Self(x)
    }

    #[inline(always)]
    fn load((): (), column: &[f64]) -> Self {
        Self(column[0])
    }

    #[inline(always)]
    fn store(self, column: &mut [f64]) {
        column[0] = self.0;
    }

    #[inline(always)]
    fn gather((): (), rows: Rows) -> [Self; 4] {
        Self::spread((), rows[0])
    }

    #[inline(always)]
    fn gather_difference((): (), a: Rows, b: Rows) -> [Self; 4] {
        let (a, b) = (a[0], b[0]);
        [
            Self(a[0] - b[0]),
            Self(a[1] - b[1]),
            Self(a[2] - b[2]),
            Self(a[3] - b[3]),
        ]
    }

    #[inline(always)]
    fn gather_difference_and_sum((): (), a: Rows, b: Rows) -> [Self; 4] {
        let (a, b) = (a[0], b[0]);
        [
            Self(a[0] - b[0]),
            Self(a[1] - b[1]),
            Self(a[2] - b[2]),
            Self(a[3] + b[3]),
        ]
    }

    #[inline(always)]
    fn spread((): (), row: &Row) -> [Self; 4] {
        [Self(row[0]), Self(row[1]), Self(row[2]), Self(row[3])]
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [Elementwise; WIDEST] {
        let [a, b, c, d] = columns;
        [Elementwise([a.0, b.0, c.0, d.0]); WIDEST]
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> bool {
        self.0 > other.0
    }

    #[inline(always)]
    fn choose(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    #[inline(always)]
    fn count(mask: bool) -> u32 {
        u32::from(mask)
    }

    #[inline(always)]
    fn numbers(self) -> [f64; WIDEST] {
        [self.0; WIDEST]
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = self.0.to_bits().wrapping_add(split_bits::OFFSET);
        let whole = bits >> split_bits::EXPONENT | split_bits::WHOLE.to_bits();
        let m = (bits & split_bits::FRACTION) + split_bits::ROOT_OF_HALF;
        (
            Self(f64::from_bits(m)),
            Self(f64::from_bits(whole) - split_bits::BIAS),
        )
    }
}

/// A row for any processor.
#[derive(Clone, Copy, Debug)]
pub struct Elementwise(Row);

macro_rules! elementwise {
    ($($operator:ident $function:ident $sign:tt),*) => {$(
        impl $operator for Elementwise {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                let (a, b) = (self.0, other.0);
                Self([a[0] $sign b[0], a[1] $sign b[1], a[2] $sign b[2], a[3] $sign b[3]])
            }
        }
    )*};
}
elementwise!(Add add +, Sub sub -, Mul mul *);

impl Quad for Elementwise {
    type Processor = ();

    #[inline(always)]
    fn load((): (), row: &Row) -> Self {
        Self(*row)
    }

    #[inline(always)]
    fn repeat((): (), x: f64) -> Self {
        Self([x; 4])
    }

    #[inline(always)]
    fn row(self) -> Row {
        self.0
    }
}
