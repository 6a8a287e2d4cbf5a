//! Where the memory of a window goes, for those who look for leaks: `RUST_LOG=grainfall_app=debug`.
//!
//! In: the runs shown, every ten seconds. Out: a line of the log with the memory that the program
//! holds and that which its runs keep by design, both [bytes].

use crate::simulation::Simulation;
use bevy::log::debug;
use bevy::prelude::{App, IntoScheduleConfigs, Plugin, Res, Update};
use bevy::time::common_conditions::on_real_timer;
use grainfall::lab::Half;
use grainfall::run::resident_memory;
use std::time::Duration;

/// Wall-clock time from line to line.
const INTERVAL: Duration = Duration::from_secs(10);

/// Writes the lines.
pub(super) struct MemoryLogPlugin;

impl Plugin for MemoryLogPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, tell_memory.run_if(on_real_timer(INTERVAL)));
    }
}

fn tell_memory(simulation: Option<Res<Simulation>>) {
    let (Some(simulation), Some(resident)) = (simulation, resident_memory()) else {
        return;
    };
    let shown = 1 + usize::from(simulation.comparison().is_some());
    let runs = Half::ALL.into_iter().take(shown);
    let kept = runs.map(|half| simulation.half(half).kept_memory().total());
    let kept: usize = kept.sum();
    debug!("memory {resident} kept {kept}");
}
