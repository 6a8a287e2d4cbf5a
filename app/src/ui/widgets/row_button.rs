//! A small button in the row of a parameter: a sign, which has a name for screen readers.

use bevy_egui::egui::{self, WidgetInfo, WidgetType};

/// The sign of the button that leads to a parameter sweep.
const CURVE: &str = "📈";

/// Draws the button with this `sign`, called `name`, which says under the pointer what it does, or
/// why not; whether it was pressed.
pub fn row_button_ui(
    ui: &mut egui::Ui,
    sign: &str,
    name: &str,
    hint: &str,
    why_not: Option<&str>,
) -> bool {
    let enabled = why_not.is_none();
    let button = ui.add_enabled(enabled, egui::Button::new(sign).frame(false));
    let button = button
        .on_hover_text(hint)
        .on_disabled_hover_text(why_not.unwrap_or_default());
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, enabled, name));
    button.clicked()
}

/// Draws the button that leads to runs over values of what is called `label`; whether it was
/// pressed.
pub fn sweep_button_ui(ui: &mut egui::Ui, label: &str) -> bool {
    let name = format!("Run over values of {label}…");
    let hint = "Run over several values of it in the background, and see what follows…";
    row_button_ui(ui, CURVE, &name, hint, None)
}
