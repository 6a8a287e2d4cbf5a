//! Running a paper's cases, and setting beside each other what is there of them.
//!
//! In: a [`PaperJob`]. Out: the files of its folder, its tables, and which cases are missing.

use super::plan::{Paper, PaperTable, Row, Selection};
use crate::output::write_file;
use crate::run::{BedStore, Estimate, VERSION};
use crate::runner::{RunnerError, Standing, Watch, standing};
use crate::sweep::{self, Case, CaseResult, Sweep, SweepEnding, SweepFolder};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// The file that holds all tables of a paper.
const TABLES: &str = "tables.md";

/// What is wanted of a paper, and where its results go.
pub struct PaperJob {
    paper: &'static Paper,
    rows: Vec<Row>,
    sweep: Sweep,
    cases: Vec<Case>,
}

/// A case of a paper, as a list shows it.
pub struct Listed {
    /// The part that it belongs to.
    pub part: &'static str,
    /// Its folder's name.
    pub name: String,
    /// How it stands there; none where that cannot be told, with the reason.
    pub standing: Result<Standing, String>,
    /// Time of one thread that it takes, about [s].
    pub time: f64,
}

/// What came of a paper.
pub struct Papered {
    /// Whether all its cases are done.
    pub ending: SweepEnding,
    /// Its tables.
    pub tables: Vec<PaperTable>,
    /// The cases that are in none of them, each with how it stands.
    pub missing: Vec<String>,
}

impl PaperJob {
    /// The cases of `paper` that `selection` asks for, in the folder `out`, so many `jobs` at a
    /// time.
    ///
    /// # Errors
    /// When no case is left, or one does not suit the scene.
    pub fn new(
        paper: &'static Paper,
        selection: &Selection,
        out: PathBuf,
        jobs: usize,
    ) -> Result<Self, RunnerError> {
        let rows = paper.rows(selection)?;
        let sweep = paper.sweep(&rows, selection.is_small, out, jobs)?;
        let cases = sweep::cases(&sweep)?;
        Ok(Self {
            paper,
            rows,
            sweep,
            cases,
        })
    }

    /// The same with beds looked for and kept in `beds`.
    #[must_use]
    pub fn with_beds(mut self, beds: BedStore) -> Self {
        self.sweep.beds = beds;
        self
    }

    /// The same, with cases that are there computed anew where `restart`.
    #[must_use]
    pub fn restarting(mut self, restart: bool) -> Self {
        self.sweep.restart = restart;
        self
    }

    /// What its cases take, `at_once` of them at the same time.
    pub fn estimate(&self, at_once: usize) -> Estimate {
        Estimate::of_cases(self.cases.iter().map(|case| &case.scene), at_once)
    }

    /// The sweep that its cases are run by.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }
}

/// The cases of `job` in the order in which they are run, each with how it stands.
pub fn list(job: &PaperJob) -> Vec<Listed> {
    let listed = |(row, case): (&Row, &Case)| Listed {
        part: row.part,
        name: case.name.clone(),
        standing: standing(&sweep::job(&job.sweep, case)).map_err(|error| error.to_string()),
        time: Estimate::of(&case.scene).time,
    };
    job.rows.iter().zip(&job.cases).map(listed).collect()
}

/// Runs the cases of `job` in their order until all are done or `interrupted` becomes true, then
/// sets beside each other what is there; `watch` hears how far it has come.
///
/// # Errors
/// A [`RunnerError`] when a case cannot be run or was computed by another method, or a file cannot
/// be written.
pub fn run(
    job: &PaperJob,
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
) -> Result<Papered, RunnerError> {
    let ending = sweep::run_in_order(&job.sweep, &job.cases, interrupted, watch)?;
    Ok(Papered {
        ending,
        ..set_beside(job)?
    })
}

/// Sets beside each other what is there of `job`, and computes nothing: finished cases of one
/// method, this build's where there are such. What is missing is named.
///
/// # Errors
/// A [`RunnerError`] when a case has other values, or a file cannot be read or written.
pub fn set_beside(job: &PaperJob) -> Result<Papered, RunnerError> {
    // What is read is not to be computed anew.
    let sweep = Sweep {
        restart: false,
        ..job.sweep.clone()
    };
    let folder = SweepFolder::open(&sweep, &job.cases)?;
    let (outcomes, missing) = sweep::gather(&sweep, &job.cases)?;
    let mut files = sweep::set_beside(&sweep, &outcomes)?;
    let tables = all_tables(job, &outcomes);
    let text = page(job.paper, &tables, &missing);
    write_file(&sweep.out.join(TABLES), |file| {
        file.write_all(text.as_bytes())
    })?;
    files.push(TABLES.to_owned());
    folder.close(&sweep, &outcomes, files)?;
    let ending = if missing.is_empty() {
        SweepEnding::Done
    } else {
        SweepEnding::Interrupted
    };
    Ok(Papered {
        ending,
        tables,
        missing,
    })
}

/// The paper's own tables, and that of what was run.
fn all_tables(job: &PaperJob, outcomes: &[CaseResult]) -> Vec<PaperTable> {
    let runs = PaperTable {
        name: "runs",
        title: "What was run",
        text: runs(job, outcomes),
    };
    std::iter::once(runs)
        .chain((job.paper.tables)(&job.sweep, outcomes))
        .collect()
}

/// For each part how many of its cases are there, of how many seeds, over which time; and by which
/// method.
fn runs(job: &PaperJob, outcomes: &[CaseResult]) -> String {
    let mut text = String::from(
        "| part | cases done | of | seeds of each | results from, to [s] |\n|---|---|---|---|---|\n",
    );
    for part in job.paper.parts() {
        let own = || {
            job.rows
                .iter()
                .zip(&job.cases)
                .filter(|(row, _)| row.part == part)
        };
        let is_own = |outcome: &&CaseResult| own().any(|(_, case)| case.name == outcome.case.name);
        let done: Vec<&CaseResult> = outcomes.iter().filter(is_own).collect();
        let all = own().count();
        if all == 0 {
            continue;
        }
        let ensembles = sweep::ensembles(&job.sweep, done.iter().copied());
        let seeds = extremes(ensembles.iter().map(|own| own.members.len()));
        let times = done.first().map_or_else(String::new, |own| {
            format!("{:.0}, {:.0}", own.results.from, own.results.to)
        });
        let _ = writeln!(
            text,
            "| {part} | {} | {all} | {seeds} | {times} |",
            done.len()
        );
    }
    let method = outcomes.first().and_then(|own| own.method.as_deref());
    if let Some(method) = method {
        let _ = write!(
            text,
            "\nComputed by Grainfall {VERSION}, method {method}.\n"
        );
    }
    text
}

/// `2`, or `1 to 2`.
fn extremes(counts: impl Iterator<Item = usize>) -> String {
    let counts: Vec<usize> = counts.collect();
    match (counts.iter().min(), counts.iter().max()) {
        (Some(least), Some(most)) if least == most => least.to_string(),
        (Some(least), Some(most)) => format!("{least} to {most}"),
        _ => String::new(),
    }
}

/// All tables on one page, with what is missing of them.
fn page(paper: &Paper, tables: &[PaperTable], missing: &[String]) -> String {
    let mut text = format!("# {}\n", paper.source);
    for table in tables {
        let _ = write!(text, "\n## {}\n\n{}", table.title, table.text);
    }
    if !missing.is_empty() {
        let _ = write!(text, "\n## Missing\n\n");
        for case in missing {
            let _ = writeln!(text, "- {case}");
        }
    }
    text
}
