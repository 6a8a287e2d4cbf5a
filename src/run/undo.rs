//! What can be taken back and brought back, and where each leads.
//!
//! In: changes as they are made. Out: the entry to undo or to redo next. Going there is the
//! timeline's work.

use super::Parameter;
use super::branch::Branch;
use super::history::Moment;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Most changes that can be taken back.
const MOST_UNDONE: usize = 200;

/// What a change was about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Changed {
    /// One parameter.
    Parameter(Parameter),
    /// Several at once.
    Parameters,
    /// The run started afresh.
    Start,
    /// Another branch was taken up.
    Run,
}

/// A change that was made or taken back: what it was, and where to go for the other side of it.
pub struct UndoEntry {
    pub what: Changed,
    pub destination: Destination,
}

/// Where the other side of a change lies.
pub enum Destination {
    /// Earlier in the present branch: after its first commands, at a moment.
    Earlier { commands: usize, moment: Moment },
    /// A step of another branch.
    Other { branch: Arc<Branch>, step: u64 },
}

/// The changes that can be taken back, and those that were, each in the order in which they were
/// made.
#[derive(Default)]
pub struct UndoList {
    pub undo: Vec<UndoEntry>,
    pub redo: Vec<UndoEntry>,
}

impl UndoList {
    /// Notes a change that was made; what was taken back before is out of reach of a redo.
    pub fn note(&mut self, entry: UndoEntry) {
        self.redo.clear();
        self.undo.push(entry);
        if self.undo.len() > MOST_UNDONE {
            self.undo.remove(0);
        }
    }

    /// Whether a change now can be part of the last one.
    pub fn can_join(&self) -> bool {
        !self.undo.is_empty() && self.redo.is_empty()
    }

    /// Makes a command about `what` part of the last change.
    pub fn join(&mut self, what: Changed) {
        if let Some(last) = self.undo.last_mut()
            && last.what != what
        {
            last.what = Changed::Parameters;
        }
    }

    /// The other branches that entries lead to.
    pub fn branches(&self) -> impl Iterator<Item = &Branch> {
        let entries = self.undo.iter().chain(&self.redo);
        entries.filter_map(|entry| match &entry.destination {
            Destination::Other { branch, .. } => Some(&**branch),
            Destination::Earlier { .. } => None,
        })
    }

    /// What an undo would take back.
    pub fn next_undo(&self) -> Option<&Changed> {
        self.undo.last().map(|entry| &entry.what)
    }

    /// What a redo would bring back.
    pub fn next_redo(&self) -> Option<&Changed> {
        self.redo.last().map(|entry| &entry.what)
    }
}
