//! The runs that there are: the present ones and those that were left for others, each with its name,
//! which can be changed.
//!
//! In: the simulation. Out: requests to take up, to forget or to name a run.

use crate::simulation::Simulation;
use crate::ui::plots::run_curves::line_sample_ui;
use crate::ui::request::Request;
use crate::ui::theme::{COMPARED_DASH, Palette, dash};
use crate::ui::widgets::focus::begin_to_type;
use crate::ui::words::names::{parameter_name, value_in_words};
use crate::ui::words::number;
use crate::ui::words::run_names::RunNames;
use bevy_egui::egui::{self, Key, RichText, Stroke, WidgetInfo, WidgetType};
use grainfall::lab::{Half, RunView};
use grainfall::run::{Branch, BranchNames, Command};

/// Why kept runs have to wait.
const OF_ONE_RUN: &str = "Two runs stand side by side, and it would take the place of one of them: end the comparison first";
/// How a name is changed.
const RENAME: &str = "Double-click, or ✏, to call it something else";
/// Width of the field in which it is, in points.
const FIELD_WIDTH: f32 = 190.0;
/// Room for the pencil behind a name, in points.
const ROOM_FOR_PENCIL: f32 = 36.0;

/// The list.
#[derive(Default)]
pub struct RunList {
    edited: Option<Edited>,
    /// The run of which the pencil takes the focus again, after its name was changed by keys.
    left: Option<Place>,
}

/// A name that is being changed.
struct Edited {
    run: Place,
    /// What it was before.
    before: String,
    text: String,
    /// Whether the field has not been drawn yet.
    is_new: bool,
}

/// Where a run is: in whose list, and its number there.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Place {
    half: Half,
    number: u32,
}

