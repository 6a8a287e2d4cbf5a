//! A timeline as a file can keep it: every run there has been once, however often it is come back to, and the states it
//! takes to go on at once.
//!
//! In: what a [`super::Timeline`] holds. Out: an [`Archive`], which postcard turns into bytes. Shapes of polyhedra, which
//! never change, are kept with the bed alone.

use super::Snapshot;
use super::history::{Moment, Record};
use super::timeline::Changed;
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Most memory that states other than the one shown take [bytes]: without them, ends of runs are computed again.
const MOST_STATES: usize = 64 << 20;

/// All that a timeline is.
#[derive(Clone, Serialize, Deserialize)]
pub struct Archive {
    /// The state at time zero, before any command.
    pub bed: World,
    /// Every run there has been and is still known; the first is the present one.
    pub records: Vec<Record>,
    /// States of them; the first is the one shown.
    pub states: Vec<ArchivedState>,
    /// Runs kept beside the present one, by index.
    pub kept: Vec<usize>,
    /// Changes that can be taken back.
    pub undo: Vec<ArchivedTurn>,
    /// Changes that were taken back.
    pub redo: Vec<ArchivedTurn>,
    /// Runs begun so far.
    pub begun: u32,
}

/// A state of the run of this index.
#[derive(Clone, Serialize, Deserialize)]
pub struct ArchivedState {
    pub record: usize,
    pub snapshot: Snapshot,
}

/// A change that was made or taken back.
#[derive(Clone, Serialize, Deserialize)]
pub struct ArchivedTurn {
    pub what: Changed,
    pub destination: ArchivedDestination,
}

/// Where the other side of a change lies.
#[derive(Clone, Serialize, Deserialize)]
pub enum ArchivedDestination {
    /// Earlier in the present run.
    Earlier { commands: usize, moment: Moment },
    /// A step of the run of this index.
    Other { record: usize, step: u64 },
}

impl Archive {
    /// The states to keep: the one `shown`, then as many `ends` of runs as there is room for.
    pub fn states(
        shown: ArchivedState,
        ends: impl Iterator<Item = (usize, Arc<Snapshot>)>,
    ) -> Vec<ArchivedState> {
        let mut room = MOST_STATES;
        let at = (shown.snapshot.step(), shown.snapshot.commands());
        let mut states = vec![ArchivedState {
            snapshot: shown.snapshot.sharing(None),
            ..shown
        }];
        for (record, snapshot) in ends {
            let is_shown = record == 0 && (snapshot.step(), snapshot.commands()) == at;
            let memory = snapshot.memory();
            if is_shown || memory > room {
                continue;
            }
            room -= memory;
            states.push(ArchivedState {
                record,
                snapshot: (*snapshot).clone().sharing(None),
            });
        }
        states
    }

    /// The state shown.
    pub fn shown(&self) -> Option<&World> {
        self.states.first().map(|state| state.snapshot.world())
    }

    /// Whether all that it refers to is there.
    pub fn is_whole(&self) -> bool {
        let turns = self.undo.iter().chain(&self.redo);
        let of_turns = turns.filter_map(|turn| match turn.destination {
            ArchivedDestination::Other { record, .. } => Some(record),
            ArchivedDestination::Earlier { .. } => None,
        });
        let of_states = self.states.iter().map(|state| state.record);
        let mut named = self.kept.iter().copied().chain(of_turns).chain(of_states);
        self.states.first().is_some_and(|shown| shown.record == 0)
            && named.all(|record| record < self.records.len())
    }
}

/// Gives every run its index, the present one 0.
pub struct Table<'a> {
    present: &'a Record,
    others: Vec<Arc<Record>>,
}

impl<'a> Table<'a> {
    /// With the present run alone.
    pub fn of(present: &'a Record) -> Self {
        Self {
            present,
            others: Vec::new(),
        }
    }

    /// The index of `record`.
    pub fn index(&mut self, record: &Arc<Record>) -> usize {
        let known = self
            .others
            .iter()
            .position(|other| Arc::ptr_eq(other, record));
        1 + known.unwrap_or_else(|| {
            self.others.push(record.clone());
            self.others.len() - 1
        })
    }

    /// The runs, each at its index.
    pub fn records(self) -> Vec<Record> {
        let others = self.others.iter().map(|record| (**record).clone());
        [self.present.clone()].into_iter().chain(others).collect()
    }
}
