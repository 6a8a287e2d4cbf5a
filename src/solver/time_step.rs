//! How long a step may be, and why.
//!
//! In: a scene that has no world yet, or the state of its run. Out: every limit on the step with
//! its reason, the smallest first. Before a run [`advise`] chooses the step, or takes the one that
//! the scene gives; while it goes on [`Extremes::advise`] holds the present step against the limits
//! of the present state, so that no change of a material, a liquid or a law goes unnoticed.
//!
//! Laws and bridges say their own limits ([`crate::physics::law::StepLimit`]): how long a contact
//! of the smallest grains lasts, how quickly a wave goes round one, how soon a dashpot or a drag
//! would stop one. A limit falls with the radius, so that the smallest grain of each material
//! stands for all of it.
//!
//! Not here: changing the step. A command does that (the parameter `time-step`), so that it is
//! recorded.

pub use crate::physics::law::StepLimit as Limit;

use crate::physics::law::{Circumstances, SmallestGrain, lubrication_limit};
use crate::physics::limits::TIME_STEP;
use crate::physics::{ContactLaw, Integrator, Liquid, MaterialId, Materials};
use crate::scene::{Scene, SceneContainer, SceneGrains, ScenePlane, TimeStep};
use crate::world::{self, World};
use glam::DVec3;

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

/// Speed at which grains hit each other where a scene's listed speeds are smaller [m/s].
const IMPACT_SPEED: f64 = 0.2;

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

    /// The largest step that every limit allows and a run can have [s].
    pub fn largest(&self) -> f64 {
        largest(&self.limits)
    }

    /// By which share the step exceeds its limit, 0.29 for 29 %; none where it does not.
    pub fn excess(&self) -> Option<f64> {
        excess(self.time_step, self.limits.first()?)
    }
}

/// What of a scene limits the step and changes in no run: how small its grains are, and how fast
/// they may hit each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// The smallest radius of the grains of each material [m], in order of the materials' names.
    radii: Vec<(MaterialId, f64)>,
    /// Speed of impacts [m/s].
    impact_speed: f64,
    /// Smallest sphero-radius of polyhedra; infinite where none has one [m].
    rounding: f64,
    /// How fast grains may become as they fall, or hit each other [m/s].
    fastest: f64,
}

/// The time step for `scene` before there is a world of it: the one it gives, or the largest that
/// every limit allows.
pub fn advise(scene: &Scene) -> TimeStepAdvice {
    let materials = world::materials(scene);
    let extremes = Extremes::of(scene);
    let grains = extremes.grains(&materials, |material| {
        scene.materials[usize::from(material.0)].restitution
    });
    let at = extremes.circumstances(scene.is_polyhedral(), scene.integrator);
    let limits = limits(&grains, scene.law, scene.liquid.as_ref(), &at);
    match scene.time_step {
        TimeStep::Given(given) => TimeStepAdvice::of(given, limits),
        chosen => {
            let step = chosen.share_of_limit() * largest(&limits);
            TimeStepAdvice::of(step.clamp(TIME_STEP.least, TIME_STEP.most), limits)
        }
    }
}

impl Extremes {
    /// Those of `scene`.
    pub fn of(scene: &Scene) -> Self {
        Self {
            radii: smallest_radii(scene),
            impact_speed: impact_speed(scene),
            rounding: smallest_rounding(scene),
            fastest: impact_speed(scene).max(falling_speed(scene)),
        }
    }

    /// The present step of `world`, a world of this scene, against the limits of its present state:
    /// materials and their pairs, law and liquid.
    ///
    /// At time zero and unchanged the limits are those of [`advise`], but where a pair that the
    /// scene states restitutes less than each of its two materials among its own kind: only here is
    /// it looked at.
    pub fn advise(&self, world: &World) -> TimeStepAdvice {
        let materials = &world.materials;
        let grains = self.grains(materials, |material| {
            lowest_restitution(materials, material)
        });
        let at = self.circumstances(world.polyhedra.is_some(), world.integrator());
        let limits = limits(&grains, world.law, world.wetting(), &at);
        TimeStepAdvice::of(world.clock.time_step, limits)
    }

