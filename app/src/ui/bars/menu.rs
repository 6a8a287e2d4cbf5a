//! The menu bar: files, undo and redo, the comparison of two runs, the view, help.
//!
//! In: the simulation, the files opened last, which sides and panels are shown. Out: requests; an entry that
//! cannot act now says why. What an entry does is not decided here.

use crate::simulation::Simulation;
use crate::ui::arrangement::{OpenSides, Rearrangement, why_not_both};
use crate::ui::bars::time_slider::why_no_undo;
use crate::ui::panels::picture_settings::MEASURED_HINT;
use crate::ui::request::{Request, Sheet, SweepAct};
use crate::ui::screenshot_orders::PictureOf;
use crate::ui::shortcuts::keys_for;
use crate::ui::text_size;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::focus::follow_focus;
use crate::ui::words::number;
use crate::view::{Background, CameraRequest, ProjectionKind, StandardView, ViewSettings};
use bevy_egui::egui::{self, ScrollArea};
use grainfall::lab::Half;
use grainfall::lesson::built_in_lessons;
use grainfall::run::Command;
use grainfall::scene::built_in;

/// Width of the View menu, in points: its longest entry fits.
const VIEW_WIDTH: f32 = 250.0;
/// Height of what stands round a list in a menu, with some air [points].
const ROUND_A_LIST: f32 = 120.0;

/// What the menus say of what is shown.
pub struct Shown<'a> {
    /// Files opened last.
    pub recent: &'a [String],
    /// Which sides are shown.
    pub sides: &'a mut OpenSides,
    /// The panels that this simulation has, by their titles, and whether each is shown.
    pub panels: Vec<(&'static str, bool)>,
    /// Whether it takes the keyboard's focus.
    pub takes_focus: bool,
}

/// Draws the menu bar; `rest` is drawn at its right end, from right to left.
pub fn menu_ui(
    ui: &mut egui::Ui,
    simulation: Option<&Simulation>,
    shown: &mut Shown,
    view: &mut ViewSettings,
    out: &mut Vec<Request>,
    rest: impl FnOnce(&mut egui::Ui),
) {
    egui::MenuBar::new().ui(ui, |ui| {
        let file = ui.menu_button("File", |ui| file_ui(ui, simulation, shown.recent, out));
        if shown.takes_focus {
            file.response.request_focus();
        }
        ui.menu_button("Edit", |ui| edit_ui(ui, simulation, out));
        ui.menu_button("View", |ui| view_ui(ui, shown, view, out));
        ui.menu_button("Help", |ui| {
            item_ui(ui, "Shortcuts", Request::Show(Sheet::Shortcuts), out);
            item_ui(ui, "About Grainfall", Request::Show(Sheet::About), out);
        });
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), rest);
    });
}

fn file_ui(
    ui: &mut egui::Ui,
    simulation: Option<&Simulation>,
    recent: &[String],
    out: &mut Vec<Request>,
) {
    item_ui(ui, "Scenes…", Request::ShowScenes, out);
    item_ui(ui, "Open…", Request::ChooseFile, out);
    ui.menu_button("Lessons", |ui| {
        for lesson in built_in_lessons() {
            item_ui(ui, lesson.name, Request::Open(lesson.name.into()), out);
        }
    });
    ui.menu_button("Built-in scenes", |ui| {
        for scene in built_in() {
            item_ui(ui, scene.name, Request::Open(scene.name.into()), out);
        }
    });
    ui.menu_button("Recent", |ui| {
        for name in recent {
            item_ui(ui, name, Request::Open(name.clone()), out);
        }
        if recent.is_empty() {
            ui.weak("Nothing was opened yet");
        }
    });
    ui.separator();
    let why_not = simulation.is_none().then_some("There is no run to save");
    let as_another = Request::ChooseSession;
    item_unless_ui(ui, "Save the session", Request::Save, why_not, out);
    item_unless_ui(ui, "Save the session as…", as_another, why_not, out);
    item_ui(ui, "Save the list of changes…", Request::ChooseChanges, out);
    for (name, of) in [
        ("Screenshot…", PictureOf::Window),
        ("Picture of the grains…", PictureOf::Grains),
        ("Picture without a background…", PictureOf::CutOut),
    ] {
        item_ui(ui, name, Request::ChoosePicture(of), out);
    }
    ui.add_enabled_ui(simulation.is_some(), |ui| {
        item_ui(ui, "Record a film…", Request::ChooseFilm, out);
    });
    ui.separator();
    item_ui(ui, "Quit", Request::Quit, out);
}

