//! The short summary on standard output at the end of a run.

use crate::measure::ResultKey;
use crate::output::{Ending, RunSoFar};
use crate::runner::{Finished, spoken};
use std::path::Path;

/// Prints how a run ended, its results and that its files are in `folder`. Results for several
/// thresholds of the drop stand in the file only.
pub fn report(run: Option<RunSoFar>, folder: &Path, finished: &Finished) {
    let Some(RunSoFar { world, .. }) = run else {
        println!(
            "stopped before the run began; the summary is in {}",
            folder.display()
        );
        return;
    };
    for warning in &finished.warnings {
        println!("note: {warning}");
    }
    let (wall_time, results) = (finished.wall_time, &finished.results);
    println!(
        "{}: {} grains, t = {:.3} s in {} steps of {:.3e} s, {} of wall-clock time ({:.2} × real time)",
        ended(&finished.ending),
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
    println!("files in {}", folder.display());
}

fn ended(ending: &Ending) -> &'static str {
    match ending {
        Ending::Done => "done",
        Ending::Interrupted => "interrupted",
        Ending::Faulted(_) => "stopped by a fault",
    }
}
