//! All branches of a run: go back, look, change something and run on, take it back.
//!
//! In: steps to go to and changes to make. Out: the run at that step, and all branches there have
//! been. To show an earlier moment, the state is restored from the keyframe before it and what
//! followed is computed again, commands included, which gives the same bits. A change made while an
//! earlier moment is shown begins another branch; the one that is left is kept. How fast to go, and
//! for how long, is decided elsewhere.

use super::archive::{Archive, ArchivedEntry, ArchivedState, Table};
use super::branch::Branch;
use super::branch_names::BranchNames;
use super::history::{Moment, Position};
use super::keyframes::Keyframes;
use super::measured::Stored;
use super::past::{Journey, News, Past};
use super::undo::{Changed, Destination, UndoEntry, UndoList};
use super::{Command, CommandError, Parameter, Run, Script, Snapshot, Value};
use crate::scene::Scene;
use crate::solver::{Fault, Profile};
use std::sync::Arc;
use std::time::Instant;

/// Most branches kept beside the present one.
const MOST_KEPT: usize = 8;

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

    /// All of it, as a file can keep it.
    pub fn archive(&self) -> Archive {
        let mut table = Table::of(self.run.branch());
        let kept = self.kept.iter().map(|branch| table.index(branch)).collect();
        let mut entries = |entries: &[UndoEntry]| -> Vec<ArchivedEntry> {
            let entries = entries.iter();
            let archived = entries.map(|entry| ArchivedEntry::of(entry, &mut table));
            archived.collect()
        };
        let (undo, redo) = (entries(&self.changes.undo), entries(&self.changes.redo));
        let branches = table.branches();
        let shown = ArchivedState {
            branch: 0,
            snapshot: self.run.snapshot(),
        };
        let ends = branches
            .iter()
            .enumerate()
            .filter_map(|(index, branch)| Some((index, self.keyframes.end(branch)?.clone())));
        let states = Archive::states(shown, ends);
        Archive {
            bed: (**self.run.bed()).clone(),
            states,
            kept,
            undo,
            redo,
            begun: self.begun,
            names: self.names.clone(),
            branches,
        }
    }

    /// The timeline of `scene` that was put into `archive`, on `threads` threads, with keyframes in
    /// `budget` bytes. What an archive that is not whole refers to and does not hold is left out.
    pub fn unpack(archive: Archive, scene: Arc<Scene>, threads: usize, budget: usize) -> Self {
        let branches: Vec<Arc<Branch>> = archive.branches.into_iter().map(Arc::new).collect();
        let entry = |entry: ArchivedEntry| entry.unpack(&branches);
        let mut timeline = Self {
            kept: (archive.kept.iter())
                .filter_map(|index| branches.get(*index).cloned())
                .collect(),
            changes: UndoList {
                undo: archive.undo.into_iter().filter_map(entry).collect(),
                redo: archive.redo.into_iter().filter_map(entry).collect(),
            },
            run: Run::new(scene, archive.bed, threads),
            keyframes: Keyframes::new(budget),
            journey: None,
            news: News {
                switched: true,
                arrived: true,
            },
            begun: archive.begun,
            names: archive.names,
        };
        if let Some(present) = branches.first() {
            timeline.run.replace_branch((**present).clone());
        }
        let bed = timeline.run.bed().clone();
        for (index, state) in archive.states.into_iter().enumerate() {
            let snapshot = state.snapshot.sharing(Some(&bed));
            if index == 0 {
                timeline.run.show(&snapshot);
            }
            if let Some(branch) = branches.get(state.branch) {
                let history = &branch.history;
                let position = history.position(snapshot.commands(), snapshot.step());
                timeline.keyframes.keep(position, || snapshot);
            }
        }
        timeline.run.follow_branch();
        timeline
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
    fn end(&self) -> Option<Snapshot> {
        if self.run.is_at_end() {
            return Some(self.run.snapshot());
        }
        let end = self.keyframes.end(self.branch())?;
        Some((**end).clone())
    }

    /// Branches that were left for others, the oldest first.
    pub fn kept(&self) -> &[Arc<Branch>] {
        &self.kept
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

    /// Carries out `command` at the moment shown. At an earlier moment this begins another branch
    /// and keeps the one that is left. It is part of the change before it where it `joins`.
    ///
    /// # Errors
    /// As [`Run::apply`].
    pub fn change(&mut self, command: Command, joins: bool) -> Result<(), CommandError> {
        if let Command::Set { parameter, value } = self.run.accept(&command)? {
            let joins = self.begin_change(&parameter, joins);
            self.run.change(parameter, value, joins);
        }
        Ok(())
    }

    /// Whether the time step stays from now on, as it does in each of two runs that keep one time.
    pub(crate) fn keep_step(&mut self, keeps: bool) {
        self.run.keep_step(keeps);
    }

    /// Notes that `command` was carried out in the run beside this one and not here: an undo takes
    /// it back in both, and where it was made at an earlier moment both go on from there.
    ///
    /// # Errors
    /// As [`Timeline::change`].
    pub(crate) fn note_beside(
        &mut self,
        command: &Command,
        joins: bool,
    ) -> Result<(), CommandError> {
        if let Command::Set { parameter, .. } = self.run.accept(command)? {
            self.begin_change(&parameter, joins);
        }
        Ok(())
    }

    /// Makes a new value of `parameter` a change that can be taken back; whether it is part of the
    /// one before it.
    fn begin_change(&mut self, parameter: &Parameter, joins: bool) -> bool {
        self.stop();
        let what = Changed::Parameter(parameter.clone());
        let moment = Moment::of(self.run.world());
        let joins = joins && self.run.is_at_end() && self.changes.can_join();
        if joins {
            self.changes.join(what);
            return true;
        }
        self.keep_end();
        let destination = if self.run.is_at_end() {
            let commands = self.run.commands().len();
            Destination::Earlier { commands, moment }
        } else {
            Destination::Other {
                branch: self.begin_branch(),
                step: moment.step,
            }
        };
        self.changes.note(UndoEntry { what, destination });
        false
    }

    /// Starts afresh at time zero with the present values, keeping the branch that is left.
    pub fn reset(&mut self) {
        self.restart(&self.run.values());
    }

    /// Starts afresh at time zero with these `values`, keeping the branch that is left.
    pub(crate) fn restart(&mut self, values: &[(Parameter, Value)]) {
        self.stop();
        self.keep_end();
        let step = self.step();
        let number = self.next_number();
        let left = self.run.start_afresh(values, number);
        let left = self.keep_left(left);
        // A branch that had only just begun is nothing to come back to.
        if !left.is_fresh() {
            let destination = Destination::Other { branch: left, step };
            self.changes.note(UndoEntry {
                what: Changed::Start,
                destination,
            });
        }
    }

    /// Takes the last change back: goes to its moment, as if it had not been made.
    pub fn undo(&mut self) {
        if let Some(entry) = self.changes.undo.pop() {
            let back = self.go(entry);
            self.changes.redo.push(back);
        }
    }

    /// Brings the last change that was taken back to where it was.
    pub fn redo(&mut self) {
        if let Some(entry) = self.changes.redo.pop() {
            let back = self.go(entry);
            self.changes.undo.push(back);
        }
    }

    /// Shows the end of the kept branch of `index`, if there is one, and keeps the present branch.
    pub fn take_up(&mut self, index: usize) {
        if let Some(branch) = self.kept.get(index).cloned() {
            let step = branch.end.step;
            let back = self.go(UndoEntry {
                what: Changed::Run,
                destination: Destination::Other { branch, step },
            });
            self.changes.note(back);
        }
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

    /// Forgets what is `stored` in files of what was measured in the present branch.
    pub(crate) fn forget_measured(&mut self, stored: Stored) {
        self.run.forget(stored);
    }

    /// Goes on with `threads` threads.
    pub(crate) fn use_threads(&mut self, threads: usize) {
        self.run.use_threads(threads);
    }

    /// Keeps the branch of `index` no longer.
    pub fn forget(&mut self, index: usize) {
        if index < self.kept.len() {
            self.kept.remove(index);
        }
    }

    fn next_number(&mut self) -> u32 {
        self.begun += 1;
        self.begun
    }

    fn step(&self) -> u64 {
        self.run.world().clock.step
    }

    fn position(&self) -> Position {
        let (step, commands) = self.steps_and_commands();
        self.branch().history.position(commands, step)
    }

    fn keep_keyframe(&mut self) {
        let position = self.position();
        self.keyframes.keep(position, || self.run.snapshot());
    }

    /// Keeps the end of the present branch where that is shown, so that it can be shown again at
    /// once.
    fn keep_end(&mut self) {
        if self.run.is_at_end() {
            self.keep_keyframe();
        }
    }

    /// Leaves the present branch for one that has its past until now; returns the one that is left.
    fn begin_branch(&mut self) -> Arc<Branch> {
        let number = self.next_number();
        let left = self.run.begin_branch(number);
        let left = self.keep_left(left);
        self.run.follow_branch();
        left
    }

    /// Keeps the branch that was `left` for the present one, where it holds more than others do.
    fn keep_left(&mut self, left: Branch) -> Arc<Branch> {
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

    /// Goes where `entry` leads; returns the entry that leads back.
    fn go(&mut self, entry: UndoEntry) -> UndoEntry {
        let here = self.position();
        self.keep_end();
        let (branch, step) = match entry.destination {
            Destination::Earlier { commands, moment } => {
                let number = self.next_number();
                (self.branch().until(commands, moment, number), moment.step)
            }
            Destination::Other { branch, step } => ((*branch).clone(), step),
        };
        let left = self.run.replace_branch(branch);
        let left = self.keep_left(left);
        self.travel(here, step);
        UndoEntry {
            what: entry.what,
            destination: Destination::Other {
                branch: left,
                step: here.step(),
            },
        }
    }

    /// Sets out from `here` for `step` of the present branch: from the nearest keyframe, where that
    /// is nearer.
    fn travel(&mut self, here: Position, step: u64) {
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
