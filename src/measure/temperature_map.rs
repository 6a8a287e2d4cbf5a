//! Map of the cross-section: the granular temperature of the grains in each cell of a square grid
//! over the x–y plane, whatever their place along z.
//!
//! The temperature is that of the drum's frame, in which a bed that turns with its drum has none: the
//! mean over the grains whose centres lie in the cell of their parts `|U_i|²/3`, Eq. 22 of Kasper et
//! al. 2021 with the sum over the cell. A cell of too few grains has none.

use super::surface::mean_radius;
use super::temperature::fluctuations;
use crate::world::World;
use glam::DVec2;

/// Side of a cell in mean radii of the grains: it holds a dozen or so in a thin drum.
const CELL: f64 = 4.0;
/// Cells along a side at most: grains that are strewn wide are mapped more coarsely.
const MOST_CELLS: f64 = 128.0;
/// Grains of which a mean says something, at least.
const FEWEST: u32 = 3;

/// Granular temperatures at one instant in the cells of a square grid.
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureMap {
    /// The lowest and leftmost corner [m].
    pub corner: DVec2,
    /// Side of a cell [m].
    pub spacing: f64,
    /// Cells in a row.
    pub columns: usize,
    /// Temperature in each cell, row by row from below [m²/s²]; none where too few grains are.
    pub temperature: Vec<Option<f64>>,
}

impl TemperatureMap {
    /// The cells that have a temperature: the lowest and leftmost corner [m], and it.
    pub fn cells(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let place = |index: usize| {
            let cell = DVec2::new((index % self.columns) as f64, (index / self.columns) as f64);
            self.corner + self.spacing * cell
        };
        let cells = self.temperature.iter().enumerate();
        cells.filter_map(move |(index, temperature)| Some((place(index), (*temperature)?)))
    }
}

/// The granular temperatures in the cross-section of `world` now. None without grains.
pub fn temperature_map(world: &World) -> Option<TemperatureMap> {
    let places = || world.grains.position.iter().map(|x| x.truncate());
    let low = places().reduce(DVec2::min)?;
    let high = places().reduce(DVec2::max)?;
    let side = CELL * mean_radius(&world.grains);
    let spacing = side.max((high - low).max_element() / MOST_CELLS);
    // Corners lie at whole multiples of the spacing, so that cells stand still while grains move.
    let first = (low / spacing).floor();
    let size = (high / spacing).floor() - first + 1.0;
    let columns = size.x as usize;
    let mut sums = vec![(0_u32, 0.0); columns * size.y as usize];
    for (place, part) in places().zip(fluctuations(world)) {
        let cell = (place / spacing).floor() - first;
        let (count, sum) = &mut sums[cell.y as usize * columns + cell.x as usize];
        *count += 1;
        *sum += part;
    }
    let mean = |(count, sum): &(u32, f64)| (*count >= FEWEST).then(|| sum / f64::from(*count));
    Some(TemperatureMap {
        corner: first * spacing,
        spacing,
        columns,
        temperature: sums.iter().map(mean).collect(),
    })
}
