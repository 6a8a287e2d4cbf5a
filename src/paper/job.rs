//! Running a paper's cases, and setting beside each other what is there of them.
//!
//! In: a [`PaperJob`]. Out: the files of its folder, its tables, and which cases are missing.

use super::kept_file::{self, KeptFile};
use super::kept_line::{Identity, KeptLine};
use super::plan::{Paper, PaperTable, Row, Selection};
use crate::output::write_file;
use crate::run::{BedStore, Estimate, VERSION};
use crate::runner::{RunnerError, Standing, Watch, standing};
use crate::sweep::{self, Case, CaseResult, Kept, Sweep, SweepEnding, SweepFolder};
use std::fmt::{self, Write as _};
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
    /// The file that keeps results beside the folder, if one does.
    kept: Option<PathBuf>,
}

/// A case of a paper, as a list shows it.
pub struct Listed {
    /// The part that it belongs to.
    pub part: &'static str,
    /// Its folder's name.
    pub name: String,
    /// How it stands there; none where that cannot be told, with the reason.
    pub standing: Result<Standing, String>,
    /// What of it is kept beside the folder.
    kept: Kept,
    /// Time of one thread that it takes, about [s].
    pub time: f64,
}

impl Listed {
    /// Whether nothing of it is left to compute.
    pub fn is_done(&self) -> bool {
        self.is_kept() || self.standing == Ok(Standing::Done)
    }

    /// Whether its results are kept beside the folder.
    pub fn is_kept(&self) -> bool {
        matches!(self.kept, Kept::Results(_))
    }
}

impl fmt::Display for Listed {
    /// How it stands, in words.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.kept, &self.standing) {
            (Kept::Results(_), _) => f.write_str("kept"),
            (_, Err(reason)) => f.write_str(reason),
            (Kept::Unused(reason), Ok(standing)) if *standing != Standing::Done => {
                write!(f, "{standing}; {reason}")
            }
            (_, Ok(standing)) => write!(f, "{standing}"),
        }
    }
}

/// What came of a paper.
pub struct Papered {
    /// Whether all its cases are done.
    pub ending: SweepEnding,
    /// Its tables.
    pub tables: Vec<PaperTable>,
    /// The cases that are in none of them, each with how it stands.
    pub missing: Vec<String>,
    /// Which plots lack cases whose results alone are kept, if any do.
    pub lacking: Option<String>,
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
            kept: None,
        })
    }

    /// The same with results kept in the file at `path` as well, where there is one: what it holds
    /// of this build's method is done, and what is done is put into it.
    #[must_use]
    pub fn with_kept(mut self, path: Option<PathBuf>) -> Self {
        self.kept = path;
        self
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

    /// What the cases take that are to be run, `at_once` of them at the same time.
    ///
    /// # Errors
    /// When the file that keeps results is damaged or cannot be read.
    pub fn estimate(&self, at_once: usize) -> Result<Estimate, RunnerError> {
        let waiting = self.waiting()?;
        let scenes = waiting.iter().map(|case| &case.scene);
        Ok(Estimate::of_cases(scenes, at_once))
    }

    /// The sweep that its cases are run by.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// What of each case is kept beside the folder.
    fn kept(&self) -> Result<Vec<Kept>, RunnerError> {
        let Some(path) = &self.kept else {
            return Ok(self.cases.iter().map(|_| Kept::Nothing).collect());
        };
        let file = KeptFile::read(path)?;
        let kept = self.cases.iter().map(|case| kept_of(&file, case));
        kept.collect()
    }

    /// The cases that are to be run: those that are not kept, all where it restarts.
    fn waiting(&self) -> Result<Vec<Case>, RunnerError> {
        let kept = self.kept()?;
        let is_waiting = |kept: &Kept| self.sweep.restart || !matches!(kept, Kept::Results(_));
        let waiting = self.cases.iter().zip(&kept);
        let waiting = waiting.filter(|(_, kept)| is_waiting(kept));
        Ok(waiting.map(|(case, _)| case.clone()).collect())
    }

    /// Keeps what the folders hold of these `outcomes`, where it was computed by this build's
    /// method; lines that are there stay unless `replace`.
    fn keep<'a>(
        &self,
        outcomes: impl IntoIterator<Item = &'a CaseResult>,
        replace: bool,
    ) -> Result<(), RunnerError> {
        let Some(path) = &self.kept else {
            return Ok(());
        };
        let is_new = |own: &&CaseResult| own.has_course() && own.is_of_this_method();
        let lines = outcomes.into_iter().filter(is_new).map(|outcome| {
            let identity = Identity::of(&outcome.case)?;
            KeptLine::of(identity, outcome)
        });
        let lines = lines.collect::<Result<_, String>>();
        let lines = lines.map_err(RunnerError::Input)?;
        kept_file::put(path, lines, replace)
    }

    /// The sweep as it reads what is there: nothing is to be computed anew.
    fn reading(&self) -> Sweep {
        Sweep {
            restart: false,
            ..self.sweep.clone()
        }
    }
}

