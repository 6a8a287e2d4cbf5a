//! What limits a scene's time step, and what each choice costs.

use super::named_scene;
use super::terminal::say;
use grainfall::run::{MeasuredBed, MeasuredResult};
use grainfall::runner::{RunnerError, apply_settings, exit};
use grainfall::solver::{Limit, StepChoice, advise, step_choices};
use serde::Serialize;
use std::fmt::Write;

/// What there is to tell.
#[derive(Serialize)]
struct TimeSteps {
    /// What limits the step, the binding limit first.
    limits: Vec<Limit>,
    /// The steps that there are.
    choices: Vec<StepChoice>,
    /// What a bed like the scene's came to with some steps.
    measured: &'static MeasuredBed,
}

/// So many results of a bed stand in the table for people, the first ones; all are compared.
const SHOWN_RESULTS: usize = 4;

/// Prints what limits the step of the scene called `name` with the values `set`, and what an impact
/// comes to with each step that it can have. Returns the exit code.
///
/// # Errors
/// When there is no such scene or no such value.
pub fn list_time_steps(name: &str, set: &[String], json: bool) -> Result<u8, RunnerError> {
    let mut scene = named_scene(name)?;
    apply_settings(&mut scene, set)?;
    let found = TimeSteps {
        limits: advise(&scene).limits,
        choices: step_choices(&scene),
        measured: MeasuredBed::like(&scene),
    };
    let text = if json {
        let text = serde_json::to_string_pretty(&found);
        text.map_err(|error| RunnerError::Input(error.to_string()))?
    } else {
        found.for_people()
    };
    say(text.trim_end());
    Ok(exit::DONE)
}

impl TimeSteps {
    fn for_people(&self) -> String {
        let mut text = String::from("Limits of the step\n");
        for Limit {
            name,
            time_step,
            reason,
        } in &self.limits
        {
            let _ = writeln!(text, "  {:>9}  {name}: {reason}", micro(*time_step));
        }
        let impact = self.choices.iter().find_map(|choice| choice.impact);
        let of = impact.map_or_else(String::new, |impact| {
            format!(
                ", and an impact of two of the smallest grains at {} m/s",
                impact.speed
            )
        });
        let _ = writeln!(text, "\nSteps{of}");
        let _ = writeln!(
            text,
            "  {:<10} {:>9}  {:>12}  {:<25}  steps for a second",
            "", "step", "it lasts", "it gives back"
        );
        for choice in &self.choices {
            let (lasts, back) = choice.impact.map_or(("–".into(), "–".into()), |impact| {
                let [least, most] = impact.range;
                (
                    format!("{:.1} steps", impact.steps),
                    format!("{:.4} ({least:.4} to {most:.4})", impact.restitution),
                )
            });
            let _ = writeln!(
                text,
                "  {:<10} {:>9}  {lasts:>12}  {back:<25}  {:.0}",
                choice.name,
                micro(choice.time_step),
                1.0 / choice.time_step
            );
        }
        text + &measured_for_people(self.measured)
    }
}

/// What a bed came to step by step, as a table.
fn measured_for_people(bed: &MeasuredBed) -> String {
    let standard = bed.standard();
    let shown = &standard.results[..SHOWN_RESULTS];
    let heads = ["step".to_owned(), "runs".to_owned()]
        .into_iter()
        .chain(shown.iter().map(MeasuredResult::head))
        .chain(["off by more than scatter".to_owned()]);
    let rows = bed.steps.iter().map(|step| {
        let name = format!("{} {}", micro(step.time_step), bed.integrator_of(step));
        let off = if bed.is_standard(step) {
            String::new()
        } else {
            bed.off_in_words(step)
        };
        [name.trim_end().to_owned(), step.runs.to_string()]
            .into_iter()
            .chain(
                step.results[..SHOWN_RESULTS]
                    .iter()
                    .map(MeasuredResult::cell),
            )
            .chain([off])
            .collect()
    });
    let rows: Vec<Vec<String>> = std::iter::once(heads.collect()).chain(rows).collect();
    format!(
        "\nA bed that was run with other steps: {}\n{}Means over seeds ± standard error. All results of a step are held against those of the first by Welch's test: \
         of twenty that are the same one is called off.\n",
        bed.bed,
        aligned(&rows)
    )
}

/// `rows` with their cells below each other.
fn aligned(rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let lengths = rows.iter().map(|row| row[column].chars().count());
        lengths.max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..rows.first().map_or(0, Vec::len)).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths);
        let cells = cells.map(|(cell, width)| format!("  {cell:<width$}"));
        format!("{}\n", cells.collect::<String>().trim_end())
    };
    rows.iter().map(line).collect()
}

/// A step of this many seconds, for people.
fn micro(time: f64) -> String {
    format!("{:.2} µs", time * 1e6)
}
