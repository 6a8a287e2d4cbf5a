//! What each key does, in one table: keys are looked up in it, and the sheet of shortcuts and the
//! menus show it.
//!
//! In: the keys pressed in a frame, the simulation. Out: requests that mean something now. While a
//! text is typed or a dialog is open, no key counts.

use crate::simulation::Simulation;
use crate::ui::arrangement::Rearrangement;
use crate::ui::event_kinds::EventKinds;
use crate::ui::panels::explorer::Explorer;
use crate::ui::panels::picture_settings::PictureSettings;
use crate::ui::playback::{
    Way, allows, go, leap, play_or_pause, step_back, step_on, to_avalanche, to_event,
};
use crate::ui::request::{LessonAct, Request, Sheet, SweepAct};
use crate::ui::screenshot_orders::PictureOf;
use crate::view::{CameraRequest, StandardView};
use bevy_egui::egui::{self, Key, KeyboardShortcut, Modifiers};
use grainfall::lab::Half;
use grainfall::lesson::{Change, Prediction};
use grainfall::run::Command;

/// A key and what it does.
pub struct Shortcut {
    /// Keys that do it, any of them.
    keys: &'static [KeyboardShortcut],
    /// What it does, in words.
    pub name: &'static str,
    action: KeyAction,
}

enum KeyAction {
    PlayOrPause,
    StepBack,
    StepOn,
    Steps(Way, u64),
    Leap(Way),
    ToTheNewest,
    Avalanche(Way),
    Event(Way),
    Ask(Request),
}

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn look_from(side: StandardView) -> KeyAction {
    KeyAction::Ask(Request::Camera(CameraRequest::From(side)))
}

const fn show(panel: &'static str) -> KeyAction {
    KeyAction::Ask(Request::Arrange(Rearrangement::Show(panel)))
}

const fn lesson(act: LessonAct) -> KeyAction {
    KeyAction::Ask(Request::Lesson(act))
}

const fn say(change: Change) -> KeyAction {
    lesson(LessonAct::Say(Prediction::Change(change)))
}

