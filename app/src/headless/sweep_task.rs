//! `grainfall sweep`: what is asked for on the command line.
//!
//! In: its options. Out: the sweep, and the part of it that is to be done, which is carried out and
//! reported.

use super::terminal::{say, tell};
use super::{Progress, Report, Said, named_scene};
use grainfall::output::Ending;
use grainfall::run::{BedStore, Estimate};
use grainfall::runner::{RunnerError, apply_settings, exit};
use grainfall::sweep::{self, Sweep, Variation};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// What to vary about which scene, and where its results go.
#[derive(clap::Args)]
pub struct SweepTask {
    /// A scene file, or the name of a built-in scene
    pub scene: String,
    /// What to vary: liquid=0..7, mix=0.1..0.5:0.1, radius=3mm,2mm (may be repeated: every
    /// combination is run); 'radius=3mm,2mm; count=470,1600' goes value by value
    #[arg(long, value_name = "KEY=VALUES", required_unless_present = "seeds")]
    vary: Vec<String>,
    /// Run every case from so many seeds, the scene's and those that follow it: tables and plots
    /// give means with their standard errors over the seeds
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    seeds: Option<u16>,
    /// Change a value in every case, as in a single run
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Simulated time of each case: 10s, 2min
    #[arg(long, value_name = "TIME")]
    duration: Option<String>,
    /// Folder for the results [default: out/SCENE-sweep]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Cases that run at the same time, each on one thread; fewer cases share the threads [default: all
    /// cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=512))]
    pub jobs: Option<u16>,
    /// Run every case anew, in the place of those that the folder holds
    #[arg(long)]
    restart: bool,
    /// Say how many cases there are, and do nothing
    #[arg(long, conflicts_with_all = ["case", "merge", "restart"])]
    count: bool,
    /// Run this case alone, 1 to the number that --count says, and set nothing beside it
    #[arg(long, value_name = "K", conflicts_with = "merge")]
    case: Option<usize>,
    /// Set what the cases came to beside each other, compute nothing, and say what is missing
    #[arg(long, conflicts_with = "restart")]
    merge: bool,
    #[command(flatten)]
    said: Said,
}

impl SweepTask {
    /// What is to be said.
    pub fn report(&self) -> Report {
        self.said.report()
    }

    /// How many cases run at the same time where `jobs` may; none where nothing is computed.
    pub fn runs_at_once(&self, jobs: usize) -> Option<usize> {
        match (self.count || self.merge, self.case) {
            (true, _) => None,
            (false, Some(_)) => Some(1),
            (false, None) => Some(jobs),
        }
    }

    /// The sweep whose output folder is called `name` where none is asked for, with so many `jobs`.
    ///
    /// # Errors
    /// When the scene, a setting or a variation is wrong.
    pub fn sweep(&self, name: &str, jobs: usize) -> Result<Sweep, RunnerError> {
        let mut scene = named_scene(&self.scene)?;
        let duration = self.duration.iter();
        let duration: Vec<String> = duration.map(|time| format!("duration={time}")).collect();
        apply_settings(&mut scene, &duration)?;
        let mut variations = Vec::new();
        for text in &self.vary {
            variations.extend(Variation::parse_tied(text)?);
        }
        let seeds = self
            .seeds
            .map(|count| Variation::of_seeds(scene.seed, count));
        variations.extend(seeds);
        let out = || Path::new("out").join(format!("{name}-sweep"));
        Ok(Sweep {
            name: self.scene.clone(),
            scene,
            settings: self.set.clone(),
            variations,
            out: self.out.clone().unwrap_or_else(out),
            jobs,
            beds: BedStore::user(),
            restart: self.restart,
        })
    }

    /// What the cases of `sweep` that are asked for take, `at_once` of them at the same time.
    ///
    /// # Errors
    /// When a case cannot be.
    pub fn estimate(&self, sweep: &Sweep, at_once: usize) -> Result<Estimate, RunnerError> {
        let cases = sweep::cases(sweep)?;
        let asked = |number: usize| self.case.is_none_or(|only| only == number);
        let cases = (1..).zip(&cases).filter(|(number, _)| asked(*number));
        Ok(Estimate::of_cases(
            cases.map(|(_, case)| &case.scene),
            at_once,
        ))
    }

    /// Does what is asked for of `sweep`; prints progress to standard error and what came out to
    /// standard output, but where the report is to be another. Returns the exit code.
    ///
    /// # Errors
    /// A [`RunnerError`] when the input asks for something that cannot be, or a file cannot be
    /// written.
    pub fn carry_out(&self, sweep: &Sweep, interrupted: &AtomicBool) -> Result<u8, RunnerError> {
        if self.count {
            say(&sweep::count(sweep)?.to_string());
            return Ok(exit::DONE);
        }
        if let Some(number) = self.case {
            return Ok(self.run_case(sweep, number, interrupted)?.exit_code());
        }
        let swept = if self.merge {
            sweep::merge(sweep)
        } else {
            let mut progress = Progress::of(self.report());
            let swept = sweep::run(sweep, interrupted, &mut progress);
            progress.finish();
            swept
        }?;
        for case in &swept.missing {
            tell(&format!("missing: {case}"));
        }
        self.report().sweep(sweep, &swept)?;
        Ok(swept.ending.exit_code())
    }

    fn run_case(
        &self,
        sweep: &Sweep,
        number: usize,
        interrupted: &AtomicBool,
    ) -> Result<Ending, RunnerError> {
        let mut progress = Progress::of(self.report());
        let outcome = sweep::run_case(sweep, number, interrupted, &mut progress);
        progress.finish();
        let (name, ending) = outcome?;
        self.report().case(number, &sweep.out.join(name), &ending)?;
        Ok(ending)
    }
}
