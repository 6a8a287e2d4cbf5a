//! Pairs of grains that are near each other, found with a cell grid.
//!
//! In: centres and a reach. Out: a visit to each pair closer than the reach, once, in an order that
//! depends on nothing but the centres.

use glam::{DVec3, UVec3};
use std::ops::Range;

/// Calls `visit(i, j, x_j − x_i)` once for each pair of points that are closer than `reach` [m].
pub(super) fn for_each_near_pair(
    points: &[DVec3],
    reach: f64,
    mut visit: impl FnMut(usize, usize, DVec3),
) {
    if points.is_empty() || reach <= 0.0 {
        return;
    }
    let grid = Grid::over(points, reach);
    let (order, starts) = grid.sort(points);
    let sorted: Vec<DVec3> = order.iter().map(|&i| points[i as usize]).collect();
    let reach_squared = reach * reach;
    for cell in 0..grid.cells() {
        let own = starts[cell] as usize..starts[cell + 1] as usize;
        if own.is_empty() {
            continue;
        }
        let runs = grid.forward_runs(cell, &starts);
        for a in own.clone() {
            let x = sorted[a];
            let rest_of_row = a + 1..grid.end_of_next(cell, &starts);
            for b in std::iter::once(rest_of_row).chain(runs.clone()).flatten() {
                let separation = sorted[b] - x;
                if separation.length_squared() < reach_squared {
                    visit(order[a] as usize, order[b] as usize, separation);
                }
            }
        }
    }
}

/// Cubic cells over a cloud of points; x runs fastest.
struct Grid {
    origin: DVec3,
    cell_size: f64,
    counts: UVec3,
}

impl Grid {
    /// Cells at least `reach` wide, and wider where the cloud is so thin that most would be empty.
    fn over(points: &[DVec3], reach: f64) -> Self {
        let (low, high) = points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), x| {
                (low.min(*x), high.max(*x))
            });
        let extent = (high - low).max(DVec3::ZERO);
        let most_cells = 8.0 * points.len() as f64 + 64.0;
        let mut cell_size = reach;
        while (extent / cell_size + 1.0).element_product() > most_cells {
            cell_size *= 2.0;
        }
        Self {
            origin: low,
            cell_size,
            counts: (extent / cell_size).as_uvec3() + UVec3::ONE,
        }
    }

    fn cells(&self) -> usize {
        self.counts.as_usizevec3().element_product()
    }

    fn cell(&self, point: DVec3) -> usize {
        let at = ((point - self.origin) / self.cell_size)
            .as_uvec3()
            .min(self.counts - UVec3::ONE);
        self.index(at.x, at.y, at.z)
    }

    fn index(&self, x: u32, y: u32, z: u32) -> usize {
        ((z * self.counts.y + y) * self.counts.x + x) as usize
    }

    /// The points in order of their cells, and where in that order each cell starts.
    fn sort(&self, points: &[DVec3]) -> (Vec<u32>, Vec<u32>) {
        let cells: Vec<usize> = points.iter().map(|x| self.cell(*x)).collect();
        let mut starts = vec![0_u32; self.cells() + 1];
        for &cell in &cells {
            starts[cell + 1] += 1;
        }
        for cell in 0..self.cells() {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.clone();
        let mut order = vec![0_u32; points.len()];
        for (i, &cell) in cells.iter().enumerate() {
            order[next[cell] as usize] = i as u32;
            next[cell] += 1;
        }
        (order, starts)
    }

    /// Where the cell after `cell` in its row ends, or `cell` itself if it is the last.
    fn end_of_next(&self, cell: usize, starts: &[u32]) -> usize {
        let last_in_row = (cell as u32 + 1).is_multiple_of(self.counts.x);
        starts[if last_in_row { cell + 1 } else { cell + 2 }] as usize
    }

    /// The points in those neighbours of `cell` that come in later rows: one run for each row.
    fn forward_runs(&self, cell: usize, starts: &[u32]) -> [Range<usize>; 4] {
        let cell = cell as u32;
        let x = cell % self.counts.x;
        let y = cell / self.counts.x % self.counts.y;
        let z = cell / (self.counts.x * self.counts.y);
        let (left, right) = (x.saturating_sub(1), (x + 1).min(self.counts.x - 1));
        let run = |(dy, dz)| {
            let y = y.checked_add_signed(dy).filter(|y| *y < self.counts.y)?;
            let z = (z + dz < self.counts.z).then_some(z + dz)?;
            let start = starts[self.index(left, y, z)] as usize;
            let end = starts[self.index(right, y, z) + 1] as usize;
            Some(start..end)
        };
        // Beyond the grid there are none.
        [(1, 0), (-1, 1), (0, 1), (1, 1)].map(|row| run(row).unwrap_or_default())
    }
}