/// Every shortcut, in the order of the sheet.
pub const SHORTCUTS: &[Shortcut] = &[
    Shortcut {
        keys: &[key(Key::Space)],
        name: "Play or pause",
        action: KeyAction::PlayOrPause,
    },
    // Before the keys with fewer others held, which would take them.
    Shortcut {
        keys: &[ctrl_shift(Key::ArrowRight)],
        name: "A hundred time steps on",
        action: KeyAction::Steps(Way::On, 100),
    },
    Shortcut {
        keys: &[ctrl_shift(Key::ArrowLeft)],
        name: "A hundred time steps back",
        action: KeyAction::Steps(Way::Back, 100),
    },
    Shortcut {
        keys: &[ctrl(Key::ArrowRight)],
        name: "Ten time steps on",
        action: KeyAction::Steps(Way::On, 10),
    },
    Shortcut {
        keys: &[ctrl(Key::ArrowLeft)],
        name: "Ten time steps back",
        action: KeyAction::Steps(Way::Back, 10),
    },
    Shortcut {
        keys: &[shift(Key::ArrowRight)],
        name: "A fiftieth of a second on",
        action: KeyAction::Leap(Way::On),
    },
    Shortcut {
        keys: &[shift(Key::ArrowLeft)],
        name: "A fiftieth of a second back",
        action: KeyAction::Leap(Way::Back),
    },
    Shortcut {
        keys: &[key(Key::Period), key(Key::ArrowRight)],
        name: "One time step",
        action: KeyAction::StepOn,
    },
    Shortcut {
        keys: &[key(Key::Comma), key(Key::ArrowLeft)],
        name: "One time step back",
        action: KeyAction::StepBack,
    },
    Shortcut {
        keys: &[key(Key::G)],
        name: "Go to a moment: type its time",
        action: KeyAction::Ask(Request::TypeMoment),
    },
    Shortcut {
        keys: &[key(Key::End)],
        name: "The newest state",
        action: KeyAction::ToTheNewest,
    },
    // Before the shorter one, which would take its keys.
    Shortcut {
        keys: &[ctrl_shift(Key::Z), ctrl(Key::Y)],
        name: "Redo",
        action: KeyAction::Ask(Request::Command(Command::Redo)),
    },
    Shortcut {
        keys: &[ctrl(Key::Z)],
        name: "Undo",
        action: KeyAction::Ask(Request::Command(Command::Undo)),
    },
    Shortcut {
        keys: &[key(Key::R)],
        name: "Start afresh",
        action: KeyAction::Ask(Request::Command(Command::Reset)),
    },
    Shortcut {
        keys: &[key(Key::F2)],
        name: "Name the run that is shown",
        action: KeyAction::Ask(Request::TypeName),
    },
    // Before the shorter ones, which would take its keys.
    Shortcut {
        keys: &[ctrl_shift(Key::T)],
        name: "Run over several values of a parameter",
        action: KeyAction::Ask(Request::Sweep(SweepAct::Ask(None))),
    },
    Shortcut {
        keys: &[ctrl(Key::T)],
        name: "Compare two values side by side",
        action: KeyAction::Ask(Request::Compare(None)),
    },
    // Before the plain key, which would take it.
    Shortcut {
        keys: &[shift(Key::T)],
        name: "No trails",
        action: KeyAction::Ask(Request::NoTrails),
    },
    Shortcut {
        keys: &[key(Key::T)],
        name: "Trail of the grain under the microscope",
        action: KeyAction::Ask(Request::Trail),
    },
    Shortcut {
        keys: &[key(Key::M)],
        name: "Ruler: distance and angle between two clicks",
        action: KeyAction::Ask(Request::Ruler),
    },
    Shortcut {
        keys: &[key(Key::F)],
        name: "Everything in view",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Fit)),
    },
    Shortcut {
        keys: &[key(Key::Home)],
        name: "The view a scene opens with",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Home)),
    },
    Shortcut {
        keys: &[key(Key::Num1)],
        name: "Look from the front",
        action: look_from(StandardView::Front),
    },
    Shortcut {
        keys: &[key(Key::Num2)],
        name: "Look from the back",
        action: look_from(StandardView::Back),
    },
    Shortcut {
        keys: &[key(Key::Num3)],
        name: "Look from the left",
        action: look_from(StandardView::Left),
    },
    Shortcut {
        keys: &[key(Key::Num4)],
        name: "Look from the right",
        action: look_from(StandardView::Right),
    },
    Shortcut {
        keys: &[key(Key::Num5)],
        name: "Look from above",
        action: look_from(StandardView::Above),
    },
    Shortcut {
        keys: &[key(Key::Num6)],
        name: "Look from below",
        action: look_from(StandardView::Below),
    },
    // Before the plain keys, which would take them.
    Shortcut {
        keys: &[shift(Key::F5)],
        name: "Keep this view as view 1",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Save(0))),
    },
    Shortcut {
        keys: &[shift(Key::F6)],
        name: "Keep this view as view 2",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Save(1))),
    },
    Shortcut {
        keys: &[shift(Key::F7)],
        name: "Keep this view as view 3",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Save(2))),
    },
    Shortcut {
        keys: &[key(Key::F5)],
        name: "Show kept view 1",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Recall(0))),
    },
    Shortcut {
        keys: &[key(Key::F6)],
        name: "Show kept view 2",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Recall(1))),
    },
    Shortcut {
        keys: &[key(Key::F7)],
        name: "Show kept view 3",
        action: KeyAction::Ask(Request::Camera(CameraRequest::Recall(2))),
    },
    Shortcut {
        keys: &[ctrl(Key::O)],
        name: "Open a scene, a lesson, a session or a recording",
        action: KeyAction::Ask(Request::ChooseFile),
    },
    Shortcut {
        keys: &[ctrl(Key::G)],
        name: "Lessons and scenes with their pictures",
        action: KeyAction::Ask(Request::ShowScenes),
    },
    Shortcut {
        keys: &[ctrl_shift(Key::S)],
        name: "Save the session to another file",
        action: KeyAction::Ask(Request::ChooseSession),
    },
    Shortcut {
        keys: &[ctrl(Key::S)],
        name: "Save the session",
        action: KeyAction::Ask(Request::Save),
    },
    Shortcut {
        keys: &[ctrl(Key::P)],
        name: "Save a picture",
        action: KeyAction::Ask(Request::ChoosePicture(PictureOf::Window)),
    },
    Shortcut {
        keys: &[ctrl(Key::R)],
        name: "Record a film; stop and save it",
        action: KeyAction::Ask(Request::ChooseFilm),
    },
    Shortcut {
        keys: &[ctrl(Key::E)],
        name: "Any quantity over time, to look at and to export",
        action: show(Explorer::TITLE),
    },
    Shortcut {
        keys: &[ctrl(Key::Comma)],
        name: "What the picture shows, and how",
        action: show(PictureSettings::TITLE),
    },
    Shortcut {
        keys: &[key(Key::PageUp)],
        name: "The avalanche before",
        action: KeyAction::Avalanche(Way::Back),
    },
    Shortcut {
        keys: &[key(Key::PageDown)],
        name: "The next avalanche",
        action: KeyAction::Avalanche(Way::On),
    },
    // Before the plain key, which would take it.
    Shortcut {
        keys: &[shift(Key::E)],
        name: "The event before, of the kinds shown",
        action: KeyAction::Event(Way::Back),
    },
    Shortcut {
        keys: &[key(Key::E)],
        name: "The next event, of the kinds shown",
        action: KeyAction::Event(Way::On),
    },
    Shortcut {
        keys: &[key(Key::L)],
        name: "Play a part again and again: mark A, B, none",
        action: KeyAction::Ask(Request::Repeat),
    },
    Shortcut {
        keys: &[key(Key::Enter)],
        name: "In a lesson: predict, play, go on",
        action: lesson(LessonAct::Main),
    },
    Shortcut {
        keys: &[key(Key::N)],
        name: "In a lesson: the next step",
        action: lesson(LessonAct::Next),
    },
    Shortcut {
        keys: &[key(Key::B)],
        name: "In a lesson: the step before",
        action: lesson(LessonAct::Back),
    },
    Shortcut {
        keys: &[key(Key::H)],
        name: "In a lesson: a hint",
        action: lesson(LessonAct::Hint),
    },
    Shortcut {
        keys: &[key(Key::A)],
        name: "In a lesson: try again",
        action: lesson(LessonAct::Again),
    },
    Shortcut {
        keys: &[key(Key::Plus)],
        name: "In a lesson: I say higher",
        action: say(Change::Higher),
    },
    Shortcut {
        keys: &[key(Key::Minus)],
        name: "In a lesson: I say lower",
        action: say(Change::Lower),
    },
    Shortcut {
        keys: &[key(Key::Equals)],
        name: "In a lesson: I say the same",
        action: say(Change::Same),
    },
    Shortcut {
        keys: &[key(Key::F1)],
        name: "These shortcuts",
        action: KeyAction::Ask(Request::Show(Sheet::Shortcuts)),
    },
    Shortcut {
        keys: &[key(Key::F10)],
        name: "The menus",
        action: KeyAction::Ask(Request::Menus),
    },
    Shortcut {
        keys: &[key(Key::P)],
        name: "Present: panels away, large numbers; and back",
        action: KeyAction::Ask(Request::Present),
    },
    Shortcut {
        keys: &[key(Key::F11)],
        name: "The whole screen, and back",
        action: KeyAction::Ask(Request::FullScreen),
    },
    Shortcut {
        keys: &[ctrl(Key::Q)],
        name: "Quit",
        action: KeyAction::Ask(Request::Quit),
    },
];

