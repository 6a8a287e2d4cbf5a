//! The plots of a sweep as SVG files: those of columns, or those of drums.
//!
//! In: what became of the cases. Out: one file for each plot that has points.

use super::Sweep;
use super::case::CaseResult;
use super::chart::Plot;
use super::column_plots::column_plots;
use super::drum_plots::drum_plots;
use crate::output::write_file;
use crate::run::Provenance;
use crate::runner::RunnerError;

/// Writes every plot that the outcomes have points for; returns the files' names.
///
/// # Errors
/// When a file cannot be written.
pub fn write_plots(sweep: &Sweep, outcomes: &[CaseResult]) -> Result<Vec<String>, RunnerError> {
    let mut names = Vec::new();
    for plot in plots(sweep, outcomes).filter(Plot::has_points) {
        let text = plot.draw().map_err(|reason| {
            RunnerError::Input(format!("the plot {} cannot be drawn: {reason}", plot.file))
        })?;
        let name = format!("plots/{}", plot.file);
        let path = sweep.out.join(&name);
        let text = Provenance::of_scene(&sweep.scene).in_svg(&text);
        write_file(&path, |file| file.write_all(text.as_bytes()))?;
        names.push(name);
    }
    Ok(names)
}

/// Every plot of these outcomes. What a case came to before it met a fault is no result, nor is
/// where one stood that was stopped before it began: they are in no plot.
pub(super) fn plots(sweep: &Sweep, outcomes: &[CaseResult]) -> impl Iterator<Item = Plot> {
    let has_begun =
        |outcome: &CaseResult| outcome.series.time().last().is_some_and(|time| *time > 0.0);
    let is_sound = |outcome: &&CaseResult| outcome.ending.fault().is_none() && has_begun(outcome);
    let sound: Vec<CaseResult> = outcomes.iter().filter(is_sound).cloned().collect();
    let plots = if sound.iter().any(CaseResult::is_column) {
        column_plots(sweep, &sound)
    } else {
        drum_plots(sweep, &sound)
    };
    plots.into_iter()
}
