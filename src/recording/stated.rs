//! What a run's record states of it, as far as playing it takes.
//!
//! In: a record. Out: whether its run goes on, its first time step, its commands with their steps,
//! what people should know. A change that is not in order is refused.

use crate::files::FolderLock;
use crate::run::{Command, Parameter, RunRecord, ScriptedCommand, StampedCommand};
use crate::solver::advise;
use crate::world::MOST_STEPS;
use std::path::Path;

/// Most that the time of a record may differ from that of its steps, relative to it.
const SAME_TIME: f64 = 1e-9;

/// Whether the run of a recording goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunProgress {
    /// A program computes it now: states are added.
    UnderWay,
    /// Its program ended without finishing it.
    Stopped,
    /// It has come to its end, whichever that was.
    Over,
}

/// Whether the run with this `record` in `folder` goes on.
pub fn progress_of(record: &RunRecord, folder: &Path) -> RunProgress {
    match record.status.as_deref() {
        Some("running") if FolderLock::is_held(folder) => RunProgress::UnderWay,
        Some("running") => RunProgress::Stopped,
        _ => RunProgress::Over,
    }
}

/// What is to be said of a run with this `record` and `progress`.
pub fn notes_of(record: &RunRecord, progress: RunProgress) -> Vec<String> {
    let text = match (record.status.as_deref(), progress) {
        (_, RunProgress::UnderWay) => {
            "The run is under way: until it ends, changes that were made on its way are not known, and files are not compared \
             with their digests"
        }
        (_, RunProgress::Stopped) => {
            "The run was killed on its way, or is computed on another machine: changes that were made on its way are not known, \
             and files are not compared with their digests"
        }
        (Some("interrupted"), _) => "The run was stopped before its end",
        (Some("fault"), _) => {
            "A physical fault stopped the run at its end: its summary.json says which, and the last states need not mean \
             anything"
        }
        _ => return Vec::new(),
    };
    vec![text.to_owned()]
}

/// How long the first step of the run with this `record` was [s]: as its scene says, unless the
/// time that it came to says otherwise, as that of an import may.
pub fn first_step(record: &RunRecord) -> f64 {
    let advised = advise(&record.scene).time_step;
    let found = record.time / record.steps as f64;
    let differs = (found - advised).abs() > SAME_TIME * advised;
    if found > 0.0 && found.is_finite() && differs && !changes_step(&record.commands) {
        found
    } else {
        advised
    }
}

fn changes_step(commands: &[ScriptedCommand]) -> bool {
    (commands.iter()).any(|scripted| {
        matches!(&scripted.command, Command::Set { parameter, .. } if *parameter == Parameter::TimeStep)
    })
}

/// `commands` as a run carried them out.
pub fn stamped(commands: &[ScriptedCommand]) -> Result<Vec<StampedCommand>, String> {
    let mut last = (0, 0.0);
    let mut stamped = Vec::with_capacity(commands.len());
    for (index, scripted) in commands.iter().enumerate() {
        let when = scripted.step.zip(scripted.time);
        let follows = |(step, time): &(u64, f64)| {
            last.0 <= *step && last.1 <= *time && time.is_finite() && *step <= MOST_STEPS
        };
        let Some((step, time)) = when.filter(follows) else {
            return Err(format!("change {} in it is not in order", index + 1));
        };
        last = (step, time);
        let command = scripted.command.clone();
        stamped.push(StampedCommand {
            step,
            time,
            command,
        });
    }
    Ok(stamped)
}
