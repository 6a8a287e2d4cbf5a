//! What a panel is: a part of the window in one file, one struct and one function.
//!
//! In: the simulation, read only, and the view's settings. Out: requests. What kinds of scenes
//! panels tell apart stands here too. Which panels there are is the dock's business.

use crate::simulation::Simulation;
use crate::ui::request::Request;
use crate::view::ViewSettings;
use bevy_egui::egui;
use grainfall::lab::RunView;
use grainfall::measure::Measure;
use grainfall::run::Parameter;
use grainfall::world::{Shape, World};

/// A part of the window: one file, one struct, one function.
pub trait Panel: Send + Sync + 'static {
    /// What stands over it.
    fn title(&self) -> &'static str;

    /// Whether it applies to this simulation; a panel that does not is left out.
    fn applies_to(&self, _simulation: &Simulation) -> bool {
        true
    }

    /// Whether it is one of the first things to look at in this simulation: then it is open until a
    /// person closes it.
    fn comes_first(&self, _simulation: &Simulation) -> bool {
        false
    }

    /// Whether it should open now, though a person has not opened it.
    fn wants_open(&mut self, _view: &ViewSettings) -> bool {
        false
    }

    /// Whether it describes one run: of two side by side, the one that was clicked on last.
    fn describes_one_run(&self) -> bool {
        false
    }

    /// Makes it show `parameter`, where the panel shows one parameter.
    fn take_up(&mut self, _parameter: &Parameter) {}

    /// What a person chose in it, for a session to keep, in its own words; empty where there is
    /// nothing to choose.
    fn choices(&self) -> String {
        String::new()
    }

    /// Takes up `choices` as it stated them; what it does not know changes nothing.
    fn take_choices(&mut self, _choices: &str) {}

    /// Draws it; what is asked for goes into `out`.
    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    );
}

/// Whether a column collapses in this simulation.
pub fn is_column(simulation: &RunView) -> bool {
    let column = |world: &World| matches!(world.container.shape, Shape::Column { .. });
    simulation.world().is_some_and(|world| column(world))
}

/// Whether neither a bed nor a column is there to look at: then where the energy goes tells most of
/// the grains.
pub fn energy_comes_first(simulation: &RunView) -> bool {
    !has_bed(simulation) && !is_column(simulation)
}

/// Whether grains lie in a bed, whose surface is measured.
pub fn has_bed(simulation: &RunView) -> bool {
    let world = simulation.world();
    world.is_some_and(|world| Measure::SurfaceAngle.applies_to(world))
}
