//! How long a step may be, and why.
//!
//! In: a scene. Out: the step to take, every limit that was considered and the one that binds. A step given by the scene
//! is taken as given, with a warning where it exceeds a limit.

use super::law::{LARGEST_DRAG, natural_log, smallest_viscous_gap};
use crate::physics::{ContactLaw, FeatureRule, Liquid};
use crate::scene::{Scene, SceneGrains, SceneMaterial, TimeStep};
use std::f64::consts::PI;

/// Share of the Rayleigh time that a step may take (physics of Kasper et al. 2021 as run by its authors: at most 0.2).
const RAYLEIGH_SHARE: f64 = 0.2;

/// Steps that an elastic Hertz contact must last at least.
const STEPS_PER_CONTACT: f64 = 15.0;

/// Speed at which grains hit each other where a scene's listed speeds are smaller [m/s].
const IMPACT_SPEED: f64 = 0.2;

/// Steps that half a period of a linear contact must last at least.
const STEPS_PER_HALF_PERIOD: f64 = 20.0;

/// Features of a polyhedron in a packed bed that are in contact at once, and those of two of them: each a spring and a
/// dashpot of its own under [`FeatureRule::Full`].
const FEATURES_OF_GRAIN: f64 = 40.0;
const FEATURES_OF_PAIR: f64 = 9.0;

/// Neighbours that touch a polyhedron at once, at most but for a few.
const NEIGHBOURS_OF_GRAIN: f64 = 12.0;

/// Neighbours of a grain whose drag the step must bear without bounding it.
const DRAGGING_NEIGHBOURS: f64 = 6.0;

/// One limit on the time step.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Limit {
    /// What sets it: `Rayleigh wave`, `Hertz contact` …
    pub name: &'static str,
    /// The step must not exceed it [s].
    pub time_step: f64,
    /// How it was computed, in words and numbers.
    pub reason: String,
}

/// The step to take and the limits it was chosen from.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct TimeStepAdvice {
    /// The step taken [s].
    pub time_step: f64,
    /// Every limit considered, the binding one first.
    pub limits: Vec<Limit>,
    /// What to tell people when a given step exceeds a limit.
    pub warning: Option<String>,
}

/// A kind of grain that the scene holds: what limits the step.
struct Kind<'a> {
    radius: f64,
    material: &'a SceneMaterial,
}

impl Kind<'_> {
    /// [kg]
    fn mass(&self) -> f64 {
        4.0 / 3.0 * PI * self.radius.powi(3) * self.material.density
    }
}

/// The time step for `scene`: the one it gives, or the largest that every limit allows.
pub fn advise(scene: &Scene) -> TimeStepAdvice {
    let kinds = kinds(scene);
    let speed = impact_speed(scene);
    let mut limits: Vec<Limit> = match scene.law {
        ContactLaw::HertzMindlin => kinds
            .iter()
            .flat_map(|kind| [rayleigh_limit(kind), hertz_limit(kind, speed)])
            .collect(),
        ContactLaw::Hooke {
            normal_stiffness,
            tangential_stiffness,
            features,
        } => {
            let stiffness = normal_stiffness.max(tangential_stiffness);
            let touching = scene.is_polyhedral().then_some(features);
            kinds
                .iter()
                .flat_map(|kind| {
                    let dashpots = touching.map(|rule| dashpot_limit(kind, normal_stiffness, rule));
                    std::iter::once(hooke_limit(kind, stiffness, touching)).chain(dashpots)
                })
                .collect()
        }
    };
    if let Some(liquid) = scene
        .liquid
        .as_ref()
        .filter(|liquid| liquid.viscosity > 0.0)
    {
        limits.extend(kinds.iter().map(|kind| lubrication_limit(kind, liquid)));
    }
    limits.sort_by(|a, b| a.time_step.total_cmp(&b.time_step));
    limits.dedup_by(|later, earlier| later.name == earlier.name);
    let largest = limits.first().map_or(1e-5, |limit| limit.time_step);
    match scene.time_step {
        TimeStep::Automatic => TimeStepAdvice {
            time_step: largest,
            limits,
            warning: None,
        },
        TimeStep::Given(given) => TimeStepAdvice {
            time_step: given,
            warning: warning(given, &limits),
            limits,
        },
    }
}

fn warning(given: f64, limits: &[Limit]) -> Option<String> {
    let binding = limits.first().filter(|limit| given > limit.time_step)?;
    Some(format!(
        "the given time step of {given:.3e} s exceeds the limit of {:.3e} s set by the {}: {}. \
         Give a smaller one, or `time_step: Automatic`",
        binding.time_step, binding.name, binding.reason
    ))
}

fn kinds(scene: &Scene) -> Vec<Kind<'_>> {
    let material = |name: &str| {
        scene
            .materials
            .iter()
            .find(|material| material.name == name)
    };
    let mut kinds: Vec<Kind> = match &scene.grains {
        SceneGrains::Fill { species, .. } => species
            .iter()
            .filter_map(|species| {
                Some(Kind {
                    radius: species.radius,
                    material: material(&species.material)?,
                })
            })
            .collect(),
        SceneGrains::Voronoi(cells) => cells
            .species
            .iter()
            .filter_map(|species| {
                Some(Kind {
                    radius: cells.smallest_radius(&scene.container),
                    material: material(&species.material)?,
                })
            })
            .collect(),
        SceneGrains::List(grains) => grains
            .iter()
            .filter_map(|grain| {
                Some(Kind {
                    radius: grain.equal_volume_radius(),
                    material: material(&grain.material)?,
                })
            })
            .collect(),
    };
    // A limit grows with the radius and depends on nothing else that differs within a material.
    kinds.sort_by(|a, b| {
        a.material
            .name
            .cmp(&b.material.name)
            .then(a.radius.total_cmp(&b.radius))
    });
    kinds.dedup_by(|later, earlier| later.material.name == earlier.material.name);
    kinds
}

