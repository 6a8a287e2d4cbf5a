//! Eight numbers side by side in a register of AVX-512.
//!
//! In: the proof that the processor has AVX-512, numbers and rows. Out: the operations of
//! [`Lanes`], element by element. Rows, which are four numbers, stay in the registers of `avx2`.
//! Every `unsafe` here calls an intrinsic; what makes it sound is the proof that each value
//! carries.

#![expect(
    unsafe_code,
    reason = "the pair loop is three times faster in lanes than one number at a time"
)]

use super::avx2::{Four, Proof};
use super::vocabulary::{Lanes, Quad, Row, Rows, WIDEST, Work, split_bits};
use std::arch::x86_64::{
    __m512d, __mmask8, _CMP_GT_OQ, _mm512_add_epi64, _mm512_add_pd, _mm512_and_si512,
    _mm512_castpd_si512, _mm512_castpd256_pd512, _mm512_castpd512_pd256, _mm512_castsi512_pd,
    _mm512_cmp_pd_mask, _mm512_div_pd, _mm512_extractf64x4_pd, _mm512_insertf64x4, _mm512_loadu_pd,
    _mm512_mask_blend_pd, _mm512_mul_pd, _mm512_or_si512, _mm512_permutex2var_pd, _mm512_set_epi64,
    _mm512_set1_epi64, _mm512_set1_pd, _mm512_shuffle_f64x2, _mm512_sqrt_pd, _mm512_srli_epi64,
    _mm512_storeu_pd, _mm512_sub_pd, _mm512_unpackhi_pd, _mm512_unpacklo_pd, _mm512_xor_pd,
};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Proof that the processor has AVX-512 (F, DQ, VL) as well: only [`Avx512::detect`] makes one.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(());

impl Proof for Avx512 {}

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

/// Eight numbers in a register, with the proof that there is one.
#[derive(Clone, Copy, Debug)]
pub struct Eight(Avx512, __m512d);

macro_rules! vector {
    ($($operator:ident $function:ident $intrinsic:ident),*) => {$(
        impl $operator for Eight {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                // SAFETY: AVX-512 is there, as `self.0` proves.
                Self(self.0, unsafe { $intrinsic(self.1, other.1) })
            }
        }
    )*};
}
vector!(
    Add add _mm512_add_pd,
    Sub sub _mm512_sub_pd,
    Mul mul _mm512_mul_pd,
    Div div _mm512_div_pd
);

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

/// A row, in a register of AVX2.
type FourNumbers = Four<Avx512>;

impl Eight {
    /// Two rows in one register.
    #[inline(always)]
    fn two_rows(first: FourNumbers, second: FourNumbers) -> Self {
        // SAFETY: AVX-512 is there, as `first.0` proves.
        Self(first.0, unsafe {
            _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(first.1), second.1)
        })
    }

    /// Eight rows as columns: registers that hold rows 0 and 2, 1 and 3, 4 and 6, 5 and 7 need no
    /// permutation.
    #[inline(always)]
    fn columns(rows: [FourNumbers; WIDEST]) -> [Self; 4] {
        let proof = rows[0].0;
        let [a, b, c, d] = [
            Self::two_rows(rows[0], rows[2]),
            Self::two_rows(rows[1], rows[3]),
            Self::two_rows(rows[4], rows[6]),
            Self::two_rows(rows[5], rows[7]),
        ];
        // SAFETY: AVX-512 is there, as `proof` is.
        unsafe {
            let low = [_mm512_unpacklo_pd(a.1, b.1), _mm512_unpacklo_pd(c.1, d.1)];
            let high = [_mm512_unpackhi_pd(a.1, b.1), _mm512_unpackhi_pd(c.1, d.1)];
            [
                Self(proof, _mm512_shuffle_f64x2::<0x88>(low[0], low[1])),
                Self(proof, _mm512_shuffle_f64x2::<0x88>(high[0], high[1])),
                Self(proof, _mm512_shuffle_f64x2::<0xDD>(low[0], low[1])),
                Self(proof, _mm512_shuffle_f64x2::<0xDD>(high[0], high[1])),
            ]
        }
    }

    #[inline(always)]
    fn halves(self) -> [FourNumbers; 2] {
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
    type Quad = FourNumbers;

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
        // SAFETY: AVX-512 is there, as `self.0` proves; the slice holds eight numbers, of any
        // alignment.
        unsafe { _mm512_storeu_pd(column[..Self::COUNT].as_mut_ptr(), self.1) };
    }

    #[inline(always)]
    fn gather(proof: Avx512, rows: Rows) -> [Self; 4] {
        Self::columns([
            FourNumbers::load(proof, rows[0]),
            FourNumbers::load(proof, rows[1]),
            FourNumbers::load(proof, rows[2]),
            FourNumbers::load(proof, rows[3]),
            FourNumbers::load(proof, rows[4]),
            FourNumbers::load(proof, rows[5]),
            FourNumbers::load(proof, rows[6]),
            FourNumbers::load(proof, rows[7]),
        ])
    }

    #[inline(always)]
    fn gather_difference(proof: Avx512, a: Rows, b: Rows) -> [Self; 4] {
        Self::columns([
            FourNumbers::difference(proof, a[0], b[0]),
            FourNumbers::difference(proof, a[1], b[1]),
            FourNumbers::difference(proof, a[2], b[2]),
            FourNumbers::difference(proof, a[3], b[3]),
            FourNumbers::difference(proof, a[4], b[4]),
            FourNumbers::difference(proof, a[5], b[5]),
            FourNumbers::difference(proof, a[6], b[6]),
            FourNumbers::difference(proof, a[7], b[7]),
        ])
    }

    #[inline(always)]
    fn gather_difference_and_sum(proof: Avx512, a: Rows, b: Rows) -> [Self; 4] {
        Self::columns([
            FourNumbers::difference_and_sum(proof, a[0], b[0]),
            FourNumbers::difference_and_sum(proof, a[1], b[1]),
            FourNumbers::difference_and_sum(proof, a[2], b[2]),
            FourNumbers::difference_and_sum(proof, a[3], b[3]),
            FourNumbers::difference_and_sum(proof, a[4], b[4]),
            FourNumbers::difference_and_sum(proof, a[5], b[5]),
            FourNumbers::difference_and_sum(proof, a[6], b[6]),
            FourNumbers::difference_and_sum(proof, a[7], b[7]),
        ])
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
    fn rows([a, b, c, d]: [Self; 4]) -> [FourNumbers; WIDEST] {
        // SAFETY: AVX-512 is there, as `a.0` proves.
        let pairs = unsafe {
            let first = _mm512_set_epi64(11, 10, 3, 2, 9, 8, 1, 0);
            let second = _mm512_set_epi64(15, 14, 7, 6, 13, 12, 5, 4);
            let low = [_mm512_unpacklo_pd(a.1, b.1), _mm512_unpacklo_pd(c.1, d.1)];
            let high = [_mm512_unpackhi_pd(a.1, b.1), _mm512_unpackhi_pd(c.1, d.1)];
            [
                _mm512_permutex2var_pd(low[0], first, low[1]),
                _mm512_permutex2var_pd(high[0], first, high[1]),
                _mm512_permutex2var_pd(low[0], second, low[1]),
                _mm512_permutex2var_pd(high[0], second, high[1]),
            ]
        };
        let [r0, r2] = Self(a.0, pairs[0]).halves();
        let [r1, r3] = Self(a.0, pairs[1]).halves();
        let [r4, r6] = Self(a.0, pairs[2]).halves();
        let [r5, r7] = Self(a.0, pairs[3]).halves();
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
