//! What tests of exports and imports begin with: a drum of three grains, handed to another engine.

use grainfall::engines::{Export, ExportError, MpiEngine, export};
use grainfall::scene::Scene;
use grainfall::solver::advise;
use grainfall::world::build;
use std::path::Path;

/// A drum of three grains.
pub fn drum() -> Scene {
    let mut scene = Scene::open("small-drum").expect("it is built in");
    scene.set("count", "3").expect("it can be set");
    scene
}

/// Writes what LIGGGHTS takes to run it to the folder `deck`, its grains as they are placed.
pub fn export_drum(deck: &Path) -> Result<(), ExportError> {
    let scene = drum();
    let world = build(&scene, advise(&scene).time_step);
    let handed = Export {
        name: "drum",
        scene: &scene,
        commands: &[],
        world: &world,
        is_settled: false,
    };
    export(handed, MpiEngine::Liggghts, deck).map(drop)
}