fn impact_speed(scene: &Scene) -> f64 {
    match &scene.grains {
        SceneGrains::Fill { .. } | SceneGrains::Voronoi(_) => IMPACT_SPEED,
        SceneGrains::List(grains) => grains
            .iter()
            .map(|grain| 2.0 * grain.velocity.length())
            .fold(IMPACT_SPEED, f64::max),
    }
}

/// `T_R = π r √(ρ/G) / (0.1631 ν + 0.8766)`: a Rayleigh wave crosses the grain's half circumference.
fn rayleigh_limit(kind: &Kind) -> Limit {
    let material = kind.material;
    let shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
    let time = PI * kind.radius * (material.density / shear).sqrt()
        / (0.1631 * material.poisson_ratio + 0.8766);
    Limit {
        name: "Rayleigh wave",
        time_step: RAYLEIGH_SHARE * time,
        reason: format!(
            "{RAYLEIGH_SHARE} of the {time:.3e} s that a surface wave takes round a grain of {} with r = {:.3e} m",
            material.name, kind.radius
        ),
    }
}

/// `T_H = 2.87 (m*² / (r* E*² v))^(1/5)`: an elastic Hertz impact of two equal grains.
fn hertz_limit(kind: &Kind, speed: f64) -> Limit {
    let material = kind.material;
    let mass = 4.0 / 3.0 * PI * kind.radius.powi(3) * material.density / 2.0;
    let modulus = material.youngs_modulus / (2.0 * (1.0 - material.poisson_ratio.powi(2)));
    let fifth_power = mass * mass / (0.5 * kind.radius * modulus * modulus * speed);
    // Rounded, so that a platform's own last bit of the root does not show in a run.
    let time = f64::from((2.87 * fifth_power.powf(0.2)) as f32);
    Limit {
        name: "Hertz contact",
        time_step: time / STEPS_PER_CONTACT,
        reason: format!(
            "1/{STEPS_PER_CONTACT} of the {time:.3e} s that an impact of two grains of {} at {speed:.3} m/s lasts",
            material.name
        ),
    }
}

/// Half a period of two equal grains on a spring, `π √(m*/K)`; on several, where polyhedra touch in several places.
fn hooke_limit(kind: &Kind, stiffness: f64, touching: Option<FeatureRule>) -> Limit {
    let springs = match touching {
        Some(FeatureRule::Full) => FEATURES_OF_PAIR,
        Some(FeatureRule::Shared) | None => 1.0,
    };
    let time = PI * (0.5 * kind.mass() / (springs * stiffness)).sqrt();
    Limit {
        name: "linear contact",
        time_step: time / STEPS_PER_HALF_PERIOD,
        reason: format!(
            "1/{STEPS_PER_HALF_PERIOD} of the {time:.3e} s that two grains of {} touch on {springs} springs of {stiffness:.3e} N/m",
            kind.material.name
        ),
    }
}

/// `1.6 m/(M c)` with the dashpot `c = 2 √(ln² e K_n m/(π² + ln² e))` of a grain against a heavy one: up to that step the
/// dashpots of `M` contacts take no more than all of its speed.
fn dashpot_limit(kind: &Kind, normal_stiffness: f64, rule: FeatureRule) -> Limit {
    let contacts = match rule {
        FeatureRule::Full => FEATURES_OF_GRAIN,
        FeatureRule::Shared => NEIGHBOURS_OF_GRAIN,
    };
    let log_squared = natural_log(kind.material.restitution).powi(2);
    let damped = log_squared / (PI * PI + log_squared);
    let dashpot = 2.0 * (damped * normal_stiffness * kind.mass()).sqrt();
    Limit {
        name: "dashpots of a polyhedron",
        time_step: LARGEST_DRAG * kind.mass() / (contacts * dashpot),
        reason: format!(
            "{LARGEST_DRAG}/{contacts} of the {:.3e} s in which one dashpot stops the smallest grain of {}, which {contacts} of \
             them act on at once",
            kind.mass() / dashpot,
            kind.material.name
        ),
    }
}

/// `1.6 m/(2 · 6 c)` with the drag `c = 6π η r*²/D` of two equal grains at the smallest gap: up to that step it acts
/// unbounded on grains with six neighbours each.
fn lubrication_limit(kind: &Kind, liquid: &Liquid) -> Limit {
    let mass = kind.mass();
    let effective = 0.5 * kind.radius;
    let gap = smallest_viscous_gap(liquid.law.viscous_gap, effective, 2.0 * kind.radius);
    let drag = 6.0 * PI * liquid.viscosity * effective * effective / gap;
    Limit {
        name: "lubrication",
        time_step: LARGEST_DRAG * mass / (2.0 * DRAGGING_NEIGHBOURS * drag),
        reason: format!(
            "{LARGEST_DRAG}/12 of the {:.3e} s in which the liquid film stops a grain of {} with r = {:.3e} m that closes \
             the smallest gap",
            mass / drag,
            kind.material.name,
            kind.radius
        ),
    }
}
