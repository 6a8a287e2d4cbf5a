//! `grainfall paper`: what is asked for on the command line.
//!
//! In: its options. Out: a paper's cases run or listed, its tables in its folder and in a document.

use super::terminal::{say, tell};
use super::{Progress, Report, Said};
use grainfall::files::{read_whole, write_whole};
use grainfall::output::OutputError;
use grainfall::paper::{self, Listed, Paper, PaperJob, Papered, Selection};
use grainfall::runner::{RunnerError, exit, spoken};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Which paper, what is to be done with it, and where its results go.
#[derive(clap::Args)]
pub struct PaperTask {
    /// The paper: kasper2021, kasper2021-readings, man2023 or man2023-readings
    name: String,
    #[command(flatten)]
    wanted: Wanted,
    /// Folder for the results [default: out/PAPER]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Cases that run at the same time, each on one thread; fewer cases share the threads [default: all
    /// cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=512))]
    pub threads: Option<u16>,
    /// A file that keeps the results beside the folder, a line for each case, such as
    /// docs/results/kasper2021.jsonl: what it holds is done, what gets done is put into it
    #[arg(long, value_name = "FILE.jsonl")]
    kept: Option<PathBuf>,
    /// Run every case anew, in the place of those that the folder and --kept hold
    #[arg(long)]
    restart: bool,
    /// List the cases in their order, each with how it stands and how long it takes, about, and
    /// compute nothing
    #[arg(long, visible_alias = "dry-run", conflicts_with_all = ["tables_only", "restart", "write"])]
    list: bool,
    /// Make tables and plots of what is there, compute nothing, and say what is missing
    #[arg(long, conflicts_with = "restart")]
    tables_only: bool,
    /// A document in Markdown whose tables of the paper, each between `<!-- table: PAPER/NAME -->`
    /// and `<!-- end -->`, are replaced
    #[arg(long, value_name = "FILE.md")]
    write: Option<PathBuf>,
    #[command(flatten)]
    said: Said,
}

/// Which of a paper's cases are wanted.
#[derive(clap::Args)]
struct Wanted {
    /// So many seeds of each case, instead of as many as the paper's list has
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    seeds: Option<u16>,
    /// This part of the paper alone, such as r3; --list names all (may be repeated)
    #[arg(long, value_name = "PART")]
    part: Vec<String>,
    /// The cases whose names hold this text alone, such as radius=3mm
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// A small setting of the paper, for a try: seconds instead of days
    #[arg(long)]
    small: bool,
}

impl Wanted {
    fn selection(&self) -> Selection {
        Selection {
            is_small: self.small,
            seeds: self.seeds.map(u64::from),
            parts: self.part.clone(),
            only: self.only.clone(),
        }
    }
}

impl PaperTask {
    /// What is to be said.
    pub fn report(&self) -> Report {
        self.said.report()
    }

    /// Whether something is computed.
    pub fn computes(&self) -> bool {
        !self.list && !self.tables_only
    }

    /// What is wanted of the paper, so many cases at a time.
    ///
    /// # Errors
    /// When there is no such paper, or no case of it is left.
    pub fn job(&self, at_once: usize) -> Result<PaperJob, RunnerError> {
        let paper = paper::paper(&self.name)?;
        let selection = self.wanted.selection();
        let job = PaperJob::new(paper, &selection, self.folder(paper), at_once)?;
        Ok(job.restarting(self.restart).with_kept(self.kept.clone()))
    }

    fn folder(&self, paper: &Paper) -> PathBuf {
        let end = if self.wanted.small { "-small" } else { "" };
        let own = || Path::new("out").join(format!("{}{end}", paper.name));
        self.out.clone().unwrap_or_else(own)
    }

    /// Does what is asked for of `job`; prints progress to standard error and the tables to
    /// standard output, but where the report is to be another. Returns the exit code.
    ///
    /// # Errors
    /// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be
    /// written.
    pub fn carry_out(&self, job: &PaperJob, interrupted: &AtomicBool) -> Result<u8, RunnerError> {
        if self.list {
            say_list(&paper::list(job)?);
            return Ok(exit::DONE);
        }
        if let Some(document) = &self.write {
            // What cannot be written in the end is told before days of work.
            read_document(document)?;
        }
        let papered = if self.tables_only {
            paper::set_beside(job)
        } else {
            let mut progress = Progress::of(self.report());
            let papered = paper::run(job, interrupted, &mut progress);
            progress.finish();
            papered
        }?;
        self.say(job, &papered)?;
        if let Some(document) = &self.write {
            self.write_into(document, &papered)?;
        }
        Ok(if self.tables_only {
            exit::DONE
        } else {
            papered.ending.exit_code()
        })
    }

    fn say(&self, job: &PaperJob, papered: &Papered) -> Result<(), RunnerError> {
        let (named, others) = papered.missing.split_at(papered.missing.len().min(NAMED));
        for case in named {
            self.report().note(&format!("missing: {case}"));
        }
        if !others.is_empty() {
            let count = others.len();
            let note = format!("missing: {count} more, which `--list` and tables.md name");
            self.report().note(&note);
        }
        if let Some(lacking) = &papered.lacking {
            self.report().note(lacking);
        }
        if self.report() == Report::Text {
            for table in &papered.tables {
                say(&format!("{}\n\n{}", table.title, table.text));
            }
        }
        self.report().cases(&job.sweep().out)
    }

    /// Puts the tables between the markers of `document`.
    fn write_into(&self, document: &Path, papered: &Papered) -> Result<(), RunnerError> {
        let text = read_document(document)?;
        let replaced = paper::replace(&text, &self.name, &papered.tables);
        let replaced = replaced
            .map_err(|error| RunnerError::Input(format!("{}: {error}", document.display())))?;
        write_whole(document, |file| file.write_all(replaced.as_bytes()))
            .map_err(|source| OutputError::write(document, source))?;
        Ok(())
    }
}

/// Missing cases that are named one by one.
const NAMED: usize = 8;
/// Largest document that is read [bytes].
const LARGEST: u64 = 16 << 20;

fn read_document(path: &Path) -> Result<String, RunnerError> {
    let refuse = |reason: &dyn std::fmt::Display| {
        RunnerError::Input(format!("--write {}: {reason}", path.display()))
    };
    let bytes = read_whole(path, LARGEST).map_err(|error| refuse(&error))?;
    String::from_utf8(bytes).map_err(|_| refuse(&"expected text in UTF-8"))
}

fn say_list(cases: &[Listed]) {
    let mut left = 0.0;
    for (number, case) in (1..).zip(cases) {
        if !case.is_done() {
            left += case.time;
        }
        let time = spoken(case.time);
        say(&format!(
            "{number:>4}  {:<6} {:<50} {time:>8}  {case}",
            case.part, case.name
        ));
    }
    tell(&format!(
        "{} cases, {} of one thread left",
        cases.len(),
        spoken(left)
    ));
}
