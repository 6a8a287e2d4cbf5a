//! The numbers of a scene that act from the next start on: what the grains are made of, how large everything is, the time
//! step, the seed.
//!
//! In: a scene. Out: a list of [`StartInfo`], and the scene with another value. What can change while a run goes on is a
//! [`super::Parameter`] instead.

use super::DisplayUnit;
use crate::scene::{Scene, SceneContainer, SceneError, SceneGrains, SceneMaterial};
use crate::solver::advise;
use std::ops::RangeInclusive;

/// A number of a scene that acts from the next start on. Materials go by the names the scene gives them.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum StartParameter {
    /// Number of grains of a filling.
    GrainCount,
    /// Radius of all grains of a filling [m].
    GrainRadius,
    /// Size of a lattice cell of Voronoi grains [m].
    Cell,
    /// Rounding radius of Voronoi grains [m].
    Rounding,
    /// Share of the cells that become grains.
    SolidFraction,
    /// Inner radius of the drum [m].
    DrumRadius,
    /// Inner width of the drum [m].
    DrumWidth,
    /// Radius of the column [m].
    ColumnRadius,
    /// Height of the column [m].
    ColumnHeight,
    /// Young's modulus of a material [Pa].
    YoungsModulus(String),
    /// Poisson's ratio of a material.
    PoissonRatio(String),
    /// Density of a material [kg/m³].
    Density(String),
    /// Normal stiffness of linear springs [N/m].
    NormalStiffness,
    /// Time step [s].
    TimeStep,
    /// Seed of everything random.
    Seed,
}

/// A start value and all that a field needs to know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct StartInfo {
    /// Which one.
    pub parameter: StartParameter,
    /// What people call it: `density glass`.
    pub label: String,
    /// The paper's symbol.
    pub symbol: &'static str,
    /// Values it can take, in SI units.
    pub range: RangeInclusive<f64>,
    /// The scene's value, in SI units.
    pub value: f64,
    /// One sentence: what it does.
    pub description: &'static str,
    /// The unit it is shown in.
    pub display: DisplayUnit,
    /// Whether it counts something.
    pub is_whole: bool,
}

/// How far from the scene's value sliders of materials go, as a factor.
const REACH: f64 = 10.0;
/// Largest seed a field offers.
const LARGEST_SEED: f64 = 1e6;
/// Most grains a field offers, as a multiple of the scene's.
const MORE_GRAINS: f64 = 4.0;

const MILLIMETRES: DisplayUnit = DisplayUnit {
    name: "mm",
    factor: 1e3,
};
const MICROSECONDS: DisplayUnit = DisplayUnit {
    name: "µs",
    factor: 1e6,
};
const MEGAPASCALS: DisplayUnit = DisplayUnit {
    name: "MPa",
    factor: 1e-6,
};

const fn unit(name: &'static str) -> DisplayUnit {
    DisplayUnit { name, factor: 1.0 }
}

impl StartParameter {
    /// Its value in `scene`, in SI units; `None` where that has no such number, or it does not act there.
    pub fn read(&self, scene: &Scene) -> Option<f64> {
        let hertzian = scene.law.told(|law| law.uses_elastic_constants());
        let material = |name: &String| scene.material(name).map(|(_, material)| material);
        match self {
            Self::GrainCount => match &scene.grains {
                SceneGrains::Fill { count, .. } => Some(*count as f64),
                _ => None,
            },
            Self::GrainRadius => match &scene.grains {
                SceneGrains::Fill { species, .. } => {
                    let radius = species.first()?.radius;
                    (species.iter().all(|kind| kind.radius == radius)).then_some(radius)
                }
                _ => None,
            },
            Self::Cell | Self::Rounding | Self::SolidFraction => match &scene.grains {
                SceneGrains::Voronoi(cells) if cells.packing.is_none() => Some(match self {
                    Self::Cell => cells.cell,
                    Self::Rounding => cells.rounding,
                    _ => cells.solid_fraction,
                }),
                _ => None,
            },
            Self::DrumRadius | Self::DrumWidth => match scene.container {
                SceneContainer::Drum { radius, .. } if *self == Self::DrumRadius => Some(radius),
                SceneContainer::Drum { width, .. } => Some(width),
                _ => None,
            },
            Self::ColumnRadius | Self::ColumnHeight => match scene.container {
                SceneContainer::Column { radius, .. } if *self == Self::ColumnRadius => {
                    Some(radius)
                }
                SceneContainer::Column { height, .. } => Some(height),
                _ => None,
            },
            Self::YoungsModulus(name) => Some(material(name)?.youngs_modulus).filter(|_| hertzian),
            Self::PoissonRatio(name) => Some(material(name)?.poisson_ratio).filter(|_| hertzian),
            Self::Density(name) => {
                Some(material(name)?.density).filter(|_| scene.has_grains_of(name))
            }
            Self::NormalStiffness => {
                let springs = scene.law.feature_springs()?;
                Some(springs.normal_stiffness)
            }
            Self::TimeStep => Some(advise(scene).time_step),
            Self::Seed => Some(scene.seed as f64),
        }
    }

