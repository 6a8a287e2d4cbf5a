//! What is said at the end of a run or a sweep: a summary for people, the summary's file for
//! programs, or nothing.

use super::terminal::{say, tell};
use grainfall::measure::ResultKey;
use grainfall::output::{Ending, OutputError, RunSoFar, SUMMARY};
use grainfall::runner::{Finished, RunnerError, spoken};
use grainfall::sweep::{SWEEP, Sweep, Swept};
use std::fs;
use std::path::Path;

/// What is said at the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Report {
    /// A summary for people.
    Text,
    /// `summary.json` of a run, `sweep.json` of a sweep.
    Json,
    /// Nothing, and nothing on the way: errors alone.
    Quiet,
}

/// The options that choose it.
#[derive(clap::Args)]
pub struct Said {
    /// Say nothing but errors
    #[arg(long, conflicts_with = "json")]
    quiet: bool,
    /// At the end, print summary.json (of a sweep, sweep.json) instead of a summary for people
    #[arg(long)]
    json: bool,
}

impl Said {
    /// What is asked for.
    pub fn report(&self) -> Report {
        match (self.quiet, self.json) {
            (true, _) => Report::Quiet,
            (_, true) => Report::Json,
            (false, false) => Report::Text,
        }
    }
}

impl Report {
    /// Says something by the way on standard error.
    pub fn note(self, text: &str) {
        if self != Self::Quiet {
            tell(&format!("note: {text}"));
        }
    }

    /// Says how a run ended.
    ///
    /// # Errors
    /// When its summary cannot be read.
    pub fn run(
        self,
        run: Option<RunSoFar>,
        folder: &Path,
        finished: &Finished,
    ) -> Result<(), RunnerError> {
        match self {
            Self::Quiet => Ok(()),
            Self::Json => say_file(&folder.join(SUMMARY)),
            Self::Text => {
                report(run, folder, finished);
                Ok(())
            }
        }
    }

    /// Says what the summary in `folder` states, where that is asked for.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn folder(self, folder: &Path) -> Result<(), RunnerError> {
        match self {
            Self::Quiet | Self::Text => Ok(()),
            Self::Json => say_file(&folder.join(SUMMARY)),
        }
    }

    /// Says how case number `number` of a sweep, in its `folder`, ended.
    ///
    /// # Errors
    /// When its summary cannot be read.
    pub fn case(self, number: usize, folder: &Path, ending: &Ending) -> Result<(), RunnerError> {
        match self {
            Self::Quiet => Ok(()),
            Self::Json => say_file(&folder.join(SUMMARY)),
            Self::Text => {
                say(&format!(
                    "case {number}: {}, files in {}",
                    ended(ending),
                    folder.display()
                ));
                Ok(())
            }
        }
    }

    /// Says what came out of a sweep.
    ///
    /// # Errors
    /// When its record cannot be read.
    pub fn sweep(self, sweep: &Sweep, swept: &Swept) -> Result<(), RunnerError> {
        match self {
            Self::Quiet | Self::Json => self.cases(&sweep.out),
            Self::Text => {
                say(swept.table.trim_end());
                self.cases(&sweep.out)
            }
        }
    }

    /// Says in which `folder` the results of several cases are.
    ///
    /// # Errors
    /// When its record cannot be read.
    pub fn cases(self, folder: &Path) -> Result<(), RunnerError> {
        match self {
            Self::Quiet => Ok(()),
            Self::Json => say_file(&folder.join(SWEEP)),
            Self::Text => {
                say(&format!("results in {}", folder.display()));
                Ok(())
            }
        }
    }
}

fn say_file(path: &Path) -> Result<(), RunnerError> {
    let text = fs::read_to_string(path).map_err(|source| OutputError::write(path, source))?;
    say(text.trim_end());
    Ok(())
}

/// Prints how a run ended, its results and that its files are in `folder`. Results for several
/// thresholds of the drop stand in the file only.
fn report(run: Option<RunSoFar>, folder: &Path, finished: &Finished) {
    let Some(RunSoFar { world, .. }) = run else {
        say(&format!(
            "stopped before the run began; the summary is in {}",
            folder.display()
        ));
        return;
    };
    for warning in &finished.warnings {
        say(&format!("note: {warning}"));
    }
    let (wall_time, results) = (finished.wall_time, &finished.results);
    say(&format!(
        "{}: {} grains, t = {:.3} s in {} steps of {:.3e} s, {} of wall-clock time ({:.2} × real time)",
        ended(&finished.ending),
        world.grains.len(),
        world.time(),
        world.clock.step,
        world.clock.time_step,
        spoken(wall_time),
        world.time() / wall_time
    ));
    say(&format!(
        "results from t = {:.2} s to {:.2} s:",
        results.from, results.to
    ));
    let keys = results.entries.iter().map(|entry| entry.key);
    for key in keys.filter(|key| !matches!(key, ResultKey::OfAvalanches(..))) {
        say(&format!(
            "  {:<40} {}",
            key.name(),
            results.text_in_full(key)
        ));
    }
    if let Some(note) = results.rotation_note() {
        say(&format!("note: {note}"));
    }
    say(&format!("state {}", world.hash()));
    say(&format!("files in {}", folder.display()));
}

fn ended(ending: &Ending) -> &'static str {
    match ending {
        Ending::Done => "done",
        Ending::Interrupted => "interrupted",
        Ending::Faulted(_) => "stopped by a fault",
    }
}
