//! A timeline on its way into a file and out of it.
//!
//! In: a timeline, or an [`Archive`] of one. Out: the other. What a file may hold is checked
//! elsewhere (`soundness`).

use super::Timeline;
use crate::run::archive::{Archive, ArchivedEntry, ArchivedState, Table};
use crate::run::branch::Branch;
use crate::run::keyframes::Keyframes;
use crate::run::past::News;
use crate::run::trajectory::Run;
use crate::run::undo::{UndoEntry, UndoList};
use crate::scene::Scene;
use std::sync::Arc;

impl Timeline {
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
}
