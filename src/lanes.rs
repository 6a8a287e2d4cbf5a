//! The solver's small vector vocabulary: numbers that stand side by side.
//!
//! [`Lanes`] is what the pair loop computes with: one number (the scalar twin, for any processor),
//! four (AVX2) or eight (AVX-512). Every operation is an exact IEEE one, taken element by element
//! and never fused, so that a result has the same bits in any width. [`Processor::detect`] chooses
//! at run time.

use std::fmt;
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
/// exponent's are those of `k`, off by [`split_bits::BIAS`]; the others, put on √½'s again, are
/// those of `m`.
mod split_bits {
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

/// Four lanes of AVX2 and eight of AVX-512.
#[cfg(target_arch = "x86_64")]
mod avx {
    #![expect(
        unsafe_code,
        reason = "the pair loop is three times faster in lanes than one number at a time"
    )]

    use super::{Lanes, Quad, Row, Rows, WIDEST, Work, split_bits};
    use std::arch::x86_64::{
        __m256d, __m512d, __mmask8, _CMP_GT_OQ, _MM_HINT_T0, _mm_prefetch, _mm256_add_epi64,
        _mm256_add_pd, _mm256_and_si256, _mm256_blendv_pd, _mm256_castpd_si256,
        _mm256_castsi256_pd, _mm256_cmp_pd, _mm256_div_pd, _mm256_loadu_pd, _mm256_movemask_pd,
        _mm256_mul_pd, _mm256_or_si256, _mm256_permute2f128_pd, _mm256_set_pd, _mm256_set1_epi64x,
        _mm256_set1_pd, _mm256_sqrt_pd, _mm256_srli_epi64, _mm256_storeu_pd, _mm256_sub_pd,
        _mm256_unpackhi_pd, _mm256_unpacklo_pd, _mm256_xor_pd, _mm512_add_epi64, _mm512_add_pd,
        _mm512_and_si512, _mm512_castpd_si512, _mm512_castpd256_pd512, _mm512_castpd512_pd256,
        _mm512_castsi512_pd, _mm512_cmp_pd_mask, _mm512_div_pd, _mm512_extractf64x4_pd,
        _mm512_insertf64x4, _mm512_loadu_pd, _mm512_mask_blend_pd, _mm512_mul_pd, _mm512_or_si512,
        _mm512_set1_epi64, _mm512_set1_pd, _mm512_sqrt_pd, _mm512_srli_epi64, _mm512_storeu_pd,
        _mm512_sub_pd, _mm512_xor_pd,
    };
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// Proof that the processor has AVX2: only [`Avx2::detect`] makes one. Every intrinsic below
    /// rests on one of the two.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx2(());

    /// Proof that the processor has AVX-512 (F, DQ, VL) as well: only [`Avx512::detect`] makes one.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx512(());

    /// Asks for the first cache lines of `items`.
    #[inline(always)]
    pub fn prefetch<T, const LINES: usize>(items: &[T]) {
        const LINE: usize = 64;
        let start = items.as_ptr().cast::<i8>();
        let lines = std::mem::size_of_val(items).div_ceil(LINE);
        for line in 0..lines.min(LINES) {
            // SAFETY: a prefetch reads nothing that the program could see; the address lies within `items`.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(line * LINE)) };
        }
    }

    /// Either proof: the processor has AVX2.
    pub trait Proof: Copy {}
    impl Proof for Avx2 {}
    impl Proof for Avx512 {}

    impl Avx2 {
        /// The proof, if there is one.
        pub fn detect() -> Option<Self> {
            std::arch::is_x86_feature_detected!("avx2").then_some(Self(()))
        }

        /// Does `work` in code compiled for AVX2.
        #[inline(always)]
        pub fn run<W: Work>(self, work: W) -> W::Output {
            #[target_feature(enable = "avx2")]
            fn entered<W: Work>(proof: Avx2, work: W) -> W::Output {
                work.run::<Four<Avx2>>(proof)
            }
            // SAFETY: `self` proves that the processor has what `entered` is compiled for.
            unsafe { entered(self, work) }
        }
    }

    impl Avx512 {
        /// The proof, if there is one.
        pub fn detect() -> Option<Self> {
            let found = std::arch::is_x86_feature_detected!("avx2")
                && std::arch::is_x86_feature_detected!("avx512f")
                && std::arch::is_x86_feature_detected!("avx512dq")
                && std::arch::is_x86_feature_detected!("avx512vl");
            found.then_some(Self(()))
        }

        /// Does `work` in code compiled for AVX-512.
        #[inline(always)]
        pub fn run<W: Work>(self, work: W) -> W::Output {
            #[target_feature(enable = "avx2,avx512f,avx512dq,avx512vl")]
            fn entered<W: Work>(proof: Avx512, work: W) -> W::Output {
                work.run::<Eight>(proof)
            }
            // SAFETY: `self` proves that the processor has what `entered` is compiled for.
            unsafe { entered(self, work) }
        }
    }

    /// Four numbers in a register, with the proof that there is one.
    #[derive(Clone, Copy, Debug)]
    pub struct Four<P>(P, __m256d);

    /// Eight numbers in a register, with the proof that there is one.
    #[derive(Clone, Copy, Debug)]
    pub struct Eight(Avx512, __m512d);

    macro_rules! vector {
        ($($operator:ident $function:ident $four:ident $eight:ident),*) => {$(
            impl<P: Proof> $operator for Four<P> {
                type Output = Self;
                #[inline(always)]
                fn $function(self, other: Self) -> Self {
                    // SAFETY: AVX is there, as `self.0` proves.
                    Self(self.0, unsafe { $four(self.1, other.1) })
                }
            }

            impl $operator for Eight {
                type Output = Self;
                #[inline(always)]
                fn $function(self, other: Self) -> Self {
                    // SAFETY: AVX-512 is there, as `self.0` proves.
                    Self(self.0, unsafe { $eight(self.1, other.1) })
                }
            }
        )*};
    }
    vector!(
        Add add _mm256_add_pd _mm512_add_pd,
        Sub sub _mm256_sub_pd _mm512_sub_pd,
        Mul mul _mm256_mul_pd _mm512_mul_pd,
        Div div _mm256_div_pd _mm512_div_pd
    );

    impl<P: Proof> Neg for Four<P> {
        type Output = Self;
        #[inline(always)]
        fn neg(self) -> Self {
            // SAFETY: AVX is there, as `self.0` proves.
            Self(self.0, unsafe {
                _mm256_xor_pd(self.1, _mm256_set1_pd(-0.0))
            })
        }
    }

    impl Neg for Eight {
        type Output = Self;
        #[inline(always)]
        fn neg(self) -> Self {
            // SAFETY: AVX-512 is there, as `self.0` proves.
            Self(self.0, unsafe {
                _mm512_xor_pd(self.1, _mm512_set1_pd(-0.0))
            })
        }
    }

    impl<P: Proof> Four<P> {
        /// Turns four rows into four columns, or back.
        #[inline(always)]
        fn transpose(rows: [Self; 4]) -> [Self; 4] {
            let proof = rows[0].0;
            let [a, b, c, d] = [rows[0].1, rows[1].1, rows[2].1, rows[3].1];
            // SAFETY: AVX is there, as `proof` is.
            unsafe {
                let (low_ab, high_ab) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
                let (low_cd, high_cd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
                [
                    Self(proof, _mm256_permute2f128_pd::<0x20>(low_ab, low_cd)),
                    Self(proof, _mm256_permute2f128_pd::<0x20>(high_ab, high_cd)),
                    Self(proof, _mm256_permute2f128_pd::<0x31>(low_ab, low_cd)),
                    Self(proof, _mm256_permute2f128_pd::<0x31>(high_ab, high_cd)),
                ]
            }
        }

        /// Columns of the four rows from the `k`-th on.
        #[inline(always)]
        fn gather_four(proof: P, rows: Rows, k: usize) -> [Self; 4] {
            Self::transpose([
                Self::load(proof, rows[k]),
                Self::load(proof, rows[k + 1]),
                Self::load(proof, rows[k + 2]),
                Self::load(proof, rows[k + 3]),
            ])
        }

        #[inline(always)]
        fn gather_four_differences(proof: P, a: Rows, b: Rows, k: usize) -> [Self; 4] {
            Self::transpose([
                Self::difference(proof, a[k], b[k]),
                Self::difference(proof, a[k + 1], b[k + 1]),
                Self::difference(proof, a[k + 2], b[k + 2]),
                Self::difference(proof, a[k + 3], b[k + 3]),
            ])
        }

        #[inline(always)]
        fn gather_four_differences_and_sums(proof: P, a: Rows, b: Rows, k: usize) -> [Self; 4] {
            Self::transpose([
                Self::difference_and_sum(proof, a[k], b[k]),
                Self::difference_and_sum(proof, a[k + 1], b[k + 1]),
                Self::difference_and_sum(proof, a[k + 2], b[k + 2]),
                Self::difference_and_sum(proof, a[k + 3], b[k + 3]),
            ])
        }

        #[inline(always)]
        fn difference(proof: P, a: &Row, b: &Row) -> Self {
            Self::load(proof, a) - Self::load(proof, b)
        }

        /// The vector of `a − b`, the companion of `a + b`.
        #[inline(always)]
        fn difference_and_sum(proof: P, a: &Row, b: &Row) -> Self {
            // SAFETY: AVX is there, as `proof` is.
            let flipped = unsafe {
                _mm256_xor_pd(Self::load(proof, b).1, _mm256_set_pd(-0.0, 0.0, 0.0, 0.0))
            };
            Self::load(proof, a) - Self(proof, flipped)
        }
    }

    impl<P: Proof> Quad for Four<P> {
        type Processor = P;

        #[inline(always)]
        fn load(proof: P, row: &Row) -> Self {
            // SAFETY: AVX is there, as `proof` is; a row is four numbers, of any alignment.
            Self(proof, unsafe { _mm256_loadu_pd(row.as_ptr()) })
        }

        #[inline(always)]
        fn repeat(proof: P, x: f64) -> Self {
            // SAFETY: AVX is there, as `proof` is.
            Self(proof, unsafe { _mm256_set1_pd(x) })
        }

        #[inline(always)]
        fn row(self) -> Row {
            let mut row = [0.0; 4];
            // SAFETY: AVX is there, as `self.0` proves; a row is four numbers, of any alignment.
            unsafe { _mm256_storeu_pd(row.as_mut_ptr(), self.1) };
            row
        }
    }

    impl Lanes for Four<Avx2> {
        const COUNT: usize = 4;
        type Processor = Avx2;
        type Mask = __m256d;
        type Quad = Self;

        #[inline(always)]
        fn splat(proof: Avx2, x: f64) -> Self {
            Self::repeat(proof, x)
        }

        #[inline(always)]
        fn load(proof: Avx2, column: &[f64]) -> Self {
            // SAFETY: AVX is there, as `proof` is; the slice holds four numbers, of any alignment.
            Self(proof, unsafe {
                _mm256_loadu_pd(column[..Self::COUNT].as_ptr())
            })
        }

        #[inline(always)]
        fn store(self, column: &mut [f64]) {
            // SAFETY: AVX is there, as `self.0` proves; the slice holds four numbers, of any alignment.
            unsafe { _mm256_storeu_pd(column[..Self::COUNT].as_mut_ptr(), self.1) };
        }

        #[inline(always)]
        fn gather(proof: Avx2, rows: Rows) -> [Self; 4] {
            Self::gather_four(proof, rows, 0)
        }

        #[inline(always)]
        fn gather_difference(proof: Avx2, a: Rows, b: Rows) -> [Self; 4] {
            Self::gather_four_differences(proof, a, b, 0)
        }

        #[inline(always)]
        fn gather_difference_and_sum(proof: Avx2, a: Rows, b: Rows) -> [Self; 4] {
            Self::gather_four_differences_and_sums(proof, a, b, 0)
        }

        #[inline(always)]
        fn spread(proof: Avx2, row: &Row) -> [Self; 4] {
            [
                Self::splat(proof, row[0]),
                Self::splat(proof, row[1]),
                Self::splat(proof, row[2]),
                Self::splat(proof, row[3]),
            ]
        }

        #[inline(always)]
        fn rows(columns: [Self; 4]) -> [Self; WIDEST] {
            let [a, b, c, d] = Self::transpose(columns);
            [a, b, c, d, a, b, c, d]
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

        #[inline(always)]
        fn count(mask: __m256d) -> u32 {
            // SAFETY: masks come from comparisons, which took AVX.
            unsafe { _mm256_movemask_pd(mask) }.count_ones()
        }

        #[inline(always)]
        fn numbers(self) -> [f64; WIDEST] {
            let [a, b, c, d] = self.row();
            [a, b, c, d, a, b, c, d]
        }

        #[inline(always)]
        fn split(self) -> (Self, Self) {
            // SAFETY: AVX2 is there, as `self.0` proves.
            let (m, whole) = unsafe {
                let bits = _mm256_add_epi64(
                    _mm256_castpd_si256(self.1),
                    _mm256_set1_epi64x(split_bits::OFFSET.cast_signed()),
                );
                let exponent = _mm256_srli_epi64::<{ split_bits::EXPONENT.cast_signed() }>(bits);
                let fraction =
                    _mm256_and_si256(bits, _mm256_set1_epi64x(split_bits::FRACTION.cast_signed()));
                (
                    _mm256_add_epi64(
                        fraction,
                        _mm256_set1_epi64x(split_bits::ROOT_OF_HALF.cast_signed()),
                    ),
                    _mm256_or_si256(
                        exponent,
                        _mm256_set1_epi64x(split_bits::WHOLE.to_bits().cast_signed()),
                    ),
                )
            };
            // SAFETY: likewise.
            let (m, whole) = unsafe { (_mm256_castsi256_pd(m), _mm256_castsi256_pd(whole)) };
            (
                Self(self.0, m),
                Self(self.0, whole) - Self::repeat(self.0, split_bits::BIAS),
            )
        }
    }

    /// Rows of the first and of the last four numbers.
    type Half = Four<Avx512>;

    impl Eight {
        /// Columns of eight from columns of the first four and of the last four.
        #[inline(always)]
        fn join(first: [Half; 4], last: [Half; 4]) -> [Self; 4] {
            [
                Self::of_halves(first[0], last[0]),
                Self::of_halves(first[1], last[1]),
                Self::of_halves(first[2], last[2]),
                Self::of_halves(first[3], last[3]),
            ]
        }

        #[inline(always)]
        fn of_halves(first: Half, last: Half) -> Self {
            // SAFETY: AVX-512 is there, as `first.0` proves.
            Self(first.0, unsafe {
                _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(first.1), last.1)
            })
        }

        #[inline(always)]
        fn halves(self) -> [Half; 2] {
            // SAFETY: AVX-512 is there, as `self.0` proves.
            unsafe {
                [
                    Four(self.0, _mm512_castpd512_pd256(self.1)),
                    Four(self.0, _mm512_extractf64x4_pd::<1>(self.1)),
                ]
            }
        }
    }

    impl Lanes for Eight {
        const COUNT: usize = 8;
        type Processor = Avx512;
        type Mask = __mmask8;
        type Quad = Half;

        #[inline(always)]
        fn splat(proof: Avx512, x: f64) -> Self {
            // SAFETY: AVX-512 is there, as `proof` is.
            Self(proof, unsafe { _mm512_set1_pd(x) })
        }

        #[inline(always)]
        fn load(proof: Avx512, column: &[f64]) -> Self {
            // SAFETY: AVX-512 is there, as `proof` is; the slice holds eight numbers, of any alignment.
            Self(proof, unsafe {
                _mm512_loadu_pd(column[..Self::COUNT].as_ptr())
            })
        }

        #[inline(always)]
        fn store(self, column: &mut [f64]) {
            // SAFETY: AVX-512 is there, as `self.0` proves; the slice holds eight numbers, of any alignment.
            unsafe { _mm512_storeu_pd(column[..Self::COUNT].as_mut_ptr(), self.1) };
        }

        #[inline(always)]
        fn gather(proof: Avx512, rows: Rows) -> [Self; 4] {
            Self::join(
                Half::gather_four(proof, rows, 0),
                Half::gather_four(proof, rows, 4),
            )
        }

        #[inline(always)]
        fn gather_difference(proof: Avx512, a: Rows, b: Rows) -> [Self; 4] {
            Self::join(
                Half::gather_four_differences(proof, a, b, 0),
                Half::gather_four_differences(proof, a, b, 4),
            )
        }

        #[inline(always)]
        fn gather_difference_and_sum(proof: Avx512, a: Rows, b: Rows) -> [Self; 4] {
            Self::join(
                Half::gather_four_differences_and_sums(proof, a, b, 0),
                Half::gather_four_differences_and_sums(proof, a, b, 4),
            )
        }

        #[inline(always)]
        fn spread(proof: Avx512, row: &Row) -> [Self; 4] {
            [
                Self::splat(proof, row[0]),
                Self::splat(proof, row[1]),
                Self::splat(proof, row[2]),
                Self::splat(proof, row[3]),
            ]
        }

        #[inline(always)]
        fn rows(columns: [Self; 4]) -> [Half; WIDEST] {
            let [a, b, c, d] = [
                columns[0].halves(),
                columns[1].halves(),
                columns[2].halves(),
                columns[3].halves(),
            ];
            let [r0, r1, r2, r3] = Half::transpose([a[0], b[0], c[0], d[0]]);
            let [r4, r5, r6, r7] = Half::transpose([a[1], b[1], c[1], d[1]]);
            [r0, r1, r2, r3, r4, r5, r6, r7]
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: AVX-512 is there, as `self.0` proves.
            Self(self.0, unsafe { _mm512_sqrt_pd(self.1) })
        }

        #[inline(always)]
        fn exceeds(self, other: Self) -> __mmask8 {
            // SAFETY: AVX-512 is there, as `self.0` proves.
            unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.1, other.1) }
        }

        #[inline(always)]
        fn choose(mask: __mmask8, a: Self, b: Self) -> Self {
            // SAFETY: AVX-512 is there, as `a.0` proves.
            Self(a.0, unsafe { _mm512_mask_blend_pd(mask, b.1, a.1) })
        }

        #[inline(always)]
        fn count(mask: __mmask8) -> u32 {
            mask.count_ones()
        }

        #[inline(always)]
        fn numbers(self) -> [f64; WIDEST] {
            let mut numbers = [0.0; WIDEST];
            // SAFETY: AVX-512 is there, as `self.0` proves; the array holds eight numbers.
            unsafe { _mm512_storeu_pd(numbers.as_mut_ptr(), self.1) };
            numbers
        }

        #[inline(always)]
        fn split(self) -> (Self, Self) {
            // SAFETY: AVX-512 is there, as `self.0` proves.
            let (m, whole) = unsafe {
                let bits = _mm512_add_epi64(
                    _mm512_castpd_si512(self.1),
                    _mm512_set1_epi64(split_bits::OFFSET.cast_signed()),
                );
                let exponent = _mm512_srli_epi64::<{ split_bits::EXPONENT }>(bits);
                let fraction =
                    _mm512_and_si512(bits, _mm512_set1_epi64(split_bits::FRACTION.cast_signed()));
                (
                    _mm512_add_epi64(
                        fraction,
                        _mm512_set1_epi64(split_bits::ROOT_OF_HALF.cast_signed()),
                    ),
                    _mm512_or_si512(
                        exponent,
                        _mm512_set1_epi64(split_bits::WHOLE.to_bits().cast_signed()),
                    ),
                )
            };
            // SAFETY: likewise.
            let (m, whole) = unsafe { (_mm512_castsi512_pd(m), _mm512_castsi512_pd(whole)) };
            (
                Self(self.0, m),
                Self(self.0, whole) - Self::splat(self.0, split_bits::BIAS),
            )
        }
    }
}

