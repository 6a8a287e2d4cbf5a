//! How long a step may be, and why.
//!
//! In: a scene that has no world yet, or the state of its run. Out: every limit on the step with its
//! reason, the smallest first. Before a run [`advise`] chooses the step, or takes the one that the
//! scene gives; while it goes on [`Extremes::advise`] holds the present step against the limits of
//! the present state, so that no change of a material, a liquid or a law goes unnoticed.
//!
//! Not here: changing the step. A command does that (the parameter `time-step`), so that it is
//! recorded.

use crate::physics::law::{LARGEST_DRAG, natural_log, smallest_viscous_gap};
use crate::physics::{ContactLaw, FeatureRule, Liquid, Material, MaterialId, Materials};
use crate::scene::{Scene, SceneGrains, TimeStep};
use crate::world::{self, World};
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

/// The step and the limits that it is held against.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct TimeStepAdvice {
    /// The step taken [s].
    pub time_step: f64,
    /// Every limit considered, the binding one first.
    pub limits: Vec<Limit>,
    /// What to tell people when the step exceeds a limit.
    pub warning: Option<String>,
}

/// The step of a scene whose grains nothing limits [s].
const UNLIMITED: f64 = 1e-5;

impl TimeStepAdvice {
    /// `time_step` [s] against `limits`, the binding one first.
    fn of(time_step: f64, limits: Vec<Limit>) -> Self {
        Self {
            time_step,
            warning: warning(time_step, &limits),
            limits,
        }
    }

    /// The largest step that every limit allows [s].
    pub fn largest(&self) -> f64 {
        self.limits
            .first()
            .map_or(UNLIMITED, |limit| limit.time_step)
    }

    /// By which share the step exceeds its limit, 0.29 for 29 %; none where it does not.
    pub fn excess(&self) -> Option<f64> {
        excess(self.time_step, self.limits.first()?)
    }
}

/// What of a scene limits the step and changes in no run: how small its grains are, and how fast they
/// may hit each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// The smallest radius of the grains of each material [m], in order of the materials' names.
    radii: Vec<(MaterialId, f64)>,
    /// Speed of impacts [m/s].
    impact_speed: f64,
}

/// The smallest grain of one material: what limits the step.
struct SmallestGrain<'a> {
    material: &'a Material,
    /// [m]
    radius: f64,
    /// Restitution of its most strongly damped contacts.
    restitution: f64,
}

impl SmallestGrain<'_> {
    /// [kg]
    fn mass(&self) -> f64 {
        4.0 / 3.0 * PI * self.radius.powi(3) * self.material.density
    }
}

/// What every limit depends on beside the grains.
struct Conditions<'a> {
    law: ContactLaw,
    is_polyhedral: bool,
    /// The liquid whose bridges act.
    liquid: Option<&'a Liquid>,
    impact_speed: f64,
}

/// The time step for `scene` before there is a world of it: the one it gives, or the largest that every
/// limit allows.
pub fn advise(scene: &Scene) -> TimeStepAdvice {
    let materials = world::materials(scene);
    let extremes = Extremes::of(scene);
    let grains = extremes.grains(&materials, |material| {
        scene.materials[usize::from(material.0)].restitution
    });
    let limits = limits(
        &grains,
        &Conditions {
            law: scene.law,
            is_polyhedral: scene.is_polyhedral(),
            liquid: scene.liquid.as_ref(),
            impact_speed: extremes.impact_speed,
        },
    );
    match scene.time_step {
        TimeStep::Given(given) => TimeStepAdvice::of(given, limits),
        TimeStep::Automatic | TimeStep::Following => {
            let largest = limits.first().map_or(UNLIMITED, |limit| limit.time_step);
            TimeStepAdvice::of(largest, limits)
        }
    }
}

impl Extremes {
    /// Those of `scene`.
    pub fn of(scene: &Scene) -> Self {
        Self {
            radii: smallest_radii(scene),
            impact_speed: impact_speed(scene),
        }
    }

    /// The present step of `world`, a world of this scene, against the limits of its present state:
    /// materials and their pairs, law and liquid.
    ///
    /// At time zero and unchanged the limits are those of [`advise`], but where a pair that the scene
    /// states restitutes less than each of its two materials among its own kind: only here is it
    /// looked at.
    pub fn advise(&self, world: &World) -> TimeStepAdvice {
        let materials = &world.materials;
        let grains = self.grains(materials, |material| {
            lowest_restitution(materials, material)
        });
        let limits = limits(
            &grains,
            &Conditions {
                law: world.law,
                is_polyhedral: world.polyhedra.is_some(),
                liquid: world.wetting(),
                impact_speed: self.impact_speed,
            },
        );
        TimeStepAdvice::of(world.clock.time_step, limits)
    }

