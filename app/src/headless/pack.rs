//! What a scene begins with, computed once and kept in a file: its settled bed, its grains cut from
//! Voronoi cells; and the moments at which scenes open in a window.

use super::terminal::tell;
use super::{Allowed, Progress, named_scene};
use grainfall::geometry::Rounded;
use grainfall::output::write_file;
use grainfall::run::{Estimate, Opening, available_threads, make_bed, openings};
use grainfall::runner::{RunnerError, apply_settings, exit};
use grainfall::scene::{Scene, StoredCells};
use grainfall::world::Packing;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

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

/// Computes the moments at which scenes open in a window into files of `folder`, as many at once as
/// there are cores; those that are there already and are what this program makes stay. Returns the
/// exit code.
///
/// # Errors
/// When one cannot be run or written; the others are made all the same.
pub fn write_openings(folder: &Path) -> Result<u8, RunnerError> {
    let wanted = openings()
        .iter()
        .filter(|opening| !opening.is_made_in(folder));
    let wanted: Vec<&Opening> = wanted.collect();
    let at_once = available_threads().min(wanted.len()).max(1);
    let (next, threads) = (AtomicUsize::new(0), available_threads() / at_once);
    let make_the_rest = || {
        let mut outcome = Ok(());
        while let Some(opening) = wanted.get(next.fetch_add(1, Ordering::Relaxed)) {
            tell(&format!("{} to {} s", opening.scene, opening.moment));
            outcome = outcome.and(write_opening(opening, threads, folder));
        }
        outcome
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..at_once).map(|_| scope.spawn(make_the_rest)).collect();
        let ends = workers.into_iter().map(|worker| match worker.join() {
            Ok(outcome) => outcome,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        ends.fold(Ok(()), Result::and)
    })?;
    Ok(exit::DONE)
}

fn write_opening(opening: &Opening, threads: usize, folder: &Path) -> Result<(), RunnerError> {
    let session = opening.make(threads).map_err(|error| error.to_string());
    let path = folder.join(opening.file_name());
    let written = session.and_then(|session| {
        let written = session.write_packed(&path);
        written.map_err(|error| format!("{} cannot be written: {error}", path.display()))
    });
    written.map_err(|reason| RunnerError::Input(format!("{}: {reason}", opening.scene)))
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
