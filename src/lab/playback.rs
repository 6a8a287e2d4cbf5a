//! A recording that is played: which of its states is shown, and up to when.
//!
//! In: a [`Recording`], and steps to go to. Out: its states as they are, none between two of them:
//! until the next is due, the last one stays. A state is read when it is shown; of those shown
//! before, as many are kept as fit into the memory that was granted. Where its run is under way, what
//! that writes is taken up, and whoever looks at the last state follows it.

use super::clock::{LabClock, Mode};
use super::lab_command::LabCommand;
use super::update::{RecordedFlow, RunNews, RunsNews};
use crate::measure::MeanFlow;
use crate::recording::{
    FlowSurvey, Follower, Recording, RecordingFacts, RunNews as News, RunProgress,
};
use crate::run::{Command, CommandError, KeptMemory, Past, Sampling};
use crate::solver::Profile;
use crate::world::{self, World};
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;
use std::time::Duration;

/// Most states kept, however small they are.
const MOST_KEPT: usize = 256;

/// A recording that is played.
pub struct Playback {
    recording: Recording,
    /// Takes up what its run writes, where that is not over.
    follower: Option<Follower>,
    /// What is known of it, where that is news.
    facts: Option<RecordingFacts>,
    /// Measures the mean flow on the states, where that was asked for.
    survey: Option<FlowSurvey>,
    /// The mean flow.
    flow: Option<RecordedFlow>,
    /// The step that it has come to: that of a state, or one between two.
    reached: u64,
    /// The first state that can be read.
    start: Arc<World>,
    /// The state shown and its index.
    shown: (usize, Arc<World>),
    /// States read lately, the last one at the end.
    kept: VecDeque<(usize, Arc<World>)>,
    /// Memory for them [bytes].
    memory: usize,
    /// What people should know and were not told yet.
    notes: Vec<String>,
    /// States that cannot be read.
    damaged: BTreeSet<usize>,
    /// States of whose files something was told.
    noted: BTreeSet<usize>,
}

impl Playback {
    /// `recording` at its first state that can be read, keeping states in `memory` bytes.
    ///
    /// # Errors
    /// Why none of its states can be read.
    pub fn new(recording: Recording, memory: usize) -> Result<Self, String> {
        let mut notes = recording.notes().to_vec();
        let mut damaged = BTreeSet::new();
        for (index, moment) in recording.moments().iter().enumerate() {
            match recording.state(index) {
                Ok(state) => {
                    notes.extend(state.notes);
                    let start = Arc::new(state.world);
                    return Ok(Self {
                        reached: moment.step,
                        shown: (index, start.clone()),
                        start,
                        kept: VecDeque::new(),
                        memory,
                        notes,
                        damaged,
                        noted: [index].into(),
                        follower: Follower::of(&recording),
                        facts: None,
                        survey: None,
                        flow: recording.flow().map(written_flow),
                        recording,
                    });
                }
                Err(error) => notes.push(error.to_string()),
            }
            damaged.insert(index);
        }
        Err(notes.join("; "))
    }

    /// What people should know since this was last called, in sentences.
    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// What is known of the recording, where that has changed since this was last called.
    pub fn take_facts(&mut self) -> Option<RecordingFacts> {
        self.facts.take()
    }

    /// Lets `passed` wall-clock time pass: what a run under way has written is taken up now and then,
    /// and where the mean flow is measured, another state is read.
    pub fn tick(&mut self, passed: Duration) {
        if let Some(survey) = &mut self.survey
            && (survey.measure_next(&self.recording) || self.flow.is_none())
        {
            self.flow = Some(RecordedFlow {
                mean: Arc::new(survey.mean(&self.recording)),
                read: Some(survey.read()),
            });
        }
        self.follow(passed);
    }

    fn follow(&mut self, passed: Duration) {
        let Some(follower) = &mut self.follower else {
            return;
        };
        let end = self.recording.branch().end.step;
        let follows = self.reached >= end;
        let Some(news) = follower.tick(passed, &mut self.recording) else {
            return;
        };
        match news {
            News::Grown | News::Progress => {}
            News::ReadAnew => self.read_anew(),
            News::Lost(reason) => {
                self.notes
                    .push(format!("The run is followed no longer: {reason}"));
                self.follower = None;
            }
        }
        if follows {
            self.go_to(self.recording.moments().len() - 1);
        }
        self.facts = Some(self.recording.facts());
    }

    /// The recording was read anew: the same moment is shown, as it is known now.
    fn read_anew(&mut self) {
        let time = self.shown.1.time();
        let moments = self.recording.moments();
        let index = moments.partition_point(|moment| moment.time <= time);
        let index = index.max(1) - 1;
        self.reached = moments[index].step;
        self.kept.clear();
        self.damaged.clear();
        self.noted.clear();
        if let Ok(state) = self.recording.state(index) {
            self.shown = (index, Arc::new(state.world));
        }
        if self.recording.progress() == RunProgress::Over {
            let written = self.recording.flow().map(written_flow);
            self.survey = self.survey.take().filter(|_| written.is_none());
            self.flow = written.or(self.flow.take());
            let end = self.recording.branch().end.time;
            self.notes.push(format!("The run ended at t = {end:.3} s"));
            self.notes.extend_from_slice(self.recording.notes());
            self.follower = None;
        }
    }

    /// The step that it has come to, and how long a step is there.
    pub fn now(&self) -> world::Clock {
        let mut now = world::Clock::new(self.shown.1.clock.time_step);
        now.step = self.reached;
        now
    }

