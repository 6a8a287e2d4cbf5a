//! From grains placed in a container to a bed at rest.
//!
//! In: a scene whose container is to be filled, with its time step. Out: a world at time zero in
//! which every grain rests on others under the scene's own gravity, contacts with their histories
//! included. The walls stand still meanwhile.
//!
//! The grains fall freely, then lose a share of their velocity between pieces of so many steps
//! until they creep, then relax with nothing but the contact laws, so that the end is a true
//! equilibrium; where they do not come to rest so (a grain may swing between two others with hardly
//! a loss), they are calmed again. Large beds do so in longer steps and do not wait for stragglers
//! (`docs/reach.md`). All stages are counted in steps: the same scene gives the same bits.

use super::pieces::Pieces;
use crate::measure::elastic_energy;
use crate::scene::{Scene, SceneContainer, SceneGrains, TimeStep};
use crate::solver::{Fault, Solver, advise};
use crate::world::{Clock, WallMotion, World};
use glam::DVec3;
use std::time::{Duration, Instant};

/// Wall-clock time that a piece takes at most, as a rule: whoever stops a run waits for it. Slices of
/// small beds take less.
const PIECE_TIME: Duration = Duration::from_millis(500);
/// Share of its velocity that a grain keeps from one slice of the calming stage to the next.
const KEPT: f64 = 0.9;
/// Kinetic energy over `Σ m g r` at which calming ends.
const CREEPING: f64 = 1e-8;
/// Kinetic energy over `Σ m g r` of a bed at rest; rms speeds are then near 1e-5 m/s for
/// millimetres.
const QUIET: f64 = 1e-9;
/// Grains from which on a bed is a large one. It settles in the *fast* step, falls for longer, and of
/// every so many grains the fastest is left out where it is said how much the bed still moves:
/// somewhere in it there is always one that spins or swings between two others with hardly a loss.
const LARGE: usize = 10_000;
/// Free falls through its height that a large bed takes before it is calmed: until the waves of its
/// impact have died down, which calming would slow.
const FALLS_OF_LARGE: f64 = 2.0;
/// A relaxation, in units of `√(r/g)`: grains that balance where they cannot stay fall within it.
const RELAXATION: f64 = 10.0;
/// Longest settling, in units of `√(r/g)`, after which a bed is taken as it is.
const PATIENCE: f64 = 150.0;
/// Slices in `√(r/g)`.
const SLICES: f64 = 8.0;

/// Whether the grains of `scene` have to settle before time zero.
pub fn needs_settling(scene: &Scene) -> bool {
    let filled = matches!(scene.grains, SceneGrains::Fill { count, .. } if count > 0);
    filled && scene.container != SceneContainer::Nothing && scene.gravity.length() > 0.0
}

/// The step with which the bed of `scene` settles [s]: that of the dry scene, whatever its liquid asks
/// for; the *fast* one for a [`LARGE`] bed, where the scene leaves the step to the program.
pub fn settling_step(scene: &Scene) -> f64 {
    let time_step = match scene.time_step {
        TimeStep::Automatic | TimeStep::Following if scene.grain_count() >= LARGE => TimeStep::Fast,
        asked => asked,
    };
    let dry = Scene {
        liquid: None,
        time_step,
        ..scene.clone()
    };
    advise(&dry).time_step
}

/// A bed on its way to rest.
pub struct Settling {
    world: World,
    solver: Solver,
    /// The scene's world before settling.
    built: World,
    stage: SettlingStage,
    /// Steps of a slice, and the step at which the present one ends.
    slice: u64,
    slice_end: u64,
    pieces: Pieces,
    /// `Σ m g r` [J].
    energy_scale: f64,
    /// Steps of the free fall, of a relaxation, and of everything at most.
    fall: u64,
    relaxation: u64,
    patience: u64,
    progress: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum SettlingStage {
    Falling,
    Calming,
    Relaxing { since: u64 },
    AtRest,
}

impl Settling {
    /// Starts from `built`, a scene's world with its grains placed and at rest, on `threads`
    /// threads, with steps of `time_step` [s].
    pub fn new(built: World, time_step: f64, threads: usize) -> Self {
        let world = standing(&built, time_step);
        let gravity = world.gravity.length();
        let radius = mean(&world.grains.radius);
        let steps = |time: f64| (time / world.clock.time_step).ceil().max(1.0) as u64;
        let unit = (radius / gravity).sqrt();
        let slice = steps(unit / SLICES);
        let falls = if world.grains.len() < LARGE {
            1.0
        } else {
            FALLS_OF_LARGE
        };
        Self {
            slice,
            slice_end: slice,
            pieces: Pieces::of(PIECE_TIME),
            fall: steps(falls * (2.0 * extent(&world) / gravity).sqrt()),
            relaxation: steps(RELAXATION * unit),
            patience: steps(PATIENCE * unit),
            energy_scale: energy_scale(&world),
            built,
            world,
            solver: Solver::new(threads),
            stage: SettlingStage::Falling,
            progress: 0.0,
        }
    }

