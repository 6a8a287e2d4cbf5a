//! What stands in the picture: which world, which moment, which of two runs.
//!
//! In: the simulation. Out: a caption, or one for each half.

use crate::simulation::Simulation;
use crate::ui::words::run_names::half_title;
use crate::view::Caption;
use grainfall::lab::{Half, RunView};

/// What stands in the picture: once, or in each of its halves. With the clock or without; with how
/// fast it goes where that is given.
pub fn captions(
    simulation: Option<&Simulation>,
    has_clock: bool,
    real_time_factor: f64,
) -> Vec<Caption<'_>> {
    let is_pair = |simulation: &&Simulation| simulation.comparison().is_some();
    let captions = match simulation.filter(is_pair) {
        None => {
            let run = simulation.map(|simulation| simulation.half(Half::Left));
            vec![caption(run, real_time_factor, None)]
        }
        Some(pair) => Half::ALL
            .map(|half| {
                let title = Some(half_title(pair, half));
                caption(Some(pair.half(half)), real_time_factor, title)
            })
            .into(),
    };
    let with_clock = |caption| Caption {
        has_clock,
        ..caption
    };
    captions.into_iter().map(with_clock).collect()
}

fn caption(run: Option<&RunView>, factor: f64, title: Option<String>) -> Caption<'_> {
    Caption {
        world: run.and_then(|run| run.world().map(AsRef::as_ref)),
        real_time_factor: (factor > 0.0).then_some(factor),
        title,
        has_clock: true,
        is_for_afar: false,
    }
}
