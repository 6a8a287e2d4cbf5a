//! Where a run stood, kept in memory or in a file.
//!
//! In: what a run is at a moment. Out: the same again. A [`Snapshot`] leaves out the commands and
//! samples before it, which its branch has; a [`Checkpoint`] holds them. Going on from either is
//! the run's work.

use super::StampedCommand;
use super::meetings::Meeting;
use super::orientations::Turned;
use super::sampling::Sampling;
use crate::measure::{FlowHistory, FlowProfile, Series};
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Where a run stood: all it takes to go on from there, together with the run's commands and
/// samples until then.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    pub(super) world: World,
    pub(super) commands: usize,
    pub(super) samples: usize,
    #[serde(with = "super::shared")]
    pub(super) flow: Arc<FlowHistory>,
    /// In a file as it was before samples followed what happens; the rest stands apart there.
    #[serde(with = "on_grid")]
    pub(super) sampling: Sampling,
    /// How far spheres have turned, where that is followed; stands apart in a file, too.
    #[serde(skip)]
    pub(super) turned: Option<Turned>,
}

impl Snapshot {
    /// Steps taken then.
    pub fn step(&self) -> u64 {
        self.world.clock.step
    }

    /// Commands carried out until then.
    pub fn commands(&self) -> usize {
        self.commands
    }

    /// The state then.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The same with the shapes of polyhedra that `shapes_of` has.
    pub(crate) fn sharing(mut self, shapes_of: Option<&World>) -> Self {
        let shapes = shapes_of.and_then(|world| Some(world.polyhedra.as_ref()?.shapes.clone()));
        if let Some(polyhedra) = &mut self.world.polyhedra {
            polyhedra.shapes = shapes.unwrap_or_else(|| Arc::new([]));
        }
        self
    }

    /// Memory that it takes beside the run that it is of [bytes].
    pub fn memory(&self) -> usize {
        let turned = self.turned.as_deref().map_or(0, size_of_val);
        self.world.memory() + self.flow.own_memory() + turned
    }
}

/// A run as a file can keep it: all it takes to go on in another process, to the same bits. What
/// only ever becomes more, samples and profiles of seconds that are over, is kept apart from the
/// rest.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    pub(super) world: World,
    pub(super) commands: Vec<StampedCommand>,
    #[serde(skip)]
    pub(super) series: Arc<Series>,
    #[serde(with = "super::shared")]
    pub(super) flow: Arc<FlowHistory>,
    /// Stands behind the rest in a file.
    #[serde(skip)]
    pub(super) meetings: Arc<Vec<Meeting>>,
    pub(super) sampling: Sampling,
}

/// What a [`Checkpoint`] without its samples is read from.
#[derive(Serialize)]
pub struct CheckpointParts<'a> {
    world: &'a World,
    commands: &'a [StampedCommand],
    flow: &'a FlowHistory,
    sampling: Sampling,
}

impl<'a> CheckpointParts<'a> {
    /// Those of the state `world` at the end of a run that had these `commands` and this `flow` and
    /// took its samples by `sampling`.
    pub fn of(
        world: &'a World,
        commands: &'a [StampedCommand],
        sampling: Sampling,
        flow: &'a FlowHistory,
    ) -> Self {
        Self {
            world,
            commands,
            flow,
            sampling,
        }
    }
}

impl Checkpoint {
    /// The state at which the run goes on.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The samples of the run until then.
    pub fn series(&self) -> &Series {
        &self.series
    }

    /// How many commands were carried out until then.
    pub fn command_count(&self) -> usize {
        self.commands.len()
    }

    /// The same with the samples of the run until then, the profiles of its flowing layer in the
    /// first seconds and its meetings, which are kept apart.
    #[must_use]
    pub fn with_measured(
        self,
        series: Series,
        seconds: Vec<FlowProfile>,
        meetings: Vec<Meeting>,
    ) -> Self {
        let rest = Arc::unwrap_or_clone(self.flow).counted_from(seconds.len());
        Self {
            series: Arc::new(series),
            flow: Arc::new(rest.behind(seconds)),
            meetings: Arc::new(meetings),
            ..self
        }
    }
}

/// The sampling of a state in a file: the index of the grid's next sample.
mod on_grid {
    use super::Sampling;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(sampling: &Sampling, to: S) -> Result<S::Ok, S::Error> {
        sampling.grid().serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Sampling, D::Error> {
        u64::deserialize(from).map(Sampling::on_grid)
    }
}
