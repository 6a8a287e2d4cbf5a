//! A scene handed to an engine: a folder with all that it takes.
//!
//! In: a scene and its world at time zero. Out: script, data file, meshes, a script that calls the
//! engine, what is different there, and a record by which [`super::import`] knows its results.
//! A folder that holds anything else, or dumps already, is left alone.

use super::atom_types::{AtomTypes, GrainType};
use super::atoms_file::write_atoms;
use super::deck::{DUMPS, Deck, GRAINS, Handed, Steps};
use super::exadem_deck::{self, exadem_deck};
use super::lammps_deck::{self, lammps_deck};
use super::liggghts_deck::{self, liggghts_deck};
use super::mpi_engine::MpiEngine;
use super::rockable_files::{BODIES, BodyKinds, SHAPES};
use crate::files::{holds_files, read_whole, write_whole};
use crate::output::OutputError;
use crate::physics::limits;
use crate::run::{Provenance, ScriptedCommand, VERSION, printable};
use crate::scene::{Scene, within_folders};
use crate::world::{Clock, World};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The file that says that a folder is an export, and of what.
pub const RECORD: &str = "export.json";
/// The script that calls the engine.
const RUN: &str = "run.sh";
/// What is different in the engine.
const DEVIATIONS: &str = "DEVIATIONS.txt";
/// Largest record that is read [bytes].
const LARGEST: u64 = 256 << 20;

/// Why a scene cannot be handed over.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The engine does not have what the scene asks for.
    #[error("{engine} cannot run this scene: {}", .reasons.join("; "))]
    Refused {
        /// The engine.
        engine: MpiEngine,
        /// Everything that it does not have.
        reasons: Vec<String>,
    },
    /// The folder holds something else.
    #[error("the folder {} holds {holds}: choose another with --out, or empty it", .path.display())]
    Foreign {
        /// Which folder.
        path: PathBuf,
        /// What is in it.
        holds: &'static str,
    },
    /// A file could not be written.
    #[error(transparent)]
    Unwritten(#[from] OutputError),
}

/// What `export.json` states.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ExportRecord {
    /// Always `grainfall export`.
    pub program: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// The engine's word.
    pub engine: String,
    /// What the scene was called.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// What was changed about it at time zero.
    pub commands: Vec<ScriptedCommand>,
    /// The engine's time step [s].
    pub time_step: f64,
    /// Types of grain, the first being 1.
    pub types: Vec<GrainType>,
    /// What is different in the engine, in sentences.
    pub deviations: Vec<String>,
}

/// What program wrote a record.
const PROGRAM: &str = "grainfall export";

/// What is handed over, under its name and with what was changed about it at time zero.
#[derive(Clone, Copy)]
pub struct Export<'a> {
    /// What the scene is called.
    pub name: &'a str,
    /// The scene.
    pub scene: &'a Scene,
    /// What was changed at time zero.
    pub commands: &'a [ScriptedCommand],
    /// Its world at time zero, with those changes.
    pub world: &'a World,
    /// Whether the grains of a filling have come to rest in it.
    pub is_settled: bool,
}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    /// Names of the files, in the folder.
    pub files: Vec<String>,
    /// What is different in the engine, in sentences.
    pub deviations: Vec<String>,
    /// Steps that the engine is to compute, and between two dumps.
    pub steps: Steps,
    /// The engine's time step [s].
    pub time_step: f64,
}

/// What an engine takes.
struct Package {
    types: AtomTypes,
    script: String,
    clock: Clock,
    deviations: Vec<String>,
    grains: GrainFiles,
}

/// The files of grains, and of what moves beside them.
enum GrainFiles {
    /// A data file of spheres, and meshes of walls.
    Spheres(Box<Deck>),
    /// Shapes and bodies.
    Polyhedra(BodyKinds),
}

