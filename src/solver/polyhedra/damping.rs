//! Symmetric matrices of six rows, side by side: what a pair's dashpots make of relative velocity
//! and spin.
//!
//! In: damping matrices and responses of pairs. Out: the same for forces that act on what they have
//! brought about. Rows and columns are velocity (or force) along x, y, z, then spin (or torque). A
//! damping matrix `G` has the rank of a pair's contacts, one to six, and need not have an inverse;
//! a response `A` has one, as long as one side is a body. Sums run in one order for any number of
//! lanes.
//!
//! Not here: what they mean ([`super::dashpots`]).

use crate::lanes::{Lanes, WIDEST};

/// Rows of four that the 21 entries of a matrix and a companion fill.
pub const ROWS: usize = 6;

/// Where the sum of the dashpots stands behind the entries.
pub const SUM: usize = 21;

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
    /// Row `k` of the memory that it fills.
    #[inline(always)]
    pub fn row(&self, k: usize) -> [N::Quad; WIDEST] {
        let m = &self.0;
        N::rows([m[4 * k], m[4 * k + 1], m[4 * k + 2], m[4 * k + 3]])
    }

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

/// A lower triangular matrix.
type Triangle<N> = [[N; 6]; 6];

/// The lower triangular `C` with `C Cᵀ` the positive `matrix`, and the inverses of its diagonal
/// (Cholesky's decomposition, column by column).
#[inline(always)]
#[expect(clippy::eq_op, reason = "lanes have no zero of their own")]
fn cholesky<N: Lanes>(one: N, matrix: &Matrix<N>) -> (Triangle<N>, [N; 6]) {
    let zero = one - one;
    let (mut c, mut inverse) = ([[zero; 6]; 6], [zero; 6]);
    for j in 0..6 {
        let mut pivot = matrix.at(j, j);
        for k in 0..j {
            pivot = pivot - c[j][k] * c[j][k];
        }
        c[j][j] = pivot.sqrt();
        inverse[j] = one / c[j][j];
        for i in j + 1..6 {
            let mut sum = matrix.at(i, j);
            for k in 0..j {
                sum = sum - c[i][k] * c[j][k];
            }
            c[i][j] = sum * inverse[j];
        }
    }
    (c, inverse)
}

/// `(G⁻¹ + h A)⁻¹`, of `G` that need not have an inverse: `G − h Y (1 + h Ĝ)⁻¹ Yᵀ` with `A = C Cᵀ`,
/// `Y = G C`, `Ĝ = Cᵀ G C` (the identity of Woodbury). `1 + h Ĝ` has no eigenvalue below one, so
/// that its decomposition never fails, however stiff the dashpots are.
#[inline(always)]
#[expect(clippy::eq_op, reason = "lanes have no zero of their own")]
pub fn softened<N: Lanes>(one: N, damping: &Matrix<N>, response: &Matrix<N>, h: N) -> Matrix<N> {
    let zero = one - one;
    let (c, _) = cholesky(one, response);
    let mut y = [[zero; 6]; 6];
    for i in 0..6 {
        for j in 0..6 {
            let mut sum = damping.at(i, j) * c[j][j];
            for k in j + 1..6 {
                sum = sum + damping.at(i, k) * c[k][j];
            }
            y[i][j] = sum;
        }
    }
    let mut inner = Matrix([zero; 4 * ROWS]);
    for i in 0..6 {
        for j in 0..=i {
            let mut sum = c[i][i] * y[i][j];
            for k in i + 1..6 {
                sum = sum + c[k][i] * y[k][j];
            }
            inner.0[entry(i, j)] = sum * h;
        }
        inner.0[entry(i, i)] = inner.0[entry(i, i)] + one;
    }
    let (l, inverse) = cholesky(one, &inner);
    // z = L⁻¹ Yᵀ
    let mut z = [[zero; 6]; 6];
    for column in 0..6 {
        for i in 0..6 {
            let mut sum = y[column][i];
            for k in 0..i {
                sum = sum - l[i][k] * z[k][column];
            }
            z[i][column] = sum * inverse[i];
        }
    }
    let mut found = Matrix(damping.0);
    for i in 0..6 {
        for j in 0..=i {
            let mut sum = z[0][i] * z[0][j];
            for k in 1..6 {
                sum = sum + z[k][i] * z[k][j];
            }
            found.0[entry(i, j)] = damping.at(i, j) - sum * h;
        }
    }
    found
}
