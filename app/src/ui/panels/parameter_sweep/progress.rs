//! How far a sweep has come: all of it, each of its runs, and where its report is.
//!
//! In: the sweep as it stands. Out: drawings, and requests to stop it or to go on.

use crate::ui::request::{Request, SweepAct};
use crate::ui::sweep_desk::SweepSeen;
use crate::ui::theme::Palette;
use bevy_egui::egui::{self, RichText, Sense, WidgetInfo, WidgetType};
use grainfall::runner::Part;
use grainfall::sweep::SweepEnding;

/// Height of the row of runs [points].
const ROW: f32 = 12.0;
/// Most faults that are told one by one.
const MOST_FAULTS: usize = 3;

/// Draws how it stands.
pub fn progress_ui(ui: &mut egui::Ui, seen: &SweepSeen, out: &mut Vec<Request>) {
    let standing = &seen.standing;
    let palette = Palette::of(ui.visuals());
    let key = &seen.sweep.variations[0].key;
    ui.label(RichText::new(format!("{} over {key}", seen.sweep.name)).strong());
    match &standing.ending {
        None => running_ui(ui, seen, out),
        Some(Ok(SweepEnding::Done)) => {
            ui.label("Every run is done.");
        }
        Some(Ok(SweepEnding::Faulted(count))) => {
            ui.colored_label(palette.warning, format!("{count} of the runs met a fault:"));
            for fault in standing.faults.iter().take(MOST_FAULTS) {
                ui.label(RichText::new(fault).small());
            }
        }
        Some(Ok(SweepEnding::Interrupted)) => {
            let (done, all) = (standing.outcomes.len(), standing.parts.len());
            let text = format!(
                "Stopped: {done} of {all} runs are done, the others go on from where they are."
            );
            ui.label(text);
            go_on_ui(ui, seen, out);
        }
        Some(Err(reason)) => {
            ui.colored_label(palette.error, reason);
            go_on_ui(ui, seen, out);
        }
    }
}

fn running_ui(ui: &mut egui::Ui, seen: &SweepSeen, out: &mut Vec<Request>) {
    let standing = &seen.standing;
    let text = if standing.progress.is_empty() {
        "starting"
    } else {
        &standing.progress
    };
    ui.add(egui::ProgressBar::new(standing.share as f32).text(RichText::new(text).small()));
    parts_ui(ui, &standing.parts);
    ui.horizontal(|ui| {
        let button = ui.add_enabled(!seen.is_stopping, egui::Button::new("Stop the sweep"));
        let button =
            button.on_hover_text("What is done is kept; the same question goes on from there");
        if button.clicked() {
            out.push(Request::Sweep(SweepAct::Stop));
        }
        if seen.is_stopping {
            ui.weak("stopping: what is computed is being written");
        }
    });
}

/// Each run as a bar of its own.
fn parts_ui(ui: &mut egui::Ui, parts: &[Part]) {
    if parts.is_empty() {
        return;
    }
    let palette = Palette::of(ui.visuals());
    let size = egui::vec2(ui.available_width(), ROW);
    let (room, response) = ui.allocate_exact_size(size, Sense::hover());
    let width = room.width() / parts.len() as f32;
    let gap = (0.15 * width).min(2.0);
    for (index, part) in parts.iter().enumerate() {
        let left = room.left() + index as f32 * width;
        let own = egui::Rect::from_min_size(
            egui::pos2(left, room.top()),
            egui::vec2(width - gap, room.height()),
        );
        ui.painter()
            .rect_filled(own, 2.0, ui.visuals().extreme_bg_color);
        let (share, colour) = match part {
            Part::Waiting => (0.0, palette.stages[0]),
            Part::Preparing => (1.0, palette.grid),
            Part::Running(share) => (*share as f32, palette.stages[0]),
            Part::Over => (1.0, palette.minimum),
        };
        let done = own.with_max_x(own.left() + share * own.width());
        ui.painter().rect_filled(done, 2.0, colour);
    }
    let words = parts_in_words(parts);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::ProgressIndicator, true, &words));
    response.on_hover_text(words);
}

fn parts_in_words(parts: &[Part]) -> String {
    let one = |part: &Part| match part {
        Part::Waiting => "waiting".to_owned(),
        Part::Preparing => "its bed settles".to_owned(),
        Part::Running(share) => format!("{:.0} %", 100.0 * share),
        Part::Over => "done".to_owned(),
    };
    let lines: Vec<String> = (1..)
        .zip(parts)
        .map(|(number, part)| format!("run {number}: {}", one(part)))
        .collect();
    lines.join("\n")
}

fn go_on_ui(ui: &mut egui::Ui, seen: &SweepSeen, out: &mut Vec<Request>) {
    let button = ui.button("Go on with the sweep");
    if button.on_hover_text("From what its folder holds").clicked() {
        out.push(Request::Sweep(SweepAct::Start(Box::new(
            seen.question.clone(),
        ))));
    }
}

/// Says where the report is and how to confirm it, once there is one.
pub fn report_ui(ui: &mut egui::Ui, seen: &SweepSeen) {
    if !matches!(seen.standing.ending, Some(Ok(_))) {
        return;
    }
    let folder = seen.sweep.out.display();
    ui.add_space(2.0);
    ui.label(
        RichText::new("Report: tables, plots, and a summary of every run")
            .small()
            .weak(),
    );
    let path = RichText::new(folder.to_string()).small();
    // A long path would widen the panel; the pointer over it shows all of it.
    ui.add(egui::Label::new(path).truncate());
    ui.horizontal_wrapped(|ui| {
        if ui.small_button("Copy the path").clicked() {
            ui.ctx().copy_text(folder.to_string());
        }
        let verify = RichText::new("grainfall verify FOLDER").small().monospace();
        ui.label(verify).on_hover_text("Computes every run again and confirms that it comes to the same state, to the bit, and that tables and plots are as they were written");
    });
}
