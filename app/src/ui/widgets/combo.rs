//! A choice from a list, with its name beside it.
//!
//! In: the name, what is chosen, what there is to choose. Out: the choice.

use crate::ui::widgets::focus::follow_focus;
use bevy_egui::egui::{self, ComboBox, Key, WidgetInfo, WidgetType};

/// Height of the open list before it scrolls [points]: most lists are shown whole.
const LIST_HEIGHT: f32 = 400.0;

/// Draws a list with the name `label` beside it, in which `chosen` is the text of what is chosen
/// and `choices` draws what there is to choose.
pub fn combo_ui(ui: &mut egui::Ui, label: &str, chosen: &str, choices: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        ui.label(label);
        let list = ComboBox::from_id_salt(label)
            .selected_text(chosen)
            .width(ui.available_width() - 8.0)
            .height(LIST_HEIGHT);
        list_ui(ui, label, list, choices);
    });
}

/// Draws `list`, called `label`, in which `choices` draws what there is to choose. The list scrolls
/// to where the focus goes, and closes when something is chosen, by the pointer or by a key.
pub fn list_ui(
    ui: &mut egui::Ui,
    label: &str,
    list: ComboBox,
    choices: impl FnOnce(&mut egui::Ui),
) -> egui::Response {
    let list = list.show_ui(ui, |ui| {
        choices(ui);
        follow_focus(ui);
        let focused = ui.memory(egui::Memory::focused);
        let focused = focused.and_then(|id| ui.ctx().read_response(id));
        let is_here = focused.is_some_and(|entry| entry.layer_id == ui.layer_id());
        let chooses = |input: &egui::InputState| {
            input.key_pressed(Key::Enter) || input.key_pressed(Key::Space)
        };
        if is_here && ui.input(chooses) {
            ui.close();
        }
    });
    (list.response).widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, label));
    list.response
}
