//! `grainfall verify FILE`: computes again what a file states, and says what came out.

use super::terminal::{say, tell};
use super::{Allowed, Progress};
use grainfall::run::{BedStore, Estimate, RunRecord, VERSION};
use grainfall::runner::{RunnerError, Verdict, VouchedFiles, exit};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Computes the run of `file` again on `threads` threads, until `interrupted` becomes true, and
/// says whether it is as stated. Returns the exit code.
///
/// # Errors
/// When the file holds no record, or its run cannot be computed or asks for more memory than there
/// is.
pub fn confirm(
    file: &Path,
    threads: usize,
    allowed: &Allowed,
    interrupted: &AtomicBool,
) -> Result<u8, RunnerError> {
    let record = RunRecord::read(file)?;
    let mut asked = record.scene.clone();
    asked.duration = record.time;
    allowed.memory(&Estimate::of(&asked))?;
    let files = record.check_files(file.parent().unwrap_or(Path::new("")));
    let stop = || interrupted.load(Ordering::Relaxed);
    let mut progress = Progress::on_stderr();
    let verdict = record.verify(threads, BedStore::user(), &mut progress, &stop);
    progress.finish();
    let verdict = verdict?;
    let (name, steps, time) = (&record.name, record.steps, record.time);
    let stated = record.state_hash.as_deref().unwrap_or_default();
    match &verdict {
        Verdict::Same => say(&format!(
            "the same: {name}, state {stated} at t = {time:.6} s, step {steps}"
        )),
        Verdict::Differs(what) => {
            tell(&format!(
                "error: {name} comes to the state {stated}, but not to all that is stated:"
            ));
            for what in what {
                tell(&format!("  {what}"));
            }
        }
        Verdict::Other(found) => tell(&format!(
            "error: {name} comes to state {found} at step {steps}, not to {stated}"
        )),
        Verdict::Faulted(fault) => tell(&format!(
            "error: {name} does not come to step {steps}: {fault}"
        )),
        Verdict::Interrupted => tell(&format!("stopped before step {steps}")),
    }
    if !matches!(verdict, Verdict::Same | Verdict::Interrupted) {
        tell(&of_version(&record.version));
    }
    report_files(&files);
    Ok(match verdict {
        Verdict::Same if !files.altered.is_empty() => exit::OTHER_STATE,
        verdict => verdict.exit_code(),
    })
}

/// What a difference means, by the `version` that wrote the file.
fn of_version(version: &str) -> String {
    if version == VERSION {
        return format!(
            "  the file was written by version {version}, which is this one: the file was forged, \
             or this build or machine computes otherwise"
        );
    }
    format!(
        "  the file was written by version {version}, and this is {VERSION}, which may compute \
         otherwise by intent: CHANGELOG.md says where; Grainfall {version} repeats the run"
    )
}

fn report_files(files: &VouchedFiles) {
    for altered in &files.altered {
        tell(&format!("error: {altered}"));
    }
    if files.same > 0 {
        say(&format!("files as they were written: {}", files.same));
    }
    if let Some(first) = files.missing.first() {
        let count = files.missing.len();
        tell(&format!(
            "note: {count} of the files it vouches for are not beside it ({first} …) and were not looked at"
        ));
    }
}