/// What egui's own keys and the mouse over the picture do.
pub const GESTURES: [(&str, &str); 8] = [
    (
        "Ctrl + +, −, 0",
        "Text and controls larger, smaller, as large as suits the window",
    ),
    ("Esc", "The panels back, after presenting"),
    ("Click a grain", "Put it under the microscope"),
    ("Shift + click a grain", "Draw its trail, or no longer"),
    ("Drag", "Orbit"),
    ("Right drag, Shift + drag", "Pan"),
    ("Scroll, pinch", "Zoom"),
    ("Double click", "Everything in view"),
];

impl Shortcut {
    /// Its keys in words: `. or →`.
    pub fn keys(&self, ctx: &egui::Context) -> String {
        let name = |key: &KeyboardShortcut| {
            let symbol = match key.logical_key {
                Key::Period => ".",
                Key::Comma => ",",
                Key::ArrowLeft => "←",
                Key::ArrowRight => "→",
                _ => return ctx.format_shortcut(key),
            };
            let ctrl = if key.modifiers.command { "Ctrl+" } else { "" };
            let shift = if key.modifiers.shift { "Shift+" } else { "" };
            format!("{ctrl}{shift}{symbol}")
        };
        let names: Vec<String> = self.keys.iter().map(name).collect();
        names.join(" or ")
    }

