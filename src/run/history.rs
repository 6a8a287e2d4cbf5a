//! What a run was: the changes made to it, in order, and what was measured.
//!
//! The trajectory of a scene is fixed by the changes that were made, each before its step. So a [`History`] tells one run
//! from another, and a [`Place`] says where a state lies among all runs there have been: the same place, the same bits.

use super::{Run, Script, StampedCommand};
use crate::measure::{FlowHistory, Series};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The changes of a run, in order.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(into = "Changes", from = "Changes")]
pub struct History {
    commands: Vec<StampedCommand>,
    /// For each command a hash of it and of all before it.
    keys: Vec<blake3::Hash>,
    /// Index of the first command of each change: a drag or a button may take several.
    changes: Vec<usize>,
}

/// A history in a file: each command, and whether it is part of the change before it.
#[derive(Serialize, Deserialize)]
struct Changes(Vec<(StampedCommand, bool)>);

impl From<History> for Changes {
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

impl From<Changes> for History {
    fn from(changes: Changes) -> Self {
        let mut history = Self::default();
        for (command, joins) in changes.0 {
            history.push(command, joins);
        }
        history
    }
}

/// Where a state lies: after how many commands of which history, at which step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    commands: usize,
    key: blake3::Hash,
    step: u64,
}

impl Place {
    /// Steps taken there.
    pub fn step(&self) -> u64 {
        self.step
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

    /// Adds `command`, which is part of the change before it where it `joins`.
    pub fn push(&mut self, command: StampedCommand, joins: bool) {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.key(self.commands.len()).as_bytes());
        let entry = (command.step, &command.command);
        hasher.update(&postcard::to_stdvec(&entry).unwrap_or_default());
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

    /// The place after the first `commands`, at `step`.
    pub fn place(&self, commands: usize, step: u64) -> Place {
        Place {
            commands,
            key: self.key(commands),
            step,
        }
    }

    /// Whether a run with this history comes through `place`, if it goes on long enough.
    pub fn passes(&self, place: &Place) -> bool {
        let next = self.commands.get(place.commands);
        place.commands <= self.commands.len()
            && self.key(place.commands) == place.key
            && next.is_none_or(|next| next.step >= place.step)
    }

    fn key(&self, commands: usize) -> blake3::Hash {
        let last = commands.checked_sub(1).and_then(|last| self.keys.get(last));
        last.copied()
            .unwrap_or(blake3::Hash::from_bytes([0; blake3::OUT_LEN]))
    }
}

/// All that is known of a run from time zero to its end so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Record {
    /// Which of all runs it is, counted from 1.
    pub number: u32,
    /// What was changed.
    #[serde(with = "super::shared")]
    pub history: Arc<History>,
    /// The samples taken.
    #[serde(with = "super::shared")]
    pub series: Arc<Series>,
    /// The flowing layer.
    #[serde(with = "super::shared")]
    pub flow: Arc<FlowHistory>,
    /// Its last step so far.
    pub end: Moment,
    /// Commands that were given beforehand; those after the end are still to come.
    pub plan: Script,
}

/// A step and its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Steps taken.
    pub step: u64,
    /// Simulated time [s].
    pub time: f64,
}

impl Record {
    /// The record of `run`, which is at its end, as the one of this `number`, all of its commands one change.
    pub fn of(run: &Run, number: u32) -> Self {
        let mut record = Self {
            number,
            ..Self::default()
        };
        record.follow(run, true);
        record
    }

    /// Takes in what is new of `run`, which is at the record's end or beyond; new commands are part of the last change
    /// where they `join`, and a step that followed its limit is part of the change that moved it.
    pub fn follow(&mut self, run: &Run, join: bool) {
        let known = self.history.commands.len();
        if run.commands().len() > known {
            let history = Arc::make_mut(&mut self.history);
            let mut before = None;
            for command in &run.commands()[known..] {
                let followed = command.command.is_of_time_step() && before == Some(command.step);
                before = Some(command.step);
                history.push(command.clone(), join || followed);
            }
        }
        let (samples, known) = (run.series(), self.series.len());
        if samples.len() > known {
            let series = Arc::make_mut(&mut self.series);
            for sample in (known..samples.len()).filter_map(|index| samples.get(index)) {
                series.push(sample);
            }
        }
        self.plan.keep_times(&run.world().clock);
        self.flow.clone_from(run.flow());
        self.end = Moment::of(run);
    }

    /// The beginning of another run, of this `number`: this record up to `end`, where its first `commands` were carried
    /// out.
    #[must_use]
    pub fn until(&self, commands: usize, end: Moment, number: u32) -> Self {
        let mut record = self.clone();
        record.number = number;
        Arc::make_mut(&mut record.history).truncate(commands);
        let samples = (record.series.steps()).partition_point(|step| *step <= end.step);
        Arc::make_mut(&mut record.series).truncate(samples);
        record.end = end;
        record
    }

    /// The place of its end.
    pub fn end_place(&self) -> Place {
        self.history
            .place(self.history.commands.len(), self.end.step)
    }

    /// Whether all of it is also part of `other`.
    pub fn is_part_of(&self, other: &Self) -> bool {
        self.end.step <= other.end.step && other.history.passes(&self.end_place())
    }

    /// Whether it stands at its start and nothing was changed.
    pub fn is_fresh(&self) -> bool {
        self.end.step == 0 && self.history.commands.is_empty()
    }

    /// Whether the run went on after its last change.
    pub fn went_on(&self) -> bool {
        let last = self.history.commands.last().map_or(0, |last| last.step);
        self.end.step > last
    }

    /// What is still to be carried out after the first `commands`, if the run goes on beyond the record's end, and how
    /// many of these are the record's.
    pub fn rest(&self, commands: usize) -> (Script, usize) {
        let recorded = &self.history.commands[commands.min(self.history.commands.len())..];
        let script = Script::again(recorded, &self.plan, self.end.step);
        (script, recorded.len())
    }
}

impl Moment {
    /// Where `run` is now.
    pub fn of(run: &Run) -> Self {
        Self {
            step: run.world().clock.step,
            time: run.world().time(),
        }
    }
}
