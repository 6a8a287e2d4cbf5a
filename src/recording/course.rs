//! What was set when, and where the walls are by then: all of a state but its grains.
//!
//! In: a scene and the commands of its run. Out: its world at a step, without grains: materials,
//! walls, gravity, liquid, clock. Commands are carried out by the parameters' own rows.

use crate::run::{Command, StampedCommand, StepTimes};
use crate::scene::Scene;
use crate::world::{World, build_without_grains};
use std::sync::Arc;

/// The course of a run without its grains.
pub struct Course {
    scene: Arc<Scene>,
    /// The world at time zero, without grains.
    start: World,
    commands: Vec<StampedCommand>,
}

impl Course {
    /// That of a run of `scene` which begins with steps of `time_step` [s]; no commands yet.
    pub fn new(scene: Arc<Scene>, time_step: f64) -> Self {
        Self {
            start: build_without_grains(&scene, time_step),
            scene,
            commands: Vec::new(),
        }
    }

    /// These `commands` were carried out on its way; they are in order.
    pub fn follow(&mut self, commands: Vec<StampedCommand>) {
        self.commands = commands;
    }

    /// What was carried out.
    pub fn commands(&self) -> &[StampedCommand] {
        &self.commands
    }

    /// Which step was when.
    pub fn step_times(&self) -> StepTimes {
        StepTimes::new(self.start.clock.time_step, &self.commands)
    }

    /// The world at `step`, without grains.
    pub fn at(&self, step: u64) -> World {
        let mut world = self.start.clone();
        for stamped in self.commands.iter().take_while(|c| c.step <= step) {
            go_on(&mut world, stamped.step);
            if let Command::Set { parameter, value } = &stamped.command {
                parameter.write(*value, &self.scene, &mut world);
            }
        }
        go_on(&mut world, step);
        world
    }
}

/// Lets the clock and the walls of `world` go on to `step`.
fn go_on(world: &mut World, step: u64) {
    let steps = step.saturating_sub(world.clock.step);
    world.container.carry(steps as f64 * world.clock.time_step);
    world.clock.step += steps;
}
