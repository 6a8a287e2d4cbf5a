//! All branches of a run: go back, look, change something and run on, take it back.
//!
//! In: steps to go to and changes to make. Out: the run at that step, and all branches there have
//! been. To show an earlier moment, the state is restored from the keyframe before it and what
//! followed is computed again, commands included, which gives the same bits. A change made while an
//! earlier moment is shown begins another branch; the one that is left is kept. How fast to go, and
//! for how long, is decided elsewhere. Here the run goes from moment to moment; `changes` holds what
//! is changed and taken back, `branches` which branches are kept, `filed` the way into a file.

mod branches;
mod changes;
mod filed;

use super::branch::Branch;
use super::branch_names::BranchNames;
use super::history::Position;
use super::kept_memory::KeptMemory;
use super::keyframes::Keyframes;
use super::measured::Stored;
use super::past::{Journey, News, Past};
use super::undo::UndoList;
use super::{CommandError, Run, Script, Snapshot};
use crate::solver::{Fault, Profile};
use std::sync::Arc;
use std::time::Instant;

/// The present branch with all that came before it.
pub struct Timeline {
    run: Run,
    keyframes: Keyframes,
    kept: Vec<Arc<Branch>>,
    changes: UndoList,
    journey: Option<Journey>,
    news: News,
    /// Branches begun so far.
    begun: u32,
    names: BranchNames,
}

impl Timeline {
    /// The timeline of `run`, which is at its end, with keyframes in `budget` bytes.
    pub fn new(run: Run, budget: usize) -> Self {
        Self {
            run,
            keyframes: Keyframes::new(budget),
            kept: Vec::new(),
            changes: UndoList::default(),
            journey: None,
            news: News::default(),
            begun: 1,
            names: BranchNames::default(),
        }
    }

    /// Commands to carry out by themselves when their steps come.
    ///
    /// # Errors
    /// As [`Run::schedule`].
    pub fn schedule(&mut self, plan: Script) -> Result<(), CommandError> {
        self.run.schedule(plan)
    }

    /// Follows how far spheres turn, where keyframes are kept: somebody looks at such a run.
    pub(crate) fn follow_orientations(&mut self) {
        if self.keyframes.are_kept() {
            self.run.follow_orientations();
        }
    }

    /// The run at the moment shown.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// The present branch as far as it has come.
    pub fn branch(&self) -> &Branch {
        self.run.branch()
    }

    /// Steps taken and commands carried out at the moment shown.
    pub(crate) fn steps_and_commands(&self) -> (u64, usize) {
        (self.step(), self.run.commands().len())
    }

    /// The state at the end of the present branch, where that is at hand.
    pub(super) fn end(&self) -> Option<Snapshot> {
        if self.run.is_at_end() {
            return Some(self.run.snapshot());
        }
        let end = self.keyframes.end(self.branch())?;
        Some((**end).clone())
    }

    /// What lies behind and ahead.
    pub fn past(&self) -> Past {
        let branch = self.branch();
        Past {
            number: branch.number,
            end: branch.end,
            undo: self.changes.next_undo().cloned(),
            redo: self.changes.next_redo().cloned(),
            kept: self.kept.clone(),
            names: self.names.clone(),
            memory: self.keyframes.memory(),
        }
    }

    /// What it keeps in memory, with the branch as it was `shared` with others.
    pub(crate) fn kept_memory(&self, shared: &Branch) -> KeptMemory {
        let kept = self.kept.iter().map(Arc::as_ref);
        let branches = [self.branch(), shared].into_iter();
        let branches = branches.chain(kept).chain(self.changes.branches());
        KeptMemory::of(branches, self.keyframes.memory())
    }

    /// What came about since this was last called.
    pub fn take_news(&mut self) -> News {
        std::mem::take(&mut self.news)
    }

    /// Where the solver's time went since this was last called.
    pub fn take_profile(&mut self) -> Profile {
        self.run.take_profile()
    }

    /// The step to be gone to before anything else.
    pub fn destination(&self) -> Option<u64> {
        self.journey.map(|journey| journey.to)
    }

    /// How much of the way to it is done, 0 … 1.
    pub fn progress(&self) -> f32 {
        (self.journey).map_or(1.0, |journey| journey.progress(self.step()))
    }

    /// Stays where it is on the way.
    pub fn stop(&mut self) {
        if self.journey.take().is_some() {
            self.news.arrived = true;
        }
    }

    /// Advances to `step`, recording what is new.
    ///
    /// # Errors
    /// As [`Run::advance_to`].
    pub fn advance_to(&mut self, step: u64) -> Result<(), Fault> {
        let started = Instant::now();
        let outcome = self.run.advance_to(step);
        if self.keyframes.after(started.elapsed()) {
            self.keep_keyframe();
        }
        let there = |journey: &Journey| self.step() >= journey.to;
        if self.journey.as_ref().is_some_and(there) || outcome.is_err() {
            self.stop();
        }
        outcome
    }

    /// Goes ahead in the present branch to the last keyframe at or before `step`: for those who
    /// want to see it faster than it can be computed.
    pub fn skip_towards(&mut self, step: u64) {
        let step = step.min(self.branch().end.step);
        let ahead = self.keyframes.nearest(&self.branch().history, step);
        let ahead = ahead.filter(|snapshot| snapshot.step() > self.step());
        if let Some(snapshot) = ahead.cloned() {
            self.run.show(&snapshot);
            self.run.follow_branch();
        }
    }

    /// Goes to `step` of the present branch, at most to its end.
    pub fn seek(&mut self, step: u64) {
        let here = self.position();
        self.keep_end();
        self.travel(here, step.min(self.branch().end.step));
    }

    /// Forgets what is `stored` in files of what was measured in the present branch.
    pub(crate) fn forget_measured(&mut self, stored: Stored) {
        self.run.forget(stored);
    }

    /// Goes on with `threads` threads.
    pub(crate) fn use_threads(&mut self, threads: usize) {
        self.run.use_threads(threads);
    }

    pub(super) fn step(&self) -> u64 {
        self.run.world().clock.step
    }

    pub(super) fn position(&self) -> Position {
        let (step, commands) = self.steps_and_commands();
        self.branch().history.position(commands, step)
    }

    fn keep_keyframe(&mut self) {
        let position = self.position();
        self.keyframes.keep(position, || self.run.snapshot());
    }

    /// Keeps the end of the present branch where that is shown, so that it can be shown again at
    /// once.
    pub(super) fn keep_end(&mut self) {
        if self.run.is_at_end() {
            self.keep_keyframe();
        }
    }

    /// Sets out from `here` for `step` of the present branch: from the nearest keyframe, where that
    /// is nearer.
    pub(super) fn travel(&mut self, here: Position, step: u64) {
        let history = &self.branch().history;
        let start = self.keyframes.nearest(history, step).cloned();
        let passes = here.step() <= step && history.passes(&here);
        let is_nearest = |start: &Arc<Snapshot>| start.step() <= here.step();
        match start {
            start if passes && start.as_ref().is_none_or(is_nearest) => {}
            Some(snapshot) => {
                self.run.show(&snapshot);
                self.keyframes.restart();
            }
            None => {
                self.run.rewind();
                self.keyframes.restart();
            }
        }
        self.run.follow_branch();
        let from = self.step();
        self.journey = Some(Journey { from, to: step });
        self.news.arrived = true;
        if from >= step {
            self.stop();
        }
    }
}
