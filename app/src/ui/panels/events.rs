//! What happened in the run and when: a list to search, to sift by kind and to jump by.
//!
//! In: the events of the run. Out: requests to show their moments. Rows are made for the part of
//! the list in view alone.

use crate::simulation::Simulation;
use crate::ui::event_kinds::EventKinds;
use crate::ui::panel::Panel;
use crate::ui::playback::{Way, seek, to_event};
use crate::ui::request::Request;
use crate::ui::words::events::event_in_words;
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, ScrollArea, WidgetInfo, WidgetType};
use grainfall::lab::{Half, RunView};
use grainfall::run::{Event, EventKind};

/// Height of the list before it scrolls, in points.
const LIST_HEIGHT: f32 = 240.0;

/// The panel.
#[derive(Default)]
pub struct Events {
    search: String,
    kinds: EventKinds,
    /// Whether the kinds are those of a session that were not yet taken up.
    is_restored: bool,
    /// What the list was made of.
    made_of: Option<(u64, EventKinds, String)>,
    /// Indices of the events that it shows.
    listed: Vec<usize>,
    /// The row of the moment shown when it was last drawn.
    present: Option<usize>,
}

impl Panel for Events {
    fn title(&self) -> &'static str {
        "Events"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn choices(&self) -> String {
        self.kinds.in_words()
    }

    fn take_choices(&mut self, choices: &str) {
        (self.kinds, self.is_restored) = (EventKinds::read(choices), true);
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        if !std::mem::take(&mut self.is_restored) {
            self.kinds = EventKinds::of(ui.ctx());
        }
        let run = simulation.half(view.focus);
        if run.events().is_empty() {
            ui.weak("Impacts, bridges, avalanches and changes are listed here as they happen.");
        } else {
            self.kinds_ui(ui, run.events());
            self.search_ui(ui, simulation, view.focus, out);
            self.list(run);
            self.list_ui(ui, run, out);
        }
        self.kinds.choose(ui.ctx());
    }
}

impl Events {
    /// Which of the kinds that there are, and how many of each, are shown.
    fn kinds_ui(&mut self, ui: &mut egui::Ui, events: &[Event]) {
        ui.horizontal_wrapped(|ui| {
            for kind in EventKind::ALL {
                let count = events.iter().filter(|event| event.kind() == kind).count();
                if count > 0 {
                    let text = format!("{} {count}", kind.name());
                    ui.toggle_value(self.kinds.shown_mut(kind), text)
                        .on_hover_text("Show or hide them, here and on the time slider");
                }
            }
        });
    }

    /// The ways to the events before and after, and what is searched for.
    fn search_ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        half: Half,
        out: &mut Vec<Request>,
    ) {
        ui.horizontal(|ui| {
            for (face, name, way, key) in [
                ("⏴", "Event before", Way::Back, "Shift+E"),
                ("⏵", "Next event", Way::On, "E"),
            ] {
                let request = to_event(simulation, half, self.kinds, way);
                let enabled = request.is_some();
                let button = ui.add_enabled(enabled, egui::Button::new(face));
                button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, enabled, name));
                if button.on_hover_text(format!("{name} ({key})")).clicked() {
                    out.extend(request);
                }
            }
            let width = ui.available_width();
            let field = egui::TextEdit::singleline(&mut self.search)
                .hint_text("Search")
                .desired_width(width);
            let response = ui.add(field);
            let text = self.search.clone();
            response.widget_info(|| {
                let mut info = WidgetInfo::text_edit(true, "", &text, "Search");
                info.label = Some("Search events".into());
                info
            });
        });
    }

    /// Makes the list where it is another one.
    fn list(&mut self, run: &RunView) {
        let made_of = (run.events_revision(), self.kinds, self.search.clone());
        if self.made_of.as_ref() == Some(&made_of) {
            return;
        }
        let words = self.search.to_lowercase();
        let is_found = |event: &Event| {
            let text = || line(event, run).to_lowercase();
            words.is_empty() || words.split_whitespace().all(|word| text().contains(word))
        };
        let events = run.events().iter().enumerate();
        let listed = events.filter(|(_, event)| self.kinds.show(event.kind()) && is_found(event));
        self.listed = listed.map(|(index, _)| index).collect();
        self.made_of = Some(made_of);
    }

    fn list_ui(&mut self, ui: &mut egui::Ui, run: &RunView, out: &mut Vec<Request>) {
        if self.listed.is_empty() {
            ui.weak("No event is of these kinds and has these words.");
            return;
        }
        let Some(times) = run.step_times() else {
            return;
        };
        let (events, shown) = (run.events(), times.time_at(run.step()));
        let is_past = |index: &usize| times.step_at(events[*index].time) <= run.step();
        let past = self.listed.partition_point(is_past);
        let present = past.checked_sub(1);
        let height = ui.spacing().interact_size.y;
        let mut area = ScrollArea::vertical()
            .id_salt("events")
            .max_height(LIST_HEIGHT)
            .auto_shrink([false, true]);
        if present != self.present {
            // The row of the moment shown stays in the middle.
            let row = present.unwrap_or(0) as f32 * (height + ui.spacing().item_spacing.y);
            area = area.vertical_scroll_offset((row - 0.5 * LIST_HEIGHT).max(0.0));
            self.present = present;
        }
        area.show_rows(ui, height, self.listed.len(), |ui, rows| {
            for row in rows {
                let event = &events[self.listed[row]];
                let clicked = row_ui(ui, &line(event, run), present == Some(row), row < past);
                if clicked && event.time != shown {
                    out.extend(seek(run, event.time));
                }
            }
        });
    }
}

/// `49.80 ms  grain 0 and floor meet at 612.0 mm/s`.
fn line(event: &Event, run: &RunView) -> String {
    let time = number::moment(event.time);
    format!("{time}  {}", event_in_words(event, run))
}

/// A row of the list; whether it was clicked.
fn row_ui(ui: &mut egui::Ui, text: &str, is_present: bool, is_past: bool) -> bool {
    let coloured = if is_past {
        RichText::new(text)
    } else {
        RichText::new(text).weak().italics()
    };
    let row = egui::Button::selectable(is_present, coloured)
        .truncate()
        .min_size(egui::vec2(ui.available_width(), 0.0));
    let hint = if is_past {
        "Show this moment"
    } else {
        "Comes after the moment shown. Show this moment"
    };
    let response = ui.add(row);
    response.on_hover_text(format!("{text}\n{hint}")).clicked()
}
