//! A button that says why it cannot be pressed.
//!
//! In: the button, and the reason why not, if there is one. Out: egui's response.

use bevy_egui::egui;

/// Adds `button`, disabled where there is a reason `why_not`, which hovering over it then shows.
pub fn button_unless_ui(
    ui: &mut egui::Ui,
    why_not: Option<&str>,
    button: egui::Button,
) -> egui::Response {
    let response = ui.add_enabled(why_not.is_none(), button);
    match why_not {
        Some(reason) => response.on_disabled_hover_text(reason),
        None => response,
    }
}
