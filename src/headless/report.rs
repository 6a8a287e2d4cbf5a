//! The short summary on standard output at the end of a run.

use super::Ending;
use super::progress::spoken;
use super::recorder::Recorder;
use crate::measure::{ResultKey, Summary};
use crate::simulation::Simulation;

/// Prints how a run ended, its results and where its files are. Results for several thresholds of
/// the drop stand in the file only.
pub fn report(simulation: &Simulation, recorder: &Recorder, ending: &Ending, results: &Summary) {
    let Some(world) = simulation.world() else {
        println!(
            "stopped before the run began; the summary is in {}",
            recorder.folder().path().display()
        );
        return;
    };
    for warning in simulation.warnings() {
        println!("note: {warning}");
    }
    let wall_time = recorder.wall_time();
    println!(
        "{}: {} grains, t = {:.3} s in {} steps of {:.3e} s, {} of wall-clock time ({:.2} × real time)",
        ended(ending),
        world.grains.len(),
        world.time(),
        world.clock.step,
        world.clock.time_step,
        spoken(wall_time),
        world.time() / wall_time
    );
    println!(
        "results from t = {:.2} s to {:.2} s:",
        results.from, results.to
    );
    let keys = results.entries.iter().map(|entry| entry.key);
    for key in keys.filter(|key| !matches!(key, ResultKey::OfAvalanches(..))) {
        println!("  {:<32} {}", key.name(), results.text(key));
    }
    println!("state {}", world.hash());
    println!("files in {}", recorder.folder().path().display());
}

fn ended(ending: &Ending) -> &'static str {
    match ending {
        Ending::Done => "done",
        Ending::Interrupted => "interrupted",
        Ending::Faulted(_) => "stopped by a fault",
    }
}
