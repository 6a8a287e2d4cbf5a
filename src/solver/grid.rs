//! Which spheres are near each other: a search by cells.
//!
//! In: centres and radii. Out: for each sphere those of higher number that are near it, in order.
//! Spheres are sorted into cubic cells at least one interaction length wide, so that only 27 cells
//! have to be looked at for each. Where sizes differ much there is a grid for each level of size,
//! and a sphere looks for its like and for larger ones alone: a cell of the largest would hold all
//! the small ones there are. Used for grains and for the spheres round polyhedra.
//!
//! Cells are numbered with x fastest, so that the three cells beside each other along x are one
//! range of members: 9 ranges are looked at instead of 27 cells. Each pair is told once, by its
//! lower number, and partners come in rising order: the lists that are made from them need no
//! sorting of their own. Boxes much larger than what they hold get wider cells, up to eight for
//! each sphere: the grid takes memory by spheres, not by space.
//!
//! Not here: walls, which each list asks for their distance, and how long a list lasts.

use super::row::{Row, length_squared, sub};
use std::ops::Range;

/// How many times smaller than the largest spheres of its level the smallest are, at most.
const LEVEL: f64 = 4.0;
/// Levels of size at most; the last one holds all that are smaller.
const MOST_LEVELS: usize = 16;

/// Spheres and what finds those near each of them: workers may look for a range each.
pub struct NearSearch {
    /// Centres and radii [m].
    spheres: Vec<Row>,
    /// Surfaces nearer than this are near [m].
    skin: f64,
    levels: Levels,
    grids: Vec<CellGrid>,
    /// The pairs of spheres of different levels.
    unequal: Vec<(u32, u32)>,
}

impl NearSearch {
    /// A search among `spheres` (centre and radius [m]) whose surfaces are nearer than `skin` [m].
    pub fn new(spheres: Vec<Row>, skin: f64) -> Self {
        let levels = Levels::of(&spheres);
        let grids = levels.grids(&spheres, skin);
        let unequal = levels.unequal_pairs(&spheres, &grids, skin);
        Self {
            spheres,
            skin,
            levels,
            grids,
            unequal,
        }
    }

    /// Calls `visit` with each of these numbers and those of higher number that are near it, in order.
    pub fn visit(&self, numbers: Range<usize>, mut visit: impl FnMut(u32, &[u32])) {
        let first = numbers.start as u32;
        let begin = self.unequal.partition_point(|(low, _)| *low < first);
        let mut unequal = self.unequal[begin..].iter().peekable();
        let mut near = Vec::new();
        for (i, sphere) in (first..).zip(&self.spheres[numbers]) {
            near.clear();
            self.grids[self.levels.level(i)].for_near(sphere, |j| {
                if j > i && are_near(sphere, &self.spheres[j as usize], self.skin) {
                    near.push(j);
                }
            });
            while let Some((_, j)) = unequal.next_if(|(low, _)| *low == i) {
                near.push(*j);
            }
            near.sort_unstable();
            visit(i, &near);
        }
    }
}

/// Calls `visit` with the number of every sphere (centre and radius [m]) and those of higher number
/// whose surfaces are nearer to its own than `skin` [m], in order.
pub fn for_each_near(
    spheres: impl Iterator<Item = Row>,
    skin: f64,
    visit: impl FnMut(u32, &[u32]),
) {
    let spheres: Vec<Row> = spheres.collect();
    let all = 0..spheres.len();
    NearSearch::new(spheres, skin).visit(all, visit);
}

/// The radius of a sphere, the companion of its centre [m].
fn radius(sphere: &Row) -> f64 {
    sphere[3]
}

/// Whether the surfaces of two spheres are nearer to each other than `skin` [m].
fn are_near(sphere: &Row, other: &Row, skin: f64) -> bool {
    let reach = radius(sphere) + radius(other) + skin;
    length_squared(sub(*other, *sphere)) < reach * reach
}

/// Which level of size each sphere is of, the largest first.
struct Levels {
    /// The level of each; empty where all are of one.
    level: Vec<u8>,
    /// How many there are.
    number: usize,
}

impl Levels {
    fn of(spheres: &[Row]) -> Self {
        let radii = || spheres.iter().map(radius);
        let largest = radii().fold(0.0, f64::max);
        if radii().all(|radius| LEVEL * radius >= largest) {
            return Self {
                level: Vec::new(),
                number: 1,
            };
        }
        let level = |radius: f64| {
            let (mut level, mut least) = (0, largest / LEVEL);
            while radius < least && level + 1 < MOST_LEVELS {
                level += 1;
                least /= LEVEL;
            }
            level as u8
        };
        let level: Vec<u8> = radii().map(level).collect();
        Self {
            number: 1 + usize::from(level.iter().copied().max().unwrap_or(0)),
            level,
        }
    }

