//! The loop that drives a run to its end.
//!
//! In: a [`Job`] and what moves its run. Out: the run's files and a [`Finished`]. On the way the
//! loop hears whether to stop, tells how far the run has come, and holds at each output time.

use super::checkpoint::{CheckpointFile, CheckpointLookup, Kept};
use super::{Advance, At, DirectRun, Halt, Job, RunnerError, Watch, spoken};
use crate::measure::Summary;
use crate::output::{Ending, OutputFolder, Recorder, RunSoFar, Subject, Written};
use crate::run::Checkpoint;
use crate::world::Clock;
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
}

/// Runs `job` by itself, without an app, until it is done, a fault occurs or `stop` says so;
/// `watch` hears how far it has come. Returns how it ended, and the run as it stands then.
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
    let checkpoint = runner.take_checkpoint();
    let mut run = DirectRun::of(job).from_checkpoint(checkpoint);
    let finished = runner.finish(&mut run, watch, stop)?;
    Ok((finished, run))
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
    duration: f64,
    recorder: Recorder,
    checkpoints: Option<CheckpointFile>,
    /// Where the run goes on, if it was stopped before.
    checkpoint: Option<Checkpoint>,
    warnings: Vec<String>,
}

impl Runner {
    /// Opens the folder of `job`, and what is kept there of it.
    ///
    /// # Errors
    /// When the folder holds other files or cannot be written.
    pub fn open(job: &Job) -> Result<Self, RunnerError> {
        let checkpoints = job.checkpoints.then(|| CheckpointFile::of(job));
        let checkpoints = checkpoints.transpose()?;
        let mut warnings = Vec::new();
        let (mut checkpoint, mut written) = (None, Written::default());
        match checkpoints.as_ref().map(CheckpointFile::read) {
            Some(CheckpointLookup::Kept(kept)) => {
                written = kept.written;
                checkpoint = Some(kept.checkpoint);
            }
            Some(CheckpointLookup::Damaged(warning)) => warnings.push(warning),
            Some(CheckpointLookup::Nothing) | None => {}
        }
        let folder = OutputFolder::open(&job.out, &written.names())?;
        let subject = Subject {
            scene: Arc::new(job.scene.clone()),
            name: job.name.clone(),
            threads: job.threads,
            grains: job.grains,
        };
        Ok(Self {
            duration: job.scene.duration,
            recorder: Recorder::open(subject, folder, written)?,
            checkpoints,
            checkpoint,
            warnings,
        })
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
        let end = End::Time(self.duration);
        let ending = drive(run, end, Some(&mut self), watch, stop)?;
        if let Some(view) = run.at().state() {
            self.keep(view)?;
        }
        self.warnings.extend(run.warnings());
        let results = (self.recorder).finish(run.at().state(), &ending, &self.warnings)?;
        Ok(Finished {
            ending,
            results,
            wall_time: self.recorder.wall_time(),
            warnings: self.warnings,
        })
    }

    /// Writes what is due at the present state; returns the step of the next output.
    fn record(&mut self, run: RunSoFar) -> Result<Option<u64>, RunnerError> {
        self.recorder.record(run)?;
        if self
            .checkpoints
            .as_ref()
            .is_some_and(CheckpointFile::is_due)
        {
            self.keep(run)?;
        }
        Ok(self.recorder.next_output(&run.world.clock))
    }

    /// Keeps a checkpoint, if any is to be kept.
    fn keep(&mut self, run: RunSoFar) -> Result<(), RunnerError> {
        let Some(file) = &mut self.checkpoints else {
            return Ok(());
        };
        let checkpoint = Checkpoint::of(run.world, run.commands, run.series, run.flow);
        let written = self.recorder.written().clone();
        Ok(file.write(&Kept {
            checkpoint,
            written,
        })?)
    }
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
    loop {
        let goal = match run.at() {
            At::Preparing { stage, share } => {
                watch.preparing(share, stage);
                0
            }
            At::State(view) => {
                pace.tell(view.world.time(), end.time(), watch);
                let output = match &mut runner {
                    Some(runner) => runner.record(view)?,
                    None => None,
                };
                let clock = &view.world.clock;
                let last = end.step(clock);
                if clock.step >= last {
                    return Ok(Ending::Done);
                }
                output.unwrap_or(last).min(last)
            }
        };
        if stop() {
            return Ok(Ending::Interrupted);
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
