//! The solver's small vector vocabulary: numbers that stand side by side.
//!
//! [`Lanes`] is what the pair loop computes with: one number (the scalar twin, for any processor) or four (AVX). Every
//! operation is an exact IEEE one, taken element by element and never fused, so that a result has the same bits in any
//! width. [`Processor::detect`] chooses at run time.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four numbers side by side in memory: usually a vector and a companion scalar.
pub type Row = [f64; 4];

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
    /// Column by column, from the first [`Lanes::COUNT`] of the rows.
    fn gather(processor: Self::Processor, rows: [&Row; 4]) -> [Self; 4];
    /// Column by column, from `a − b`.
    fn gather_difference(processor: Self::Processor, a: [&Row; 4], b: [&Row; 4]) -> [Self; 4];
    /// Column by column: the vectors of `a − b`, the companions of `a + b`.
    fn gather_difference_and_sum(
        processor: Self::Processor,
        a: [&Row; 4],
        b: [&Row; 4],
    ) -> [Self; 4];
    /// The four numbers of one row, each in every lane.
    fn spread(processor: Self::Processor, row: &Row) -> [Self; 4];
    /// Rows again; the first [`Lanes::COUNT`] of them count.
    fn rows(columns: [Self; 4]) -> [Self::Quad; 4];
    /// Square root.
    fn sqrt(self) -> Self;
    /// Where `self > other`.
    fn exceeds(self, other: Self) -> Self::Mask;
    /// `a` where `mask` holds, elsewhere `b`.
    fn choose(mask: Self::Mask, a: Self, b: Self) -> Self;
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
    fn gather((): (), rows: [&Row; 4]) -> [Self; 4] {
        Self::spread((), rows[0])
    }

    #[inline(always)]
    fn gather_difference((): (), a: [&Row; 4], b: [&Row; 4]) -> [Self; 4] {
        let (a, b) = (a[0], b[0]);
        [
            Self(a[0] - b[0]),
            Self(a[1] - b[1]),
            Self(a[2] - b[2]),
            Self(a[3] - b[3]),
        ]
    }

    #[inline(always)]
    fn gather_difference_and_sum((): (), a: [&Row; 4], b: [&Row; 4]) -> [Self; 4] {
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
    fn rows(columns: [Self; 4]) -> [Elementwise; 4] {
        let [a, b, c, d] = columns;
        [Elementwise([a.0, b.0, c.0, d.0]); 4]
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

/// Four lanes of AVX.
#[cfg(target_arch = "x86_64")]
mod avx {
    #![expect(
        unsafe_code,
        reason = "the pair loop is three times faster in lanes than one number at a time"
    )]

    use super::{Lanes, Quad, Row, Work};
    use std::arch::x86_64::{
        __m256d, _CMP_GT_OQ, _mm256_add_pd, _mm256_blendv_pd, _mm256_cmp_pd, _mm256_div_pd,
        _mm256_loadu_pd, _mm256_mul_pd, _mm256_permute2f128_pd, _mm256_set_pd, _mm256_set1_pd,
        _mm256_sqrt_pd, _mm256_storeu_pd, _mm256_sub_pd, _mm256_unpackhi_pd, _mm256_unpacklo_pd,
        _mm256_xor_pd,
    };
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// Proof that the processor has AVX2: only [`Avx::detect`] makes one. Every intrinsic below rests on it.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx(());

    impl Avx {
        /// The proof, if there is one.
        pub fn detect() -> Option<Self> {
            std::arch::is_x86_feature_detected!("avx2").then_some(Self(()))
        }

        /// Does `work` in code compiled for AVX2.
        #[inline(always)]
        pub fn run<W: Work>(self, work: W) -> W::Output {
            #[target_feature(enable = "avx2")]
            fn entered<W: Work>(avx: Avx, work: W) -> W::Output {
                work.run::<Four>(avx)
            }
            // SAFETY: `self` proves that the processor has what `entered` is compiled for.
            unsafe { entered(self, work) }
        }
    }

    /// Four numbers in a register, with the proof that there is one.
    #[derive(Clone, Copy, Debug)]
    pub struct Four(Avx, __m256d);

    macro_rules! vector {
        ($($operator:ident $function:ident $instruction:ident),*) => {$(
            impl $operator for Four {
                type Output = Self;
                #[inline(always)]
                fn $function(self, other: Self) -> Self {
                    // SAFETY: AVX is there, as `self.0` proves.
                    Self(self.0, unsafe { $instruction(self.1, other.1) })
                }
            }
        )*};
    }
    vector!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);

    impl Neg for Four {
        type Output = Self;
        #[inline(always)]
        fn neg(self) -> Self {
            // SAFETY: AVX is there, as `self.0` proves.
            Self(self.0, unsafe {
                _mm256_xor_pd(self.1, _mm256_set1_pd(-0.0))
            })
        }
    }

    #[inline(always)]
    fn register(_: Avx, row: &Row) -> __m256d {
        // SAFETY: AVX is there, as the argument proves; a row is four numbers, of any alignment.
        unsafe { _mm256_loadu_pd(row.as_ptr()) }
    }

    /// Turns four rows into four columns, or back.
    #[inline(always)]
    fn transpose(avx: Avx, rows: [__m256d; 4]) -> [Four; 4] {
        let [a, b, c, d] = rows;
        // SAFETY: AVX is there, as `avx` proves.
        unsafe {
            let (low_ab, high_ab) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (low_cd, high_cd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            [
                Four(avx, _mm256_permute2f128_pd::<0x20>(low_ab, low_cd)),
                Four(avx, _mm256_permute2f128_pd::<0x20>(high_ab, high_cd)),
                Four(avx, _mm256_permute2f128_pd::<0x31>(low_ab, low_cd)),
                Four(avx, _mm256_permute2f128_pd::<0x31>(high_ab, high_cd)),
            ]
        }
    }

    impl Quad for Four {
        type Processor = Avx;

        #[inline(always)]
        fn load(avx: Avx, row: &Row) -> Self {
            Self(avx, register(avx, row))
        }

        #[inline(always)]
        fn repeat(avx: Avx, x: f64) -> Self {
            // SAFETY: AVX is there, as `avx` proves.
            Self(avx, unsafe { _mm256_set1_pd(x) })
        }

        #[inline(always)]
        fn row(self) -> Row {
            let mut row = [0.0; 4];
            // SAFETY: AVX is there, as `self.0` proves; a row is four numbers, of any alignment.
            unsafe { _mm256_storeu_pd(row.as_mut_ptr(), self.1) };
            row
        }
    }

    impl Lanes for Four {
        const COUNT: usize = 4;
        type Processor = Avx;
        type Mask = __m256d;
        type Quad = Self;

        #[inline(always)]
        fn splat(avx: Avx, x: f64) -> Self {
            Self::repeat(avx, x)
        }

        #[inline(always)]
        fn gather(avx: Avx, rows: [&Row; 4]) -> [Self; 4] {
            let [a, b, c, d] = rows;
            transpose(
                avx,
                [
                    register(avx, a),
                    register(avx, b),
                    register(avx, c),
                    register(avx, d),
                ],
            )
        }

        #[inline(always)]
        fn gather_difference(avx: Avx, a: [&Row; 4], b: [&Row; 4]) -> [Self; 4] {
            let (a0, a1) = (Self::load(avx, a[0]), Self::load(avx, a[1]));
            let (a2, a3) = (Self::load(avx, a[2]), Self::load(avx, a[3]));
            let (b0, b1) = (Self::load(avx, b[0]), Self::load(avx, b[1]));
            let (b2, b3) = (Self::load(avx, b[2]), Self::load(avx, b[3]));
            transpose(avx, [(a0 - b0).1, (a1 - b1).1, (a2 - b2).1, (a3 - b3).1])
        }

        #[inline(always)]
        fn gather_difference_and_sum(avx: Avx, a: [&Row; 4], b: [&Row; 4]) -> [Self; 4] {
            // SAFETY: AVX is there, as `avx` proves.
            let flip = unsafe { _mm256_set_pd(-0.0, 0.0, 0.0, 0.0) };
            let (a0, a1) = (Self::load(avx, a[0]), Self::load(avx, a[1]));
            let (a2, a3) = (Self::load(avx, a[2]), Self::load(avx, a[3]));
            // SAFETY: likewise.
            let (b0, b1, b2, b3) = unsafe {
                (
                    Self(avx, _mm256_xor_pd(register(avx, b[0]), flip)),
                    Self(avx, _mm256_xor_pd(register(avx, b[1]), flip)),
                    Self(avx, _mm256_xor_pd(register(avx, b[2]), flip)),
                    Self(avx, _mm256_xor_pd(register(avx, b[3]), flip)),
                )
            };
            transpose(avx, [(a0 - b0).1, (a1 - b1).1, (a2 - b2).1, (a3 - b3).1])
        }

        #[inline(always)]
        fn spread(avx: Avx, row: &Row) -> [Self; 4] {
            [
                Self::splat(avx, row[0]),
                Self::splat(avx, row[1]),
                Self::splat(avx, row[2]),
                Self::splat(avx, row[3]),
            ]
        }

        #[inline(always)]
        fn rows(columns: [Self; 4]) -> [Self; 4] {
            let [a, b, c, d] = columns;
            transpose(a.0, [a.1, b.1, c.1, d.1])
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: AVX is there, as `self.0` proves.
            Self(self.0, unsafe { _mm256_sqrt_pd(self.1) })
        }

        #[inline(always)]
        fn exceeds(self, other: Self) -> __m256d {
            // SAFETY: AVX is there, as `self.0` proves.
            unsafe { _mm256_cmp_pd::<_CMP_GT_OQ>(self.1, other.1) }
        }

        #[inline(always)]
        fn choose(mask: __m256d, a: Self, b: Self) -> Self {
            // SAFETY: AVX is there, as `a.0` proves.
            Self(a.0, unsafe { _mm256_blendv_pd(b.1, a.1, mask) })
        }
    }
}

/// Something to compute in lanes.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Does it with the lanes `N`.
    fn run<N: Lanes>(self, processor: N::Processor) -> Self::Output;
}

/// What the processor at hand can do.
#[derive(Clone, Copy, Debug)]
pub enum Processor {
    /// One number at a time.
    Scalar,
    /// Four at a time.
    #[cfg(target_arch = "x86_64")]
    Avx(avx::Avx),
}

impl Processor {
    /// The widest that this processor has.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx) = avx::Avx::detect() {
            return Self::Avx(avx);
        }
        Self::Scalar
    }

    /// Does `work` with these lanes.
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Scalar => work.run::<One>(()),
            #[cfg(target_arch = "x86_64")]
            Self::Avx(avx) => avx.run(work),
        }
    }
}