    /// Gives it the `value`, in SI units.
    ///
    /// # Errors
    /// When the scene does not hold together with it; the scene is then as it was.
    pub fn write(&self, value: f64, scene: &mut Scene) -> Result<(), SceneError> {
        let text = format!("{value:?}");
        let whole = format!("{value:.0}");
        match self {
            Self::GrainCount => scene.set("count", &whole),
            Self::Seed => scene.set("seed", &whole),
            Self::GrainRadius | Self::ColumnRadius => scene.set("radius", &text),
            Self::ColumnHeight => scene.set("height", &text),
            Self::Cell => scene.set("cell", &text),
            Self::Rounding => scene.set("rounding", &text),
            Self::SolidFraction => scene.set("solid-fraction", &text),
            Self::NormalStiffness => scene.set("normal-stiffness", &text),
            Self::TimeStep => scene.set("time-step", &text),
            Self::DrumRadius | Self::DrumWidth => changed(scene, |scene| {
                if let SceneContainer::Drum { radius, width, .. } = &mut scene.container {
                    *(if *self == Self::DrumRadius {
                        radius
                    } else {
                        width
                    }) = value;
                }
            }),
            Self::YoungsModulus(name) => {
                change_material(scene, name, |material| material.youngs_modulus = value)
            }
            Self::PoissonRatio(name) => {
                change_material(scene, name, |material| material.poisson_ratio = value)
            }
            Self::Density(name) => {
                change_material(scene, name, |material| material.density = value)
            }
        }
    }

    /// Whether somebody gave `scene` another value of it than the `original` has; a time step that follows from the rest is
    /// nobody's.
    pub fn differs(&self, scene: &Scene, original: &Scene) -> bool {
        match self {
            Self::TimeStep => scene.time_step != original.time_step,
            _ => self.read(scene) != self.read(original),
        }
    }

    /// Takes it from `original`.
    ///
    /// # Errors
    /// As [`StartParameter::write`].
    pub fn restore(&self, original: &Scene, scene: &mut Scene) -> Result<(), SceneError> {
        match (self, self.read(original)) {
            (Self::TimeStep, _) => changed(scene, |scene| scene.time_step = original.time_step),
            (_, Some(value)) => self.write(value, scene),
            (_, None) => Ok(()),
        }
    }
}

fn change_material(
    scene: &mut Scene,
    name: &str,
    change: impl FnOnce(&mut SceneMaterial),
) -> Result<(), SceneError> {
    changed(scene, |scene| {
        let material = scene
            .materials
            .iter_mut()
            .find(|material| material.name == name);
        if let Some(material) = material {
            change(material);
        }
    })
}

/// Changes `scene` where it then still holds together.
fn changed(scene: &mut Scene, change: impl FnOnce(&mut Scene)) -> Result<(), SceneError> {
    let mut other = scene.clone();
    change(&mut other);
    other.check()?;
    *scene = other;
    Ok(())
}

/// The numbers of `scene` that act from the next start on.
pub fn start_parameters(scene: &Scene) -> Vec<StartInfo> {
    use StartParameter as P;
    let mut all = vec![
        P::GrainCount,
        P::GrainRadius,
        P::Cell,
        P::Rounding,
        P::SolidFraction,
        P::DrumRadius,
        P::DrumWidth,
        P::ColumnRadius,
        P::ColumnHeight,
    ];
    for material in &scene.materials {
        let name = &material.name;
        all.extend([
            P::Density(name.clone()),
            P::YoungsModulus(name.clone()),
            P::PoissonRatio(name.clone()),
        ]);
    }
    all.extend([P::NormalStiffness, P::TimeStep, P::Seed]);
    let info = |parameter: P| {
        let value = parameter.read(scene)?;
        Some(info(parameter, value))
    };
    all.into_iter().filter_map(info).collect()
}

