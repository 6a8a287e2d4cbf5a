//! Which lanes the processor at hand has.
//!
//! In: the processor, asked at run time. Out: work done with the widest lanes it has, or with any
//! of those it has.

#[cfg(target_arch = "aarch64")]
use super::neon;
use super::scalar::One;
use super::vocabulary::Work;
#[cfg(target_arch = "x86_64")]
use super::{avx2, avx512};
use std::fmt;

/// Asks for the memory at the beginning of `items`, up to `LINES` cache lines of it, before it is
/// needed.
#[inline(always)]
pub fn prefetch<T, const LINES: usize>(items: &[T]) {
    #[cfg(target_arch = "x86_64")]
    avx2::prefetch::<T, LINES>(items);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = items;
}

/// What the processor at hand can do.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Processor {
    /// One number at a time.
    Scalar,
    /// Four at a time.
    #[cfg(target_arch = "aarch64")]
    Neon,
    /// Four at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::Avx2),
    /// Eight at a time.
    #[cfg(target_arch = "x86_64")]
    Avx512(avx512::Avx512),
}

impl Processor {
    /// The widest that this processor has.
    pub fn detect() -> Self {
        Self::all().pop().unwrap_or(Self::Scalar)
    }

    /// All that this processor can do, narrowest first.
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::Scalar];
        #[cfg(target_arch = "aarch64")]
        all.push(Self::Neon);
        #[cfg(target_arch = "x86_64")]
        {
            all.extend(avx2::Avx2::detect().map(Self::Avx2));
            all.extend(avx512::Avx512::detect().map(Self::Avx512));
        }
        all
    }

    /// Does `work` with these lanes.
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Scalar => work.run::<One>(()),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => work.run::<neon::Four>(()),
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
            #[cfg(target_arch = "aarch64")]
            Self::Neon => "four at a time (NEON)",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "four at a time (AVX2)",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "eight at a time (AVX-512)",
        })
    }
}
