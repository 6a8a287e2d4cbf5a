//! The bar under the picture: the timeline; play, pause, single step, reset, speed, simulated time;
//! how far a bed is prepared or a moment is away; what went wrong and what to do.

use crate::simulation::Simulation;
use crate::ui::bars::time_slider::timeline_ui;
use crate::ui::playback::{SPEEDS, allows, go_to, play_or_pause, step_back, step_on};
use crate::ui::repeat::Repeat;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::combo::list_ui;
use crate::ui::widgets::field::Field;
use crate::ui::widgets::touch;
use crate::ui::words::number;
use bevy_egui::egui::{self, Align, Layout, RichText, WidgetInfo, WidgetType, vec2};
use grainfall::lab::Status;
use grainfall::lesson::Touch;
use grainfall::run::Command;

/// Room for the clock, and as much for the speed beside it, in points.
const ROOM_FOR_CLOCK: f32 = 140.0;
/// What Reset does.
const RESET_HINT: &str =
    "Start afresh with the settled bed and the present parameters; the run is kept (R)";
/// Below this share of the speed asked for, the bar says that the machine is slower.
const KEEPING_UP: f64 = 0.9;

/// The transport bar.
#[derive(Default)]
pub struct Transport {
    /// The newest step when it was opened.
    opened_at: Option<u64>,
    /// Whether somebody has played what is open.
    was_played: bool,
    /// Whether there was room for the clock.
    shows_time: bool,
    /// What is played again and again.
    pub repeat: Repeat,
}

impl Transport {
    /// Whether it says which moment is shown.
    pub fn shows_time(&self) -> bool {
        self.shows_time
    }

    /// Draws the bar.
    pub fn ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let status = simulation.status();
        if simulation.world().is_some() {
            let newest = simulation.past().end.step;
            self.was_played |= newest > *self.opened_at.get_or_insert(newest);
        }
        self.repeat.follow(simulation, out);
        let timeline = ui.scope(|ui| timeline_ui(ui, simulation, &self.repeat, out));
        touch::mark_ui(ui, &Touch::Time, timeline.response.rect);
        ui.horizontal_wrapped(|ui| {
            play_ui(ui, simulation, !self.was_played, out);
            buttons_ui(ui, simulation, out);
            speed_ui(ui, simulation.speed(), out);
            if !self.was_played {
                scenes_ui(ui, out);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.shows_time = clock_ui(ui, simulation, out);
                warnings_ui(ui, simulation.warnings());
                repeat_ui(ui, simulation, &self.repeat, out);
            });
        });
        let can_undo = simulation.undo_and_redo()[0].is_some();
        status_ui(ui, status, simulation.advice().time_step, can_undo, out);
    }
}

/// Play and pause; in the accent colour and with its name while somebody `is_invited` to
/// press it.
fn play_ui(ui: &mut egui::Ui, simulation: &Simulation, is_invited: bool, out: &mut Vec<Request>) {
    let status = simulation.status();
    let (face, name, hint) = match status {
        Status::Running => ("⏸", "Pause", "Pause (Space)"),
        Status::Seeking { .. } => ("⏸", "Pause", "Stop on the way (Space)"),
        _ if simulation.looks_back() => ("▶", "Play", "See what followed (Space)"),
        _ => ("▶", "Play", "Play (Space)"),
    };
    let command = play_or_pause(status);
    if !(is_invited && name == "Play" && command.is_some()) {
        let response = button_ui(ui, status, (face, name, hint), command, out);
        return touch::mark_ui(ui, &Touch::Play, response.rect);
    }
    let accent = ui.visuals().selection;
    let face = RichText::new("▶  Play")
        .size(19.0)
        .strong()
        .color(accent.stroke.color);
    let button = egui::Button::new(face)
        .fill(accent.bg_fill)
        .min_size(vec2(108.0, 32.0));
    let response = ui.add(button).on_hover_text(hint);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
    touch::mark_ui(ui, &Touch::Play, response.rect);
    if response.clicked() {
        out.extend(command.map(Request::Command));
    }
}

/// The way to other scenes, as long as this one was not played.
fn scenes_ui(ui: &mut egui::Ui, out: &mut Vec<Request>) {
    let button = egui::Button::new("Other scenes…").min_size(vec2(0.0, 32.0));
    let hint = "Scenes with their pictures (Ctrl+G)";
    if ui.add(button).on_hover_text(hint).clicked() {
        out.push(Request::ShowScenes);
    }
}

