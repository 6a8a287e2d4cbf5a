//! Which numbers of a scene can change while it runs, and how each is read from a world and written to it.
//!
//! In: a scene. Out: a list of [`ParameterInfo`], one per live parameter. Writing a value keeps the energy ledger
//! honest: what a change of mass or stiffness puts in is booked as a command's work.

use super::{Parameter, relabel};
use crate::measure::elastic_energy;
use crate::physics::{BridgeLaw, Liquid, MaterialId, Materials, PairProperties};
use crate::scene::{Scene, SceneContainer};
use crate::world::World;
use glam::DVec3;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// How a value is shown to people: `shown = factor × SI`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Name of the unit, empty for a pure number.
    pub name: &'static str,
    /// Shown value per SI value.
    pub factor: f64,
}

/// A live parameter and all that a slider needs to know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Which one.
    pub parameter: Parameter,
    /// What people call it: `friction glass – drum`.
    pub label: String,
    /// The paper's symbol.
    pub symbol: &'static str,
    /// SI unit, `1` for a pure number.
    pub unit: &'static str,
    /// Values it can take, in SI units.
    pub range: RangeInclusive<f64>,
    /// The scene's value, in SI units.
    pub default: f64,
    /// One sentence: what it does.
    pub description: &'static str,
    /// The unit it is shown in.
    pub display: DisplayUnit,
}

const PURE: DisplayUnit = DisplayUnit {
    name: "",
    factor: 1.0,
};
const RPM: DisplayUnit = DisplayUnit {
    name: "rpm",
    factor: 30.0 / std::f64::consts::PI,
};
const PERCENT: DisplayUnit = DisplayUnit {
    name: "%",
    factor: 100.0,
};
const MILLIPASCAL_SECONDS: DisplayUnit = DisplayUnit {
    name: "mPa s",
    factor: 1e3,
};
const MILLINEWTONS_PER_METRE: DisplayUnit = DisplayUnit {
    name: "mN/m",
    factor: 1e3,
};
const DEGREES: DisplayUnit = DisplayUnit {
    name: "°",
    factor: 180.0 / std::f64::consts::PI,
};
const MILLILITRES: DisplayUnit = DisplayUnit {
    name: "ml",
    factor: 1e6,
};
const MICROSECONDS: DisplayUnit = DisplayUnit {
    name: "µs",
    factor: 1e6,
};
const METRES_PER_SECOND_SQUARED: DisplayUnit = DisplayUnit {
    name: "m/s²",
    factor: 1.0,
};

impl Parameter {
    /// Its present value in SI units; `None` where `world` has no such parameter.
    pub fn read(&self, world: &World) -> Option<f64> {
        let pair = |a: &String, b: &String| {
            let materials = &world.materials;
            Some(materials.pair(materials.find(a)?, materials.find(b)?))
        };
        match self {
            Self::Friction(a, b) => Some(pair(a, b)?.friction),
            Self::WetFriction(a, b) => Some(pair(a, b)?.wet_friction),
            Self::Restitution(a, b) => Some(pair(a, b)?.restitution),
            Self::RollingFriction(a, b) => Some(pair(a, b)?.rolling_friction),
            Self::DrumSpeed => Some(world.container.drum_speed()),
            Self::Gravity => Some(world.gravity.length()),
            Self::Share(species) => relabel::share(world, species),
            Self::Viscosity => Some(world.liquid?.viscosity),
            Self::SurfaceTension => Some(world.liquid?.surface_tension),
            Self::ContactAngle => Some(world.liquid?.contact_angle),
            Self::LiquidVolume => Some(world.liquid?.volume),
            Self::BridgeLaw => match world.liquid?.law {
                BridgeLaw::AS_PRINTED => Some(0.0),
                BridgeLaw::AS_CODED => Some(1.0),
                _ => None,
            },
            Self::TimeStep => Some(world.clock.time_step),
        }
    }

