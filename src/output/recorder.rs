//! Which file of a run is written when.
//!
//! In: a [`RunSoFar`] at each output time, and one at the end. Out: the files of the folder, each
//! whole at any time; whatever happens after a file was written, it stays. The series and the lists
//! of frames grow with the run, and are made durable with them at an output, at most once a
//! second. Bytes written grow like what there is to say: nothing but the summary is written twice.

use super::collection_file::CollectedFile;
use super::events_file::{EVENTS, events_table, write_events};
use super::folder::{CHECKPOINT, FRAME_LOG, OutputFolder, PROFILES, SAMPLES, SUMMARY};
use super::frames::{self, Frame, FrameFiles, WrittenFrames};
use super::profile_files::{FLOW, PROFILE, flow_table, profile_table, write_flow, write_profile};
use super::series_file::{SERIES, SeriesFile};
use super::summary_file::SummaryFile;
use super::velocity_file::{VELOCITY, velocity_table, write_velocity};
use super::{Ending, OutputError, RunSoFar};
use crate::measure::{Deposit, Summary, floor_pressure};
use crate::run::{Provenance, TABLES_METADATA, VERSION, method, write_metadata};
use crate::scene::Scene;
use crate::solver::{Extremes, TimeStepAdvice, advise};
use crate::world::{Clock, World};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::mem::take;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Least wall-clock time between two times that outputs are made durable.
const SYNC_TIME: Duration = Duration::from_secs(1);
/// Most of a run's wall-clock time that this may cost, as one part in so many.
const SHARE_OF_TIME: u32 = 20;
/// Files by these names, and the frames', are a run's own; those of an earlier run give way to a
/// later one.
const OWN: [&str; 10] = [
    CHECKPOINT,
    SAMPLES,
    PROFILES,
    FRAME_LOG,
    SERIES,
    FLOW,
    VELOCITY,
    PROFILE,
    EVENTS,
    TABLES_METADATA,
];

/// All of them.
fn own() -> Vec<&'static str> {
    OWN.into_iter().chain(frames::OTHERS).collect()
}

/// What is recorded.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene that is run.
    pub scene: Arc<Scene>,
    /// What to call it in the summary.
    pub name: String,
    /// Threads the solver works on.
    pub threads: usize,
    /// Whether the grains are written at each output time.
    pub grains: bool,
    /// Whether another program computed the run.
    pub imported: bool,
}

/// The status of a run that another program computed.
pub const IMPORTED: &str = "imported";

/// What was written so far, to go on with later.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    frames: WrittenFrames,
    /// Outputs that are done or past.
    outputs: u64,
    /// Wall-clock time that it took [s].
    wall_time: f64,
}

/// The same but for the frames, of which a log is kept.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct WrittenRest {
    lasting: Vec<CollectedFile>,
    outputs: u64,
    wall_time: f64,
}

impl WrittenRest {
    /// All that was written, with these `frames`.
    pub fn with(self, frames: Vec<Frame>) -> Written {
        Written {
            frames: WrittenFrames::new(frames, self.lasting),
            outputs: self.outputs,
            wall_time: self.wall_time,
        }
    }
}

impl Written {
    /// What is kept of the outputs from number `from` on, which is not forgotten.
    pub fn frames_since(&self, from: usize) -> &[Frame] {
        self.frames.since(from)
    }

    /// What is kept beside a log of the frames.
    pub fn rest(&self) -> WrittenRest {
        WrittenRest {
            lasting: self.frames.lasting().to_vec(),
            outputs: self.outputs,
            wall_time: self.wall_time,
        }
    }

    /// The first of the frames' files that `folder` does not hold.
    pub fn missing(&self, folder: &Path) -> Option<String> {
        self.frames.missing(folder)
    }

    /// Wall-clock time that the run took until then [s].
    pub fn wall_time(&self) -> f64 {
        self.wall_time
    }
}