/// A button with this face, name and hint, which sends `command` where there is one.
fn button_ui(
    ui: &mut egui::Ui,
    status: &Status,
    (face, name, hint): (&str, &str, &str),
    command: Option<Command>,
    out: &mut Vec<Request>,
) -> egui::Response {
    let face = RichText::new(face).size(19.0);
    let button = egui::Button::new(face).min_size(vec2(36.0, 32.0));
    let response = ui
        .add_enabled(command.is_some(), button)
        .on_hover_text(hint)
        .on_disabled_hover_text(format!("{name}: {}", why_not(status)));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, command.is_some(), name));
    if response.clicked() {
        out.extend(command.map(Request::Command));
    }
    response
}

/// To the start, a step back, a step on, to the newest state; afresh.
fn buttons_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
    let status = simulation.status();
    let allowed = |command| Some(command).filter(|command| allows(status, command));
    let start = (simulation.step() > 0).then_some(Command::Seek(0));
    let end = simulation.past().end.step;
    let newest = simulation.looks_back().then_some(Command::Seek(end));
    let [back_hint, on_hint, start_hint] = match simulation.recording() {
        Some(_) => [
            "The state before (, or ←)",
            "The next state (. or →)",
            "Back to the first state (R)",
        ],
        None => [
            "The time step before (, or ←)",
            "One time step (. or →)",
            RESET_HINT,
        ],
    };
    let buttons = [
        (
            "⏮",
            "To the start",
            "The start of the run",
            start.and_then(allowed),
        ),
        ("⏴", "Step back", back_hint, step_back(simulation)),
        ("⏵", "Single step", on_hint, step_on(simulation)),
        (
            "⏭",
            "To the newest state",
            "The newest state (End)",
            newest.and_then(allowed),
        ),
        ("⟲", "Reset", start_hint, allowed(Command::Reset)),
    ];
    for (face, name, hint, command) in buttons {
        let response = button_ui(ui, status, (face, name, hint), command, out);
        if name == "Reset" {
            touch::mark_ui(ui, &Touch::Afresh, response.rect);
        }
    }
}

/// Why a button does nothing now.
fn why_not(status: &Status) -> &'static str {
    match status {
        Status::Preparing { .. } => "the bed is still being prepared",
        Status::Failed(_) => "there is no run; open another scene",
        Status::Faulted(_) => "the run met a fault; undo the last change, or go back to time zero",
        Status::Running | Status::Paused | Status::Seeking { .. } => "the run is at its start",
    }
}

fn speed_ui(ui: &mut egui::Ui, speed: f64, out: &mut Vec<Request>) {
    let speeds = egui::ComboBox::from_id_salt("speed")
        .selected_text(speed_name(speed))
        .width(74.0)
        .height(420.0);
    let list = list_ui(ui, "Speed", speeds, |ui| {
        for choice in SPEEDS {
            let entry = ui.selectable_label(choice == speed, speed_name(choice));
            if entry.clicked() && choice != speed {
                out.push(Request::Command(Command::Speed(choice)));
            }
        }
    });
    let list = list.on_hover_text("Speed: simulated seconds per second");
    touch::mark_ui(ui, &Touch::Speed, list.rect);
}

/// The button that marks what is played again and again, and how long that is.
fn repeat_ui(ui: &mut egui::Ui, simulation: &Simulation, repeat: &Repeat, out: &mut Vec<Request>) {
    let is_marked = repeat.duration().is_some();
    let (text, hint) = match (repeat.duration(), repeat.ends().count()) {
        (Some(duration), _) => (
            format!("A–B {}", number::moment(duration)),
            "What lies between A and B is played again and again. Play on without that (L)",
        ),
        (None, 0) => (
            "A–B".to_owned(),
            "Play a part again and again, or take a time: mark its start A at the moment shown (L)",
        ),
        (None, _) => ("A–…".to_owned(), "Mark its end B at the moment shown (L)"),
    };
    let enabled = simulation.world().is_some();
    let button = egui::Button::selectable(is_marked, text).min_size(vec2(0.0, 26.0));
    let response = ui.add_enabled(enabled, button).on_hover_text(hint);
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::Button, enabled, is_marked, "Repeat a part")
    });
    if response.clicked() {
        out.push(Request::Repeat);
    }
}

/// `0.5×`, `max`.
fn speed_name(speed: f64) -> String {
    if speed.is_finite() {
        format!("{speed}×")
    } else {
        "max".into()
    }
}

