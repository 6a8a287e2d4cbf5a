//! What a driver moves: a preparation that becomes a run, the runs of a lab or a recording, and
//! their clock.
//!
//! In: [`Message`]s, which are commands and ticks. Out: [`Update`]s. [`Engine::work`] does one
//! short piece at a time, so that commands are answered quickly; how the pieces fall does not show
//! in a trajectory. On which thread it is moved is up to the driver.

use super::clock::{LabClock, Mode};
use super::lab_command::LabCommand;
use super::playback::Playback;
use super::runs::Runs;
use super::update::{SavedFile, Update};
use super::{Half, Options, Status};
use crate::recording::Recording;
use crate::run::{
    Command, CommandError, Parameter, Pieces, Preparation, Prepared, Run, Script, ScriptedCommand,
    Session, Stored, Timeline, Value,
};
use crate::scene::Scene;
use crate::world::World;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the outside tells the engine.
pub enum Message {
    /// Carry this out.
    Command(LabCommand),
    /// So much wall-clock time has passed.
    Tick(Duration),
    /// The scene was made of this one; a session holds both.
    MadeOf(Arc<Scene>),
}

/// Wall-clock time over which a profile is gathered.
const PROFILE_TIME: Duration = Duration::from_millis(500);

/// Shortest wall-clock time between two pictures of a bed that settles.
const SETTLING_TIME: Duration = Duration::from_millis(40);

/// Least wall-clock time between two such pictures, in times that copying the bed for one takes.
const SETTLING_SHARE: u32 = 10;

/// Wall-clock time a piece of work should take: commands wait for it.
const PIECE_TIME: Duration = Duration::from_millis(10);

/// Why branches are not taken up while two runs are compared.
const OF_ONE_RUN: &str =
    "A branch would take the place of one of the two runs: end the comparison first.";

/// A preparation that becomes a run, the runs of a lab, and their clock.
pub struct Engine {
    stage: LabStage,
    clock: LabClock,
    /// The scene as it was opened.
    original: Arc<Scene>,
    threads: usize,
    /// Memory for keyframes [bytes].
    memory: usize,
    pieces: Pieces,
    script: Vec<ScriptedCommand>,
    /// Commands that come before there is a run, or while one is on the way to another moment.
    waiting: Vec<LabCommand>,
    /// Whether values that are set belong to one change now, and whether one was set in it.
    open_change: Option<bool>,
    answered: u64,
    /// Whether it was said that work cannot be kept for the case that the program ends unasked.
    is_beyond_rescue: bool,
    /// When a bed that settles is shown next; never where none is.
    shows_settling: Option<Instant>,
    news: Update,
    profiled: Instant,
}

enum LabStage {
    Preparing(Box<Preparation>),
    Ready(Runs),
    /// Nothing is computed.
    Recorded(Box<Playback>),
    /// There is no run, as the status says.
    Failed(Status),
}

impl Engine {
    /// An engine that prepares a run of `scene`, with steps of `time_step` [s], and goes on with
    /// it.
    pub fn open(scene: Arc<Scene>, time_step: f64, options: Options) -> Self {
        let original = scene.clone();
        let preparation = Preparation::new(scene, time_step, options.threads, options.beds.clone());
        Self::at(
            LabStage::Preparing(Box::new(preparation)),
            original,
            options,
        )
    }

    /// An engine that goes on with `session` at the moment that was shown.
    pub fn resume(session: Session, options: Options) -> Self {
        let original = Arc::new(session.original().clone());
        let timeline = session.into_timeline(options.threads, options.memory);
        Self::at(LabStage::Ready(Runs::new(timeline)), original, options)
    }

    /// An engine that plays `recording` from its start.
    pub fn play_back(recording: Recording, options: Options) -> Self {
        let scene = recording.scene().clone();
        let stage = match Playback::new(recording, options.memory) {
            Ok(playback) => LabStage::Recorded(Box::new(playback)),
            Err(reason) => LabStage::Failed(Status::Failed(reason)),
        };
        Self::at(stage, scene, options)
    }

    fn at(stage: LabStage, original: Arc<Scene>, options: Options) -> Self {
        Self {
            stage,
            clock: LabClock::new(options.autoplay, options.speed),
            original,
            threads: options.threads,
            memory: options.memory,
            pieces: Pieces::of(PIECE_TIME),
            script: options.script,
            waiting: Vec::new(),
            open_change: None,
            answered: 0,
            is_beyond_rescue: false,
            shows_settling: options.shows_settling.then(Instant::now),
            news: Update::default(),
            profiled: Instant::now(),
        }
    }