impl RunList {
    /// Draws it; nothing while there is one run only, which nobody named.
    pub fn ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let past = simulation.past();
        let is_pair = simulation.comparison().is_some();
        if past.kept.is_empty() && !is_pair && past.names.of(past.number).is_none() {
            return;
        }
        ui.add_space(4.0);
        ui.label(RichText::new("Runs").strong());
        let names = RunNames::of(simulation);
        for half in Half::ALL.into_iter().take(1 + usize::from(is_pair)) {
            self.present_ui(ui, simulation, half, &names, out);
        }
        // Those that the right one has are known to the plots alone.
        for (index, (name, branch)) in names.kept.iter().enumerate().take(past.kept.len()) {
            self.kept_ui(ui, simulation, (index, name, branch), out);
        }
    }

    /// The row of the run that is shown in `half`.
    fn present_ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        half: Half,
        names: &RunNames,
        out: &mut Vec<Request>,
    ) {
        let palette = Palette::of(ui.visuals());
        let (dash, colour) = match half {
            Half::Left => (None, ui.visuals().text_color()),
            Half::Right => (Some(COMPARED_DASH), palette.compared),
        };
        let number = simulation.half(half).past().number;
        ui.horizontal_wrapped(|ui| {
            line_sample_ui(ui, dash, Stroke::new(1.8, colour));
            let hint = "The run that is shown";
            self.name_ui(ui, Place { half, number }, names.present(half), hint, out);
            if simulation.comparison().is_some() {
                ui.weak(half.label());
            }
        });
    }

    /// The row of the kept run of this index.
    fn kept_ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        (index, name, branch): (usize, &str, &Branch),
        out: &mut Vec<Request>,
    ) {
        let palette = Palette::of(ui.visuals());
        ui.horizontal_wrapped(|ui| {
            line_sample_ui(ui, Some(dash(index)), Stroke::new(1.6, palette.kept));
            let place = Place {
                half: Half::Left,
                number: branch.number,
            };
            self.name_ui(ui, place, name, &describe(branch, simulation), out);
            let until = RichText::new(format!("to {}", number::moment(branch.end.time)));
            ui.add(egui::Label::new(until.weak()).extend());
            let buttons = [
                ("Show", "Take this run up again", Command::Return(index)),
                ("Forget", "Keep this run no longer", Command::Forget(index)),
            ];
            for (verb, hint, command) in buttons {
                let enabled = simulation.comparison().is_none() || verb == "Forget";
                let button = egui::Button::new(verb).small();
                let response = ui.add_enabled(enabled, button).on_hover_text(hint);
                let response = response.on_disabled_hover_text(OF_ONE_RUN);
                let label = format!("{verb} {name}");
                response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, enabled, &label));
                if response.clicked() {
                    out.push(Request::Command(command));
                }
            }
        });
    }

    /// The name of a run, or the field in which it is changed.
    fn name_ui(
        &mut self,
        ui: &mut egui::Ui,
        run: Place,
        name: &str,
        hint: &str,
        out: &mut Vec<Request>,
    ) {
        if self.edited.as_ref().is_some_and(|edited| edited.run == run) {
            return self.field_ui(ui, out);
        }
        let label = egui::Label::new(name)
            .sense(egui::Sense::click())
            .truncate();
        // A long one leaves room for what stands behind it.
        let room = (ui.available_size_before_wrap().x - ROOM_FOR_PENCIL).max(ROOM_FOR_PENCIL);
        let label = ui.scope(|ui| {
            ui.set_max_width(room);
            ui.add(label.show_tooltip_when_elided(false))
        });
        let label = (label.inner).on_hover_text(format!("{name}\n{hint}\n{RENAME}"));
        let pencil = ui.add(egui::Button::new("✏").small().frame(false));
        let action = format!("Rename {name}");
        pencil.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &action));
        if self.left == Some(run) {
            pencil.request_focus();
            self.left = None;
        }
        if label.double_clicked() || pencil.on_hover_text(RENAME).clicked() {
            self.edited = Some(Edited {
                run,
                before: name.to_owned(),
                text: name.to_owned(),
                is_new: true,
            });
        }
    }

    /// The field: Enter, or a click elsewhere, takes the name; Esc leaves it as it was. Without a
    /// name the run is called by what differs in it again.
    fn field_ui(&mut self, ui: &mut egui::Ui, out: &mut Vec<Request>) {
        let Some(edited) = &mut self.edited else {
            return;
        };
        let mut field = edited.ui(ui);
        let is_new = std::mem::take(&mut edited.is_new);
        begin_to_type(ui, &mut field, &edited.text, is_new);
        if !is_new && field.response.response.lost_focus() {
            let is_left = ui.input(|input| input.key_pressed(Key::Escape));
            let is_by_key = is_left || ui.input(|input| input.key_pressed(Key::Enter));
            self.left = is_by_key.then_some(edited.run);
            if let Some(Edited {
                run,
                before,
                text: name,
                ..
            }) = self.edited.take()
                && !is_left
                && name != before
            {
                let Place { half, number } = run;
                out.push(Request::NameRun { half, number, name });
            }
        }
    }
}

impl Edited {
    /// Draws the field of the name.
    fn ui(&mut self, ui: &mut egui::Ui) -> egui::text_edit::TextEditOutput {
        let field = egui::TextEdit::singleline(&mut self.text)
            .hint_text("by what differs")
            .char_limit(BranchNames::LONGEST)
            .desired_width(FIELD_WIDTH.min(ui.available_size_before_wrap().x - ROOM_FOR_PENCIL));
        let field = field.show(ui);
        let text = self.text.clone();
        field.response.response.widget_info(|| {
            let mut info = WidgetInfo::text_edit(true, "", &text, "by what differs");
            info.label = Some("Name of the run".into());
            info
        });
        field
    }
}

/// The last change of a kept run.
fn describe(branch: &Branch, simulation: &RunView) -> String {
    let last = branch.history.commands().last();
    let Some((stamped, Command::Set { parameter, value })) =
        last.map(|stamped| (stamped, &stamped.command))
    else {
        return "Nothing was changed in it.".into();
    };
    format!(
        "Its last change: {} {} at {}",
        parameter_name(parameter, simulation),
        value_in_words(parameter, *value),
        number::moment(stamped.time)
    )
}