/// The clock, and whether there is room for it: else that in the picture will do.
fn clock_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) -> bool {
    let Some(world) = simulation
        .world()
        .filter(|_| ui.available_width() >= ROOM_FOR_CLOCK)
    else {
        return false;
    };
    let palette = Palette::of(ui.visuals());
    let (factor, asked) = (simulation.real_time_factor(), simulation.speed());
    let slower = factor > 0.0 && asked.is_finite() && factor < KEEPING_UP * asked;
    let mut time = world.time();
    let field = Field {
        label: "Time",
        range: 0.0..=f64::MAX,
        unit: "s",
        // A short run is told to a hundredth of a millisecond.
        decimals: if time < 1.0 { 2..=5 } else { 2..=2 },
        is_whole: false,
        speed: 0.0,
        size: Some(vec2(104.0, 26.0)),
    };
    let typed = field.ui(ui, &mut time);
    if typed.changed() && time != world.time() {
        let command =
            go_to(simulation, time).filter(|command| allows(simulation.status(), command));
        out.extend(command.map(Request::Command));
    }
    typed.on_hover_text(format!(
        "Simulated time, step {}. Click to type another: the run shows it, or goes on to it",
        world.clock.step
    ));
    if factor > 0.0 && ui.available_width() >= ROOM_FOR_CLOCK {
        let text = RichText::new(format!("{} real time", number::times(factor)));
        if slower {
            let hint = "This machine is slower than the speed asked for: simulated time slows down, nothing is skipped.";
            ui.label(text.color(palette.warning)).on_hover_text(hint);
        } else {
            ui.label(text.weak())
                .on_hover_text("Simulated seconds per second, measured");
        }
    }
    true
}

fn warnings_ui(ui: &mut egui::Ui, warnings: &[String]) {
    if warnings.is_empty() {
        return;
    }
    let colour = Palette::of(ui.visuals()).warning;
    let text = RichText::new(format!("⚠ {}", warnings.len())).color(colour);
    let response = ui.label(text).on_hover_text(warnings.join("\n\n"));
    let name = || format!("Warnings: {}", warnings.join("; "));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, name()));
}

/// How far the bed is prepared, or what went wrong and what to do; nothing while all goes well.
pub fn status_ui(
    ui: &mut egui::Ui,
    status: &Status,
    time_step: f64,
    can_undo: bool,
    out: &mut Vec<Request>,
) {
    match status {
        Status::Running | Status::Paused => {}
        Status::Seeking { progress } => {
            progress_ui(ui, "Going to the moment asked for", "On the way", *progress);
        }
        Status::Preparing { stage, progress } => {
            let text = number::capitalised(stage);
            progress_ui(ui, &text, "Preparing the bed", *progress);
        }
        Status::Faulted(fault) => message_ui(ui, "The run stopped", &fault.to_string(), |ui| {
            ui.label(remedy(time_step));
            if can_undo && ui.button("Undo the last change").clicked() {
                out.push(Request::Command(Command::Undo));
            }
            if ui.button("Back to time zero").clicked() {
                out.push(Request::Command(Command::Reset));
            }
        }),
        Status::Failed(reason) => message_ui(ui, "There is nothing to run", reason, |ui| {
            ui.label("Open another scene (Ctrl+O), or correct this one and open it again.");
        }),
    }
}

fn progress_ui(ui: &mut egui::Ui, text: &str, name: &str, progress: f32) {
    let text = format!("{text} · {:.0} %", 100.0 * progress);
    let bar = egui::ProgressBar::new(progress)
        .text(text)
        .desired_height(24.0);
    let response = ui.add(bar);
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::ProgressIndicator, true, name);
        info.value = Some(f64::from(progress));
        info
    });
}

/// What a person can do about a fault of a run with steps of `time_step` [s].
fn remedy(time_step: f64) -> String {
    format!(
        "What to do: undo the last change of a parameter, or go back to time zero; if it stops again, give the scene half \
         the time step, `time_step: Given({:.1e})`.",
        0.5 * time_step
    )
}

fn message_ui(ui: &mut egui::Ui, title: &str, text: &str, rest: impl FnOnce(&mut egui::Ui)) {
    let palette = Palette::of(ui.visuals());
    egui::Frame::new()
        .fill(palette.error_fill)
        .corner_radius(6)
        .inner_margin(10)
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.label(RichText::new(title).strong().color(palette.error));
            ui.label(text);
            rest(ui);
        });
}
