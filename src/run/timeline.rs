//! Runs as something to hold: go back, look, change something and run on, take it back.
//!
//! In: steps to go to and changes to make. Out: the run at that step, and the records of all runs there have been. A moment
//! is come back to from the keyframe before it by computing again what followed, commands included: the same bits. A
//! change made while an earlier moment is shown begins another run; the one that is left is kept beside it.

use super::archive::{Archive, ArchivedDestination, ArchivedState, ArchivedTurn, Table};
use super::history::{Moment, Place, Record};
use super::keyframes::Keyframes;
use super::{Command, CommandError, Parameter, Run, Script, Snapshot};
use crate::scene::Scene;
use crate::solver::{Fault, Profile};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::time::Instant;

/// Most changes that can be taken back.
const MOST_UNDONE: usize = 200;
/// Most runs kept beside the present one.
const MOST_KEPT: usize = 8;

/// The present run with all that came before it.
pub struct Timeline {
    run: Run,
    record: Record,
    keyframes: Keyframes,
    kept: Vec<Arc<Record>>,
    undo: Vec<Turn>,
    redo: Vec<Turn>,
    journey: Option<Journey>,
    news: News,
    /// Runs begun so far.
    begun: u32,
}

/// On the way to a moment: steps at which it began and will end.
#[derive(Clone, Copy, Debug)]
struct Journey {
    from: u64,
    to: u64,
}

/// A change that was made or taken back: what it was, and where to go for the other side of it.
struct Turn {
    what: Changed,
    destination: Destination,
}

enum Destination {
    /// Earlier in the present run: after its first commands, at a moment.
    Earlier { commands: usize, moment: Moment },
    /// A step of another run.
    Other { record: Arc<Record>, step: u64 },
}

/// What a change was about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Changed {
    /// One parameter.
    Parameter(Parameter),
    /// Several at once.
    Parameters,
    /// The run started afresh.
    Start,
    /// Another of the kept runs was taken up.
    Run,
}

/// What came about since it was last asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct News {
    /// Another run is the present one.
    pub switched: bool,
    /// The state is one that a person asked to see: the nearest keyframe or the end of the way.
    pub arrived: bool,
}

/// What lies behind and ahead of the state shown.
#[derive(Clone, Debug, Default)]
pub struct Past {
    /// Which of all runs the present one is, counted from 1.
    pub number: u32,
    /// The last moment of the present run so far.
    pub end: Moment,
    /// What an undo would take back.
    pub undo: Option<Changed>,
    /// What a redo would bring back.
    pub redo: Option<Changed>,
    /// Runs that were left for others, the oldest first.
    pub kept: Vec<Arc<Record>>,
    /// Memory that keyframes take [bytes].
    pub memory: usize,
}

impl Turn {
    fn archive(&self, table: &mut Table) -> ArchivedTurn {
        let destination = match &self.destination {
            Destination::Earlier { commands, moment } => ArchivedDestination::Earlier {
                commands: *commands,
                moment: *moment,
            },
            Destination::Other { record, step } => ArchivedDestination::Other {
                record: table.index(record),
                step: *step,
            },
        };
        ArchivedTurn {
            what: self.what.clone(),
            destination,
        }
    }

    fn unpack(archived: ArchivedTurn, records: &[Arc<Record>]) -> Option<Self> {
        let destination = match archived.destination {
            ArchivedDestination::Earlier { commands, moment } => {
                Destination::Earlier { commands, moment }
            }
            ArchivedDestination::Other { record, step } => Destination::Other {
                record: records.get(record)?.clone(),
                step,
            },
        };
        Some(Self {
            what: archived.what,
            destination,
        })
    }
}

impl Timeline {
    /// The timeline of `run`, which is at its end, with keyframes in `budget` bytes.
    pub fn new(run: Run, budget: usize) -> Self {
        Self {
            record: Record::of(&run, 1),
            run,
            keyframes: Keyframes::new(budget),
            kept: Vec::new(),
            undo: Vec::new(),
            redo: Vec::new(),
            journey: None,
            news: News::default(),
            begun: 1,
        }
    }

