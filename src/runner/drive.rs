//! The loop that drives a run to its end.
//!
//! In: a [`Job`] and what moves its run. Out: the run's files and a [`Finished`]. On the way the
//! loop hears whether to stop, tells how far the run has come, and holds at each output time.

use super::checkpoint::{CheckpointFile, CheckpointLookup, Kept};
use super::rest::RestWatch;
use super::{Advance, At, DirectRun, Halt, Job, RunnerError, Watch, spoken};
use crate::measure::Summary;
use crate::output::{Ending, OutputError, OutputFolder, Recorder, RunSoFar, Subject};
use crate::run::{Checkpoint, Measured, Stored, method};
use crate::scene::Scene;
use crate::world::Clock;
use std::fmt;
use std::sync::Arc;
use std::time::Instant;

/// How a job ended and what came out.
#[derive(Clone, Debug)]
pub struct Finished {
    /// How it ended.
    pub ending: Ending,
    /// Its results.
    pub results: Summary,
    /// Wall-clock time since it was begun or gone on with [s].
    pub wall_time: f64,
    /// What people should know, in sentences.
    pub warnings: Vec<String>,
    /// Whether all of it was there already, and nothing was written.
    pub was_done: bool,
}

/// Runs `job` by itself, without an app, until it is done, a fault occurs or `stop` says so;
/// `watch` hears how far it has come. Returns how it ended, and the run as it stands then; one that
/// was done already is only read ([`DirectRun::standing_at`]).
///
/// ```
/// use grainfall::runner::{self, Job};
/// use grainfall::scene::Scene;
///
/// let mut scene = Scene::open("bouncing-grain")?;
/// scene.set("duration", "20ms")?;
/// let folder = tempfile::tempdir()?;
/// let job = Job::new("bounce", scene, folder.path());
/// let (finished, run) = runner::run(&job, &mut (), &|| false)?;
/// assert_eq!(finished.ending.status(), "done");
/// assert!(run.run().is_some_and(|run| run.world().time() > 0.019));
/// assert!(folder.path().join("summary.json").is_file());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be written.
pub fn run(
    job: &Job,
    watch: &mut dyn Watch,
    stop: &dyn Fn() -> bool,
) -> Result<(Finished, DirectRun), RunnerError> {
    let mut runner = Runner::open(job)?;
    let is_done = runner.is_done();
    let mut run = match runner.take_checkpoint() {
        Some(end) if is_done => {
            DirectRun::standing_at(end, Arc::new(job.scene.clone()), job.threads)
        }
        checkpoint => DirectRun::of(job).from_checkpoint(checkpoint),
    };
    let finished = runner.finish(&mut run, watch, stop)?;
    Ok((finished, run))
}

/// Refuses `job` where that is known without running it: where it asks for something that cannot
/// be, or its folder holds another run. Nothing is written.
///
/// # Errors
/// The [`RunnerError`] that [`Runner::open`] would answer with.
pub fn look(job: &Job) -> Result<(), RunnerError> {
    job.check()?;
    if job.restart || !job.checkpoints {
        return Ok(());
    }
    match CheckpointFile::of(job)?.other() {
        Some(reason) => Err(OutputError::OtherRun {
            path: job.out.clone(),
            reason,
        }
        .into()),
        None => Ok(()),
    }
}

/// How a job stands in its folder.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// It has come to nothing yet.
    Nothing,
    /// It was stopped at this simulated time [s].
    Until(f64),
    /// All of it is there.
    Done,
    /// Another program runs it.
    Taken(String),
}

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("not begun"),
            Self::Until(time) => write!(f, "stopped at t = {time:.6} s"),
            Self::Done => f.write_str("done"),
            Self::Taken(holder) => write!(f, "being run by {holder}"),
        }
    }
}

/// How `job` stands in its folder. Nothing is computed, and nothing is written but the folder's
/// lock.
///
/// # Errors
/// When the job asks for something that cannot be, or its folder holds another run or cannot be
/// read.
pub fn standing(job: &Job) -> Result<Standing, RunnerError> {
    job.check()?;
    if !job.out.is_dir() {
        return Ok(Standing::Nothing);
    }
    let folder = match OutputFolder::lock(&job.out) {
        Err(OutputError::Taken { holder, .. }) => return Ok(Standing::Taken(holder)),
        folder => folder?,
    };
    let Some(kept) = find(job, &mut CheckpointFile::of(job)?, &folder)? else {
        return Ok(Standing::Nothing);
    };
    Ok(if is_done(&kept, &folder, job)? {
        Standing::Done
    } else {
        Standing::Until(kept.checkpoint.world().time())
    })
}

