//! A number to type, to drag, to step with the arrow keys, to set to a named value and to take
//! back: one row of a panel.

use crate::ui::widgets::field;
use crate::ui::widgets::field::Field;
use crate::ui::words::{number, symbol};
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};
use grainfall::parameters::Preset;
use grainfall::physics::DisplayUnit;
use std::ops::RangeInclusive;

/// Width of the field with the number and its unit, in points.
const NUMBER_WIDTH: f32 = 96.0;
/// A slider that is dragged stays at a named value within this share of its length.
const HOLD: f64 = 0.012;

/// What a row needs to know of its number. Values are in SI units.
pub struct ValueRow<'a> {
    /// What screen readers call it, unlike any other.
    pub label: &'a str,
    /// What stands beside it.
    pub name: &'a str,
    /// The paper's symbol.
    pub symbol: &'a str,
    /// Values it can take.
    pub range: RangeInclusive<f64>,
    /// What its reset button brings back.
    pub default: f64,
    /// The unit it is shown in.
    pub display: DisplayUnit,
    /// Whether the slider goes by powers of ten.
    pub is_logarithmic: bool,
    /// Whether it counts something.
    pub is_whole: bool,
    /// Named values.
    pub presets: &'a [Preset<'a>],
    /// A line below it, if any.
    pub caption: Option<String>,
}

/// Draws the row of a number whose present value is `value`, with what is drawn `beside` its field;
/// what is wanted instead, if anything. `explain` says under the pointer what it is.
pub fn value_ui(
    ui: &mut egui::Ui,
    row: &ValueRow,
    value: f64,
    beside: impl FnOnce(&mut egui::Ui),
    explain: impl Fn(&mut egui::Ui),
) -> Option<f64> {
    let wanted = ui.push_id(row.label, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        let mut shown = value * row.display.factor;
        let mut wanted = None;
        let (name, field) = egui::Sides::new().shrink_left().truncate().show(
            ui,
            |ui| ui.label(symbol::named(ui, row.name, row.symbol)),
            |ui| {
                if reset_ui(ui, row, value != row.default) {
                    wanted = Some(row.default);
                }
                beside(ui);
                field_ui(ui, row, &mut shown)
            },
        );
        let mut slid = shown;
        let slider = slider_ui(ui, row, &mut slid);
        if slider.changed() {
            shown = if slider.dragged() {
                row.held(slid)
            } else {
                slid
            };
        }
        let explained = |response: egui::Response| response.on_hover_ui(&explain);
        let is_slid = explained(slider).changed();
        let edited = is_slid | explained(field.clone()).changed();
        explained(name);
        if let Some(preset) = presets_ui(ui, row, value) {
            wanted = Some(preset);
        }
        if is_slid || wanted.is_some() {
            field::forget(ui, &field);
        }
        field::slip_ui(ui, &field);
        if let Some(caption) = &row.caption {
            let text = RichText::new(caption).small().weak();
            ui.add(egui::Label::new(text).truncate());
        }
        wanted.or(edited.then(|| row.in_si(shown)))
    });
    wanted
        .inner
        .filter(|wanted| *wanted != value && wanted.is_finite())
}

fn field_ui(ui: &mut egui::Ui, row: &ValueRow, shown: &mut f64) -> egui::Response {
    let range = row.shown_range();
    let width = range.end() - range.start();
    let decimals = if row.is_whole {
        0
    } else {
        decimals(width).max(significant(*shown))
    };
    let field = Field {
        label: row.label,
        range,
        unit: row.display.name,
        decimals: decimals.min(2)..=decimals,
        is_whole: row.is_whole,
        speed: width / 400.0,
        size: Some(egui::vec2(NUMBER_WIDTH, 22.0)),
    };
    field.ui(ui, shown)
}

fn slider_ui(ui: &mut egui::Ui, row: &ValueRow, shown: &mut f64) -> egui::Response {
    ui.spacing_mut().slider_width = ui.available_width();
    ui.spacing_mut().interact_size.y = 18.0;
    let mut slider = egui::Slider::new(shown, row.shown_range())
        .show_value(false)
        .logarithmic(row.is_logarithmic)
        .smallest_positive(0.1)
        .clamping(egui::SliderClamping::Edits);
    if row.is_whole {
        slider = slider.step_by(1.0);
    }
    let response = ui.add(slider);
    response.widget_info(|| WidgetInfo::slider(true, *shown, row.label));
    response
}

fn reset_ui(ui: &mut egui::Ui, row: &ValueRow, away: bool) -> bool {
    let default = number::trimmed(row.default * row.display.factor);
    let button = ui
        .add_enabled(away, egui::Button::new("↺").frame(false))
        .on_hover_text(format!("Back to {default}{}", row.suffix()))
        .on_disabled_hover_text("It has the scene's value");
    let name = format!("Reset {}", row.label);
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, away, &name));
    button.clicked()
}

/// The named values within reach as buttons; the one that was chosen.
fn presets_ui(ui: &mut egui::Ui, row: &ValueRow, value: f64) -> Option<f64> {
    if row.presets.is_empty() {
        return None;
    }
    let mut chosen = None;
    let within = row
        .presets
        .iter()
        .filter(|preset| row.range.contains(&preset.value));
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        for preset in within {
            let here = (preset.value - value).abs() <= 1e-9 * row.span();
            let text = RichText::new(preset.name).small();
            let button = ui.selectable_label(here, text);
            let shown = number::trimmed(preset.value * row.display.factor);
            let button = button.on_hover_text(format!("{shown}{}", row.suffix()));
            let label = format!("{}: {}", row.label, preset.name);
            button
                .widget_info(|| WidgetInfo::selected(WidgetType::RadioButton, true, here, &label));
            if button.clicked() {
                chosen = Some(preset.value);
            }
        }
    });
    chosen
}

impl ValueRow<'_> {
    /// Its range and its default in words: `0 to 1, 0.4 in the scene`.
    pub fn extent(&self) -> String {
        let default = number::trimmed(self.default * self.display.factor);
        let range = field::between(&self.shown_range(), self.display.name);
        format!("{range}, {default} in the scene")
    }

    fn shown_range(&self) -> RangeInclusive<f64> {
        self.range.start() * self.display.factor..=self.range.end() * self.display.factor
    }

    fn span(&self) -> f64 {
        self.range.end() - self.range.start()
    }

    fn in_si(&self, shown: f64) -> f64 {
        (shown / self.display.factor).clamp(*self.range.start(), *self.range.end())
    }

    fn suffix(&self) -> String {
        field::with_space(self.display.name)
    }

    /// `shown`, or the named value that a slider at it stays at.
    fn held(&self, shown: f64) -> f64 {
        if self.is_logarithmic {
            return shown;
        }
        let distance = |preset: &&Preset| (preset.value - self.in_si(shown)).abs();
        let near = self
            .presets
            .iter()
            .filter(|preset| distance(preset) < HOLD * self.span());
        let nearest = near.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(shown, |preset| preset.value * self.display.factor)
    }
}

/// Digits after the point that show three of `value` in all: a range of powers of ten has small
/// values too.
fn significant(value: f64) -> usize {
    match value.abs() {
        0.0 => 0,
        size => (2.0 - size.log10().floor()).clamp(0.0, 6.0) as usize,
    }
}

/// Digits after the point that a value in a range of this `width` deserves: a ten-thousandth of it.
fn decimals(width: f64) -> usize {
    (4.0 - width.log10().ceil()).clamp(0.0, 6.0) as usize
}
