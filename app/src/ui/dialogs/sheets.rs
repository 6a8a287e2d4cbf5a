//! Sheets over the window: the shortcuts, what the program is, why a file could not be opened, and
//! what is to become of unsaved work.
//!
//! In: what is to be said or asked. Out: whether the sheet is still open, and the answer as a
//! request.

use crate::ui::dialogs::dialog::dialog_ui;
use crate::ui::request::{Request, Sheet};
use crate::ui::shortcuts::{GESTURES, SHORTCUTS};
use crate::ui::theme::Palette;
use crate::ui::widgets::focus::take_first_focus;
use bevy_egui::egui::{self, Key, RichText, ScrollArea};
use std::path::Path;

/// Height of what stands round the content of a sheet, with some air [points].
const AROUND_CONTENT: f32 = 140.0;
/// How far an arrow scrolls [points].
const LINE: f32 = 40.0;

/// Draws `sheet`; false once it is closed.
pub fn sheet_ui(ctx: &egui::Context, sheet: Sheet) -> bool {
    match sheet {
        Sheet::Shortcuts => modal_ui(ctx, "Shortcuts", 500.0, shortcuts_ui),
        Sheet::About => modal_ui(ctx, "Grainfall", 460.0, about_ui),
    }
}

/// Draws the reason why a scene or a session could not be opened; false once it is closed.
pub fn open_error_ui(ctx: &egui::Context, reason: &str) -> bool {
    modal_ui(ctx, "This file cannot be opened", 720.0, |ui| {
        let palette = Palette::of(ui.visuals());
        egui::Frame::new()
            .fill(palette.error_fill)
            .corner_radius(6)
            .inner_margin(10)
            .show(ui, |ui| {
                let text = RichText::new(reason).monospace();
                ui.add(egui::Label::new(text).selectable(true).wrap());
            });
        ui.label("What was open goes on. A scene can be corrected and opened again.");
    })
}

/// Asks what becomes of work that is in no file before `next`, which leaves it; false once that is
/// answered.
pub fn unsaved_ui(ctx: &egui::Context, next: &Request, out: &mut Vec<Request>) -> bool {
    let text = "Its changes and runs are in no file yet. Saved, it opens again as it is now, with every change, every run and \
                this moment, to the bit.";
    let answers = [
        ("Save", Some(Request::SaveThen(Box::new(next.clone())))),
        ("Discard", Some(Request::Leave(Box::new(next.clone())))),
        ("Cancel", None),
    ];
    question_ui(ctx, "Save the session?", text, answers, out)
}

/// Asks whether `request`, against which `reason` speaks, is meant; false once that is answered.
pub fn doubt_ui(
    ctx: &egui::Context,
    reason: &str,
    request: &Request,
    out: &mut Vec<Request>,
) -> bool {
    let anyway = Request::Anyway(Box::new(request.clone()));
    let (question, yes) = match request {
        Request::Quit => ("Leave while a sweep is running?", "Stop it and leave"),
        _ => ("This is a large scene", "Open it"),
    };
    let answers = [(yes, Some(anyway)), ("Cancel", None)];
    question_ui(ctx, question, reason, answers, out)
}

/// Offers the session that an earlier window left at `path`; false once that is answered.
pub fn left_ui(ctx: &egui::Context, path: &Path, out: &mut Vec<Request>) -> bool {
    let age = std::fs::metadata(path).and_then(|file| file.modified());
    let age = age.ok().and_then(|time| time.elapsed().ok());
    let when = age.map_or_else(String::new, |age| format!(" {}", ago(age.as_secs())));
    let text = format!(
        "Grainfall ended{when} before its work was saved. What was kept of it opens as it was half a minute before the end or \
         less, with every change and every run."
    );
    let answers = [
        ("Open", Some(Request::OpenLeft(path.to_owned()))),
        ("Discard", Some(Request::DiscardLeft(path.to_owned()))),
        ("Later", None),
    ];
    question_ui(ctx, "Go on with what was not saved?", &text, answers, out)
}

