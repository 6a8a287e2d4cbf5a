//! The timeline under the picture: the present run from its start to its newest state, to look at
//! any moment of it.
//!
//! In: the simulation. Out: requests to show a moment, to undo and to redo. What happened is marked
//! on the line by [`super::time_marks`].

use crate::simulation::Simulation;
use crate::ui::bars::time_marks::marks_ui;
use crate::ui::playback::allows;
use crate::ui::repeat::Repeat;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::elided::{elided, width};
use crate::ui::words::names::parameter_name;
use crate::ui::words::number;
use crate::ui::words::run_names::RunNames;
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType, vec2};
use grainfall::lab::Half;
use grainfall::recording::{RecordingFacts, RunProgress};
use grainfall::run::{Changed, Command};

/// Draws the timeline, over the whole width; nothing while there is no run.
pub fn timeline_ui(
    ui: &mut egui::Ui,
    simulation: &Simulation,
    repeat: &Repeat,
    out: &mut Vec<Request>,
) {
    if simulation.world().is_none() {
        return;
    }
    names_ui(ui, simulation);
    ui.horizontal(|ui| {
        if let Some(recording) = simulation.recording() {
            run_anew_ui(ui, out);
            line_ui(ui, simulation, repeat, out);
            state_ui(ui, simulation, recording);
        } else {
            undo_ui(ui, simulation, out);
            let place = Place::of(ui, simulation);
            line_ui(ui, simulation, repeat, out);
            place.ui(ui, simulation, out);
        }
    });
}

/// The ways from a recording to a run.
fn run_anew_ui(ui: &mut egui::Ui, out: &mut Vec<Request>) {
    let ways = [
        (
            "The scene, from its start",
            "Its bed is made again, and the parameters have the values of the moment shown",
            Request::RunAnew,
        ),
        (
            "On from this moment",
            "The grains are where they are, with their velocities and films; contacts begin without springs and bridges",
            Request::RunOn,
        ),
    ];
    let menu = ui.menu_button("Run anew", |ui| {
        for (name, hint, request) in ways {
            if ui.button(name).on_hover_text(hint).clicked() {
                out.push(request);
                ui.close();
            }
        }
    });
    menu.response
        .on_hover_text("A recording shows what was computed. A run can be changed");
}

/// `state 12 of 51 · 1.20 of 5.00 s`.
fn state_in_words(recording: &RecordingFacts, step: u64) -> String {
    let (index, states) = (recording.index_at(step), recording.moments.len());
    let time = |index: usize| {
        recording
            .moments
            .get(index)
            .map_or(0.0, |moment| moment.time)
    };
    let place = place_in_words(time(index), time(states.saturating_sub(1)));
    let progress = match recording.progress {
        RunProgress::UnderWay => " · under way",
        RunProgress::Stopped => " · not finished",
        RunProgress::Over => "",
    };
    format!("state {} of {states} · {place}{progress}", index + 1)
}

/// Which state of a recording is shown.
fn state_ui(ui: &mut egui::Ui, simulation: &Simulation, recording: &RecordingFacts) {
    let text = state_in_words(recording, simulation.step());
    let more = match recording.progress {
        RunProgress::UnderWay => {
            ". Its run is under way: states are added as they are written, and while the last one is shown, the picture follows"
        }
        RunProgress::Stopped => {
            ". Its run was not finished, and nobody computes it here now: if somebody goes on with it, its states are added"
        }
        RunProgress::Over => "",
    };
    ui.label(text).on_hover_text(format!(
        "A recording shows the states that were written, each as it is, until the next is due; nothing is made up between \
         them{more}"
    ));
}

/// Undo and redo.
fn undo_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
    let [undo, redo] = simulation.undo_and_redo();
    let buttons = [
        ("⟲", "Undo", "Undo (Ctrl+Z)", undo, Command::Undo),
        ("⟳", "Redo", "Redo (Ctrl+Shift+Z)", redo, Command::Redo),
    ];
    for (face, name, title, what, command) in buttons {
        let enabled = what.is_some() && allows(simulation.status(), &command);
        let button = egui::Button::new(RichText::new(face).size(17.0)).min_size(vec2(32.0, 26.0));
        let mut response = ui.add_enabled(enabled, button);
        response = response.on_disabled_hover_text(format!("{title}: {}", why_no_undo(simulation)));
        if let Some(what) = what {
            let about = changed_name(what, simulation);
            let effect = match command {
                Command::Undo => "Back to the moment before it, as if it had not been made",
                _ => "On to where the run was when it was taken back",
            };
            response = response.on_hover_text(format!("{title}: {about}\n{effect}"));
        }
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, enabled, name));
        if response.clicked() {
            out.push(Request::Command(command));
        }
    }
}

/// Why there is no undo or redo.
pub fn why_no_undo(simulation: &Simulation) -> &'static str {
    match simulation.comparison() {
        Some(_) => "there is nothing to take back since the comparison began",
        None => "there is nothing to take back",
    }
}

fn changed_name(what: &Changed, simulation: &Simulation) -> String {
    match what {
        Changed::Parameter(parameter) => parameter_name(parameter, simulation),
        Changed::Parameters => "several parameters".into(),
        Changed::Start => "starting afresh".into(),
        Changed::Run => "taking up another run".into(),
    }
}

