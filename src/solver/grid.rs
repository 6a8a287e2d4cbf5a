//! Cells to find near grains in.

use super::row::Row;

/// Grains sorted into cubic cells at least one interaction length wide.
pub struct CellGrid {
    origin: [f64; 3],
    inverse_size: f64,
    cells: [usize; 3],
    first: Vec<u32>,
    members: Vec<u32>,
}

impl CellGrid {
    /// A grid of grains given by their centres and radii [m], for pairs whose surfaces are `skin` apart at most [m].
    pub fn new(grains: impl ExactSizeIterator<Item = (Row, f64)> + Clone, skin: f64) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut radius: f64 = 0.0;
        for (centre, own) in grains.clone() {
            for axis in 0..3 {
                low[axis] = low[axis].min(centre[axis]);
                high[axis] = high[axis].max(centre[axis]);
            }
            radius = radius.max(own);
        }
        let mut size = 2.0 * radius + skin;
        let limit = 8 * grains.len() + 64;
        let count = |size: f64| [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / size).max(0.0));
        // Grains scattered far apart would need a grid larger than memory: wider cells are still right.
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
        grid.fill(grains);
        grid
    }

    fn fill(&mut self, grains: impl ExactSizeIterator<Item = (Row, f64)>) {
        let cells: Vec<usize> = grains
            .map(|(centre, _)| self.index(self.cell(centre)))
            .collect();
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

    fn cell(&self, position: Row) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let place = (position[axis] - self.origin[axis]) * self.inverse_size;
            (place.max(0.0) as usize).min(self.cells[axis] - 1)
        })
    }

    fn index(&self, cell: [usize; 3]) -> usize {
        (cell[2] * self.cells[1] + cell[1]) * self.cells[0] + cell[0]
    }

    /// Visits the grains in the cells round `position`: all that may be near, and others.
    pub fn for_near(&self, position: Row, mut visit: impl FnMut(u32)) {
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
