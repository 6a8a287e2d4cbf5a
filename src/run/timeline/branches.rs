//! The branches that are kept beside the present one: which, how many, and what people call them.
//!
//! In: branches that are left for others. Out: those that hold more than others do, the oldest
//! first.

use super::Timeline;
use crate::run::branch::Branch;
use crate::run::snapshot::Snapshot;
use std::sync::Arc;

/// Most branches kept beside the present one.
const MOST_KEPT: usize = 8;

impl Timeline {
    /// Branches that were left for others, the oldest first.
    pub fn kept(&self) -> &[Arc<Branch>] {
        &self.kept
    }

    /// Calls the branch of this `number` by `name`; an empty one takes its name away.
    pub fn name_branch(&mut self, number: u32, name: &str) {
        self.names.give(number, name);
    }

    /// Keeps `branch` of `other`, which began from the same bed, beside the present one, with the
    /// state at its `end` where that is known; returns its index.
    fn adopt(&mut self, other: &Self, mut branch: Branch, end: Option<Snapshot>) -> usize {
        let number = self.next_number();
        if let Some(name) = other.names.of(branch.number) {
            self.names.give(number, name);
        }
        branch.number = number;
        if let Some(end) = end {
            let position = branch.history.position(end.commands(), end.step());
            self.keyframes.keep(position, || end);
        }
        self.kept.push(Arc::new(branch));
        self.drop_oldest();
        self.kept.len() - 1
    }

    /// Keeps all branches of `other`, a run from the same bed, beside the present one, the newest
    /// of both where there is no room for all; returns the index of that which is the other's
    /// present one.
    pub(crate) fn adopt_all(&mut self, other: &Self) -> usize {
        for branch in &other.kept {
            let end = other.keyframes.end(branch).map(|end| (**end).clone());
            self.adopt(other, (**branch).clone(), end);
        }
        self.adopt(other, other.branch().clone(), other.end())
    }

    /// Keeps these branches and no others beside the present one.
    pub(crate) fn keep_only(&mut self, kept: Vec<Arc<Branch>>) {
        self.kept = kept;
    }

    /// Keeps the branch of `index` no longer.
    pub fn forget(&mut self, index: usize) {
        if index < self.kept.len() {
            self.kept.remove(index);
        }
    }

    pub(super) fn next_number(&mut self) -> u32 {
        self.begun += 1;
        self.begun
    }

    /// Leaves the present branch for one that has its past until now; returns the one that is left.
    pub(super) fn begin_branch(&mut self) -> Arc<Branch> {
        let number = self.next_number();
        let left = self.run.begin_branch(number);
        let left = self.keep_left(left);
        self.run.follow_branch();
        left
    }

    /// Keeps the branch that was `left` for the present one, where it holds more than others do.
    pub(super) fn keep_left(&mut self, left: Branch) -> Arc<Branch> {
        let left = Arc::new(left);
        let present = self.run.branch();
        let holds_more = |branch: &Arc<Branch>| branch.went_on() && !branch.is_part_of(present);
        self.kept
            .retain(|kept| holds_more(kept) && !kept.is_part_of(&left));
        if holds_more(&left) {
            self.kept.push(left.clone());
        }
        self.drop_oldest();
        self.news.switched = true;
        left
    }

    fn drop_oldest(&mut self) {
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
    }
}