    /// Moves the grains on by a slice, or by a short piece of one, and says whether they are at
    /// rest.
    ///
    /// # Errors
    /// The solver's [`Fault`].
    pub fn advance(&mut self) -> Result<bool, Fault> {
        let steps = self.next_piece();
        let started = Instant::now();
        self.solver.advance(&mut self.world, steps)?;
        self.pieces.fit(steps, started.elapsed());
        let step = self.world.clock.step;
        if step < self.slice_end {
            return Ok(false);
        }
        self.slice_end = step + self.slice;
        let agitation = kinetic_energy(&self.world) / self.energy_scale;
        self.stage = match self.stage {
            _ if step >= self.patience => SettlingStage::AtRest,
            SettlingStage::Falling if step >= self.fall => SettlingStage::Calming,
            SettlingStage::Calming if agitation < CREEPING => {
                SettlingStage::Relaxing { since: step }
            }
            SettlingStage::Relaxing { since } if step - since < self.relaxation => self.stage,
            SettlingStage::Relaxing { .. } if agitation < QUIET => SettlingStage::AtRest,
            SettlingStage::Relaxing { .. } => SettlingStage::Calming,
            unchanged => unchanged,
        };
        if self.stage == SettlingStage::Calming {
            self.calm();
        }
        self.progress = self.progress.max(self.estimate(agitation));
        Ok(self.stage == SettlingStage::AtRest)
    }

    /// How far settling has come, 0 … 1.
    pub fn progress(&self) -> f32 {
        self.progress
    }

    /// The world on its way to rest.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The settled world at time zero, the walls moving as the scene says.
    pub fn finish(self) -> World {
        start(self.world, &self.built)
    }

    /// Steps of the next piece: those left of the slice, in as few equal pieces as may be.
    fn next_piece(&self) -> u64 {
        let left = self.slice_end - self.world.clock.step;
        left.div_ceil(left.div_ceil(self.pieces.steps()))
    }

    fn calm(&mut self) {
        let grains = &mut self.world.grains;
        for moving in grains.velocity.iter_mut().chain(&mut grains.spin) {
            *moving *= KEPT;
        }
    }

    #[expect(
        clippy::disallowed_methods,
        reason = "how far settling has come is told, not computed with"
    )]
    fn estimate(&self, agitation: f64) -> f32 {
        let decades = |from: f64, to: f64| {
            ((from / agitation.max(1e-300)).ln() / (from / to).ln()).clamp(0.0, 1.0) as f32
        };
        // Where falling and calming end, about.
        let [fallen, calmed] = if self.world.grains.len() < LARGE {
            [0.3, 0.8]
        } else {
            [0.5, 0.65]
        };
        let between = |from: f32, to: f32, part: f32| from + (to - from) * part.min(1.0);
        match self.stage {
            SettlingStage::Falling => {
                let part = self.world.clock.step as f32 / self.fall as f32;
                between(0.0, fallen, part)
            }
            SettlingStage::Calming => between(fallen, calmed, decades(1.0, CREEPING)),
            SettlingStage::Relaxing { .. } => between(calmed, 1.0, decades(CREEPING, QUIET)),
            SettlingStage::AtRest => 1.0,
        }
    }
}

/// `built` as it settles: with walls that stand still, dry, with steps of `time_step` [s]. Liquid
/// is poured over the settled bed, so that a drum has one bed for all liquids.
pub fn standing(built: &World, time_step: f64) -> World {
    let mut world = built.clone();
    world.clock = Clock::new(time_step);
    world.liquid = None;
    world.grains.film.fill(0.0);
    for pair in world.materials.pairs_mut() {
        pair.wet_friction = pair.friction;
    }
    for wall in &mut world.container.walls {
        wall.motion = WallMotion::default();
    }
    world
}

