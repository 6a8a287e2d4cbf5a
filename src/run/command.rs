//! Everything a person can ask of a run.
//!
//! In: what files, scripts and panels say. Out: a [`Command`]. What parameters there are and what
//! they take is not here: [`crate::parameters`] knows.

use crate::parameters::{Parameter, Unsuited, Value};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Everything a person can ask of a run. One enum, one handler ([`super::Run::apply`]).
///
/// A command out of a file has values of the kind that its parameter takes: choices by their words,
/// or by the numbers that stood for them before they had words. Others are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub enum Command {
    /// Go on.
    Play,
    /// Hold.
    Pause,
    /// Take this many steps, then hold.
    Step(u64),
    /// Simulated seconds per wall-clock second to aim for; infinity for as fast as the machine can.
    Speed(f64),
    /// Start afresh at time zero with the settled bed and the present values of the live
    /// parameters.
    Reset,
    /// Show the run as it was at this step, and hold.
    Seek(u64),
    /// Back to the moment of the last change, as if it had not been made.
    Undo,
    /// What the last undo took back, as it was.
    Redo,
    /// Show the kept run of this index again, and keep the present one.
    Return(usize),
    /// Keep the run of this index no longer.
    Forget(usize),
    /// Give a live parameter a value.
    Set {
        /// Which one.
        parameter: Parameter,
        /// Its new value, one of [`crate::parameters::ParameterInfo::values`].
        value: Value,
    },
}

impl Serialize for Command {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Command {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let command = Self::deserialize(deserializer)?;
        command.typed().map_err(D::Error::custom)
    }
}

impl Command {
    /// It with a value of the kind that its parameter takes.
    ///
    /// # Errors
    /// When the parameter takes no such value, with what it takes.
    pub(crate) fn typed(self) -> Result<Self, Unsuited> {
        match self {
            Self::Set { parameter, value } => {
                let value = parameter.typed(value)?;
                Ok(Self::Set { parameter, value })
            }
            other => Ok(other),
        }
    }

    /// Its name where it moves along the runs instead of changing one.
    pub(crate) fn moving(&self) -> Option<&'static str> {
        match self {
            Self::Reset => Some("Reset"),
            Self::Seek(_) => Some("Seek"),
            Self::Undo => Some("Undo"),
            Self::Redo => Some("Redo"),
            Self::Return(_) => Some("Return"),
            Self::Forget(_) => Some("Forget"),
            Self::Play | Self::Pause | Self::Step(_) | Self::Speed(_) | Self::Set { .. } => None,
        }
    }
}

/// A command and the step before which it was carried out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StampedCommand {
    /// Steps taken when it was carried out.
    pub step: u64,
    /// Simulated time then [s].
    pub time: f64,
    /// What was asked.
    pub command: Command,
}
