//! What a scene begins with, computed once and kept in a file: its settled bed, its grains cut from
//! Voronoi cells; and the run that the window opens with.

use super::{Allowed, Progress, named_scene};
use grainfall::geometry::Rounded;
use grainfall::output::write_file;
use grainfall::run::Estimate;
use grainfall::run::{make_bed, make_opening};
use grainfall::runner::{RunnerError, apply_settings, available_threads, exit};
use grainfall::scene::{Scene, StoredCells};
use grainfall::world::Packing;
use std::path::Path;

/// Settles the bed of the scene called `name` into a file. Returns the exit code.
///
/// # Errors
/// When there is no such scene, it has no bed or asks for more memory than there is, or the file cannot be written.
pub fn write_bed(name: &str, allowed: &Allowed, path: &Path) -> Result<u8, RunnerError> {
    let scene = named_scene(name)?;
    allowed.memory(&Estimate::of_start(&scene))?;
    let bed = make_bed(&scene, available_threads())
        .map_err(|error| RunnerError::Input(error.to_string()))?;
    write_file(path, |file| file.write_all(&bed))?;
    Ok(exit::DONE)
}

/// Computes the run that the window opens with into a file. Returns the exit code.
///
/// # Errors
/// When it cannot be run or the file cannot be written.
pub fn write_opening(path: &Path) -> Result<u8, RunnerError> {
    let session =
        make_opening(available_threads()).map_err(|error| RunnerError::Input(error.to_string()))?;
    session
        .write(path)
        .map_err(|error| RunnerError::Input(error.to_string()))?;
    Ok(exit::DONE)
}

/// Cuts the grains of the scene called `name`, after these `settings`, into a file. Returns the exit
/// code.
///
/// # Errors
/// When there is no such scene, it cuts none or asks for more memory than there is, a setting
/// changes nothing about them, or the file cannot be written.
pub fn write_packing(
    name: &str,
    settings: &[String],
    allowed: &Allowed,
    path: &Path,
) -> Result<u8, RunnerError> {
    let mut scene = named_scene(name)?;
    for setting in settings {
        if !apply_settings(&mut scene.clone(), std::slice::from_ref(setting))?.is_empty() {
            return Err(RunnerError::Input(format!(
                "--set {setting}: changes nothing about the grains' places and shapes"
            )));
        }
    }
    apply_settings(&mut scene, settings)?;
    allowed.memory(&Estimate::of_start(&scene))?;
    let grains = pack(&scene)?;
    write_file(path, |file| file.write_all(&StoredCells::encode(&grains)?))?;
    Ok(exit::DONE)
}

/// The grains of `scene`, cut from Voronoi cells; progress goes to standard error.
///
/// # Errors
/// When the scene cuts none.
fn pack(scene: &Scene) -> Result<Vec<Rounded>, RunnerError> {
    let mut packing = Packing::new(scene).ok_or_else(|| {
        RunnerError::Input(format!(
            "«{}» cuts no Voronoi cells; expected a scene with `grains: Voronoi(…)`",
            scene.title
        ))
    })?;
    let mut progress = Progress::on_stderr();
    while !packing.advance() {
        progress.tell(f64::from(packing.progress()), || {
            "cutting the grains".into()
        });
    }
    progress.finish();
    Ok(packing.finish())
}
