//! How the panels look: every colour, size and font of them stands here.
//!
//! In: dark or light. Out: egui's style for the whole window, and a [`Palette`] for what the panels
//! paint themselves. The picture has its own colours in `view`.

use crate::view::{Background, MEASURED_ON_DARK, MEASURED_ON_LIGHT};
use bevy_egui::egui::style::WidgetVisuals;
use bevy_egui::egui::{
    self, Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, TextStyle, Theme,
    Visuals, vec2,
};

/// Size of body text in points: readable at a projector.
const BODY: f32 = 15.5;

/// Colours of what the panels paint themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// The line θ(t).
    pub angle: Color32,
    /// The line Tg(t).
    pub temperature: Color32,
    /// A threshold or another line to compare with.
    pub threshold: Color32,
    /// Where an avalanche starts.
    pub maximum: Color32,
    /// Where an avalanche ends.
    pub minimum: Color32,
    /// When somebody changed a parameter.
    pub change: Color32,
    /// The lines of the run beside the first.
    pub compared: Color32,
    /// Runs that were left for another.
    pub kept: Color32,
    /// Lines behind a plot.
    pub grid: Color32,
    /// Bars, one per stage of a step.
    pub stages: [Color32; 4],
    /// Something to look at.
    pub warning: Color32,
    /// Something that went wrong.
    pub error: Color32,
    /// Behind a message of something that went wrong.
    pub error_fill: Color32,
    /// Over the picture while a file hovers over the window.
    pub veil: Color32,
}

impl Palette {
    /// The palette that goes with `visuals`.
    pub fn of(visuals: &Visuals) -> Self {
        if visuals.dark_mode { DARK } else { LIGHT }
    }
}

