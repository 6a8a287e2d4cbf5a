//! Keyframes: states along all branches, kept within a budget of memory. An earlier moment is
//! computed from the keyframe before it instead of from time zero.
//!
//! In: the computing time that was spent, and the state now. Out: the last keyframe before a step
//! of a branch. A keyframe is due after some computing time since the last one. When the budget is
//! spent, every second one is dropped and the next are taken half as often, so they stay evenly
//! spread over the computing time, however long a run becomes. Computing from a keyframe on is the
//! timeline's work.

use super::Snapshot;
use super::branch::Branch;
use super::history::{History, Position};
use std::sync::Arc;
use std::time::Duration;

/// Work between two keyframes at first: repeating it is felt as at once.
const FIRST_SPACING: Duration = Duration::from_millis(50);
/// Most of the work's time that taking keyframes may cost, as one part in so many.
const SHARE_OF_TIME: u32 = 50;
/// Most keyframes kept, however small they are.
const MOST: usize = 4096;

/// The keyframes kept.
pub struct Keyframes {
    list: Vec<Keyframe>,
    memory: usize,
    budget: usize,
    spacing: Duration,
    /// Work done since the last keyframe was taken or passed.
    work: Duration,
}

struct Keyframe {
    position: Position,
    snapshot: Arc<Snapshot>,
    memory: usize,
}

impl Keyframes {
    /// None yet, within `budget` [bytes].
    pub fn new(budget: usize) -> Self {
        Self {
            list: Vec::new(),
            memory: 0,
            budget,
            spacing: FIRST_SPACING,
            work: Duration::ZERO,
        }
    }

    /// Whether any are kept.
    pub fn are_kept(&self) -> bool {
        self.budget > 0
    }

    /// Memory that they take [bytes].
    pub fn memory(&self) -> usize {
        self.memory
    }

    /// Notes that so much `work` was done; says whether a keyframe is due.
    pub fn after(&mut self, work: Duration) -> bool {
        self.work += work;
        self.work >= self.spacing
    }

    /// Notes that work starts anew from a keyframe.
    pub fn restart(&mut self) {
        self.work = Duration::ZERO;
    }

    /// Keeps the `snapshot` that `take` takes at `position`, unless there is one; what it costs
    /// spaces the next.
    pub fn keep(&mut self, position: Position, take: impl FnOnce() -> Snapshot) {
        self.restart();
        if self.budget == 0
            || self
                .list
                .iter()
                .any(|keyframe| keyframe.position == position)
        {
            return;
        }
        let started = std::time::Instant::now();
        let snapshot = Arc::new(take());
        self.spacing = self.spacing.max(SHARE_OF_TIME * started.elapsed());
        let memory = snapshot.memory();
        if memory > self.budget {
            return;
        }
        while self.memory + memory > self.budget || self.list.len() >= MOST {
            self.thin();
        }
        self.memory += memory;
        self.list.push(Keyframe {
            position,
            snapshot,
            memory,
        });
    }

    /// The last state at or before `step` of the run with `history`.
    pub fn nearest(&self, history: &History, step: u64) -> Option<&Arc<Snapshot>> {
        let on_the_way = |keyframe: &&Keyframe| {
            keyframe.position.step() <= step && history.passes(&keyframe.position)
        };
        let kept = self.list.iter().filter(on_the_way);
        kept.max_by_key(|keyframe| (keyframe.position.step(), keyframe.snapshot.commands()))
            .map(|keyframe| &keyframe.snapshot)
    }

    /// The state at the end of `branch`, where that was kept.
    pub fn end(&self, branch: &Branch) -> Option<&Arc<Snapshot>> {
        let nearest = self.nearest(&branch.history, branch.end.step);
        nearest.filter(|snapshot| snapshot.step() == branch.end.step)
    }

    fn thin(&mut self) {
        let mut index = 0;
        self.list.retain(|_| {
            index += 1;
            index % 2 == 0
        });
        self.memory = self.list.iter().map(|keyframe| keyframe.memory).sum();
        self.spacing *= 2;
    }
}