/// What `file` keeps of `case`.
fn kept_of(file: &KeptFile, case: &Case) -> Result<Kept, RunnerError> {
    let own = Identity::of(case).map_err(RunnerError::Input)?;
    let Some((number, line)) = file.find(&own) else {
        let reason = file.why_unused(&own);
        return Ok(reason.map_or(Kept::Nothing, Kept::Unused));
    };
    let results = line.results();
    let results = results.map_err(|reason| file.damaged(*number, &reason))?;
    let kept = CaseResult::kept(case, results, line.state.clone(), own.method);
    Ok(Kept::Results(Box::new(kept)))
}

/// The cases of `job` in the order in which they are run, each with how it stands.
///
/// # Errors
/// When the file that keeps results is damaged or cannot be read.
pub fn list(job: &PaperJob) -> Result<Vec<Listed>, RunnerError> {
    let listed = |((row, case), kept): ((&Row, &Case), Kept)| Listed {
        part: row.part,
        name: case.name.clone(),
        standing: standing(&sweep::job(&job.sweep, case)).map_err(|error| error.to_string()),
        kept,
        time: Estimate::of(&case.scene).time,
    };
    let cases = job.rows.iter().zip(&job.cases);
    Ok(cases.zip(job.kept()?).map(listed).collect())
}

/// Runs the cases of `job` that are not kept in their order until all are done or `interrupted`
/// becomes true, then sets beside each other what is there; `watch` hears how far it has come.
///
/// # Errors
/// A [`RunnerError`] when a case cannot be run or was computed by another method, or a file cannot
/// be written.
pub fn run(
    job: &PaperJob,
    interrupted: &AtomicBool,
    watch: &mut dyn Watch,
) -> Result<Papered, RunnerError> {
    if job.kept.is_some() && !job.sweep.restart {
        // What earlier calls left in the folder, before days of work.
        let (outcomes, _) = sweep::gather(&job.sweep, &job.cases, &[])?;
        job.keep(&outcomes, false)?;
    }
    let keep = |outcome: &CaseResult| job.keep([outcome], job.sweep.restart);
    let waiting = job.waiting()?;
    let ending = sweep::run_in_order(&job.sweep, &waiting, interrupted, watch, &keep)?;
    Ok(Papered {
        ending,
        ..set_beside(job)?
    })
}

/// Sets beside each other what is there of `job`, and computes nothing: finished cases of one
/// method, this build's where there are such, out of the folder, else out of the file that keeps
/// results. What is missing is named.
///
/// # Errors
/// A [`RunnerError`] when a case has other values, the folder and the file that keeps results state
/// different things, or a file cannot be read or written.
pub fn set_beside(job: &PaperJob) -> Result<Papered, RunnerError> {
    let sweep = job.reading();
    let kept = job.kept()?;
    let folder = SweepFolder::open(&sweep, &job.cases)?;
    let (outcomes, missing) = sweep::gather(&sweep, &job.cases, &kept)?;
    job.keep(&outcomes, false)?;
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
        lacking: sweep::lacking(&outcomes),
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