    /// Whether it asks for `request`.
    fn asks_for(&self, request: &Request) -> bool {
        matches!(&self.action, KeyAction::Ask(own) if own == request)
    }

    /// Whether its keys work the control that has the keyboard's focus.
    fn moves_a_control(&self) -> bool {
        use Key::{ArrowLeft, ArrowRight, End, Enter, Home, Space};
        self.keys.iter().any(|key| {
            let works = [ArrowLeft, ArrowRight, End, Enter, Home, Space].contains(&key.logical_key);
            works && !key.modifiers.command
        })
    }

    fn is_pressed(&self, ctx: &egui::Context) -> bool {
        ctx.input_mut(|input| {
            // Every key is consumed, not only the first that is pressed.
            let pressed = self.keys.iter().filter(|key| input.consume_shortcut(key));
            pressed.count() > 0
        })
    }

    /// What it asks for, if `simulation` allows it now.
    fn request(&self, ctx: &egui::Context, simulation: Option<&Simulation>) -> Option<Request> {
        let command = match &self.action {
            KeyAction::Ask(Request::Command(command)) => command.clone(),
            KeyAction::Ask(request) => return Some(request.clone()),
            KeyAction::PlayOrPause => play_or_pause(simulation?.status())?,
            KeyAction::StepBack => step_back(simulation?)?,
            KeyAction::StepOn => step_on(simulation?)?,
            KeyAction::Leap(way) => leap(simulation?, *way)?,
            KeyAction::Steps(way, steps) => go(simulation?, *way, *steps)?,
            KeyAction::Avalanche(way) => return to_avalanche(simulation?, *way),
            KeyAction::Event(way) => {
                return to_event(simulation?, Half::Left, EventKinds::of(ctx), *way);
            }
            KeyAction::ToTheNewest => Command::Seek(simulation?.past().end.step),
        };
        allows(simulation?.status(), &command).then_some(Request::Command(command))
    }
}

/// The keys in words that ask for `request`; nothing where none do.
pub fn keys_for(ctx: &egui::Context, request: &Request) -> String {
    let shortcut = SHORTCUTS.iter().find(|shortcut| shortcut.asks_for(request));
    shortcut.map_or_else(String::new, |shortcut| shortcut.keys(ctx))
}

/// What the keys pressed now ask for; nothing while the keyboard writes into a field or a sheet
/// lies over the window.
pub fn pressed(ctx: &egui::Context, simulation: Option<&Simulation>) -> Vec<Request> {
    let covered = ctx.memory(|memory| memory.top_modal_layer().is_some());
    if covered || ctx.text_edit_focused() {
        return Vec::new();
    }
    let focused = ctx.memory(|memory| memory.focused().is_some());
    let pressed = (SHORTCUTS.iter())
        .filter(|shortcut| !(focused && shortcut.moves_a_control()))
        .filter(|shortcut| shortcut.is_pressed(ctx));
    pressed
        .filter_map(|shortcut| shortcut.request(ctx, simulation))
        .collect()
}
