//! Results of a run that goes on, taken anew now and then.

use crate::ui::panel::is_column;
use grainfall::lab::{RunView, SMALLEST_DROP};
use grainfall::measure::{Series, Summary, results, summarise};
use std::borrow::Cow;

/// Averages are remade after this many new samples, half a simulated second. Results of a column
/// are remade with every sample.
const SAMPLES_BETWEEN_SUMMARIES: usize = 25;

/// The last averages and what they were made of.
#[derive(Default)]
pub struct Averages {
    made: Option<(Key, Summary)>,
}

/// What decides a summary: the same key, the same summary.
#[derive(Clone, Copy, PartialEq)]
struct Key {
    simulation: u64,
    run: u32,
    samples: usize,
    from: f64,
    until: f64,
}

impl Averages {
    /// Averages over `simulation` from a time [s] on, or the results of its column, remade when
    /// enough has been added.
    pub fn over(&mut self, simulation: &RunView, from: f64) -> &Summary {
        self.between(simulation, from, f64::INFINITY)
    }

    /// The same, `until` another time [s].
    pub fn between(&mut self, simulation: &RunView, from: f64, until: f64) -> &Summary {
        let series = simulation.series();
        let between = if is_column(simulation) {
            1
        } else {
            SAMPLES_BETWEEN_SUMMARIES
        };
        let key = Key {
            simulation: simulation.id(),
            run: simulation.past().number,
            samples: series.len() / between,
            from,
            until,
        };
        if self.made.as_ref().is_some_and(|(made, _)| *made != key) {
            self.made = None;
        }
        let make = || {
            let series = &first(series, until);
            match simulation.world() {
                Some(world) => {
                    let flow = simulation.flow();
                    (key, results(series, flow, world, from, SMALLEST_DROP))
                }
                None => (key, summarise(series, from, SMALLEST_DROP)),
            }
        };
        &self.made.get_or_insert_with(make).1
    }
}

/// The samples of `series` until a time [s].
fn first(series: &Series, until: f64) -> Cow<'_, Series> {
    let count = series.time().partition_point(|time| *time <= until);
    if count == series.len() {
        return Cow::Borrowed(series);
    }
    let mut first = Series::default();
    first.copy_first(series, count);
    Cow::Owned(first)
}
