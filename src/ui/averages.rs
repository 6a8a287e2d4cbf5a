//! Averages over a run that goes on, taken anew now and then.

use crate::measure::{Series, Summary, summarise};
use crate::simulation::SMALLEST_DROP;

/// Averages are taken anew whenever this many samples have been added, half a simulated second.
const SAMPLES_BETWEEN_SUMMARIES: usize = 25;

/// The last averages and what they were made of.
#[derive(Default)]
pub struct Averages {
    made: Option<(Key, Summary)>,
}

/// What a summary was made of.
#[derive(Clone, Copy, PartialEq)]
struct Key {
    samples: usize,
    from: f64,
}

impl Averages {
    /// Averages over `series` from a time [s] on, remade when enough has been added.
    pub fn over(&mut self, series: &Series, from: f64) -> &Summary {
        let key = Key {
            samples: series.len() / SAMPLES_BETWEEN_SUMMARIES,
            from,
        };
        if self.made.as_ref().is_some_and(|(made, _)| *made != key) {
            self.made = None;
        }
        let make = || (key, summarise(series, from, SMALLEST_DROP));
        &self.made.get_or_insert_with(make).1
    }
}
