//! The mean velocity of the flowing layer over the depth below the surface, with its standard error.
//!
//! In: the run, or the recording that is played. Out: its plot; of a recording whose run wrote no
//! profile, the request to measure one on its states. The numbers are those of `flow.csv`.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, has_bed};
use crate::ui::plots::axes::fitting_plot;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use egui_plot::Line;
use grainfall::lab::RunView;
use grainfall::measure::{LEFT_OUT, MeanFlow};
use std::sync::Arc;

const MILLIMETRES: f64 = 1e3;

/// The panel of the mean flow.
#[derive(Default)]
pub struct FlowOverDepth {
    drawn: Option<Drawn>,
}

/// What is drawn of a run and what it was made of.
struct Drawn {
    key: (u64, u32, usize),
    flow: Arc<MeanFlow>,
}

impl Panel for FlowOverDepth {
    fn title(&self) -> &'static str {
        "Flow over depth"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        has_bed(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let flow = self.flow_of(run);
        let states = simulation
            .recording()
            .map(|recording| recording.moments.len());
        let read = run.recorded_flow().map(|flow| flow.read);
        match (states, read) {
            (Some(states), None) => return ask_ui(ui, states, out),
            (Some(states), Some(Some(read))) if read < states => {
                ui.weak(format!("{read} of {states} states are read."));
            }
            _ => {}
        }
        if flow.depths.iter().all(|depth| depth.samples == 0) {
            ui.weak("The bed has not flowed in the part of the run that results count.");
            return;
        }
        plot_ui(ui, &flow);
        let from = number::moment(LEFT_OUT * run.past().end.time);
        let note = match read {
            Some(Some(_)) => {
                format!("Measured on the states from {from} on in which the bed flows.")
            }
            _ => format!(
                "Mean over the samples from {from} on in which the bed flows; dashed: one standard error."
            ),
        };
        ui.label(RichText::new(note).small().weak());
    }
}

impl FlowOverDepth {
    /// The mean flow of `run`, made anew where something was added.
    fn flow_of(&mut self, run: &RunView) -> Arc<MeanFlow> {
        if run.recorded_flow().is_some() {
            return run.mean_flow();
        }
        let key = (run.id(), run.past().number, run.series().len());
        if self.drawn.as_ref().is_some_and(|drawn| drawn.key != key) {
            self.drawn = None;
        }
        let make = || Drawn {
            key,
            flow: run.mean_flow(),
        };
        self.drawn.get_or_insert_with(make).flow.clone()
    }
}

/// Offers to measure on as many `states` what a run did not write.
fn ask_ui(ui: &mut egui::Ui, states: usize, out: &mut Vec<Request>) {
    ui.weak("The run wrote no profile: it is under way, was stopped, or its bed did not flow.");
    let button = ui.button(format!("Measure it on the {states} states"));
    let hint = "Every state is read once. They lie further apart than a run's own samples";
    if button.on_hover_text(hint).clicked() {
        out.push(Request::MeasureFlow);
    }
}

fn plot_ui(ui: &mut egui::Ui, flow: &MeanFlow) {
    let palette = Palette::of(ui.visuals());
    ui.label(RichText::new("Velocity along the surface [mm/s], over depth [mm]").strong());
    let [mean, lower, upper] = curves(flow);
    fitting_plot(ui, "flow over depth").show(ui, |plot| {
        let dashed = egui_plot::LineStyle::dashed_dense();
        for bound in [lower, upper] {
            let line = Line::new("one standard error", bound);
            plot.line(line.color(palette.angle).width(1.0).style(dashed));
        }
        plot.line(Line::new("mean", mean).color(palette.angle).width(1.8));
    });
}

/// The mean and its two bounds, depth [mm] and velocity [mm/s]; bounds where there is an error.
fn curves(flow: &MeanFlow) -> [Vec<[f64; 2]>; 3] {
    let known = || flow.depths.iter().filter(|depth| depth.samples > 0);
    let at = |depth: f64, velocity: f64| [MILLIMETRES * depth, MILLIMETRES * velocity];
    let bound = |sign: f64| {
        let bounds = known().filter_map(|d| Some(at(d.depth, d.velocity + sign * d.error?)));
        bounds.collect()
    };
    let mean = known().map(|d| at(d.depth, d.velocity)).collect();
    [mean, bound(-1.0), bound(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::measure::FlowDepth;

    #[test]
    fn curves_hold_what_was_averaged_in_millimetres() {
        let depth = |depth, velocity, error, samples| FlowDepth {
            depth,
            velocity,
            error,
            samples,
        };
        let flow = MeanFlow {
            depths: vec![
                depth(0.0, 0.25, Some(0.125), 7),
                depth(0.5, 0.125, None, 2),
                depth(1.0, f64::NAN, None, 0),
            ],
        };
        let [mean, lower, upper] = curves(&flow);
        assert_eq!(mean, [[0.0, 250.0], [500.0, 125.0]]);
        assert_eq!((lower, upper), (vec![[0.0, 125.0]], vec![[0.0, 375.0]]));
    }
}
