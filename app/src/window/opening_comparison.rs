//! The second run that a window opens with, beside the first.
//!
//! In: a live parameter and its value, from the command line. Out: both runs side by side as soon
//! as the first one stands, or the reason why not.

use crate::simulation::Simulation;
use crate::ui::Dock;
use bevy::prelude::*;
use grainfall::lab::LabCommand;
use grainfall::parameters::{Parameter, Value};
use grainfall::run::Command;

/// A second run that the window opens with.
#[derive(Resource)]
pub(super) struct OpeningComparison {
    /// What to begin with; none once it has begun.
    pub(super) wanted: Option<(Parameter, Value)>,
    /// Whether both go on by themselves: the first has not moved before, and leaves no run behind.
    pub(super) is_played: bool,
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
            Ok(()) => {
                simulation.send(LabCommand::Compare { parameter, value });
                if comparison.is_played {
                    simulation.send(Command::Play);
                }
            }
            Err(reason) => {
                dock.notify(reason.as_str());
                comparison.refused = Some(reason);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::lab::{DriverKind, Options, Status};
    use grainfall::run::BedStore;
    use grainfall::scene::Scene;
    use std::time::Duration;

    #[test]
    fn two_runs_begin_together_and_leave_none_behind() {
        let options = Options {
            driver: DriverKind::Inline,
            threads: 1,
            autoplay: false,
            beds: BedStore::none(),
            ..Options::window()
        };
        let scene = Scene::open("bouncing-grain").unwrap();
        let mut app = App::new();
        app.insert_resource(Simulation::open(scene, options))
            .insert_resource(Dock::default())
            .insert_resource(OpeningComparison {
                wanted: Some((Parameter::Gravity, 1.62.into())),
                is_played: true,
                refused: None,
            })
            .add_systems(Update, begin_comparison);
        for _ in 0..200 {
            app.update();
            let mut simulation = app.world_mut().resource_mut::<Simulation>();
            simulation.tick(Duration::from_millis(16));
        }
        let simulation = app.world().resource::<Simulation>();
        assert!(simulation.comparison().is_some());
        assert_eq!(*simulation.status(), Status::Running);
        assert!(simulation.past().end.step > 0);
        assert_eq!(simulation.past().kept.len(), 0);
    }
}
