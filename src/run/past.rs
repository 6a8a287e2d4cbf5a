//! What is told of a timeline: what lies behind and ahead of the state shown, and what came about
//! lately.
//!
//! In: nothing. Out: plain values, filled in by [`super::Timeline`].

use super::branch::Branch;
use super::branch_names::BranchNames;
use super::history::Moment;
use super::undo::Changed;
use std::sync::Arc;

/// What came about since it was last asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct News {
    /// Another branch is the present one.
    pub switched: bool,
    /// The state is one that a person asked to see: the nearest keyframe or the end of the way.
    pub arrived: bool,
}

/// What lies behind and ahead of the state shown.
#[derive(Clone, Debug, Default)]
pub struct Past {
    /// Which of all branches the present one is, counted from 1.
    pub number: u32,
    /// The last moment of the present branch so far.
    pub end: Moment,
    /// What an undo would take back.
    pub undo: Option<Changed>,
    /// What a redo would bring back.
    pub redo: Option<Changed>,
    /// Branches that were left for others, the oldest first.
    pub kept: Vec<Arc<Branch>>,
    /// What people called branches.
    pub names: BranchNames,
    /// Memory that keyframes take [bytes].
    pub memory: usize,
}

/// On the way to a moment.
#[derive(Clone, Copy, Debug)]
pub struct Journey {
    /// The step at which it began.
    pub from: u64,
    /// The step at which it will end.
    pub to: u64,
}

impl Journey {
    /// How much of it is done at `step`, 0 … 1.
    pub fn progress(&self, step: u64) -> f32 {
        let done = step.saturating_sub(self.from);
        done as f32 / (self.to - self.from).max(1) as f32
    }
}