fn edit_ui(ui: &mut egui::Ui, simulation: Option<&Simulation>, out: &mut Vec<Request>) {
    let comparison = simulation.and_then(|simulation| simulation.comparison());
    let [undo, redo] = simulation.map_or([None; 2], |simulation| simulation.undo_and_redo());
    let entries = [("Undo", Command::Undo, undo), ("Redo", Command::Redo, redo)];
    for (name, command, what) in entries {
        let nothing = simulation.map_or("There is no run", why_no_undo);
        let why_not = what.is_none().then(|| number::capitalised(nothing));
        item_unless_ui(ui, name, Request::Command(command), why_not.as_deref(), out);
    }
    let why_not = simulation.is_none().then_some("There is no run");
    item_unless_ui(ui, "Go to a moment…", Request::TypeMoment, why_not, out);
    item_unless_ui(ui, "Name the run…", Request::TypeName, why_not, out);
    ui.separator();
    let why_not = simulation.is_none().then_some("There is no run to compare");
    let compare = Request::Compare(None);
    item_unless_ui(ui, "Compare two values…", compare, why_not, out);
    let sweep = Request::Sweep(SweepAct::Ask(None));
    item_unless_ui(ui, "Run over values…", sweep, why_not, out);
    let why_not = comparison.is_none().then_some("There is one run only");
    for half in Half::ALL {
        let name = format!("End the comparison, keep the {} run", half.label());
        item_unless_ui(ui, &name, Request::EndComparison(half), why_not, out);
    }
}

fn view_ui(ui: &mut egui::Ui, shown: &mut Shown, view: &mut ViewSettings, out: &mut Vec<Request>) {
    ui.set_width(VIEW_WIDTH);
    item_ui(ui, "Fit", Request::Camera(CameraRequest::Fit), out);
    item_ui(ui, "Home", Request::Camera(CameraRequest::Home), out);
    ui.menu_button("Look from", |ui| {
        for side in StandardView::ALL {
            let look = CameraRequest::From(side);
            item_ui(ui, side.label(), Request::Camera(look), out);
        }
    });
    ui.separator();
    item_ui(ui, "Ruler", Request::Ruler, out);
    let mut parallel = view.projection == ProjectionKind::Orthographic;
    if ui.checkbox(&mut parallel, "Parallel projection").changed() {
        view.projection = if parallel {
            ProjectionKind::Orthographic
        } else {
            ProjectionKind::Perspective
        };
    }
    let mut light = view.background == Background::Light;
    if ui
        .checkbox(&mut light, "Light, for projectors and print")
        .changed()
    {
        view.background = if light {
            Background::Light
        } else {
            Background::Dark
        };
    }
    ui.checkbox(&mut view.show_measured, "Show what is measured")
        .on_hover_text(MEASURED_HINT);
    ui.separator();
    item_ui(ui, "Present", Request::Present, out);
    item_ui(ui, "Full screen", Request::FullScreen, out);
    ui.checkbox(&mut shown.sides.left, "Controls on the left");
    ui.checkbox(&mut shown.sides.right, "Plots and results on the right");
    if let Some(reason) = why_not_both(ui.ctx().content_rect().width()) {
        // Menus spread their text over the whole width.
        ui.vertical(|ui| ui.weak(reason));
    }
    ui.menu_button("Panels", |ui| panels_ui(ui, &shown.panels, out));
    ui.menu_button("Size of text and controls", text_size::menu_ui);
}

/// Which panels are shown; their places are changed in the menus at their titles.
fn panels_ui(ui: &mut egui::Ui, panels: &[(&'static str, bool)], out: &mut Vec<Request>) {
    let height = ui.ctx().content_rect().height() - ROUND_A_LIST;
    ScrollArea::vertical().max_height(height).show(ui, |ui| {
        for (title, is_shown) in panels {
            let mut shows = *is_shown;
            if ui.checkbox(&mut shows, *title).changed() {
                out.push(Request::Arrange(if shows {
                    Rearrangement::Show(title)
                } else {
                    Rearrangement::Close(title)
                }));
            }
        }
        follow_focus(ui);
    });
    ui.separator();
    let at_first = Request::Arrange(Rearrangement::AsAtFirst);
    item_ui(ui, "All as at first", at_first, out);
}

/// An entry that asks for `request`, with its shortcut.
fn item_ui(ui: &mut egui::Ui, name: &str, request: Request, out: &mut Vec<Request>) {
    item_unless_ui(ui, name, request, None, out);
}

/// The same, disabled where there is a reason why not; hovering over it shows the reason.
fn item_unless_ui(
    ui: &mut egui::Ui,
    name: &str,
    request: Request,
    why_not: Option<&str>,
    out: &mut Vec<Request>,
) {
    let keys = keys_for(ui.ctx(), &request);
    let button = egui::Button::new(name).shortcut_text(keys);
    if button_unless_ui(ui, why_not, button).clicked() {
        out.push(request);
        ui.close();
    }
}
