//! Where the solver keeps each grain.
//!
//! Grains that touch lie near each other in memory, so that members of a team share few cache lines: a team's halves of the
//! rows are halves of the bed. Places are a cache like the lists: they follow where the grains were some lists ago, and
//! never show in a result, because forces are summed in the order of the grains' indices.

use crate::world::Grains;
use glam::DVec3;

/// The places of all grains.
#[derive(Default)]
pub struct Order {
    /// The grain at each place.
    grain: Vec<u32>,
    /// The place of each grain.
    place: Vec<u32>,
    /// Near lists built when the places were chosen.
    lists: u64,
}

/// Near lists after which places are chosen anew: within them a bed mixes little.
const LISTS_IN_ORDER: u64 = 16;

impl Order {
    /// Whether the places are those of other grains or of long ago, `lists` near lists having been built since the start.
    pub fn is_stale(&self, grains: &Grains, lists: u64) -> bool {
        self.grain.len() != grains.len() || lists > self.lists + LISTS_IN_ORDER
    }

    /// Sorts the grains into slices as thick as a grain across the longest extent, and these likewise along the other two.
    pub fn choose(&mut self, grains: &Grains, lists: u64) {
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
        self.place.resize(self.grain.len(), 0);
        for (place, grain) in self.grain.iter().enumerate() {
            self.place[*grain as usize] = place as u32;
        }
        self.lists = lists;
    }

    /// The grain at each place.
    pub fn grains(&self) -> &[u32] {
        &self.grain
    }

    /// The place of `grain`.
    pub fn place(&self, grain: u32) -> u32 {
        self.place[grain as usize]
    }
}
