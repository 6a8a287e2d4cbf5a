//! Everything a person can ask of a run.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Everything a person can ask of a run. One enum, one handler ([`super::Command`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Give a live parameter a value, in SI units.
    Set {
        /// Which one.
        parameter: Parameter,
        /// Its new value, in [`super::ParameterInfo::range`].
        value: f64,
    },
}

impl Command {
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

/// A number that can change while a run goes on. Materials and species go by the names the scene
/// gives them.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum Parameter {
    /// Sliding friction μ between two materials, dry.
    Friction(String, String),
    /// Sliding friction μ between two materials where there is liquid.
    WetFriction(String, String),
    /// Restitution e between two materials.
    Restitution(String, String),
    /// Rolling friction `μ_R` between two materials.
    RollingFriction(String, String),
    /// Angular speed of the drum [rad/s].
    DrumSpeed,
    /// Magnitude of gravity, its direction kept [m/s²].
    Gravity,
    /// Share of a species by number, where species share one radius.
    Share(String),
    /// Viscosity η of the liquid [Pa s].
    Viscosity,
    /// Surface tension γ of the liquid [N/m].
    SurfaceTension,
    /// Contact angle α of the liquid [rad].
    ContactAngle,
    /// Volume of all the liquid [m³].
    LiquidVolume,
    /// How bridges act: 0 as printed, 1 as coded.
    BridgeLaw,
    /// Length of a step [s]. It belongs to how the run is computed, not to what runs.
    TimeStep,
}

impl fmt::Display for Parameter {
    /// The key in command lists and for `--set`: `friction.glass.drum`, `drum-speed` …
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Friction(a, b) => write!(f, "friction.{a}.{b}"),
            Self::WetFriction(a, b) => write!(f, "wet-friction.{a}.{b}"),
            Self::Restitution(a, b) => write!(f, "restitution.{a}.{b}"),
            Self::RollingFriction(a, b) => write!(f, "rolling-friction.{a}.{b}"),
            Self::DrumSpeed => f.write_str("drum-speed"),
            Self::Gravity => f.write_str("gravity"),
            Self::Share(species) => write!(f, "share.{species}"),
            Self::Viscosity => f.write_str("viscosity"),
            Self::SurfaceTension => f.write_str("surface-tension"),
            Self::ContactAngle => f.write_str("contact-angle"),
            Self::LiquidVolume => f.write_str("liquid-volume"),
            Self::BridgeLaw => f.write_str("bridge-law"),
            Self::TimeStep => f.write_str("time-step"),
        }
    }
}

impl From<Parameter> for String {
    fn from(parameter: Parameter) -> Self {
        parameter.to_string()
    }
}

impl TryFrom<String> for Parameter {
    type Error = String;

    fn try_from(key: String) -> Result<Self, String> {
        let parts: Vec<&str> = key.split('.').collect();
        match parts[..] {
            ["friction", a, b] => Ok(Self::Friction(a.into(), b.into())),
            ["wet-friction", a, b] => Ok(Self::WetFriction(a.into(), b.into())),
            ["restitution", a, b] => Ok(Self::Restitution(a.into(), b.into())),
            ["rolling-friction", a, b] => Ok(Self::RollingFriction(a.into(), b.into())),
            ["drum-speed"] => Ok(Self::DrumSpeed),
            ["gravity"] => Ok(Self::Gravity),
            ["share", species] => Ok(Self::Share(species.into())),
            ["viscosity"] => Ok(Self::Viscosity),
            ["surface-tension"] => Ok(Self::SurfaceTension),
            ["contact-angle"] => Ok(Self::ContactAngle),
            ["liquid-volume"] => Ok(Self::LiquidVolume),
            ["bridge-law"] => Ok(Self::BridgeLaw),
            ["time-step"] => Ok(Self::TimeStep),
            _ => Err(format!(
                "no parameter is called `{key}`; expected one of friction.A.B, wet-friction.A.B, restitution.A.B, \
                 rolling-friction.A.B (A, B: materials), drum-speed, gravity, share.S (S: a species), viscosity, \
                 surface-tension, contact-angle, liquid-volume, bridge-law, time-step"
            )),
        }
    }
}