    /// Its SI unit, `1` for a pure number.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::DrumSpeed => "rad/s",
            Self::Gravity => "m/s²",
            Self::Viscosity => "Pa s",
            Self::SurfaceTension => "N/m",
            Self::ContactAngle => "rad",
            Self::LiquidVolume => "m³",
            Self::TimeStep => "s",
            _ => "1",
        }
    }

    /// The unit it is shown in.
    pub fn display(&self) -> DisplayUnit {
        match self {
            Self::DrumSpeed => RPM,
            Self::Gravity => METRES_PER_SECOND_SQUARED,
            Self::Share(_) => PERCENT,
            Self::Viscosity => MILLIPASCAL_SECONDS,
            Self::SurfaceTension => MILLINEWTONS_PER_METRE,
            Self::ContactAngle => DEGREES,
            Self::LiquidVolume => MILLILITRES,
            Self::TimeStep => MICROSECONDS,
            Self::Friction(..)
            | Self::WetFriction(..)
            | Self::Restitution(..)
            | Self::RollingFriction(..)
            | Self::BridgeLaw => PURE,
        }
    }

    /// Where it stands in the equations of the papers, in the contact law of `scene`.
    pub fn equation(&self, scene: &Scene) -> &'static str {
        match self {
            Self::Friction(..) | Self::WetFriction(..) => scene.law.words().friction,
            Self::Restitution(..) => scene.law.words().restitution,
            Self::RollingFriction(..) => "q = −μ_R k_n δ r* ω/|ω|, Eq. 10 of Kasper et al. 2021",
            Self::DrumSpeed => "v = Ω × r on rim and end plates",
            Self::Gravity => "F = m g",
            Self::Share(_) => {
                "P_a = N_a / N; μ_p = Σ P_a P_b μ_ab, Eqs. 4.1 and 4.2 of Man et al. 2023"
            }
            Self::Viscosity => {
                "F = 6π η r*² v_n/D across the gap D, Eqs. 15–17 of Kasper et al. 2021"
            }
            Self::SurfaceTension => {
                "F = π γ √(r_i r_j) (c + exp(a D/r + b)), Eqs. 13 and 14 of Kasper et al. 2021"
            }
            Self::ContactAngle => {
                "α in b of Eq. 14 and in the rupture gap, Eqs. 11–14 of Kasper et al. 2021"
            }
            Self::LiquidVolume => {
                "V = 0.05 (Vf_i + Vf_j) of both films, Eq. 11 of Kasper et al. 2021"
            }
            Self::BridgeLaw => "Eqs. 11–17 of Kasper et al. 2021",
            Self::TimeStep => "x(t + Δt) from x(t): velocity Verlet",
        }
    }

    /// The value that `text` states, a number alone (SI) or with its unit, in SI units: `0.1`, `0.5 rpm`.
    pub fn parse_value(&self, text: &str) -> Option<f64> {
        let (text, display) = (text.trim(), self.display());
        let bare = |unit: &str| text.strip_suffix(unit).map(str::trim_end);
        let number = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
        let si = || number(bare(self.unit()).unwrap_or(text));
        let shown = || Some(number(bare(display.name)?)? / display.factor);
        number(text).or_else(shown).or_else(si)
    }
}

/// Most viscous liquid a slider offers [Pa s].
const MOST_VISCOUS: f64 = 1.5;
/// Strongest surface tension a slider offers [N/m].
const STRONGEST_TENSION: f64 = 0.15;
/// Largest contact angle a slider offers [rad], 80°.
const LARGEST_CONTACT_ANGLE: f64 = 80.0 / DEGREES.factor;
/// Fastest drum a slider offers [rad/s], 10 rpm.
const FASTEST_DRUM: f64 = 10.0 / RPM.factor;
/// Strongest gravity a slider offers [m/s²].
const STRONGEST_GRAVITY: f64 = 20.0;

/// Shortest and longest step that a run can be given [s].
const STEPS: RangeInclusive<f64> = 1e-12..=1.0;