/// Writes what `engine` takes to compute `export` to the folder `out`.
///
/// # Errors
/// When the engine does not have what the scene asks for, the folder holds something else, or a
/// file cannot be written.
pub fn export(export: Export, engine: MpiEngine, out: &Path) -> Result<Exported, ExportError> {
    // Engines look for quotes even in comments, and go on reading until they are closed.
    let from = Provenance::of(export.scene, export.world);
    let from = from.to_string().replace('"', "'").replace('\n', " ");
    let handed = Handed {
        title: &from,
        scene: export.scene,
        world: export.world,
        is_settled: export.is_settled,
    };
    let refuse = |reasons: Vec<String>| ExportError::Refused {
        engine,
        reasons: reasons.iter().map(|reason| printable(reason)).collect(),
    };
    let mut package = package(handed, engine).map_err(refuse)?;
    // They name walls as the scene does.
    (package.deviations.iter_mut()).for_each(|deviation| *deviation = printable(deviation));
    open(out)?;
    let record = ExportRecord {
        program: PROGRAM.to_owned(),
        version: VERSION.to_owned(),
        engine: engine.word().to_owned(),
        name: export.name.to_owned(),
        scene: export.scene.clone(),
        commands: export.commands.to_vec(),
        time_step: package.clock.time_step,
        types: package.types.grains.clone(),
        deviations: package.deviations.clone(),
    };
    let mut files = Files::new(out);
    // First, so that a folder that was begun is known as one of ours.
    files.write(RECORD, &|file| {
        serde_json::to_writer_pretty(&mut *file, &record)?;
        file.write_all(b"\n")
    })?;
    write_grains(&package, handed, &mut files)?;
    files.write(&script_name(engine), &|file| {
        file.write_all(package.script.as_bytes())
    })?;
    files.write(RUN, &|file| file.write_all(run_script(engine).as_bytes()))?;
    files.write(DEVIATIONS, &|file| {
        file.write_all(deviations_text(engine, &from, &package.deviations).as_bytes())
    })?;
    Ok(Exported {
        files: files.names,
        deviations: package.deviations,
        steps: Steps::of(export.scene, &package.clock),
        time_step: package.clock.time_step,
    })
}

/// Files that are written to a folder, each whole or not at all.
struct Files<'a> {
    folder: &'a Path,
    names: Vec<String>,
}

impl<'a> Files<'a> {
    fn new(folder: &'a Path) -> Self {
        let names = Vec::new();
        Self { folder, names }
    }

