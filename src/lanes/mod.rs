//! The solver's small vector vocabulary: numbers that stand side by side.
//!
//! [`Lanes`] is what the pair loop computes with: one number (the scalar twin, for any processor),
//! four (AVX2, NEON) or eight (AVX-512). Every operation is an exact IEEE one, taken element by
//! element and never fused, so that a result has the same bits in any width. [`Processor::detect`]
//! chooses at run time.
//!
//! | file | holds |
//! |---|---|
//! | `processor` | which of them the processor at hand has |
//! | `avx512` | eight numbers at a time |
//! | `avx2` | four numbers at a time |
//! | `neon` | four numbers at a time, on ARM |
//! | `scalar` | one number at a time |
//! | `vocabulary` | what can be computed with lanes, whatever their number |

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
mod processor;
mod scalar;
#[cfg(test)]
mod tests;
mod vocabulary;

pub use processor::{Processor, prefetch};
pub use scalar::{Elementwise, One};
pub use vocabulary::{
    Lanes, Quad, Row, Rows, WIDEST, Work, cross, dot, minus, plus, side_by_side, splat_vector,
    times,
};