fn info(parameter: StartParameter, value: f64) -> StartInfo {
    let (symbol, display) = parameter.symbol_and_unit();
    StartInfo {
        label: parameter.label(),
        symbol,
        range: parameter.range(value),
        value,
        description: parameter.description(),
        display,
        is_whole: matches!(parameter, StartParameter::GrainCount | StartParameter::Seed),
        parameter,
    }
}

impl StartParameter {
    fn label(&self) -> String {
        let name = match self {
            Self::GrainCount => "number of grains",
            Self::GrainRadius => "grain radius",
            Self::Cell => "cell size",
            Self::Rounding => "rounding radius",
            Self::SolidFraction => "solid fraction",
            Self::DrumRadius => "drum radius",
            Self::DrumWidth => "drum width",
            Self::ColumnRadius => "column radius",
            Self::ColumnHeight => "column height",
            Self::YoungsModulus(material) => return format!("Young's modulus {material}"),
            Self::PoissonRatio(material) => return format!("Poisson's ratio {material}"),
            Self::Density(material) => return format!("density {material}"),
            Self::NormalStiffness => "normal stiffness",
            Self::TimeStep => "time step",
            Self::Seed => "seed",
        };
        name.to_owned()
    }

    fn symbol_and_unit(&self) -> (&'static str, DisplayUnit) {
        match self {
            Self::GrainCount => ("N", unit("")),
            Self::GrainRadius => ("r", MILLIMETRES),
            Self::Cell => ("d", MILLIMETRES),
            Self::Rounding => ("R_s", MILLIMETRES),
            Self::SolidFraction => ("φ_i", unit("")),
            Self::DrumRadius => ("R", MILLIMETRES),
            Self::DrumWidth => ("W", MILLIMETRES),
            Self::ColumnRadius => ("R_i", MILLIMETRES),
            Self::ColumnHeight => ("H_i", MILLIMETRES),
            Self::YoungsModulus(_) => ("E", MEGAPASCALS),
            Self::PoissonRatio(_) => ("ν", unit("")),
            Self::Density(_) => ("ρ", unit("kg/m³")),
            Self::NormalStiffness => ("K_n", unit("N/m")),
            Self::TimeStep => ("Δt", MICROSECONDS),
            Self::Seed => ("", unit("")),
        }
    }

    /// The values that a slider offers where the scene has `value`.
    fn range(&self, value: f64) -> RangeInclusive<f64> {
        let around = |factor: f64| value / factor..=value * factor;
        match self {
            Self::GrainCount => 1.0..=(MORE_GRAINS * value).ceil(),
            Self::GrainRadius | Self::Cell | Self::DrumRadius | Self::ColumnRadius => around(2.0),
            Self::DrumWidth | Self::ColumnHeight => around(4.0),
            Self::Rounding => value / 4.0..=value * 2.0,
            Self::SolidFraction => 0.3..=1.0,
            Self::PoissonRatio(_) => 0.0..=0.49,
            Self::YoungsModulus(_) | Self::Density(_) | Self::NormalStiffness => around(REACH),
            Self::TimeStep => value / REACH..=value * 2.0,
            Self::Seed => 0.0..=LARGEST_SEED.max(value),
        }
    }

    fn description(&self) -> &'static str {
        match self {
            Self::GrainCount => {
                "How many grains the container is filled with. Twice as many take about twice as long to compute."
            }
            Self::GrainRadius => {
                "The bed keeps its volume: half the radius makes eight times as many grains."
            }
            Self::Cell => {
                "Size of a lattice cell, of which each makes one Voronoi grain: half of it makes eight times as many."
            }
            Self::Rounding => "How round the edges and corners of the grains are.",
            Self::SolidFraction => {
                "Share of the cells that become grains; the others are left empty, at random."
            }
            Self::DrumRadius => "Inner radius of the drum; the grains stay as many as they are.",
            Self::DrumWidth => "Inner width of the drum; the grains stay as many as they are.",
            Self::ColumnRadius => "Radius of the column before it falls.",
            Self::ColumnHeight => {
                "Height of the column before it falls: over its radius it is the aspect ratio α."
            }
            Self::YoungsModulus(_) => {
                "How stiff the material is. A softer one allows a longer time step and lets grains overlap more."
            }
            Self::PoissonRatio(_) => "How much the material bulges sideways when it is pressed.",
            Self::Density(_) => "Mass per volume of a grain.",
            Self::NormalStiffness => {
                "Force per overlap of a contact; the tangential one stays in proportion."
            }
            Self::TimeStep => {
                "Simulated time of one step. The scene's own is as long as the stiffest contact allows; a longer one is not \
                 to be trusted."
            }
            Self::Seed => "Another number makes another arrangement of the same grains.",
        }
    }
}