/// A question over everything else, its answers with what each asks for; false once it is answered.
fn question_ui<const N: usize>(
    ctx: &egui::Context,
    question: &str,
    text: &str,
    answers: [(&str, Option<Request>); N],
    out: &mut Vec<Request>,
) -> bool {
    let (answered, left) = dialog_ui(ctx, question, 460.0, |ui| {
        ui.heading(question);
        ui.add_space(4.0);
        ui.label(text);
        ui.add_space(8.0);
        let mut answered = false;
        ui.horizontal(|ui| {
            for (index, (name, answer)) in answers.into_iter().enumerate() {
                let button = ui.button(name);
                if index == 0 {
                    take_first_focus(&button);
                }
                if button.clicked() {
                    out.extend(answer);
                    answered = true;
                }
            }
        });
        answered
    });
    !(answered || left)
}

/// How long ago something was, in words.
fn ago(seconds: u64) -> String {
    match seconds {
        0..120 => "a moment ago".to_owned(),
        120..7200 => format!("{} minutes ago", seconds / 60),
        7200..172_800 => format!("{} hours ago", seconds / 3600),
        _ => format!("{} days ago", seconds / 86_400),
    }
}

/// A window that blocks everything else until it is closed; false once it is.
fn modal_ui(
    ctx: &egui::Context,
    title: &str,
    width: f32,
    content: impl FnOnce(&mut egui::Ui),
) -> bool {
    let (closed, left) = dialog_ui(ctx, title, width, |ui| {
        ui.heading(title);
        ui.add_space(4.0);
        // The title above and the button below are always in the window.
        let height = ui.ctx().content_rect().height() - AROUND_CONTENT;
        ScrollArea::vertical()
            .id_salt(title)
            .max_height(height)
            .min_scrolled_height(height)
            .show(ui, |ui| {
                content(ui);
                scroll_by_keys(ui, height);
            });
        ui.add_space(4.0);
        let close = ui.button("Close");
        take_first_focus(&close);
        close.clicked()
    });
    !(closed || left)
}

/// Scrolls the text in `ui`, of which this `height` [points] is seen, by the keys that do so
/// elsewhere.
fn scroll_by_keys(ui: &egui::Ui, height: f32) {
    let keys = [
        (Key::ArrowDown, LINE),
        (Key::ArrowUp, -LINE),
        (Key::PageDown, height - LINE),
        (Key::PageUp, LINE - height),
        (Key::End, f32::MAX),
        (Key::Home, f32::MIN),
    ];
    let pressed = |(key, _): &&(Key, f32)| ui.input(|input| input.key_pressed(*key));
    if let Some((_, distance)) = keys.iter().find(pressed) {
        let (text, seen) = (ui.min_rect(), ui.clip_rect());
        let [above, below] = [seen.top() - text.top(), text.bottom() - seen.bottom()];
        let way = distance.clamp(-above.max(0.0), below.max(0.0));
        ui.scroll_with_delta(egui::vec2(0.0, -way));
    }
}

fn shortcuts_ui(ui: &mut egui::Ui) {
    egui::Grid::new("shortcuts")
        .num_columns(2)
        .spacing([24.0, 5.0])
        .show(ui, |ui| {
            for shortcut in SHORTCUTS {
                ui.monospace(shortcut.keys(ui.ctx()));
                ui.label(shortcut.name);
                ui.end_row();
            }
            for (gesture, name) in GESTURES {
                ui.monospace(gesture);
                ui.label(name);
                ui.end_row();
            }
        });
}

fn about_ui(ui: &mut egui::Ui) {
    ui.label(format!("Version {}", env!("CARGO_PKG_VERSION")));
    ui.label(
        "A laboratory for granular matter: every grain is computed, with the contact laws of the papers that the scenes \
         come from. What is drawn is what is computed; the same scene, seed and commands give the same numbers, with and \
         without a window.",
    );
    ui.label("Kasper, Magnanimo, de Jong, Beek, Jarray: Effect of viscosity on the avalanche dynamics and flow transition of wet granular matter, Particuology (2021).");
    ui.weak("MIT or Apache-2.0");
}
