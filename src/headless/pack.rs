//! A scene's Voronoi cells cut to grains, with progress.

use super::{HeadlessError, Progress};
use crate::geometry::Rounded;
use crate::scene::Scene;
use crate::world::Packing;

/// The grains of `scene`, cut from Voronoi cells; progress goes to standard error.
///
/// # Errors
/// When the scene cuts none.
pub fn pack(scene: &Scene) -> Result<Vec<Rounded>, HeadlessError> {
    let mut packing = Packing::new(scene).ok_or_else(|| {
        HeadlessError::Input(format!(
            "«{}» cuts no Voronoi cells; expected a scene with `grains: Voronoi(…)`",
            scene.title
        ))
    })?;
    let mut progress = Progress::new();
    while !packing.advance() {
        progress.tell(f64::from(packing.progress()), || {
            "cutting the grains".into()
        });
    }
    progress.finish();
    Ok(packing.finish())
}
