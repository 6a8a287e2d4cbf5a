//! The lesson that is followed: the text of its step, what is asked, what was predicted and what was
//! measured, hints.
//!
//! In: the lesson under way, the simulation. Out: requests, each with a key of its own; and commands
//! for the run where a request is fulfilled ([`LessonDesk::act`]).

use crate::simulation::Simulation;
use crate::ui::request::{LessonAct, Request};
use crate::ui::theme::Palette;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::field;
use crate::ui::widgets::focus::is_entered;
use crate::ui::widgets::touch;
use crate::ui::words::names::{parameter_name, value_in_words};
use crate::view::{CameraRequest, ColourBy, CoordinateAxis, Cut, StandardView, ViewSettings};
use bevy_egui::egui::{self, RichText, ScrollArea, WidgetInfo, WidgetType};
use grainfall::lesson::{
    Change, Lesson, LessonCut, LessonLook, LessonStep, LessonUnderWay, LessonView, Prediction,
    Question, QuestionKind, Seen, Shown, Stage, Touch,
};
use grainfall::measure::{Verdict, numeral};
use grainfall::run::Command;
use grainfall::scene::Scene;

/// Most of the height of its side that it takes.
const SHARE: f32 = 0.62;

/// The lesson that is followed, if one is, and what is typed.
#[derive(Default)]
pub struct LessonDesk {
    under_way: Option<LessonUnderWay>,
    /// The prediction of a number while it is typed.
    typed: String,
    /// Whether its field is to take the keyboard's focus.
    wants_field: bool,
}

impl LessonDesk {
    /// Begins `lesson`.
    pub fn begin(&mut self, lesson: Lesson) {
        *self = Self::default();
        self.under_way = Some(LessonUnderWay::new(lesson));
    }

    /// The lesson that is followed.
    pub fn under_way(&self) -> Option<&LessonUnderWay> {
        self.under_way.as_ref()
    }

    /// It as a session keeps it; empty where no lesson is followed.
    pub fn in_words(&self) -> String {
        (self.under_way.as_ref()).map_or_else(String::new, LessonUnderWay::in_words)
    }

    /// Goes on with what a session of `scene` kept; what is not known is left out.
    pub fn take_up(&mut self, words: &str, scene: &Scene) {
        *self = Self::default();
        if !words.is_empty() {
            self.under_way = LessonUnderWay::read(words, scene);
        }
    }

    /// Follows the run: asks to hold it once it has answered.
    pub fn follow(&mut self, simulation: &Simulation, out: &mut Vec<Request>) {
        let seen = Seen {
            series: simulation.series(),
            commands: simulation.commands(),
            branch: simulation.past().number,
            has_answered: simulation.has_answered(),
        };
        let hold = (self.under_way.as_mut()).and_then(|lesson| lesson.follow(&seen));
        out.extend(hold.map(Request::Command));
    }

    /// Does what was asked for; the commands for the run that go with it.
    pub fn act(&mut self, act: LessonAct, simulation: &Simulation) -> Vec<Command> {
        let Some(lesson) = &mut self.under_way else {
            return Vec::new();
        };
        let before = lesson.index();
        let mut commands = Vec::new();
        match act {
            LessonAct::Next => lesson.go_on(),
            LessonAct::Back => lesson.go_back(),
            LessonAct::Hint => lesson.hint(),
            LessonAct::Again => {
                lesson.try_again();
                self.wants_field = true;
            }
            LessonAct::Say(prediction) => lesson.predict(prediction),
            LessonAct::Main => match lesson.stage() {
                Stage::Reading | Stage::Answered => lesson.go_on(),
                Stage::Waiting(step) => lesson.show(step),
                Stage::Asking => self.wants_field = true,
                Stage::Predicted => {
                    let value = |parameter: &_| simulation.value(parameter);
                    let branch = simulation.past().number;
                    commands = lesson.play(branch, simulation.parameters(), value);
                }
                Stage::Playing(_) => {}
            },
            LessonAct::Leave => {
                *self = Self::default();
                return Vec::new();
            }
        }
        if lesson.index() != before {
            self.typed.clear();
            self.wants_field = true;
        }
        commands
    }

    /// Draws it at the top of its side, and marks what is to be touched.
    pub fn ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        let Some(lesson) = &self.under_way else {
            touch::ask(ui.ctx(), &[]);
            return;
        };
        touch::ask(ui.ctx(), &touched(lesson));
        let height = SHARE * ui.available_height();
        header_ui(ui, lesson, out);
        ScrollArea::vertical()
            .id_salt(("lesson", lesson.index()))
            .max_height(height)
            .show(ui, |ui| {
                ui.set_width(ui.available_width() - 6.0);
                let step = lesson.step();
                ui.label(RichText::new(&step.title).strong().size(17.0));
                ui.label(&step.text);
                let typed = (&mut self.typed, &mut self.wants_field);
                if let Some(question) = &step.question {
                    question_ui(ui, lesson, question, simulation, typed, out);
                }
                for hint in lesson.hints() {
                    ui.label(RichText::new(format!("Hint: {hint}")).italics());
                }
            });
        footer_ui(ui, lesson, out);
        ui.separator();
    }
}