    /// Carries out what `message` says, or keeps it until that can be done.
    pub fn take(&mut self, message: Message) {
        match message {
            Message::Tick(passed) => self.tick(passed),
            Message::MadeOf(original) => self.original = original,
            Message::Command(command) => self.dispatch(command),
        }
    }

    /// Whether there is work to do without another message.
    pub fn is_busy(&self) -> bool {
        match &self.stage {
            LabStage::Preparing(_) => true,
            LabStage::Ready(runs) => runs.have_work(&self.clock),
            LabStage::Recorded(playback) => playback.has_work(&self.clock),
            LabStage::Failed(_) => false,
        }
    }

    /// Does one short piece of work, if there is any.
    pub fn work(&mut self) {
        match &mut self.stage {
            LabStage::Preparing(preparation) => match preparation.advance() {
                Ok(Prepared::NotYet) => {}
                Ok(Prepared::Ready(run)) => {
                    let warnings = preparation.warnings().to_vec();
                    self.begin(*run, warnings);
                }
                Err(fault) => self.fail(Status::Faulted(fault)),
            },
            LabStage::Ready(runs) => {
                let started = Instant::now();
                let piece = runs.advance(&mut self.clock, self.pieces.steps());
                self.pieces.fit(piece.steps, started.elapsed());
                if piece.arrived {
                    self.dispatch_waiting();
                }
            }
            LabStage::Recorded(playback) => playback.advance(&mut self.clock),
            LabStage::Failed(_) => {}
        }
    }

    /// What is new since this was last called.
    pub fn take_update(&mut self) -> Update {
        let mut update = std::mem::take(&mut self.news);
        update.status = Some(self.status());
        update.settling = self.settling();
        update.answered = Some(self.answered);
        if let LabStage::Recorded(playback) = &mut self.stage {
            update.warnings.extend(playback.take_notes());
            update.recording = playback.take_facts();
            update.runs = Some(playback.news());
        }
        if let LabStage::Ready(runs) = &mut self.stage {
            if self.profiled.elapsed() > PROFILE_TIME {
                self.profiled = Instant::now();
                runs.renew_profiles();
            }
            update.runs = runs.news(&self.clock);
            update.answered = update.answered.filter(|_| update.runs.is_some());
        }
        update
    }

    /// A copy of the bed that settles, where it is time for one.
    fn settling(&mut self) -> Option<Arc<World>> {
        let LabStage::Preparing(preparation) = &self.stage else {
            return None;
        };
        let (world, started) = (preparation.settling()?, Instant::now());
        self.shows_settling.filter(|next| *next <= started)?;
        let copy = Arc::new(world.without_contacts());
        let pause = SETTLING_TIME.max(SETTLING_SHARE * started.elapsed());
        self.shows_settling = Some(Instant::now() + pause);
        Some(copy)
    }

    fn status(&self) -> Status {
        let runs = match &self.stage {
            LabStage::Failed(status) => return status.clone(),
            LabStage::Preparing(preparation) => {
                return Status::Preparing {
                    stage: preparation.name().into(),
                    progress: preparation.progress(),
                };
            }
            LabStage::Recorded(_) if self.clock.mode() == Mode::Paused => return Status::Paused,
            LabStage::Recorded(_) => return Status::Running,
            LabStage::Ready(runs) => runs,
        };
        match runs.fault() {
            Some(fault) => Status::Faulted(fault.clone()),
            None if runs.are_on_the_way() => Status::Seeking {
                progress: runs.progress(),
            },
            None if self.clock.mode() == Mode::Paused => Status::Paused,
            None => Status::Running,
        }
    }

    /// Makes what the preparation came to the run of the lab.
    fn begin(&mut self, run: Run, warnings: Vec<String>) {
        self.news.warnings.extend(warnings);
        let script = std::mem::take(&mut self.script);
        let clock = run.world().clock;
        let mut timeline = Timeline::new(run, self.memory);
        let scheduled = Script::new(&script, &clock)
            .map_err(|error| error.to_string())
            .and_then(|script| timeline.schedule(script).map_err(|error| error.to_string()));
        match scheduled {
            Ok(()) => {
                self.stage = LabStage::Ready(Runs::new(timeline));
                self.dispatch_waiting();
            }
            Err(reason) => self.fail(Status::Failed(reason)),
        }
    }

    /// Ends without a run; what waited for one is answered.
    fn fail(&mut self, status: Status) {
        self.stage = LabStage::Failed(status);
        self.dispatch_waiting();
    }