/// Asks for the memory at the beginning of `items`, up to `LINES` cache lines of it, before it is
/// needed.
#[inline(always)]
pub fn prefetch<T, const LINES: usize>(items: &[T]) {
    #[cfg(target_arch = "x86_64")]
    avx::prefetch::<T, LINES>(items);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = items;
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
#[non_exhaustive]
pub enum Processor {
    /// One number at a time.
    Scalar,
    /// Four at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2(avx::Avx2),
    /// Eight at a time.
    #[cfg(target_arch = "x86_64")]
    Avx512(avx::Avx512),
}

impl Processor {
    /// The widest that this processor has.
    pub fn detect() -> Self {
        Self::all().pop().unwrap_or(Self::Scalar)
    }

    /// All that this processor can do, narrowest first.
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::Scalar];
        #[cfg(target_arch = "x86_64")]
        {
            all.extend(avx::Avx2::detect().map(Self::Avx2));
            all.extend(avx::Avx512::detect().map(Self::Avx512));
        }
        all
    }

    /// Does `work` with these lanes.
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Scalar => work.run::<One>(()),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(proof) => proof.run(work),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(proof) => proof.run(work),
        }
    }
}

impl fmt::Display for Processor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scalar => "one at a time",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "four at a time (AVX2)",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "eight at a time (AVX-512)",
        })
    }
}
