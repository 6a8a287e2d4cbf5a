//! Where pairs write what they do: the rows of [`super::rings`].
//!
//! A pair of grains has its number, modulo the size of the ring; a pair with a wall has a row among
//! those of its wall.

use super::rows::{GROUP, WallId};

/// Grains that are moved together.
pub const BLOCK: usize = 32;

/// Rows for the pairs with one wall: a block has no more of them than grains, and groups reach over
/// its ends.
pub const ROWS_OF_WALL: usize = (BLOCK + 2 * GROUP).next_power_of_two();

/// The row, among those of pairs with walls, of the one of this number.
pub fn row_at_wall(wall: WallId, number: usize) -> usize {
    wall.index() * ROWS_OF_WALL + number % ROWS_OF_WALL
}

/// Where to find what a pair does to a grain ([`super::rings`]).
#[derive(Clone, Copy, Debug, Default)]
pub struct Place(u32);

impl Place {
    const AT_WALL: u32 = 1 << 31;

    /// That of the pair of two grains of this number.
    pub fn of(pair: usize) -> Self {
        Self(pair as u32)
    }

    /// That of the pair of this number with this wall.
    pub fn at_wall(wall: WallId, number: usize) -> Self {
        Self(Self::AT_WALL | row_at_wall(wall, number) as u32)
    }

    /// Whether the pair is one with a wall.
    #[inline(always)]
    pub fn is_at_wall(self) -> bool {
        self.0 & Self::AT_WALL != 0
    }

    /// The row of a pair with a wall, the number of one of two grains.
    #[inline(always)]
    pub fn number(self) -> usize {
        (self.0 & !Self::AT_WALL) as usize
    }
}