/// Which runs the line is of, where there are others or where a person named it: above the line. A
/// long name keeps its beginning and its end, and is whole under the pointer.
fn names_ui(ui: &mut egui::Ui, simulation: &Simulation) {
    let names = RunNames::of(simulation);
    if !names.are_told() {
        return;
    }
    let palette = Palette::of(ui.visuals());
    let colours = [ui.visuals().strong_text_color(), palette.compared];
    let is_pair = simulation.comparison().is_some();
    let shown = 1 + usize::from(is_pair);
    ui.columns(shown, |places| {
        for ((ui, half), colour) in places.iter_mut().zip(Half::ALL).zip(colours) {
            let name = names.present(half);
            let hint = if is_pair {
                format!("{name}\nThe run on the {}", half.label())
            } else {
                format!("{name}\nThe run that is shown: Changes and runs lists them all")
            };
            let text = RichText::new(elided(ui, name)).color(colour);
            let response = ui.add(egui::Label::new(text).extend());
            let response = response.on_hover_text(hint);
            let told = || format!("Run on the timeline: {name}");
            response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, told()));
        }
    });
}

/// The line itself.
fn line_ui(ui: &mut egui::Ui, simulation: &Simulation, repeat: &Repeat, out: &mut Vec<Request>) {
    let Some(world) = simulation.world() else {
        return;
    };
    let time_step = world.clock.time_step;
    let Some(times) = simulation.step_times() else {
        return;
    };
    let end = simulation.past().end;
    let shown = simulation.step();
    let enabled = end.step > 0 && allows(simulation.status(), &Command::Seek(0));
    let mut time = times.time_at(shown.min(end.step));
    let room = match simulation.recording() {
        Some(recording) => width(ui, &state_in_words(recording, end.step)) + 24.0,
        None => Place::of(ui, simulation).room(ui, end.time),
    };
    ui.spacing_mut().slider_width = (ui.available_width() - room).max(80.0);
    let slider = egui::Slider::new(&mut time, 0.0..=end.time.max(time_step)).show_value(false);
    let response = ui.add_enabled(enabled, slider);
    let value = (time * 1e6).round() / 1e6;
    response.widget_info(|| WidgetInfo::slider(enabled, value, "Moment shown"));
    if response.changed() {
        let step = times.step_at(time).min(end.step);
        if step != shown {
            out.push(Request::Command(Command::Seek(step)));
        }
    }
    marks_ui(ui, response.rect, simulation, end.time, repeat);
    response.on_hover_text(line_in_words(simulation));
}

/// What the line is, and of which run where there are several.
fn line_in_words(simulation: &Simulation) -> String {
    if simulation.recording().is_some() {
        return "Drag to see any state of the recording.".to_owned();
    }
    let hint =
        "Drag to see any moment of the run. Change something there to begin another run from it.";
    if simulation.past().kept.is_empty() {
        return hint.to_owned();
    }
    let names = RunNames::of(simulation);
    format!("{}\n{hint}", names.present(Half::Left))
}

/// The least width of the line [points].
const SHORTEST_LINE: f32 = 160.0;

/// `2.04 of 17.22 s`.
fn place_in_words(time: f64, end: f64) -> String {
    format!("{} of {}", number::moment(time), number::moment(end))
}

/// What stands right of the line: the moment shown out of the whole run, and the way back to the
/// newest. Where there is no room for both, the way alone; the picture tells the moment.
#[derive(Clone, Copy)]
enum Place {
    MomentAndWay,
    Way,
}

impl Place {
    /// What there is room for in the rest of this row.
    fn of(ui: &egui::Ui, simulation: &Simulation) -> Self {
        let room = Self::MomentAndWay.room(ui, simulation.past().end.time);
        if ui.available_width() < room + SHORTEST_LINE {
            Self::Way
        } else {
            Self::MomentAndWay
        }
    }

    /// What the button says.
    fn way(self) -> &'static str {
        match self {
            Self::MomentAndWay => "To the newest",
            Self::Way => "Newest",
        }
    }

    /// Its width. It does not depend on the moment shown, so the line does not jump.
    fn room(self, ui: &egui::Ui, end: f64) -> f32 {
        let spacing = ui.spacing();
        let moments = [end, end.min(0.1234)].map(|time| width(ui, &place_in_words(time, end)));
        let moment = match self {
            Self::MomentAndWay => moments[0].max(moments[1]) + spacing.item_spacing.x,
            Self::Way => 0.0,
        };
        let button = width(ui, self.way()) + 2.0 * spacing.button_padding.x;
        moment + button + 2.0 * spacing.item_spacing.x
    }

    fn ui(self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let end = simulation.past().end;
        if !simulation.looks_back() {
            ui.weak("newest")
                .on_hover_text("The newest state of the run is shown");
            return;
        }
        let Some(times) = simulation.step_times() else {
            return;
        };
        if matches!(self, Self::MomentAndWay) {
            let text = place_in_words(times.time_at(simulation.step()), end.time);
            let palette = Palette::of(ui.visuals());
            ui.label(RichText::new(text).color(palette.warning))
                .on_hover_text(
                    "An earlier moment is shown: Play shows what followed, a change begins another run",
                );
        }
        let enabled = allows(simulation.status(), &Command::Seek(end.step));
        let button = ui.add_enabled(enabled, egui::Button::new(self.way()));
        if button
            .on_hover_text("Show the newest state (End)")
            .clicked()
        {
            out.push(Request::Command(Command::Seek(end.step)));
        }
    }
}