    /// Lets the runs go on by what `passed` wall-clock time is worth.
    fn tick(&mut self, passed: Duration) {
        if let LabStage::Recorded(playback) = &mut self.stage {
            playback.tick(passed);
            self.clock.tick(passed, playback.now());
        }
        if let LabStage::Ready(runs) = &mut self.stage {
            self.clock.tick(passed, runs.now());
            if let Some(step) = self.clock.due() {
                runs.skip_towards(step);
            }
        }
    }

    /// Carries `command` out, or keeps it until there is a run that stands where it was asked to
    /// go.
    fn dispatch(&mut self, command: LabCommand) {
        if self.must_wait(&command) {
            self.waiting.push(command);
            return;
        }
        self.answered += 1;
        if let LabStage::Recorded(playback) = &mut self.stage {
            let refused = playback.take(&command, &mut self.clock).err();
            let refused = refused.map(|refusal| refusal.to_string());
            return self.news.warnings.extend(refused);
        }
        if parts_changes(&command) {
            self.open_change = self.open_change.map(|_| false);
        }
        match command {
            LabCommand::OpenChange => self.open_change = Some(false),
            LabCommand::CloseChange => self.open_change = None,
            LabCommand::Hold(step) => self.clock.hold_at(step),
            LabCommand::Threads(threads) => self.use_threads(threads),
            // A run has measured it.
            LabCommand::MeasureFlow => {}
            LabCommand::ForgetMeasured(stored) => self.forget_measured(stored),
            LabCommand::Save { path, look } => self.save(path, look),
            LabCommand::Rescue { path, look } => self.rescue(&path, look),
            LabCommand::Compare { parameter, value } => self.compare(parameter, value),
            LabCommand::EndComparison { keep } => self.end_comparison(keep),
            LabCommand::NameBranch { half, number, name } => {
                if let LabStage::Ready(runs) = &mut self.stage {
                    runs.name_branch(half, number, &name);
                }
            }
            LabCommand::SetIn {
                half,
                parameter,
                value,
            } => self.change(&Command::Set { parameter, value }, Some(half)),
            LabCommand::All(command) => match command {
                Command::Set { .. } => self.change(&command, None),
                Command::Play => self.play(Mode::Running),
                Command::Pause => self.pause(),
                Command::Step(steps) => self.step(steps),
                Command::Speed(speed) => {
                    self.clock.set_speed(speed);
                    self.play(self.clock.mode());
                }
                Command::Reset => self.reset(),
                Command::Seek(step) => self.travel(|runs| runs.seek(step)),
                Command::Undo => self.travel(Runs::undo),
                Command::Redo => self.travel(Runs::redo),
                Command::Return(index) => self.take_up(index),
                Command::Forget(index) => {
                    if let LabStage::Ready(runs) = &mut self.stage {
                        runs.forget(index);
                    }
                }
            },
        }
    }

    /// Holds here; what waited for the end of a way is carried out here.
    fn pause(&mut self) {
        if let LabStage::Ready(runs) = &mut self.stage {
            runs.stop();
            self.dispatch_waiting();
        }
        self.play(Mode::Paused);
    }

    /// Takes so many steps from here and holds.
    fn step(&mut self, steps: u64) {
        if let LabStage::Ready(runs) = &self.stage {
            let until = runs.now().step.saturating_add(steps);
            self.play(Mode::Stepping { until });
        }
    }

    /// Starts afresh, and goes on where nothing had stopped it.
    fn reset(&mut self) {
        if let LabStage::Ready(runs) = &mut self.stage {
            runs.reset();
            let goes_on = self.clock.mode() == Mode::Running && runs.fault().is_none();
            self.play(if goes_on { Mode::Running } else { Mode::Paused });
        }
    }

    /// Shows a branch again, where there is one run only.
    fn take_up(&mut self, index: usize) {
        if matches!(&self.stage, LabStage::Ready(runs) if runs.is_pair()) {
            self.news.warnings.push(OF_ONE_RUN.into());
        } else {
            self.travel(|runs| runs.take_up(index));
        }
    }

    /// Starts a second run beside the first, or says why not.
    fn compare(&mut self, parameter: Parameter, value: Value) {
        if let LabStage::Ready(runs) = &mut self.stage {
            match runs.compare(parameter, value, self.memory / 2) {
                Ok(()) => self.begin_anew(),
                Err(reason) => self.news.warnings.push(reason),
            }
        }
    }