const fn rgb([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

const DARK: Palette = Palette {
    angle: rgb(MEASURED_ON_DARK),
    temperature: Color32::from_rgb(0xF4, 0xA2, 0x5B),
    threshold: Color32::from_rgb(0x9A, 0xA5, 0xB4),
    maximum: Color32::from_rgb(0xFF, 0xD5, 0x7A),
    minimum: Color32::from_rgb(0x5F, 0xD3, 0xA8),
    change: Color32::from_rgb(0x9E, 0x8F, 0xD6),
    compared: Color32::from_rgb(0xF2, 0xA9, 0xDC),
    kept: Color32::from_rgb(0xB4, 0xBD, 0xC9),
    grid: Color32::from_rgb(0x3B, 0x45, 0x54),
    stages: [
        Color32::from_rgb(0x6C, 0xB8, 0xF6),
        Color32::from_rgb(0xF4, 0xA2, 0x5B),
        Color32::from_rgb(0x5F, 0xD3, 0xA8),
        Color32::from_rgb(0xB9, 0xA5, 0xEE),
    ],
    warning: Color32::from_rgb(0xFF, 0xC4, 0x5C),
    error: Color32::from_rgb(0xFF, 0x8A, 0x80),
    error_fill: Color32::from_rgb(0x42, 0x22, 0x24),
    veil: Color32::from_rgba_premultiplied(0x0E, 0x1C, 0x2C, 0xC0),
};

const LIGHT: Palette = Palette {
    angle: rgb(MEASURED_ON_LIGHT),
    temperature: Color32::from_rgb(0xA8, 0x4A, 0x06),
    threshold: Color32::from_rgb(0x5D, 0x67, 0x74),
    maximum: Color32::from_rgb(0x8F, 0x5A, 0x00),
    minimum: Color32::from_rgb(0x0A, 0x75, 0x53),
    change: Color32::from_rgb(0x6A, 0x56, 0xB5),
    compared: Color32::from_rgb(0x96, 0x25, 0x77),
    kept: Color32::from_rgb(0x5F, 0x68, 0x74),
    grid: Color32::from_rgb(0xC9, 0xD0, 0xD9),
    stages: [
        Color32::from_rgb(0x2F, 0x86, 0xCB),
        Color32::from_rgb(0xD9, 0x7A, 0x2B),
        Color32::from_rgb(0x2B, 0x9D, 0x78),
        Color32::from_rgb(0x86, 0x72, 0xC9),
    ],
    warning: Color32::from_rgb(0x8F, 0x5E, 0x00),
    error: Color32::from_rgb(0xB3, 0x1B, 0x1B),
    error_fill: Color32::from_rgb(0xFB, 0xE4, 0xE2),
    veil: Color32::from_rgba_premultiplied(0x90, 0x98, 0xA0, 0xA8),
};

/// Length of the dashes of the kept run of `index` on plots, in points, by which kept runs are told
/// apart.
pub fn dash(index: usize) -> f32 {
    const LENGTHS: [f32; 4] = [9.0, 4.0, 16.0, 2.0];
    LENGTHS[index % LENGTHS.len()]
}

/// Length of the dashes of the run beside the first on plots, in points.
pub const COMPARED_DASH: f32 = 7.0;

/// Surfaces and text of one of the two looks.
struct Surfaces {
    panel: Color32,
    window: Color32,
    sunken: Color32,
    stripe: Color32,
    line: Color32,
    button: Color32,
    hovered: Color32,
    pressed: Color32,
    text: Color32,
    strong: Color32,
    weak: Color32,
    accent: Color32,
    accent_text: Color32,
}

const DARK_SURFACES: Surfaces = Surfaces {
    panel: Color32::from_rgb(0x1C, 0x21, 0x2A),
    window: Color32::from_rgb(0x22, 0x28, 0x33),
    sunken: Color32::from_rgb(0x12, 0x16, 0x1C),
    stripe: Color32::from_rgb(0x23, 0x29, 0x34),
    line: Color32::from_rgb(0x36, 0x3F, 0x4D),
    button: Color32::from_rgb(0x31, 0x3A, 0x48),
    hovered: Color32::from_rgb(0x3E, 0x49, 0x5A),
    pressed: Color32::from_rgb(0x4A, 0x58, 0x6D),
    text: Color32::from_rgb(0xD9, 0xDF, 0xE8),
    strong: Color32::from_rgb(0xFA, 0xFB, 0xFD),
    weak: Color32::from_rgb(0x9C, 0xA8, 0xB8),
    accent: Color32::from_rgb(0x2C, 0x6F, 0xA8),
    accent_text: Color32::from_rgb(0xF4, 0xF9, 0xFF),
};

const LIGHT_SURFACES: Surfaces = Surfaces {
    panel: Color32::from_rgb(0xEE, 0xF0, 0xF3),
    window: Color32::from_rgb(0xFA, 0xFB, 0xFC),
    sunken: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    stripe: Color32::from_rgb(0xE5, 0xE8, 0xED),
    line: Color32::from_rgb(0xC3, 0xCA, 0xD3),
    button: Color32::from_rgb(0xDC, 0xE1, 0xE8),
    hovered: Color32::from_rgb(0xCD, 0xD5, 0xDF),
    pressed: Color32::from_rgb(0xBC, 0xC7, 0xD4),
    text: Color32::from_rgb(0x22, 0x2A, 0x35),
    strong: Color32::from_rgb(0x0B, 0x10, 0x18),
    weak: Color32::from_rgb(0x4C, 0x56, 0x63),
    accent: Color32::from_rgb(0x25, 0x70, 0xB0),
    accent_text: Color32::from_rgb(0xFF, 0xFF, 0xFF),
};

/// Gives the whole window its fonts and both looks; which look shows is [`show`]'s choice.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| {
            style.visuals = visuals(theme);
            style.text_styles = text_styles();
            style.animation_time = 0.08;
            style.interaction.selectable_labels = false;
            style.interaction.tooltip_delay = 0.35;
            let spacing = &mut style.spacing;
            spacing.item_spacing = vec2(8.0, 6.0);
            spacing.button_padding = vec2(9.0, 4.0);
            spacing.interact_size = vec2(36.0, 26.0);
            spacing.slider_rail_height = 5.0;
            spacing.icon_width = 17.0;
            spacing.icon_width_inner = 10.0;
            spacing.combo_width = 96.0;
            spacing.indent = 14.0;
            spacing.menu_margin = Margin::same(6);
            spacing.window_margin = Margin::same(16);
            spacing.tooltip_width = 380.0;
        });
    }
}

/// Shows the look that goes with a background of the picture.
pub fn show(ctx: &egui::Context, background: Background) {
    let theme = match background {
        Background::Dark => Theme::Dark,
        Background::Light => Theme::Light,
    };
    if ctx.theme() != theme {
        ctx.set_theme(theme);
    }
}

