//! A branch: one run among all that were begun from the same bed, as it is known from time zero to
//! its end so far.
//!
//! In: changes and samples, as a run makes and takes them. Out: a [`Branch`], which can be kept,
//! shown again, cut off at an earlier moment to begin another, and put into a file. It holds no
//! state: see [`super::keyframes`].

use super::Script;
use super::history::{History, Moment, Position};
use super::meetings::Meeting;
use crate::measure::{FlowHistory, Series};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// All that is known of a run from time zero to its end so far. What grows is shared: a copy is
/// cheap, and the first sample that is added while a copy is about copies the samples before it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Branch {
    /// Which of all branches it is, counted from 1.
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
    /// Contacts and bridges of few grains that began and ended; they stand apart in a file.
    #[serde(skip)]
    pub meetings: Arc<Vec<Meeting>>,
    /// Its last step so far.
    pub end: Moment,
    /// Commands that were given beforehand; those after the end are still to come.
    pub plan: Script,
}

impl Branch {
    /// One of this `number` that is at time zero, with nothing changed or measured.
    pub fn begin(number: u32) -> Self {
        Self {
            number,
            ..Self::default()
        }
    }

    /// The beginning of another branch, of this `number`: this one up to `end`, where its first
    /// `commands` were carried out.
    #[must_use]
    pub fn until(&self, commands: usize, end: Moment, number: u32) -> Self {
        let mut branch = self.clone();
        branch.number = number;
        branch.end = end;
        if commands < branch.history.commands().len() {
            Arc::make_mut(&mut branch.history).truncate(commands);
        }
        let samples = (branch.series.steps()).partition_point(|step| *step <= end.step);
        if samples < branch.series.len() {
            let mut series = Series::default();
            series.copy_first(&branch.series, samples);
            branch.series = Arc::new(series);
        }
        let is_past = |meeting: &Meeting| meeting.step <= end.step;
        let meetings = branch.meetings.partition_point(is_past);
        if meetings < branch.meetings.len() {
            Arc::make_mut(&mut branch.meetings).truncate(meetings);
        }
        branch
    }

    /// The position of its end.
    pub fn end_position(&self) -> Position {
        let commands = self.history.commands().len();
        self.history.position(commands, self.end.step)
    }

    /// Whether all of it is also part of `other`.
    pub fn is_part_of(&self, other: &Self) -> bool {
        self.end.step <= other.end.step && other.history.passes(&self.end_position())
    }

    /// Whether it stands at its start and nothing was changed.
    pub fn is_fresh(&self) -> bool {
        self.end.step == 0 && self.history.commands().is_empty()
    }

    /// Whether the run went on after its last change.
    pub fn went_on(&self) -> bool {
        let last = self.history.commands().last().map_or(0, |last| last.step);
        self.end.step > last
    }

    /// What is still to be carried out after the first `commands`, if the run goes on beyond the
    /// branch's end, and how many of these commands are the branch's own.
    pub fn rest(&self, commands: usize) -> (Script, usize) {
        let all = self.history.commands();
        let recorded = &all[commands.min(all.len())..];
        let script = Script::again(recorded, &self.plan, self.end.step);
        (script, recorded.len())
    }
}