    /// Goes on with one of two runs.
    fn end_comparison(&mut self, keep: Half) {
        if let LabStage::Ready(runs) = &mut self.stage {
            runs.end_comparison(keep);
            self.begin_anew();
        }
    }

    /// Goes on as before with another number of runs.
    fn begin_anew(&mut self) {
        self.play(self.clock.mode());
        self.use_threads(self.threads);
    }

    /// Whether `command` has no meaning before there is a run, or before it stands where it was
    /// asked to go.
    fn must_wait(&self, command: &LabCommand) -> bool {
        let acts_at_once = matches!(
            command,
            LabCommand::Hold(_)
                | LabCommand::Threads(_)
                | LabCommand::All(Command::Seek(_) | Command::Pause | Command::Speed(_))
        );
        match &self.stage {
            LabStage::Preparing(_) => !matches!(command, LabCommand::Hold(_)),
            LabStage::Ready(runs) if !runs.are_on_the_way() || acts_at_once => false,
            // What takes a lone run elsewhere need not wait until it has come to the place before.
            LabStage::Ready(runs) => {
                let moves =
                    matches!(command, LabCommand::All(command) if command.moving().is_some());
                runs.is_pair() || !moves
            }
            LabStage::Recorded(_) | LabStage::Failed(_) => false,
        }
    }

    /// Dispatches what waited, as far as it need not wait on.
    fn dispatch_waiting(&mut self) {
        for command in std::mem::take(&mut self.waiting) {
            self.dispatch(command);
        }
    }

    /// Writes the whole session, on the way from one piece of work to the next.
    fn save(&mut self, path: PathBuf, look: String) {
        let outcome = match &mut self.stage {
            LabStage::Ready(runs) => runs
                .save(&path, &self.original, look)
                .map_err(|error| error.to_string()),
            _ => Err("there is no run".into()),
        };
        self.news.saved.push(SavedFile { path, outcome });
    }

    /// Writes the whole session where it is found again if the program ends unasked; says once why
    /// that cannot be.
    fn rescue(&mut self, path: &Path, look: String) {
        let LabStage::Ready(runs) = &mut self.stage else {
            return;
        };
        if let Err(error) = runs.save(path, &self.original, look)
            && !std::mem::replace(&mut self.is_beyond_rescue, true)
        {
            self.news.warnings.push(format!(
                "What is done here would be lost if the program were stopped: {} cannot be written: {error}",
                path.display()
            ));
        }
    }

    fn forget_measured(&mut self, stored: Stored) {
        if let LabStage::Ready(runs) = &mut self.stage {
            runs.forget_measured(stored);
        }
    }

    fn use_threads(&mut self, threads: usize) {
        self.threads = threads;
        if let LabStage::Ready(runs) = &mut self.stage {
            runs.use_threads(threads);
        }
    }

    /// Changes all runs, or one of them; says why where that is refused.
    fn change(&mut self, change: &Command, half: Option<Half>) {
        if let LabStage::Ready(runs) = &mut self.stage {
            let joins = self.open_change == Some(true);
            self.open_change = self.open_change.map(|_| true);
            let refused: Option<CommandError> = runs.change(change, half, joins).err();
            let refused = refused.map(|refusal| refusal.to_string());
            self.news.warnings.extend(refused);
        }
    }

    /// Sets out for another moment and holds there.
    fn travel(&mut self, set_out: impl FnOnce(&mut Runs)) {
        if let LabStage::Ready(runs) = &mut self.stage {
            set_out(runs);
        }
        self.play(Mode::Paused);
    }

    /// Goes on in `mode` from here, forgetting what earlier ticks granted and what went wrong.
    fn play(&mut self, mode: Mode) {
        self.clock.set_mode(mode);
        if let LabStage::Ready(runs) = &mut self.stage {
            runs.forget_faults();
        }
    }
}

/// Whether what is set after `command` is another change than what was set before it, even within
/// one drag.
fn parts_changes(command: &LabCommand) -> bool {
    match command {
        LabCommand::All(command) => !matches!(command, Command::Set { .. }),
        LabCommand::SetIn { .. }
        | LabCommand::OpenChange
        | LabCommand::CloseChange
        | LabCommand::ForgetMeasured(_)
        | LabCommand::MeasureFlow
        | LabCommand::NameBranch { .. }
        | LabCommand::Rescue { .. }
        | LabCommand::Hold(_)
        | LabCommand::Threads(_) => false,
        LabCommand::Compare { .. } | LabCommand::EndComparison { .. } | LabCommand::Save { .. } => {
            true
        }
    }
}
