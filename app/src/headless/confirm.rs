//! `grainfall verify FILE`: computes again what a file states, and says what came out; of a sweep
//! every case, and whether its tables and plots are as they were written.

use super::terminal::{say, tell};
use super::{Allowed, Progress};
use grainfall::run::{BedStore, Estimate, RunRecord, VERSION};
use grainfall::runner::{RunnerError, Verdict, VouchedFiles, exit};
use grainfall::sweep::StatedSweep;
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
    match StatedSweep::at(file) {
        Some(sweep) => confirm_sweep(&sweep, threads, allowed, interrupted),
        None => confirm_run(file, &RunRecord::read(file)?, threads, allowed, interrupted),
    }
}

/// Does so with every case of the sweep that `file` states, and looks at its tables and plots.
fn confirm_sweep(
    file: &Path,
    threads: usize,
    allowed: &Allowed,
    interrupted: &AtomicBool,
) -> Result<u8, RunnerError> {
    let sweep = StatedSweep::read(file)?;
    let mut code = exit::DONE;
    for (name, _) in &sweep.cases {
        let summary = sweep.summary(name);
        let record = RunRecord::read(&summary)?;
        if let Some(difference) = sweep.difference(name, &record) {
            tell(&format!("error: {difference}"));
            code = exit::OTHER_STATE;
        }
        let own = confirm_run(&summary, &record, threads, allowed, interrupted)?;
        if own == exit::INTERRUPTED {
            return Ok(own);
        }
        code = code.max(own);
    }
    let files = sweep.check_files();
    report_files(&files);
    if !files.altered.is_empty() {
        code = exit::OTHER_STATE;
    }
    if code == exit::DONE {
        say(&format!("all {} cases are the same", sweep.cases.len()));
    }
    Ok(code)
}

/// Does so with the run of `record`, which stands in `file`.
fn confirm_run(
    file: &Path,
    record: &RunRecord,
    threads: usize,
    allowed: &Allowed,
    interrupted: &AtomicBool,
) -> Result<u8, RunnerError> {
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
