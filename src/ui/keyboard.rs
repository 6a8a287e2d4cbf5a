//! Which of Shift, Ctrl and Alt were held when a key was pressed, told key by key.
//!
//! In: the keys of a frame in their order. Out: the same events for egui, each with what was held at its own moment. As they
//! come, all have what is held at the end of the frame: where a frame takes long, Ctrl and a key that are pressed and let
//! go within one would do what the key alone does.

use bevy::input::keyboard::{Key, KeyboardFocusLost, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::helpers::{bevy_to_egui_key, bevy_to_egui_physical_key};
use bevy_egui::{EguiInput, PrimaryEguiContext, egui};

/// The keys that are held.
#[derive(Clone, Copy, Default)]
pub struct Held {
    shift: bool,
    ctrl: bool,
    alt: bool,
    command: bool,
}

impl Held {
    /// Takes note of a key.
    fn follow(&mut self, input: &KeyboardInput) {
        let held = match input.logical_key {
            Key::Shift => &mut self.shift,
            Key::Control => &mut self.ctrl,
            Key::Alt => &mut self.alt,
            Key::Super | Key::Meta => &mut self.command,
            _ => return,
        };
        *held = input.state.is_pressed();
    }

    fn modifiers(self) -> egui::Modifiers {
        let is_mac = cfg!(target_os = "macos");
        egui::Modifiers {
            alt: self.alt,
            ctrl: self.ctrl,
            shift: self.shift,
            mac_cmd: is_mac && self.command,
            command: if is_mac { self.command } else { self.ctrl },
        }
    }
}

/// Corrects the events of this frame before egui reads them.
pub fn tell_modifiers(
    mut inputs: MessageReader<KeyboardInput>,
    mut focus_lost: MessageReader<KeyboardFocusLost>,
    mut held: Local<Held>,
    context: Option<Single<&mut EguiInput, With<PrimaryEguiContext>>>,
) {
    if focus_lost.read().count() > 0 {
        *held = Held::default();
    }
    let mut nobody = Vec::new();
    let mut context = context.map(Single::into_inner);
    let events = (context.as_mut()).map_or(&mut nobody, |context| &mut context.0.events);
    correct(inputs.read(), &mut held, events);
}

/// Gives each key among the `events`, which came of `inputs`, what was held then; a letter that Ctrl was held for is no
/// text.
fn correct<'a>(
    inputs: impl Iterator<Item = &'a KeyboardInput>,
    held: &mut Held,
    events: &mut Vec<egui::Event>,
) {
    let mut next = 0;
    for input in inputs {
        held.follow(input);
        let key = bevy_to_egui_key(&input.logical_key);
        if key.or(bevy_to_egui_physical_key(&input.key_code)).is_none() {
            continue;
        }
        let is_key = |event: &egui::Event| matches!(event, egui::Event::Key { .. });
        let Some(found) = events[next..].iter().position(is_key) else {
            return;
        };
        let mut place = next + found;
        let text = place.checked_sub(1).filter(|before| *before >= next);
        let is_text = |at: &usize| matches!(events[*at], egui::Event::Text(_));
        if let Some(text) = text.filter(is_text)
            && held.modifiers().command
        {
            events.remove(text);
            place = text;
        }
        if let egui::Event::Key { modifiers, .. } = &mut events[place] {
            *modifiers = held.modifiers();
        }
        next = place + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::input::ButtonState;

    fn input(key: Key, code: KeyCode, state: ButtonState) -> KeyboardInput {
        KeyboardInput {
            key_code: code,
            logical_key: key,
            state,
            text: None,
            repeat: false,
            window: Entity::PLACEHOLDER,
        }
    }

    fn event(key: egui::Key, pressed: bool) -> egui::Event {
        egui::Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: egui::Modifiers::NONE,
        }
    }

    #[test]
    fn keys_pressed_within_one_frame_have_what_was_held_then() {
        use ButtonState::{Pressed, Released};
        let ctrl = |state| input(Key::Control, KeyCode::ControlLeft, state);
        let g = |state| input(Key::Character("g".into()), KeyCode::KeyG, state);
        let inputs = [
            g(Pressed),
            g(Released),
            ctrl(Pressed),
            g(Pressed),
            g(Released),
            ctrl(Released),
            g(Pressed),
        ];
        // What comes of them where nothing is held at the end of the frame.
        let typed = || egui::Event::Text("g".to_owned());
        let mut events = vec![
            typed(),
            event(egui::Key::G, true),
            event(egui::Key::G, false),
        ];
        events.extend([
            typed(),
            event(egui::Key::G, true),
            event(egui::Key::G, false),
        ]);
        events.extend([typed(), event(egui::Key::G, true)]);
        let mut held = Held::default();
        correct(inputs.iter(), &mut held, &mut events);
        let told: Vec<_> = (events.iter())
            .map(|event| match event {
                egui::Event::Key { modifiers, .. } => Some(modifiers.command),
                _ => None,
            })
            .collect();
        let (text, plain, with_ctrl) = (None, Some(false), Some(true));
        assert_eq!(
            told,
            [text, plain, plain, with_ctrl, with_ctrl, text, plain]
        );
        assert!(!held.ctrl);
    }
}
