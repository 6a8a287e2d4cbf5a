//! Which parameters there are, each with its row, and the keys they go by.
//!
//! In: a key such as `friction.glass.drum`. Out: the [`Parameter`], and the [`ParameterRow`] that
//! holds all else that is known of it. **To add a parameter**: write its row in one of the files of
//! `rows`, and its line in the list below. Nothing else lists parameters.

use super::parameter_row::{Kind, Names, ParameterRow};
use super::rows::{
    bridge_choices, driving, liquid_and_bridges, material_pairs, material_properties, run, sizes,
};
use super::value::Value;
use crate::physics::Materials;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What the names of a parameter are names of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameKind {
    /// It has none.
    None,
    /// A material.
    Material,
    /// A species.
    Species,
    /// Two materials that meet.
    Pair,
}

/// A row of the registry, and how parameters of it are made.
pub struct Entry {
    /// What is known of it.
    pub row: &'static ParameterRow,
    /// What its names are names of.
    pub name_kind: NameKind,
    /// The parameter of it that is about these names.
    pub of: fn(Names) -> Parameter,
}

/// Makes the enum of parameters, and the list of their rows in the same order.
macro_rules! parameters {
    ($($(#[$doc:meta])* $variant:ident $(($($name:ident),+))? => $row:path,)+) => {
        /// A value of a scene that people can change, while a run goes on or before it starts.
        /// Materials and species go by the names the scene gives them. Panels list parameters in
        /// this order.
        #[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(into = "String", try_from = "String")]
        pub enum Parameter {
            $($(#[$doc])* $variant $(($(parameters!(@text $name)),+))?,)+
        }

        impl Parameter {
            /// What is known of it.
            pub fn row(&self) -> &'static ParameterRow {
                match self {
                    $(Self::$variant { .. } => &$row,)+
                }
            }

            /// The names that it is about.
            pub fn names(&self) -> Names<'_> {
                match self {
                    $(Self::$variant $(($($name),+))? => parameters!(@names $($($name)+)?),)+
                }
            }

            /// That of the same row about other names.
            fn about(&self, names: Names) -> Self {
                let of: fn(Names) -> Self = match self {
                    $(Self::$variant { .. } => parameters!(@of $variant $($($name)+)?),)+
                };
                of(names)
            }

            /// What its names are names of.
            pub fn name_kind(&self) -> NameKind {
                match self {
                    $(Self::$variant { .. } => parameters!(@name_kind $($($name)+)?),)+
                }
            }
        }

        /// Every row.
        static ENTRIES: &[Entry] = &[$(Entry {
            row: &$row,
            name_kind: parameters!(@name_kind $($($name)+)?),
            of: parameters!(@of $variant $($($name)+)?),
        },)+];
    };
    (@text $name:ident) => { String };
    (@names) => { ["", ""] };
    (@names $a:ident) => { [$a, ""] };
    (@names $a:ident $b:ident) => { [$a, $b] };
    (@name_kind) => { NameKind::None };
    (@name_kind material) => { NameKind::Material };
    (@name_kind species) => { NameKind::Species };
    (@name_kind $a:ident $b:ident) => { NameKind::Pair };
    (@of $variant:ident) => { |_| Parameter::$variant };
    (@of $variant:ident $a:ident) => { |[a, _]| Parameter::$variant(a.to_owned()) };
    (@of $variant:ident $a:ident $b:ident) => {
        |[a, b]| Parameter::$variant(a.to_owned(), b.to_owned())
    };
}

parameters! {
    /// Angular speed of the drum [rad/s].
    DrumSpeed => driving::DRUM_SPEED,
    /// Magnitude of gravity, its direction kept [m/s²].
    Gravity => driving::GRAVITY,
    /// Sliding friction μ between two materials where there is liquid.
    WetFriction(a, b) => material_pairs::WET_FRICTION,
    /// Sliding friction μ between two materials, dry.
    Friction(a, b) => material_pairs::FRICTION,
    /// Rolling friction `μ_R` between two materials.
    RollingFriction(a, b) => material_pairs::ROLLING_FRICTION,
    /// Restitution e between two materials.
    Restitution(a, b) => material_pairs::RESTITUTION,
    /// Share of a species by number, where species share one radius.
    Share(species) => driving::SHARE,
    /// Viscosity η of the liquid [Pa s].
    Viscosity => liquid_and_bridges::VISCOSITY,
    /// Surface tension γ of the liquid [N/m].
    SurfaceTension => liquid_and_bridges::SURFACE_TENSION,
    /// Contact angle α of the liquid [rad].
    ContactAngle => liquid_and_bridges::CONTACT_ANGLE,
    /// Volume of all the liquid [m³].
    LiquidVolume => liquid_and_bridges::VOLUME,
    /// How bridges act: as printed, as coded, or by choices of one's own.
    BridgeLaw => liquid_and_bridges::BRIDGE_LAW,
    /// What a bridge holds of both grains' films.
    BridgeVolume => bridge_choices::BRIDGE_VOLUME,
    /// Which contact angle two grains have together.
    PairAngle => bridge_choices::PAIR_ANGLE,
    /// Smallest gap of the viscous forces.
    ViscousGap => bridge_choices::VISCOUS_GAP,
    /// Gap of the capillary force of grains that touch or nearly do.
    CapillaryGap => bridge_choices::CAPILLARY_GAP,
    /// When a bridge breaks.
    Rupture => bridge_choices::RUPTURE,
    /// Which normal force bounds friction.
    CoulombBound => bridge_choices::COULOMB,
    /// The liquid of the paper's Table 1, or none.
    Liquid => liquid_and_bridges::CASE,
    /// Number of grains of a filling.
    GrainCount => sizes::GRAIN_COUNT,
    /// Radius of all grains of a filling [m].
    GrainRadius => sizes::GRAIN_RADIUS,
    /// Size of a lattice cell of Voronoi grains [m].
    Cell => sizes::CELL,
    /// Rounding radius of Voronoi grains [m].
    Rounding => sizes::ROUNDING,
    /// Share of the cells that become grains.
    SolidFraction => sizes::SOLID_FRACTION,
    /// Share of the second of two species of Voronoi cells.
    Mix => sizes::MIX,
    /// Inner radius of the drum [m].
    DrumRadius => sizes::DRUM_RADIUS,
    /// Inner width of the drum [m].
    DrumWidth => sizes::DRUM_WIDTH,
    /// Radius of the column [m].
    ColumnRadius => sizes::COLUMN_RADIUS,
    /// Height of the column [m].
    ColumnHeight => sizes::COLUMN_HEIGHT,
    /// Density of a material [kg/m³].
    Density(material) => material_properties::DENSITY,
    /// Young's modulus of a material [Pa].
    YoungsModulus(material) => material_properties::YOUNGS_MODULUS,
    /// Poisson's ratio of a material.
    PoissonRatio(material) => material_properties::POISSON_RATIO,
    /// Friction of two grains of the first species, from the start on.
    FirstFriction => material_properties::FIRST_FRICTION,
    /// Friction of two grains of the second species, from the start on.
    SecondFriction => material_properties::SECOND_FRICTION,
    /// Friction of all grains on the container, from the start on.
    WallFriction => material_properties::WALL_FRICTION,
    /// Normal stiffness of linear springs [N/m].
    NormalStiffness => material_properties::NORMAL_STIFFNESS,
    /// How contacts of two polyhedra in several places count.
    Features => material_properties::FEATURES,
    /// How the equations of motion of polyhedra are integrated.
    Integrator => run::INTEGRATOR,
    /// Time step [s].
    TimeStep => run::TIME_STEP,
    /// Seed of everything random.
    Seed => run::SEED,
    /// Simulated time of a run without a window [s].
    Duration => run::DURATION,
    /// What ends a run without a window.
    Until => run::UNTIL,
    /// Simulated time between two written states [s].
    OutputInterval => run::OUTPUT_INTERVAL,
    /// Simulated time between two samples [s].
    SampleInterval => run::SAMPLE_INTERVAL,
}

/// Every row of the registry, in the order of [`Parameter`].
pub fn entries() -> &'static [Entry] {
    ENTRIES
}

impl Entry {
    /// Its key with what its names stand for: `friction.A.B`, `share.S`.
    pub fn key(&self) -> String {
        let names = match self.name_kind {
            NameKind::None => "",
            NameKind::Material => ".M",
            NameKind::Species => ".S",
            NameKind::Pair => ".A.B",
        };
        format!("{}{names}", self.row.key)
    }
}

impl NameKind {
    /// How many names there are.
    pub fn count(self) -> usize {
        match self {
            Self::None => 0,
            Self::Material | Self::Species => 1,
            Self::Pair => 2,
        }
    }
}

/// A value that a parameter does not take.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{parameter}` cannot be {value}; expected {expected}")]
pub struct Unsuited {
    parameter: Parameter,
    value: String,
    expected: String,
}

impl Parameter {
    /// The parameters that go by `key`: none, or one, or several of which each scene has one at
    /// most.
    pub fn of_key(key: &str) -> Vec<Self> {
        let mut parts = key.split('.');
        let (first, names) = (parts.next().unwrap_or_default(), parts.collect::<Vec<_>>());
        let name = |index: usize| names.get(index).copied().unwrap_or_default();
        let fits =
            |entry: &&Entry| entry.row.key == first && entry.name_kind.count() == names.len();
        let entries = entries().iter().filter(fits);
        entries
            .map(|entry| (entry.of)([name(0), name(1)]))
            .collect()
    }

    /// The two materials that it is about, where it is about two.
    pub fn pair(&self) -> Option<(&str, &str)> {
        let [a, b] = self.names();
        (self.name_kind() == NameKind::Pair).then_some((a, b))
    }

    /// `value` as it takes it: a number that stands for a choice as that choice, a whole number for
    /// a count as that count.
    ///
    /// # Errors
    /// When it takes no such value, with what it takes. Ranges are not looked at.
    pub fn typed(&self, value: Value) -> Result<Value, Unsuited> {
        let kind = &self.row().kind;
        let typed = match (kind, value) {
            (Kind::Number(_), Value::Number(_)) | (Kind::Count, Value::Count(_)) => Some(value),
            (Kind::NumberOr(_, own), Value::Number(number)) => {
                let own = own.iter().find(|own| own.number == number);
                Some(own.map_or(value, Value::Choice))
            }
            (Kind::Count, Value::Number(number)) => whole(number).map(Value::Count),
            (_, Value::Choice(given)) => {
                let mut own = kind.choices().iter();
                own.find(|own| own.key == given.key).map(Value::Choice)
            }
            (Kind::Choice(own), Value::Number(number)) => {
                (own.iter().find(|own| own.number == number)).map(Value::Choice)
            }
            (_, Value::Count(_)) => None,
        };
        typed.ok_or_else(|| Unsuited {
            parameter: self.clone(),
            value: value.to_string(),
            expected: kind.expected(),
        })
    }

    /// It with its materials in the scene's order, so that a pair has one name.
    #[must_use]
    pub fn canonical(&self, materials: &Materials) -> Self {
        let Some((a, b)) = self.pair() else {
            return self.clone();
        };
        match (materials.find(a), materials.find(b)) {
            (Some(first), Some(second)) if first > second => self.about([b, a]),
            _ => self.clone(),
        }
    }
}

/// The count that `number` is.
fn whole(number: f64) -> Option<u64> {
    let is_whole = number >= 0.0 && number.fract() == 0.0 && number <= u64::MAX as f64;
    is_whole.then_some(number as u64)
}

impl fmt::Display for Parameter {
    /// The key in command lists and for `--set`: `friction.glass.drum`, `drum-speed` …
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.row().key)?;
        let names = self.names().into_iter().take(self.name_kind().count());
        names.into_iter().try_for_each(|name| write!(f, ".{name}"))
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
        let known = Self::of_key(&key).into_iter().next();
        known.ok_or_else(|| {
            let live = entries().iter().filter(|entry| entry.row.in_world.is_some());
            let live: Vec<String> = live.map(Entry::key).collect();
            format!(
                "no parameter is called `{key}`; expected one of {} (A, B: materials, S: a species)",
                live.join(", ")
            )
        })
    }
}
