//! What an engine computed, measured as a run of ours is.
//!
//! In: dumps and data files, and the scene that they are of: from the folder of an export, or as a
//! person names it. Out: a run's folder with series, results and the grains at each instant, and
//! the last state as the list of grains of a new scene. What takes forces or the memory of contacts
//! is not a number in it.

use super::atom_types::GrainType;
use super::deck::DUMPS;
use super::export::{ExportRecord, RECORD};
use super::frames::{DUMP, FrameFile, XYZ};
use super::imported_state::{StateBuilder, without_unknown};
use super::mpi_engine::MpiEngine;
use super::{AtomFrame, FrameError};
use crate::measure::{FlowHistory, Series, Summary, sample_and_surface};
use crate::output::{Ending, OutputError, OutputFolder, Recorder, RunSoFar, Subject};
use crate::run::{Run, Sampling, Script, ScriptedCommand, StampedCommand};
use crate::runner::Watch;
use crate::scene::Scene;
use crate::solver::advise;
use crate::world::{SpeciesId, World, build};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most that a stated time may differ from that of its step, relative to it; some state six digits.
const SAME_TIME: f64 = 1e-5;

/// Why an engine's files cannot be taken in.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// A file is not what it has to be.
    #[error(transparent)]
    File(#[from] FrameError),
    /// The files do not belong to each other, or to the scene.
    #[error("{0}")]
    Unfit(String),
    /// A file could not be written.
    #[error(transparent)]
    Unwritten(#[from] OutputError),
}

/// What the files are of.
#[derive(Clone, Debug)]
pub struct ImportSource {
    /// What to call it.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// What was changed about it at time zero.
    pub commands: Vec<ScriptedCommand>,
    /// The engine's time step [s].
    pub time_step: f64,
    /// Types of grain, the first being 1; none where they are the scene's species.
    pub types: Option<Vec<GrainType>>,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Its results.
    pub results: Summary,
    /// The last state.
    pub last: World,
    /// The scene, as its record states it.
    pub scene: Scene,
    /// Instants that were read.
    pub frames: usize,
}

impl ImportSource {
    /// What the folder that holds the file or folder at `path`, or the folder above, is an export
    /// of; none where it is none.
    ///
    /// # Errors
    /// When there is a record of an export that cannot be read.
    pub fn beside(path: &Path) -> Result<Option<Self>, ImportError> {
        let absolute = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let mut folders = absolute.ancestors().take(3);
        let Some(folder) = folders.find(|folder| folder.join(RECORD).is_file()) else {
            return Ok(None);
        };
        let record = ExportRecord::read(folder).map_err(ImportError::Unfit)?;
        let engine: Result<MpiEngine, _> = record.engine.parse();
        let engine = engine.map_err(|reason| {
            ImportError::Unfit(format!(
                "{}: engine: {reason}",
                folder.join(RECORD).display()
            ))
        })?;
        Ok(Some(Self {
            name: format!("{}-{}", record.name, engine.word()),
            scene: record.scene,
            commands: record.commands,
            time_step: record.time_step,
            types: Some(record.types),
        }))
    }

    /// Files of `scene`, called `name`, with the time step that it states.
    pub fn of_scene(name: &str, scene: Scene, commands: Vec<ScriptedCommand>) -> Self {
        Self {
            name: name.to_owned(),
            time_step: advise(&scene).time_step,
            scene,
            commands,
            types: None,
        }
    }

    /// The scene's world at time zero, with what was changed then.
    fn template(&self) -> Result<(World, Vec<StampedCommand>), ImportError> {
        let world = build(&self.scene, self.time_step);
        let unfit = |reason: String| ImportError::Unfit(format!("{}: {reason}", self.name));
        let script = Script::new(&self.commands, &world.clock);
        let script = script.map_err(|error| unfit(error.to_string()))?;
        let mut run = Run::new(Arc::new(self.scene.clone()), world, 1);
        run.schedule(script)
            .map_err(|error| unfit(error.to_string()))?;
        let mut world = run.world().clone();
        world.clock.time_step = self.time_step;
        Ok((world, run.commands().to_vec()))
    }

    /// Types of grain: those that are stated where they fit, else one for each species.
    fn types(&self, world: &World) -> Vec<GrainType> {
        let species = world.species.iter().enumerate();
        let of_species = species.map(|(index, kind)| GrainType {
            species: SpeciesId(index as u16),
            material: kind.material,
            radius: 0.0,
        });
        let of_species: Vec<GrainType> = of_species.collect();
        let materials = world.materials.list().len();
        let is_known = |kind: &GrainType| {
            usize::from(kind.species.0) < of_species.len()
                && usize::from(kind.material.0) < materials
        };
        let stated = self
            .types
            .clone()
            .filter(|types| types.iter().all(is_known));
        stated.unwrap_or(of_species)
    }
}

/// The files that `paths` name: of a folder the dumps in it, or in its folder of dumps.
///
/// # Errors
/// When a folder cannot be read, or holds none.
pub fn named_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, ImportError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let dumps = path.join(DUMPS);
        let folder = if dumps.is_dir() { dumps } else { path.clone() };
        let unread = |error: std::io::Error| {
            let reason = format!("{}: cannot be read: {error}", folder.display());
            ImportError::Unfit(reason)
        };
        let before = files.len();
        for entry in fs::read_dir(&folder).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            if path
                .extension()
                .is_some_and(|word| word == DUMP || word == XYZ)
            {
                files.push(path);
            }
        }
        if files.len() == before {
            return Err(ImportError::Unfit(format!(
                "{} holds no dumps (files `*.{DUMP}` or `*.{XYZ}`): has the engine run?",
                folder.display()
            )));
        }
    }
    Ok(files)
}

