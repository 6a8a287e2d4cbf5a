//! Runs a scene to its end without a window, as `grainfall SCENE --no-render` does, and prints what
//! was measured.
//!
//! ```sh
//! cargo run -p grainfall-core --example run_a_scene -- small-drum
//! ```

use grainfall::runner::{self, Job};
use grainfall::scene::Scene;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or("small-drum".into());
    let mut scene = Scene::open(&name)?;
    // Any key of the scene, as `--set` has it.
    scene.set("duration", "0.5s")?;
    scene.set("seed", "7")?;

    let out = std::env::temp_dir().join("grainfall-run-a-scene");
    let job = Job::new(name, scene, out);
    // Nobody watches, and nobody stops it.
    let (finished, _run) = runner::run(&job, &mut (), &|| false)?;

    println!("{}: {}", job.name, finished.ending.status());
    for entry in &finished.results.entries {
        println!(
            "{:<32} {}",
            entry.key.name(),
            finished.results.text(entry.key)
        );
    }
    println!("files in {}", job.out.display());
    Ok(())
}
