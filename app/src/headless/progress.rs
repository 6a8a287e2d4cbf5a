//! How far a run has come: a bar on a terminal, a line now and then elsewhere. Everything goes to
//! standard error.

use super::report::Report;
use super::terminal;
use grainfall::runner::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Time between two lines where there is no terminal.
const LINE_TIME: Duration = Duration::from_secs(5);
/// Parts of a whole that a bar distinguishes.
const PARTS: f64 = 10_000.0;

/// Tells how far something has come.
pub enum Progress {
    /// Nobody wants to hear it.
    Silent,
    /// On a terminal.
    Bar(ProgressBar),
    /// In a file or a pipe.
    Lines {
        /// When the last line was written.
        told: Instant,
    },
}

impl Progress {
    /// On standard error, as that is.
    pub fn on_stderr() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self::Lines {
                told: Instant::now(),
            };
        }
        let bar = ProgressBar::with_draw_target(Some(PARTS as u64), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}") {
            bar.set_style(style);
        }
        Self::Bar(bar)
    }

    /// As the `report` at the end asks for.
    pub fn of(report: Report) -> Self {
        match report {
            Report::Quiet => Self::Silent,
            Report::Text | Report::Json => Self::on_stderr(),
        }
    }

    /// Says that `share` (0 … 1) is done, and `what`.
    pub fn tell(&mut self, share: f64, what: impl FnOnce() -> String) {
        match self {
            Self::Silent => {}
            Self::Bar(bar) => {
                bar.set_position((share * PARTS) as u64);
                bar.set_message(what());
            }
            Self::Lines { told } if told.elapsed() < LINE_TIME => {}
            Self::Lines { told } => {
                *told = Instant::now();
                terminal::tell(&format!("{:3.0} %  {}", 100.0 * share, what()));
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

impl Watch for Progress {
    fn preparing(&mut self, share: f64, stage: &str) {
        self.tell(share, || stage.to_owned());
    }

    fn running(&mut self, share: f64, what: &dyn Fn() -> String) {
        self.tell(share, what);
    }
}