/// The time step of a run whose first one is `time_step` [s]. It is none of the
/// [`live_parameters`], which are physics; a run takes commands about it all the same.
pub fn time_step(time_step: f64) -> ParameterInfo {
    ParameterInfo {
        parameter: Parameter::TimeStep,
        label: "time step".into(),
        symbol: "Δt",
        unit: Parameter::TimeStep.unit(),
        range: STEPS,
        default: time_step,
        description: "Simulated time of one step. The stiffest contact and the thinnest film limit it.",
        display: MICROSECONDS,
    }
}

/// The live parameters of `scene`, whose world at time zero is `world`.
pub fn live_parameters(scene: &Scene, world: &World) -> Vec<ParameterInfo> {
    let mut list = Vec::new();
    if let SceneContainer::Drum { speed, .. } = scene.container {
        list.push(drum_speed(speed));
    }
    list.push(gravity(scene.gravity.length()));
    list.extend(meeting_pairs(world).into_iter().flat_map(|(a, b)| {
        let names = [a, b].map(|id| world.materials.get(id).name.clone());
        let rolls = world.polyhedra.is_none();
        pair_parameters(
            names,
            world.materials.pair(a, b),
            scene.liquid.is_some(),
            rolls,
        )
    }));
    list.extend(shares(scene, world));
    list.extend(scene.liquid.iter().flat_map(liquid_parameters));
    list
}

/// Gives `parameter` of `world`, a world of `scene`, the `value` in SI units. A parameter that the world does not have is
/// left alone.
pub fn write(parameter: &Parameter, value: f64, scene: &Scene, world: &mut World) {
    match parameter {
        Parameter::Friction(a, b) => change_pair(world, a, b, |pair| pair.friction = value),
        Parameter::WetFriction(a, b) => change_pair(world, a, b, |pair| pair.wet_friction = value),
        Parameter::Restitution(a, b) => change_pair(world, a, b, |pair| pair.restitution = value),
        Parameter::RollingFriction(a, b) => {
            change_pair(world, a, b, |pair| pair.rolling_friction = value);
        }
        Parameter::DrumSpeed => world.container.set_drum_speed(value),
        Parameter::Gravity => world.set_gravity(value * down(scene)),
        Parameter::Share(species) => booked(world, |world| {
            relabel::set_share(scene, world, species, value);
        }),
        Parameter::LiquidVolume => world.set_liquid_volume(value),
        Parameter::Viscosity => change_liquid(world, |liquid| liquid.viscosity = value),
        Parameter::SurfaceTension => change_liquid(world, |liquid| liquid.surface_tension = value),
        Parameter::ContactAngle => change_liquid(world, |liquid| liquid.contact_angle = value),
        Parameter::BridgeLaw => change_liquid(world, |liquid| {
            liquid.law = if value < 0.5 {
                BridgeLaw::AS_PRINTED
            } else {
                BridgeLaw::AS_CODED
            };
        }),
        Parameter::TimeStep => world.clock.set_time_step(value),
    }
}

fn change_liquid(world: &mut World, change: impl FnOnce(&mut Liquid)) {
    if let Some(liquid) = &mut world.liquid {
        change(liquid);
    }
}

/// Direction of gravity, downwards where the scene has none.
fn down(scene: &Scene) -> DVec3 {
    scene.gravity.try_normalize().unwrap_or(DVec3::NEG_Y)
}

fn change_pair(world: &mut World, a: &str, b: &str, change: impl FnOnce(&mut PairProperties)) {
    let materials = &mut world.materials;
    if let (Some(a), Some(b)) = (materials.find(a), materials.find(b)) {
        change(materials.pair_mut(a, b));
    }
}

/// Makes a change of masses or stiffnesses and books the energy it puts in as the command's work.
fn booked(world: &mut World, change: impl FnOnce(&mut World)) {
    let stored = |world: &World| world.kinetic_energy() + elastic_energy(world);
    let (energy, potential) = (stored(world), world.potential_energy());
    change(world);
    world.ledger.command_work += stored(world) - energy;
    let changed = world.potential_energy();
    world.ledger.close_gravity_segment(potential, changed);
}