/// What the present step lets touch: what it names, and the parameters that it sets.
fn touched(lesson: &LessonUnderWay) -> Vec<Touch> {
    let step = lesson.step();
    let set = step
        .set
        .iter()
        .map(|(own, _)| Touch::Parameter(own.clone()));
    step.touch.iter().cloned().chain(set).collect()
}

fn header_ui(ui: &mut egui::Ui, lesson: &LessonUnderWay, out: &mut Vec<Request>) {
    let (index, count) = (lesson.index(), lesson.lesson().steps.len());
    egui::Sides::new().shrink_left().truncate().show(
        ui,
        |ui| ui.label(RichText::new(&lesson.lesson().title).weak()),
        |ui| {
            let leave = ui
                .small_button("✖")
                .on_hover_text("Leave the lesson; the scene stays");
            leave.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Leave the lesson"));
            if leave.clicked() {
                out.push(Request::Lesson(LessonAct::Leave));
            }
            ui.label(RichText::new(format!("Step {} of {count}", index + 1)).weak())
        },
    );
}

/// Back, a hint, on: each with its key.
fn footer_ui(ui: &mut egui::Ui, lesson: &LessonUnderWay, out: &mut Vec<Request>) {
    let hints = (lesson.step().hints.len(), lesson.hints().len());
    let buttons = [
        (
            "Back  (B)",
            LessonAct::Back,
            (lesson.index() == 0).then_some("This is the first step"),
        ),
        (
            "Hint  (H)",
            LessonAct::Hint,
            match hints {
                (0, _) => Some("This step has no hints"),
                (all, shown) if all == shown => Some("Every hint is shown"),
                _ => None,
            },
        ),
        (
            "Next  (N)",
            LessonAct::Next,
            (!lesson.has_next()).then_some("This is the last step"),
        ),
    ];
    ui.horizontal(|ui| {
        for (name, act, why_not) in buttons {
            if button_unless_ui(ui, why_not, egui::Button::new(name)).clicked() {
                out.push(Request::Lesson(act));
            }
        }
    });
}

/// What is asked, the prediction, and what became of it.
fn question_ui(
    ui: &mut egui::Ui,
    lesson: &LessonUnderWay,
    question: &Question,
    simulation: &Simulation,
    typed: (&mut String, &mut bool),
    out: &mut Vec<Request>,
) {
    ui.add_space(4.0);
    ui.label(RichText::new(&question.text).strong());
    if let Some(reason) = lesson.spoilt() {
        ui.colored_label(Palette::of(ui.visuals()).warning, reason);
    }
    match lesson.stage() {
        Stage::Waiting(step) => {
            let title = &lesson.lesson().steps[step].title;
            ui.label(format!(
                "This is compared with “{title}”: measure that first."
            ));
            main_ui(ui, "Go there", out);
        }
        Stage::Asking | Stage::Predicted => {
            match question.kind {
                QuestionKind::Number { .. } => number_ui(ui, lesson, question, typed, out),
                QuestionKind::Change { .. } => choices_ui(ui, lesson, out),
            }
            if lesson.stage() == Stage::Predicted {
                values_ui(ui, lesson.step(), simulation);
                main_ui(ui, "Play it", out);
            }
        }
        Stage::Playing(progress) => {
            let end = question.measurement.span.end;
            let text = format!("Measuring: {:.1} of {end} s", progress * end);
            let bar = ui.add(egui::ProgressBar::new(progress as f32).text(&text));
            bar.widget_info(|| {
                WidgetInfo::labeled(WidgetType::ProgressIndicator, true, "Measuring")
            });
        }
        Stage::Answered => answered_ui(ui, lesson, out),
        Stage::Reading => {}
    }
}

/// The button of what comes next, which Enter presses too.
fn main_ui(ui: &mut egui::Ui, name: &str, out: &mut Vec<Request>) {
    let accent = ui.visuals().selection;
    let face = RichText::new(format!("{name}  (Enter)")).strong();
    let button = egui::Button::new(face.color(accent.stroke.color)).fill(accent.bg_fill);
    if ui.add(button).clicked() {
        out.push(Request::Lesson(LessonAct::Main));
    }
}