    fn grains<'a>(
        &self,
        materials: &'a Materials,
        restitution: impl Fn(MaterialId) -> f64,
    ) -> Vec<SmallestGrain<'a>> {
        let grain = |&(material, radius): &(MaterialId, f64)| SmallestGrain {
            material: materials.get(material),
            radius,
            restitution: restitution(material),
        };
        self.radii.iter().map(grain).collect()
    }
}

/// Restitution of the most strongly damped contacts of bodies of this material. A mean of two materials
/// is that of one of them among its own kind, so that only a pair below both counts.
fn lowest_restitution(materials: &Materials, material: MaterialId) -> f64 {
    let between = |a, b| materials.pair(a, b).restitution;
    let own = between(material, material);
    (0..materials.list().len() as u16)
        .map(MaterialId)
        .map(|other| (between(material, other), between(other, other)))
        .filter(|(pair, other)| *pair < own.min(*other))
        .fold(own, |lowest, (pair, _)| lowest.min(pair))
}

/// Every limit of the `grains`, the binding one first.
fn limits(grains: &[SmallestGrain], conditions: &Conditions) -> Vec<Limit> {
    let mut limits: Vec<Limit> = grains
        .iter()
        .flat_map(|grain| law_limits(grain, conditions))
        .collect();
    if let Some(liquid) = conditions.liquid.filter(|liquid| liquid.viscosity > 0.0) {
        limits.extend(grains.iter().map(|grain| lubrication_limit(grain, liquid)));
    }
    limits.sort_by(|a, b| a.time_step.total_cmp(&b.time_step));
    limits.dedup_by(|later, earlier| later.name == earlier.name);
    limits
}

/// The limits that the contact law sets.
fn law_limits(grain: &SmallestGrain, conditions: &Conditions) -> Vec<Limit> {
    match conditions.law {
        ContactLaw::HertzMindlin => vec![
            rayleigh_limit(grain),
            hertz_limit(grain, conditions.impact_speed),
        ],
        ContactLaw::Hooke {
            normal_stiffness,
            tangential_stiffness,
            features,
        } => {
            let stiffness = normal_stiffness.max(tangential_stiffness);
            let touching = conditions.is_polyhedral.then_some(features);
            let dashpots = touching.map(|rule| dashpot_limit(grain, normal_stiffness, rule));
            std::iter::once(hooke_limit(grain, stiffness, touching))
                .chain(dashpots)
                .collect()
        }
    }
}

fn excess(time_step: f64, limit: &Limit) -> Option<f64> {
    (time_step > limit.time_step).then(|| time_step / limit.time_step - 1.0)
}

fn warning(time_step: f64, limits: &[Limit]) -> Option<String> {
    let binding = limits.first()?;
    let excess = excess(time_step, binding)?;
    Some(format!(
        "the time step of {time_step:.3e} s exceeds the limit of {:.3e} s set by the {} by {:.0} %: {}. \
         Give a smaller one: `time_step: Automatic` in the scene, `time-step` while it runs",
        binding.time_step,
        binding.name,
        100.0 * excess,
        binding.reason
    ))
}