fn drum_speed(speed: f64) -> ParameterInfo {
    let fastest = FASTEST_DRUM.max(2.0 * speed.abs());
    ParameterInfo {
        parameter: Parameter::DrumSpeed,
        label: "drum speed".into(),
        symbol: "Ω",
        unit: "rad/s",
        range: -fastest..=fastest,
        default: speed,
        description: "How fast the drum turns; positive is anticlockwise as you see it.",
        display: RPM,
    }
}

fn gravity(magnitude: f64) -> ParameterInfo {
    ParameterInfo {
        parameter: Parameter::Gravity,
        label: "gravity".into(),
        symbol: "g",
        unit: "m/s²",
        range: 0.0..=STRONGEST_GRAVITY.max(2.0 * magnitude),
        default: magnitude,
        description: "Strength of gravity; its direction stays.",
        display: METRES_PER_SECOND_SQUARED,
    }
}

/// What can change about how two materials meet: wet friction only where the scene has a liquid, rolling friction only
/// where grains are spheres.
fn pair_parameters(
    names: [String; 2],
    pair: PairProperties,
    wet: bool,
    rolls: bool,
) -> Vec<ParameterInfo> {
    let [a, b] = names;
    let info = |parameter, name, symbol, range, default, description| ParameterInfo {
        parameter,
        label: format!("{name} {a} – {b}"),
        symbol,
        unit: "1",
        range,
        default,
        description,
        display: PURE,
    };
    let wet_friction = wet.then(|| {
        info(
            Parameter::WetFriction(a.clone(), b.clone()),
            "wet friction",
            "μ_w",
            0.0..=pair.wet_friction.max(1.0),
            pair.wet_friction,
            "Friction where there is liquid: sliding starts when the tangential force reaches this share of the contact's \
             normal force.",
        )
    });
    let friction = info(
        Parameter::Friction(a.clone(), b.clone()),
        if wet { "dry friction" } else { "friction" },
        "μ",
        0.0..=pair.friction.max(1.0),
        pair.friction,
        "Sliding starts when the tangential force reaches this share of the normal force.",
    );
    let rolling_friction = rolls.then(|| {
        info(
            Parameter::RollingFriction(a.clone(), b.clone()),
            "rolling friction",
            "μ_R",
            0.0..=pair.rolling_friction.max(0.2),
            pair.rolling_friction,
            "Rolling is opposed by a torque of this share of the normal force times the effective radius.",
        )
    });
    let restitution = info(
        Parameter::Restitution(a.clone(), b.clone()),
        "restitution",
        "e",
        pair.restitution.min(0.05)..=1.0,
        pair.restitution,
        "Rebound speed over impact speed of a head-on impact.",
    );
    wet_friction
        .into_iter()
        .chain([friction])
        .chain(rolling_friction)
        .chain([restitution])
        .collect()
}

