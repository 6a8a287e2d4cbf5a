//! `grainfall import DUMP…`: what another engine computed, as a run's folder.

use super::terminal::say;
use super::{Progress, Report, Said, named_scene};
use grainfall::engines::{ImportError, ImportSource, import, named_files, scene_from};
use grainfall::measure::ResultKey;
use grainfall::output::write_file;
use grainfall::runner::{RunnerError, apply_settings, exit};
use std::path::{Path, PathBuf};

/// What to take in, what it is of, and where it goes.
#[derive(clap::Args)]
pub struct ImportTask {
    /// Dumps and data files of LIGGGHTS and LAMMPS, XYZ of exaDEM, or folders of dumps
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The scene that they are of [default: that of the export beside them]
    #[arg(long, value_name = "SCENE")]
    scene: Option<String>,
    /// Change a value of that scene, as it was for the engine
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    set: Vec<String>,
    /// The engine's time step [default: that of the export, or the scene's]
    #[arg(long, value_name = "TIME")]
    time_step: Option<String>,
    /// Folder for the files [default: out/SCENE-ENGINE]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the run that the folder holds
    #[arg(long)]
    restart: bool,
    /// Write a scene that begins with the last state, each grain listed, to this file
    #[arg(long, value_name = "FILE.ron")]
    start: Option<PathBuf>,
    #[command(flatten)]
    said: Said,
}

impl ImportTask {
    /// Does it. Returns the exit code.
    ///
    /// # Errors
    /// When a file is not what it has to be, its scene is unknown, or files cannot be written.
    pub fn carry_out(&self) -> Result<u8, RunnerError> {
        let source = self.source()?;
        let files = named_files(&self.files).map_err(refused)?;
        let out = self.out.clone();
        let out = out.unwrap_or_else(|| Path::new("out").join(&source.name));
        let mut progress = Progress::of(self.said.report());
        let imported = import(&files, &source, &out, self.restart, &mut progress);
        progress.finish();
        let imported = imported.map_err(refused)?;
        if let Some(path) = &self.start {
            let scene = scene_from(&imported.scene, &imported.last);
            let text = scene.to_text().map_err(RunnerError::Input)?;
            write_file(path, |file| file.write_all(text.as_bytes()))?;
        }
        if self.said.report() != Report::Text {
            return self.said.report().folder(&out).map(|()| exit::DONE);
        }
        say(&format!(
            "imported: {} grains at {} instants up to t = {:.3} s",
            imported.last.grains.len(),
            imported.frames,
            imported.last.time()
        ));
        let keys = imported
            .results
            .entries
            .iter()
            .filter(|e| e.value.is_some());
        for entry in keys.filter(|entry| !matches!(entry.key, ResultKey::OfAvalanches(..))) {
            let text = imported.results.text_in_full(entry.key);
            say(&format!("  {:<40} {text}", entry.key.name()));
        }
        say(&format!("files in {}", out.display()));
        Ok(exit::DONE)
    }

    /// What the files are of: the scene that is named, or the export beside the first of them.
    fn source(&self) -> Result<ImportSource, RunnerError> {
        let mut source = match &self.scene {
            Some(name) => {
                let mut scene = named_scene(name)?;
                let commands = apply_settings(&mut scene, &self.set)?;
                let name = Path::new(name).file_stem();
                let name = name.map_or_else(|| "scene".into(), |name| name.to_string_lossy());
                ImportSource::of_scene(&format!("{name}-imported"), scene, commands)
            }
            None => self.export_beside()?,
        };
        if let Some(step) = &self.time_step {
            source.scene.set("time-step", step)?;
            source.time_step =
                ImportSource::of_scene("", source.scene.clone(), Vec::new()).time_step;
        }
        Ok(source)
    }

    fn export_beside(&self) -> Result<ImportSource, RunnerError> {
        let first = self.files.first().map_or(Path::new("."), PathBuf::as_path);
        let found = ImportSource::beside(first).map_err(refused)?;
        found.ok_or_else(|| {
            RunnerError::Input(format!(
                "no export lies beside {}: name the scene that the files are of with --scene, for its container, \
                 materials and time step",
                first.display()
            ))
        })
    }
}

fn refused(error: ImportError) -> RunnerError {
    match error {
        ImportError::Unwritten(error) => error.into(),
        error => RunnerError::Input(error.to_string()),
    }
}
