//! A parameter sweep: what is measured over several values of one parameter, run in the background
//! from the scene as it is now.
//!
//! In: the simulation, and the sweep that runs. Out: requests to start and to stop it, and to open
//! one of its runs.

mod answer;
mod form;
mod progress;

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::request::Request;
use crate::ui::sweep_desk::{SweepDesk, SweepSeen};
use crate::view::ViewSettings;
use answer::Answer;
use bevy_egui::egui;
use form::Form;
use grainfall::parameters::Parameter;

/// The panel.
pub struct ParameterSweep {
    desk: SweepDesk,
    form: Form,
    answer: Answer,
}

impl ParameterSweep {
    /// What stands over it.
    pub const TITLE: &'static str = "Parameter sweep";

    /// The panel of the sweep on this `desk`.
    pub fn of(desk: &SweepDesk) -> Self {
        Self {
            desk: desk.clone(),
            form: Form::default(),
            answer: Answer::default(),
        }
    }
}

impl Panel for ParameterSweep {
    fn title(&self) -> &'static str {
        Self::TITLE
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        simulation.recording().is_none() || self.desk.seen().is_some()
    }

    fn take_up(&mut self, parameter: &Parameter) {
        self.form.take_up(parameter);
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let seen = self.desk.seen();
        let is_running = seen.as_ref().is_some_and(SweepSeen::is_running);
        if simulation.recording().is_none() {
            self.form.ui(ui, simulation, &self.desk, is_running, out);
        }
        if let Some(seen) = &seen {
            ui.separator();
            progress::progress_ui(ui, seen, out);
            self.answer.ui(ui, seen, simulation, out);
            progress::report_ui(ui, seen);
        }
        if is_running {
            // It goes on whether or not anything else moves.
            ui.ctx()
                .request_repaint_after(std::time::Duration::from_millis(100));
        }
    }
}
