//! What acts from the next start on: sizes, materials, time step, seed; and the button that starts with it.
//!
//! In: the simulation's scene, and that scene as it was opened. Out: a request to start afresh with a changed scene.

use crate::scene::Scene;
use crate::simulation::{Simulation, StartInfo, start_parameters};
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::value_row::{Value, value_ui};
use crate::ui::words::number;
use bevy_egui::egui::{self, RichText};

/// What acts from the next start on.
#[derive(Default)]
pub struct StartValues {
    /// The values there are, once they were asked for.
    list: Vec<StartInfo>,
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
        let changed = |info: &&StartInfo| info.parameter.differs(scene, simulation.original());
        self.list.iter().filter(changed).count()
    }

    /// Brings back all that the scene had as it was opened; in the run they are from the next start on.
    pub fn reset(&mut self, simulation: &Simulation) {
        let original = Some((**simulation.original()).clone());
        self.draft = original.filter(|original| original != simulation.scene());
        self.refusal = None;
    }

    /// Draws a row for each.
    pub fn rows_ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation) {
        let scene = simulation.scene();
        ui.add_space(6.0);
        ui.label(RichText::new("From the next start on").strong());
        for info in &self.list {
            let draft = self.draft.as_ref().unwrap_or(scene);
            let Some(value) = info.parameter.read(draft) else {
                continue;
            };
            let is_given = info.parameter.differs(draft, simulation.original());
            if let Some(wanted) = row_ui(ui, info, value, is_given) {
                let mut changed = draft.clone();
                let outcome = if wanted == info.value {
                    (info.parameter).restore(simulation.original(), &mut changed)
                } else {
                    info.parameter.write(wanted, &mut changed)
                };
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

/// The row of a start value, which somebody gave the scene or which it had; what is wanted instead, if anything.
fn row_ui(ui: &mut egui::Ui, info: &StartInfo, value: f64, is_given: bool) -> Option<f64> {
    let name = number::capitalised(&info.label);
    let mut row = Value {
        label: &info.label,
        name: &name,
        symbol: info.symbol,
        range: info.range.clone(),
        default: if is_given { info.value } else { value },
        display: info.display,
        is_logarithmic: *info.range.start() > 0.0 && info.range.end() / info.range.start() > 20.0,
        is_whole: info.is_whole,
        landmarks: &[],
        caption: None,
    };
    let extent = row.extent();
    row.caption = Some(format!("{extent} · acts at the next start"));
    value_ui(
        ui,
        &row,
        value,
        |_| (),
        |ui| {
            ui.label(info.description);
            ui.weak(&extent);
            ui.weak("It acts when the run is started with it.");
        },
    )
}
