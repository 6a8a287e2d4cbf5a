//! Four numbers side by side in a register of AVX2.
//!
//! In: the proof that the processor has AVX2, numbers and rows. Out: the operations of [`Lanes`]
//! and [`Quad`], element by element. Every `unsafe` here calls an intrinsic; what makes it sound is
//! the proof that each value carries.

#![expect(
    unsafe_code,
    reason = "the pair loop is three times faster in lanes than one number at a time"
)]

use super::vocabulary::{Lanes, Quad, Row, Rows, WIDEST, Work, split_bits};
use std::arch::x86_64::{
    __m256d, _CMP_GT_OQ, _MM_HINT_T0, _mm_prefetch, _mm256_add_epi64, _mm256_add_pd,
    _mm256_and_si256, _mm256_blendv_pd, _mm256_castpd_si256, _mm256_castsi256_pd, _mm256_cmp_pd,
    _mm256_div_pd, _mm256_loadu_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_or_si256,
    _mm256_permute2f128_pd, _mm256_set_pd, _mm256_set1_epi64x, _mm256_set1_pd, _mm256_sqrt_pd,
    _mm256_srli_epi64, _mm256_storeu_pd, _mm256_sub_pd, _mm256_unpackhi_pd, _mm256_unpacklo_pd,
    _mm256_xor_pd,
};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Proof that the processor has AVX2: only [`Avx2::detect`] makes one. Every intrinsic
/// rests on this or on the proof of a wider processor.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

/// Asks for the first cache lines of `items`.
#[inline(always)]
pub fn prefetch<T, const LINES: usize>(items: &[T]) {
    const LINE: usize = 64;
    let start = items.as_ptr().cast::<i8>();
    let lines = std::mem::size_of_val(items).div_ceil(LINE);
    for line in 0..lines.min(LINES) {
        // SAFETY: a prefetch reads nothing that the program could see; the address lies within
        // `items`.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(line * LINE)) };
    }
}

/// Either proof: the processor has AVX2.
pub trait Proof: Copy {}
impl Proof for Avx2 {}

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

/// Four numbers in a register, with the proof that there is one.
#[derive(Clone, Copy, Debug)]
pub struct Four<P>(pub(super) P, pub(super) __m256d);

macro_rules! vector {
    ($($operator:ident $function:ident $intrinsic:ident),*) => {$(
        impl<P: Proof> $operator for Four<P> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                // SAFETY: AVX is there, as `self.0` proves.
                Self(self.0, unsafe { $intrinsic(self.1, other.1) })
            }
        }
    )*};
}
vector!(
    Add add _mm256_add_pd,
    Sub sub _mm256_sub_pd,
    Mul mul _mm256_mul_pd,
    Div div _mm256_div_pd
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

impl<P: Proof> Four<P> {
    /// Turns four rows into four columns, or back.
    #[inline(always)]
    pub(super) fn transpose(rows: [Self; 4]) -> [Self; 4] {
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
    pub(super) fn gather_four(proof: P, rows: Rows, k: usize) -> [Self; 4] {
        Self::transpose([
            Self::load(proof, rows[k]),
            Self::load(proof, rows[k + 1]),
            Self::load(proof, rows[k + 2]),
            Self::load(proof, rows[k + 3]),
        ])
    }

    #[inline(always)]
    pub(super) fn gather_four_differences(proof: P, a: Rows, b: Rows, k: usize) -> [Self; 4] {
        Self::transpose([
            Self::difference(proof, a[k], b[k]),
            Self::difference(proof, a[k + 1], b[k + 1]),
            Self::difference(proof, a[k + 2], b[k + 2]),
            Self::difference(proof, a[k + 3], b[k + 3]),
        ])
    }

    #[inline(always)]
    pub(super) fn gather_four_differences_and_sums(
        proof: P,
        a: Rows,
        b: Rows,
        k: usize,
    ) -> [Self; 4] {
        Self::transpose([
            Self::difference_and_sum(proof, a[k], b[k]),
            Self::difference_and_sum(proof, a[k + 1], b[k + 1]),
            Self::difference_and_sum(proof, a[k + 2], b[k + 2]),
            Self::difference_and_sum(proof, a[k + 3], b[k + 3]),
        ])
    }

    #[inline(always)]
    pub(super) fn difference(proof: P, a: &Row, b: &Row) -> Self {
        Self::load(proof, a) - Self::load(proof, b)
    }

    /// The vector of `a − b`, the companion of `a + b`.
    #[inline(always)]
    pub(super) fn difference_and_sum(proof: P, a: &Row, b: &Row) -> Self {
        // SAFETY: AVX is there, as `proof` is.
        let flipped =
            unsafe { _mm256_xor_pd(Self::load(proof, b).1, _mm256_set_pd(-0.0, 0.0, 0.0, 0.0)) };
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
