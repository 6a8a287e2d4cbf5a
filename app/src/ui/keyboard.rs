//! Which of Shift, Ctrl and Alt were held when each key was pressed.
//!
//! In: the keys of a frame, in order. Out: the same events for egui, each with the modifiers held
//! at its own moment. Bevy gives all keys of a frame the modifiers that are held at the end of the
//! frame. In a slow frame Ctrl+S, pressed and released, would then act like S alone.

use bevy::input::keyboard::{Key, KeyboardFocusLost, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::egui::Modifiers;
use bevy_egui::helpers::{bevy_to_egui_key, bevy_to_egui_physical_key};
use bevy_egui::{EguiInput, PrimaryEguiContext, egui};

/// Takes note in `held` of a key that is pressed or let go.
fn follow(held: &mut Modifiers, input: &KeyboardInput) {
    let (is_mac, is_down) = (cfg!(target_os = "macos"), input.state.is_pressed());
    match input.logical_key {
        Key::Shift => held.shift = is_down,
        Key::Alt => held.alt = is_down,
        Key::Control if is_mac => held.ctrl = is_down,
        Key::Control => (held.ctrl, held.command) = (is_down, is_down),
        Key::Super | Key::Meta if is_mac => (held.mac_cmd, held.command) = (is_down, is_down),
        _ => {}
    }
}

/// Corrects the events of this frame before egui reads them.
pub fn tell_modifiers(
    mut inputs: MessageReader<KeyboardInput>,
    mut focus_lost: MessageReader<KeyboardFocusLost>,
    mut held: Local<Modifiers>,
    context: Option<Single<&mut EguiInput, With<PrimaryEguiContext>>>,
) {
    if focus_lost.read().count() > 0 {
        *held = Modifiers::NONE;
    }
    let mut nobody = Vec::new();
    let mut context = context.map(Single::into_inner);
    let events = (context.as_mut()).map_or(&mut nobody, |context| &mut context.0.events);
    correct(inputs.read(), &mut held, events);
}

/// Gives each key among the `events`, which came of `inputs`, what was held then; a letter that
/// Ctrl was held for is no text.
fn correct<'a>(
    inputs: impl Iterator<Item = &'a KeyboardInput>,
    held: &mut Modifiers,
    events: &mut Vec<egui::Event>,
) {
    let mut next = 0;
    for input in inputs {
        follow(held, input);
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
            && held.command
        {
            events.remove(text);
            place = text;
        }
        if let egui::Event::Key { modifiers, .. } = &mut events[place] {
            *modifiers = *held;
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
            modifiers: Modifiers::NONE,
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
        let mut held = Modifiers::NONE;
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