    /// Steps of its last state.
    fn end(&self) -> u64 {
        self.recording.branch().end.step
    }

    /// Whether it is to go further.
    pub fn has_work(&self, clock: &LabClock) -> bool {
        self.reached < self.end() && clock.goal(None) > self.reached
    }

    /// Goes on to where `clock` lets it: at any speed as fast as the machine can, state by state.
    /// At its end it holds.
    pub fn advance(&mut self, clock: &mut LabClock) {
        let goal = clock.goal(None);
        let next = self.recording.index_at(self.reached) + 1;
        let next = self.recording.moments().get(next).map(|next| next.step);
        self.reached = match next {
            Some(next) if goal == u64::MAX => next,
            _ => goal.min(self.end()),
        };
        self.show(self.recording.index_at(self.reached));
        if self.reached >= self.end() {
            clock.stop();
        }
    }

    /// Carries out what `command` asks for and holds or plays on by `clock`.
    ///
    /// # Errors
    /// When it would change something, or compute.
    pub fn take(&mut self, command: &LabCommand, clock: &mut LabClock) -> Result<(), CommandError> {
        match command {
            LabCommand::OpenChange
            | LabCommand::CloseChange
            | LabCommand::ForgetMeasured(_)
            | LabCommand::Rescue { .. }
            | LabCommand::Threads(_) => {}
            LabCommand::MeasureFlow if self.recording.flow().is_some() => {}
            LabCommand::MeasureFlow => self.survey = Some(FlowSurvey::default()),
            LabCommand::Hold(step) => clock.hold_at(*step),
            LabCommand::All(command) => match command {
                Command::Play => {
                    self.begin_again();
                    clock.set_mode(Mode::Running);
                }
                Command::Pause => clock.set_mode(Mode::Paused),
                Command::Speed(speed) => clock.set_speed(*speed),
                Command::Step(steps) => {
                    self.step_on(*steps);
                    clock.set_mode(Mode::Paused);
                }
                Command::Seek(step) => {
                    self.seek(*step);
                    clock.set_mode(Mode::Paused);
                }
                Command::Reset => {
                    self.seek(0);
                    clock.set_mode(Mode::Paused);
                }
                Command::Undo
                | Command::Redo
                | Command::Return(_)
                | Command::Forget(_)
                | Command::Set { .. } => return Err(CommandError::Recorded),
            },
            LabCommand::SetIn { .. }
            | LabCommand::Compare { .. }
            | LabCommand::EndComparison { .. }
            | LabCommand::NameBranch { .. }
            | LabCommand::Save { .. } => return Err(CommandError::Recorded),
        }
        Ok(())
    }

    /// Goes back to the start, where it stands at its end.
    fn begin_again(&mut self) {
        if self.reached >= self.end() {
            self.seek(0);
        }
    }

    /// Shows the state nearest to `step`.
    fn seek(&mut self, step: u64) {
        self.go_to(self.recording.nearest(step));
    }

    /// Shows the state after the one shown, or one that is `steps` later where that is further.
    fn step_on(&mut self, steps: u64) {
        let later = self.recording.index_at(self.reached.saturating_add(steps));
        let last = self.recording.moments().len() - 1;
        let next = self.recording.index_at(self.reached) + 1;
        self.go_to(later.max(next).min(last));
    }

    /// What is shown.
    pub fn news(&self) -> RunsNews {
        let branch = self.recording.branch();
        RunsNews {
            comparison: None,
            runs: vec![RunNews {
                world: self.shown.1.clone(),
                start: self.start.clone(),
                turned: None,
                reached: self.reached,
                parameters: self.recording.parameters().clone(),
                branch: branch.clone(),
                latest: None,
                sampling: Sampling::default(),
                past: Past {
                    number: branch.number,
                    end: branch.end,
                    ..Past::default()
                },
                memory: KeptMemory::default(),
                fault: None,
                flow: self.flow.clone(),
                profile: Profile::default(),
            }],
        }
    }

    fn go_to(&mut self, index: usize) {
        self.reached = self.recording.moments()[index].step;
        self.show(index);
    }

    /// Shows the state of this `index`; where it cannot be read, that is told once and the state
    /// shown stays.
    fn show(&mut self, index: usize) {
        if index == self.shown.0 || self.damaged.contains(&index) {
            return;
        }
        let kept = self.kept.iter().find(|(kept, _)| *kept == index);
        let state = match kept {
            Some((_, world)) => world.clone(),
            None => match self.recording.state(index) {
                Ok(state) => {
                    if self.noted.insert(index) {
                        self.notes.extend(state.notes);
                    }
                    Arc::new(state.world)
                }
                Err(error) => {
                    self.damaged.insert(index);
                    let note = format!("{error}. The state shown before it stays in the picture");
                    self.notes.push(note);
                    return;
                }
            },
        };
        let before = std::mem::replace(&mut self.shown, (index, state));
        self.keep(before);
    }

    /// Keeps a state that is shown no longer, in the place of those kept longest.
    fn keep(&mut self, state: (usize, Arc<World>)) {
        let memory = state.1.memory().max(1);
        let most = (self.memory / memory).min(MOST_KEPT);
        while !self.kept.is_empty() && self.kept.len() >= most {
            self.kept.pop_front();
        }
        if most > 0 && !self.kept.iter().any(|(kept, _)| *kept == state.0) {
            self.kept.push_back(state);
        }
    }
}

/// The mean flow that a run wrote.
fn written_flow(mean: &Arc<MeanFlow>) -> RecordedFlow {
    RecordedFlow {
        mean: mean.clone(),
        read: None,
    }
}