/// `files` in order of the first step that each states; empty ones are left out.
fn in_order(files: &[PathBuf]) -> Result<Vec<PathBuf>, ImportError> {
    let mut found = Vec::new();
    for path in files {
        if let Some(first) = FrameFile::open(path)?.next_frame()? {
            found.push((first.step, path.clone()));
        }
    }
    found.sort_by_key(|file| file.0);
    Ok(found.into_iter().map(|(_, path)| path).collect())
}

/// Reads `files` of `source` and writes what they come to as a run to the folder `out`; an earlier
/// run there is replaced only where `restart` says so. `watch` hears how far it has come.
///
/// # Errors
/// When a file is not what it has to be, does not belong to the scene, or the folder cannot be
/// written.
pub fn import(
    files: &[PathBuf],
    source: &ImportSource,
    out: &Path,
    restart: bool,
    watch: &mut dyn Watch,
) -> Result<Imported, ImportError> {
    let (template, commands) = source.template()?;
    let types = source.types(&template);
    let files = in_order(files)?;
    let folder = OutputFolder::lock(out)?;
    if !restart && !folder.is_begun_only()? {
        return Err(OutputError::OtherRun {
            path: out.to_owned(),
            reason: "an import begins anew".to_owned(),
        }
        .into());
    }
    let subject = Subject {
        scene: Arc::new(source.scene.clone()),
        name: source.name.clone(),
        threads: 1,
        grains: true,
        imported: true,
    };
    let mut recording = Recording {
        states: StateBuilder::new(template, types),
        time_step: source.time_step,
        recorder: Recorder::begin(subject, folder)?,
        series: Series::default(),
        flow: FlowHistory::default(),
        commands,
        last: None,
        frames: 0,
    };
    let sizes = files.iter().map(|path| size(path));
    let (all, mut read) = (sizes.sum::<u64>() as f64, 0);
    for path in &files {
        let mut file = FrameFile::open(path)?;
        while let Some(frame) = file.next_frame()? {
            recording.add(path, &frame)?;
            let share = (read + file.taken()) as f64 / all;
            watch.running(share.min(1.0), &|| {
                format!("{} instants, step {}", recording.frames, frame.step)
            });
        }
        read += size(path);
    }
    recording.finish(source)
}

/// Bytes of the file at `path`; whoever opens it is told where it cannot be read.
fn size(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |found| found.len())
}

/// An import on its way.
struct Recording {
    states: StateBuilder,
    time_step: f64,
    recorder: Recorder,
    series: Series,
    flow: FlowHistory,
    commands: Vec<StampedCommand>,
    last: Option<World>,
    frames: usize,
}

impl Recording {
    /// Takes the `frame` of the file at `path` in.
    fn add(&mut self, path: &Path, frame: &AtomFrame) -> Result<(), ImportError> {
        let refuse = |reason: String| {
            let reason = format!("step {}: {reason}", frame.step);
            ImportError::File(FrameError::of_file(path, reason))
        };
        if let Some(last) = &self.last
            && last.clock.step >= frame.step
        {
            return Err(refuse(format!(
                "does not follow step {}: expected files of one run, each instant once",
                last.clock.step
            )));
        }
        if let Some(time) = frame.time {
            let ours = frame.step as f64 * self.time_step;
            if (time - ours).abs() > SAME_TIME * ours.abs().max(self.time_step) {
                return Err(refuse(format!(
                    "is at {time:e} s, which is {ours:e} s by the scene's time step of {:e} s; `--time-step` states another",
                    self.time_step
                )));
            }
        }
        let world = self.states.state(frame, self.time_step).map_err(refuse)?;
        let (sample, surface) = sample_and_surface(&world);
        let sample = without_unknown(sample);
        if let Some(line) = surface {
            self.flow.add(&world, &sample, &line);
        }
        self.series.push(sample);
        self.frames += 1;
        let world = self.last.insert(world);
        self.recorder.record_output(RunSoFar {
            world,
            series: &self.series,
            flow: &self.flow,
            meetings: &[],
            commands: &self.commands,
            sampling: Sampling::default(),
        })?;
        Ok(())
    }

    /// Writes the last files.
    fn finish(mut self, source: &ImportSource) -> Result<Imported, ImportError> {
        let Some(last) = self.last else {
            return Err(ImportError::Unfit(
                "the files hold no instant; expected dumps or data files of an engine's run"
                    .to_owned(),
            ));
        };
        let run = RunSoFar {
            world: &last,
            series: &self.series,
            flow: &self.flow,
            meetings: &[],
            commands: &self.commands,
            sampling: Sampling::default(),
        };
        let results = self.recorder.finish(Some(run), &Ending::Done, &[])?;
        Ok(Imported {
            results,
            scene: source.scene.clone(),
            last,
            frames: self.frames,
        })
    }
}
