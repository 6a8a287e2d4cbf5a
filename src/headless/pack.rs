//! A scene's Voronoi cells cut to grains, with progress.

use super::Progress;
use crate::geometry::Rounded;
use crate::runner::RunnerError;
use crate::scene::Scene;
use crate::world::Packing;

/// The grains of `scene`, cut from Voronoi cells; progress goes to standard error.
///
/// # Errors
/// When the scene cuts none.
pub fn pack(scene: &Scene) -> Result<Vec<Rounded>, RunnerError> {
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
