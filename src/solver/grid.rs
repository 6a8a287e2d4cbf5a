//! Which spheres are near each other: a search by cells.
//!
//! In: centres and radii. Out: for each sphere those of higher number that are near it, in order.
//! Spheres are sorted into cubic cells at least one interaction length wide, so that only 27 cells
//! have to be looked at for each. Used for grains and for the spheres round polyhedra.

use super::row::{Row, length_squared, sub};

/// Calls `visit` with the number of every sphere (centre and radius [m]) and those of higher number
/// whose surfaces are nearer to its own than `skin` [m], in order.
pub fn for_each_near(
    spheres: impl Iterator<Item = Row>,
    skin: f64,
    mut visit: impl FnMut(u32, &[u32]),
) {
    let spheres: Vec<Row> = spheres.collect();
    let grid = CellGrid::new(&spheres, skin);
    let mut near = Vec::new();
    for (i, sphere) in (0..).zip(&spheres) {
        near.clear();
        grid.for_near(sphere, |j| {
            let other = &spheres[j as usize];
            let reach = sphere[3] + other[3] + skin;
            if j > i && length_squared(sub(*other, *sphere)) < reach * reach {
                near.push(j);
            }
        });
        near.sort_unstable();
        visit(i, &near);
    }
}

/// Spheres sorted into cubic cells at least one interaction length wide.
struct CellGrid {
    /// Lower corner [m].
    origin: [f64; 3],
    /// One over the edge of a cell [1/m].
    inverse_size: f64,
    /// Number of cells along each axis.
    cells: [usize; 3],
    /// Where in `members` those of each cell begin; the end behind the last one.
    first: Vec<u32>,
    /// Numbers of the spheres, cell by cell.
    members: Vec<u32>,
}

impl CellGrid {
    /// A grid of `spheres`, for pairs whose surfaces are `skin` apart at most [m].
    fn new(spheres: &[Row], skin: f64) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut radius: f64 = 0.0;
        for sphere in spheres {
            for axis in 0..3 {
                low[axis] = low[axis].min(sphere[axis]);
                high[axis] = high[axis].max(sphere[axis]);
            }
            radius = radius.max(sphere[3]);
        }
        let mut size = 2.0 * radius + skin;
        let limit = 8 * spheres.len() + 64;
        let count = |size: f64| [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / size).max(0.0));
        // Spheres scattered far apart would need a grid larger than memory: wider cells are still
        // right.
        while count(size).iter().map(|n| n + 1.0).product::<f64>() > limit as f64 {
            size *= 1.5;
        }
        let cells = count(size).map(|n| n as usize + 1);
        let mut grid = Self {
            origin: low,
            inverse_size: 1.0 / size,
            cells,
            first: Vec::new(),
            members: Vec::new(),
        };
        grid.fill(spheres);
        grid
    }

    /// Sorts the spheres by their cells.
    fn fill(&mut self, spheres: &[Row]) {
        let cell_of = |sphere: &Row| self.index(self.cell(sphere));
        let cells: Vec<usize> = spheres.iter().map(cell_of).collect();
        self.first = vec![0; self.cells.iter().product::<usize>() + 1];
        for &cell in &cells {
            self.first[cell + 1] += 1;
        }
        for cell in 1..self.first.len() {
            self.first[cell] += self.first[cell - 1];
        }
        let mut next = self.first.clone();
        self.members = vec![0; cells.len()];
        for (i, &cell) in cells.iter().enumerate() {
            self.members[next[cell] as usize] = i as u32;
            next[cell] += 1;
        }
    }

    /// The cell of a point: of one outside of the grid the nearest cell.
    fn cell(&self, position: &Row) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let place = (position[axis] - self.origin[axis]) * self.inverse_size;
            (place.max(0.0) as usize).min(self.cells[axis] - 1)
        })
    }

    /// Number of a cell.
    fn index(&self, cell: [usize; 3]) -> usize {
        (cell[2] * self.cells[1] + cell[1]) * self.cells[0] + cell[0]
    }

    /// Visits the spheres in the cells round `position`: all that may be near, and others.
    fn for_near(&self, position: &Row, mut visit: impl FnMut(u32)) {
        let [cx, cy, cz] = self.cell(position);
        let span = |c: usize, axis: usize| c.saturating_sub(1)..=(c + 1).min(self.cells[axis] - 1);
        for z in span(cz, 2) {
            for y in span(cy, 1) {
                let xs = span(cx, 0);
                let from = self.first[self.index([*xs.start(), y, z])] as usize;
                let to = self.first[self.index([*xs.end(), y, z]) + 1] as usize;
                self.members[from..to].iter().for_each(|&j| visit(j));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that look random, between 0 and 1.
    fn scattered(count: u32) -> Vec<f64> {
        let step = |x: &mut u32| {
            *x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            Some(f64::from(*x >> 8) / f64::from(1 << 24))
        };
        std::iter::repeat_n((), count as usize)
            .scan(1, |x, ()| step(x))
            .collect()
    }

    #[test]
    fn search_finds_the_pairs_that_a_look_at_all_of_them_finds() {
        let numbers = scattered(400 * 4);
        let spheres: Vec<Row> = numbers
            .chunks(4)
            .map(|x| [x[0], 3.0 * x[1], 0.2 * x[2], 0.02 + 0.03 * x[3]])
            .collect();
        let skin = 0.01;
        let mut found = Vec::new();
        for_each_near(spheres.iter().copied(), skin, |i, near| {
            found.extend(near.iter().map(|j| (i, *j)));
        });
        let near = |i: u32, j: u32| {
            let (a, b) = (spheres[i as usize], spheres[j as usize]);
            length_squared(sub(a, b)).sqrt() < a[3] + b[3] + skin
        };
        let all = (0..400).flat_map(|i| (i + 1..400).map(move |j| (i, j)));
        let expected: Vec<(u32, u32)> = all.filter(|(i, j)| near(*i, *j)).collect();
        assert!(expected.len() > 200, "{}", expected.len());
        assert_eq!(found, expected);
    }
}
