//! What acts from the next start on: sizes, materials, time step, seed; and the button that starts
//! with it.
//!
//! In: the simulation's scene, and that scene as it was opened. Out: a request to start afresh with
//! a changed scene.

use crate::simulation::Simulation;
use crate::ui::request::{Request, SweepAct};
use crate::ui::theme::Palette;
use crate::ui::widgets::row_button::sweep_button_ui;
use crate::ui::widgets::value_row::{ValueRow, value_ui};
use crate::ui::words::number;
use bevy_egui::egui::{self, RichText};
use grainfall::parameters::{Kind, Parameter, ParameterInfo, start_parameters};
use grainfall::scene::Scene;

/// What acts from the next start on.
#[derive(Default)]
pub struct StartValues {
    /// The values there are, once they were asked for.
    list: Vec<ParameterInfo>,
    /// The scene with what was changed.
    draft: Option<Scene>,
    /// Why the last change was refused.
    refusal: Option<String>,
}

impl StartValues {
    /// How many of them are others than in the scene as it was opened.
    pub fn changed(&mut self, simulation: &Simulation) -> usize {
        if self.list.is_empty() {
            self.list = start_parameters(simulation.original());
        }
        let scene = self.draft.as_ref().unwrap_or(simulation.scene());
        let changed = |info: &&ParameterInfo| differs(info, scene, simulation.original());
        self.list.iter().filter(changed).count()
    }

    /// Brings back all that the scene had as it was opened; in the run they are from the next start
    /// on.
    pub fn reset(&mut self, simulation: &Simulation) {
        let original = Some((**simulation.original()).clone());
        self.draft = original.filter(|original| original != simulation.scene());
        self.refusal = None;
    }

    /// Draws a row for each.
    pub fn rows_ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let scene = simulation.scene();
        ui.add_space(6.0);
        ui.label(RichText::new("From the next start on").strong());
        for info in &self.list {
            let draft = self.draft.as_ref().unwrap_or(scene);
            let Some(value) = info.parameter.in_effect(draft) else {
                continue;
            };
            let value = value.number();
            let is_given = differs(info, draft, simulation.original());
            let mut swept = false;
            let wanted = row_ui(ui, info, value, is_given, |ui| {
                // Seeds are asked for beside any other parameter.
                let is_seed = info.parameter == Parameter::Seed;
                swept = !is_seed && sweep_button_ui(ui, &info.label);
            });
            out.extend(swept.then(|| Request::Sweep(SweepAct::Ask(Some(info.parameter.clone())))));
            if let Some(wanted) = wanted {
                let mut changed = draft.clone();
                let stated = info.parameter.stated(simulation.original());
                let original = stated.filter(|_| wanted == info.default.number());
                let wanted = original.unwrap_or(info.row().value(wanted));
                let outcome = info.parameter.state(wanted, &mut changed);
                self.refusal = outcome.err().map(|error| error.to_string());
                if self.refusal.is_none() {
                    self.draft = Some(changed).filter(|changed| changed != scene);
                }
            }
        }
    }

    /// Draws what became of the last change, and the button that starts with all of them.
    pub fn footer_ui(&mut self, ui: &mut egui::Ui, out: &mut Vec<Request>) {
        let palette = Palette::of(ui.visuals());
        if let Some(refusal) = &self.refusal {
            ui.colored_label(palette.warning, format!("Left as it was: {refusal}"));
        }
        let Some(draft) = &self.draft else {
            return;
        };
        ui.colored_label(palette.warning, "Changed, and not yet in the run.");
        let mut forgotten = false;
        ui.horizontal(|ui| {
            let start = ui.button("Start with these");
            let start = start.on_hover_text(
                "A new run from time zero with these values and the present ones of the others",
            );
            if start.clicked() {
                out.push(Request::Start(Box::new(draft.clone())));
            }
            forgotten = ui
                .button("Forget these")
                .on_hover_text("Back to the values of the present run")
                .clicked();
        });
        if forgotten {
            *self = Self::default();
        }
    }
}

/// Whether somebody gave `scene` another value than the `original` has; a time step that follows
/// from the rest is nobody's.
fn differs(info: &ParameterInfo, scene: &Scene, original: &Scene) -> bool {
    info.parameter.stated(scene) != info.parameter.stated(original)
}

/// The row of a start value, which somebody gave the scene or which it had, with what is drawn
/// `beside` its field; what is wanted instead, if anything.
fn row_ui(
    ui: &mut egui::Ui,
    info: &ParameterInfo,
    value: f64,
    is_given: bool,
    beside: impl FnOnce(&mut egui::Ui),
) -> Option<f64> {
    let name = number::capitalised(&info.label);
    let (own, default) = (info.row(), info.default.number());
    let range = info.range();
    let mut row = ValueRow {
        label: &info.label,
        name: &name,
        symbol: own.symbol,
        default: if is_given { default } else { value },
        display: own.kind.unit().shown,
        is_logarithmic: own.is_logarithmic(&range),
        is_whole: own.kind == Kind::Count,
        presets: &[],
        caption: None,
        range,
    };
    let extent = row.extent();
    row.caption = Some(format!("{extent} · acts at the next start"));
    value_ui(ui, &row, value, beside, |ui| {
        ui.label(own.description);
        ui.weak(&extent);
        ui.weak("It acts when the run is started with it.");
    })
}
