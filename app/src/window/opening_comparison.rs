//! The second run that a window opens with, beside the first.
//!
//! In: a live parameter and its value, from the command line. Out: both runs side by side as soon
//! as the first one stands, or the reason why not.

use crate::simulation::Simulation;
use crate::ui::Dock;
use bevy::prelude::*;
use grainfall::lab::LabCommand;
use grainfall::parameters::{Parameter, Value};

/// A second run that the window opens with.
#[derive(Resource)]
pub(super) struct OpeningComparison {
    /// What to begin with; none once it has begun.
    pub(super) wanted: Option<(Parameter, Value)>,
    /// Why there is none.
    pub(super) refused: Option<String>,
}

/// Begins the second run as soon as the first one stands.
pub(super) fn begin_comparison(
    mut comparison: ResMut<OpeningComparison>,
    simulation: Option<ResMut<Simulation>>,
    mut dock: ResMut<Dock>,
) {
    let Some(mut simulation) = simulation.filter(|simulation| simulation.can_compare()) else {
        return;
    };
    if let Some((parameter, value)) = comparison.bypass_change_detection().wanted.take() {
        match simulation.check_comparison(&parameter, value) {
            Ok(()) => simulation.send(LabCommand::Compare { parameter, value }),
            Err(reason) => {
                dock.notify(reason.as_str());
                comparison.refused = Some(reason);
            }
        }
    }
}
