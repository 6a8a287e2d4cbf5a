//! Symmetric matrices of six rows, side by side: what springs and dashpots of a pair make of relative
//! velocity and spin.
//!
//! Rows and columns are velocity (or force) along x, y, z, then spin (or torque). Sums run in one
//! order for any number of lanes.
//!
//! Not here: what they mean ([`super::couplings`]).

use crate::lanes::Lanes;

/// Rows of four that the 21 entries of a matrix and a companion fill.
pub const ROWS: usize = 6;

/// Number of the entries: where a companion begins.
pub const ENTRIES: usize = 21;

/// A symmetric matrix of six rows, its lower triangle row by row, and a companion.
pub type Packed = [f64; 4 * ROWS];

/// Where the entry of row `i` and column `j ≤ i` is.
pub const fn entry(i: usize, j: usize) -> usize {
    if i >= j {
        i * (i + 1) / 2 + j
    } else {
        j * (j + 1) / 2 + i
    }
}

/// A symmetric matrix of each lane.
pub struct Matrix<N>(pub [N; 4 * ROWS]);

impl<N: Lanes> Matrix<N> {
    /// Entry of row `i` and column `j`.
    #[inline(always)]
    pub fn at(&self, i: usize, j: usize) -> N {
        self.0[entry(i, j)]
    }

    /// The matrix times `v`.
    #[inline(always)]
    pub fn times(&self, v: [N; 6]) -> [N; 6] {
        let mut found = v;
        for i in 0..6 {
            let mut sum = self.at(i, 0) * v[0];
            for j in 1..6 {
                sum = sum + self.at(i, j) * v[j];
            }
            found[i] = sum;
        }
        found
    }
}
