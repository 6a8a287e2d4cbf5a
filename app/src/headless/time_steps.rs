//! What limits a scene's time step, and what each choice costs.

use super::named_scene;
use super::terminal::say;
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
}

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
        text
    }
}

/// A step of this many seconds, for people.
fn micro(time: f64) -> String {
    format!("{:.2} µs", time * 1e6)
}
