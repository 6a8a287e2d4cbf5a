//! The spatial sort: in which slot the rows of each grain stand.
//!
//! Grains that touch lie near each other in memory, so that workers share few cache lines: the
//! workers' ranges of rows are slices of the bed. Slots are a cache like the lists: they follow
//! where the grains were some lists ago, and never show in a result, because forces are summed in
//! the order of the grains' indices.

use super::rows::Slot;
use crate::world::Grains;
use glam::DVec3;

/// The slots of all grains.
#[derive(Default)]
pub struct Slots {
    /// The grain in each slot.
    grain: Vec<u32>,
    /// The slot of each grain.
    slot: Vec<Slot>,
    /// Searches for neighbours when they were last sorted.
    searches: u64,
}

/// Searches for neighbours after which grains are sorted anew: within them a bed mixes little.
const SEARCHES_IN_ORDER: u64 = 16;

impl Slots {
    /// Whether the slots are those of other grains or of long ago, after so many `searches` for
    /// neighbours since the start.
    pub fn is_stale(&self, grains: &Grains, searches: u64) -> bool {
        self.grain.len() != grains.len() || searches > self.searches + SEARCHES_IN_ORDER
    }

    /// Sorts the grains into slices as thick as a grain across the longest extent, and these
    /// likewise along the other two.
    pub fn sort(&mut self, grains: &Grains, searches: u64) {
        let position = &grains.position;
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        let thickness = 2.0 * mean(&grains.radius);
        let low = position.iter().copied().reduce(DVec3::min);
        let high = position.iter().copied().reduce(DVec3::max);
        let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| (high - low)[*b].total_cmp(&(high - low)[*a]));
        let slices = |i: u32| {
            let offset = (position[i as usize] - low) / thickness;
            axes.map(|axis| offset[axis] as u32)
        };
        self.grain = (0..position.len() as u32).collect();
        self.grain.sort_by_cached_key(|i| slices(*i));
        self.slot.resize(self.grain.len(), Slot::default());
        for (slot, grain) in self.grain.iter().enumerate() {
            self.slot[*grain as usize] = Slot(slot as u32);
        }
        self.searches = searches;
    }

    /// The grain in each slot.
    pub fn grains(&self) -> &[u32] {
        &self.grain
    }

    /// The grain in this slot; padding holds none.
    pub fn grain_in(&self, slot: Slot) -> u32 {
        self.grain.get(slot.index()).copied().unwrap_or(u32::MAX)
    }

    /// The slot of `grain`.
    pub fn slot_of(&self, grain: u32) -> Slot {
        self.slot[grain as usize]
    }
}
