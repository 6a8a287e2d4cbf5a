//! Where the grains of a filling begin: the cells of a lattice, from below.
//!
//! In: a container and the size classes of its grains. Out: cells in rising order, in each of which
//! either one of the largest grains fits with room to spare, or a block of smaller ones. A filling
//! that fits has a lattice; one that does not has none. Nothing is random here. Of the cells in the
//! box round a mesh, or in the room that its scene states, those are taken that are clear of its
//! walls, and without a stated room inside of it: above them the mesh is met an odd number of times.

use super::SceneContainer;
use super::mesh::SceneMesh;
use super::size_classes::SizeClass;
use glam::DVec3;
use std::ops::RangeInclusive;

/// Free width between neighbours, in radii: the first that leaves room for all grains is taken. A
/// loose lattice lets grains fall in disorder; a tight one holds more.
const GAPS: [f64; 2] = [0.1, 0.02];

/// Most cells of a region that a mesh bounds: each is asked how far the mesh is.
const MOST_IN_MESH: f64 = 1e7;
/// Most pairs of an upright line of cells and a triangle that are looked at to tell inside from
/// outside.
const MOST_CROSSINGS: f64 = 3e8;
/// Where in a cell, in its edges, the upright line stands that tells inside from outside.
const OFF_MIDDLE: [f64; 2] = [0.500_137, 0.500_071];

/// The cells of a filling.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Size of a cell [m].
    pub cell: DVec3,
    /// For each size class the number of its grains along an edge of a cell.
    pub divisions: Vec<usize>,
    region: CellRegion,
    /// What of the region there is, where a mesh bounds it.
    mesh: Option<InMesh>,
}

/// What of a region lies clear of a mesh.
#[derive(Clone, Debug)]
struct InMesh {
    surface: SceneMesh,
    /// Least distance of a cell's centre from it [m].
    clear: f64,
    /// For each column of cells, along x and then z, the heights at which an upright line through it
    /// meets the mesh [m]; none where all cells count that are clear of it.
    heights: Option<Vec<Vec<f64>>>,
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
    /// How many cells there are in a box; none are counted of others.
    fn size(&self) -> f64 {
        match *self {
            Self::Drum { .. } => 0.0,
            Self::Box { counts, .. } => counts.iter().map(|&count| count as f64).product(),
        }
    }

    /// Whether there is any cell at all.
    fn has_room(&self) -> bool {
        match *self {
            Self::Drum { reach, depth, .. } => reach >= 0.0 && depth > 0,
            Self::Box { counts, .. } => counts.iter().all(|&count| count > 0),
        }
    }
}

impl InMesh {
    /// What of the cells of this size in `region` lies clear of the mesh that `container` is; none of
    /// other containers.
    fn of(
        container: &SceneContainer,
        region: &CellRegion,
        cell: DVec3,
        clear: f64,
    ) -> Option<Self> {
        let (SceneContainer::Mesh { surface, room, .. }, CellRegion::Box { min, counts }) =
            (container, region)
        else {
            return None;
        };
        let heights = room.is_none().then(|| {
            let columns = (0..counts[0]).flat_map(|x| (0..counts[2]).map(move |z| (x, z)));
            // Off the middles by a little: lines through the edges of symmetric meshes meet two
            // triangles at one place.
            let line = |(x, z)| {
                let middle = DVec3::new(x as f64 + OFF_MIDDLE[0], 0.0, z as f64 + OFF_MIDDLE[1]);
                surface.heights_at(*min + middle * cell)
            };
            columns.map(line).collect()
        });
        Some(Self {
            surface: surface.clone(),
            clear,
            heights,
        })
    }

    /// Whether a cell about `centre` in the column at `place` is clear of the mesh and, where that
    /// counts, inside of it.
    fn holds(&self, centre: DVec3, place: usize) -> bool {
        let is_inside = self.heights.as_ref().is_none_or(|heights| {
            let above = heights[place].iter().filter(|y| **y > centre.y);
            above.count() % 2 == 1
        });
        is_inside && self.surface.distance(centre) >= self.clear
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
                let reach = radius - gap * largest - block_radius(pitch, classes, &divisions, 2.0);
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
            SceneContainer::Mesh {
                ref surface, room, ..
            } => {
                let (min, max) = room.unwrap_or_else(|| surface.bounds());
                let counts = (max - min).to_array().map(|length| whole(length / pitch));
                (CellRegion::Box { min, counts }, DVec3::splat(pitch))
            }
            SceneContainer::Nothing | SceneContainer::Column { .. } | SceneContainer::Planes(_) => {
                return None;
            }
        };
        let clear = gap * largest + block_radius(pitch, classes, &divisions, 3.0);
        let is_too_fine = match (container, &region) {
            (SceneContainer::Mesh { surface, room, .. }, CellRegion::Box { counts, .. }) => {
                let lines = counts[0] as f64 * counts[2] as f64;
                let crossings = lines * surface.triangles().len() as f64;
                region.size() > MOST_IN_MESH || room.is_none() && crossings > MOST_CROSSINGS
            }
            _ => false,
        };
        (region.has_room() && !is_too_fine).then(|| Self {
            mesh: InMesh::of(container, &region, cell, clear),
            cell,
            divisions,
            region,
        })
    }

    /// Centres of the cells [m], lowest first; neighbours in a row follow each other.
    pub fn cells(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.rows().flat_map(move |row| {
            self.columns(row).flat_map(move |column| {
                (0..self.depth()).filter_map(move |slice| {
                    let centre = self.centre(column, row, slice);
                    let mesh = self.mesh.as_ref();
                    let place = (column * self.depth() + slice) as usize;
                    mesh.is_none_or(|mesh| mesh.holds(centre, place))
                        .then_some(centre)
                })
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

/// How far any grain of a cell reaches from the cell's centre [m], in all three `dimensions` or in the
/// two across a drum's axis.
fn block_radius(pitch: f64, classes: &[SizeClass], divisions: &[usize], dimensions: f64) -> f64 {
    classes
        .iter()
        .zip(divisions)
        .map(|(class, &count)| {
            let corner = 0.5 * pitch * (1.0 - 1.0 / count as f64);
            corner * dimensions.sqrt() + class.radius
        })
        .fold(0.0, f64::max)
}

/// The whole cells in `cells`. A hair is added so that a box three pitches wide has three.
fn whole(cells: f64) -> i64 {
    (cells + 1e-9).floor() as i64
}
