//! What a run keeps in memory by design: all that was measured, for its plots, and states to come
//! back to.
//!
//! In: branches, and the bytes of their keyframes. Out: bytes. What branches share is counted once.
//! Room that is set aside for what is still to come does not count: it is not used before.

use super::branch::Branch;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Memory that a run takes with all its branches [bytes].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptMemory {
    /// Samples.
    pub samples: usize,
    /// Profiles and maps of the flowing layer.
    pub flow: usize,
    /// Contacts and bridges of few grains that began and ended.
    pub meetings: usize,
    /// Keyframes: states along all branches.
    pub states: usize,
}

impl KeptMemory {
    /// That of these `branches`, and of keyframes that take `states` [bytes].
    pub fn of<'a>(branches: impl IntoIterator<Item = &'a Branch>, states: usize) -> Self {
        let mut counted = BTreeSet::new();
        let mut kept = Self {
            states,
            ..Self::default()
        };
        for branch in branches {
            if counted.insert(Arc::as_ptr(&branch.series).addr()) {
                kept.samples += branch.series.memory();
            }
            if counted.insert(Arc::as_ptr(&branch.flow).addr()) {
                kept.flow += branch.flow.own_memory();
                let parts = branch.flow.shared_parts();
                let new = parts.filter(|(place, _)| counted.insert(*place));
                kept.flow += new.map(|(_, bytes)| bytes).sum::<usize>();
            }
            if counted.insert(Arc::as_ptr(&branch.meetings).addr()) {
                kept.meetings += size_of_val(&branch.meetings[..]);
            }
        }
        kept
    }

    /// All of it [bytes].
    pub fn total(&self) -> usize {
        self.samples + self.flow + self.meetings + self.states
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{Measure, Sample};

    /// Adds so many samples to `branch`, every value of which differs from the one before it.
    fn measure(branch: &mut Branch, samples: usize) {
        for _ in 0..samples {
            let step = branch.series.len() as u64;
            Arc::make_mut(&mut branch.series).push(Sample {
                step,
                time: step as f64,
                values: [step as f64; Measure::COUNT],
            });
        }
    }

    #[test]
    fn a_thousand_samples_more_are_a_thousand_rows_more_and_what_is_shared_counts_once() {
        let row = size_of::<Sample>();
        let mut branch = Branch::begin(1);
        measure(&mut branch, 2);
        let few = KeptMemory::of([&branch], 100);
        assert_eq!((few.samples, few.total()), (2 * row, 2 * row + 100));
        measure(&mut branch, 1000);
        assert_eq!(KeptMemory::of([&branch], 100).samples, 1002 * row);
        let mut other = branch.clone();
        assert_eq!(KeptMemory::of([&branch, &other], 0).samples, 1002 * row);
        measure(&mut other, 1);
        assert_eq!(KeptMemory::of([&branch, &other], 0).samples, 2005 * row);
    }
}
