//! `summary.json`: what was run, how it ended, what came out.

use crate::measure::Summary;
use crate::run::{StampedCommand, fingerprint};
use crate::scene::Scene;
use crate::solver::{Fault, TimeStepAdvice};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// All that `summary.json` holds, in SI units.
#[derive(Debug, Serialize)]
pub struct SummaryFile<'a> {
    /// Always `grainfall`: the folder is a run's.
    pub program: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// Hash of how its solver and measures compute ([`crate::run::method`]).
    pub method: &'static str,
    /// `running`, `done`, `interrupted`, `fault`, or `imported` from another program.
    pub status: &'static str,
    /// What made the solver stop, if anything.
    pub fault: Option<&'a Fault>,
    /// What the scene was called.
    pub name: &'a str,
    /// Seed of everything random.
    pub seed: u64,
    /// The scene as it was run; scene, seed and commands make the run.
    pub scene: &'a Scene,
    /// The commands carried out.
    pub commands: &'a [StampedCommand],
    /// The time step and its reasons.
    pub time_step: &'a TimeStepAdvice,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time reached [s].
    pub time: f64,
    /// Number of grains.
    pub grains: usize,
    /// Hash of the last state: the same scene, seed and commands give the same hash.
    pub state_hash: Option<String>,
    /// The results.
    pub results: Option<&'a Summary>,
    /// Wall-clock time of the run [s].
    pub wall_time: f64,
    /// Threads the solver worked on.
    pub threads: usize,
    /// What people should know, in sentences.
    pub warnings: &'a [String],
    /// The files that were written, by their names relative to the folder, each with its digest.
    pub files: &'a BTreeMap<String, String>,
}

impl SummaryFile<'_> {
    /// Writes it to `file`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        let fingerprint = fingerprint(&serde_json::to_value(self)?);
        let signed = Signed {
            summary: self,
            fingerprint,
        };
        serde_json::to_writer_pretty(&mut *file, &signed)?;
        file.write_all(b"\n")
    }
}

/// A summary with what tells whether it was edited since.
#[derive(Serialize)]
struct Signed<'a> {
    #[serde(flatten)]
    summary: &'a SummaryFile<'a>,
    fingerprint: String,
}