/// What can change about the liquid.
fn liquid_parameters(liquid: &Liquid) -> Vec<ParameterInfo> {
    let info =
        |parameter: Parameter, label: &str, symbol, range, default, description| ParameterInfo {
            label: label.into(),
            symbol,
            unit: parameter.unit(),
            range,
            default,
            description,
            display: parameter.display(),
            parameter,
        };
    let mut list = vec![
        info(
            Parameter::Viscosity,
            "viscosity",
            "η",
            0.0..=MOST_VISCOUS.max(2.0 * liquid.viscosity),
            liquid.viscosity,
            "How strongly bridges resist motion: water 1 mPa s, glycerol 1410 mPa s.",
        ),
        info(
            Parameter::SurfaceTension,
            "surface tension",
            "γ",
            0.0..=STRONGEST_TENSION.max(2.0 * liquid.surface_tension),
            liquid.surface_tension,
            "How strongly bridges pull grains together: water 72.8 mN/m.",
        ),
        info(
            Parameter::ContactAngle,
            "contact angle",
            "α",
            0.0..=LARGEST_CONTACT_ANGLE.max(liquid.contact_angle),
            liquid.contact_angle,
            "Angle at which the liquid meets the grains; the smaller, the better it wets them.",
        ),
        info(
            Parameter::LiquidVolume,
            "liquid",
            "V_l",
            0.0..=5.0 * liquid.volume.max(1e-9),
            liquid.volume,
            "Volume of all the liquid; none makes the grains dry.",
        ),
    ];
    if matches!(liquid.law, BridgeLaw::AS_PRINTED | BridgeLaw::AS_CODED) {
        let coded = liquid.law == BridgeLaw::AS_CODED;
        list.push(info(
            Parameter::BridgeLaw,
            "bridge law",
            "",
            0.0..=1.0,
            f64::from(u8::from(coded)),
            "0: the paper's equations as printed. 1: what the public LIGGGHTS 3.8 computes, with far weaker viscous forces.",
        ));
    }
    list
}

/// The pairs of materials that can touch: grain with grain and grain with wall, each once, in the scene's order.
fn meeting_pairs(world: &World) -> BTreeSet<(MaterialId, MaterialId)> {
    let grains: BTreeSet<MaterialId> = world.species.iter().map(|s| s.material).collect();
    let walls = world.container.walls.iter().map(|wall| wall.material);
    let partners: BTreeSet<MaterialId> = grains.iter().copied().chain(walls).collect();
    grains
        .iter()
        .flat_map(|&a| partners.iter().map(move |&b| (a.min(b), a.max(b))))
        .collect()
}

/// Index of the first and second material that a pair parameter names, for comparing pairs whatever their order.
fn ids(materials: &Materials, a: &str, b: &str) -> Option<(MaterialId, MaterialId)> {
    let (a, b) = (materials.find(a)?, materials.find(b)?);
    Some((a.min(b), a.max(b)))
}

/// `parameter` with its materials in the scene's order, so that a pair has one name.
pub fn canonical(parameter: &Parameter, materials: &Materials) -> Parameter {
    let ordered = |a: &str, b: &str| {
        ids(materials, a, b).map_or_else(
            || (a.to_owned(), b.to_owned()),
            |(a, b)| (materials.get(a).name.clone(), materials.get(b).name.clone()),
        )
    };
    match parameter {
        Parameter::Friction(a, b) => {
            let (a, b) = ordered(a, b);
            Parameter::Friction(a, b)
        }
        Parameter::WetFriction(a, b) => {
            let (a, b) = ordered(a, b);
            Parameter::WetFriction(a, b)
        }
        Parameter::Restitution(a, b) => {
            let (a, b) = ordered(a, b);
            Parameter::Restitution(a, b)
        }
        Parameter::RollingFriction(a, b) => {
            let (a, b) = ordered(a, b);
            Parameter::RollingFriction(a, b)
        }
        other => other.clone(),
    }
}

/// A share for each species whose grains can change places with those of another; the default is what whole grains made of
/// the scene's.
fn shares(scene: &Scene, world: &World) -> Vec<ParameterInfo> {
    let species = scene.species();
    let info = |(index, (name, _)): (usize, &(&str, &str))| {
        let members = scene.interchangeable_species(index);
        let most = members.iter().map(|&member| scene.share(member)).sum();
        let default = relabel::share(world, name).unwrap_or(scene.share(index));
        (members.len() > 1).then(|| share(name, default, most))
    };
    species.iter().enumerate().filter_map(info).collect()
}

fn share(species: &str, default: f64, most: f64) -> ParameterInfo {
    ParameterInfo {
        parameter: Parameter::Share(species.to_owned()),
        label: format!("share {species}"),
        symbol: "P",
        unit: "1",
        range: 0.0..=most,
        default,
        description: "Share of the grains by number; the next species of the same size gives or takes the difference.",
        display: PERCENT,
    }
}
