//! Where the grains of a filling begin: the cells of a lattice, from below.
//!
//! In: a container and the size classes of its grains. Out: cells in rising order, in each of which
//! either one of the largest grains fits with room to spare, or a block of smaller ones. A filling
//! that fits has a lattice; one that does not has none. Nothing is random here.

use super::SceneContainer;
use super::size_classes::SizeClass;
use glam::DVec3;
use std::ops::RangeInclusive;

/// Free width between neighbours, in radii: the first that leaves room for all grains is taken. A
/// loose lattice lets grains fall in disorder; a tight one holds more.
const GAPS: [f64; 2] = [0.1, 0.02];

/// The cells of a filling.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Size of a cell [m].
    pub cell: DVec3,
    /// For each size class the number of its grains along an edge of a cell.
    pub divisions: Vec<usize>,
    region: CellRegion,
}

/// Which cells there are.
#[derive(Clone, Debug)]
enum CellRegion {
    /// Cells whose centres are nearer than `reach` [m] to the axis.
    Drum { reach: f64, back: f64, depth: i64 },
    /// This number of cells along x, y and z from the corner `min`.
    Box { min: DVec3, counts: [i64; 3] },
}

impl CellRegion {
    /// Whether there is any cell at all.
    fn has_room(&self) -> bool {
        match *self {
            Self::Drum { reach, depth, .. } => reach >= 0.0 && depth > 0,
            Self::Box { counts, .. } => counts.iter().all(|&count| count > 0),
        }
    }
}

impl Lattice {
    /// The lattice that holds all of `classes` in `container`, if there is one.
    pub fn for_filling(container: &SceneContainer, classes: &[SizeClass]) -> Option<Self> {
        GAPS.iter()
            .filter_map(|&gap| Self::with_gap(container, classes, gap))
            .find(|lattice| lattice.holds(classes))
    }

    fn with_gap(container: &SceneContainer, classes: &[SizeClass], gap: f64) -> Option<Self> {
        let largest = classes.iter().map(|class| class.radius).fold(0.0, f64::max);
        let pitch = (2.0 + gap) * largest;
        let divisions: Vec<usize> = classes
            .iter()
            .map(|class| whole(largest / class.radius).max(1) as usize)
            .collect();
        let (region, cell) = match *container {
            SceneContainer::Drum { radius, width, .. } => {
                let reach = radius - gap * largest - block_radius(pitch, classes, &divisions);
                let depth = whole(width / pitch);
                let cell = DVec3::new(pitch, pitch, width / depth as f64);
                let back = -0.5 * width;
                (CellRegion::Drum { reach, back, depth }, cell)
            }
            SceneContainer::Box { min, max, .. } => {
                let size = max - min;
                let counts = size.to_array().map(|length| whole(length / pitch));
                // Even room along the floor; as low as can be above it.
                let cell = DVec3::new(size.x / counts[0] as f64, pitch, size.z / counts[2] as f64);
                (CellRegion::Box { min, counts }, cell)
            }
            SceneContainer::Nothing | SceneContainer::Column { .. } | SceneContainer::Planes(_) => {
                return None;
            }
        };
        region.has_room().then_some(Self {
            cell,
            divisions,
            region,
        })
    }

    /// Centres of the cells [m], lowest first; neighbours in a row follow each other.
    pub fn cells(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.rows().flat_map(move |row| {
            self.columns(row).flat_map(move |column| {
                (0..self.depth()).map(move |slice| self.centre(column, row, slice))
            })
        })
    }

    /// Cells that `class`, the one at `index`, needs.
    pub fn cells_for(&self, index: usize, class: &SizeClass) -> usize {
        class.count.div_ceil(self.block(index))
    }

    /// Grains of the class at `index` that one cell holds.
    pub fn block(&self, index: usize) -> usize {
        self.divisions[index].saturating_pow(3)
    }

    fn holds(&self, classes: &[SizeClass]) -> bool {
        let needed = classes
            .iter()
            .enumerate()
            .map(|(index, class)| self.cells_for(index, class))
            .sum();
        self.cells().take(needed).count() == needed
    }

    fn rows(&self) -> RangeInclusive<i64> {
        match self.region {
            CellRegion::Drum { reach, .. } => {
                let rows = whole(reach / self.cell.y);
                -rows..=rows
            }
            CellRegion::Box { counts, .. } => 0..=counts[1] - 1,
        }
    }

    fn columns(&self, row: i64) -> RangeInclusive<i64> {
        match self.region {
            CellRegion::Drum { reach, .. } => {
                let y = row as f64 * self.cell.y;
                let half_chord = (reach * reach - y * y).max(0.0).sqrt();
                let columns = whole(half_chord / self.cell.x);
                -columns..=columns
            }
            CellRegion::Box { counts, .. } => 0..=counts[0] - 1,
        }
    }

    fn depth(&self) -> i64 {
        match self.region {
            CellRegion::Drum { depth, .. } => depth,
            CellRegion::Box { counts, .. } => counts[2],
        }
    }

    fn centre(&self, column: i64, row: i64, slice: i64) -> DVec3 {
        let (column, row, slice) = (column as f64, row as f64, slice as f64);
        match self.region {
            CellRegion::Drum { back, .. } => DVec3::new(
                column * self.cell.x,
                row * self.cell.y,
                back + (slice + 0.5) * self.cell.z,
            ),
            CellRegion::Box { min, .. } => {
                min + (DVec3::new(column, row, slice) + DVec3::splat(0.5)) * self.cell
            }
        }
    }
}

/// How far any grain of a cell reaches from the cell's centre in the plane across the drum's axis
/// [m].
fn block_radius(pitch: f64, classes: &[SizeClass], divisions: &[usize]) -> f64 {
    classes
        .iter()
        .zip(divisions)
        .map(|(class, &count)| {
            let corner = 0.5 * pitch * (1.0 - 1.0 / count as f64);
            corner * std::f64::consts::SQRT_2 + class.radius
        })
        .fold(0.0, f64::max)
}

/// The whole cells in `cells`. A hair is added so that a box three pitches wide has three.
fn whole(cells: f64) -> i64 {
    (cells + 1e-9).floor() as i64
}