    /// All of it, as a file can keep it.
    pub fn archive(&self) -> Archive {
        let mut table = Table::of(&self.record);
        let kept = self.kept.iter().map(|record| table.index(record)).collect();
        let mut turns =
            |turns: &[Turn]| turns.iter().map(|turn| turn.archive(&mut table)).collect();
        let (undo, redo) = (turns(&self.undo), turns(&self.redo));
        let records = table.records();
        let shown = ArchivedState {
            record: 0,
            snapshot: self.run.snapshot(),
        };
        let ends = records.iter().enumerate().filter_map(|(record, known)| {
            let snapshot = self.keyframes.nearest(&known.history, known.end.step)?;
            let is_end = snapshot.step() == known.end.step;
            is_end.then(|| (record, snapshot.clone()))
        });
        let states = Archive::states(shown, ends);
        Archive {
            bed: (**self.run.bed()).clone(),
            states,
            kept,
            undo,
            redo,
            begun: self.begun,
            records,
        }
    }

    /// The timeline of `scene` that was put into `archive`, on `threads` threads, with keyframes in `budget` bytes.
    pub fn unpack(archive: Archive, scene: Arc<Scene>, threads: usize, budget: usize) -> Self {
        let records: Vec<Arc<Record>> = archive.records.into_iter().map(Arc::new).collect();
        let turn = |turn| Turn::unpack(turn, &records);
        let mut timeline = Self {
            record: records
                .first()
                .map(|first| (**first).clone())
                .unwrap_or_default(),
            kept: (archive.kept.iter())
                .filter_map(|index| records.get(*index).cloned())
                .collect(),
            undo: archive.undo.into_iter().filter_map(turn).collect(),
            redo: archive.redo.into_iter().filter_map(turn).collect(),
            run: Run::new(scene, archive.bed, threads),
            keyframes: Keyframes::new(budget),
            journey: None,
            news: News {
                switched: true,
                arrived: true,
            },
            begun: archive.begun,
        };
        let bed = timeline.run.bed().clone();
        for (index, state) in archive.states.into_iter().enumerate() {
            let snapshot = state.snapshot.sharing(Some(&bed));
            if index == 0 {
                let record = &timeline.record;
                (timeline.run).restore(&snapshot, record.history.commands(), &record.series);
            }
            if let Some(record) = records.get(state.record) {
                let place = record.history.place(snapshot.commands(), snapshot.step());
                timeline.keyframes.keep(place, || snapshot);
            }
        }
        timeline.follow_record();
        timeline
    }

    /// Commands to carry out by themselves when their steps come.
    ///
    /// # Errors
    /// As [`Run::schedule`].
    pub fn schedule(&mut self, plan: Script) -> Result<(), CommandError> {
        self.run.schedule(plan.clone())?;
        self.record.plan = plan;
        self.record.follow(&self.run, true);
        Ok(())
    }

    /// The run at the moment shown.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// The present run as far as it has come.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// Steps taken and commands carried out at the moment shown.
    pub(crate) fn position(&self) -> (u64, usize) {
        (self.step(), self.run.commands().len())
    }

    /// The state at the end of the present run, where that is at hand.
    pub(crate) fn end(&self) -> Option<Snapshot> {
        if self.is_at_end() {
            return Some(self.run.snapshot());
        }
        let (history, end) = (&self.record.history, self.record.end.step);
        let nearest = self.keyframes.nearest(history, end)?;
        (nearest.step() == end).then(|| (**nearest).clone())
    }

    /// Runs that were left for others, the oldest first.
    pub fn kept(&self) -> &[Arc<Record>] {
        &self.kept
    }