impl DirectRun {
    /// The run that `job` asks for, at its beginning.
    pub fn of(job: &Job) -> Self {
        let scene = Arc::new(job.scene.clone());
        Self::new(scene, job.script.clone(), job.threads, job.beds.clone())
    }
}

/// A job that is being run.
pub struct Runner {
    end: End,
    rest: Option<RestWatch>,
    recorder: Recorder,
    checkpoints: Option<CheckpointFile>,
    /// Where the run goes on, if it was stopped before.
    checkpoint: Option<Checkpoint>,
    /// Whether the folder holds all of it already.
    is_done: bool,
    warnings: Vec<String>,
}

impl Runner {
    /// Checks `job`, then opens its folder, and what is kept there of it. A job that is refused
    /// leaves the folder as it was.
    ///
    /// # Errors
    /// When the job asks for something that cannot be, or its folder holds other files or another
    /// run, is written to by another program or cannot be written.
    pub fn open(job: &Job) -> Result<Self, RunnerError> {
        job.check()?;
        let folder = OutputFolder::lock(&job.out)?;
        let mut checkpoints = job
            .checkpoints
            .then(|| CheckpointFile::of(job))
            .transpose()?;
        let kept = match &mut checkpoints {
            Some(file) if !job.restart => find(job, file, &folder)?,
            _ => None,
        };
        let subject = Subject {
            scene: Arc::new(job.scene.clone()),
            name: job.name.clone(),
            threads: job.threads,
            grains: job.grains,
            imported: false,
        };
        let warnings = folder.warning().into_iter().collect();
        let is_done = match &kept {
            Some(kept) => is_done(kept, &folder, job)?,
            None => false,
        };
        if kept.is_some() && !is_done {
            check_method(&folder, &job.scene)?;
        }
        let (recorder, checkpoint) = match kept {
            Some(kept) if is_done => {
                let recorder = Recorder::of_done(subject, folder, kept.written);
                (recorder, Some(kept.checkpoint))
            }
            Some(kept) => {
                let recorder = Recorder::go_on(subject, folder, kept.written)?;
                (recorder, Some(kept.checkpoint))
            }
            None => (Recorder::begin(subject, folder)?, None),
        };
        let end = match &checkpoint {
            Some(end) if is_done => End::Step(end.world().clock.step, end.world().time()),
            _ => End::Time(job.scene.duration),
        };
        Ok(Self {
            end,
            rest: RestWatch::of(job),
            recorder,
            checkpoints,
            checkpoint,
            is_done,
            warnings,
        })
    }

    /// The same with a checkpoint kept at every look, after which all may be forgotten.
    #[cfg(test)]
    #[must_use]
    pub fn keeping_always(mut self) -> Self {
        if let Some(file) = &mut self.checkpoints {
            file.keep_always();
        }
        self
    }

    /// Whether the folder holds all of the run already: then it is only read.
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// Simulated time at which the run goes on, if it was stopped before [s].
    pub fn goes_on_from(&self) -> Option<f64> {
        let checkpoint = self.checkpoint.as_ref()?;
        Some(checkpoint.world().time())
    }

    /// Where the run goes on, if it was stopped before.
    pub fn take_checkpoint(&mut self) -> Option<Checkpoint> {
        self.checkpoint.take()
    }

    /// Moves `run` to its end and writes its last files.
    ///
    /// # Errors
    /// When its commands cannot be carried out, or a file cannot be written.
    pub fn finish(
        mut self,
        run: &mut dyn Advance,
        watch: &mut dyn Watch,
        stop: &dyn Fn() -> bool,
    ) -> Result<Finished, RunnerError> {
        let end = self.end;
        let writing = (!self.is_done).then_some(&mut self);
        let ending = drive(run, end, writing, watch, stop)?;
        self.warnings.extend(run.warnings());
        let view = run.at().state();
        if ending == Ending::Done && view.is_some_and(|view| self.still_moves(view)) {
            self.warnings.push(format!(
                "the column still moves at t = {:.6} s, its duration: a longer --duration lets it come to rest",
                end.time()
            ));
        }
        if self.is_done {
            return Ok(Finished {
                ending,
                results: RunSoFar::results_of(view),
                wall_time: self.recorder.written().wall_time(),
                warnings: self.warnings,
                was_done: true,
            });
        }
        if let Some(view) = view {
            self.keep(view)?;
            if let Some(measured) = self.forgotten(view)? {
                run.remember(measured);
            }
            if let Some(file) = &self.checkpoints {
                self.recorder.remember_frames(&file.frames()?);
            }
        }
        let view = run.at().state();
        let results = self.recorder.finish(view, &ending, &self.warnings)?;
        Ok(Finished {
            ending,
            results,
            wall_time: self.recorder.wall_time(),
            warnings: self.warnings,
            was_done: false,
        })
    }

