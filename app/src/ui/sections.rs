//! Panels one under the other on a side of the dock, each open or folded under its title.
//!
//! In: the panels of the side and the simulation. Out: what the panels ask for, and where a person
//! wants them to stand. A panel that opens is scrolled into view.

use crate::simulation::Simulation;
use crate::ui::arrangement::{Rearrangement, Side};
use crate::ui::panel::Panel;
use crate::ui::request::Request;
use crate::ui::widgets::focus::follow_focus;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, CollapsingHeader, RichText, ScrollArea, WidgetInfo, WidgetType};

/// Width of the button that opens the menu of a panel's place [points].
const MENU_WIDTH: f32 = 24.0;

/// A panel in its place.
pub struct Section {
    /// What stands in it.
    pub panel: Box<dyn Panel>,
    open_at_first: bool,
    /// Whether it should open and take the focus in the next frame.
    pub is_wanted: bool,
    /// Whether it is to be open or closed from the next frame on, whatever it was.
    pub is_to_be_open: Option<bool>,
    /// Whether it is left out until somebody asks for it.
    pub is_closed: bool,
    /// How far it was open in the last frame, 0 … 1.
    openness: f32,
}

impl Section {
    /// Whether it was open in the last frame.
    pub fn is_open(&self) -> bool {
        self.openness > 0.5
    }

    /// Whether it is to be seen, open or folded.
    pub fn is_shown(&self, simulation: &Simulation) -> bool {
        !self.is_closed && self.panel.applies_to(simulation)
    }
}

/// The section of `panel`, open at first or not.
pub fn section(panel: impl Panel, open_at_first: bool) -> Section {
    Section {
        panel: Box::new(panel),
        open_at_first,
        is_wanted: false,
        is_to_be_open: None,
        is_closed: false,
        openness: 1.0,
    }
}

/// Draws the `sections` of a `side` from top to bottom; those that do not apply to `simulation` are
/// left out, and those that are closed.
pub fn sections_ui(
    ui: &mut egui::Ui,
    (side, sections): (Side, &mut [Section]),
    simulation: &Simulation,
    view: &mut ViewSettings,
    out: &mut Vec<Request>,
) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        // Room for the scroll bar, so that it never lies over a number.
        ui.set_width(ui.available_width() - 6.0);
        let mut opening = None;
        for section in sections {
            if !section.is_shown(simulation) {
                continue;
            }
            // With two runs side by side most panels describe the one that was clicked on last.
            let of = match simulation.comparison() {
                Some(_) if section.panel.describes_one_run() => {
                    format!(" · {}", view.focus.label())
                }
                _ => String::new(),
            };
            let name = section.panel.title();
            let title = RichText::new(format!("{name}{of}")).strong().size(17.0);
            let is_wanted = std::mem::take(&mut section.is_wanted);
            let summoned = section.panel.wants_open(view) || is_wanted;
            // In another kind of scene it is another panel, open or not.
            let comes_first = section.panel.comes_first(simulation);
            let shown = CollapsingHeader::new(title)
                .id_salt((name, comes_first))
                .default_open(section.open_at_first || comes_first)
                .open(summoned.then_some(true).or(section.is_to_be_open.take()))
                .show_unindented(ui, |ui| section.panel.ui(ui, simulation, view, out));
            place_ui(ui, &shown.header_response, (side, name), out);
            if is_wanted {
                shown.header_response.request_focus();
            }
            if shown.openness > section.openness || is_wanted {
                opening = Some(whole(&shown));
            }
            section.openness = shown.openness;
        }
        // The last wish to scroll counts: a panel that opens has its title focused too.
        match opening {
            Some(panel) => show_whole(ui, panel),
            None => follow_focus(ui),
        }
    });
}

/// A menu at the right end of a panel's `title`, and under the right button of the pointer on it, by
/// which the panel called `name` goes elsewhere.
fn place_ui(
    ui: &mut egui::Ui,
    title: &egui::Response,
    (side, name): (Side, &'static str),
    out: &mut Vec<Request>,
) {
    let entries = [
        ("Up".to_owned(), Rearrangement::Up(name)),
        ("Down".to_owned(), Rearrangement::Down(name)),
        (
            format!("To the {} side", side.other().label()),
            Rearrangement::Across(name),
        ),
        ("Close".to_owned(), Rearrangement::Close(name)),
    ];
    let mut menu = |ui: &mut egui::Ui| {
        for (label, asked) in &entries {
            if ui.button(label).clicked() {
                out.push(Request::Arrange(*asked));
                ui.close();
            }
        }
    };
    title.context_menu(&mut menu);
    let size = egui::vec2(MENU_WIDTH, title.rect.height());
    // A title is as wide as its text; the menus stand one below the other.
    let whole = title.rect.with_max_x(ui.max_rect().right());
    let corner = egui::Align2::RIGHT_TOP.align_size_within_rect(size, whole);
    let mut aside = ui.new_child(egui::UiBuilder::new().max_rect(corner));
    let button = egui::Button::new("☰").frame(false).min_size(size);
    let button = egui::containers::menu::MenuButton::from_button(button).ui(&mut aside, menu);
    let hint = "Where this panel stands; closed, it is found in View, Panels";
    let response = button.0.on_hover_text(hint);
    let label = || format!("Place of {name}");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, label()));
}

/// The place of a panel's title and of as much of it as is open.
fn whole<R>(panel: &egui::CollapsingResponse<R>) -> egui::Rect {
    let title = panel.header_response.rect;
    let body = panel.body_response.as_ref();
    body.map_or(title, |body| title.union(body.rect))
}

/// Scrolls as far as it takes to see all of a panel that opens, or its upper part where it is
/// higher than the window.
fn show_whole(ui: &egui::Ui, panel: egui::Rect) {
    let is_higher = panel.height() > ui.clip_rect().height();
    ui.scroll_to_rect(panel, is_higher.then_some(egui::Align::Min));
}