/// The smallest radius of the grains of each material [m], in order of the materials' names.
fn smallest_radii(scene: &Scene) -> Vec<(MaterialId, f64)> {
    let id = |name: &str| {
        scene
            .material(name)
            .map(|(index, _)| MaterialId(index as u16))
    };
    let mut radii: Vec<(MaterialId, f64)> = match &scene.grains {
        SceneGrains::Fill { species, .. } => species
            .iter()
            .filter_map(|species| Some((id(&species.material)?, species.radius)))
            .collect(),
        SceneGrains::Voronoi(cells) => {
            let radius = cells.smallest_radius(&scene.container);
            cells
                .species
                .iter()
                .filter_map(|species| Some((id(&species.material)?, radius)))
                .collect()
        }
        SceneGrains::List(grains) => grains
            .iter()
            .filter_map(|grain| Some((id(&grain.material)?, grain.equal_volume_radius())))
            .collect(),
    };
    let name = |id: MaterialId| &scene.materials[usize::from(id.0)].name;
    // A limit grows with the radius and depends on nothing else that differs within a material.
    radii.sort_by(|a, b| name(a.0).cmp(name(b.0)).then(a.1.total_cmp(&b.1)));
    radii.dedup_by_key(|(material, _)| *material);
    radii
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
fn rayleigh_limit(grain: &SmallestGrain) -> Limit {
    let material = grain.material;
    let time = PI * grain.radius * (material.density / material.shear_modulus()).sqrt()
        / (0.1631 * material.poisson_ratio + 0.8766);
    Limit {
        name: "Rayleigh wave",
        time_step: RAYLEIGH_SHARE * time,
        reason: format!(
            "{RAYLEIGH_SHARE} of the {time:.3e} s that a surface wave takes round a grain of {} with r = {:.3e} m",
            material.name, grain.radius
        ),
    }
}

/// `T_H = 2.87 (m*² / (r* E*² v))^(1/5)`: an elastic Hertz impact of two equal grains.
fn hertz_limit(grain: &SmallestGrain, speed: f64) -> Limit {
    let material = grain.material;
    let mass = 4.0 / 3.0 * PI * grain.radius.powi(3) * material.density / 2.0;
    let modulus = material.youngs_modulus / (2.0 * (1.0 - material.poisson_ratio.powi(2)));
    let fifth_power = mass * mass / (0.5 * grain.radius * modulus * modulus * speed);
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
fn hooke_limit(grain: &SmallestGrain, stiffness: f64, touching: Option<FeatureRule>) -> Limit {
    let springs = match touching {
        Some(FeatureRule::Full) => FEATURES_OF_PAIR,
        Some(FeatureRule::Shared) | None => 1.0,
    };
    let time = PI * (0.5 * grain.mass() / (springs * stiffness)).sqrt();
    Limit {
        name: "linear contact",
        time_step: time / STEPS_PER_HALF_PERIOD,
        reason: format!(
            "1/{STEPS_PER_HALF_PERIOD} of the {time:.3e} s that two grains of {} touch on {springs} springs of {stiffness:.3e} N/m",
            grain.material.name
        ),
    }
}

/// `1.6 m/(M c)` with the dashpot `c = 2 √(ln² e K_n m/(π² + ln² e))` of a grain against a heavy one: up to that step the
/// dashpots of `M` contacts take no more than all of its speed.
fn dashpot_limit(grain: &SmallestGrain, normal_stiffness: f64, rule: FeatureRule) -> Limit {
    let contacts = match rule {
        FeatureRule::Full => FEATURES_OF_GRAIN,
        FeatureRule::Shared => NEIGHBOURS_OF_GRAIN,
    };
    let log_squared = natural_log(grain.restitution).powi(2);
    let damped = log_squared / (PI * PI + log_squared);
    let dashpot = 2.0 * (damped * normal_stiffness * grain.mass()).sqrt();
    Limit {
        name: "dashpots of a polyhedron",
        time_step: LARGEST_DRAG * grain.mass() / (contacts * dashpot),
        reason: format!(
            "{LARGEST_DRAG}/{contacts} of the {:.3e} s in which one dashpot stops the smallest grain of {}, which {contacts} of \
             them act on at once",
            grain.mass() / dashpot,
            grain.material.name
        ),
    }
}

/// `1.6 m/(2 · 6 c)` with the drag `c = 6π η r*²/D` of two equal grains at the smallest gap: up to that step it acts
/// unbounded on grains with six neighbours each.
fn lubrication_limit(grain: &SmallestGrain, liquid: &Liquid) -> Limit {
    let mass = grain.mass();
    let effective = 0.5 * grain.radius;
    let gap = smallest_viscous_gap(liquid.law.viscous_gap, effective, 2.0 * grain.radius);
    let drag = 6.0 * PI * liquid.viscosity * effective * effective / gap;
    Limit {
        name: "lubrication",
        time_step: LARGEST_DRAG * mass / (2.0 * DRAGGING_NEIGHBOURS * drag),
        reason: format!(
            "{LARGEST_DRAG}/12 of the {:.3e} s in which the liquid film stops a grain of {} with r = {:.3e} m that closes \
             the smallest gap",
            mass / drag,
            grain.material.name,
            grain.radius
        ),
    }
}