    /// Writes what is due at the present state; returns the step at which something is due next,
    /// none where the run ends here.
    fn record(&mut self, run: RunSoFar) -> Result<Option<u64>, RunnerError> {
        let all = if self.recorder.rewrites_series(run) {
            self.forgotten(run)?
        } else {
            None
        };
        let with_all = all.as_ref().map(|all| RunSoFar {
            series: &all.series,
            flow: &all.flow,
            ..run
        });
        let is_output = self.recorder.record(with_all.unwrap_or(run))?;
        let checkpoints = self.checkpoints.as_ref();
        if checkpoints.is_some_and(|file| file.is_due(is_output)) {
            self.keep(run)?;
        }
        if self.rest.is_some_and(|rest| rests(rest, run)) {
            return Ok(None);
        }
        let clock = &run.world.clock;
        let look = self.rest.map(|rest| rest.next_look(clock));
        let due = [self.recorder.next_output(clock), look];
        Ok(Some(due.into_iter().flatten().min().unwrap_or(u64::MAX)))
    }

    /// Whether the run was to come to rest and has not.
    fn still_moves(&self, run: RunSoFar) -> bool {
        self.rest
            .is_some_and(|rest| !self.is_done && !rests(rest, run))
    }

    /// All that was measured of `run`, where some of it was forgotten.
    fn forgotten(&self, run: RunSoFar) -> Result<Option<Measured>, OutputError> {
        let is_part = run.series.is_part() || run.flow.is_part();
        let file = self.checkpoints.as_ref().filter(|_| is_part);
        file.map(|file| file.measured(run)).transpose()
    }

    /// What of the run may be forgotten: it stands in the table of samples and in the checkpoint.
    fn stored(&self) -> Stored {
        let file = self.checkpoints.as_ref().filter(|_| self.rest.is_none());
        file.map_or_else(Stored::default, CheckpointFile::stored)
    }

    /// Keeps a checkpoint, if any is to be kept.
    fn keep(&mut self, run: RunSoFar) -> Result<(), RunnerError> {
        let Some(file) = &mut self.checkpoints else {
            return Ok(());
        };
        let started = Instant::now();
        self.recorder.sync()?;
        file.write(run, &self.recorder.written(), started)?;
        self.recorder.forget_frames(file.frames_stored());
        Ok(())
    }
}

/// What is kept of `job` in its `folder`, from which it goes on.
fn find(
    job: &Job,
    file: &mut CheckpointFile,
    folder: &OutputFolder,
) -> Result<Option<Kept>, RunnerError> {
    let refuse = |reason: String| {
        let path = folder.path().to_owned();
        Err(OutputError::OtherRun { path, reason }.into())
    };
    match file.read() {
        CheckpointLookup::Kept(kept) => {
            if let Err(reason) = kept.checkpoint.check(&job.scene) {
                return refuse(format!("its checkpoint cannot be used: {reason}"));
            }
            if let Some(missing) = kept.written.missing(folder.path()) {
                return refuse(format!("its file {missing} is missing"));
            }
            let world = kept.checkpoint.world();
            if world.time() > job.scene.duration + world.clock.time_step {
                return refuse(format!(
                    "it came to t = {:.6} s already, beyond the {} s asked for",
                    world.time(),
                    job.scene.duration
                ));
            }
            Ok(Some(*kept))
        }
        CheckpointLookup::Unusable(reason) => refuse(reason),
        CheckpointLookup::Nothing if folder.is_begun_only()? => Ok(None),
        CheckpointLookup::Nothing => {
            refuse("it has results and no checkpoint to go on from".into())
        }
    }
}