    /// The level of the sphere of number `i`.
    fn level(&self, i: u32) -> usize {
        self.level
            .get(i as usize)
            .map_or(0, |level| usize::from(*level))
    }

    /// A grid for each level.
    fn grids(&self, spheres: &[Row], skin: f64) -> Vec<CellGrid> {
        let numbers = 0..spheres.len() as u32;
        let of_level = |level| numbers.clone().filter(move |i| self.level(*i) == level);
        (0..self.number)
            .map(|level| CellGrid::new(spheres, of_level(level).collect(), skin))
            .collect()
    }

    /// The pairs of spheres of different levels that are nearer to each other than `skin` [m], the
    /// lower number first, in order.
    fn unequal_pairs(&self, spheres: &[Row], grids: &[CellGrid], skin: f64) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        if self.number == 1 {
            return pairs;
        }
        for (i, sphere) in (0..).zip(spheres) {
            for larger in &grids[..self.level(i)] {
                larger.for_near(sphere, |j| {
                    if are_near(sphere, &spheres[j as usize], skin) {
                        pairs.push((i.min(j), i.max(j)));
                    }
                });
            }
        }
        pairs.sort_unstable();
        pairs
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
    /// A grid of those of the `spheres` that have these `numbers`, for pairs of them, or of one of
    /// them and a smaller sphere, whose surfaces are `skin` apart at most [m].
    fn new(spheres: &[Row], numbers: Vec<u32>, skin: f64) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut largest: f64 = 0.0;
        for sphere in numbers.iter().map(|i| &spheres[*i as usize]) {
            for axis in 0..3 {
                low[axis] = low[axis].min(sphere[axis]);
                high[axis] = high[axis].max(sphere[axis]);
            }
            largest = largest.max(radius(sphere));
        }
        let mut size = 2.0 * largest + skin;
        let limit = 8 * numbers.len() + 64;
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
        grid.fill(spheres, &numbers);
        grid
    }

    /// Sorts the spheres of these numbers by their cells.
    fn fill(&mut self, spheres: &[Row], numbers: &[u32]) {
        let cell_of = |i: &u32| self.index(self.cell(&spheres[*i as usize]));
        let cells: Vec<usize> = numbers.iter().map(cell_of).collect();
        self.first = vec![0; self.cells.iter().product::<usize>() + 1];
        for &cell in &cells {
            self.first[cell + 1] += 1;
        }
        for cell in 1..self.first.len() {
            self.first[cell] += self.first[cell - 1];
        }
        let mut next = self.first.clone();
        self.members = vec![0; cells.len()];
        for (&i, &cell) in numbers.iter().zip(&cells) {
            self.members[next[cell] as usize] = i;
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
        let sphere = |x: &[f64], radius| [x[0], 3.0 * x[1], 0.2 * x[2], radius];
        let alike = numbers.chunks(4).map(|x| sphere(x, 0.02 + 0.03 * x[3]));
        compare(&alike.collect::<Vec<Row>>(), 0.01);
        // Radii over four decades, small ones in most places.
        let size = |x: f64| 0.3 * x * x * x * x * x * x * x * x + 3e-5;
        let unlike = numbers.chunks(4).map(|x| sphere(x, size(x[3])));
        compare(&unlike.collect::<Vec<Row>>(), 0.01);
    }

    #[test]
    fn small_spheres_round_a_large_one_are_not_all_looked_at_for_each_other() {
        let numbers = scattered(20_000 * 3);
        let mut spheres: Vec<Row> = numbers
            .chunks(3)
            .map(|x| [x[0], x[1], x[2], 1e-3])
            .collect();
        spheres.push([0.5, 0.5, 0.5, 1.0]);
        let levels = Levels::of(&spheres);
        let grids = levels.grids(&spheres, 1e-3);
        let mut looks = 0;
        for (i, sphere) in (0..).zip(&spheres) {
            for grid in &grids[..=levels.level(i)] {
                grid.for_near(sphere, |_| looks += 1);
            }
        }
        // With cells for the large one there are 4e8.
        assert!(looks < 1_000_000, "{looks}");
    }

    /// Compares what the search finds with all pairs.
    fn compare(spheres: &[Row], skin: f64) {
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
        assert!(expected.len() > 100, "{}", expected.len());
        assert_eq!(found, expected);
        let search = NearSearch::new(spheres.to_vec(), skin);
        let mut in_parts = Vec::new();
        for part in [0..7, 7..7, 7..250, 250..400] {
            search.visit(part, |i, near| {
                in_parts.extend(near.iter().map(|j| (i, *j)));
            });
        }
        assert_eq!(in_parts, expected);
    }
}
