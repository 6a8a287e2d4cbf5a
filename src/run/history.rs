//! The changes that were made to a run, in order, and where a state lies among them.
//!
//! In: commands, each with the step before which it was carried out. Out: a [`History`] that tells
//! one run from another. A scene's trajectory is fixed by its changes, so two states at the same
//! [`Position`] have the same bits. What was measured is not here: see [`super::branch`].

use super::StampedCommand;
use crate::world::World;
use serde::{Deserialize, Serialize};

/// The changes of a run, in order.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(into = "SavedChanges", from = "SavedChanges")]
pub struct History {
    commands: Vec<StampedCommand>,
    /// For each command a hash of it and of all before it.
    keys: Vec<blake3::Hash>,
    /// Index of the first command of each change: a drag or a button may take several.
    changes: Vec<usize>,
}

/// A history in a file: each command, and whether it is part of the change before it.
#[derive(Serialize, Deserialize)]
struct SavedChanges(Vec<(StampedCommand, bool)>);

impl From<History> for SavedChanges {
    fn from(history: History) -> Self {
        let first = |index| history.changes.contains(&index);
        let commands = history.commands.iter().cloned().enumerate();
        Self(
            commands
                .map(|(index, command)| (command, !first(index)))
                .collect(),
        )
    }
}

impl From<SavedChanges> for History {
    fn from(changes: SavedChanges) -> Self {
        let mut history = Self::default();
        for (command, joins) in changes.0 {
            history.push(command, joins);
        }
        history
    }
}

impl FromIterator<StampedCommand> for History {
    /// Every command as a change of its own.
    fn from_iter<I: IntoIterator<Item = StampedCommand>>(commands: I) -> Self {
        let changes = commands.into_iter().map(|command| (command, false));
        SavedChanges(changes.collect()).into()
    }
}

/// Where a state lies: after how many commands of which history, at which step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    commands: usize,
    key: blake3::Hash,
    step: u64,
}

impl Position {
    /// Steps taken there.
    pub fn step(&self) -> u64 {
        self.step
    }
}

/// A step and its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Steps taken.
    pub step: u64,
    /// Simulated time [s].
    pub time: f64,
}

impl Moment {
    /// The moment of the state `world`.
    pub fn of(world: &World) -> Self {
        Self {
            step: world.clock.step,
            time: world.time(),
        }
    }
}

impl History {
    /// The commands carried out, in order.
    pub fn commands(&self) -> &[StampedCommand] {
        &self.commands
    }

    /// Index of the first command of each change.
    pub fn changes(&self) -> &[usize] {
        &self.changes
    }

    /// The commands of each change, in order.
    pub fn each_change(&self) -> impl Iterator<Item = &[StampedCommand]> {
        let ends = self.changes.iter().skip(1).copied();
        let ends = ends.chain([self.commands.len()]);
        let spans = self.changes.iter().copied().zip(ends);
        spans.filter_map(|(first, end)| self.commands.get(first..end))
    }

    /// Adds `command`, which is part of the change before it where it `joins`.
    pub fn push(&mut self, command: StampedCommand, joins: bool) {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.key(self.commands.len()).as_bytes());
        hasher.update(&command.step.to_le_bytes());
        // Numbers are written here with as many digits as it takes to tell them apart.
        hasher.update(format!("{:?}", command.command).as_bytes());
        if !joins || self.changes.is_empty() {
            self.changes.push(self.commands.len());
        }
        self.keys.push(hasher.finalize());
        self.commands.push(command);
    }

    /// Forgets all but the first `commands`.
    pub fn truncate(&mut self, commands: usize) {
        self.commands.truncate(commands);
        self.keys.truncate(commands);
        self.changes.retain(|first| *first < commands);
    }

    /// The position after the first `commands`, at `step`.
    pub fn position(&self, commands: usize, step: u64) -> Position {
        Position {
            commands,
            key: self.key(commands),
            step,
        }
    }

    /// Whether a run with this history comes through `position`, if it goes on long enough.
    pub fn passes(&self, position: &Position) -> bool {
        let next = self.commands.get(position.commands);
        position.commands <= self.commands.len()
            && self.key(position.commands) == position.key
            && next.is_none_or(|next| next.step >= position.step)
    }

    fn key(&self, commands: usize) -> blake3::Hash {
        let last = commands.checked_sub(1).and_then(|last| self.keys.get(last));
        last.copied()
            .unwrap_or(blake3::Hash::from_bytes([0; blake3::OUT_LEN]))
    }
}
