//! What was changed and when, and below it the runs that there are.
//!
//! In: the simulation. Out: requests to show a moment, to save the list, and those about runs.

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::panels::run_list::RunList;
use crate::ui::request::Request;
use crate::ui::words::names::setting_in_words;
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, ScrollArea};
use grainfall::lab::{Half, RunView};
use grainfall::parameters::Parameter;
use grainfall::run::{Command, changes};

/// Height of the list of changes before it scrolls, in points.
const LIST_HEIGHT: f32 = 170.0;

/// The panel.
#[derive(Default)]
pub struct ChangeList {
    rows: Vec<ChangeRow>,
    /// The revision of the commands of both runs that the rows were made of.
    revision: [u64; 2],
    runs: RunList,
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
        self.runs.ui(ui, simulation, out);
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