/// The field for a number.
fn number_ui(
    ui: &mut egui::Ui,
    lesson: &LessonUnderWay,
    question: &Question,
    (typed, wants_field): (&mut String, &mut bool),
    out: &mut Vec<Request>,
) {
    let unit = question.measurement.quantity.quantity().unit.shown;
    let said = match lesson.answer().prediction {
        Some(Prediction::Number(said)) => Some(said * unit.factor),
        _ => None,
    };
    let mut entered = false;
    ui.horizontal(|ui| {
        let label = ui.label("I say");
        let edit = egui::TextEdit::singleline(typed)
            .desired_width(80.0)
            .hint_text("a number");
        let edit = ui.add(edit).labelled_by(label.id);
        if std::mem::take(wants_field) && said.is_none() {
            edit.request_focus();
        }
        ui.label(unit.name);
        entered = is_entered(&edit);
        entered |= ui.button("Predict").clicked();
    });
    let number = field::read(typed, unit.name);
    match (entered, number, said) {
        (true, Some(number), _) => {
            let prediction = Prediction::Number(number / unit.factor);
            out.push(Request::Lesson(LessonAct::Say(prediction)));
        }
        (_, None, _) if !typed.trim().is_empty() => {
            let text = format!("“{}” is no number: write one such as 20.", typed.trim());
            ui.colored_label(Palette::of(ui.visuals()).warning, text);
        }
        (_, _, Some(said)) => {
            let said = numeral::beside_unit(&numeral::trimmed(said), unit.name);
            ui.label(format!("You say {said}."));
        }
        _ => {}
    }
}

/// The directions to choose from, each with its key.
fn choices_ui(ui: &mut egui::Ui, lesson: &LessonUnderWay, out: &mut Vec<Request>) {
    let chosen = lesson.answer().prediction;
    ui.horizontal(|ui| {
        for (change, key) in Change::ALL.into_iter().zip(["+", "−", "="]) {
            let own = Prediction::Change(change);
            let name = format!("{}  ({key})", change.word());
            if ui.selectable_label(chosen == Some(own), name).clicked() {
                out.push(Request::Lesson(LessonAct::Say(own)));
            }
        }
    });
}

/// With which values the experiment is played.
fn values_ui(ui: &mut egui::Ui, step: &LessonStep, simulation: &Simulation) {
    if step.set.is_empty() {
        ui.weak("Played from the start, with the scene's values.");
    }
    for (parameter, value) in &step.set {
        let name = parameter_name(parameter, simulation);
        let value = value_in_words(parameter, *value);
        ui.weak(format!("Played from the start, with {name} = {value}."));
    }
}

/// What became of the prediction, and why.
fn answered_ui(ui: &mut egui::Ui, lesson: &LessonUnderWay, out: &mut Vec<Request>) {
    let palette = Palette::of(ui.visuals());
    if let Some(judged) = lesson.judged() {
        let colour = match judged.verdict {
            Verdict::Holds => palette.minimum,
            Verdict::DoesNot => palette.warning,
            Verdict::InPart | Verdict::NotDecided => palette.threshold,
        };
        egui::Frame::new()
            .stroke(egui::Stroke::new(1.5, colour))
            .corner_radius(6)
            .inner_margin(8)
            .show(ui, |ui| {
                ui.set_width(ui.available_width());
                ui.label(&judged.text);
                if judged.is_unexpected {
                    let text = "The lesson expects another result. Was something else changed?";
                    ui.colored_label(palette.warning, text);
                }
            });
    }
    ui.label(&lesson.step().why);
    ui.horizontal(|ui| {
        if lesson.has_next() {
            main_ui(ui, "Go on", out);
        }
        if ui.button("Try again  (A)").clicked() {
            out.push(Request::Lesson(LessonAct::Again));
        }
    });
}

/// Makes the picture look as a lesson asks.
pub fn show_look(look: &LessonLook, view: &mut ViewSettings) {
    view.colour_by = look.colour_by.map_or(ColourBy::Species, ColourBy::Quantity);
    let shows = |what| look.show.contains(&what);
    view.draw_forces(shows(Shown::Forces));
    view.show_bridges = shows(Shown::Bridges);
    view.show_velocities = shows(Shown::Velocities);
    view.show_turning = shows(Shown::Turning).then_some(true);
    view.show_flow = shows(Shown::Flow);
    view.show_temperature = shows(Shown::Temperature);
    view.cut = look.cut.map(|cut| match cut {
        LessonCut::Across => Cut::Beyond {
            axis: CoordinateAxis::Z,
            position: 0.0,
        },
        LessonCut::Quarter => Cut::Quarter { x: 0.0, z: 0.0 },
    });
    let request = look.from.map(|from| match from {
        LessonView::Home => CameraRequest::Home,
        LessonView::Front => CameraRequest::From(StandardView::Front),
        LessonView::Right => CameraRequest::From(StandardView::Right),
        LessonView::Above => CameraRequest::From(StandardView::Above),
    });
    if request.is_some() {
        view.camera_request = request;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_leaves_nothing_of_the_one_before() {
        let mut view = ViewSettings::default();
        let look = LessonLook {
            show: vec![Shown::Forces, Shown::Flow, Shown::Temperature],
            cut: Some(LessonCut::Quarter),
            ..LessonLook::default()
        };
        show_look(&look, &mut view);
        assert!(view.show_forces && view.shows_ghosts());
        assert!(view.show_flow && view.show_temperature);
        assert_eq!(view.cut, Some(Cut::Quarter { x: 0.0, z: 0.0 }));
        show_look(&LessonLook::default(), &mut view);
        assert!(!view.show_forces && !view.show_flow && !view.show_temperature);
        assert_eq!((view.cut, view.grain_size), (None, 1.0));
    }
}
