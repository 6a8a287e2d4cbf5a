//! What a headless run leaves behind while it goes on.
//!
//! In: a [`Simulation`] that holds at each output time. Out: the files of the folder, each whole; whatever happens after a
//! file was written, it stays.

use super::folder::{OutputFolder, SUMMARY};
use super::grains_file::{COLLECTION, extension, write_collection, write_grains};
use super::profile_files::{FLOW, PROFILE, write_flow, write_profile};
use super::series_file::{SERIES, write_series};
use super::summary_file::SummaryFile;
use super::velocity_file::{VELOCITY, write_velocity};
use super::{Ending, HeadlessError, Job};
use crate::measure::{Deposit, Measure, Summary, results, summarise};
use crate::simulation::{Provenance, SMALLEST_DROP, Simulation, TABLES_METADATA};
use crate::world::{Clock, World};
use std::time::{Duration, Instant};

/// Share of a run, from its start, that results leave out: the paper averages over the last 30 of 50 s.
const LEFT_OUT: f64 = 0.4;

/// Wall-clock time after which a run that goes on writes its series anew, for those who look at it meanwhile.
const LISTING_TIME: Duration = Duration::from_secs(10);

/// Writes a run's files.
pub struct Recorder<'a> {
    job: &'a Job,
    folder: OutputFolder,
    /// The grains' files written, each with its time [s].
    frames: Vec<(f64, String)>,
    /// Outputs that are done or past.
    outputs: u64,
    started: Instant,
    /// When the lists of what was written were last written themselves.
    listed: Instant,
}

impl<'a> Recorder<'a> {
    /// Opens the folder of `job` and marks it as a run's.
    ///
    /// # Errors
    /// When the folder holds other files or cannot be written.
    pub fn open(job: &'a Job, simulation: &Simulation) -> Result<Self, HeadlessError> {
        let recorder = Self {
            job,
            folder: OutputFolder::open(&job.out)?,
            frames: Vec::new(),
            outputs: 0,
            started: Instant::now(),
            listed: Instant::now(),
        };
        recorder.write_summary(simulation, "running", None)?;
        Ok(recorder)
    }

    /// The step at which the run should hold next: an output time or the end.
    pub fn next_stop(&self, clock: &Clock) -> u64 {
        let output = self.outputs as f64 * self.job.scene.output_interval;
        clock.step_at(output.min(self.job.scene.duration))
    }

    /// Writes what is due at the present state and says whether the run is over.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn record(
        &mut self,
        simulation: &Simulation,
        world: &World,
    ) -> Result<bool, HeadlessError> {
        let clock = &world.clock;
        let over = clock.step >= clock.step_at(self.job.scene.duration);
        if clock.step < self.next_stop(clock) {
            return Ok(over);
        }
        self.write_grains(world)?;
        while !over && self.next_stop(clock) <= clock.step {
            self.outputs += 1;
        }
        if self.listed.elapsed() > LISTING_TIME {
            self.write_lists(simulation)?;
            self.listed = Instant::now();
        }
        Ok(over)
    }

    /// Writes the last files of a run that ended as `ending` says, and returns its results.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn finish(
        &mut self,
        simulation: &Simulation,
        ending: &Ending,
    ) -> Result<Summary, HeadlessError> {
        if let Some(world) = simulation.world()
            && self.frames.last().map(|(time, _)| *time) != Some(world.time())
        {
            self.write_grains(world)?;
        }
        self.write_lists(simulation)?;
        let end = simulation.world().map_or(0.0, |world| world.time());
        let from = LEFT_OUT * end;
        let series = simulation.series();
        let results = match simulation.world() {
            Some(world) => results(series, world, from, SMALLEST_DROP),
            None => summarise(series, from, SMALLEST_DROP),
        };
        self.write_flow(simulation, from)?;
        self.write_profile(simulation)?;
        self.write_tables_metadata(&self.provenance(simulation))?;
        self.write_summary(simulation, ending.name(), Some((ending, &results)))?;
        Ok(results)
    }

    /// Wall-clock time since the run was opened [s].
    pub fn wall_time(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Where the files are.
    pub fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    fn write_grains(&mut self, world: &World) -> Result<(), HeadlessError> {
        let name = OutputFolder::grains_name(self.frames.len(), extension(world));
        let from = Provenance::of(&self.job.scene, world);
        self.folder
            .write(&name, |file| write_grains(world, &from, file))?;
        self.frames.push((world.time(), name));
        Ok(())
    }

    fn write_flow(&self, simulation: &Simulation, from: f64) -> Result<(), HeadlessError> {
        let profile = simulation.flow().since(from);
        if profile.depth.is_empty() {
            return Ok(());
        }
        self.folder.write(FLOW, |file| write_flow(&profile, file))?;
        let Some(map) = simulation.flow().fastest_since(from) else {
            return Ok(());
        };
        self.folder
            .write(VELOCITY, |file| write_velocity(map, file))
    }

    fn write_profile(&self, simulation: &Simulation) -> Result<(), HeadlessError> {
        let Some(deposit) = simulation.world().and_then(|world| Deposit::of(world)) else {
            return Ok(());
        };
        self.folder.write(PROFILE, |file| {
            write_profile(&deposit.height_profile(), file)
        })
    }

    fn write_lists(&self, simulation: &Simulation) -> Result<(), HeadlessError> {
        let measures = simulation
            .world()
            .map_or_else(Vec::new, |world| Measure::of(world));
        self.folder.write(SERIES, |file| {
            write_series(simulation.series(), &measures, file)
        })?;
        let from = self.provenance(simulation);
        self.folder.write(COLLECTION, |file| {
            write_collection(&self.frames, &from, file)
        })
    }

    /// Where the files of the run so far come from.
    fn provenance(&self, simulation: &Simulation) -> Provenance {
        let scene = &self.job.scene;
        let of_scene = || Provenance::of_scene(scene);
        let world = simulation.world();
        world.map_or_else(of_scene, |world| Provenance::of(scene, world))
    }

    fn write_tables_metadata(&self, from: &Provenance) -> Result<(), HeadlessError> {
        let tables = [SERIES, FLOW, VELOCITY, PROFILE];
        let written: Vec<&str> = (tables.into_iter())
            .filter(|table| self.folder.path().join(table).exists())
            .collect();
        self.folder
            .write(TABLES_METADATA, |file| from.write_tables(&written, file))
    }

    fn write_summary(
        &self,
        simulation: &Simulation,
        status: &'static str,
        outcome: Option<(&Ending, &Summary)>,
    ) -> Result<(), HeadlessError> {
        let world = simulation.world();
        let summary = SummaryFile {
            program: "grainfall",
            version: env!("CARGO_PKG_VERSION"),
            status,
            fault: outcome.and_then(|(ending, _)| ending.fault()),
            name: &self.job.name,
            seed: self.job.scene.seed,
            scene: &self.job.scene,
            commands: simulation.commands(),
            time_step: simulation.advice(),
            steps: world.map_or(0, |world| world.clock.step),
            time: world.map_or(0.0, |world| world.time()),
            grains: world.map_or(0, |world| world.grains.len()),
            state_hash: world.map(|world| world.hash().to_string()),
            results: outcome.map(|(_, results)| results),
            wall_time: self.wall_time(),
            threads: self.job.threads,
            warnings: simulation.warnings(),
        };
        self.folder.write(SUMMARY, |file| summary.write(file))
    }
}
