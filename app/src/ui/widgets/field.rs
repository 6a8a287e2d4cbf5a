//! A field for a number, to type or to drag, which says what was wrong with a text it refused.
//!
//! In: what was typed. Out: the number. Where the text is no number, or one out of range, a line
//! under the field says so until the person does something else there.

use crate::ui::theme::Palette;
use crate::ui::words::number;
use bevy_egui::egui::accesskit::Live;
use bevy_egui::egui::{self, DragValue, Response, WidgetInfo};
use std::cell::{Cell, RefCell};
use std::ops::RangeInclusive;

/// What a field for a number needs to know of it. Numbers are in the unit shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'a> {
    /// What screen readers call it.
    pub label: &'a str,
    /// What it can take.
    pub range: RangeInclusive<f64>,
    /// The unit behind it.
    pub unit: &'a str,
    /// Digits after the point, at least and at most.
    pub decimals: RangeInclusive<usize>,
    /// Whether it counts something: what is typed is rounded.
    pub is_whole: bool,
    /// How much a point of a drag changes it.
    pub speed: f64,
    /// Its size in points, where that is given.
    pub size: Option<egui::Vec2>,
}

impl Field<'_> {
    /// Draws the field; the number in `shown` is another one when a person has made it so.
    pub fn ui(&self, ui: &mut egui::Ui, shown: &mut f64) -> Response {
        let (before, style) = (*shown, ui.style().number_formatter.clone());
        let untouched = RefCell::new(String::new());
        let (typed, slip) = (Cell::new(false), RefCell::new(None));
        let widget = DragValue::new(shown)
            .range(self.range.clone())
            .clamp_existing_to_range(false)
            .speed(self.speed)
            .min_decimals(*self.decimals.start())
            .max_decimals(*self.decimals.end())
            .suffix(with_space(self.unit))
            .custom_formatter(|value, decimals| {
                let text = style.format(value, decimals);
                untouched.replace(text.clone());
                text
            })
            .custom_parser(|text| {
                typed.set(true);
                // What only passed through keeps digits that are not shown.
                if *untouched.borrow() == text || text.trim().is_empty() {
                    return Some(before);
                }
                let number = read(text, self.unit).map(|number| self.rounded(number));
                slip.replace(self.slip(text, number));
                number
            })
            .update_while_editing(false);
        let response = match self.size {
            Some(size) => ui.add_sized(size, widget),
            None => ui.add(widget),
        };
        let value = *shown;
        response.widget_info(|| WidgetInfo {
            label: Some(self.label.to_owned()),
            ..WidgetInfo::drag_value(true, value)
        });
        if typed.get() {
            ui.data_mut(|data| data.insert_temp(response.id, slip.take()));
        } else if response.gained_focus() || response.dragged() {
            forget(ui, &response);
        }
        response
    }

    fn rounded(&self, number: f64) -> f64 {
        if self.is_whole {
            number.round()
        } else {
            number
        }
    }

    /// What is wrong with `text`, in which `number` was read.
    fn slip(&self, text: &str, number: Option<f64>) -> Option<String> {
        let (typed, expected) = (text.trim(), between(&self.range, self.unit));
        let (least, most) = (*self.range.start(), *self.range.end());
        match number {
            None => Some(format!(
                "“{typed}” is not a number, so nothing was changed. Expected: {expected}."
            )),
            Some(number) if !(least..=most).contains(&number) => {
                let taken = number::trimmed(number.clamp(least, most));
                Some(format!(
                    "{typed} is out of range, so {taken} was taken. Expected: {expected}."
                ))
            }
            Some(_) => None,
        }
    }
}

/// Draws what was wrong with what was typed last into the field of `response`, if anything was.
pub fn slip_ui(ui: &mut egui::Ui, response: &Response) {
    let slip = ui.data(|data| data.get_temp::<Option<String>>(response.id));
    let Some(slip) = slip.flatten() else {
        return;
    };
    let colour = Palette::of(ui.visuals()).warning;
    let line = ui.colored_label(colour, slip);
    ui.ctx()
        .accesskit_node_builder(line.id, |node| node.set_live(Live::Polite));
}

/// Says no longer what was wrong in the field of `response`.
pub fn forget(ui: &egui::Ui, response: &Response) {
    ui.data_mut(|data| data.remove_temp::<Option<String>>(response.id));
}

/// `0 to 1 rpm`, `0 s or more`.
pub fn between(range: &RangeInclusive<f64>, unit: &str) -> String {
    let [least, most] = [range.start(), range.end()].map(|end| number::trimmed(*end));
    let unit = with_space(unit);
    if range.end().is_finite() {
        format!("{least} to {most}{unit}")
    } else {
        format!("{least}{unit} or more")
    }
}

/// `unit` as it stands behind a number.
pub fn with_space(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// The number in `text`, which may have its `unit` behind it and a comma for a point.
pub fn read(text: &str, unit: &str) -> Option<f64> {
    let bare = text.trim();
    let bare = bare.strip_suffix(unit).unwrap_or(bare);
    let plain: String = (bare.chars())
        .filter(|letter| !letter.is_whitespace())
        .map(|letter| match letter {
            '−' => '-',
            ',' => '.',
            letter => letter,
        })
        .collect();
    plain.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The number in `text`, which `what` is.
///
/// # Errors
/// Why it is none that can be, in a sentence.
pub fn number_of(
    what: &str,
    text: &str,
    range: &RangeInclusive<f64>,
    unit: &str,
) -> Result<f64, String> {
    let expected = between(range, unit);
    match read(text, unit) {
        None => Err(format!(
            "{what}: “{}” is not a number. Expected: {expected}",
            text.trim()
        )),
        Some(number) if !range.contains(&number) => Err(format!(
            "{what}: {} cannot be. Expected: {expected}",
            text.trim()
        )),
        Some(number) => Ok(number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_people_write_them() {
        for (text, number) in [
            ("0.25", 0.25),
            (" 0,25 ", 0.25),
            ("1.41 mPa s", 1.41),
            ("1 410", 1410.0),
            ("−2e-3", -2e-3),
        ] {
            assert_eq!(read(text, "mPa s"), Some(number), "{text}");
        }
        for text in ["", "abc", "1.2.3", "NaN", "inf", "2 rpm"] {
            assert_eq!(read(text, "mPa s"), None, "{text}");
        }
        assert_eq!(read("7", ""), Some(7.0));
    }

    #[test]
    fn ranges_stand_in_words() {
        assert_eq!(between(&(0.0..=1.0), ""), "0 to 1");
        assert_eq!(between(&(0.0..=f64::INFINITY), "s"), "0 s or more");
    }
}
