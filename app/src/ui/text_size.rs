//! How large text and controls are: as the window's size asks for, or as somebody chose.
//!
//! In: the window's size, keys, entries of a menu. Out: egui's zoom factor. A window of 3840 × 2160
//! shows everything twice as large as one of 1920 × 1080, so that it looks the same on the wall;
//! smaller windows show it as it is designed.

use bevy_egui::egui::gui_zoom::kb_shortcuts::{ZOOM_IN, ZOOM_IN_SECONDARY, ZOOM_OUT, ZOOM_RESET};
use bevy_egui::egui::{self, Id, KeyboardShortcut, Vec2, vec2};
use std::ops::RangeInclusive;

/// Sizes of text and controls, over their usual one, that somebody can work with.
pub const SCALES: RangeInclusive<f32> = 0.2..=5.0;
/// The largest window in which text has its usual size [logical pixels].
const USUAL: Vec2 = vec2(1920.0, 1080.0);
/// Sizes by the window are multiples of this: text keeps its size while a window is drawn a little
/// larger.
const STEP: f32 = 0.25;
/// So many wishes for more make everything larger by its usual size.
const WISHES: f32 = 10.0;

/// What somebody wishes of the size of text and controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wish {
    Larger,
    Smaller,
    ByWindow,
}

impl Wish {
    const ALL: [Self; 3] = [Self::Larger, Self::Smaller, Self::ByWindow];

    fn label(self) -> &'static str {
        match self {
            Self::Larger => "Larger",
            Self::Smaller => "Smaller",
            Self::ByWindow => "As large as suits the window",
        }
    }

    fn keys(self) -> &'static [KeyboardShortcut] {
        match self {
            Self::Larger => &[ZOOM_IN, ZOOM_IN_SECONDARY],
            Self::Smaller => &[ZOOM_OUT],
            Self::ByWindow => &[ZOOM_RESET],
        }
    }

    fn fulfil(self, ctx: &egui::Context) {
        let by = |steps: f32| {
            let scale = (WISHES * ctx.zoom_factor() + steps).round() / WISHES;
            Some(scale.clamp(*SCALES.start(), *SCALES.end()))
        };
        let scale = match self {
            Self::Larger => by(1.0),
            Self::Smaller => by(-1.0),
            Self::ByWindow => None,
        };
        choose(ctx, scale);
    }
}

/// The size that suits a window of this `size` [logical pixels].
pub fn by_window(size: Vec2) -> f32 {
    let times = (size / USUAL).min_elem();
    let steps = (times / STEP).round() * STEP;
    steps.clamp(1.0, *SCALES.end())
}

/// The size that somebody chose, if anybody did.
pub fn chosen(ctx: &egui::Context) -> Option<f32> {
    ctx.data(|data| data.get_temp(id())).flatten()
}

/// Chooses a size, or leaves it to the window.
pub fn choose(ctx: &egui::Context, scale: Option<f32>) {
    ctx.data_mut(|data| data.insert_temp(id(), scale));
}

/// Reads the keys and shows everything as large as was chosen, or as suits a `window` of this size
/// [logical pixels].
pub fn follow(ctx: &egui::Context, window: Option<Vec2>) {
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    for wish in Wish::ALL {
        let is_pressed = |keys: &KeyboardShortcut| ctx.input_mut(|i| i.consume_shortcut(keys));
        if wish.keys().iter().any(is_pressed) {
            wish.fulfil(ctx);
        }
    }
    let suited = || window.map_or(1.0, by_window);
    ctx.set_zoom_factor(chosen(ctx).unwrap_or_else(suited));
}

/// The entries of a menu.
pub fn menu_ui(ui: &mut egui::Ui) {
    let ctx = ui.ctx().clone();
    ui.weak(format!(
        "Text and controls: {:.0} %",
        100.0 * ctx.zoom_factor()
    ));
    for wish in Wish::ALL {
        let keys = ctx.format_shortcut(&wish.keys()[0]);
        let entry = egui::Button::new(wish.label()).shortcut_text(keys);
        let is_so = wish == Wish::ByWindow && chosen(&ctx).is_none();
        if ui.add(entry.selected(is_so)).clicked() {
            wish.fulfil(&ctx);
        }
    }
}

fn id() -> Id {
    Id::new("text size")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_times_the_pixels_show_text_twice_as_large() {
        for (width, height, scale) in [
            (800.0, 600.0, 1.0),
            (1440.0, 900.0, 1.0),
            (1920.0, 1080.0, 1.0),
            (2560.0, 1440.0, 1.25),
            (3840.0, 2160.0, 2.0),
            // With the bars of a desktop.
            (3840.0, 2070.0, 2.0),
            // Wide but no higher: no more fits one below the other.
            (3840.0, 1080.0, 1.0),
        ] {
            assert_eq!(by_window(vec2(width, height)), scale, "{width} × {height}");
        }
    }
}
