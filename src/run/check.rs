//! Whether a command can be carried out in a run, and why not.
//!
//! In: a command, the run's parameters, a state of it. Out: the command as the run carries it out,
//! or a [`CommandError`] with the value, the range and the keys there are. Nothing is changed here.

use super::Command;
use crate::parameters::{Parameter, ParameterInfo, Unsuited, Values, time_step};
use crate::world::World;

/// Why a command was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CommandError {
    /// The scene has no such live parameter.
    #[error("the scene has no parameter `{parameter}`; it has {}", .known.join(", "))]
    Unknown {
        /// The key that was given.
        parameter: String,
        /// The keys there are.
        known: Vec<String>,
    },
    /// What is shown was computed before.
    #[error(
        "This is a recording: it shows what was computed before. `Run anew` beside the timeline starts a run that can be \
         changed"
    )]
    Recorded,
    /// The parameter takes no such value at all.
    #[error(transparent)]
    Unsuited(#[from] Unsuited),
    /// The value lies outside the parameter's range.
    #[error(
        "`{parameter}` cannot be {} {unit}; expected {low} … {high} {unit}", readable(*.value)
    )]
    OutOfRange {
        /// Which parameter.
        parameter: Parameter,
        /// The value asked for.
        value: f64,
        /// Smallest value it can take.
        low: f64,
        /// Largest value it can take.
        high: f64,
        /// SI unit of the three.
        unit: &'static str,
    },
}

/// The `command` as it is carried out in `world`: its parameter by the one name that it has, its
/// value of the kind that this takes.
///
/// # Errors
/// Why it cannot be carried out.
pub(crate) fn accept(
    parameters: &[ParameterInfo],
    world: &World,
    command: &Command,
) -> Result<Command, CommandError> {
    let Command::Set { parameter, value } = command else {
        return Ok(command.clone());
    };
    let parameter = parameter.canonical(&world.materials);
    let step = time_step(world.clock.time_step);
    let known = || parameters.iter().chain([&step]);
    let Some(info) = known().find(|info| info.parameter == parameter) else {
        return Err(CommandError::Unknown {
            parameter: parameter.to_string(),
            known: known().map(|info| info.parameter.to_string()).collect(),
        });
    };
    let value = parameter.typed(*value)?;
    match &info.values {
        Values::Range(range) if !range.contains(&value.number()) => Err(CommandError::OutOfRange {
            low: *range.start(),
            high: *range.end(),
            unit: parameter.row().kind.unit().si,
            value: value.number(),
            parameter,
        }),
        Values::Range(_) | Values::Choices(_) => Ok(Command::Set { parameter, value }),
    }
}

/// A number without hundreds of zeros.
fn readable(value: f64) -> String {
    if value == 0.0 || !value.is_finite() || (1e-6..1e9).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn numbers_that_are_refused_are_told_in_a_few_letters() {
        let told = [0.0, 999.0, -0.5, 1e300, 1e-300, f64::NAN].map(readable);
        assert_eq!(told, ["0", "999", "-0.5", "1e300", "1e-300", "NaN"]);
    }
}
