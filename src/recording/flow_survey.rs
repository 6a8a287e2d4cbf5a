//! The mean flow of a recording, measured on its states: for runs that wrote none.
//!
//! In: a recording, state by state. Out: the mean flow over the states read so far, which lie further
//! apart than a run's own samples. A state that cannot be read is passed over.

use super::recorded_run::Recording;
use crate::measure::{FlowHistory, LEFT_OUT, MeanFlow, sample_and_surface};

/// The mean flow of a recording on its way.
#[derive(Default)]
pub struct FlowSurvey {
    /// States that were read.
    read: usize,
    history: FlowHistory,
}

impl FlowSurvey {
    /// Reads the next state of `recording`; says whether there was one.
    pub fn measure_next(&mut self, recording: &Recording) -> bool {
        if self.read >= recording.moments().len() {
            return false;
        }
        if let Ok(state) = recording.state(self.read) {
            let (sample, surface) = sample_and_surface(&state.world);
            if let Some(surface) = surface {
                self.history.add(&state.world, &sample, &surface);
            }
        }
        self.read += 1;
        true
    }

    /// States that were read.
    pub fn read(&self) -> usize {
        self.read
    }

    /// The mean over those of them that count in results of `recording`, as of a run.
    pub fn mean(&self, recording: &Recording) -> MeanFlow {
        let end = recording.moments().last().map_or(0.0, |last| last.time);
        self.history.mean_since(LEFT_OUT * end)
    }
}
