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

/// Writes those of the `plots` of `sweep` that have points; returns the files' names.
///
/// # Errors
/// When a file cannot be written.
pub fn write_plots(
    sweep: &Sweep,
    plots: impl IntoIterator<Item = Plot>,
) -> Result<Vec<String>, RunnerError> {
    let mut names = Vec::new();
    for plot in plots.into_iter().filter(Plot::has_points) {
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

/// Which plots lack which of these outcomes, as their results alone are kept; none where none does.
pub fn lacking(outcomes: &[CaseResult]) -> Option<String> {
    let without: Vec<&str> = (outcomes.iter())
        .filter(|own| own.is_sound() && !own.has_course())
        .map(|own| own.case.name.as_str())
        .collect();
    let plots = if outcomes.iter().any(CaseResult::is_column) {
        "plots/courses"
    } else {
        "plots/courses, plots/velocity and plots/velocity-profile-*.svg"
    };
    let cases = match without.len() {
        0 => return None,
        1 => "1 case, which is".to_owned(),
        count => format!("{count} cases, which are"),
    };
    let (named, others) = without.split_at(without.len().min(3));
    let others = match others.len() {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    let named = named.join(", ");
    Some(format!(
        "{plots} lack {cases} kept without samples: {named}{others}"
    ))
}

/// Every plot of these outcomes; those that show no result are in none.
pub(super) fn plots(sweep: &Sweep, outcomes: &[CaseResult]) -> impl Iterator<Item = Plot> {
    let sound: Vec<CaseResult> = outcomes
        .iter()
        .filter(|own| own.is_sound())
        .cloned()
        .collect();
    let plots = if sound.iter().any(CaseResult::is_column) {
        column_plots(sweep, &sound)
    } else {
        drum_plots(sweep, &sound)
    };
    plots.into_iter()
}