    /// What lies behind and ahead.
    pub fn past(&self) -> Past {
        let what = |turns: &[Turn]| turns.last().map(|turn| turn.what.clone());
        Past {
            number: self.record.number,
            end: self.record.end,
            undo: what(&self.undo),
            redo: what(&self.redo),
            kept: self.kept.clone(),
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
        self.journey.map_or(1.0, |Journey { from, to }| {
            let done = self.step().saturating_sub(from);
            done as f32 / (to - from).max(1) as f32
        })
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
        if self.is_at_end() {
            self.record.follow(&self.run, false);
        }
        let there = |journey: &Journey| self.step() >= journey.to;
        if self.journey.as_ref().is_some_and(there) || outcome.is_err() {
            self.stop();
        }
        outcome
    }

    /// Goes ahead in what was recorded, to the last keyframe at or before `step`: for those who want to see it faster than
    /// it can be computed.
    pub fn skip_towards(&mut self, step: u64) {
        let step = step.min(self.record.end.step);
        let ahead = self.keyframes.nearest(&self.record.history, step);
        if let Some(snapshot) = ahead
            .filter(|snapshot| snapshot.step() > self.step())
            .cloned()
        {
            let commands = self.record.history.commands();
            self.run.restore(&snapshot, commands, &self.record.series);
            self.follow_record();
        }
    }

    /// Goes to `step` of the present run, at most to its end.
    pub fn seek(&mut self, step: u64) {
        let here = self.place();
        self.keep_end();
        self.travel(here, step.min(self.record.end.step));
    }

    /// Carries out `command` at the moment shown. In the past this begins another run and keeps the one that is left. It is
    /// part of the change before it where it `joins`.
    ///
    /// # Errors
    /// As [`Run::apply`].
    pub fn change(&mut self, command: Command, joins: bool) -> Result<(), CommandError> {
        self.change_by(command, joins, Run::apply)
    }

    /// The same in one of two runs that keep one time: the step stays.
    ///
    /// # Errors
    /// As [`Run::apply`].
    pub(crate) fn change_in_pair(
        &mut self,
        command: Command,
        joins: bool,
    ) -> Result<(), CommandError> {
        self.change_by(command, joins, Run::apply_at_this_step)
    }

    fn change_by(
        &mut self,
        command: Command,
        joins: bool,
        apply: fn(&mut Run, Command) -> Result<(), CommandError>,
    ) -> Result<(), CommandError> {
        self.run.check(&command)?;
        let Command::Set { parameter, .. } = &command else {
            return Ok(());
        };
        let joins = self.begin_change(parameter, joins);
        apply(&mut self.run, command)?;
        self.record.follow(&self.run, joins);
        Ok(())
    }

    /// Notes that `command` was carried out in the run beside this one and not here: an undo takes it back in both, and
    /// where it was made in the past both go on from there.
    ///
    /// # Errors
    /// As [`Timeline::change`].
    pub(crate) fn note_beside(
        &mut self,
        command: &Command,
        joins: bool,
    ) -> Result<(), CommandError> {
        self.run.check(command)?;
        if let Command::Set { parameter, .. } = command {
            self.begin_change(parameter, joins);
        }
        Ok(())
    }

    /// Makes a change of `parameter` one that can be taken back; whether it is part of the one before it.
    fn begin_change(&mut self, parameter: &Parameter, joins: bool) -> bool {
        self.stop();
        let what = Changed::Parameter(parameter.clone());
        let moment = Moment::of(&self.run);
        let joins = joins && self.is_at_end() && !self.undo.is_empty() && self.redo.is_empty();
        if joins {
            self.join(what);
        } else {
            self.keep_end();
            let destination = if self.is_at_end() {
                let commands = self.run.commands().len();
                Destination::Earlier { commands, moment }
            } else {
                let record = self.branch();
                Destination::Other {
                    record,
                    step: moment.step,
                }
            };
            self.turn(Turn { what, destination });
        }
        joins
    }

    /// Starts afresh at time zero with the present values, keeping the run that is left.
    pub fn reset(&mut self) {
        self.start_afresh(Run::reset);
    }

    /// Starts afresh at time zero with these `values`, keeping the run that is left.
    pub(crate) fn restart(&mut self, values: &[(Parameter, f64)]) {
        self.start_afresh(|run| run.restart_with(values));
    }

    fn start_afresh(&mut self, start: impl FnOnce(&mut Run)) {
        self.stop();
        self.keep_end();
        let step = self.step();
        start(&mut self.run);
        let number = self.next_number();
        let left = self.switch(Record::of(&self.run, number));
        // A run that had only just begun is nothing to come back to.
        if !left.is_fresh() {
            let destination = Destination::Other { record: left, step };
            self.turn(Turn {
                what: Changed::Start,
                destination,
            });
        }
    }

    /// Takes the last change back: goes to its moment, as if it had not been made.
    pub fn undo(&mut self) {
        if let Some(turn) = self.undo.pop() {
            let back = self.go(turn);
            self.redo.push(back);
        }
    }

    /// Brings the last change that was taken back to where it was.
    pub fn redo(&mut self) {
        if let Some(turn) = self.redo.pop() {
            let back = self.go(turn);
            self.undo.push(back);
        }
    }

    /// Shows the end of the kept run of `index`, if there is one, and keeps the present run.
    pub fn take_up(&mut self, index: usize) {
        if let Some(record) = self.kept.get(index).cloned() {
            let step = record.end.step;
            let back = self.go(Turn {
                what: Changed::Run,
                destination: Destination::Other { record, step },
            });
            self.turn(back);
        }
    }

    /// Keeps the run of `record`, which began from the same bed, beside the present one, with the state at its `end`
    /// where that is known; returns its index.
    pub(crate) fn adopt(&mut self, mut record: Record, end: Option<Snapshot>) -> usize {
        record.number = self.next_number();
        if let Some(end) = end {
            let place = record.history.place(end.commands(), end.step());
            self.keyframes.keep(place, || end);
        }
        self.kept.push(Arc::new(record));
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
        self.kept.len() - 1
    }

    /// Goes on with `threads` threads.
    pub(crate) fn use_threads(&mut self, threads: usize) {
        self.run.use_threads(threads);
    }

    /// Keeps the run of `index` no longer.
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

    fn is_at_end(&self) -> bool {
        self.step() >= self.record.end.step
            && self.run.commands().len() >= self.record.history.commands().len()
    }

    fn place(&self) -> Place {
        (self.record.history).place(self.run.commands().len(), self.step())
    }

    fn keep_keyframe(&mut self) {
        let place = self.place();
        self.keyframes.keep(place, || self.run.snapshot());
    }

    /// Keeps the end of the present run where that is shown, so that it can be come back to at once.
    fn keep_end(&mut self) {
        if self.is_at_end() {
            self.keep_keyframe();
        }
    }

    /// Notes a change that was made; what was taken back before is out of reach of a redo.
    fn turn(&mut self, turn: Turn) {
        self.redo.clear();
        self.undo.push(turn);
        if self.undo.len() > MOST_UNDONE {
            self.undo.remove(0);
        }
    }

    /// Makes a command about `what` part of the last change.
    fn join(&mut self, what: Changed) {
        if let Some(last) = self.undo.last_mut()
            && last.what != what
        {
            last.what = Changed::Parameters;
        }
    }

    /// Leaves the present run for one that has its past until now; returns the one that is left.
    fn branch(&mut self) -> Arc<Record> {
        let number = self.next_number();
        let commands = self.run.commands().len();
        let mut record = (self.record).until(commands, Moment::of(&self.run), number);
        record.flow.clone_from(self.run.flow());
        let left = self.switch(record);
        self.follow_record();
        left
    }

    /// Makes `record` the present one and returns the one that is left, which is kept where it holds more.
    fn switch(&mut self, record: Record) -> Arc<Record> {
        let left = Arc::new(std::mem::replace(&mut self.record, record));
        self.kept.push(left.clone());
        let (present, newest) = (&self.record, self.kept.len() - 1);
        let rivals = self.kept.clone();
        let mut index = 0;
        self.kept.retain(|kept| {
            let own = index;
            index += 1;
            let contained = |other: &Arc<Record>| kept.is_part_of(other);
            let in_newest = own != newest && rivals.last().is_some_and(contained);
            kept.went_on() && !kept.is_part_of(present) && !in_newest
        });
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
        self.news.switched = true;
        left
    }

    /// Goes where `turn` leads; returns the turn that leads back.
    fn go(&mut self, turn: Turn) -> Turn {
        let here = self.place();
        self.keep_end();
        let (record, step) = match turn.destination {
            Destination::Earlier { commands, moment } => {
                let number = self.next_number();
                (self.record.until(commands, moment, number), moment.step)
            }
            Destination::Other { record, step } => ((*record).clone(), step),
        };
        let left = self.switch(record);
        self.travel(here, step);
        Turn {
            what: turn.what,
            destination: Destination::Other {
                record: left,
                step: here.step(),
            },
        }
    }

    /// Sets out from `here` for `step` of the present run: from the nearest keyframe, where that is nearer.
    fn travel(&mut self, here: Place, step: u64) {
        let history = &self.record.history;
        let start = self.keyframes.nearest(history, step).cloned();
        let passes = here.step() <= step && history.passes(&here);
        let nearer = start
            .as_ref()
            .is_none_or(|start| start.step() <= here.step());
        match start {
            _ if passes && nearer => {}
            Some(snapshot) => {
                self.run
                    .restore(&snapshot, history.commands(), &self.record.series);
                self.keyframes.restart();
            }
            None => {
                self.run.restart();
                self.keyframes.restart();
            }
        }
        self.follow_record();
        let from = self.step();
        self.journey = Some(Journey { from, to: step });
        self.news.arrived = true;
        if from >= step {
            self.stop();
        }
    }

    /// Lets the run go on as the record says and, after its end, as was planned.
    fn follow_record(&mut self) {
        let (rest, recorded) = self.record.rest(self.run.commands().len());
        self.run.follow(rest, recorded);
    }
}
