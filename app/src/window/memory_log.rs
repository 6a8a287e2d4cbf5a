//! Where the memory of a window goes, for those who look for leaks: `RUST_LOG=grainfall_app=debug`.
//!
//! In: the runs shown, every ten seconds. Out: a line of the log with the memory that the program
//! holds, what of it is in use, by its graphics driver too, where the allocator tells, and what is
//! kept by design [bytes]: by its runs, and of the letters that were written so far; and how many
//! pipelines the renderer has, of which a driver keeps something, too.

use crate::simulation::Simulation;
use crate::window::pipelines::Pipelines;
use bevy::log::debug;
use bevy::prelude::{App, IntoScheduleConfigs, Plugin, Query, Res, Update};
use bevy::time::common_conditions::on_real_timer;
use bevy_egui::{EguiContext, egui};
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

/// Copies of a picture of letters: of egui, two on its way to the renderer, the renderer's own, which
/// a software driver has here.
const COPIES: usize = 4;

fn tell_memory(
    simulation: Option<Res<Simulation>>,
    mut contexts: Query<&mut EguiContext>,
    pipelines: Option<Res<Pipelines>>,
) {
    let (Some(simulation), Some(resident)) = (simulation, resident_memory()) else {
        return;
    };
    let shown = 1 + usize::from(simulation.comparison().is_some());
    let runs = Half::ALL.into_iter().take(shown);
    let kept = runs.map(|half| simulation.half(half).kept_memory().total());
    let letters = contexts
        .iter_mut()
        .map(|mut context| letters(context.get_mut()));
    let kept = kept.sum::<usize>() + letters.sum::<usize>();
    let used = in_use().map_or(String::new(), |used| format!(" in use {used}"));
    let pipelines = pipelines.map_or(0, |pipelines| pipelines.count());
    debug!("memory {resident}{used} kept {kept} pipelines {pipelines}");
}

/// What the pictures take into which each letter is drawn once in each size [bytes]. They grow by
/// doubling, and begin anew when they are nearly as high as wide.
fn letters(context: &egui::Context) -> usize {
    if context.cumulative_pass_nr() == 0 {
        return 0;
    }
    let pixels: usize = context.fonts(|fonts| fonts.font_image_size().iter().product());
    COPIES * pixels * size_of::<egui::Color32>()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_size_of_letters_takes_memory_once() {
        let context = egui::Context::default();
        assert_eq!(letters(&context), 0);
        let write = |sizes: std::ops::Range<u8>| {
            let _ = context.run_ui(egui::RawInput::default(), |ui| {
                for size in sizes.clone() {
                    let text = egui::RichText::new("0123456789 ϕθ Σ abc").size(f32::from(size));
                    ui.label(text);
                }
            });
            letters(&context)
        };
        let few = write(12..14);
        assert!(few > 0);
        assert_eq!(write(12..14), few);
        let many = write(12..80);
        assert!(many > few, "{many} after {few}");
        assert_eq!(write(12..80), many);
    }

    #[cfg(all(target_os = "linux", target_env = "gnu"))]
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
