//! One line to type: the moment to go to, or the name of a run.
//!
//! In: the simulation. Out: the request that goes with what was typed, or why there is none.

use crate::simulation::Simulation;
use crate::ui::dialogs::dialog::dialog_ui;
use crate::ui::playback::{allows, go_to};
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::field::number_of;
use crate::ui::widgets::focus::{begin_to_type, is_entered};
use crate::ui::words::number;
use bevy_egui::egui::{self, TextEdit};
use grainfall::lab::Half;
use grainfall::run::{BranchNames, Command};

/// Width of the dialog [points].
const WIDTH: f32 = 420.0;

/// A line that is being typed.
pub struct TypedLine {
    wanted: Wanted,
    text: String,
    /// Whether the field has not been drawn yet.
    is_new: bool,
}

/// What the line is to say.
#[derive(Clone, Copy)]
enum Wanted {
    Moment,
    /// The name of the run of this number.
    Name {
        half: Half,
        number: u32,
    },
}

impl TypedLine {
    /// The moment to go to, at first the one that is shown.
    pub fn moment(simulation: &Simulation) -> Self {
        let shown = simulation.world().map_or(0.0, |world| world.time());
        Self::of(Wanted::Moment, number::trimmed((shown * 1e6).round() / 1e6))
    }

    /// The name of the run in `half`, at first the one that a person gave it.
    pub fn name(simulation: &Simulation, half: Half) -> Self {
        let past = simulation.half(half).past();
        let number = past.number;
        let name = past.names.of(number).unwrap_or_default();
        Self::of(Wanted::Name { half, number }, name.to_owned())
    }

    fn of(wanted: Wanted, text: String) -> Self {
        Self {
            wanted,
            text,
            is_new: true,
        }
    }

    /// Draws it over everything; false once it is answered or closed.
    pub fn ui(
        &mut self,
        ctx: &egui::Context,
        simulation: Option<&Simulation>,
        out: &mut Vec<Request>,
    ) -> bool {
        let title = match self.wanted {
            Wanted::Moment => "Go to a moment",
            Wanted::Name { .. } => "Name the run that is shown",
        };
        let (is_over, is_left) = dialog_ui(ctx, title, WIDTH, |ui| {
            ui.heading(title);
            let is_entered = self.field_ui(ui);
            let outlook = simulation
                .ok_or_else(|| "There is no run".to_owned())
                .and_then(|simulation| self.outlook(simulation));
            match &outlook {
                Ok((_, words)) => ui.weak(words),
                Err(reason) => ui.colored_label(Palette::of(ui.visuals()).warning, reason),
            };
            ui.add_space(4.0);
            self.answers_ui(ui, outlook, is_entered, out)
        });
        !(is_over || is_left)
    }

    /// The field; whether somebody has pressed Enter in it.
    fn field_ui(&mut self, ui: &mut egui::Ui) -> bool {
        let (label, unit, width) = match self.wanted {
            Wanted::Moment => ("Time", "s", 120.0),
            Wanted::Name { .. } => ("Name", "", f32::INFINITY),
        };
        ui.horizontal(|ui| {
            let label = ui.label(label);
            let mut field = TextEdit::singleline(&mut self.text)
                .desired_width(width)
                .char_limit(BranchNames::LONGEST)
                .show(ui);
            let is_new = std::mem::take(&mut self.is_new);
            begin_to_type(ui, &mut field, &self.text, is_new);
            ui.label(unit);
            is_entered(&field.response.response.labelled_by(label.id))
        })
        .inner
    }

    /// What is asked for with the line as it is, and that in words; or why nothing can be.
    fn outlook(&self, simulation: &Simulation) -> Result<(Request, String), String> {
        match self.wanted {
            Wanted::Moment => moment(&self.text, simulation),
            Wanted::Name { half, number } => {
                let name = self.text.trim().to_owned();
                let words = if name.is_empty() {
                    "Without a name it is called by what differs in it"
                } else {
                    "It is called so in plots, lists, exports and beside the timeline"
                };
                let request = Request::NameRun { half, number, name };
                Ok((request, words.to_owned()))
            }
        }
    }

    /// The buttons; whether the line is answered or left.
    fn answers_ui(
        &self,
        ui: &mut egui::Ui,
        outlook: Result<(Request, String), String>,
        is_entered: bool,
        out: &mut Vec<Request>,
    ) -> bool {
        let verb = match self.wanted {
            Wanted::Moment => "Go",
            Wanted::Name { .. } => "Name it",
        };
        ui.horizontal(|ui| {
            let why_not = outlook.as_ref().err().map(String::as_str);
            let is_done = button_unless_ui(ui, why_not, egui::Button::new(verb)).clicked();
            let is_left = ui.button("Cancel").clicked();
            match outlook {
                Ok((request, _)) if is_done || is_entered => {
                    out.push(request);
                    true
                }
                _ => is_left,
            }
        })
        .inner
    }
}

/// The request that shows the moment in `text`, and what that takes.
fn moment(text: &str, simulation: &Simulation) -> Result<(Request, String), String> {
    let end = simulation.past().end;
    let last = match simulation.recording() {
        Some(_) => end.time,
        None => f64::INFINITY,
    };
    let time = number_of("The time", text, &(0.0..=last), "s")?;
    let command = go_to(simulation, time).filter(|command| allows(simulation.status(), command));
    let command = command.ok_or_else(|| "There is no run yet".to_owned())?;
    let newest = number::moment(end.time);
    let words = match command {
        Command::Step(_) => format!("The run goes on to it from {newest}"),
        _ if time > end.time => format!("The run has come to {newest}, which is shown"),
        _ => "The run was there".to_owned(),
    };
    Ok((Request::Command(command), words))
}