    /// Writes the file called `name`, as `fill` does.
    fn write(
        &mut self,
        name: &str,
        fill: &dyn Fn(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let path = self.folder.join(name);
        self.names.push(name.to_owned());
        write_whole(&path, fill).map_err(|source| OutputError::write(&path, source))
    }
}

/// Writes the files of the grains of `package`.
fn write_grains(package: &Package, handed: Handed, files: &mut Files) -> Result<(), OutputError> {
    let (world, title) = (handed.world, handed.title);
    match &package.grains {
        GrainFiles::Spheres(deck) => {
            let types = (&package.types, deck.types);
            files.write(GRAINS, &|file| {
                write_atoms(world, types, &deck.domain, title, file)
            })?;
            for mesh in &deck.meshes {
                files.write(&format!("{}.stl", mesh.name), &|file| mesh.write(file))?;
            }
        }
        GrainFiles::Polyhedra(kinds) => {
            if let Some(bodies) = &world.polyhedra {
                files.write(SHAPES, &|file| kinds.write_shapes(bodies, title, file))?;
            }
            let step = package.clock.time_step;
            files.write(BODIES, &|file| {
                kinds.write_bodies(world, &package.types, step, title, file)
            })?;
        }
    }
    Ok(())
}

/// What `engine` takes of `handed`.
fn package(handed: Handed, engine: MpiEngine) -> Result<Package, Vec<String>> {
    let alone = |reason| vec![reason];
    let world = handed.world;
    let of_spheres = |types, mut deck: Deck| Package {
        types,
        script: std::mem::take(&mut deck.script),
        clock: world.clock,
        deviations: std::mem::take(&mut deck.deviations),
        grains: GrainFiles::Spheres(Box::new(deck)),
    };
    match engine {
        MpiEngine::Liggghts => {
            let types = liggghts_deck::types(world).map_err(alone)?;
            let deck = liggghts_deck(handed, &types)?;
            Ok(of_spheres(types, deck))
        }
        MpiEngine::Lammps => {
            let types = lammps_deck::types(world).map_err(alone)?;
            let deck = lammps_deck(handed, &types)?;
            Ok(of_spheres(types, deck))
        }
        MpiEngine::Exadem => {
            let types = exadem_deck::types(world).map_err(alone)?;
            let deck = exadem_deck(handed, &types)?;
            Ok(Package {
                types,
                script: deck.script,
                clock: deck.clock,
                deviations: deck.deviations,
                grains: GrainFiles::Polyhedra(BodyKinds::of(world)),
            })
        }
    }
}

/// `in.liggghts`, or `grains.msp`.
fn script_name(engine: MpiEngine) -> String {
    match engine {
        MpiEngine::Liggghts | MpiEngine::Lammps => format!("in.{}", engine.word()),
        MpiEngine::Exadem => "grains.msp".to_owned(),
    }
}

fn run_script(engine: MpiEngine) -> String {
    let (name, program, variable) = (engine.name(), engine.program(), engine.variable());
    let option = match engine {
        MpiEngine::Liggghts | MpiEngine::Lammps => "-in ",
        MpiEngine::Exadem => "",
    };
    format!(
        "#!/bin/sh\n# Runs {name} on as many processes as are asked for (2): sh run.sh 8\n# MPIRUN and {variable} name \
         other programs: MPIRUN='mpirun --oversubscribe' {variable}=/opt/{program} sh run.sh 8\nset -e\ncd \"$(dirname \
         \"$0\")\"\nmkdir -p {DUMPS}\nexec ${{MPIRUN:-mpirun}} -np \"${{1:-2}}\" ${{{variable}:-{program}}} {option}{}\n",
        script_name(engine),
    )
}

fn deviations_text(engine: MpiEngine, from: &str, deviations: &[String]) -> String {
    let mut text =
        format!("What {engine} does otherwise than Grainfall with this scene.\n{from}\n");
    for (index, deviation) in deviations.iter().enumerate() {
        let _ = writeln!(text, "\n{}. {deviation}", index + 1);
    }
    text
}

/// Makes the folder `out` where it is missing, and refuses one that holds something else.
fn open(out: &Path) -> Result<(), ExportError> {
    let failed = |source| OutputError::write(out, source);
    let refuse = |holds| {
        let path = out.to_owned();
        Err(ExportError::Foreign { path, holds })
    };
    if out.exists() {
        if holds_files(out).map_err(failed)? && ExportRecord::read(out).is_err() {
            return refuse("files that are not an export's");
        }
        let dumps = out.join(DUMPS);
        if dumps.is_dir() && fs::read_dir(&dumps).map_err(failed)?.next().is_some() {
            return refuse("an export that its engine has run");
        }
    }
    Ok(())
}

impl ExportRecord {
    /// The record in the folder at `path`.
    ///
    /// # Errors
    /// What is wrong with it, for people.
    pub fn read(path: &Path) -> Result<Self, String> {
        let file = path.join(RECORD);
        let refuse = |reason: String| format!("{}: {reason}", file.display());
        let bytes = read_whole(&file, LARGEST)
            .map_err(|error| refuse(format!("cannot be read: {error}")))?;
        // What it names elsewhere is not opened.
        let record: Result<Self, _> = within_folders(&[path], || serde_json::from_slice(&bytes));
        let record = record.map_err(|error| refuse(error.to_string()))?;
        if record.program != PROGRAM {
            return Err(refuse("is no record of an export".to_owned()));
        }
        (record.scene.check())
            .map_err(|error| refuse(format!("states a scene that cannot be run: {error}")))?;
        if !limits::TIME_STEP.accept(record.time_step) {
            return Err(refuse(format!(
                "states a time step of {:?} s; expected one between 1e-12 s and 1 s",
                record.time_step
            )));
        }
        Ok(record)
    }
}
