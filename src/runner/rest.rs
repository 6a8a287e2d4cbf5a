//! A run that ends when its column is at rest.
//!
//! In: the samples so far. Out: whether the run ends here. It is asked at the end of each output
//! interval, whether states are written or not, and depends on the samples and the tube alone: a run
//! that was stopped and goes on ends at the same step. Such a run forgets no sample.

use super::Job;
use crate::measure::{Collapse, Series};
use crate::scene::{Scene, Until};
use crate::world::{Clock, Surface, World};

/// Looks for the rest of a column.
#[derive(Clone, Copy, Debug)]
pub struct RestWatch {
    /// Simulated time between two looks [s].
    interval: f64,
    /// Commands that are carried out first.
    commands: usize,
}

impl RestWatch {
    /// That of a `job`; none where its duration alone ends it.
    pub fn of(job: &Job) -> Option<Self> {
        Self::of_scene(&job.scene, job.script.len())
    }

    /// That of a run of `scene` with so many `commands`.
    pub fn of_scene(scene: &Scene, commands: usize) -> Option<Self> {
        (scene.until == Until::Rest).then_some(Self {
            interval: scene.output_interval,
            commands,
        })
    }

    /// The step of the next look.
    pub fn next_look(&self, clock: &Clock) -> u64 {
        let looks = (clock.time() / self.interval + 1e-9).floor();
        clock.step_at((looks + 1.0) * self.interval)
    }

    /// Whether a run ends at its state `world`, having taken the samples of `series` and carried
    /// out so many `commands`.
    pub fn ends(&self, world: &World, series: &Series, commands: usize) -> bool {
        let look = (world.time() / self.interval).round() * self.interval;
        world.clock.has_just_come_to(look) && commands >= self.commands && is_at_rest(world, series)
    }
}

/// Whether the column of `world` is at rest, free of its tube.
fn is_at_rest(world: &World, series: &Series) -> bool {
    let Some((collapse, last)) = Collapse::of(series).zip(series.last()) else {
        return false;
    };
    let holds =
        |surface: &Surface| matches!(surface, Surface::Tube { rim, .. } if *rim < collapse.height);
    let mut walls = world.container.walls.iter();
    collapse.is_over(last.time) && !walls.any(|wall| holds(&wall.surface))
}
