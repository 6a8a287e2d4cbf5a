//! A timeline as a file can keep it: every branch once, however often it is referred to, and the
//! states it takes to go on without computing them again.
//!
//! In: what a [`super::Timeline`] holds. Out: an [`Archive`], which postcard turns into bytes.
//! Shapes of polyhedra, which never change, are kept with the bed alone. Files are read and written
//! by [`super::Session`].

use super::Snapshot;
use super::branch::Branch;
use super::branch_names::BranchNames;
use super::history::Moment;
use super::meetings::Meeting;
use super::sampling::Sampling;
use super::undo::{Changed, Destination, UndoEntry};
use crate::world::World;
use glam::Quat;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Most memory that states other than the one shown take [bytes]: without them, ends of branches
/// are computed again.
const MOST_STATES: usize = 64 << 20;

/// All that a timeline is.
#[derive(Clone, Serialize, Deserialize)]
pub struct Archive {
    /// The state at time zero, before any command.
    pub bed: World,
    /// Every branch that is still known; the first is the present one.
    pub branches: Vec<Branch>,
    /// States of them; the first is the one shown.
    pub states: Vec<ArchivedState>,
    /// Branches kept beside the present one, by index.
    pub kept: Vec<usize>,
    /// Changes that can be taken back.
    pub undo: Vec<ArchivedEntry>,
    /// Changes that were taken back.
    pub redo: Vec<ArchivedEntry>,
    /// Branches begun so far.
    pub begun: u32,
    /// What people called branches; it stands apart in a file.
    #[serde(skip)]
    pub names: BranchNames,
}

/// A state of the branch of this index.
#[derive(Clone, Serialize, Deserialize)]
pub struct ArchivedState {
    pub branch: usize,
    pub snapshot: Snapshot,
}

/// A change that was made or taken back.
#[derive(Clone, Serialize, Deserialize)]
pub struct ArchivedEntry {
    pub what: Changed,
    pub destination: ArchivedDestination,
}

/// Where the other side of a change lies.
#[derive(Clone, Serialize, Deserialize)]
pub enum ArchivedDestination {
    /// Earlier in the present branch.
    Earlier { commands: usize, moment: Moment },
    /// A step of the branch of this index.
    Other { branch: usize, step: u64 },
}

impl ArchivedEntry {
    /// `entry` with the branch it leads to by its index in `table`.
    pub fn of(entry: &UndoEntry, table: &mut Table) -> Self {
        let destination = match &entry.destination {
            Destination::Earlier { commands, moment } => ArchivedDestination::Earlier {
                commands: *commands,
                moment: *moment,
            },
            Destination::Other { branch, step } => ArchivedDestination::Other {
                branch: table.index(branch),
                step: *step,
            },
        };
        Self {
            what: entry.what.clone(),
            destination,
        }
    }

    /// The entry again, with the branch it leads to out of `branches`; none where there is no such
    /// branch.
    pub fn unpack(self, branches: &[Arc<Branch>]) -> Option<UndoEntry> {
        let destination = match self.destination {
            ArchivedDestination::Earlier { commands, moment } => {
                Destination::Earlier { commands, moment }
            }
            ArchivedDestination::Other { branch, step } => Destination::Other {
                branch: branches.get(branch)?.clone(),
                step,
            },
        };
        Some(UndoEntry {
            what: self.what,
            destination,
        })
    }
}

impl Archive {
    /// The states to keep: the one `shown`, then as many `ends` of branches as there is room for.
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
        for (branch, snapshot) in ends {
            let is_shown = branch == 0 && (snapshot.step(), snapshot.commands()) == at;
            let memory = snapshot.memory();
            if is_shown || memory > room {
                continue;
            }
            room -= memory;
            states.push(ArchivedState {
                branch,
                snapshot: (*snapshot).clone().sharing(None),
            });
        }
        states
    }

    /// The state shown, with the shapes of its polyhedra, which the archive keeps once.
    pub fn shown(&self) -> Option<World> {
        let shown = self.states.first()?.snapshot.clone();
        Some(shown.sharing(Some(&self.bed)).world().clone())
    }

    /// How samples are taken from each state on, as far as the state's grid does not say it.
    pub fn samplings(&self) -> impl Iterator<Item = Sampling> {
        self.states.iter().map(|state| state.snapshot.sampling)
    }

    /// Takes samples from each state on as the `samplings` say, as many as there are.
    pub fn set_samplings(&mut self, samplings: &[Sampling]) {
        for (state, sampling) in self.states.iter_mut().zip(samplings) {
            state.snapshot.sampling = *sampling;
        }
    }

    /// The meetings in each branch.
    pub fn meetings(&self) -> impl Iterator<Item = &[Meeting]> {
        self.branches
            .iter()
            .map(|branch| branch.meetings.as_slice())
    }

    /// Gives each branch its `meetings`, as many as there are.
    pub fn set_meetings(&mut self, meetings: Vec<Vec<Meeting>>) {
        for (branch, meetings) in self.branches.iter_mut().zip(meetings) {
            branch.meetings = Arc::new(meetings);
        }
    }

    /// How far spheres have turned in each state, nothing where that is not known.
    pub fn orientations(&self) -> impl Iterator<Item = Vec<Quat>> {
        let turned = |state: &ArchivedState| state.snapshot.turned.as_deref().map(<[Quat]>::to_vec);
        self.states
            .iter()
            .map(move |state| turned(state).unwrap_or_default())
    }

    /// Turns the spheres of each state so, as far as there are `orientations` of all its grains.
    pub fn set_orientations(&mut self, orientations: Vec<Vec<Quat>>) {
        for (state, turned) in self.states.iter_mut().zip(orientations) {
            let is_rotation = |turn: &Quat| turn.is_finite() && turn.length_squared() > 0.5;
            let fits = turned.len() == state.snapshot.world.grains.len();
            let is_known = fits && !turned.is_empty() && turned.iter().all(is_rotation);
            state.snapshot.turned = is_known.then(|| turned.into());
        }
    }

    /// Whether all that it refers to is there.
    pub fn is_whole(&self) -> bool {
        let entries = self.undo.iter().chain(&self.redo);
        let of_entries = entries.filter_map(|entry| match entry.destination {
            ArchivedDestination::Other { branch, .. } => Some(branch),
            ArchivedDestination::Earlier { .. } => None,
        });
        let of_states = self.states.iter().map(|state| state.branch);
        let mut named = self.kept.iter().copied().chain(of_entries).chain(of_states);
        self.states.first().is_some_and(|shown| shown.branch == 0)
            && named.all(|branch| branch < self.branches.len())
    }
}

/// Gives every branch its index, the present one 0.
pub struct Table<'a> {
    present: &'a Branch,
    others: Vec<Arc<Branch>>,
}

impl<'a> Table<'a> {
    /// With the present branch alone.
    pub fn of(present: &'a Branch) -> Self {
        Self {
            present,
            others: Vec::new(),
        }
    }

    /// The index of `branch`.
    pub fn index(&mut self, branch: &Arc<Branch>) -> usize {
        let known = self
            .others
            .iter()
            .position(|other| Arc::ptr_eq(other, branch));
        1 + known.unwrap_or_else(|| {
            self.others.push(branch.clone());
            self.others.len() - 1
        })
    }

    /// The branches, each at its index.
    pub fn branches(self) -> Vec<Branch> {
        let others = self.others.iter().map(|branch| (**branch).clone());
        [self.present.clone()].into_iter().chain(others).collect()
    }
}
