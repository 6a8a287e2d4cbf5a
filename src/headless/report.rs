//! The short summary on standard output at the end of a run.

use super::Ending;
use super::progress::spoken;
use super::recorder::Recorder;
use crate::measure::{Summary, SummaryEntry};
use crate::simulation::Simulation;

/// Results about the smallest drops beside the first stand in the file only.
const FILE_ONLY: &str = "(≥";

/// Prints how a run ended, its results and where its files are.
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
    for entry in results
        .entries
        .iter()
        .filter(|entry| !entry.name.contains(FILE_ONLY))
    {
        println!("  {:<32} {}", entry.name, value(entry));
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

fn value(entry: &SummaryEntry) -> String {
    match (entry.value, entry.unit) {
        (None, _) => "–".into(),
        (Some(value), "1") => format!("{value:.4}"),
        (Some(value), "rad") => format!("{value:.4} rad = {:.2}°", value.to_degrees()),
        (Some(value), "rad/s") => format!("{value:.4} rad/s = {:.2} °/s", value.to_degrees()),
        (Some(value), unit) => format!("{value:.4e} {unit}"),
    }
}