    /// The smallest grains: what they are made of and their radius [m]; none where there is none.
    pub(super) fn smallest(&self) -> Option<(MaterialId, f64)> {
        let radii = self.radii.iter().copied();
        radii.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Speed of impacts that steps are advised for [m/s].
    pub(super) fn impact_speed(&self) -> f64 {
        self.impact_speed
    }

    fn circumstances(&self, are_polyhedra: bool, integrator: Integrator) -> Circumstances {
        Circumstances {
            impact_speed: self.impact_speed,
            are_polyhedra,
            integrator,
            rounding: self.rounding,
            fastest: self.fastest,
        }
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

/// Restitution of the most strongly damped contacts of bodies of this material. A mean of two
/// materials is that of one of them among its own kind, so that only a pair below both counts.
fn lowest_restitution(materials: &Materials, material: MaterialId) -> f64 {
    let between = |a, b| materials.pair(a, b).restitution;
    let own = between(material, material);
    (0..materials.list().len() as u16)
        .map(MaterialId)
        .map(|other| (between(material, other), between(other, other)))
        .filter(|(pair, other)| *pair < own.min(*other))
        .fold(own, |lowest, (pair, _)| lowest.min(pair))
}

/// Every limit of the `grains` under the `law` with the bridges of a `liquid`, the binding one
/// first.
fn limits(
    grains: &[SmallestGrain],
    law: ContactLaw,
    liquid: Option<&Liquid>,
    at: &Circumstances,
) -> Vec<Limit> {
    let of_law = |grain: &SmallestGrain| law.told(|law| law.step_limits(grain, at));
    let mut limits: Vec<Limit> = grains.iter().flat_map(of_law).collect();
    if let Some(liquid) = liquid.filter(|liquid| liquid.viscosity > 0.0) {
        limits.extend(grains.iter().map(|grain| lubrication_limit(grain, liquid)));
    }
    limits.sort_by(|a, b| a.time_step.total_cmp(&b.time_step));
    limits.dedup_by(|later, earlier| later.name == earlier.name);
    limits
}

/// The largest step within all `limits`, the binding one first, that is one of [`TIME_STEP`]:
/// grains of metres that are as soft as foam would allow minutes. A stiff dust asks for less than a
/// run can have; then the least exceeds its limit, and the warning says so.
fn largest(limits: &[Limit]) -> f64 {
    let largest = limits.first().map_or(UNLIMITED, |limit| limit.time_step);
    largest.clamp(TIME_STEP.least, TIME_STEP.most)
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

/// The smallest sphero-radius of the scene's polyhedra; infinite where none has one [m].
fn smallest_rounding(scene: &Scene) -> f64 {
    match &scene.grains {
        SceneGrains::Fill { .. } => f64::INFINITY,
        SceneGrains::Voronoi(cells) => cells.rounding,
        SceneGrains::List(grains) => {
            let roundings = grains.iter().filter_map(|grain| grain.shape.rounding());
            roundings.fold(f64::INFINITY, f64::min)
        }
    }
}

/// The speed of a free fall from the top of a column, or of listed grains onto planes; none elsewhere
/// [m/s].
fn falling_speed(scene: &Scene) -> f64 {
    match (&scene.container, &scene.grains) {
        (SceneContainer::Column { height, .. }, _) => {
            (2.0 * scene.gravity.length() * height).sqrt()
        }
        (SceneContainer::Planes(planes), SceneGrains::List(grains)) => {
            let speeds = grains.iter().map(|grain| {
                let work = work_of_fall(planes, grain.position, scene.gravity);
                (grain.velocity.length_squared() + 2.0 * work).sqrt()
            });
            speeds.fold(0.0, f64::max)
        }
        _ => 0.0,
    }
}

/// What `gravity` does to a grain that falls from `position` onto the first of the `planes` below it,
/// over its mass; nothing where there is none [m²/s²].
fn work_of_fall(planes: &[ScenePlane], position: DVec3, gravity: DVec3) -> f64 {
    let works = planes.iter().filter_map(|plane| {
        let (height, pull) = (
            (position - plane.point).dot(plane.normal),
            -gravity.dot(plane.normal),
        );
        (height > 0.0 && pull > 0.0).then(|| gravity.length_squared() * height / pull)
    });
    let least = works.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
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