/// Writes a run's files.
pub struct Recorder {
    subject: Subject,
    extremes: Extremes,
    folder: OutputFolder,
    written: Written,
    series: Option<SeriesFile>,
    frames: Option<FrameFiles>,
    /// When all that was written was last made durable.
    synced: Instant,
    /// Wall-clock time that this took: a busy disk takes its time.
    sync_cost: Duration,
    /// When the run was begun or gone on with.
    started: Instant,
}

impl Recorder {
    /// Makes `folder` that of a run of `subject`: of an earlier run nothing is left in it.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn begin(subject: Subject, folder: OutputFolder) -> Result<Self, OutputError> {
        folder.check(&own())?;
        // A checkpoint must not be taken for one of the run that the summary is of.
        folder.remove(CHECKPOINT)?;
        let mut recorder = Self::new(subject, folder, Written::default());
        recorder.mark()?;
        recorder.folder.clear(&own(), &[])?;
        recorder.begin_frames()?;
        Ok(recorder)
    }

    /// Goes on in `folder` with a run of `subject` of which so much was `written` before; what was
    /// written later is removed, as it is computed again.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn go_on(
        subject: Subject,
        folder: OutputFolder,
        written: Written,
    ) -> Result<Self, OutputError> {
        folder.check(&own())?;
        let files: Vec<String> = written.frames.files().map(|frame| frame.name).collect();
        let mut recorder = Self::new(subject, folder, written);
        recorder.mark()?;
        recorder.begin_frames()?;
        let kept: Vec<&str> = [CHECKPOINT, SAMPLES, PROFILES, FRAME_LOG, SERIES]
            .into_iter()
            .chain(frames::LISTS)
            .chain(files.iter().map(String::as_str))
            .collect();
        recorder.folder.clear(&own(), &kept)?;
        Ok(recorder)
    }

    /// Of a run of `subject` in `folder` that is done, with all that was `written`: nothing is
    /// written any more.
    pub fn of_done(subject: Subject, folder: OutputFolder, written: Written) -> Self {
        Self::new(subject, folder, written)
    }

    fn new(subject: Subject, folder: OutputFolder, written: Written) -> Self {
        Self {
            extremes: Extremes::of(&subject.scene),
            subject,
            folder,
            written,
            series: None,
            frames: None,
            synced: Instant::now(),
            sync_cost: Duration::ZERO,
            started: Instant::now(),
        }
    }

    /// Says in the folder that a run goes on there.
    fn mark(&self) -> Result<(), OutputError> {
        let advice = self.advice(None);
        self.write_summary(
            None,
            "running",
            None,
            advice.warning.as_slice(),
            &BTreeMap::new(),
        )
    }

    fn begin_frames(&mut self) -> Result<(), OutputError> {
        if self.subject.grains {
            let (from, written) = (self.provenance(None), take(&mut self.written.frames));
            self.frames = Some(FrameFiles::begin(&self.folder, written, &from)?);
        }
        Ok(())
    }

    /// The step of the next output; none where grains are not written.
    pub fn next_output(&self, clock: &Clock) -> Option<u64> {
        let time = self.written.outputs as f64 * self.subject.scene.output_interval;
        self.subject.grains.then(|| clock.step_at(time))
    }

    /// Writes what is new at the present state; says whether that was an output.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn record(&mut self, run: RunSoFar) -> Result<bool, OutputError> {
        self.write_series(Some(run))?;
        let clock = &run.world.clock;
        let is_due = |step: Option<u64>| step.is_some_and(|step| step <= clock.step);
        let is_output = is_due(self.next_output(clock));
        if is_output {
            self.write_frame(run.world)?;
            let affordable = self.sync_cost.saturating_mul(SHARE_OF_TIME);
            if self.synced.elapsed() >= affordable.max(SYNC_TIME) {
                self.sync()?;
            }
        }
        while is_due(self.next_output(clock)) {
            self.written.outputs += 1;
        }
        Ok(is_output)
    }

    /// Forgets what is kept of the first outputs, so many: it stands in a log.
    pub fn forget_frames(&mut self, first: usize) {
        if let Some(frames) = &mut self.frames {
            frames.written_mut().forget(first);
        }
    }

    /// Takes what was forgotten from `all` that the log holds, as is wanted before the end.
    pub fn remember_frames(&mut self, all: &[Frame]) {
        if let Some(frames) = &mut self.frames {
            frames.written_mut().remember(all);
        }
    }

    /// Writes the present state as an output, whenever that is: of a run whose outputs are not ours
    /// to choose.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn record_output(&mut self, run: RunSoFar) -> Result<(), OutputError> {
        self.write_series(Some(run))?;
        self.write_frame(run.world)
    }

    /// Whether the table of samples is to be written anew with all of them at the present state.
    pub fn rewrites_series(&self, run: RunSoFar) -> bool {
        (self.series.as_ref()).is_some_and(|series| series.begins_anew(run))
    }

    /// Makes all that was written durable.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&mut self) -> Result<(), OutputError> {
        let started = Instant::now();
        if let Some(frames) = &mut self.frames {
            frames.sync(&self.folder)?;
        }
        if let Some(series) = &self.series {
            series.sync(&self.folder)?;
        }
        self.synced = Instant::now();
        self.sync_cost = started.elapsed();
        Ok(())
    }

    /// Writes the last files of a run that ended as `ending` says, with what people should know in
    /// `warnings`, and returns its results. A run that never stood at time zero is none.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn finish(
        &mut self,
        run: Option<RunSoFar>,
        ending: &Ending,
        warnings: &[String],
    ) -> Result<Summary, OutputError> {
        if let Some(RunSoFar { world, .. }) = run
            && let Some(frames) = &self.frames
            && frames.written().last_time() != Some(world.time())
        {
            self.write_frame(world)?;
        }
        self.write_series(run)?;
        self.sync()?;
        let mut files = self.write_tables(run)?;
        if let Some(frames) = &self.frames {
            files.extend(frames.finish(&self.folder, &self.provenance(run))?);
        }
        let results = RunSoFar::results_of(run);
        let end = Some((ending, &results));
        let status = if self.subject.imported {
            IMPORTED
        } else {
            ending.status()
        };
        self.write_summary(run, status, end, warnings, &files)?;
        Ok(results)
    }

    /// What was written so far.
    pub fn written(&self) -> Written {
        let frames = self.frames.as_ref().map(FrameFiles::written);
        Written {
            wall_time: self.wall_time(),
            frames: frames.unwrap_or(&self.written.frames).clone(),
            ..self.written
        }
    }

    /// The folder that is written to.
    pub fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    /// Wall-clock time of the run, without that between a stop and going on [s].
    pub fn wall_time(&self) -> f64 {
        self.written.wall_time + self.started.elapsed().as_secs_f64()
    }

    fn write_frame(&mut self, world: &World) -> Result<(), OutputError> {
        let from = Provenance::of(&self.subject.scene, world);
        match &mut self.frames {
            Some(frames) => frames.write(&self.folder, world, &from),
            None => Ok(()),
        }
    }

    /// Writes the samples that are new.
    fn write_series(&mut self, run: Option<RunSoFar>) -> Result<(), OutputError> {
        match (&mut self.series, run) {
            (Some(series), Some(run)) => series.go_on(&self.folder, run),
            (Some(_), None) => Ok(()),
            (None, run) => {
                self.series = Some(SeriesFile::begin(&self.folder, run)?);
                Ok(())
            }
        }
    }

    /// Writes the tables of a run's end and what says where they come from; returns the digests of
    /// all tables.
    fn write_tables(&self, run: Option<RunSoFar>) -> Result<BTreeMap<String, String>, OutputError> {
        let from = run.map_or(0.0, |run| run.results_from());
        let flow = run.map(|run| run.flow.mean_since(from));
        let flow = flow.filter(|flow| !flow.depths.is_empty());
        let fastest = run.and_then(|run| run.flow.fastest_since(from));
        let deposit = run.and_then(|run| Deposit::of(run.world));
        let profile = run.zip(deposit).map(|(run, deposit)| {
            let heights = deposit.height_profile();
            let pressure = floor_pressure(run.world, &heights);
            (heights, pressure)
        });
        let events = run.map(|run| (run.events(), &run.world.container.walls));
        let events = events.filter(|(events, _)| !events.is_empty());
        let series = self.series.as_ref();
        let tables = [
            (
                series.map(SeriesFile::table),
                series.map(SeriesFile::digest),
            ),
            (
                Some(flow_table()),
                self.write_table(FLOW, flow.as_ref(), write_flow)?,
            ),
            (
                Some(velocity_table()),
                self.write_table(VELOCITY, fastest, write_velocity)?,
            ),
            (
                Some(profile_table()),
                self.write_table(PROFILE, profile.as_ref(), |(heights, pressure), file| {
                    write_profile(heights, pressure, file)
                })?,
            ),
            (
                Some(events_table()),
                self.write_table(EVENTS, events.as_ref(), |(events, walls), file| {
                    write_events(events, walls, file)
                })?,
            ),
        ];
        let written = tables
            .into_iter()
            .filter_map(|(table, digest)| Some((table?, digest?)));
        let (tables, digests): (Vec<_>, Vec<_>) = written.unzip();
        let from = self.provenance(run);
        let metadata = self
            .folder
            .write(TABLES_METADATA, |file| write_metadata(&tables, &from, file))?;
        let names = tables.into_iter().map(|table| table.name);
        let mut files: BTreeMap<String, String> = names.zip(digests).collect();
        files.insert(TABLES_METADATA.into(), metadata);
        Ok(files)
    }

    /// Writes the table called `name` and returns its digest; where the run has nothing for it,
    /// there is none.
    fn write_table<T>(
        &self,
        name: &'static str,
        content: Option<&T>,
        write: fn(&T, &mut dyn Write) -> io::Result<()>,
    ) -> Result<Option<String>, OutputError> {
        let Some(content) = content else {
            self.folder.remove(name)?;
            return Ok(None);
        };
        let digest = self.folder.write(name, |file| write(content, file))?;
        Ok(Some(digest))
    }

    /// Where the files of the run so far come from.
    fn provenance(&self, run: Option<RunSoFar>) -> Provenance {
        let scene = &self.subject.scene;
        run.map_or_else(
            || Provenance::of_scene(scene),
            |run| Provenance::of(scene, run.world),
        )
    }

    /// The time step and the limits that the present state sets.
    fn advice(&self, run: Option<RunSoFar>) -> TimeStepAdvice {
        run.map_or_else(
            || advise(&self.subject.scene),
            |run| self.extremes.advise(run.world),
        )
    }

    fn write_summary(
        &self,
        run: Option<RunSoFar>,
        status: &'static str,
        end: Option<(&Ending, &Summary)>,
        warnings: &[String],
        files: &BTreeMap<String, String>,
    ) -> Result<(), OutputError> {
        let world = run.map(|run| run.world);
        let scene = &self.subject.scene;
        let summary = SummaryFile {
            program: "grainfall",
            version: VERSION,
            method: method(scene),
            status,
            fault: end.and_then(|(ending, _)| ending.fault()),
            name: &self.subject.name,
            seed: scene.seed,
            scene,
            commands: run.map_or(&[], |run| run.commands),
            time_step: &self.advice(run),
            steps: world.map_or(0, |world| world.clock.step),
            time: world.map_or(0.0, World::time),
            grains: world.map_or(0, |world| world.grains.len()),
            state_hash: world.map(|world| world.hash().to_string()),
            results: end.map(|(_, results)| results),
            wall_time: self.wall_time(),
            threads: self.subject.threads,
            warnings,
            files,
        };
        self.folder.write(SUMMARY, |file| summary.write(file))?;
        Ok(())
    }
}
