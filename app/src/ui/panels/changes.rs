//! What was changed and when, and the runs that were left for others.
//!
//! In: the simulation. Out: requests to show a moment, to take up or to forget a run, to save the
//! list.

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::plots::run_curves::line_sample_ui;
use crate::ui::request::Request;
use crate::ui::theme::{Palette, dash};
use crate::ui::words::number;
use crate::ui::words::run_names::{parameter_name, setting_in_words, value_in_words};
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, ScrollArea};
use grainfall::lab::{Half, RunView};
use grainfall::parameters::Parameter;
use grainfall::run::{Branch, Command, changes};

/// Height of the list of changes before it scrolls, in points.
const LIST_HEIGHT: f32 = 170.0;

/// The panel.
#[derive(Default)]
pub struct ChangeList {
    rows: Vec<ChangeRow>,
    /// The revision of the commands of both runs that the rows were made of.
    revision: [u64; 2],
}

/// One change in words.
struct ChangeRow {
    step: u64,
    time: f64,
    text: String,
}

impl Panel for ChangeList {
    fn title(&self) -> &'static str {
        "Changes and runs"
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let revision = Half::ALL.map(|half| simulation.half(half).revision());
        if self.revision != revision {
            self.revision = revision;
            self.rows = rows(simulation);
        }
        if self.rows.is_empty() {
            ui.weak("What you change is listed here, and can be taken back with Ctrl+Z.");
        } else {
            self.list_ui(ui, simulation, out);
            let save = ui.button("Save the list…").on_hover_text(
                "A file that repeats this run without a window: --no-render --commands FILE",
            );
            if save.clicked() {
                out.push(Request::ChooseChanges);
            }
        }
        kept_runs_ui(ui, simulation, out);
    }
}

impl ChangeList {
    fn list_ui(&self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let shown = simulation.step();
        ScrollArea::vertical()
            .id_salt("changes")
            .max_height(LIST_HEIGHT)
            .stick_to_bottom(true)
            .show(ui, |ui| {
                for row in &self.rows {
                    let text = format!("{}  {}", number::moment(row.time), row.text);
                    let coloured = if row.step <= shown {
                        RichText::new(&text)
                    } else {
                        RichText::new(&text).weak().italics()
                    };
                    let line = egui::Button::new(coloured).frame(false).truncate();
                    let hint = if row.step <= shown {
                        "Show this moment"
                    } else {
                        "Comes after the moment shown. Show this moment"
                    };
                    if ui
                        .add(line)
                        .on_hover_text(format!("{text}\n{hint}"))
                        .clicked()
                    {
                        out.push(Request::Command(Command::Seek(row.step)));
                    }
                }
            });
    }
}

/// The changes of the present run in words. Of two runs side by side: also the changes on the right
/// of the parameter in which they differ.
fn rows(simulation: &Simulation) -> Vec<ChangeRow> {
    let mut rows = rows_of(simulation, |_| true);
    if let Some(comparison) = simulation.comparison() {
        let own = rows_of(comparison.right, |parameter| {
            parameter == comparison.parameter
        });
        rows.extend(own.into_iter().map(|row| ChangeRow {
            text: format!("{}: {}", Half::Right.label(), row.text),
            ..row
        }));
        rows.sort_by_key(|row| row.step);
    }
    rows
}

/// The changes of one run in words; only those of parameters that are `listed`.
fn rows_of(simulation: &RunView, listed: impl Fn(&Parameter) -> bool) -> Vec<ChangeRow> {
    let rows = changes(simulation.each_change()).into_iter();
    let rows = rows.map(|change| ChangeRow {
        step: change.step,
        time: change.time,
        text: (change.set.iter())
            .filter(|setting| listed(&setting.parameter))
            .map(|setting| setting_in_words(setting, simulation))
            .collect::<Vec<_>>()
            .join(", "),
    });
    rows.filter(|row| !row.text.is_empty()).collect()
}

/// The runs that were left for others.
fn kept_runs_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
    let past = simulation.past();
    if past.kept.is_empty() {
        return;
    }
    ui.add_space(4.0);
    ui.label(RichText::new(format!("Beside the present run, run {}", past.number)).strong());
    let palette = Palette::of(ui.visuals());
    for (index, record) in past.kept.iter().enumerate() {
        ui.horizontal(|ui| {
            let stroke = egui::Stroke::new(1.6, palette.kept);
            line_sample_ui(ui, Some(dash(index)), stroke);
            let name = format!("Run {}", record.number);
            ui.label(&name).on_hover_text(describe(record, simulation));
            ui.weak(format!("to {}", number::moment(record.end.time)));
            let buttons = [
                ("Show", "Take this run up again", Command::Return(index)),
                ("Forget", "Keep this run no longer", Command::Forget(index)),
            ];
            for (verb, hint, command) in buttons {
                let enabled = simulation.comparison().is_none() || verb == "Forget";
                let button = egui::Button::new(verb).small();
                let response = ui.add_enabled(enabled, button).on_hover_text(hint);
                let response = response.on_disabled_hover_text(OF_ONE_RUN);
                let label = format!("{verb} {}", name.to_lowercase());
                response.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::WidgetType::Button, enabled, &label)
                });
                if response.clicked() {
                    out.push(Request::Command(command));
                }
            }
        });
    }
}

/// The last change of a kept run, which tells it from the others.
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

/// Why kept runs have to wait.
pub const OF_ONE_RUN: &str = "Two runs stand side by side, and it would take the place of one of them: end the comparison first";
