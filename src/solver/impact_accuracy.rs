//! What a time step costs in accuracy: an impact of two grains, computed with it.
//!
//! In: a scene, a step. Out: how long the impact lasts and what it gives back, by the solver itself
//! with the scene's law, materials and integrator. Beside the same with a shorter step this is the
//! error that the step makes of each impact.
//!
//! The impact is head-on and dry, between two of the smallest grains of the scene (of polyhedra:
//! spheres of their volume, one contact), at the speed that steps are advised for
//! ([`super::time_step`]). Where in a step it begins is chance in a bed: [`PHASES`] of them are
//! computed.
//!
//! Not here: what a step makes of a whole bed, which only runs can tell.

use super::Solver;
use super::time_step::{Extremes, advise};
use crate::physics::MaterialId;
use crate::scene::{Scene, SceneContainer, TimeStep};
use crate::world::{
    Grains, Ledger, PlacedPolyhedron, Polyhedra, Polyhedron, Species, SpeciesId, World,
    build_without_grains,
};
use glam::{DQuat, DVec3};

/// In how many parts of a step the impact begins.
const PHASES: u32 = 8;
/// An impact of more steps is not waited for.
const MOST_STEPS: u64 = 100_000;

/// An impact as it comes out with a step.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ImpactAccuracy {
    /// The step [s].
    pub time_step: f64,
    /// Speed of approach [m/s].
    pub speed: f64,
    /// How long the grains touch, the mean over the phases [steps].
    pub steps: f64,
    /// Speed of parting over that of approach, the mean over the phases.
    pub restitution: f64,
    /// The least and the most of them.
    pub range: [f64; 2],
}

impl ImpactAccuracy {
    /// An impact of grains of `scene` with steps of `time_step` [s]; none where it has no grains,
    /// or where they do not part.
    pub fn of(scene: &Scene, time_step: f64) -> Option<Self> {
        let extremes = Extremes::of(scene);
        let (material, radius) = extremes.smallest()?;
        let speed = extremes.impact_speed();
        let mut impact = Self {
            time_step,
            speed,
            steps: 0.0,
            restitution: 0.0,
            range: [f64::INFINITY, 0.0],
        };
        for phase in 0..PHASES {
            let part = (f64::from(phase) + 0.5) / f64::from(PHASES);
            let grains = Impact {
                material,
                radius,
                speed,
            };
            let mut world = grains.world(scene, time_step, part * time_step * speed)?;
            let (lasts, parting) = until_parted(&mut world)?;
            let given_back = parting / speed;
            impact.steps += lasts as f64 / f64::from(PHASES);
            impact.restitution += given_back / f64::from(PHASES);
            let [least, most] = impact.range;
            impact.range = [least.min(given_back), most.max(given_back)];
        }
        Some(impact)
    }
}

/// Two equal grains that are to meet.
struct Impact {
    material: MaterialId,
    /// Of either [m].
    radius: f64,
    /// Of approach [m/s].
    speed: f64,
}

impl Impact {
    /// A world of them alone, `gap` [m] apart.
    fn world(&self, scene: &Scene, time_step: f64, gap: f64) -> Option<World> {
        let bare = Scene {
            container: SceneContainer::Nothing,
            gravity: DVec3::ZERO,
            liquid: None,
            ..scene.clone()
        };
        let mut world = build_without_grains(&bare, time_step);
        let made_of = |species: &Species| species.material == self.material;
        let species = SpeciesId(world.species.iter().position(made_of)? as u16);
        let density = world.materials.get(self.material).density;
        let mut grains = Grains::default();
        let mut polyhedra = Polyhedra::new(vec![Polyhedron::sphere(self.radius)]);
        for side in [-1.0, 1.0] {
            let position = DVec3::X * side * (self.radius + 0.5 * gap);
            let velocity = DVec3::X * -side * 0.5 * self.speed;
            if world.polyhedra.is_some() {
                let body = PlacedPolyhedron {
                    shape: 0,
                    position,
                    orientation: DQuat::IDENTITY,
                    velocity,
                    spin: DVec3::ZERO,
                    density,
                    species,
                };
                polyhedra.push(&mut grains, &body);
            } else {
                grains.push_sphere(position, self.radius, density, species);
                let last = grains.len() - 1;
                grains.velocity[last] = velocity;
            }
        }
        world.grains = grains;
        if let Some(of_world) = &mut world.polyhedra {
            polyhedra.integrator = of_world.integrator;
            **of_world = polyhedra;
        }
        world.ledger = Ledger::starting_at(world.kinetic_energy(), 0.0);
        Some(world)
    }
}

/// Lets the two grains of `world` meet; the steps in which they touch, and how fast they part
/// [m/s].
fn until_parted(world: &mut World) -> Option<(u64, f64)> {
    let mut solver = Solver::new(1);
    let mut touched = 0;
    for _ in 0..MOST_STEPS {
        solver.advance(world, 1).ok()?;
        let touch = world.contacts.iter().any(|contact| contact.touching);
        touched += u64::from(touch);
        if touched > 0 && !touch {
            let velocity = &world.grains.velocity;
            return Some((touched, velocity[1].x - velocity[0].x));
        }
    }
    None
}

/// A step that a scene can have, and what it makes of an impact.
#[derive(Clone, Debug, serde::Serialize)]
pub struct StepChoice {
    /// What `time-step` calls it; `given` where the scene gives it.
    pub name: &'static str,
    /// Length of the step [s].
    pub time_step: f64,
    /// What an impact comes to; none where the scene has no grains.
    pub impact: Option<ImpactAccuracy>,
}

/// The steps that `scene` can be run with, the shortest first, behind them the one that it gives.
pub fn step_choices(scene: &Scene) -> Vec<StepChoice> {
    let named = [
        ("reference", TimeStep::Reference),
        ("standard", TimeStep::Automatic),
        ("fast", TimeStep::Fast),
    ];
    let given = match scene.time_step {
        given @ TimeStep::Given(_) => Some(("given", given)),
        _ => None,
    };
    let choice = |(name, time_step)| {
        let scene = Scene {
            time_step,
            ..scene.clone()
        };
        let time_step = advise(&scene).time_step;
        StepChoice {
            name,
            time_step,
            impact: ImpactAccuracy::of(&scene, time_step),
        }
    };
    named.into_iter().chain(given).map(choice).collect()
}
