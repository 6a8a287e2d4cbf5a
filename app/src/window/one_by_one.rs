//! The systems of a frame, one after the other.
//!
//! Hardly any of them takes long, and those that do wait for each other. Given to several threads, a frame would wake these some
//! hundred times, and the solver's threads would give way each time.

use bevy::app::RunFixedMainLoop;
use bevy::ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};
use bevy::prelude::*;
use bevy_egui::EguiPrimaryContextPass;

/// Lets the systems of each frame run one after the other, on the thread that draws the frame.
pub struct OneByOnePlugin;

impl Plugin for OneByOnePlugin {
    fn build(&self, app: &mut App) {
        for label in [
            First.intern(),
            PreUpdate.intern(),
            RunFixedMainLoop.intern(),
            FixedFirst.intern(),
            FixedPreUpdate.intern(),
            FixedUpdate.intern(),
            FixedPostUpdate.intern(),
            FixedLast.intern(),
            Update.intern(),
            PostUpdate.intern(),
            Last.intern(),
            EguiPrimaryContextPass.intern(),
        ] {
            app.edit_schedule(label, |schedule| {
                schedule.set_executor(SingleThreadedExecutor::new());
            });
        }
    }
}
