//! Where the memory of a window goes, for those who look for leaks: `RUST_LOG=grainfall_app=debug`.
//!
//! In: the runs shown, every ten seconds. Out: a line of the log with the memory that the program
//! holds, what of it is in use, by its graphics driver too, where the allocator tells, and what its
//! runs keep by design [bytes].

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
    let used = in_use().map_or(String::new(), |used| format!(" in use {used}"));
    debug!("memory {resident}{used} kept {kept}");
}

/// What is allocated and not freed [bytes].
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn in_use() -> Option<usize> {
    use tikv_jemalloc_ctl::{epoch, stats};

    // What it tells is of the last time that it was asked to look.
    epoch::advance().ok()?;
    stats::allocated::read().ok()
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn in_use() -> Option<usize> {
    None
}

#[cfg(all(test, target_os = "linux", target_env = "gnu"))]
mod tests {
    use super::in_use;

    #[test]
    fn what_is_allocated_is_in_use_until_it_is_freed() {
        // More than all that other tests allocate meanwhile; never written, so no memory is taken.
        const SIZE: usize = 4 << 30;
        let before = in_use().unwrap();
        let large = std::hint::black_box(Vec::<u8>::with_capacity(SIZE));
        let with_it = in_use().unwrap();
        drop(large);
        let after = in_use().unwrap();
        let most = before + SIZE / 2;
        assert!(with_it > most && after < most, "{before} {with_it} {after}");
    }
}