/// Refuses to go on in `folder` with a run that another solver computed: its end would be nobody's.
fn check_method(folder: &OutputFolder, scene: &Scene) -> Result<(), RunnerError> {
    let own = method(scene);
    match folder.summary()?["method"].as_str() {
        Some(other) if other != own => Err(OutputError::OtherRun {
            path: folder.path().to_owned(),
            reason: format!(
                "it was computed by method {other}, and this build of Grainfall computes by {own}"
            ),
        }
        .into()),
        _ => Ok(()),
    }
}

/// Whether `run` has come to the rest that ends it.
fn rests(rest: RestWatch, run: RunSoFar) -> bool {
    rest.ends(run.world, run.series, run.commands.len())
}

/// Whether `folder` holds all files of the run that is `kept`, which has come to the end of `job`.
fn is_done(kept: &Kept, folder: &OutputFolder, job: &Job) -> Result<bool, RunnerError> {
    let (summary, end) = (folder.summary()?, &kept.checkpoint);
    let world = end.world();
    let rest = RestWatch::of(job);
    let is_at_rest = rest.is_some_and(|rest| rest.ends(world, end.series(), end.command_count()));
    let files = summary["files"].as_object();
    let is_there = |name: &String| folder.path().join(name).is_file();
    Ok(
        (is_at_rest || world.clock.step_at(job.scene.duration) <= world.clock.step)
            && summary["status"] == "done"
            && summary["state_hash"] == world.hash().to_string()
            && files.is_some_and(|files| files.keys().all(is_there)),
    )
}

/// Where a run ends.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// At this simulated time [s].
    Time(f64),
    /// After this many steps, at about this simulated time [s].
    Step(u64, f64),
}

impl End {
    fn step(self, clock: &Clock) -> u64 {
        match self {
            Self::Time(time) => clock.step_at(time),
            Self::Step(step, _) => step,
        }
    }

    fn time(self) -> f64 {
        match self {
            Self::Time(time) | Self::Step(_, time) => time,
        }
    }
}

/// The loop: moves `run` until its `end`, a fault, or until `stop` says so. On the way `runner`, if
/// there is one, writes files.
///
/// # Errors
/// When the run's commands cannot be carried out, or a file cannot be written.
pub fn drive(
    run: &mut dyn Advance,
    end: End,
    mut runner: Option<&mut Runner>,
    watch: &mut dyn Watch,
    stop: &dyn Fn() -> bool,
) -> Result<Ending, RunnerError> {
    let mut pace = Pace::new();
    let mut told = Stored::default();
    loop {
        let goal = match run.at() {
            At::Preparing { stage, share } => {
                watch.preparing(share, stage);
                0
            }
            At::State(view) => {
                pace.tell(view.world.time(), end.time(), watch);
                let due = match &mut runner {
                    Some(runner) => runner.record(view)?,
                    None => Some(u64::MAX),
                };
                let clock = &view.world.clock;
                let last = end.step(clock);
                match due {
                    Some(due) if clock.step < last => due.min(last),
                    _ => return Ok(Ending::Done),
                }
            }
        };
        if stop() {
            return Ok(Ending::Interrupted);
        }
        let stored = (runner.as_ref()).map_or(told, |runner| runner.stored());
        if stored != told {
            run.forget(stored);
            told = stored;
        }
        match run.advance(goal) {
            Ok(()) => {}
            Err(Halt::Fault(fault)) => return Ok(Ending::Faulted(fault)),
            Err(Halt::Refused(reason)) => return Err(RunnerError::Input(reason)),
        }
    }
}

/// How fast a run goes.
struct Pace {
    /// Since when, and from which simulated time [s] on.
    from: Option<(Instant, f64)>,
}

impl Pace {
    fn new() -> Self {
        Self { from: None }
    }

    /// Tells `watch` that a run to `end` has come to `time` [s].
    fn tell(&mut self, time: f64, end: f64, watch: &mut dyn Watch) {
        let (since, from) = *self.from.get_or_insert_with(|| (Instant::now(), time));
        watch.running(time / end, &|| {
            let pace = (time - from) / since.elapsed().as_secs_f64();
            let left = (end - time) / pace;
            format!(
                "t = {time:.2} s of {} s, {pace:.2} × real time, {} left",
                (100.0 * end).round() / 100.0,
                spoken(left)
            )
        });
    }
}
