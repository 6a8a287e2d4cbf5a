//! A lab: one run or two equal ones, as the window, scripts and the headless runner see and change
//! them.
//!
//! In: a scene or a session, then [`LabCommand`]s by [`Lab::send`], which is the only road back,
//! and ticks of wall-clock time. Out: a [`RunView`] of each run, always of the same step, and what
//! the lab does. It computes nothing itself: an engine does, inline or on a thread of its own, and
//! which one does not show in a trajectory.

use super::driver::Driver;
use super::engine::{Engine, Message};
use super::lab_command::LabCommand;
use super::runs::ONE_STEP;
use super::update::{RunsNews, SavedFile, Update};
use super::{DriverKind, Half, Options, RunView, Status};
use crate::recording::{Recording, RecordingFacts};
use crate::run::{Changed, Command, CommandError, Parameter, Provenance, Session, Value, accept};
use crate::scene::Scene;
use crate::solver::{TimeStepAdvice, advise};
use crate::world::World;
use std::ops::Deref;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Wall-clock time over which the real-time factor is measured.
const RATE_TIME: Duration = Duration::from_millis(400);

/// Wall-clock time of running after which a run is worth keeping even if nothing was changed in it.
const LONG_RUN: Duration = Duration::from_mins(1);

/// One run or two equal ones. What is read of a lab without naming a [`Half`] is the left run,
/// which is all there is of a lone one.
pub struct Lab {
    /// The left run, and the right one where there are two.
    runs: Vec<RunView>,
    /// What the two differ in.
    comparison: Option<Parameter>,
    /// What is known of the recording that is played, where nothing is computed.
    recording: Option<RecordingFacts>,
    /// The scene as it was opened, before what acts from the next start on was changed.
    original: Arc<Scene>,
    /// None where the system gave no thread or the thread has died.
    driver: Option<Driver>,
    speed: f64,
    /// Commands sent so far, and those of them that were dispatched.
    sent: u64,
    answered: u64,
    status: Status,
    /// The bed on its way to rest, while it settles.
    settling: Option<Arc<World>>,
    rate: Rate,
    saved: Saved,
}

/// Two runs side by side.
#[derive(Clone, Copy)]
pub struct Comparison<'a> {
    /// What the two differ in.
    pub parameter: &'a Parameter,
    /// The right run.
    pub right: &'a RunView,
}

/// What is known of the files a session was written to.
#[derive(Default)]
struct Saved {
    /// News of files, not yet taken.
    files: Vec<SavedFile>,
    /// Commands sent before each file that is still to be written, that for the file included.
    pending: Vec<u64>,
    /// The revision that the last file holds, or that the lab was opened with.
    revision: u64,
    /// Wall-clock time of running since then.
    worked: Duration,
}

impl Deref for Lab {
    type Target = RunView;

    fn deref(&self) -> &RunView {
        self.half(Half::Left)
    }
}

impl Lab {
    /// Opens `scene`. On a thread this returns at once and the run is prepared there; inline it is
    /// prepared by ticks.
    pub fn open(scene: Scene, options: Options) -> Self {
        let scene = Arc::new(scene);
        let advice = advise(&scene);
        let (engine_scene, time_step) = (scene.clone(), advice.time_step);
        Self::with(scene.clone(), scene, advice, options, move |options| {
            Engine::open(engine_scene, time_step, options)
        })
    }

    /// Opens `session` at the moment that was shown. What `options` say of beds and scripts means
    /// nothing for it.
    pub fn resume(session: Session, options: Options) -> Self {
        let scene = Arc::new(session.record().scene.clone());
        let original = Arc::new(session.original().clone());
        let advice = advise(&scene);
        Self::with(scene, original, advice, options, move |options| {
            Engine::resume(session, options)
        })
    }

    /// It, as work that is in no file.
    #[must_use]
    pub fn unsaved(mut self) -> Self {
        self.saved.worked = 2 * LONG_RUN;
        self
    }

    /// Plays `recording` from its start. What `options` say of threads, beds and scripts means
    /// nothing for it.
    pub fn play_back(recording: Recording, options: Options) -> Self {
        let scene = recording.scene().clone();
        let advice = TimeStepAdvice {
            time_step: recording.first_step(),
            ..advise(&scene)
        };
        let facts = recording.facts();
        let lab = Self::with(scene.clone(), scene, advice, options, move |options| {
            Engine::play_back(recording, options)
        });
        Self {
            recording: Some(facts),
            ..lab
        }
    }

    fn with(
        scene: Arc<Scene>,
        original: Arc<Scene>,
        advice: TimeStepAdvice,
        options: Options,
        make: impl FnOnce(Options) -> Engine + Send + 'static,
    ) -> Self {
        let speed = options.speed;
        let driver = match options.driver {
            DriverKind::Inline => Ok(Driver::inline(make(options))),
            DriverKind::Thread => Driver::thread(move || make(options)),
        };
        let mut lab = Self {
            runs: vec![RunView::new(scene, advice)],
            comparison: None,
            recording: None,
            original,
            driver: None,
            speed,
            sent: 0,
            answered: 0,
            status: Status::starting(),
            settling: None,
            rate: Rate::default(),
            saved: Saved::default(),
        };
        match driver {
            Ok(driver) => lab.driver = Some(driver),
            Err(error) => lab.fail(format!("the system gives the solver no thread: {error}")),
        }
        lab
    }

