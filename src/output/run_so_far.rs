//! What files and results show of a run.

use crate::measure::{
    FlowHistory, LEFT_OUT, Measure, SMALLEST_DROP, Series, Summary, avalanches, results, summarise,
};
use crate::run::{Event, Meeting, Run, Sampling, StampedCommand, events};
use crate::world::World;

/// A run so far, as files and results show it: its present state and what was kept of it until
/// then.
#[derive(Clone, Copy)]
pub struct RunSoFar<'a> {
    /// The state now.
    pub world: &'a World,
    /// The samples so far.
    pub series: &'a Series,
    /// The flowing layer so far.
    pub flow: &'a FlowHistory,
    /// Contacts and bridges of few grains that began and ended.
    pub meetings: &'a [Meeting],
    /// The commands carried out since time zero.
    pub commands: &'a [StampedCommand],
    /// Which samples were taken, and what the next one depends on.
    pub sampling: Sampling,
}

impl<'a> RunSoFar<'a> {
    /// What is seen of `run`.
    pub fn of(run: &'a Run) -> Self {
        Self {
            world: run.world(),
            series: run.series(),
            flow: run.flow(),
            meetings: run.meetings(),
            commands: run.commands(),
            sampling: run.sampling(),
        }
    }

    /// The simulated time from which on results count [s].
    pub fn results_from(&self) -> f64 {
        LEFT_OUT * self.world.time()
    }

    /// What happened so far, each command as a change of its own.
    pub fn events(&self) -> Vec<Event> {
        let angle = self.series.column(Measure::SurfaceAngle);
        let avalanches = avalanches(self.series.time(), angle, SMALLEST_DROP);
        events(
            self.series,
            &avalanches,
            self.meetings,
            self.commands.chunks(1),
        )
    }

    /// The results so far.
    pub fn results(&self) -> Summary {
        let from = self.results_from();
        results(self.series, self.flow, self.world, from, SMALLEST_DROP)
    }

    /// The results of `run`; of one that never stood at time zero, none.
    pub fn results_of(run: Option<Self>) -> Summary {
        match run {
            Some(run) => run.results(),
            None => summarise(&Series::default(), 0.0, SMALLEST_DROP),
        }
    }
}