/// Puts a `settled` world at rest at time zero, with liquid, step and moving walls as in `built`.
///
/// Forces and springs are rounded to single precision, which disturbs a bed far less than its last
/// creeping does: kept beds are small and the same to the bit.
pub fn start(settled: World, built: &World) -> World {
    let mut world = World {
        clock: built.clock,
        liquid: built.liquid,
        materials: built.materials.clone(),
        container: built.container.clone(),
        ..settled
    };
    let grains = &mut world.grains;
    grains.film.clone_from(&built.grains.film);
    grains.velocity.fill(DVec3::ZERO);
    grains.spin.fill(DVec3::ZERO);
    let on_grains = grains
        .force
        .iter_mut()
        .chain(&mut grains.torque)
        .chain(&mut grains.rolling_torque);
    on_grains.for_each(round);
    for contact in &mut world.contacts {
        round(&mut contact.spring);
        round(&mut contact.rolling);
        round(&mut contact.force);
        contact.stiffness = f64::from(contact.stiffness as f32);
    }
    let elastic = elastic_energy(&world);
    world.restart_clock(elastic);
    world
}

fn round(vector: &mut DVec3) {
    *vector = vector.as_vec3().as_dvec3();
}

/// Kinetic energy of `world`, of a [`LARGE`] bed without its few fastest grains [J].
fn kinetic_energy(world: &World) -> f64 {
    let energy = |i| world.kinetic_energy_of(i);
    let counted = world.grains.len() - world.grains.len() / LARGE;
    let mut energies: Vec<f64> = (0..world.grains.len()).map(energy).collect();
    let limit = if counted < energies.len() {
        *energies
            .clone()
            .select_nth_unstable_by(counted, f64::total_cmp)
            .1
    } else {
        f64::INFINITY
    };
    energies.retain(|energy| *energy < limit);
    energies.iter().sum()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Extent of the grains along gravity, twice a radius at least [m].
fn extent(world: &World) -> f64 {
    let down = world.gravity.normalize();
    let depths = world.grains.position.iter().map(|x| x.dot(down));
    let (low, high) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), depth| {
        (low.min(depth), high.max(depth))
    });
    (high - low).max(2.0 * mean(&world.grains.radius))
}

/// `Σ m g r` [J].
fn energy_scale(world: &World) -> f64 {
    let grains = &world.grains;
    let moments = grains.mass.iter().zip(&grains.radius).map(|(m, r)| m * r);
    moments.sum::<f64>() * world.gravity.length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn box_of(count: usize) -> Scene {
        let text = format!(
            "(title: \"box\", materials: {{\"glass\": ()}}, container: Box(min: (0, 0, 0), max: (1, 1, 1), \
             material: \"glass\"), grains: Fill(count: {count}, species: [(radius_mm: 2, material: \"glass\")]))"
        );
        Scene::parse("box.ron", &text).unwrap()
    }

    /// Every grain with a kinetic energy of 1 J, the first two with 5 J.
    #[test]
    fn fastest_of_ten_thousand_is_left_out_where_a_bed_is_large() {
        for (count, counted) in [(9_999, 9_999.0 + 8.0), (10_000, 9_999.0 + 4.0)] {
            let mut world = crate::world::build(&box_of(count), 1e-5);
            let grains = &mut world.grains;
            for (i, (v, m)) in grains.velocity.iter_mut().zip(&grains.mass).enumerate() {
                let energy = if i < 2 { 5.0 + 1e-6 * i as f64 } else { 1.0 };
                v.x = (2.0 * energy / m).sqrt();
            }
            let energy = kinetic_energy(&world);
            assert!((energy - counted).abs() < 1e-4, "{energy} J of {count}");
        }
    }

    #[test]
    fn large_bed_settles_in_the_fast_step_unless_the_scene_gives_one() {
        let mut scene = box_of(9_999);
        let standard = advise(&scene).time_step;
        assert_eq!(settling_step(&scene), standard);
        scene = box_of(10_000);
        for left_to_us in [TimeStep::Automatic, TimeStep::Following] {
            scene.time_step = left_to_us;
            assert_eq!(settling_step(&scene), 1.5 * standard);
        }
        scene.time_step = TimeStep::Given(1e-6);
        assert_eq!(settling_step(&scene), 1e-6);
    }
}