    /// The scene as it was opened: another than [`RunView::scene`] where what acts from the next
    /// start on was changed.
    pub fn original(&self) -> &Arc<Scene> {
        &self.original
    }

    /// The same, of a scene that was made of the `original`.
    #[must_use]
    pub fn made_of(mut self, original: Arc<Scene>) -> Self {
        self.original.clone_from(&original);
        if let Some(driver) = &mut self.driver {
            driver.send(Message::MadeOf(original));
        }
        self
    }

    /// One of the two runs; the only one where there is one.
    pub fn half(&self, half: Half) -> &RunView {
        self.runs.get(half.index()).unwrap_or(&self.runs[0])
    }

    /// The second run and what it differs in, while two are compared.
    pub fn comparison(&self) -> Option<Comparison<'_>> {
        Some(Comparison {
            parameter: self.comparison.as_ref()?,
            right: self.runs.get(Half::Right.index())?,
        })
    }

    /// What is known of the recording that is played; none where a run is computed.
    pub fn recording(&self) -> Option<&RecordingFacts> {
        self.recording.as_ref()
    }

    /// Where what is shown comes from; nothing before there is a state.
    pub fn provenance(&self) -> Option<Provenance> {
        if self.recording.is_some() {
            return Some(Provenance::recorded(self.scene(), self.world()?));
        }
        let provenance = Provenance::of(self.scene(), self.world()?);
        let Some(Comparison { parameter, right }) = self.comparison() else {
            return Some(provenance);
        };
        let change = format!("{parameter} = {}", right.value(parameter)?);
        Some(provenance.beside(change, right.world()?))
    }

    /// What an undo would take back, and a redo bring back; of two runs, what was changed since
    /// they began.
    pub fn undo_and_redo(&self) -> [Option<&Changed>; 2] {
        let past = self.half(Half::Right).past();
        [past.undo.as_ref(), past.redo.as_ref()]
    }

    /// What it does now.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The bed on its way to rest, as of lately and without its contacts: what there is to see before
    /// there is a run.
    pub fn settling(&self) -> Option<&Arc<World>> {
        self.settling.as_ref()
    }

    /// Simulated seconds per wall-clock second that were asked for.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Simulated seconds per wall-clock second lately; zero while it holds.
    pub fn real_time_factor(&self) -> f64 {
        match self.status {
            Status::Running => self.rate.value,
            _ => 0.0,
        }
    }

    /// Asks for `command`. It is dispatched between two pieces of work; values are stamped with
    /// their step and kept. What is refused is told by [`RunView::warnings`].
    pub fn send(&mut self, command: impl Into<LabCommand>) {
        let command = command.into();
        self.sent += 1;
        self.expect(&command);
        if let Some(driver) = &mut self.driver {
            driver.send(Message::Command(command));
        }
    }

    /// Shows what `command` asks for until it is carried out.
    fn expect(&mut self, command: &LabCommand) {
        match command {
            LabCommand::All(Command::Speed(speed)) => self.speed = *speed,
            LabCommand::All(command) => {
                let is_own = |own: &Parameter| matches!(command, Command::Set { parameter, .. } if parameter == own);
                let runs = if self.comparison.as_ref().is_some_and(is_own) {
                    1
                } else {
                    2
                };
                for run in self.runs.iter_mut().take(runs) {
                    run.expect(command);
                }
            }
            LabCommand::SetIn {
                half,
                parameter,
                value,
            } => {
                if let Some(run) = self.runs.get_mut(half.index()) {
                    let (parameter, value) = (parameter.clone(), *value);
                    run.expect(&Command::Set { parameter, value });
                }
            }
            LabCommand::Save { .. } if self.recording.is_some() => {}
            LabCommand::Save { .. } => self.saved.pending.push(self.sent),
            LabCommand::Compare { .. }
            | LabCommand::Rescue { .. }
            | LabCommand::OpenChange
            | LabCommand::CloseChange
            | LabCommand::EndComparison { .. }
            | LabCommand::NameBranch { .. }
            | LabCommand::ForgetMeasured(_)
            | LabCommand::Hold(_)
            | LabCommand::MeasureFlow
            | LabCommand::Threads(_) => {}
        }
    }

    /// Whether two runs can be compared from here.
    pub fn can_compare(&self) -> bool {
        self.comparison.is_none()
            && self.recording.is_none()
            && matches!(self.status, Status::Running | Status::Paused)
    }

    /// Whether [`LabCommand::Compare`] can be carried out now with this `parameter` and `value`.
    ///
    /// # Errors
    /// Why it would be refused, in a sentence.
    pub fn check_comparison(&self, parameter: &Parameter, value: Value) -> Result<(), String> {
        if self.recording.is_some() {
            return Err(CommandError::Recorded.to_string());
        }
        if self.comparison.is_some() {
            return Err("Two runs are compared already: end that comparison first".into());
        }
        if *parameter == Parameter::TimeStep {
            return Err(ONE_STEP.into());
        }
        let (Some(world), true) = (self.world(), self.can_compare()) else {
            return Err("Two runs start side by side only while the run stands or goes on".into());
        };
        let change = Command::Set {
            parameter: parameter.clone(),
            value,
        };
        let accepted = accept(self.parameters(), world, &change);
        accepted.map(drop).map_err(|refusal| refusal.to_string())
    }

    /// What became of files since this was last called.
    pub fn take_saved(&mut self) -> Vec<SavedFile> {
        std::mem::take(&mut self.saved.files)
    }

    /// Whether a file is still to be written.
    pub fn is_saving(&self) -> bool {
        !self.saved.pending.is_empty()
    }

    /// Whether there is something that no file holds and that would be missed: changes, branches,
    /// or minutes of computing.
    pub fn is_unsaved(&self) -> bool {
        let past = self.past();
        let changed = past.undo.is_some() || past.redo.is_some() || !past.kept.is_empty();
        (changed && self.revision() != self.saved.revision) || self.saved.worked > LONG_RUN
    }

    /// Whether every command that was sent has been dispatched.
    pub fn has_answered(&self) -> bool {
        self.answered == self.sent
    }

    /// Lets `passed` wall-clock time pass: lets the runs go on and takes in what is new.
    pub fn tick(&mut self, passed: Duration) {
        if let Some(driver) = &mut self.driver {
            let update = driver.tick(passed);
            if update.is_none() && driver.has_died() {
                self.driver = None;
                self.fail("the solver's thread ended; this is a mistake in Grainfall".into());
            }
            if let Some(update) = update {
                self.take(update);
            }
        }
        self.runs.iter_mut().for_each(RunView::catch_up);
        if self.status == Status::Running && self.recording.is_none() {
            self.saved.worked += passed;
        }
    }

    fn fail(&mut self, reason: String) {
        self.status = Status::Failed(reason);
    }

    fn take(&mut self, update: Update) {
        self.answered = update.answered.unwrap_or(self.answered);
        self.status = update.status.unwrap_or(self.status.clone());
        if let Some(news) = update.runs {
            self.take_runs(news);
        }
        let is_preparing = matches!(self.status, Status::Preparing { .. });
        let settling = update.settling.or(self.settling.take());
        self.settling = settling.filter(|_| is_preparing);
        self.recording = update.recording.or(self.recording.take());
        self.runs[0].warn(update.warnings);
        let is_there = !matches!(self.status, Status::Seeking { .. });
        if self.has_answered() {
            for run in &mut self.runs {
                run.forget_asked();
                if is_there {
                    run.forget_sought();
                }
            }
        }
        self.take_files(update.saved);
        if self.status != Status::Running {
            self.rate.since = None;
        }
    }

    fn take_runs(&mut self, news: RunsNews) {
        let is_first = self.world().is_none();
        let generation = self.generation();
        self.comparison = news.comparison;
        self.runs.truncate(news.runs.len());
        while self.runs.len() < news.runs.len() {
            self.runs.push(self.runs[0].sibling());
        }
        for (run, news) in self.runs.iter_mut().zip(news.runs) {
            run.take(news);
        }
        if is_first {
            self.saved.revision = self.revision();
        }
        let time = self.world().map(|world| world.time());
        if let Some(time) = time.filter(|_| generation != self.generation()) {
            self.rate.follow(time);
        }
    }

    fn take_files(&mut self, files: Vec<SavedFile>) {
        let pending = std::mem::take(&mut self.saved.pending);
        let (answered, waiting) = pending.split_at(files.len().min(pending.len()));
        self.saved.pending = waiting.to_vec();
        for (file, &sent) in files.into_iter().zip(answered) {
            // Commands that followed before the news came may be in this revision and not in the
            // file.
            if file.outcome.is_ok() && sent == self.answered {
                self.saved.revision = self.revision();
                self.saved.worked = Duration::ZERO;
            }
            self.saved.files.push(file);
        }
    }
}

/// Simulated time per wall-clock time, measured over [`RATE_TIME`].
#[derive(Default)]
struct Rate {
    value: f64,
    since: Option<(Instant, f64)>,
}

impl Rate {
    fn follow(&mut self, time: f64) {
        let (since, from) = *self.since.get_or_insert((Instant::now(), time));
        let passed = since.elapsed();
        if time < from {
            self.since = None;
        } else if passed >= RATE_TIME {
            self.value = (time - from) / passed.as_secs_f64();
            self.since = Some((Instant::now(), time));
        }
    }
}
