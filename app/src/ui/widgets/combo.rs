//! A choice from a list, with its name beside it.
//!
//! In: the name, what is chosen, what there is to choose. Out: the choice.

use bevy_egui::egui::{self, WidgetInfo, WidgetType};

/// Height of the open list before it scrolls [points]: most lists are shown whole.
const LIST_HEIGHT: f32 = 400.0;

/// Draws a list with the name `label` beside it, in which `chosen` is the text of what is chosen
/// and `choices` draws what there is to choose.
pub fn combo_ui(ui: &mut egui::Ui, label: &str, chosen: &str, choices: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        ui.label(label);
        let response = egui::ComboBox::from_id_salt(label)
            .selected_text(chosen)
            .width(ui.available_width() - 8.0)
            .height(LIST_HEIGHT)
            .show_ui(ui, choices)
            .response;
        response.widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, label));
    });
}
