//! Which file of a run is written when.
//!
//! In: a [`RunSoFar`] at each output time, and one at the end. Out: the files of the folder, each
//! whole; whatever happens after a file was written, it stays.

use super::folder::{OutputFolder, SUMMARY};
use super::grains_file::{COLLECTION, extension, write_collection, write_grains};
use super::profile_files::{FLOW, PROFILE, write_flow, write_profile};
use super::series_file::{SERIES, write_series};
use super::summary_file::SummaryFile;
use super::velocity_file::{VELOCITY, write_velocity};
use super::{Ending, OutputError, RunSoFar};
use crate::measure::{Deposit, Measure, SMALLEST_DROP, Series, Summary, summarise};
use crate::run::{Provenance, TABLES_METADATA, VERSION};
use crate::scene::Scene;
use crate::solver::{Extremes, TimeStepAdvice, advise};
use crate::world::{Clock, World};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Wall-clock time after which a run that goes on writes its series anew, for those who look at it
/// meanwhile.
const LISTING_TIME: Duration = Duration::from_secs(10);

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
}

/// What was written so far, to go on with later.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Written {
    /// The grains' files, each with its time [s] and its name.
    frames: Vec<(f64, String)>,
    /// Outputs that are done or past.
    outputs: u64,
}

impl Written {
    /// The names of the grains' files.
    pub fn names(&self) -> Vec<&str> {
        self.frames.iter().map(|(_, name)| name.as_str()).collect()
    }
}

/// Writes a run's files.
pub struct Recorder {
    subject: Subject,
    extremes: Extremes,
    folder: OutputFolder,
    written: Written,
    /// When the run was begun or gone on with.
    started: Instant,
    /// When the lists of what was written were last written themselves.
    listed: Instant,
}

impl Recorder {
    /// Marks `folder` as that of a run of `subject` of which so much was `written` before.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn open(
        subject: Subject,
        folder: OutputFolder,
        written: Written,
    ) -> Result<Self, OutputError> {
        let recorder = Self {
            extremes: Extremes::of(&subject.scene),
            subject,
            folder,
            written,
            started: Instant::now(),
            listed: Instant::now(),
        };
        let advice = recorder.advice(None);
        recorder.write_summary(None, "running", None, advice.warning.as_slice())?;
        Ok(recorder)
    }

    /// The step of the next output; none where grains are not written.
    pub fn next_output(&self, clock: &Clock) -> Option<u64> {
        let time = self.written.outputs as f64 * self.subject.scene.output_interval;
        self.subject.grains.then(|| clock.step_at(time))
    }

    /// Writes what is due at the present state.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn record(&mut self, run: RunSoFar) -> Result<(), OutputError> {
        let clock = &run.world.clock;
        let is_due = |step: Option<u64>| step.is_some_and(|step| step <= clock.step);
        if is_due(self.next_output(clock)) {
            self.write_grains(run.world)?;
        }
        while is_due(self.next_output(clock)) {
            self.written.outputs += 1;
        }
        if self.listed.elapsed() > LISTING_TIME {
            self.write_lists(Some(run))?;
            self.listed = Instant::now();
        }
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
            && self.subject.grains
            && self.written.frames.last().map(|(time, _)| *time) != Some(world.time())
        {
            self.write_grains(world)?;
        }
        self.write_lists(run)?;
        self.write_tables(run)?;
        let results = match &run {
            Some(run) => run.results(),
            None => summarise(&Series::default(), 0.0, SMALLEST_DROP),
        };
        let end = Some((ending, &results));
        self.write_summary(run, ending.status(), end, warnings)?;
        Ok(results)
    }

    /// What was written so far.
    pub fn written(&self) -> &Written {
        &self.written
    }

    /// Wall-clock time since the run was begun or gone on with [s].
    pub fn wall_time(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    fn write_grains(&mut self, world: &World) -> Result<(), OutputError> {
        let name = OutputFolder::grains_name(self.written.frames.len(), extension(world));
        let from = Provenance::of(&self.subject.scene, world);
        self.folder
            .write(&name, |file| write_grains(world, &from, file))?;
        self.written.frames.push((world.time(), name));
        Ok(())
    }

    /// Writes the samples so far and the list of the grains' files.
    fn write_lists(&self, run: Option<RunSoFar>) -> Result<(), OutputError> {
        let none = Series::default();
        let series = run.map_or(&none, |run| run.series);
        let measures = run.map_or_else(Vec::new, |run| Measure::of(run.world));
        self.folder
            .write(SERIES, |file| write_series(series, &measures, file))?;
        if !self.subject.grains {
            return Ok(());
        }
        let from = self.provenance(run);
        self.folder.write(COLLECTION, |file| {
            write_collection(&self.written.frames, &from, file)
        })
    }

    /// Writes the tables of a run's end and what says where they come from.
    fn write_tables(&self, run: Option<RunSoFar>) -> Result<(), OutputError> {
        let from = run.map_or(0.0, |run| run.results_from());
        let flow = run.map(|run| run.flow.since(from));
        let flow = flow.filter(|profile| !profile.depth.is_empty());
        let fastest = run.and_then(|run| run.flow.fastest_since(from));
        let deposit = run.and_then(|run| Deposit::of(run.world));
        let heights = deposit.map(|deposit| deposit.height_profile());
        let written = [
            Some(SERIES),
            self.write_table(FLOW, flow.as_ref(), write_flow)?,
            self.write_table(VELOCITY, fastest, write_velocity)?,
            self.write_table(PROFILE, heights.as_ref(), write_profile)?,
        ];
        let written: Vec<&str> = written.into_iter().flatten().collect();
        let from = self.provenance(run);
        self.folder
            .write(TABLES_METADATA, |file| from.write_tables(&written, file))
    }

    /// Writes the table called `name` and returns its name; where the run has nothing for it, none
    /// of an earlier run is left.
    fn write_table<T>(
        &self,
        name: &'static str,
        content: Option<&T>,
        write: fn(&T, &mut dyn Write) -> io::Result<()>,
    ) -> Result<Option<&'static str>, OutputError> {
        match content {
            Some(content) => self.folder.write(name, |file| write(content, file))?,
            None => self.folder.remove(name)?,
        }
        Ok(content.map(|_| name))
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
    ) -> Result<(), OutputError> {
        let world = run.map(|run| run.world);
        let scene = &self.subject.scene;
        let summary = SummaryFile {
            program: "grainfall",
            version: VERSION,
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
        };
        self.folder.write(SUMMARY, |file| summary.write(file))
    }
}