/// The default fonts; text falls back on the monospaced one for the symbols that only it has: ⟨ ⟩ ⁻
/// ′ →.
fn fonts() -> egui::FontDefinitions {
    let mut fonts = egui::FontDefinitions::default();
    let families = &mut fonts.families;
    let monospace = families.get(&FontFamily::Monospace).cloned();
    let fallback = monospace.and_then(|names| names.into_iter().next());
    if let Some(proportional) = families.get_mut(&FontFamily::Proportional) {
        proportional.extend(fallback);
    }
    fonts
}

fn text_styles() -> std::collections::BTreeMap<TextStyle, FontId> {
    [
        (TextStyle::Small, FontId::proportional(BODY - 2.0)),
        (TextStyle::Body, FontId::proportional(BODY)),
        (TextStyle::Button, FontId::proportional(BODY)),
        (TextStyle::Heading, FontId::proportional(BODY + 4.5)),
        (TextStyle::Monospace, FontId::monospace(BODY - 1.5)),
    ]
    .into()
}

fn visuals(theme: Theme) -> Visuals {
    let (base, s) = match theme {
        Theme::Dark => (Visuals::dark(), DARK_SURFACES),
        Theme::Light => (Visuals::light(), LIGHT_SURFACES),
    };
    let corner_radius = CornerRadius::same(5);
    let palette = Palette::of(&base);
    let widget = |fill: Color32, line: Color32, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, line),
        corner_radius,
        fg_stroke: Stroke::new(1.3, text),
        expansion: 0.0,
    };
    let mut visuals = base;
    visuals.widgets.noninteractive = widget(s.panel, s.line, s.text);
    visuals.widgets.inactive = widget(s.button, Color32::TRANSPARENT, s.text);
    visuals.widgets.hovered = widget(s.hovered, s.weak, s.strong);
    visuals.widgets.active = widget(s.pressed, s.accent, s.strong);
    visuals.widgets.open = widget(s.hovered, s.line, s.strong);
    visuals.selection.bg_fill = s.accent;
    visuals.selection.stroke = Stroke::new(1.3, s.accent_text);
    visuals.panel_fill = s.panel;
    visuals.window_fill = s.window;
    visuals.window_stroke = Stroke::new(1.0, s.line);
    visuals.window_corner_radius = CornerRadius::same(9);
    visuals.menu_corner_radius = CornerRadius::same(7);
    visuals.window_shadow = shadow();
    visuals.popup_shadow = shadow();
    visuals.extreme_bg_color = s.sunken;
    visuals.text_edit_bg_color = Some(s.sunken);
    visuals.code_bg_color = s.sunken;
    visuals.faint_bg_color = s.stripe;
    visuals.weak_text_color = Some(s.weak);
    visuals.hyperlink_color = palette.angle;
    visuals.warn_fg_color = palette.warning;
    visuals.error_fg_color = palette.error;
    visuals.slider_trailing_fill = true;
    visuals.striped = false;
    visuals
}

fn shadow() -> Shadow {
    Shadow {
        offset: [0, 4],
        blur: 16,
        spread: 0,
        color: Color32::from_black_alpha(0x58),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::contrast;

    fn rgb_of(colour: Color32) -> [u8; 3] {
        [colour.r(), colour.g(), colour.b()]
    }

    /// Asserts that all of `inks` are read on all of `grounds`.
    #[track_caller]
    fn assert_read(inks: &[Color32], grounds: &[Color32]) {
        for (ink, ground) in inks
            .iter()
            .flat_map(|ink| grounds.iter().map(move |g| (ink, g)))
        {
            let contrast = contrast(rgb_of(*ink), rgb_of(*ground));
            assert!(contrast >= 4.5, "{ink:?} on {ground:?}: {contrast}");
        }
    }

    #[test]
    fn light_and_dark_are_equally_legible() {
        for (surfaces, palette) in [(DARK_SURFACES, DARK), (LIGHT_SURFACES, LIGHT)] {
            let s = &surfaces;
            let still = [s.panel, s.window, s.sunken, s.stripe];
            assert_read(&[s.text, s.strong, s.weak], &still);
            assert_read(&[s.text, s.strong], &[s.button, s.hovered, s.pressed]);
            assert_read(&[s.accent_text], &[s.accent]);
            let p = &palette;
            let curves = [p.angle, p.temperature, p.threshold, p.maximum, p.minimum];
            assert_read(&curves, &still[..3]);
            let others = [p.change, p.compared, p.kept, p.warning, p.error];
            assert_read(&others, &still[..3]);
            assert_read(&[p.error], &[p.error_fill]);
        }
    }
}
